/* The precision of a device's texture filter: weights have steps, and Vulkan allows as few as 16. */
#ifndef GLINT_SELFTEST_TEXTURE_FILTER_H
#define GLINT_SELFTEST_TEXTURE_FILTER_H

#include "harness/image_case.h"

/* The largest error of light at the end of a ray due to the weights, if the end moves by a tiny distance to the next step: two steps of
   a weight, times the largest difference of neighbouring texels in this capture. */
bool texture_filter_slack(const struct case_context *context, struct glint_capture *capture, double *slack,
                          struct glint_error *err);
/* Of ends that move by a small fraction of a texel few are close to a step: more than 1 % of ties fail. */
void texture_filter_limit_ties(struct glint_selftest_finding *finding);

extern const struct image_list images_texture_filter;

#endif
