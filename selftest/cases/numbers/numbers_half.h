/* Images in half: a part of the group "numbers". */
#ifndef GLINT_SELFTEST_NUMBERS_HALF_H
#define GLINT_SELFTEST_NUMBERS_HALF_H

#include "harness/picture.h"

size_t numbers_half_count(void);
struct glint_selftest_case numbers_half_get(size_t i);
bool numbers_half_run(const struct case_context *context, const bool *selected, struct glint_selftest_finding *findings,
                      struct glint_error *err);

#endif
