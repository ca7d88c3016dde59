/* Images in half: a part of the group "numbers". */
#ifndef GLINT_VIEWER_SELFTEST_NUMBERS_HALF_H
#define GLINT_VIEWER_SELFTEST_NUMBERS_HALF_H

#include "picture.h"

size_t numbers_half_count(void);
struct selftest_case numbers_half_get(size_t i);
bool numbers_half_run(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,
                      struct glint_error *err);

#endif
