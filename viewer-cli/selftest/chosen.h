/* Which cases are run, and what was found of them. */
#ifndef GLINT_VIEWER_SELFTEST_CHOSEN_H
#define GLINT_VIEWER_SELFTEST_CHOSEN_H

#include "command.h"
#include "selftest.h"

struct list;
enum { MOST_GROUPS = 8 };

struct chosen_group {
    const struct selftest_group *group;
    bool *cases; /* the chosen ones */
    struct selftest_finding *findings;
    size_t count; /* how many are chosen */
    double seconds;
};

struct chosen {
    struct chosen_group groups[MOST_GROUPS];
    size_t group_count;
};

/* Those with one of the texts in their name, their group's, or what they say; all where there is none. */
bool chosen_init(struct chosen *chosen, const struct selftest_group *const *groups, size_t count,
                 const struct list *only, struct glint_error *err);
void chosen_finish(struct chosen *chosen);

/* A case that compared nothing has not passed. */
bool chosen_passes(const struct selftest_case *c, const struct selftest_finding *finding);

/* The chosen cases of a group that were not left out, in their order. */
typedef void (*chosen_visit)(void *user, const struct chosen_group *group, const struct selftest_case *c,
                             const struct selftest_finding *finding);
void chosen_each(const struct chosen_group *group, chosen_visit visit, void *user);

/* chosen_report.c: a table for each group and what they come to, or JSON. device: NULL where none has run, and the cases are
   listed with their reasons. STATUS_CHECK: some failed. */
enum status chosen_report(const struct chosen *chosen, const struct glint_device_info *device, double seconds,
                          bool json);

#endif
