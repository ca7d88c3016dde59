/* Renders the buffers of an engine's frame with one ray per pixel, and cube maps. */
#include "render.h"

#include <Imath/half.h>

struct frame_work {
    const struct world *world;
    const struct view *view, *previous;
    struct pixel *pixels;
};

static void motion_of(const struct frame_work *work, uint32_t x, uint32_t y, vec3 point, double w, float motion[3]) {
    double uv[2];
    if (!view_project(work->previous, point, w, uv)) return;
    motion[0] = (float)(uv[0] - (x + 0.5) / work->view->width);
    motion[1] = (float)(uv[1] - (y + 0.5) / work->view->height);
}

/* Bends a perturbed normal towards the surface until the mirror ray leaves the surface, as engines do, because the reflection of the
   inside of a surface would be meaningless. */
static vec3 bend_normal(vec3 normal, const struct hit *hit, vec3 to_eye) {
    const float enough = 0.01f;
    vec3 towards = dot(reflected(to_eye, hit->normal), hit->geometric) > enough ? hit->normal : hit->geometric;
    for (float k = 0; k < 1; k += 0.25f) {
        vec3 n = unit(mix(normal, towards, k));
        if (dot(n, to_eye) > 0 && dot(reflected(to_eye, n), hit->geometric) > enough) return n;
    }
    return towards;
}

static float rounded(float value) {
    return imath_half_to_float(imath_float_to_half(value));
}

static vec3 to_half(vec3 v) {
    return v3(rounded(v.x), rounded(v.y), rounded(v.z));
}

static struct pixel seen(const struct world *world, const struct view *view, const struct hit *hit, vec3 direction) {
    vec3 to_eye = scale(unit(direction), -1);
    float slope = fmaxf(dot(to_eye, hit->geometric), 0.05f);
    struct surface surface = world_surface(world, hit, hit->t * view->pixel_rad / slope);
    struct pixel pixel = {.depth = hit->t,
                          .vertex_normal = to_half(hit->normal),
                          .albedo = surface.albedo,
                          .roughness = surface.roughness,
                          .metalness = surface.metalness,
                          .specular = surface.specular,
                          .stencil = surface.stencil};
    const struct shade shade = world_shade(world, hit);
    pixel.normal = to_half(bend_normal(surface.normal, hit, to_eye));
    pixel.lit = shade.lit;
    pixel.indirect = shade.indirect;
    pixel.emission = shade.emission;
    pixel.lamps = shade.lamps;
    return pixel;
}

static struct hit hit_along(const struct world *world, const struct view *view, vec3 direction, bool odd) {
    float from = (float)VIEW_NEAR;
    struct hit hit;
    do {
        hit = world_see(world, view_eye(view), direction, from);
        from = hit.t * (1 + 1e-5f) + 1e-5f;
    } while (odd && hit.t < INFINITY && hit.mesh->flags & MESH_STIPPLED);
    return hit;
}

struct hit primary_hit(const struct world *world, const struct view *view, uint32_t x, uint32_t y) {
    return hit_along(world, view, view_ray(view, x, y), (x ^ y) & 1);
}

struct pixel pixel_at(const struct world *world, const struct view *view, double x, double y, bool odd,
                      struct hit *hit) {
    vec3 direction = view_ray_at(view, x, y);
    *hit = hit_along(world, view, direction, odd);
    if (hit->t < INFINITY) return seen(world, view, hit, direction);
    return (struct pixel){.depth = INFINITY,
                          .stencil = STENCIL_SKY,
                          .normal = v3(0, 1, 0),
                          .vertex_normal = v3(0, 1, 0),
                          .lit = world_sky(world, direction)};
}

static void frame_row(void *user, uint32_t y) {
    const struct frame_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        struct pixel *pixel = &work->pixels[(size_t)y * work->view->width + x];
        struct hit hit;
        *pixel = pixel_at(work->world, work->view, x + 0.5, y + 0.5, (x ^ y) & 1, &hit);
        if (hit.t < INFINITY) {
            vec3 step = hit.mesh->flags & MESH_MOVING ? hit.mesh->step : gray(0);
            vec3 before = sub(hit.position, step);
            motion_of(work, x, y, before, 1, pixel->motion);
            pixel->motion[2] = (float)(view_depth(work->previous, before) - view_depth(work->view, hit.position));
        } else motion_of(work, x, y, view_ray(work->view, x, y), 0, pixel->motion);
    }
}

bool render_frame(const struct world *world, const struct view *view, const struct view *previous, struct pixel *pixels,
                  struct job *job, double weight, struct glint_error *err) {
    struct frame_work work = {world, view, previous, pixels};
    return parallel_for(job, "rendering", weight, view->height, frame_row, &work, err);
}

vec3 cube_direction(uint32_t face, uint32_t x, uint32_t y, uint32_t size) {
    float s = 2 * ((float)x + 0.5f) / (float)size - 1, t = 2 * ((float)y + 0.5f) / (float)size - 1;
    switch (face) { /* Vulkan, "Cube Map Face Selection": sc and tc solved for the direction */
    case 0:
        return v3(1, -t, -s);
    case 1:
        return v3(-1, -t, s);
    case 2:
        return v3(s, 1, t);
    case 3:
        return v3(s, -1, -t);
    case 4:
        return v3(s, -t, 1);
    default:
        return v3(-s, -t, -1);
    }
}

struct cube_work {
    const struct world *world;
    vec3 center;
    uint32_t size;
    struct texel *texels;
    bool sky_only;
};

static void cube_row(void *user, uint32_t row) {
    const struct cube_work *work = user;
    for (uint32_t x = 0; x < work->size; x++) {
        struct texel *texel = &work->texels[(size_t)row * work->size + x];
        vec3 direction = unit(cube_direction(row / work->size, x, row % work->size, work->size));
        struct hit hit = {.t = INFINITY};
        texel->color =
            work->sky_only ? world_sky(work->world, direction) : world_look(work->world, work->center, direction, &hit);
        if (!work->sky_only && !(hit.t < INFINITY)) texel->color = gray(0); /* the sky has a cube map of its own */
        texel->alpha = hit.t < INFINITY ? 1 : 0;
        texel->distance = hit.t;
    }
}

bool render_cubemap(const struct world *world, vec3 center, uint32_t size, struct texel *texels, struct job *job,
                    double weight, struct glint_error *err) {
    struct cube_work work = {world, center, size, texels, false};
    return parallel_for(job, "rendering cube maps", weight, 6 * size, cube_row, &work, err);
}

bool render_sky(const struct world *world, uint32_t size, struct texel *texels, struct job *job, double weight,
                struct glint_error *err) {
    struct cube_work work = {world, gray(0), size, texels, true};
    return parallel_for(job, "rendering the sky", weight, 6 * size, cube_row, &work, err);
}
