/* How a device's texture units weigh neighbouring texels: in steps, of which Vulkan grants them as few as 16. */
#ifndef GLINT_VIEWER_SELFTEST_FILTER_H
#define GLINT_VIEWER_SELFTEST_FILTER_H

#include "images.h"

/* The step of the weights: 0 where they are as exact as floats. */
bool filter_step(const struct selftest *test, double *step, struct glint_error *err);

extern const struct image_list images_filter;

#endif
