/* The groups of cases. */
#ifndef GLINT_SELFTEST_GROUPS_H
#define GLINT_SELFTEST_GROUPS_H

#include "harness/case.h"

extern const struct case_group functions_group;
extern const struct case_group geometry_group;
extern const struct case_group numbers_group;
extern const struct case_group garbage_group;
extern const struct case_group sizes_group;
extern const struct case_group time_group;
extern const struct case_group invariance_group;

#endif
