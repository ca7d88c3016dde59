/* Compares every ray of a picture through the depth buffer with a replay in double precision (depth_traversal.h, depth_march.h) of the depths and
   normals that the pass read. If a decision differs, the replay is repeated with its ray and its gaps rounded in other ways: a decision that one of
   these makes, too, was a tie, which is counted; otherwise the case fails. */
#include "cases/rays/screen_rays.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracles/depth_march.h"
#include "oracles/depth_traversal.h"

enum { ROUNDINGS = 24 };
static const double direction_rounding = 5e-7, gap_rounding = 1e-6;

/* The results of the rays. */
struct traced {
    uint32_t width, height;
    float *travelled, *depth_m, *normal;
    uint32_t *finished, *end;
    struct depth_grid grid;
    bool stepped; /* not texel by texel */
    struct depth_march_rules steps;
    struct traversal_rules walk;
};

static bool traced_get(struct traced *traced, struct case_run *run) {
    traced->travelled = case_run_floats(run, "screen_travelled", &traced->width, &traced->height);
    traced->finished = case_run_uints(run, "screen_finished", NULL, NULL);
    traced->end = case_run_uints(run, "screen_end", NULL, NULL);
    traced->depth_m = case_run_floats(run, "depth_half", NULL, NULL);
    traced->normal = case_run_floats(run, "normal_jittered", NULL, NULL);
    if (run->ok)
        depth_grid_init(&traced->grid, glint_capture_frame(run->capture), traced->width, traced->height,
                        traced->depth_m, traced->normal);
    return run->ok;
}

static void traced_free(struct traced *traced) {
    free(traced->travelled);
    free(traced->finished);
    free(traced->end);
    free(traced->depth_m);
    free(traced->normal);
}

/* A replay; path 0 is exact, the others round differently. */
static uint32_t reference_end(const struct traced *traced, const struct depth_ray *ray, uint32_t way, double *t) {
    const struct depth_ray rounded = depth_ray_rounded(ray, way ? direction_rounding : 0, way);
    struct depth_grid grid = traced->grid;
    grid.rounding = way ? gap_rounding : 0;
    grid.way = way;
    return traced->stepped ? depth_march_end(&grid, &rounded, &traced->steps, t)
                           : traversal_end(&grid, &rounded, &traced->walk, t);
}

/* The distance between two ends of a ray: as a fraction of the picture's width, or of the start's inverse depth. */
static double end_error(const struct depth_grid *grid, const struct depth_ray *ray, double a, double b) {
    double p[2], q[2], z[2];
    if (a == b) return 0;
    if (!(a < 3e38) || !(b < 3e38)) return INFINITY;
    if (!depth_ray_project(grid, ray, a, p, &z[0]) || !depth_ray_project(grid, ray, b, q, &z[1])) return INFINITY;
    const double start = fmin(fabs(ray->origin[2]), fmin(z[0], z[1]));
    return fmax(hypot(p[0] - q[0], p[1] - q[1]) / grid->width, fabs(1 / z[0] - 1 / z[1]) * start);
}

/* How far the ray ended outside of the interval that differently rounded replays with the same end reason span; infinite if there are none. */
static double error_beyond_rounding(const struct traced *traced, const struct depth_ray *ray, uint32_t reason,
                                    double t) {
    double low = INFINITY, high = -INFINITY, found;
    for (uint32_t way = 1; way <= ROUNDINGS && !(low <= t && t <= high); way++) {
        if (reference_end(traced, ray, way, &found) != reason) continue;
        low = fmin(low, found);
        high = fmax(high, found);
    }
    if (!(low <= high)) return INFINITY;
    return t < low ? end_error(&traced->grid, ray, t, low) : t > high ? end_error(&traced->grid, ray, t, high) : 0;
}

static void check_ray(const struct traced *traced, uint32_t i, double bound, struct glint_selftest_finding *finding) {
    const uint32_t x = i % traced->width, y = i / traced->width, reason = traced->end[i];
    const double t = (double)traced->travelled[i];
    struct depth_ray ray;
    double expected = 0;
    uint32_t because = END_not_traced;
    const bool has_ray = depth_ray_init(&ray, &traced->grid, x, y);
    if (has_ray) because = reference_end(traced, &ray, 0, &expected);
    double error = reason != because ? INFINITY : !has_ray ? t : end_error(&traced->grid, &ray, t, expected);
    if (has_ray && !(error <= bound)) {
        const double beyond = error_beyond_rounding(traced, &ray, reason, t);
        finding->ties += reason != because && beyond <= bound;
        error = fmin(error, beyond);
    }
    if ((traced->finished[i] != 0) != (reason == END_hit || reason == END_sky)) error = INFINITY;
    finding_compare(finding, error, "pixel %u,%u: %s at %.9g m, expected %s at %.9g m", x, y, end_reason_name(reason),
                    t, end_reason_name(because), expected);
}

/* The value of a parameter in the settings of a case. */
static double parameter_of(const char *words, const char *name, double otherwise) {
    char setting[64];
    snprintf(setting, sizeof setting, "screen_trace.%s=", name);
    const char *at = strstr(words, setting);
    if (!at) return otherwise;
    at += strlen(setting);
    return *at == 't' ? 1 : *at == 'f' ? 0 : strtod(at, NULL);
}

static struct traversal_rules traversal_rules_of(const char *words) {
    const struct traversal_rules r = traversal_rules_default;
    return (struct traversal_rules){parameter_of(words, "thickness", r.thickness),
                                    parameter_of(words, "thickness_m", r.thickness_m),
                                    parameter_of(words, "seam", r.seam),
                                    parameter_of(words, "jump", r.jump),
                                    parameter_of(words, "solid", r.solid),
                                    parameter_of(words, "bias", r.bias),
                                    parameter_of(words, "length_m", r.length_m),
                                    parameter_of(words, "sky", r.sky) > 0,
                                    parameter_of(words, "pass_behind", r.pass_behind) > 0};
}

static struct depth_march_rules depth_march_rules_of(const char *words) {
    const struct depth_march_rules r = depth_march_rules_default;
    return (struct depth_march_rules){(uint32_t)parameter_of(words, "steps", r.steps),
                                      parameter_of(words, "growth", r.growth),
                                      parameter_of(words, "thickness", r.thickness),
                                      parameter_of(words, "bias", r.bias),
                                      parameter_of(words, "length_m", r.length_m),
                                      parameter_of(words, "pass_behind", r.pass_behind) > 0,
                                      parameter_of(words, "back_faces", r.back_faces) > 0,
                                      parameter_of(words, "interpolate", r.interpolate) > 0,
                                      parameter_of(words, "refine", r.refine) > 0,
                                      parameter_of(words, "verify", r.verify) > 0,
                                      parameter_of(words, "sky", r.sky) > 0};
}

void screen_rays(struct case_run *run, const struct plain *plain, const struct replay_case *c, uint32_t stride,
                 struct glint_selftest_finding *finding) {
    struct traced traced = {
        .stepped = strstr(c->use, "linear"), .steps = depth_march_rules_of(c->use), .walk = traversal_rules_of(c->use)};
    case_run_pipeline(run, c->use);
    case_run_plain(run, plain);
    if (traced_get(&traced, run))
        for (uint32_t i = 0; i < traced.width * traced.height; i += stride) check_ray(&traced, i, c->bound, finding);
    traced_free(&traced);
}
