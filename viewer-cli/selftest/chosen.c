#include "chosen.h"

#include <stdlib.h>
#include <string.h>

#include "args.h"

static bool is_chosen(const struct list *only, const struct selftest_group *group, const struct selftest_case *c) {
    for (size_t i = 0; i < only->count; i++)
        if (strcasestr(c->name, only->items[i]) || strcasestr(group->name, only->items[i]) ||
            strcasestr(c->what, only->items[i]) || (c->source && strcasestr(c->source, only->items[i])))
            return true;
    return only->count == 0;
}

bool chosen_init(struct chosen *chosen, const struct selftest_group *const *groups, size_t count,
                 const struct list *only, struct glint_error *err) {
    size_t sum = 0;
    *chosen = (struct chosen){.group_count = count};
    for (size_t g = 0; g < count; g++) {
        const size_t cases = groups[g]->count();
        struct chosen_group *group = &chosen->groups[g];
        *group = (struct chosen_group){.group = groups[g],
                                       .cases = calloc(cases, sizeof *group->cases),
                                       .findings = calloc(cases, sizeof *group->findings)};
        if (!group->cases || !group->findings) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        for (size_t i = 0; i < cases; i++) {
            const struct selftest_case c = groups[g]->get(i);
            group->cases[i] = is_chosen(only, groups[g], &c);
            group->count += group->cases[i];
        }
        sum += group->count;
    }
    if (sum) return true;
    return glint_fail(err, GLINT_ERROR_USAGE, "--only %s: no case has that; glint selftest --list names them",
                      only->items[0]);
}

void chosen_finish(struct chosen *chosen) {
    for (size_t g = 0; g < chosen->group_count; g++) {
        free(chosen->groups[g].cases);
        free(chosen->groups[g].findings);
    }
}

bool chosen_passes(const struct selftest_case *c, const struct selftest_finding *finding) {
    return finding->values > 0 && finding->worst <= c->bound;
}

void chosen_each(const struct chosen_group *group, chosen_visit visit, void *user) {
    for (size_t i = 0, count = group->group->count(); i < count; i++) {
        const struct selftest_case c = group->group->get(i);
        if (group->cases[i] && !group->findings[i].left_out) visit(user, group, &c, &group->findings[i]);
    }
}
