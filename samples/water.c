#include "water.h"

#include <Imath/half.h>

struct water_work {
    const struct world *world;
    const struct view *view;
    const struct pixel *pixels;
    struct water_pixel *water;
    struct texel *texels;
};

vec3 water_normal(const struct water *water, vec3 p) {
    static const float waves[][4] = {/* wave vector in rad/m, phase, fraction of the slope */
                                     {0.9f, 2.3f, 0.3f, 0.40f},  {-1.9f, 3.1f, 1.7f, 0.30f},
                                     {4.2f, 5.1f, 4.1f, 0.25f},  {-7.3f, 6.1f, 2.2f, 0.20f},
                                     {11.0f, 9.2f, 5.2f, 0.15f}, {3.0f, -13.0f, 0.9f, 0.12f}};
    float x = 0, z = 0;
    for (size_t i = 0; i < sizeof waves / sizeof *waves; i++) {
        const float *w = waves[i], size = sqrtf(w[0] * w[0] + w[1] * w[1]);
        float slope = w[3] * water->ripple * cosf(w[0] * p.x + w[1] * p.z + w[2]);
        x += slope * w[0] / size;
        z += slope * w[1] / size;
    }
    return unit(v3(-x, 1, -z));
}

static float rounded(float value) {
    return imath_half_to_float(imath_float_to_half(value));
}

/* The fraction of unpolarised light that a smooth surface reflects, and the direction of refraction. */
static float fresnel_and_refraction(vec3 to_eye, vec3 normal, vec3 *refracted) {
    float in = dot(to_eye, normal), part = 1 / WATER_INDEX;
    float out = sqrtf(1 - part * part * (1 - in * in));
    *refracted = along(scale(to_eye, -part), normal, part * in - out);
    float across = (in - WATER_INDEX * out) / (in + WATER_INDEX * out);
    float within = (out - WATER_INDEX * in) / (out + WATER_INDEX * in);
    return 0.5f * (across * across + within * within);
}

static vec3 seen_through(const struct world *world, const struct water *water, vec3 at, vec3 direction, vec3 color) {
    struct hit hit;
    vec3 below = world_look(world, at, direction, &hit);
    float left = powf(1 - water->opacity, hit.t < INFINITY ? hit.t : 1000);
    return mix(color, below, left);
}

static vec3 seen(const struct world *world, const struct water *water, vec3 at, vec3 to_eye, vec3 normal, vec3 color) {
    vec3 refracted, mirror = reflected(to_eye, normal);
    float share = fresnel_and_refraction(to_eye, normal, &refracted);
    mirror.y = fmaxf(mirror.y, 1e-3f); /* a ripple that reflects another ripple */
    vec3 above = world_look(world, at, unit(mirror), NULL);
    return mix(seen_through(world, water, at, refracted, color), above, share);
}

static void water_row(void *user, uint32_t y) {
    const struct water_work *work = user;
    const struct scene *scene = world_scene(work->world);
    const struct water *water = &scene->water;
    vec3 eye = view_eye(work->view);
    for (uint32_t x = 0; x < work->view->width; x++) {
        size_t i = (size_t)y * work->view->width + x;
        vec3 ray = view_ray(work->view, x, y);
        float t = (water->level - eye.y) / ray.y;
        work->water[i] = (struct water_pixel){.depth = INFINITY, .normal = {0, 1, 0}, .scene = work->pixels[i].lit};
        if (!(t > (float)VIEW_NEAR && t < work->pixels[i].depth)) continue;
        vec3 at = along(eye, ray, t), to_eye = unit(scale(ray, -1)), n = water_normal(water, at);
        n = v3(rounded(n.x), rounded(n.y), rounded(n.z));
        float bottom = work->pixels[i].depth < INFINITY ? work->pixels[i].depth : 1000;
        vec3 color = scale(water->color, scene->gain);
        work->water[i] = (struct water_pixel){.depth = t,
                                              .normal = n,
                                              .color = color,
                                              .opacity = water->opacity,
                                              .thickness = (bottom - t) * length(ray),
                                              .scene = seen(work->world, water, at, to_eye, unit(n), color)};
    }
}

bool render_water(const struct world *world, const struct view *view, const struct pixel *pixels,
                  struct water_pixel *water, struct job *job, double weight, struct glint_error *err) {
    struct water_work work = {.world = world, .view = view, .pixels = pixels, .water = water};
    return parallel_for(job, "rendering the water", weight, view->height, water_row, &work, err);
}

/* view = V · M · world with M: y becomes 2 level - y. */
struct view mirrored_view(const struct water *water, const struct view *view) {
    struct view mirrored = *view;
    double *m = mirrored.camera.world_to_view, level = (double)water->level;
    for (int row = 0; row < 3; row++) {
        m[4 * row + 3] += 2 * level * m[4 * row + 1];
        m[4 * row + 1] = -m[4 * row + 1];
    }
    mirrored.eye[1] = 2 * level - mirrored.eye[1];
    return mirrored;
}

static void planar_row(void *user, uint32_t y) {
    const struct water_work *work = user;
    float level = world_scene(work->world)->water.level;
    vec3 eye = view_eye(work->view);
    for (uint32_t x = 0; x < work->view->width; x++) {
        vec3 ray = view_ray(work->view, x, y);
        float t = (level - eye.y) / ray.y;
        struct hit hit = {.t = INFINITY};
        if (t > 0) hit = world_trace(work->world, eye, ray, t);
        work->texels[(size_t)y * work->view->width + x] =
            (struct texel){.color = hit.t < INFINITY ? world_radiance(work->world, &hit) : world_sky(work->world, ray),
                           .distance = hit.t};
    }
}

bool render_planar(const struct world *world, const struct view *mirrored, struct texel *texels, struct job *job,
                   double weight, struct glint_error *err) {
    struct water_work work = {.world = world, .view = mirrored, .texels = texels};
    return parallel_for(job, "rendering the planar map", weight, mirrored->height, planar_row, &work, err);
}
