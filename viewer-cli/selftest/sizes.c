/* The group "sizes": pictures and cube maps as small and as large as any, and odd ones. */
#include "sizes.h"

static const struct trial_list *const lists[] = {&sizes_screen, &sizes_cubes};
enum { LISTS = sizeof lists / sizeof *lists };

static size_t count(void) {
    return trial_count(lists, LISTS);
}
static struct selftest_case get(size_t i) {
    return trial_get(lists, i);
}
static bool run(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,
                struct glint_error *err) {
    return trial_cases(lists, LISTS, test, chosen, findings, err);
}

const struct selftest_group selftest_sizes = {"sizes", "pictures and cube maps of any size", count, get, run};
