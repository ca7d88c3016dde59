/* Selects the cases of a self-test. */
#include "glint/selftest.h"

#include <stdlib.h>
#include <string.h>

#include "cases/groups.h"
#include "internal.h"

/* clang-format off */
static const struct case_group *const all_groups[SELFTEST_GROUPS] = {
    &functions_group,
    &geometry_group,
    &numbers_group,
    &garbage_group,
    &sizes_group,
    &time_group,
    &invariance_group,
};
/* clang-format on */

static bool is_selected(const char *const *only, const struct case_group *group, const struct glint_selftest_case *c) {
    for (size_t i = 0; only && only[i]; i++)
        if (strcasestr(c->name, only[i]) || strcasestr(group->name, only[i]) || strcasestr(c->what, only[i]) ||
            (c->source && strcasestr(c->source, only[i])))
            return true;
    return !only || !only[0];
}

static bool select_cases(struct selected_group *s, const struct case_group *group, const char *const *only,
                         struct glint_error *err) {
    const size_t count = group->count();
    *s = (struct selected_group){.group = group,
                                 .selected = calloc(count, sizeof *s->selected),
                                 .findings = calloc(count, sizeof *s->findings),
                                 .shown = calloc(count, sizeof *s->shown),
                                 .shown_findings = calloc(count, sizeof *s->shown_findings)};
    if (!s->selected || !s->findings || !s->shown || !s->shown_findings)
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    s->public = (struct glint_selftest_group){group->name, group->what, 0, s->shown, s->shown_findings, 0};
    for (size_t i = 0; i < count; i++) {
        const struct glint_selftest_case c = group->get(i);
        if ((s->selected[i] = is_selected(only, group, &c))) s->shown[s->public.count++] = c;
    }
    return true;
}

struct glint_selftest *glint_selftest_create(const char *const *only, struct glint_error *err) {
    struct glint_selftest *selftest = calloc(1, sizeof *selftest);
    size_t count = 0;
    bool ok = selftest || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t g = 0; ok && g < SELFTEST_GROUPS; g++) {
        ok = select_cases(&selftest->groups[g], all_groups[g], only, err);
        count += selftest->groups[g].public.count;
    }
    if (ok && count) return selftest;
    if (ok) glint_fail(err, GLINT_ERROR_USAGE, "%s: no case has that in its name or claim", only[0]);
    glint_selftest_destroy(&selftest);
    return NULL;
}

void glint_selftest_destroy(struct glint_selftest **selftest) {
    for (size_t g = 0; *selftest && g < SELFTEST_GROUPS; g++) {
        struct selected_group *s = &(*selftest)->groups[g];
        free(s->selected), free(s->findings), free(s->shown), free(s->shown_findings);
    }
    free(*selftest);
    *selftest = NULL;
}

size_t glint_selftest_group_count(const struct glint_selftest *selftest) {
    (void)selftest;
    return SELFTEST_GROUPS;
}

const struct glint_selftest_group *glint_selftest_get_group(const struct glint_selftest *selftest, size_t index) {
    return &selftest->groups[index].public;
}

const struct glint_device_info *glint_selftest_device(const struct glint_selftest *selftest) {
    return &selftest->device;
}

bool glint_selftest_passes(const struct glint_selftest_case *c, const struct glint_selftest_finding *finding) {
    return finding->values > 0 && finding->worst <= c->bound;
}
