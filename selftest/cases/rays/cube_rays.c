/* Rays through cube maps of distances, each compared with a replay in double precision. */
#include "cases/rays/cube_rays.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracles/depth_traversal.h"

/* The number of roundings that are tried. At a border between faces each sample of a march may be on either face. */
enum { WAYS = 24, WAYS_MARCHED = 1000 };
static const double direction_rounding = 5e-7, gap_rounding = 5e-7;

const double room_low[3] = {-2.5, -3, -4}, room_high[3] = {7.5, 3.4, 5};
const double room_centers[CUBES_MOST][3] = {{3.108, -0.356, -0.06}, {-1.1, -1.2, -2}, {5.3, 1.1, 2.1}, {1.4, 2, 3.3}};

double room_distance(uint32_t number, const double d[3]) {
    const double *from = room_centers[number];
    double t = INFINITY;
    for (int k = 0; k < 3; k++)
        if (d[k] != 0) t = fmin(t, ((d[k] > 0 ? room_high[k] : room_low[k]) - from[k]) / d[k]);
    return t;
}

/* ---- Inputs and results of a run ---- */

struct traced {
    uint32_t width, height;
    float *travelled, *start_m, *depth_m, *normal;
    uint32_t *place, *end, *steps, *best, *finished;
    struct depth_grid grid;
    struct cubes cubes;
};

static bool cubes_get(struct cubes *cubes, struct case_run *run, struct glint_capture *capture) {
    static const char *const channels[1] = {"distance.Z"};
    uint32_t count = 0, longest = 0;
    uint32_t *index = case_run_uints(run, "active_index", &count, NULL),
             *chain = case_run_uints(run, "active_chain", &longest, NULL);
    cubes->count = count;
    cubes->longest = longest;
    for (uint32_t i = 0; run->ok && i < count && i < CUBES_MOST; i++) {
        char name[32];
        snprintf(name, sizeof name, "cubemap.%03u", index[i]);
        const struct glint_part_info *part = glint_capture_find(capture, name);
        cubes->size = part->width;
        cubes->maps[i] = part->cubemap;
        for (int k = 0; k < 3; k++) cubes->center[i][k] = part->cubemap.center[k] - plane_scene_eye[k];
        for (uint32_t k = 0; k < longest; k++) cubes->chain[i][k] = chain[i * longest + k];
        cubes->distance_m[i] = malloc((size_t)part->width * part->height * sizeof(float));
        if (!cubes->distance_m[i]) run->ok = glint_fail(run->err, GLINT_ERROR_MEMORY, "out of memory");
        run->ok =
            run->ok && glint_capture_read(capture, part, channels, 1, GLINT_F32, cubes->distance_m[i], 0, run->err);
    }
    cubes->has_sky = glint_capture_find(capture, "sky") != NULL;
    free(index);
    free(chain);
    return run->ok;
}

static bool traced_get(struct traced *t, struct case_run *run) {
    t->travelled = case_run_floats(run, "travelled", &t->width, &t->height);
    t->start_m = case_run_floats(run, "screen_travelled", NULL, NULL);
    t->depth_m = case_run_floats(run, "depth_half", NULL, NULL);
    t->normal = case_run_floats(run, "normal_jittered", NULL, NULL);
    t->place = case_run_uints(run, "cubemap_index", NULL, NULL);
    t->end = case_run_uints(run, "cubemap_end", NULL, NULL);
    t->steps = case_run_uints(run, "cubemap_steps", NULL, NULL);
    t->best = case_run_uints(run, "cubemap_best", NULL, NULL);
    t->finished = case_run_uints(run, "screen_finished", NULL, NULL);
    if (!run->ok || !cubes_get(&t->cubes, run, run->capture)) return false;
    depth_grid_init(&t->grid, glint_capture_frame(run->capture), t->width, t->height, t->depth_m, t->normal);
    return true;
}

static void traced_free(struct traced *t) {
    void *const all[] = {t->travelled, t->start_m, t->depth_m, t->normal,  t->place,
                         t->end,       t->steps,   t->best,    t->finished};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    for (size_t i = 0; i < CUBES_MOST; i++) free(t->cubes.distance_m[i]);
}

/* ---- Comparison ---- */

/* Rounding 0 is the exact one. */
static struct cube_end reference_end(const struct cube_rays *task, const struct traced *traced,
                                     const struct depth_ray *ray, uint32_t i, uint32_t way) {
    const struct depth_ray rounded = depth_ray_rounded(ray, way ? direction_rounding : 0, way);
    struct cubes cubes = traced->cubes;
    struct cube_ray world = {.start_m = (double)traced->start_m[i], .best = traced->best[i], .rough = task->rough};
    cubes.rounding = way ? gap_rounding : 0;
    cubes.way = way;
    for (int k = 0; k < 3; k++)
        for (int r = 0; r < 3; r++) { /* the rows are the camera's axes */
            world.origin[k] += traced->grid.rows[r][k] * rounded.origin[r];
            world.direction[k] += traced->grid.rows[r][k] * rounded.direction[r];
        }
    const double found = (double)traced->travelled[i];
    return task->rules ? cube_march(&cubes, &world, task->rules)
                       : cube_exact(&cubes, &world, found, task->bound * (1 + found));
}

static double distance_error(double a, double b) {
    return a == b ? 0 : fabs(a - b) / (1 + fmin(fabs(a), fabs(b)));
}

static bool is_same_end(const struct cube_end *a, const struct cube_end *b, bool steps) {
    return a->place == b->place && a->reason == b->reason && (!steps || a->steps == b->steps);
}

static double error_beyond_rounding(const struct cube_rays *task, const struct traced *traced,
                                    const struct depth_ray *ray, uint32_t i, const struct cube_end *found) {
    const uint32_t ways = task->rules ? WAYS_MARCHED : WAYS;
    double low = INFINITY, high = -INFINITY;
    for (uint32_t way = 1; way <= ways && !(low <= found->t && found->t <= high); way++) {
        const struct cube_end other = reference_end(task, traced, ray, i, way);
        if (!is_same_end(&other, found, task->rules)) continue;
        low = fmin(low, other.t);
        high = fmax(high, other.t);
    }
    return low <= high ? distance_error(found->t, fmin(fmax(found->t, low), high)) : INFINITY;
}

/* The difference between the distances of the selected centre and of the nearest one from the start of the ray. */
static double farther(const struct traced *traced, const struct depth_ray *ray, uint32_t i) {
    double selected = INFINITY, least = INFINITY;
    for (uint32_t n = 0; n < traced->cubes.count; n++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            double at = -traced->cubes.center[n][k];
            for (int r = 0; r < 3; r++)
                at += traced->grid.rows[r][k] * (ray->origin[r] + (double)traced->start_m[i] * ray->direction[r]);
            sum += at * at;
        }
        least = fmin(least, sqrt(sum));
        if (n == traced->best[i]) selected = sqrt(sum);
    }
    return selected - least;
}

static void check_ray(const struct cube_rays *task, const struct traced *traced, uint32_t i,
                      struct glint_selftest_finding *finding) {
    const uint32_t x = i % traced->width, y = i / traced->width;
    const struct cube_end found = {(double)traced->travelled[i], traced->place[i], traced->end[i], traced->steps[i]};
    struct cube_end expected = {(double)traced->start_m[i], CUBES_NO_PLACE, END_not_traced, 0};
    struct depth_ray ray;
    const bool has_ray = depth_ray_init(&ray, &traced->grid, x, y) && !traced->finished[i];
    if (has_ray && traced->best[i] >= traced->cubes.count) {
        finding_compare(finding, INFINITY, "pixel %u,%u: cube map %u is chosen of %u", x, y, traced->best[i],
                        traced->cubes.count);
        return;
    }
    if (has_ray) expected = reference_end(task, traced, &ray, i, 0);
    double error = is_same_end(&found, &expected, task->rules) ? distance_error(found.t, expected.t) : INFINITY;
    if (has_ray && !(error <= task->bound)) {
        const double beyond = error_beyond_rounding(task, traced, &ray, i, &found);
        finding->ties += !is_same_end(&found, &expected, task->rules) && beyond <= task->bound;
        error = fmin(error, beyond);
    }
    if (has_ray && !(farther(traced, &ray, i) <= 1e-5)) error = INFINITY;
    finding_compare(finding, error,
                    "pixel %u,%u: %s in cube map %u at %.9g m, step %u; expected %s in %u at %.9g m, step %u", x, y,
                    end_reason_name(found.reason), found.place, found.t, found.steps, end_reason_name(expected.reason),
                    expected.place, expected.t, expected.steps);
}

static struct glint_cubemap cube_at(uint32_t number, enum glint_volume volume) {
    struct glint_cubemap cube = {.inner = volume};
    for (int k = 0; k < 3; k++) {
        const double c = cube.center[k] = room_centers[number][k];
        cube.box_min[k] = room_low[k] + 0.2 - c;
        cube.box_max[k] = room_high[k] - 0.2 - c;
    }
    cube.sphere_radius = 1.3;
    cube.sphere_center[0] = 0.2;
    /* A hull between two planes parallel to the screen, 0.75 m and 1.5 m in front of the camera, where surfaces are, 6 m wide. */
    static const double axes[3][3] = {{-0.36, -0.48, -0.8}, {0.48, 0.64, -0.6}, {-0.8, 0.6, 0}};
    static const double ends[3][2] = {{0.75, 1.5}, {-3, 3}, {-3, 3}};
    for (int i = 0; i < 6; i++) {
        const double *axis = axes[i / 2], sign = i % 2 ? 2 : -1; /* one axis of length 2 */
        for (int k = 0; k < 3; k++) {
            cube.planes[i][k] = sign * axis[k];
            cube.planes[i][3] += sign * axis[k] * (room_centers[number][k] - plane_scene_eye[k]);
        }
        cube.planes[i][3] -= sign * ends[i / 2][i % 2];
    }
    cube.plane_count = 6;
    return cube;
}

static struct plain picture_of(const struct cube_rays *task, const struct plane_scene *scene) {
    struct plain plain = plane_scene_capture(scene, task->width, task->height);
    plain.cube_size = task->cube_size;
    plain.cube_count = task->cube_count;
    plain.cube = task->cube;
    plain.distance = task->distance;
    plain.sky = task->sky;
    for (uint32_t i = 0; i < plain.cube_count; i++) plain.cubes[i] = cube_at(i, task->volume);
    return plain;
}

void cube_rays(struct case_run *run, const struct cube_rays *task, uint32_t seeds,
               struct glint_selftest_finding *finding) {
    struct plane_scene scene = {.rays = task->rays, .roughness = task->rough};
    memcpy(scene.flat_m, task->depths_m, sizeof scene.flat_m);
    for (uint32_t seed = 1; seed <= seeds; seed++) {
        struct traced traced = {0};
        scene.seed = 1000 * seed;
        const struct plain plain = picture_of(task, &scene);
        case_run_plain(run, &plain);
        if (traced_get(&traced, run))
            for (uint32_t i = 0; i < traced.width * traced.height; i++) check_ray(task, &traced, i, finding);
        traced_free(&traced);
    }
}
