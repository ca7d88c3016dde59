/* The cases of a self-test by group, and their findings. */
#ifndef GLINT_SELFTEST_INTERNAL_H
#define GLINT_SELFTEST_INTERNAL_H

#include "harness/case.h"

struct selected_group {
    const struct case_group *group;
    bool *selected; /* for each case of the group, like the findings */
    struct glint_selftest_finding *findings;
    struct glint_selftest_case *shown; /* the selected cases, which the public group points to */
    struct glint_selftest_finding *shown_findings;
    struct glint_selftest_group public;
};

enum { SELFTEST_GROUPS = 7 };

struct glint_selftest {
    struct selected_group groups[SELFTEST_GROUPS];
    struct glint_device_info device;
};

#endif
