/* Light of the sun and of lamps that the fog scatters once, evenly in all directions, and absorbs nothing of. Each cell has one point in it and one
   shadow ray, to a light that is drawn by how much each adds there without shadows: noisy, as engines have it, but right on average. */
#include "froxels.h"

#include <stdlib.h>
#include <string.h>

#include "dump_part.h"
#include "noise.h"

enum { WIDE = 64, HIGH = 36, SLICES = 32, SUN = SCENE_MAX_LIGHTS };
static const double NEAR = 0.1, FAR = 64;

struct work {
    const struct world *world;
    const struct view *view;
    uint32_t seed; /* of the frame */
    vec3 *out;
};

static float density_at(const struct glint_fog *fog, double height) {
    return (float)(fog->density * (fog->scale_height > 0 ? exp(-(height - fog->base) / fog->scale_height) : 1));
}

/* What the fog leaves of light from a point in a direction of unit length, over a distance. */
static float passing(const struct glint_fog *fog, vec3 at, vec3 direction, double distance) {
    const double start = (double)density_at(fog, (double)at.y),
                 climb = fog->scale_height > 0 ? (double)direction.y / fog->scale_height : 0, fall = climb * distance;
    if (isinf(distance) && !(climb > 0)) return 0;
    const double depth = fabs(fall) < 1e-9 ? start * distance : start * -expm1(-fall) / climb;
    return (float)exp(-depth);
}

/* Of one light, without its shadow: the irradiance on a surface that faces it, and the way to it. */
static vec3 light_at(const struct scene *scene, uint32_t number, vec3 at, vec3 *way) {
    if (number == SUN) {
        *way = scene->sun_direction;
        return scale(scene->sun_irradiance, passing(&scene->fog, at, unit(*way), INFINITY));
    }
    const struct light *light = &scene->lights[number];
    *way = sub(light->position, at);
    const float square = dot(*way, *way), distance = sqrtf(square), ratio = square / (light->range * light->range);
    if (ratio >= 1 || !(distance > 0)) return gray(0);
    float factor = (1 - ratio) * (1 - ratio) / (square + 0.12f); /* as world_direct has it */
    if (light->cos_outer < 1) factor *= smooth(light->cos_outer, light->cos_inner, -dot(*way, light->axis) / distance);
    return scale(light->intensity, factor * passing(&scene->fog, at, unit(*way), (double)distance));
}

static bool shaded(const struct world *world, uint32_t number, vec3 at, vec3 way) {
    if (number == SUN) return world_blocked(world, at, way, INFINITY);
    const float radius = world_scene(world)->lights[number].radius;
    return world_blocked(world, at, way, 1 - radius / fmaxf(length(way), 2 * radius));
}

static vec3 scattered(const struct world *world, vec3 at, float random) {
    const struct scene *scene = world_scene(world);
    float bright[SCENE_MAX_LIGHTS + 1] = {0}, sum = 0;
    vec3 way;
    for (uint32_t i = 0; i <= SUN; i++)
        if (i == SUN || i < scene->light_count) sum += bright[i] = luminance(light_at(scene, i, at, &way));
    if (!(sum > 0)) return gray(0);
    uint32_t drawn = 0;
    float rest = random * sum;
    for (uint32_t i = 0; i <= SUN; i++) { /* the last one that adds anything, if rounding leaves a rest */
        if (!(bright[i] > 0)) continue;
        drawn = i;
        if ((rest -= bright[i]) < 0) break;
    }
    const vec3 light = light_at(scene, drawn, at, &way);
    if (shaded(world, drawn, at, way)) return gray(0);
    return scale(light, sum / bright[drawn] * scene->gain * density_at(&scene->fog, (double)at.y) / (4 * PI_F));
}

/* A row of the part: of slice k, j is the number of the row in it. */
static void froxel_row(void *user, uint32_t row) {
    const struct work *work = user;
    const struct view *view = work->view;
    const uint32_t j = row % HIGH, k = row / HIGH;
    const double from = NEAR * pow(FAR / NEAR, (double)k / SLICES), to = NEAR * pow(FAR / NEAR, (k + 1.0) / SLICES);
    for (uint32_t i = 0; i < WIDE; i++) {
        const uint32_t cell = hash_two(row * WIDE + i, work->seed);
        float place[4];
        for (uint32_t r = 0; r < 4; r++) place[r] = unit_float(hash_two(cell, r));
        const double x = ((double)i + (double)place[0]) / WIDE * view->width,
                     y = ((double)j + (double)place[1]) / HIGH * view->height;
        const vec3 at = along(view_eye(view), view_ray_at(view, x, y), (float)(from + (to - from) * (double)place[2]));
        work->out[row * WIDE + i] = scattered(work->world, at, place[3]);
    }
}

bool froxels_write(const struct dump *dump, const struct world *world, struct job *job, struct glint_error *err) {
    const struct glint_froxels froxels = {.slices = SLICES, .near_depth = NEAR, .far_depth = FAR, .exponential = true};
    struct dump_part part;
    if (!world_scene(world)->has_fog) return true;
    vec3 *out = calloc((size_t)WIDE * HIGH * SLICES, sizeof *out);
    struct work work = {world, dump->view, 0, out};
    uint64_t bits[2]; /* of the jitter, which differs from frame to frame */
    memcpy(bits, dump->view->jitter_px, sizeof bits);
    work.seed = hash_two((uint32_t)(bits[0] >> 20), (uint32_t)(bits[1] >> 20));
    bool ok = out || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the light in the air");
    ok = ok && parallel_for(job, "collecting the light in the air", 0, HIGH * SLICES, froxel_row, &work, err);
    if (ok && (ok = dump_colors(&part, dump, "froxels", WIDE, HIGH * SLICES, dump_half, out, sizeof *out, err))) {
        part.part.froxels = &froxels;
        ok = dump_end(&part, dump, err);
    }
    free(out);
    return ok;
}
