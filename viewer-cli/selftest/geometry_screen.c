/* Rays through the depth buffer, every one of a picture against a replay in double precision (walk.h, stepped.h) of the depths
   and normals that the pass read. Where the two part on a decision, the replay is made again with its ray and its gaps rounded
   in other ways: a decision that one of these makes too was a tie, which is counted; otherwise the case fails. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clutter.h"
#include "geometry.h"
#include "screen_rays.h"
#include "stepped.h"
#include "walk.h"

enum { WIDE = 97, HIGH = 61, WAYS = 24 };
#define LINEAR SCREEN_TRACED "linear screen_trace.dither=false"
/* Which side of its own surface a ray that runs within it sees, rounding says. */
#define EITHER_SIDE LINEAR " screen_trace.back_faces=false"

static const double direction_rounding = 5e-7, gap_rounding = 1e-6;

/* What became of the rays. */
struct traced {
    uint32_t width, height;
    float *travelled, *depth_m, *normal;
    uint32_t *finished, *end;
    struct walk_grid grid;
    bool stepped; /* not texel by texel */
    struct step_rules steps;
    struct walk_rules walk;
};

static bool traced_get(struct traced *traced, struct trial *trial) {
    traced->travelled = trial_floats(trial, "screen_travelled", &traced->width, &traced->height);
    traced->finished = trial_uints(trial, "screen_finished", NULL, NULL);
    traced->end = trial_uints(trial, "screen_end", NULL, NULL);
    traced->depth_m = trial_floats(trial, "depth_half", NULL, NULL);
    traced->normal = trial_floats(trial, "normal_jittered", NULL, NULL);
    if (trial->ok)
        walk_grid_init(&traced->grid, glint_capture_frame(trial->capture), traced->width, traced->height,
                       traced->depth_m, traced->normal);
    return trial->ok;
}

static void traced_free(struct traced *traced) {
    free(traced->travelled);
    free(traced->finished);
    free(traced->end);
    free(traced->depth_m);
    free(traced->normal);
}

/* One replay; way 0 is the exact one. */
static uint32_t replayed(const struct traced *traced, const struct walk_ray *ray, uint32_t way, double *t) {
    const struct walk_ray rounded = walk_ray_rounded(ray, way ? direction_rounding : 0, way);
    struct walk_grid grid = traced->grid;
    grid.rounding = way ? gap_rounding : 0;
    grid.way = way;
    return traced->stepped ? stepped_end(&grid, &rounded, &traced->steps, t)
                           : walk_end(&grid, &rounded, &traced->walk, t);
}

/* How far apart two ends of a ray are in the picture: parts of its width, or of the start's inverse depth. */
static double apart(const struct walk_grid *grid, const struct walk_ray *ray, double a, double b) {
    double p[2], q[2], z[2];
    if (a == b) return 0;
    if (!(a < 3e38) || !(b < 3e38)) return INFINITY;
    if (!walk_project(grid, ray, a, p, &z[0]) || !walk_project(grid, ray, b, q, &z[1])) return INFINITY;
    const double start = fmin(fabs(ray->origin[2]), fmin(z[0], z[1]));
    return fmax(hypot(p[0] - q[0], p[1] - q[1]) / grid->width, fabs(1 / z[0] - 1 / z[1]) * start);
}

/* Of replays that are rounded in other ways and end for the same reason, how far outside of what they span the ray ended;
   infinite: none does. */
static double outside(const struct traced *traced, const struct walk_ray *ray, uint32_t reason, double t) {
    double low = INFINITY, high = -INFINITY, found;
    for (uint32_t way = 1; way <= WAYS && !(low <= t && t <= high); way++) {
        if (replayed(traced, ray, way, &found) != reason) continue;
        low = fmin(low, found);
        high = fmax(high, found);
    }
    if (!(low <= high)) return INFINITY;
    return t < low ? apart(&traced->grid, ray, t, low) : t > high ? apart(&traced->grid, ray, t, high) : 0;
}

static void judge(const struct traced *traced, uint32_t i, double bound, struct selftest_finding *finding) {
    const uint32_t x = i % traced->width, y = i / traced->width, reason = traced->end[i];
    const double t = (double)traced->travelled[i];
    struct walk_ray ray;
    double expected = 0;
    uint32_t because = END_not_traced;
    const bool has_ray = walk_ray_init(&ray, &traced->grid, x, y);
    if (has_ray) because = replayed(traced, &ray, 0, &expected);
    double error = reason != because ? INFINITY : !has_ray ? t : apart(&traced->grid, &ray, t, expected);
    if (has_ray && !(error <= bound)) {
        const double beyond = outside(traced, &ray, reason, t);
        finding->ties += reason != because && beyond <= bound;
        error = fmin(error, beyond);
    }
    if ((traced->finished[i] != 0) != (reason == END_hit || reason == END_sky)) error = INFINITY;
    compared(finding, error, "pixel %u,%u: %s at %.9g m, expected %s at %.9g m", x, y, end_name(reason), t,
             end_name(because), expected);
}

/* A parameter as the words of a case set it. */
static double value(const char *words, const char *name, double otherwise) {
    char setting[64];
    snprintf(setting, sizeof setting, "screen_trace.%s=", name);
    const char *at = strstr(words, setting);
    if (!at) return otherwise;
    at += strlen(setting);
    return *at == 't' ? 1 : *at == 'f' ? 0 : strtod(at, NULL);
}

static struct walk_rules walk_rules_of(const char *words) {
    const struct walk_rules r = walk_rules_default;
    return (struct walk_rules){value(words, "thickness", r.thickness),
                               value(words, "thickness_m", r.thickness_m),
                               value(words, "seam", r.seam),
                               value(words, "jump", r.jump),
                               value(words, "solid", r.solid),
                               value(words, "bias", r.bias),
                               value(words, "length_m", r.length_m),
                               value(words, "sky", r.sky) > 0,
                               value(words, "pass_behind", r.pass_behind) > 0};
}

static struct step_rules step_rules_of(const char *words) {
    const struct step_rules r = step_rules_default;
    return (struct step_rules){(uint32_t)value(words, "steps", r.steps),
                               value(words, "growth", r.growth),
                               value(words, "thickness", r.thickness),
                               value(words, "bias", r.bias),
                               value(words, "length_m", r.length_m),
                               value(words, "pass_behind", r.pass_behind) > 0,
                               value(words, "back_faces", r.back_faces) > 0,
                               value(words, "interpolate", r.interpolate) > 0,
                               value(words, "refine", r.refine) > 0,
                               value(words, "verify", r.verify) > 0,
                               value(words, "sky", r.sky) > 0};
}

void screen_rays(struct trial *trial, const struct plain *plain, const struct trial_case *c, uint32_t stride,
                 struct selftest_finding *finding) {
    struct traced traced = {
        .stepped = strstr(c->use, "linear"), .steps = step_rules_of(c->use), .walk = walk_rules_of(c->use)};
    trial_use(trial, c->use);
    trial_run(trial, plain);
    if (traced_get(&traced, trial))
        for (uint32_t i = 0; i < traced.width * traced.height; i += stride) judge(&traced, i, c->bound, finding);
    traced_free(&traced);
}

/* ---- Cases ---- */

static void check_rays(struct trial *trial, const struct trial_case *c, struct selftest_finding *finding) {
    for (uint32_t seed = 1; seed <= (trial->test->quick ? 1 : 3); seed++) {
        const struct clutter clutter = {.rays = (enum clutter_rays)c->number, .seed = 1000 * seed};
        const struct plain plain = clutter_capture(&clutter, WIDE, HIGH);
        screen_rays(trial, &plain, c, 1, finding);
    }
}

static void check_rails(struct trial *trial, const struct trial_case *c, struct selftest_finding *finding) {
    const struct clutter clutter = {.rays = (enum clutter_rays)c->number, .rails = true, .seed = 1};
    struct plain plain = clutter_capture(&clutter, WIDE, HIGH);
    for (int frame = 0; frame < (trial->test->quick ? 2 : 6); frame++) {
        plain.jitter_px[0] = frame / 6.0 - 0.45;
        plain.jitter_px[1] = 0.45 - frame / 7.0;
        screen_rays(trial, &plain, c, 1, finding);
    }
}

/* All depths from half of the near plane's on, pixel beside pixel. */
static void check_near(struct trial *trial, const struct trial_case *c, struct selftest_finding *finding) {
    const struct clutter clutter = {.rays = (enum clutter_rays)c->number, .seed = 1, .flat_m = {0.05, 0.5}};
    const struct plain plain = clutter_capture(&clutter, WIDE, HIGH);
    screen_rays(trial, &plain, c, 1, finding);
}

static void check_stipples(struct trial *trial, const struct trial_case *c, struct selftest_finding *finding) {
    const struct clutter clutter = {.rays = (enum clutter_rays)c->number, .stipples = true, .seed = 1};
    const struct plain plain = clutter_capture(&clutter, WIDE, HIGH);
    screen_rays(trial, &plain, c, 1, finding);
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

static const struct trial_case items[] = {
    THREE("mirror rays",            "from boards at all angles: where and why each ends",              check_rays, RAYS_MIRROR),
    THREE("rays of every direction", "between boards at all angles: where and why each ends",          check_rays, RAYS_ANY),
    THREE("rays along axes",        "of the view, both ways",                                          check_rays, RAYS_AXES),
    THREE("rays parallel to the screen", "depth does not change along them",                           check_rays, RAYS_PARALLEL),
    THREE("rays to the camera",     "they go back where the view came from, to the near plane",        check_rays, RAYS_BACK),
    TWO("rays along the view",      "the normal is at right angles to it: they stay in their pixel",   check_rays, RAYS_ON),
    {"rays along the view, in steps", "they stay in their pixel", UNIT, 5e-6, REASON, check_rays, EITHER_SIDE, RAYS_ON, false},
    THREE("grazing rays",           "cosines of 1e-1 to 1e-7 between normal and view",                 check_rays, RAYS_GRAZING),
    THREE("rays past the camera",   "they cross the near plane",                                       check_rays, RAYS_NEAR),
    THREE("from before the near plane", "surfaces from half of its distance on",               check_near, RAYS_ANY),
    {"thick surfaces, texel by texel", "all thicknesses, seams, jumps and biases others",      UNIT, 5e-6, REASON, check_rays, SCREEN_DDA THICK, RAYS_ANY, false},
    {"thick surfaces, in a pyramid", "the same",                                               UNIT, 5e-6, REASON, check_rays, SCREEN_HIZ THICK, RAYS_ANY, false},
    {"short rays, texel by texel",   "they end after 3 m, or behind what they come to",        UNIT, 5e-6, REASON, check_rays, SCREEN_DDA SHORT, RAYS_ANY, false},
    {"short rays, in a pyramid",     "the same",                                               UNIT, 5e-6, REASON, check_rays, SCREEN_HIZ SHORT, RAYS_ANY, false},
    {"short rays, in steps",         "they end after 3 m, or go on behind things, in even steps", UNIT, 5e-6, REASON, check_rays, LINEAR " screen_trace.length_m=3 screen_trace.pass_behind=true screen_trace.growth=1 screen_trace.sky=false", RAYS_ANY, false},
    {"plain steps",                  "nearest texels, the step that goes behind decides",      UNIT, 5e-6, REASON, check_rays, LINEAR " screen_trace.interpolate=false screen_trace.refine=false screen_trace.verify=false screen_trace.thickness=0.2 screen_trace.bias=0.01 screen_trace.steps=20", RAYS_ANY, false},
    THREE("rails",                  "a pixel wide, under moves of parts of a pixel",                   check_rails, RAYS_ANY),
    THREE("stippled depth",         "checks, columns and rows of two depths",                          check_stipples, RAYS_ANY),
};
/* clang-format on */

const struct trial_list geometry_screen = {items, sizeof items / sizeof *items};
