/* The group "geometry": rays that are hard on arithmetic, against closed forms and replays in double precision. */
#include "geometry.h"

static const struct trial_list *const lists[] = {&geometry_surfaces, &geometry_screen, &geometry_cubes,
                                                 &geometry_hulls};
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

const struct selftest_group selftest_geometry = {"geometry", "rays that are hard on arithmetic", count, get, run};
