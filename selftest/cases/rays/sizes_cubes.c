/* Cube maps of any size: a room, ray by ray. */
#include "cases/rays/cube_rays.h"
#include "cases/rays/rays_lists.h"

/* number: the width of a face. Pictures are smaller where rays take more steps. */
static void check_face_size(struct case_run *run, const struct replay_case *c, const struct march_rules *rules,
                            struct glint_selftest_finding *finding) {
    const uint32_t size = (uint32_t)c->number;
    const struct cube_rays task = {.rules = rules,
                                   .bound = c->bound,
                                   .rays = RAYS_ANY,
                                   .depths_m = {0.2, 1.5},
                                   .width = size > 100 ? 23 : 61,
                                   .height = size > 100 ? 13 : 37,
                                   .cube_size = size,
                                   .cube_count = size > 1000 || !rules ? 1 : CUBES_MOST,
                                   .distance = room_distance};
    run->half = true;
    case_run_pipeline(run, c->use);
    cube_rays(run, &task, 1, finding);
}

static void check_march(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    check_face_size(run, c, &march_rules_default, finding);
}

static void check_exact(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    check_face_size(run, c, NULL, finding);
}

/* clang-format off */
#define MARCH(text, size, slow) {"faces of " text ", marched", "a room, from all over it, in four cube maps; one of 2048", CUBE_UNIT, 5e-6, CUBE_REASON, check_march, CUBE_MARCH CUBE_ALONE, size, slow}
#define EXACT(text, size, slow) {"faces of " text ", exactly", "a room, from all over it, in one cube map", CUBE_UNIT, 5e-6, CUBE_REASON, check_exact, CUBE_EXACT CUBE_ALONE, size, slow}
static const struct replay_case items[] = {
    MARCH("1", 1, false), MARCH("2", 2, false), MARCH("17", 17, false), MARCH("65", 65, true), MARCH("72", 72, true), MARCH("512", 512, true), MARCH("2048", 2048, true),
    EXACT("17", 17, false), EXACT("33", 33, true), EXACT("48", 48, true), EXACT("56", 56, true), EXACT("64", 64, true), EXACT("65", 65, true),
    EXACT("72", 72, true), EXACT("80", 80, true), EXACT("512", 512, true), EXACT("2048", 2048, true),
};
/* clang-format on */

const struct replay_case_list sizes_cubes = {items, sizeof items / sizeof *items};
