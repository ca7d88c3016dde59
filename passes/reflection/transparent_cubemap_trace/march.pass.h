/* The march of cubemap_trace/march, along the chain of the cube map whose centre is nearest to the end of the screen ray. */
PASS("March along the chain", "Mafia DE article, Transparency and Glows; Global Illumination")
#include "slot.h"
#include "reflection/cubemap_trace/march_rows.h"
#include "reflection/cubemap_trace/no_cubemap_rows.h"
