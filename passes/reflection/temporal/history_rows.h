/* A history of half-resolution reflections. */
#line 202
WRITE(image2D, temporal_age, R16F, "samples", HALF, "n", 0, "number of samples averaged in reflection_temporal")
HISTORY(texture2D, previous_color, reflection_temporal)
HISTORY(texture2D, previous_age, temporal_age)
#include "previous_frame/history_rows.h"
#include "shared/reuse_rows.h"
#include "shared/reproject_rows.h"
