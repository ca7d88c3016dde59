/* A lamp of radiant intensity I is a sphere of radius R and radiance I / (π R²). From a distance d it fills a cone of the angle α with
   sin α = R / d, whose solid angle is 2π (1 - cos α) = 2π sin² α / (1 + cos α). The mean of visibility and cosine over directions in that cone times
   radiance and solid angle is the irradiance: 2 I / (d² (1 + cos α)) times the mean, which is I / d² times the cosine for a point. */
#include "lamps.h"

#include <stdio.h>
#include <stdlib.h>

#include "dump_part.h"
#include "noise.h"

/* ---- Truth ---- */

struct lamp_work {
    const struct world *world;
    const struct view *view;
    const struct pixel *pixels;
    uint32_t samples;
    struct lamp_truth *truth;
};

/* The surface of a pixel, and a lamp as it sees it. */
struct seen_lamp {
    const struct light *light;
    vec3 from, geometric, normal, way;
    float distance, cosine; /* of the half-angle α */
};

/* Visibility times the cosine in a direction at an angle with the cosine `off` from the middle of the lamp. */
static float sample_lamp(const struct world *world, const struct seen_lamp *seen, vec3 direction, float off) {
    const float d = seen->distance, radius = seen->light->radius, cosine = dot(direction, seen->normal);
    if (!(cosine > 0) || dot(direction, seen->geometric) <= 0) return 0;
    const float beside = fmaxf(radius * radius - d * d * (1 - off * off), 0), far = d * off - sqrtf(beside);
    return d > radius && world_blocked(world, seen->from, direction, far) ? 0 : cosine;
}

/* Irradiance by one lamp for an intensity of 1, and the variance of that value. */
static double lamp_irradiance(const struct lamp_work *work, const struct seen_lamp *seen, uint32_t seed,
                              double *variance) {
    const float radius = seen->light->radius, nearest = fmaxf(seen->distance, radius);
    const uint32_t samples = radius > 0 ? work->samples : 1;
    double sum = 0, square = 0;
    vec3 t, b, middle = scale(seen->way, 1 / seen->distance);
    frame_of(middle, &t, &b);
    for (uint32_t i = 0; i < samples; i++) {
        float u, v;
        r2_point(i, seed, &u, &v);
        const float off = 1 - u * (1 - seen->cosine), side = sqrtf(fmaxf(1 - off * off, 0)), phi = 2 * PI_F * v;
        const vec3 direction = along(along(scale(middle, off), t, side * cosf(phi)), b, side * sinf(phi));
        const double one = (double)sample_lamp(work->world, seen, direction, off);
        sum += one;
        square += one * one;
    }
    const double mean = sum / samples, scale = 2 / ((double)(nearest * nearest) * (1 + (double)seen->cosine));
    *variance = samples > 1 ? scale * scale * fmax(square / samples - mean * mean, 0) / (samples - 1) : 0;
    return scale * mean;
}

static void trace_lamps(const struct lamp_work *work, const struct hit *hit, uint32_t index) {
    const struct scene *scene = world_scene(work->world);
    const struct pixel *pixel = &work->pixels[index];
    const vec3 albedo = scale(pixel->albedo, (1 - pixel->metalness) * scene->gain / PI_F);
    vec3 sum = gray(0);
    double variance = 0;
    for (uint32_t k = 0; k < scene->light_count; k++) {
        struct seen_lamp seen = {.light = &scene->lights[k],
                                 .from = world_leave(hit, hit->geometric),
                                 .geometric = hit->geometric,
                                 .normal = unit(pixel->normal),
                                 .way = sub(scene->lights[k].position, hit->position)};
        seen.distance = length(seen.way);
        const float fade = world_lamp_fade(seen.light, seen.way);
        const float sine = seen.light->radius < seen.distance ? seen.light->radius / seen.distance : 1;
        seen.cosine = sqrtf(1 - sine * sine);
        if (!(fade > 0) || !(seen.distance > 0)) continue;
        double own, irradiance = lamp_irradiance(work, &seen, hash_two(index, 41 + k), &own);
        const double weight = (double)(fade * luminance(times(albedo, seen.light->intensity)));
        sum = along(sum, seen.light->intensity, fade * (float)irradiance);
        variance += weight * weight * own;
    }
    work->truth[index].light = times(albedo, sum);
    const double mean = (double)luminance(work->truth[index].light);
    if (mean > 0) work->truth[index].error = (float)(sqrt(variance) / mean);
}

static void truth_row(void *user, uint32_t y) {
    const struct lamp_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        const uint32_t index = y * work->view->width + x;
        const struct hit hit = primary_hit(work->world, work->view, x, y);
        work->truth[index] = (struct lamp_truth){.light = gray(0)};
        if (hit.t < INFINITY) trace_lamps(work, &hit, index);
    }
}

bool render_lamp_truth(const struct world *world, const struct view *view, const struct pixel *pixels, uint32_t samples,
                       struct lamp_truth *truth, struct job *job, struct glint_error *err) {
    struct lamp_work work = {world, view, pixels, samples, truth};
    return parallel_for(job, "tracing the light of lamps", 0, view->height, truth_row, &work, err);
}

bool lamps_truth_write(const struct dump *dump, const struct world *world, const struct pixel *pixels, uint32_t samples,
                       struct job *job, struct glint_error *err) {
    const uint32_t width = dump->view->width, height = dump->view->height;
    const struct scene *scene = world_scene(world);
    if (!scene->light_count || scene->unlit) return true;
    const struct glint_attribute attribute = {.name = "truthSamples", .type = GLINT_ATTRIBUTE_INT, .number = samples};
    struct dump_part part;
    struct lamp_truth *truth = calloc((size_t)width * height, sizeof *truth);
    bool ok = truth || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the truth of lamps");
    ok = ok && render_lamp_truth(world, dump->view, pixels, samples, truth, job, err) &&
         dump_colors(&part, dump, "truth.lamps", width, height, dump_float, &truth->light, sizeof *truth, err);
    if (ok) {
        dump_channel(&part, "error", dump_half, &truth->error, sizeof *truth);
        part.part.attributes = &attribute;
        part.part.attribute_count = 1;
        ok = dump_end(&part, dump, err);
    }
    free(truth);
    return ok;
}

/* ---- Shadow maps of spot lights ---- */

enum { MAP_SIZE = 512, MOST_MAPS = 8 };
static const float WIDEST = 4; /* tangent of the angle up to which a map covers a wider cone */

struct map_work {
    const struct world *world;
    vec3 from, right, up, axis;
    float tangent, near_m, far_m;
    float *depth;
};

/* The depth of a perspective: 0 at the near plane, 1 at the far one. */
static float map_depth(const struct map_work *work, float along_m) {
    return clampf(work->far_m / (work->far_m - work->near_m) * (1 - work->near_m / along_m), 0, 1);
}

static void map_row(void *user, uint32_t y) {
    const struct map_work *work = user;
    const float texel = 2 * work->tangent / MAP_SIZE, v = work->tangent - texel * ((float)y + 0.5f);
    for (uint32_t x = 0; x < MAP_SIZE; x++) {
        const float u = texel * ((float)x + 0.5f) - work->tangent;
        const vec3 direction = along(along(work->axis, work->right, u), work->up, v);
        const struct hit hit = world_trace(work->world, work->from, direction, work->near_m);
        work->depth[y * MAP_SIZE + x] = map_depth(work, fminf(hit.t, work->far_m));
    }
}

/* Row: scale · direction · (world - offset - from), plus a constant. */
static void fill_row(double row[4], vec3 direction, double scale, vec3 from, const double offset[3], double constant) {
    const float d[3] = {direction.x, direction.y, direction.z}, at[3] = {from.x, from.y, from.z};
    row[3] = constant;
    for (int i = 0; i < 3; i++) {
        row[i] = scale * (double)d[i];
        row[3] -= row[i] * ((double)at[i] + offset[i]);
    }
}

/* The bias is that of the sun's maps, 1.5 texels, at half the range. */
static bool write_map(const struct dump *dump, const struct world *world, uint32_t light, uint32_t number,
                      const double offset[3], struct job *job, struct glint_error *err) {
    const struct light *spot = &world_scene(world)->lights[light];
    struct map_work work = {.world = world, .from = spot->position, .axis = spot->axis, .far_m = spot->range};
    work.tangent = fminf(1.02f * sqrtf(1 - spot->cos_outer * spot->cos_outer) / spot->cos_outer, WIDEST);
    work.near_m = fmaxf(spot->radius, 0.05f);
    work.depth = calloc((size_t)MAP_SIZE * MAP_SIZE, sizeof *work.depth);
    frame_of(spot->axis, &work.right, &work.up);
    const double near_m = (double)work.near_m, far_m = (double)work.far_m, across = 1 / (double)work.tangent;
    struct glint_shadow shadow = {.range = {0, 1}, .has_light = true, .light = light};
    shadow.bias = 1.5 * 2 / (across * MAP_SIZE) * near_m / (0.5 * far_m);
    fill_row(shadow.world_to_shadow, work.right, across, work.from, offset, 0);
    fill_row(shadow.world_to_shadow + 4, work.up, across, work.from, offset, 0);
    fill_row(shadow.world_to_shadow + 8, work.axis, far_m / (far_m - near_m), work.from, offset,
             -far_m * near_m / (far_m - near_m));
    fill_row(shadow.world_to_shadow + 12, work.axis, 1, work.from, offset, 0);
    char name[32];
    snprintf(name, sizeof name, "shadow.%03u", number);
    struct dump_part part;
    bool ok = work.depth || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for a shadow map");
    ok = ok && parallel_for(job, "rendering the shadow map of a lamp", 0, MAP_SIZE, map_row, &work, err);
    if (ok) {
        dump_begin(&part, dump, name, MAP_SIZE, MAP_SIZE);
        dump_channel(&part, "depth.Z", (struct storage){GLINT_F32, "D32F"}, work.depth, sizeof *work.depth);
        part.part.shadow = &shadow;
        ok = dump_end(&part, dump, err);
    }
    free(work.depth);
    return ok;
}

bool lamps_write(const struct dump *dump, const struct world *world, const struct pixel *pixels,
                 const struct glint_sample_options *options, struct job *job, struct glint_error *err) {
    const struct scene *scene = world_scene(world);
    if (!scene->light_count || scene->unlit) return true;
    if (!dump_picture(dump, "lamps", &pixels->lamps, sizeof *pixels, err)) return false;
    const bool suns = options->also & GLINT_ALSO_SHADOW && luminance(scene->sun_irradiance) > 0;
    const uint32_t first = !suns ? 0 : options->cascades > 1 ? options->cascades : 1;
    for (uint32_t i = 0, maps = 0; i < scene->light_count && maps < MOST_MAPS; i++) {
        const float cosine = scene->lights[i].cos_outer;
        if (cosine >= 1 || cosine <= 0) continue; /* point lights, and cones that reach behind the lamp */
        if (!write_map(dump, world, i, first + maps++, options->offset, job, err)) return false;
    }
    return true;
}
