/* Encodings of depth, and projections: part of the group "numbers". */
#ifndef GLINT_SELFTEST_NUMBERS_DEPTH_H
#define GLINT_SELFTEST_NUMBERS_DEPTH_H

#include "harness/picture.h"

size_t numbers_depth_count(void);
struct glint_selftest_case numbers_depth_get(size_t i);
bool numbers_depth_run(const struct case_context *context, const bool *selected,
                       struct glint_selftest_finding *findings, struct glint_error *err);
/* Compares an open box with the replay of its own depths in double precision; with another variant, "downsample=none". */
bool numbers_depth_check(const struct case_context *context, const struct open_box *box, const char *downsample,
                         struct glint_selftest_finding *finding, struct glint_error *err);

#endif
