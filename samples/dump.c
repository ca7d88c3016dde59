/* Parts of a capture: a list of channels, each a plane of floats that is converted to the type of an engine's buffer. */
#include "dump.h"

#include <Imath/half.h>
#include <stdio.h>
#include <stdlib.h>

#include "encode.h"

#define MAX_CHANNELS 24

struct part {
    struct glint_part part;
    struct glint_channel channels[MAX_CHANNELS];
    void *memory[MAX_CHANNELS];
    size_t pixels;
    bool failed;
};

static void part_init(struct part *part, const struct dump *dump, const char *name, uint32_t width, uint32_t height) {
    *part = (struct part){.part = {.name = name, .width = width, .height = height, .encodings = dump->encodings},
                          .pixels = (size_t)width * height};
}

static const size_t type_bytes[] = {
    [GLINT_F16] = 2, [GLINT_F32] = 4, [GLINT_U16] = 2, [GLINT_U32] = 4, [GLINT_UNORM8] = 1, [GLINT_UNORM16] = 2};

static void convert(enum glint_type type, const float *source, size_t stride, size_t count, void *out) {
    uint16_t *words = out;
    uint8_t *bytes = out;
    float *floats = out;
    for (size_t i = 0; i < count; i++) {
        float v = source[i * stride];
        switch (type) {
        case GLINT_F16:
            /* Saturates like a game's buffer: finite values are clamped to the largest half, infinity stays. */
            words[i] = imath_float_to_half(isfinite(v) ? clampf(v, -65504, 65504) : v);
            break;
        case GLINT_U16:
            words[i] = (uint16_t)v;
            break;
        case GLINT_UNORM16:
            words[i] = (uint16_t)(clampf(v, 0, 1) * 65535 + 0.5f);
            break;
        case GLINT_UNORM8:
            bytes[i] = (uint8_t)(clampf(v, 0, 1) * 255 + 0.5f);
            break;
        default:
            floats[i] = v;
        }
    }
}

/* Adds a channel; `source` is its first value, consecutive values are `stride_bytes` apart. */
static void add_channel(struct part *part, const char *name, struct storage storage, const float *source,
                        size_t stride_bytes) {
    size_t i = part->part.channel_count++;
    part->memory[i] = malloc(part->pixels * type_bytes[storage.type]);
    if (!part->memory[i]) {
        part->failed = true;
        return;
    }
    convert(storage.type, source, stride_bytes / sizeof(float), part->pixels, part->memory[i]);
    part->channels[i] =
        (struct glint_channel){.name = name, .type = storage.type, .data = part->memory[i], .storage = storage.name};
}

static void put3(struct part *part, const char *const names[3], struct storage storage, const vec3 *source,
                 size_t stride_bytes) {
    add_channel(part, names[0], storage, &source->x, stride_bytes);
    add_channel(part, names[1], storage, &source->y, stride_bytes);
    add_channel(part, names[2], storage, &source->z, stride_bytes);
}

static bool part_done(struct part *part, const struct dump *dump, struct glint_error *err) {
    const struct glint_attribute settings = {
        .name = "sampleSettings", .type = GLINT_ATTRIBUTE_STRING, .string = dump->settings};
    if (dump->settings && !part->part.attribute_count) {
        part->part.attributes = &settings;
        part->part.attribute_count = 1;
    }
    part->part.channels = part->channels;
    bool ok = part->failed ? glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", part->part.name)
                           : glint_writer_add_part(dump->writer, &part->part, err);
    for (size_t i = 0; i < part->part.channel_count; i++) free(part->memory[i]);
    return ok;
}

static const char *const rgb[3] = {"R", "G", "B"};
static const struct storage in_half = {GLINT_F16, "RGBA16F"}, whole = {GLINT_F32, "R32F"};

static void encode_pixels(const struct dump *dump, const struct view *view, const struct pixel *in, struct pixel *out) {
    const struct glint_encodings *e = &dump->encodings;
    for (size_t i = 0; i < (size_t)view->width * view->height; i++) {
        out[i] = in[i];
        out[i].depth = encode_depth(e->depth, view, in[i].depth);
        out[i].normal = encode_normal(e->normal, e->normal_space, view, in[i].normal);
        out[i].vertex_normal = encode_normal(e->vertex_normal, e->normal_space, view, in[i].vertex_normal);
        out[i].roughness = encode_roughness(e->roughness, in[i].roughness);
        encode_motion(e->motion, view, in[i].motion, out[i].motion);
        out[i].motion[2] = encode_motion_depth(e->motion_depth, in[i].motion[2]);
    }
}

static void put_normal(struct part *part, const char *const names[3], enum glint_normal_encoding encoding,
                       const vec3 *source, size_t stride_bytes) {
    struct storage storage = storage_normal(encoding);
    add_channel(part, names[0], storage, &source->x, stride_bytes);
    add_channel(part, names[1], storage, &source->y, stride_bytes);
    if (encoding == GLINT_NORMAL_SIGNED || encoding == GLINT_NORMAL_UNORM)
        add_channel(part, names[2], storage, &source->z, stride_bytes);
}

bool dump_gbuffer(const struct dump *dump, const char *name, const struct view *view, const struct pixel *pixels,
                  struct glint_error *err) {
    static const char *const normal[3] = {"normal.X", "normal.Y", "normal.Z"};
    static const char *const vertex[3] = {"vertexNormal.X", "vertexNormal.Y", "vertexNormal.Z"};
    static const char *const albedo[3] = {"albedo.R", "albedo.G", "albedo.B"};
    static const struct storage byte = {GLINT_UNORM8, "RGBA8"};
    const struct glint_encodings *e = &dump->encodings;
    size_t count = (size_t)view->width * view->height, stride = sizeof(struct pixel);
    struct pixel *p = malloc(count * sizeof *p);
    if (!p) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", name);
    encode_pixels(dump, view, pixels, p);
    struct part part;
    part_init(&part, dump, name, view->width, view->height);
    add_channel(&part, "depth.Z", storage_depth(e->depth), &p->depth, stride);
    put_normal(&part, normal, e->normal, &p->normal, stride);
    put_normal(&part, vertex, e->vertex_normal, &p->vertex_normal, stride);
    add_channel(&part, "material.roughness", storage_roughness(e->roughness), &p->roughness, stride);
    add_channel(&part, "material.metalness", byte, &p->metalness, stride);
    add_channel(&part, "material.specular", byte, &p->specular, stride);
    put3(&part, albedo, byte, &p->albedo, stride);
    add_channel(&part, "motion.X", storage_motion(e->motion), &p->motion[0], stride);
    add_channel(&part, "motion.Y", storage_motion(e->motion), &p->motion[1], stride);
    add_channel(&part, "motion.Z", storage_motion_depth(e->motion_depth), &p->motion[2], stride);
    part.channels[part.part.channel_count++] = (struct glint_channel){.name = "stencil.id",
                                                                      .type = GLINT_U32,
                                                                      .data = &p->stencil,
                                                                      .x_stride_bytes = stride,
                                                                      .y_stride_bytes = stride * view->width,
                                                                      .storage = "S8"};
    bool ok = part_done(&part, dump, err);
    free(p);
    return ok;
}

static vec3 *encoded_colors(const struct dump *dump, const vec3 *first, size_t stride_bytes, size_t count) {
    vec3 *colors = malloc(count * sizeof *colors);
    for (size_t i = 0; colors && i < count; i++) {
        const vec3 *color = (const vec3 *)(const void *)((const char *)first + i * stride_bytes);
        colors[i] = encode_color(dump->encodings.color, dump->pre_exposure, *color);
    }
    return colors;
}

/* A part whose first channels are R G B. */
static bool color_part(struct part *part, const struct dump *dump, const char *name, uint32_t width, uint32_t height,
                       struct storage storage, const vec3 *first, size_t stride_bytes, struct glint_error *err) {
    part_init(part, dump, name, width, height);
    vec3 *colors = encoded_colors(dump, first, stride_bytes, part->pixels);
    if (!colors) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", name);
    put3(part, rgb, storage, colors, sizeof(vec3));
    free(colors);
    return true;
}

bool dump_lit(const struct dump *dump, const char *name, const struct pixel *pixels, struct glint_error *err) {
    struct part part;
    return color_part(&part, dump, name, dump->view->width, dump->view->height, in_half, &pixels->lit,
                      sizeof(struct pixel), err) &&
           part_done(&part, dump, err);
}

bool dump_cubemap(const struct dump *dump, uint32_t index, const struct glint_cubemap *map, uint32_t size,
                  const struct texel *texels, struct glint_error *err) {
    char name[32];
    struct part part;
    snprintf(name, sizeof name, "cubemap.%03u", index);
    if (!color_part(&part, dump, name, size, 6 * size, in_half, &texels->color, sizeof *texels, err)) return false;
    add_channel(&part, "A", in_half, &texels->alpha, sizeof *texels);
    add_channel(&part, "distance.Z", whole, &texels->distance, sizeof *texels);
    part.part.cubemap = map;
    return part_done(&part, dump, err);
}

bool dump_cubemap_elsewhere(const struct dump *dump, uint32_t index, const struct glint_cubemap *map, uint32_t size,
                            const char *sibling, struct glint_error *err) {
    char name[32];
    struct part part;
    snprintf(name, sizeof name, "cubemap.%03u", index);
    part_init(&part, dump, name, size, 6 * size);
    part.part.cubemap = map;
    part.part.sibling = sibling;
    return part_done(&part, dump, err);
}

bool dump_sky(const struct dump *dump, uint32_t size, const struct texel *texels, struct glint_error *err) {
    struct part part;
    return color_part(&part, dump, "sky", size, 6 * size, in_half, &texels->color, sizeof *texels, err) &&
           part_done(&part, dump, err);
}

bool dump_scene(const struct dump *dump, const vec3 *scene, size_t stride_bytes, struct glint_error *err) {
    struct part part;
    return color_part(&part, dump, "scene", dump->view->width, dump->view->height, in_half, scene, stride_bytes, err) &&
           part_done(&part, dump, err);
}

bool dump_water(const struct dump *dump, const struct water_pixel *water, struct glint_error *err) {
    static const char *const normal[3] = {"normal.X", "normal.Y", "normal.Z"};
    const struct glint_encodings *e = &dump->encodings;
    size_t count = (size_t)dump->view->width * dump->view->height, stride = sizeof *water;
    struct water_pixel *w = malloc(count * sizeof *w);
    struct part part;
    bool ok = w || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part water");
    ok = ok &&
         color_part(&part, dump, "water", dump->view->width, dump->view->height, in_half, &water->color, stride, err);
    for (size_t i = 0; ok && i < count; i++) {
        w[i] = water[i];
        w[i].depth = encode_depth(e->depth, dump->view, water[i].depth);
        w[i].normal = encode_normal(e->normal, e->normal_space, dump->view, water[i].normal);
    }
    if (ok) {
        add_channel(&part, "opacity", in_half, &w->opacity, stride);
        put_normal(&part, normal, e->normal, &w->normal, stride);
        add_channel(&part, "depth.Z", storage_depth(e->depth), &w->depth, stride);
        add_channel(&part, "thickness.Z", in_half, &w->thickness, stride);
        ok = part_done(&part, dump, err);
    }
    free(w);
    return ok;
}

bool dump_glass(const struct dump *dump, const struct glass_pixel *glass, struct glint_error *err) {
    static const char *const normal[3] = {"normal.X", "normal.Y", "normal.Z"};
    const struct glint_encodings *e = &dump->encodings;
    size_t count = (size_t)dump->view->width * dump->view->height, stride = sizeof *glass;
    struct glass_pixel *g = malloc(count * sizeof *g);
    struct part part;
    bool ok = g || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part transparent");
    ok = ok && color_part(&part, dump, "transparent", dump->view->width, dump->view->height, in_half, &glass->color,
                          stride, err);
    for (size_t i = 0; ok && i < count; i++) {
        g[i] = glass[i];
        g[i].depth = encode_depth(e->depth, dump->view, glass[i].depth);
        g[i].normal = encode_normal(e->normal, e->normal_space, dump->view, glass[i].normal);
        g[i].roughness = encode_roughness(e->roughness, glass[i].roughness);
    }
    if (ok) {
        add_channel(&part, "A", in_half, &g->opacity, stride);
        put_normal(&part, normal, e->normal, &g->normal, stride);
        add_channel(&part, "depth.Z", storage_depth(e->depth), &g->depth, stride);
        add_channel(&part, "material.roughness", storage_roughness(e->roughness), &g->roughness, stride);
        ok = part_done(&part, dump, err);
    }
    free(g);
    return ok;
}

bool dump_planar(const struct dump *dump, const struct view *mirrored, const struct glint_planar *planar,
                 const struct texel *texels, struct glint_error *err) {
    size_t count = (size_t)mirrored->width * mirrored->height;
    float *depth = malloc(count * sizeof *depth);
    struct part part;
    bool ok = depth || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part planar.000");
    ok = ok && color_part(&part, dump, "planar.000", mirrored->width, mirrored->height, in_half, &texels->color,
                          sizeof *texels, err);
    for (size_t i = 0; ok && i < count; i++)
        depth[i] = encode_depth(dump->encodings.depth, mirrored, texels[i].distance);
    if (ok) {
        add_channel(&part, "depth.Z", storage_depth(dump->encodings.depth), depth, sizeof *depth);
        part.part.planar = planar;
        ok = part_done(&part, dump, err);
    }
    free(depth);
    return ok;
}

static int by_value(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The median of the relative standard errors of pixels with a surface. */
static bool median_error(const float *errors, const float *weights, size_t count, double *median) {
    float *kept = malloc((count + 1) * sizeof *kept);
    if (!kept) return false;
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        size_t at = i * (sizeof(struct truth) / sizeof(float));
        if (weights[at] > 0) kept[n++] = errors[at];
    }
    qsort(kept, n, sizeof *kept, by_value);
    *median = n ? (double)kept[n / 2] : 0;
    free(kept);
    return true;
}

static bool dump_lobe(const struct dump *dump, const char *name, const struct truth *truth, const vec3 *color,
                      const float *weight, const float *error, uint32_t samples, struct glint_error *err) {
    struct part part;
    double noise;
    uint32_t width = dump->view->width, height = dump->view->height;
    if (!median_error(error, weight, (size_t)width * height, &noise))
        return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", name);
    if (!color_part(&part, dump, name, width, height, whole, color, sizeof *truth, err)) return false;
    add_channel(&part, "weight", whole, weight, sizeof *truth);
    add_channel(&part, "error", in_half, error, sizeof *truth);
    const struct glint_attribute attributes[] = {
        {.name = "truthSamples", .type = GLINT_ATTRIBUTE_INT, .number = samples},
        {.name = "truthNoise", .type = GLINT_ATTRIBUTE_DOUBLE, .number = noise},
    };
    part.part.attributes = attributes;
    part.part.attribute_count = sizeof attributes / sizeof *attributes;
    return part_done(&part, dump, err);
}

bool dump_truth(const struct dump *dump, const struct truth *truth, uint32_t samples, struct glint_error *err) {
    if (!dump_lobe(dump, "truth.reflection.ggx", truth, &truth->ggx, &truth->ggx_weight, &truth->ggx_error, samples,
                   err) ||
        !dump_lobe(dump, "truth.reflection.blinn_phong", truth, &truth->blinn_phong, &truth->phong_weight,
                   &truth->phong_error, samples, err))
        return false;
    struct part part;
    part_init(&part, dump, "truth.mirror", dump->view->width, dump->view->height);
    add_channel(&part, "distance.Z", whole, &truth->distance, sizeof *truth);
    add_channel(&part, "visible", in_half, &truth->visible, sizeof *truth);
    return part_done(&part, dump, err);
}
