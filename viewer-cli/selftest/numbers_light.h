/* Light of all sizes, and images in half: a part of the group "numbers". */
#ifndef GLINT_VIEWER_SELFTEST_NUMBERS_LIGHT_H
#define GLINT_VIEWER_SELFTEST_NUMBERS_LIGHT_H

#include "picture.h"

size_t numbers_light_count(void);
struct selftest_case numbers_light_get(size_t i);
bool numbers_light_run(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,
                       struct glint_error *err);

#endif
