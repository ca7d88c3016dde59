/* Rays through the depth buffer in difficult directions and past difficult surfaces, each checked by screen_rays.c. */
#include "cases/rays/rays_lists.h"
#include "cases/rays/screen_rays.h"
#include "oracles/plane_scene.h"

enum { WIDE = 97, HIGH = 61 };
#define LINEAR SCREEN_TRACED "linear screen_trace.dither=false"
/* For a ray within its own surface, rounding decides on which side it is. */
#define EITHER_SIDE LINEAR " screen_trace.back_faces=false"

static void check_rays(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    for (uint32_t seed = 1; seed <= (run->context->quick ? 1 : 3); seed++) {
        const struct plane_scene scene = {.rays = (enum plane_scene_rays)c->number, .seed = 1000 * seed};
        const struct plain plain = plane_scene_capture(&scene, WIDE, HIGH);
        screen_rays(run, &plain, c, 1, finding);
    }
}

static void check_rails(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    const struct plane_scene scene = {.rays = (enum plane_scene_rays)c->number, .rails = true, .seed = 1};
    struct plain plain = plane_scene_capture(&scene, WIDE, HIGH);
    for (int frame = 0; frame < (run->context->quick ? 2 : 6); frame++) {
        plain.jitter_px[0] = frame / 6.0 - 0.45;
        plain.jitter_px[1] = 0.45 - frame / 7.0;
        screen_rays(run, &plain, c, 1, finding);
    }
}

/* All depths from half of the near plane's on, in adjacent pixels. */
static void check_near(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    const struct plane_scene scene = {.rays = (enum plane_scene_rays)c->number, .seed = 1, .flat_m = {0.05, 0.5}};
    const struct plain plain = plane_scene_capture(&scene, WIDE, HIGH);
    screen_rays(run, &plain, c, 1, finding);
}

static void check_stipples(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    const struct plane_scene scene = {.rays = (enum plane_scene_rays)c->number, .stipples = true, .seed = 1};
    const struct plain plain = plane_scene_capture(&scene, WIDE, HIGH);
    screen_rays(run, &plain, c, 1, finding);
}

/* clang-format off */
#define UNIT SCREEN_UNIT
#define REASON SCREEN_REASON
#define THICK " screen_trace.thickness=0.2 screen_trace.thickness_m=0.1 screen_trace.seam=0.3 screen_trace.jump=0.1 screen_trace.solid=0.4 screen_trace.bias=0.01"
#define SHORT " screen_trace.length_m=3 screen_trace.pass_behind=false screen_trace.sky=false"
#define TWO(name, what, check, rays) \
    {name ", texel by texel",    what, UNIT, 5e-6, REASON, check, SCREEN_DDA,    rays, false}, \
    {name ", in a pyramid",      what, UNIT, 5e-6, REASON, check, SCREEN_HIZ,    rays, false}
#define THREE(name, what, check, rays) TWO(name, what, check, rays), \
    {name ", in steps",          what, UNIT, 5e-6, REASON, check, LINEAR, rays, false}

static const struct replay_case items[] = {
    THREE("mirror rays",            "from boards at all angles: where and why each ends",              check_rays, RAYS_MIRROR),
    THREE("rays of every direction", "between boards at all angles: where and why each ends",          check_rays, RAYS_ANY),
    THREE("rays along axes",        "of the view, in both directions",                                 check_rays, RAYS_AXES),
    THREE("rays parallel to the screen", "depth does not change along them",                           check_rays, RAYS_PARALLEL),
    THREE("rays to the camera",     "they return towards the camera, to the near plane",        check_rays, RAYS_BACK),
    TWO("rays along the view",      "the normal is at right angles to it: they stay in their pixel",   check_rays, RAYS_ON),
    {"rays along the view, in steps", "they stay in their pixel", UNIT, 5e-6, REASON, check_rays, EITHER_SIDE, RAYS_ON, false},
    THREE("grazing rays",           "cosines of 1e-1 to 1e-7 between normal and view",                 check_rays, RAYS_GRAZING),
    THREE("rays past the camera",   "they cross the near plane",                                       check_rays, RAYS_NEAR),
    THREE("from before the near plane", "surfaces from half of its distance on",               check_near, RAYS_ANY),
    {"thick surfaces, texel by texel", "with different thickness, seam, jump and bias",      UNIT, 5e-6, REASON, check_rays, SCREEN_DDA THICK, RAYS_ANY, false},
    {"thick surfaces, in a pyramid", "the same",                                               UNIT, 5e-6, REASON, check_rays, SCREEN_HIZ THICK, RAYS_ANY, false},
    {"short rays, texel by texel",   "they end after 3 m, or behind the first surface",        UNIT, 5e-6, REASON, check_rays, SCREEN_DDA SHORT, RAYS_ANY, false},
    {"short rays, in a pyramid",     "the same",                                               UNIT, 5e-6, REASON, check_rays, SCREEN_HIZ SHORT, RAYS_ANY, false},
    {"short rays, in steps",         "they end after 3 m, or continue behind objects, in equal steps", UNIT, 5e-6, REASON, check_rays, LINEAR " screen_trace.length_m=3 screen_trace.pass_behind=true screen_trace.growth=1 screen_trace.sky=false", RAYS_ANY, false},
    {"plain steps",                  "nearest texels, without refinement",      UNIT, 5e-6, REASON, check_rays, LINEAR " screen_trace.interpolate=false screen_trace.refine=false screen_trace.verify=false screen_trace.thickness=0.2 screen_trace.bias=0.01 screen_trace.steps=20", RAYS_ANY, false},
    THREE("rails",                  "a pixel wide, under moves of parts of a pixel",                   check_rails, RAYS_ANY),
    THREE("stippled depth",         "checks, columns and rows of two depths",                          check_stipples, RAYS_ANY),
};
/* clang-format on */

const struct replay_case_list geometry_screen = {items, sizeof items / sizeof *items};
