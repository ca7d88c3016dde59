/* All rays begin at the surface that the pixel's own ray hits. Directions under the triangle, which a smooth normal's hemisphere also has,
   are left out. */
#include "light_truth.h"

#include <stdlib.h>

#include "dump_part.h"
#include "finished.h"
#include "lamps.h"
#include "noise.h"

struct light_truth_work {
    const struct world *world;
    const struct view *view;
    const struct light_rays *rays;
    struct light_truth *truth;
};

/* A direction about the normal with the density cos θ / π. */
static vec3 cosine_direction(vec3 normal, uint32_t i, uint32_t seed) {
    vec3 t, b;
    float u, v;
    frame_of(normal, &t, &b);
    r2_point(i, seed, &u, &v);
    float r = sqrtf(u), phi = 2 * PI_F * v;
    return along(along(scale(normal, sqrtf(1 - u)), t, r * cosf(phi)), b, r * sinf(phi));
}

static void trace_hemisphere(const struct light_truth_work *work, const struct hit *hit, uint32_t index,
                             struct light_truth *truth) {
    const struct light_rays *rays = work->rays;
    const bool light = rays->kinds & GLINT_TRUTH_INDIRECT;
    const vec3 leave = world_leave(hit, hit->geometric);
    double color[3] = {0}, square = 0, distance = 0, hidden = 0, n = 0;
    for (uint32_t i = 0; i < rays->samples; i++) {
        vec3 d = cosine_direction(hit->normal, i, hash_two(index, 17));
        if (dot(d, hit->geometric) <= 0) continue;
        n++;
        struct hit found;
        if (light) {
            vec3 c = world_look(work->world, leave, d, &found);
            double l = (double)luminance(c);
            color[0] += (double)c.x, color[1] += (double)c.y, color[2] += (double)c.z;
            square += l * l;
        } else {
            found.t = world_distance(work->world, leave, d, rays->radius);
        }
        if (found.t <= rays->radius) distance += (double)found.t, hidden++;
    }
    if (n == 0) return;
    truth->occlusion = (float)((n - hidden) / n);
    if (hidden > 0) truth->occluder_m = (float)(distance / hidden);
    truth->indirect = v3((float)(color[0] / n), (float)(color[1] / n), (float)(color[2] / n));
    const double mean = (double)luminance(truth->indirect), variance = square / n - mean * mean;
    if (n > 1 && mean > 0 && variance > 0) truth->error = (float)(sqrt(variance / (n - 1)) / mean);
}

static void trace_sun(const struct light_truth_work *work, const struct hit *hit, uint32_t index,
                      struct light_truth *truth) {
    const struct scene *scene = world_scene(work->world);
    const float radius = (float)tan(scene->sun_radius_rad);
    const uint32_t samples = radius > 0 ? work->rays->samples : 1;
    const vec3 leave = world_leave(hit, hit->geometric);
    vec3 t, b;
    uint32_t seen = 0, near = 0;
    frame_of(scene->sun_direction, &t, &b);
    for (uint32_t i = 0; i < samples && dot(hit->normal, scene->sun_direction) > 0; i++) {
        float u, v;
        r2_point(i, hash_two(index, 19), &u, &v);
        float r = radius * sqrtf(u), phi = 2 * PI_F * v;
        vec3 d = unit(along(along(scene->sun_direction, t, r * cosf(phi)), b, r * sinf(phi)));
        if (dot(d, hit->geometric) <= 0 || world_blocked(work->world, leave, d, work->rays->length)) continue;
        near++;
        seen += !world_blocked(work->world, leave, d, INFINITY);
    }
    truth->sun = (float)seen / (float)samples;
    truth->contact = (float)near / (float)samples;
}

static void truth_row(void *user, uint32_t y) {
    const struct light_truth_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        const uint32_t index = y * work->view->width + x;
        struct light_truth *truth = &work->truth[index];
        *truth = (struct light_truth){.occlusion = 1, .occluder_m = INFINITY, .sun = 1, .contact = 1};
        struct hit hit = primary_hit(work->world, work->view, x, y);
        if (!(hit.t < INFINITY)) continue;
        if (work->rays->kinds & (GLINT_TRUTH_OCCLUSION | GLINT_TRUTH_INDIRECT))
            trace_hemisphere(work, &hit, index, truth);
        if (work->rays->kinds & GLINT_TRUTH_SUN) trace_sun(work, &hit, index, truth);
    }
}

bool render_light_truth(const struct world *world, const struct view *view, const struct light_rays *rays,
                        struct light_truth *truth, struct job *job, double weight, struct glint_error *err) {
    struct light_truth_work work = {world, view, rays, truth};
    return parallel_for(job, "tracing the truth of light", weight, view->height, truth_row, &work, err);
}

/* ---- Antialiasing ---- */

struct area_work {
    const struct world *world;
    const struct view *view;
    uint32_t samples;
    bool finished;
    vec3 *picture;
};

static void area_row(void *user, uint32_t y) {
    const struct area_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        const uint32_t index = y * work->view->width + x;
        double sum[3] = {0};
        for (uint32_t i = 0; i < work->samples; i++) {
            float u, v, p, q;
            struct hit hit;
            r2_point(i, hash_two(index, 29), &u, &v);
            r2_point(i, hash_two(index, 31), &p, &q);
            struct pixel pixel = pixel_at(work->world, work->view, x + (double)u, y + (double)v, (x ^ y) & 1, &hit);
            vec3 c = work->finished ? finished_pixel(work->world, work->view, &pixel, &hit, p, q) : pixel.lit;
            sum[0] += (double)c.x, sum[1] += (double)c.y, sum[2] += (double)c.z;
        }
        const double n = work->samples;
        work->picture[index] = v3((float)(sum[0] / n), (float)(sum[1] / n), (float)(sum[2] / n));
    }
}

bool render_antialiased(const struct world *world, const struct view *view, uint32_t samples, bool finished,
                        vec3 *picture, struct job *job, double weight, struct glint_error *err) {
    struct area_work work = {world, view, samples, finished, picture};
    return parallel_for(job, "averaging the picture", weight, view->height, area_row, &work, err);
}

/* ---- Parts ---- */

static void add_samples(struct dump_part *part, struct glint_attribute *attribute, uint32_t samples) {
    *attribute = (struct glint_attribute){.name = "truthSamples", .type = GLINT_ATTRIBUTE_INT, .number = samples};
    part->part.attributes = attribute;
    part->part.attribute_count = 1;
}

static bool write_visibilities(const struct dump *dump, const struct light_truth *truth, const struct light_rays *rays,
                               struct glint_error *err) {
    const struct glint_truth lengths = {.radius = (double)rays->radius, .length = (double)rays->length};
    const uint32_t width = dump->view->width, height = dump->view->height;
    struct glint_attribute attribute;
    struct dump_part part;
    if (rays->kinds & GLINT_TRUTH_OCCLUSION) {
        dump_begin(&part, dump, "truth.occlusion", width, height);
        dump_channel(&part, "visibility", dump_float, &truth->occlusion, sizeof *truth);
        dump_channel(&part, "distance.Z", dump_float, &truth->occluder_m, sizeof *truth);
        part.part.truth = &lengths;
        add_samples(&part, &attribute, rays->samples);
        if (!dump_end(&part, dump, err)) return false;
    }
    if (!(rays->kinds & GLINT_TRUTH_SUN)) return true;
    dump_begin(&part, dump, "truth.sun", width, height);
    dump_channel(&part, "visibility", dump_float, &truth->sun, sizeof *truth);
    dump_channel(&part, "contact", dump_float, &truth->contact, sizeof *truth);
    part.part.truth = &lengths;
    add_samples(&part, &attribute, rays->samples);
    return dump_end(&part, dump, err);
}

/* Colours in floats, with the standard error where it is known. */
static bool write_colors(const struct dump *dump, const char *name, const vec3 *first, size_t stride_bytes,
                         const float *error, uint32_t samples, struct glint_error *err) {
    struct glint_attribute attribute;
    struct dump_part part;
    if (!dump_colors(&part, dump, name, dump->view->width, dump->view->height, dump_float, first, stride_bytes, err))
        return false;
    if (error) dump_channel(&part, "error", dump_half, error, stride_bytes);
    add_samples(&part, &attribute, samples);
    return dump_end(&part, dump, err);
}

static bool write_antialiased(const struct dump *dump, const struct world *world, const struct view *unjittered,
                              const struct glint_sample_options *o, struct job *job, struct glint_error *err) {
    vec3 *picture = calloc((size_t)unjittered->width * unjittered->height, sizeof *picture);
    bool ok = picture || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the antialiased picture");
    ok = ok && render_antialiased(world, unjittered, o->truth_samples, o->finished_samples > 0, picture, job, 0, err) &&
         write_colors(dump, "truth.antialiased", picture, sizeof *picture, NULL, o->truth_samples, err);
    free(picture);
    return ok;
}

/* Traced indirect light takes the place of the baked one, unless the scene has none. */
static bool write_picture(const struct dump *dump, const struct world *world, const struct pixel *pixels,
                          const struct light_truth *truth, uint32_t samples, struct job *job, struct glint_error *err) {
    const size_t count = (size_t)dump->view->width * dump->view->height;
    vec3 *picture = calloc(count, sizeof *picture);
    bool ok = picture || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the true picture");
    ok = ok && render_finished(world, dump->view, pixels, samples, picture, job, 0, err);
    for (size_t i = 0; ok && !world_scene(world)->unlit && i < count; i++)
        if (pixels[i].depth < INFINITY)
            picture[i] = along(sub(picture[i], pixels[i].indirect), times(pixels[i].albedo, truth[i].indirect),
                               1 - pixels[i].metalness);
    ok = ok && write_colors(dump, "truth.picture", picture, sizeof *picture, NULL, samples, err);
    free(picture);
    return ok;
}

bool light_truth_write(const struct dump *dump, const struct world *world, const struct view *unjittered,
                       const struct pixel *pixels, const struct glint_sample_options *o, struct job *job,
                       struct glint_error *err) {
    const bool sunny = luminance(world_scene(world)->sun_irradiance) > 0;
    const uint32_t traced = GLINT_TRUTH_OCCLUSION | GLINT_TRUTH_INDIRECT | (sunny ? GLINT_TRUTH_SUN : 0);
    const uint32_t wanted = o->truths | (o->truths & GLINT_TRUTH_PICTURE ? GLINT_TRUTH_INDIRECT : 0);
    const struct light_rays rays = {.samples = o->truth_samples,
                                    .radius = (float)o->occlusion_radius,
                                    .length = (float)o->contact_length,
                                    .kinds = wanted & traced};
    struct light_truth *truth = NULL;
    bool ok = true;
    if (rays.kinds) {
        truth = calloc((size_t)dump->view->width * dump->view->height, sizeof *truth);
        ok = truth || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the truth of light");
        ok = ok && render_light_truth(world, dump->view, &rays, truth, job, 0, err) &&
             write_visibilities(dump, truth, &rays, err);
        if (ok && o->truths & GLINT_TRUTH_INDIRECT)
            ok =
                write_colors(dump, "truth.indirect", &truth->indirect, sizeof *truth, &truth->error, rays.samples, err);
        if (ok && o->truths & GLINT_TRUTH_PICTURE)
            ok = write_picture(dump, world, pixels, truth, rays.samples, job, err);
        free(truth);
    }
    ok = ok && (!(o->truths & GLINT_TRUTH_LAMPS) || lamps_truth_write(dump, world, pixels, o->truth_samples, job, err));
    return ok && (!(o->truths & GLINT_TRUTH_ANTIALIASED) || write_antialiased(dump, world, unjittered, o, job, err));
}
