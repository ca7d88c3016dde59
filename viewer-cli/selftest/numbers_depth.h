/* Depth as engines store it, and projections: a part of the group "numbers". */
#ifndef GLINT_VIEWER_SELFTEST_NUMBERS_DEPTH_H
#define GLINT_VIEWER_SELFTEST_NUMBERS_DEPTH_H

#include "picture.h"

size_t numbers_depth_count(void);
struct selftest_case numbers_depth_get(size_t i);
bool numbers_depth_run(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,
                       struct glint_error *err);
/* A court against the double replay of its own depths, with another variant, "downsample=none". */
bool numbers_depth_check(const struct selftest *test, const struct court *court, const char *downsample,
                         struct selftest_finding *finding, struct glint_error *err);

#endif
