#include "glass.h"

#include <Imath/half.h>

#define REFRACTIVE_INDEX 1.5f
#define DUST 0.06f /* opacity of a pane */

struct glass_work {
    const struct world *world, *panes;
    const struct view *view;
    const struct pixel *pixels;
    struct glass_pixel *glass;
};

static float rounded(float value) {
    return imath_half_to_float(imath_float_to_half(value));
}

/* Unpolarised light at one face, then the sum over all interreflections between both: R + (1 - R)² R (1 + R² + …) = 2R/(1 + R). */
static float pane_reflects(float cosine) {
    float inside = sqrtf(1 - (1 - cosine * cosine) / (REFRACTIVE_INDEX * REFRACTIVE_INDEX));
    float s = (cosine - REFRACTIVE_INDEX * inside) / (cosine + REFRACTIVE_INDEX * inside);
    float p = (inside - REFRACTIVE_INDEX * cosine) / (inside + REFRACTIVE_INDEX * cosine);
    float face = 0.5f * (s * s + p * p);
    return 2 * face / (1 + face);
}

static void glass_row(void *user, uint32_t y) {
    const struct glass_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        size_t i = (size_t)y * work->view->width + x;
        vec3 ray = view_ray(work->view, x, y), behind = work->pixels[i].lit;
        struct hit hit = world_trace(work->panes, view_eye(work->view), ray, (float)VIEW_NEAR);
        work->glass[i] = (struct glass_pixel){.depth = INFINITY, .normal = {0, 1, 0}, .scene = behind};
        if (!(hit.t < work->pixels[i].depth)) continue;
        vec3 to_eye = unit(scale(ray, -1)), n = v3(rounded(hit.normal.x), rounded(hit.normal.y), rounded(hit.normal.z));
        vec3 dust = scale(hit.mesh->material.albedo, world_scene(work->world)->gain);
        vec3 mirror = world_look(work->world, world_leave(&hit, hit.geometric), unit(reflected(to_eye, unit(n))), NULL);
        float share = pane_reflects(clampf(dot(to_eye, unit(n)), 0, 1));
        work->glass[i] = (struct glass_pixel){.depth = hit.t,
                                              .normal = n,
                                              .roughness = hit.mesh->material.roughness,
                                              .color = dust,
                                              .opacity = DUST,
                                              .scene = mix(mix(behind, dust, DUST), mirror, share)};
    }
}

bool render_glass(const struct world *world, const struct world *panes, const struct view *view,
                  const struct pixel *pixels, struct glass_pixel *glass, struct job *job, double weight,
                  struct glint_error *err) {
    struct glass_work work = {world, panes, view, pixels, glass};
    return parallel_for(job, "rendering the glass", weight, view->height, glass_row, &work, err);
}
