/* A patch of the surface lights a patch of the bottom: what the sun brings to it is divided by how much the refracted rays spread it. Waves are
   too low to light a place twice. The reflection at the surface, and what the water absorbs above the bottom, are in no other part either. */
#include "caustics.h"

#include <stdlib.h>

#include "dump_part.h"

struct caustic_work {
    const struct world *world;
    const struct view *view;
    vec3 *light;
};

/* Where a ray of the sun through that place of the surface is, so deep under it. */
static vec3 under(const struct scene *scene, vec3 at, float deep) {
    const vec3 normal = water_normal(&scene->water, at), to_sun = scene->sun_direction;
    const float in = dot(to_sun, normal), part = 1 / WATER_INDEX, out = sqrtf(1 - part * part * (1 - in * in));
    const vec3 ray = along(scale(to_sun, -part), normal, part * in - out);
    return along(at, ray, deep / -ray.y);
}

/* The surface over which the sun lights a point of the bottom. */
static vec3 entered(const struct scene *scene, vec3 bottom, float deep) {
    vec3 at = v3(bottom.x, scene->water.level, bottom.z);
    for (int i = 0; i < 16; i++) {
        const vec3 away = sub(under(scene, at, deep), bottom);
        at = v3(at.x - away.x, at.y, at.z - away.z);
    }
    return at;
}

/* How much more light there is than under a level surface. */
static float focused(const struct scene *scene, vec3 bottom, float deep) {
    const float h = 0.005f;
    const vec3 at = entered(scene, bottom, deep), x = v3(h, 0, 0), z = v3(0, 0, h);
    const vec3 by_x = sub(under(scene, add(at, x), deep), under(scene, sub(at, x), deep)),
               by_z = sub(under(scene, add(at, z), deep), under(scene, sub(at, z), deep));
    const float area = (by_x.x * by_z.z - by_x.z * by_z.x) / (4 * h * h);
    return 1 / fmaxf(fabsf(area), 0.1f);
}

static vec3 caustic(const struct caustic_work *work, uint32_t x, uint32_t y) {
    const struct scene *scene = world_scene(work->world);
    const struct hit hit = primary_hit(work->world, work->view, x, y);
    const float deep = scene->water.level - hit.position.y, cosine = dot(scene->sun_direction, hit.normal);
    if (!(hit.t < INFINITY && deep > 0 && cosine > 0 && view_eye(work->view).y > scene->water.level)) return gray(0);
    if (world_blocked(work->world, world_leave(&hit, hit.normal), scene->sun_direction, INFINITY)) return gray(0);
    const struct surface surface = world_surface(work->world, &hit, 0);
    const float more = focused(scene, hit.position, deep) - 1;
    if (!(more > 0)) return gray(0);
    return scale(times(surface.albedo, scene->sun_irradiance),
                 more * cosine * (1 - surface.metalness) * scene->gain / PI_F);
}

static void caustics_row(void *user, uint32_t y) {
    const struct caustic_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++)
        work->light[(size_t)y * work->view->width + x] = caustic(work, x, y);
}

bool caustics_write(const struct dump *dump, const struct world *world, struct job *job, struct glint_error *err) {
    const struct scene *scene = world_scene(world);
    if (!scene->water.there || !(luminance(scene->sun_irradiance) > 0)) return true;
    vec3 *light = calloc((size_t)dump->view->width * dump->view->height, sizeof *light);
    struct caustic_work work = {world, dump->view, light};
    bool ok = light || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the caustics");
    ok = ok && parallel_for(job, "rendering the caustics", 0, dump->view->height, caustics_row, &work, err) &&
         dump_picture(dump, "water.caustics", light, sizeof *light, err);
    free(light);
    return ok;
}
