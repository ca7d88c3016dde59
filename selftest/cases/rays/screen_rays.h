/* Compares every ray of a picture through the depth buffer with its replay in double precision. */
#ifndef GLINT_SELFTEST_SCREEN_RAYS_H
#define GLINT_SELFTEST_SCREEN_RAYS_H

#include "harness/replay_case.h"

#define SCREEN_TRACED "downsample=none downsample.jitter=false hiz=nearest screen_trace="
#define SCREEN_DDA SCREEN_TRACED "dda screen_trace.cells=65536"
#define SCREEN_HIZ SCREEN_TRACED "hiz screen_trace.cells=65536 screen_trace.cells_lq=65536"
/* The unit of errors, and the reason for their bound. */
#define SCREEN_UNIT "of the picture"
/* clang-format off */
#define SCREEN_REASON "a place is 2^-24 of the picture for each of some ten operations; where a ray closes in on a plane slowly this grows, and the replays rounded otherwise say by how much"
/* clang-format on */

/* Runs a case; one in `stride` rays is compared. */
void screen_rays(struct case_run *run, const struct plain *plain, const struct replay_case *c, uint32_t stride,
                 struct glint_selftest_finding *finding);

#endif
