/* One bounce of reflected light: GGX with height-correlated Smith masking and Schlick's Fresnel. Visible normals are sampled (E. Heitz,
   2018), so that the weight of a sample is F · G2/G1. */
#include "finished.h"

#include "lobes.h"
#include "noise.h"

struct mirror {
    vec3 leave, geometric; /* origin of rays; geometric normal towards the viewer */
    vec3 normal, albedo;
    float roughness, metalness, specular;
};

/* Smith's Λ of a direction with this cosine. */
static float smith_lambda(float alpha, float cosine) {
    float tangent2 = 1 / (cosine * cosine) - 1;
    return 0.5f * (sqrtf(1 + alpha * alpha * tangent2) - 1);
}

static vec3 fresnel(const struct mirror *m, float cosine) {
    vec3 f0 = mix(gray(0.08f * m->specular), m->albedo, m->metalness);
    float grazing = fminf(50 * fmaxf(f0.x, fmaxf(f0.y, f0.z)), 1), c = 1 - clampf(cosine, 0, 1);
    return mix(f0, gray(grazing), c * c * c * c * c);
}

/* One sample of the radiance that the surface reflects towards the viewer. */
static vec3 sample_reflection(const struct world *world, const struct mirror *m, vec3 to_eye, float u, float v) {
    float alpha = m->roughness * m->roughness, out = dot(to_eye, m->normal);
    if (!(out > 0)) return gray(0);
    vec3 direction = unit(lobe_ggx(to_eye, m->normal, m->roughness, u, v));
    float in = dot(direction, m->normal);
    if (!(in > 0 && dot(direction, m->geometric) > 0)) return gray(0);
    float before = smith_lambda(alpha, out), share = (1 + before) / (1 + before + smith_lambda(alpha, in));
    vec3 weight = fresnel(m, dot(direction, unit(add(direction, to_eye))));
    if (!(luminance(weight) > 0)) return gray(0);
    return times(scale(weight, share), world_look(world, m->leave, direction, NULL));
}

vec3 finished_look(const struct world *world, vec3 origin, vec3 direction, float u, float v) {
    struct hit hit;
    vec3 color = world_look(world, origin, direction, &hit);
    if (!(hit.t < INFINITY)) return color;
    struct surface s = world_surface(world, &hit, 0);
    struct mirror m = {
        world_leave(&hit, hit.geometric), hit.geometric, s.normal, s.albedo, s.roughness, s.metalness, s.specular};
    return add(color, sample_reflection(world, &m, unit(scale(direction, -1)), u, v));
}

struct finished_work {
    const struct world *world;
    const struct view *view;
    const struct pixel *pixels;
    uint32_t samples;
    vec3 *picture;
};

static struct mirror mirror_of(const struct pixel *pixel, const struct hit *hit) {
    return (struct mirror){world_leave(hit, hit->geometric),
                           hit->geometric,
                           unit(pixel->normal),
                           pixel->albedo,
                           pixel->roughness,
                           pixel->metalness,
                           pixel->specular};
}

vec3 finished_pixel(const struct world *world, const struct view *view, const struct pixel *pixel,
                    const struct hit *hit, float u, float v) {
    if (!(hit->t < INFINITY)) return pixel->lit;
    const struct mirror m = mirror_of(pixel, hit);
    return add(pixel->lit, sample_reflection(world, &m, unit(sub(view_eye(view), hit->position)), u, v));
}

static void finished_row(void *user, uint32_t y) {
    const struct finished_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        uint32_t i = y * work->view->width + x;
        const struct pixel *pixel = &work->pixels[i];
        work->picture[i] = pixel->lit;
        struct hit hit = primary_hit(work->world, work->view, x, y);
        if (!(hit.t < INFINITY)) continue;
        const struct mirror m = mirror_of(pixel, &hit);
        vec3 to_eye = unit(sub(view_eye(work->view), hit.position));
        for (uint32_t k = 0; k < work->samples; k++) {
            float u, v;
            r2_point(k, hash_two(i, 3), &u, &v);
            work->picture[i] =
                along(work->picture[i], sample_reflection(work->world, &m, to_eye, u, v), 1 / (float)work->samples);
        }
    }
}

bool render_finished(const struct world *world, const struct view *view, const struct pixel *pixels, uint32_t samples,
                     vec3 *picture, struct job *job, double weight, struct glint_error *err) {
    struct finished_work work = {world, view, pixels, samples, picture};
    return parallel_for(job, "finishing the picture", weight, view->height, finished_row, &work, err);
}
