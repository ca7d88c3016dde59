/* The water of the scene lake against the finished picture of its path tracer. */
#ifndef TESTS_LAKE_H
#define TESTS_LAKE_H

#include "gpu.h"

/* The mean of |image - truth| / (image + truth + 0.05) over the pixels of the water, which are most of them: of composed_water of the last run,
   against three floats a pixel. */
double lake_error(struct gpu *gpu, const float *opacity, const float *scene);

#endif
