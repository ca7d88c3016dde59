/* The cases of a self-test by their groups, and what was found of them. */
#ifndef GLINT_SELFTEST_INTERNAL_H
#define GLINT_SELFTEST_INTERNAL_H

#include "harness/case.h"

struct selected_group {
    const struct case_group *group;
    bool *selected; /* of all of the group's cases, like the findings */
    struct glint_selftest_finding *findings;
    struct glint_selftest_case *shown; /* the selected ones alone: what the public group points to */
    struct glint_selftest_finding *shown_findings;
    struct glint_selftest_group public;
};

enum { SELFTEST_GROUPS = 7 };

struct glint_selftest {
    struct selected_group groups[SELFTEST_GROUPS];
    struct glint_device_info device;
};

#endif
