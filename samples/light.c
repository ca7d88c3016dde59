/* The engine's own shadow mask is as sharp as its light, its occlusion coarse: a few rays over a short way. */
#include "light.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dump_part.h"
#include "lamps.h"
#include "light_truth.h"
#include "noise.h"

/* ---- Sun and lamps ---- */

static void put3(vec3 v, float out[3]) {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static void put3_double(vec3 v, double out[3]) {
    out[0] = (double)v.x;
    out[1] = (double)v.y;
    out[2] = (double)v.z;
}

static void put_direction(vec3 v, double out[3]) {
    put3_double(v, out);
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int i = 0; i < 3 && length > 0; i++) out[i] /= length;
}

static bool has_sun(const struct scene *scene) {
    return luminance(scene->sun_irradiance) > 0;
}

void light_describe(const struct scene *scene, const double offset[3], struct glint_frame *frame) {
    frame->has_sun = has_sun(scene);
    put_direction(scene->sun_direction, frame->sun.direction);
    frame->sun.angular_radius_rad = scene->sun_radius_rad;
    put3(scale(scene->sun_irradiance, scene->gain), frame->sun.irradiance);
    frame->light_count = scene->light_count;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const struct light *from = &scene->lights[i];
        struct glint_light *to = &frame->lights[i];
        put3_double(from->position, to->position);
        for (int k = 0; k < 3; k++) to->position[k] += offset[k];
        put3(scale(from->intensity, scene->gain), to->intensity);
        to->range = (double)from->range;
        to->radius = (double)from->radius;
        to->has_cone = from->cos_outer < 1;
        put_direction(from->axis, to->cone.axis);
        to->cone.inner_rad = acos((double)from->cos_inner);
        to->cone.outer_rad = acos((double)from->cos_outer);
    }
}

/* ---- Shadow mask and occlusion ---- */

struct light_work {
    const struct world *world;
    const struct view *view;
    const struct air *air;
    float *out, *clouds; /* the latter with air alone */
};

static void mask_row(void *user, uint32_t y) {
    const struct light_work *work = user;
    vec3 sun = world_scene(work->world)->sun_direction;
    for (uint32_t x = 0; x < work->view->width; x++) {
        struct hit hit = primary_hit(work->world, work->view, x, y);
        float *out = &work->out[(size_t)y * work->view->width + x];
        *out = 1;
        if (work->air)
            work->clouds[(size_t)y * work->view->width + x] =
                hit.t < INFINITY ? air_sunlight(work->air, hit.position) : 1;
        if (!(hit.t < INFINITY)) continue;
        *out = dot(hit.normal, sun) > 0 && !world_blocked(work->world, world_leave(&hit, hit.normal), sun, INFINITY);
    }
}

static bool write_visibility(const struct dump *dump, const char *name, const float *values, size_t stride_bytes,
                             struct glint_error *err) {
    static const struct storage byte = {GLINT_UNORM8, "R8"};
    struct dump_part part;
    dump_begin(&part, dump, name, dump->view->width, dump->view->height);
    dump_channel(&part, "visibility", byte, values, stride_bytes);
    return dump_end(&part, dump, err);
}

static bool write_mask(const struct dump *dump, const struct world *world, const struct air *air, struct job *job,
                       struct glint_error *err) {
    static const struct storage byte = {GLINT_UNORM8, "R8"};
    const size_t pixels = (size_t)dump->view->width * dump->view->height;
    float *mask = calloc(2 * pixels, sizeof *mask);
    struct light_work work = {world, dump->view, air, mask, mask + pixels};
    struct dump_part part;
    bool ok = mask || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the shadow mask");
    ok = ok && parallel_for(job, "rendering the shadow mask", 0, dump->view->height, mask_row, &work, err);
    if (ok) {
        dump_begin(&part, dump, "sun", dump->view->width, dump->view->height);
        dump_channel(&part, "visibility", byte, mask, sizeof *mask);
        if (air) dump_channel(&part, "clouds", byte, work.clouds, sizeof *mask);
        ok = dump_end(&part, dump, err);
    }
    free(mask);
    return ok;
}

static bool write_occlusion(const struct dump *dump, const struct world *world, float radius, struct job *job,
                            struct glint_error *err) {
    const struct light_rays coarse = {.samples = 8, .radius = 0.5f * radius, .kinds = GLINT_TRUTH_OCCLUSION};
    struct light_truth *seen = calloc((size_t)dump->view->width * dump->view->height, sizeof *seen);
    bool ok = seen || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the occlusion");
    ok = ok && render_light_truth(world, dump->view, &coarse, seen, job, 0, err) &&
         write_visibility(dump, "ao", &seen->occlusion, sizeof *seen, err);
    free(seen);
    return ok;
}

/* ---- Shadow map ---- */

enum { SHADOW_SIZE = 1024, MOST_CELLS = 32 };
static const float SHADOW_REACH = 16, CASCADE_REACH = 4, VOLUME_REACH = 20; /* m from the middle to the rim */

struct shadow_work {
    const struct world *world;
    vec3 corner, right, down,
        along; /* the corner of texel (0, 0) at the near end; a texel to the right and down; towards the far end */
    float *depth;
};

static void shadow_row(void *user, uint32_t y) {
    const struct shadow_work *work = user;
    for (uint32_t x = 0; x < SHADOW_SIZE; x++) {
        vec3 from = along(along(work->corner, work->right, (float)x + 0.5f), work->down, (float)y + 0.5f);
        struct hit hit = world_trace(work->world, from, work->along, 0);
        work->depth[y * SHADOW_SIZE + x] = clampf(hit.t, 0, 1);
    }
}

/* How far the scene reaches from a point along ± the direction. */
static float extent(const struct scene *scene, vec3 middle, vec3 direction) {
    vec3 low, high;
    float most = 1;
    if (!scene_bounds(scene, &low, &high)) return most;
    for (int i = 0; i < 8; i++) {
        vec3 corner = v3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
        most = fmaxf(most, fabsf(dot(sub(corner, middle), direction)));
    }
    return 1.01f * most;
}

/* Row: scale · direction · (world - offset - middle) + bias. */
static void fill_row(double row[4], vec3 direction, float scale, vec3 middle, const double offset[3], double bias) {
    double d[3], m[3];
    put3_double(direction, d);
    put3_double(middle, m);
    row[3] = bias;
    for (int i = 0; i < 3; i++) {
        row[i] = (double)scale * d[i];
        row[3] -= row[i] * (m[i] + offset[i]);
    }
}

/* An orthographic map of what lies before the camera. reach: m from the middle to the rim */
static bool write_shadow(const struct dump *dump, const struct world *world, uint32_t number, float reach,
                         const double offset[3], struct job *job, struct glint_error *err) {
    const struct scene *scene = world_scene(world);
    char name[32];
    snprintf(name, sizeof name, "shadow.%03u", number);
    vec3 right, up, sun = scene->sun_direction,
                    ahead = view_ray(dump->view, dump->view->width / 2, dump->view->height / 2);
    frame_of(sun, &right, &up);
    vec3 middle = along(view_eye(dump->view), unit(v3(ahead.x, 0, ahead.z)), 0.5f * reach);
    const float texel = 2 * reach / SHADOW_SIZE, deep = extent(scene, middle, sun);
    struct glint_shadow shadow = {.range = {0, 1}, .bias = (double)(1.5f * texel / (2 * deep))};
    fill_row(shadow.world_to_shadow, right, 1 / reach, middle, offset, 0);
    fill_row(shadow.world_to_shadow + 4, up, 1 / reach, middle, offset, 0);
    fill_row(shadow.world_to_shadow + 8, sun, -0.5f / deep, middle, offset, 0.5);
    shadow.world_to_shadow[15] = 1;
    vec3 corner = along(along(along(middle, right, -reach), up, reach), sun, deep);
    float *depth = calloc((size_t)SHADOW_SIZE * SHADOW_SIZE, sizeof *depth);
    struct shadow_work work = {world, corner, scale(right, texel), scale(up, -texel), scale(sun, -2 * deep), depth};
    struct dump_part part;
    bool ok = depth || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the shadow map");
    ok = ok && parallel_for(job, "rendering the shadow map", 0, SHADOW_SIZE, shadow_row, &work, err);
    if (ok) {
        dump_begin(&part, dump, name, SHADOW_SIZE, SHADOW_SIZE);
        dump_channel(&part, "depth.Z", (struct storage){GLINT_F32, "D32F"}, depth, sizeof *depth);
        part.part.shadow = &shadow;
        ok = dump_end(&part, dump, err);
    }
    free(depth);
    return ok;
}

/* One map, or cascades from the finest on, each three times as wide as the one before. */
static bool write_shadows(const struct dump *dump, const struct world *world, uint32_t cascades, const double offset[3],
                          struct job *job, struct glint_error *err) {
    if (cascades < 2) return write_shadow(dump, world, 0, SHADOW_REACH, offset, job, err);
    float reach = CASCADE_REACH;
    for (uint32_t k = 0; k < cascades; k++, reach *= 3)
        if (!write_shadow(dump, world, k, reach, offset, job, err)) return false;
    return true;
}

/* ---- Volume of light ---- */

typedef struct {
    vec3 faces[6]; /* +x -x +y -y +z -z */
} cell;

struct volume_work {
    const struct world *world;
    vec3 low;
    float size; /* of a cell, m */
    uint32_t cells[3];
    cell *out;
};

/* The irradiance on a face is ∫ L max(0, d·a) dω, of directions with the density 1/4π the mean times 4π; divided by π, 4 times. */
static cell gather_cell(const struct world *world, vec3 at, uint32_t seed) {
    enum { RAYS = 128 };
    cell out = {{{0, 0, 0}}};
    for (uint32_t i = 0; i < RAYS; i++) {
        float u, v;
        r2_point(i, hash_two(seed, 23), &u, &v);
        float z = 1 - 2 * u, r = sqrtf(fmaxf(0, 1 - z * z)), d[3] = {r * cosf(2 * PI_F * v), r * sinf(2 * PI_F * v), z};
        struct hit hit;
        vec3 light = world_look(world, at, v3(d[0], d[1], d[2]), &hit);
        if (hit.t < INFINITY && hit.from_behind) continue; /* inside of something */
        for (int a = 0; a < 3; a++)
            out.faces[2 * a + (d[a] < 0)] = along(out.faces[2 * a + (d[a] < 0)], light, 4 * fabsf(d[a]) / RAYS);
    }
    return out;
}

/* A row of the part: of slice k, j is the number of the row in it. */
static void volume_row(void *user, uint32_t row) {
    const struct volume_work *work = user;
    uint32_t j = row % work->cells[1], k = row / work->cells[1];
    for (uint32_t i = 0; i < work->cells[0]; i++) {
        vec3 at = along(work->low, v3((float)i + 0.5f, (float)j + 0.5f, (float)k + 0.5f), work->size);
        work->out[row * work->cells[0] + i] = gather_cell(work->world, at, row * work->cells[0] + i);
    }
}

static bool dump_volume(const struct dump *dump, const struct volume_work *work,
                        const struct glint_light_volume *volume, struct glint_error *err) {
    static const char *const names[6][3] = {{"px.R", "px.G", "px.B"}, {"nx.R", "nx.G", "nx.B"},
                                            {"py.R", "py.G", "py.B"}, {"ny.R", "ny.G", "ny.B"},
                                            {"pz.R", "pz.G", "pz.B"}, {"nz.R", "nz.G", "nz.B"}};
    struct dump_part part;
    const size_t count = (size_t)work->cells[0] * work->cells[1] * work->cells[2];
    for (size_t i = 0; i < count; i++)
        for (int f = 0; f < 6; f++)
            work->out[i].faces[f] = encode_color(dump->encodings.color, dump->pre_exposure, work->out[i].faces[f]);
    dump_begin(&part, dump, "volume.000", work->cells[0], work->cells[1] * work->cells[2]);
    for (int f = 0; f < 6; f++) dump_channels3(&part, names[f], dump_half, &work->out->faces[f], sizeof *work->out);
    part.part.volume = volume;
    return dump_end(&part, dump, err);
}

/* Around the camera, as far as the scene reaches, in cells of 1 m, or larger if there would be more than 32 a side. */
static bool write_volume(const struct dump *dump, const struct world *world, const double offset[3], struct job *job,
                         struct glint_error *err) {
    struct volume_work work = {.world = world, .size = 1};
    vec3 low, high, eye = view_eye(dump->view), reach = v3(VOLUME_REACH, 0.5f * VOLUME_REACH, VOLUME_REACH);
    if (!scene_bounds(world_scene(world), &low, &high)) return true;
    const float lows[3] = {fmaxf(low.x, eye.x - reach.x), fmaxf(low.y, eye.y - reach.y), fmaxf(low.z, eye.z - reach.z)};
    const float highs[3] = {fminf(high.x, eye.x + reach.x), fminf(high.y, eye.y + reach.y),
                            fminf(high.z, eye.z + reach.z)};
    for (int i = 0; i < 3; i++) work.size = fmaxf(work.size, (highs[i] - lows[i]) / MOST_CELLS);
    for (int i = 0; i < 3; i++) work.cells[i] = (uint32_t)fmaxf(ceilf((highs[i] - lows[i]) / work.size), 1);
    work.low = v3(lows[0], lows[1], lows[2]);
    struct glint_light_volume volume = {.slices = work.cells[2]};
    for (int i = 0; i < 3; i++)
        fill_row(volume.world_to_grid + 4 * i, v3(i == 0, i == 1, i == 2), 1 / work.size, work.low, offset, 0);
    volume.world_to_grid[15] = 1;
    work.out = calloc((size_t)work.cells[0] * work.cells[1] * work.cells[2], sizeof *work.out);
    bool ok = work.out || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the volume of light");
    ok = ok &&
         parallel_for(job, "gathering the volume of light", 0, work.cells[1] * work.cells[2], volume_row, &work, err) &&
         dump_volume(dump, &work, &volume, err);
    free(work.out);
    return ok;
}

/* ---- All of it ---- */

static bool emits(const struct view *view, const struct pixel *pixels) {
    for (size_t i = 0; i < (size_t)view->width * view->height; i++)
        if (luminance(pixels[i].emission) > 0) return true;
    return false;
}

/* The engine darkens nothing on screen, and says so. */
static bool write_indirect(const struct dump *dump, const struct pixel *pixels, struct glint_error *err) {
    const struct glint_indirect indirect = {.occluded = false};
    struct dump_part part;
    if (!dump_colors(&part, dump, "indirect", dump->view->width, dump->view->height, dump_half, &pixels->indirect,
                     sizeof *pixels, err))
        return false;
    part.part.indirect = &indirect;
    return dump_end(&part, dump, err);
}

bool light_write(const struct dump *dump, const struct world *world, const struct air *air, const struct pixel *pixels,
                 const struct glint_sample_options *options, struct job *job, struct glint_error *err) {
    const struct scene *scene = world_scene(world);
    const uint32_t also = options->also;
    if (!scene->unlit && !write_indirect(dump, pixels, err)) return false;
    if (emits(dump->view, pixels) && !dump_picture(dump, "emissive", &pixels->emission, sizeof *pixels, err))
        return false;
    return (!(also & GLINT_ALSO_AO) || write_occlusion(dump, world, (float)options->occlusion_radius, job, err)) &&
           (!(also & GLINT_ALSO_SUN && has_sun(scene)) || write_mask(dump, world, air, job, err)) &&
           (!(also & GLINT_ALSO_SHADOW && has_sun(scene)) ||
            write_shadows(dump, world, options->cascades, options->offset, job, err)) &&
           (!(also & GLINT_ALSO_LAMPS) || lamps_write(dump, world, pixels, options, job, err)) &&
           (!(also & GLINT_ALSO_VOLUME) || write_volume(dump, world, options->offset, job, err));
}
