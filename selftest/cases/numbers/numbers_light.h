/* Light of all magnitudes: part of the group "numbers". */
#ifndef GLINT_SELFTEST_NUMBERS_LIGHT_H
#define GLINT_SELFTEST_NUMBERS_LIGHT_H

#include "harness/picture.h"

size_t numbers_light_count(void);
struct glint_selftest_case numbers_light_get(size_t i);
bool numbers_light_run(const struct case_context *context, const bool *selected,
                       struct glint_selftest_finding *findings, struct glint_error *err);

#endif
