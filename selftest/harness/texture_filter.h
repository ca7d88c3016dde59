/* How a device's texture units weigh neighbouring texels: in steps, of which Vulkan grants them as few as 16. */
#ifndef GLINT_SELFTEST_TEXTURE_FILTER_H
#define GLINT_SELFTEST_TEXTURE_FILTER_H

#include "harness/image_case.h"

/* How far light at the end of a ray may be off because of the weights, when the end moves by next to nothing and reaches the
   next step: two of them, a step each, between the most different neighbours of what rays of this capture look up. */
bool texture_filter_slack(const struct case_context *context, struct glint_capture *capture, double *slack,
                          struct glint_error *err);
/* Of ends that move by a small part of a texel few can be next to a step: more than 1 % of ties fail. */
void texture_filter_limit_ties(struct glint_selftest_finding *finding);

extern const struct image_list images_texture_filter;

#endif
