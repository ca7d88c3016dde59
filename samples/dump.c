/* Parts of a capture: G-buffer, pictures, cube maps, water, glass, and the truth of reflections. */
#include "dump.h"

#include <stdio.h>
#include <stdlib.h>

#include "dump_part.h"

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

static void put_normal(struct dump_part *part, const char *const names[3], enum glint_normal_encoding encoding,
                       const vec3 *source, size_t stride_bytes) {
    struct storage storage = storage_normal(encoding);
    dump_channel(part, names[0], storage, &source->x, stride_bytes);
    dump_channel(part, names[1], storage, &source->y, stride_bytes);
    if (encoding == GLINT_NORMAL_SIGNED || encoding == GLINT_NORMAL_UNORM)
        dump_channel(part, names[2], storage, &source->z, stride_bytes);
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
    struct dump_part part;
    dump_begin(&part, dump, name, view->width, view->height);
    dump_channel(&part, "depth.Z", storage_depth(e->depth), &p->depth, stride);
    put_normal(&part, normal, e->normal, &p->normal, stride);
    put_normal(&part, vertex, e->vertex_normal, &p->vertex_normal, stride);
    dump_channel(&part, "material.roughness", storage_roughness(e->roughness), &p->roughness, stride);
    dump_channel(&part, "material.metalness", byte, &p->metalness, stride);
    dump_channel(&part, "material.specular", byte, &p->specular, stride);
    dump_channels3(&part, albedo, byte, &p->albedo, stride);
    dump_channel(&part, "motion.X", storage_motion(e->motion), &p->motion[0], stride);
    dump_channel(&part, "motion.Y", storage_motion(e->motion), &p->motion[1], stride);
    dump_channel(&part, "motion.Z", storage_motion_depth(e->motion_depth), &p->motion[2], stride);
    part.channels[part.part.channel_count++] = (struct glint_channel){.name = "stencil.id",
                                                                      .type = GLINT_U32,
                                                                      .data = &p->stencil,
                                                                      .x_stride_bytes = stride,
                                                                      .y_stride_bytes = stride * view->width,
                                                                      .storage = "S8"};
    bool ok = dump_end(&part, dump, err);
    free(p);
    return ok;
}

bool dump_lit(const struct dump *dump, const char *name, const struct pixel *pixels, struct glint_error *err) {
    return dump_picture(dump, name, &pixels->lit, sizeof *pixels, err);
}

bool dump_picture(const struct dump *dump, const char *name, const vec3 *first, size_t stride_bytes,
                  struct glint_error *err) {
    struct dump_part part;
    return dump_colors(&part, dump, name, dump->view->width, dump->view->height, dump_half, first, stride_bytes, err) &&
           dump_end(&part, dump, err);
}

bool dump_cubemap(const struct dump *dump, uint32_t index, const struct glint_cubemap *map, uint32_t size,
                  const struct texel *texels, struct glint_error *err) {
    char name[32];
    struct dump_part part;
    snprintf(name, sizeof name, "cubemap.%03u", index);
    if (!dump_colors(&part, dump, name, size, 6 * size, dump_half, &texels->color, sizeof *texels, err)) return false;
    dump_channel(&part, "A", dump_half, &texels->alpha, sizeof *texels);
    dump_channel(&part, "distance.Z", dump_float, &texels->distance, sizeof *texels);
    part.part.cubemap = map;
    return dump_end(&part, dump, err);
}

bool dump_cubemap_elsewhere(const struct dump *dump, uint32_t index, const struct glint_cubemap *map, uint32_t size,
                            const char *sibling, struct glint_error *err) {
    char name[32];
    struct dump_part part;
    snprintf(name, sizeof name, "cubemap.%03u", index);
    dump_begin(&part, dump, name, size, 6 * size);
    part.part.cubemap = map;
    part.part.sibling = sibling;
    return dump_end(&part, dump, err);
}

bool dump_sky(const struct dump *dump, uint32_t size, const struct texel *texels, struct glint_error *err) {
    struct dump_part part;
    return dump_colors(&part, dump, "sky", size, 6 * size, dump_half, &texels->color, sizeof *texels, err) &&
           dump_end(&part, dump, err);
}

bool dump_scene(const struct dump *dump, const vec3 *scene, size_t stride_bytes, struct glint_error *err) {
    return dump_picture(dump, "scene", scene, stride_bytes, err);
}

bool dump_water(const struct dump *dump, const struct water_pixel *water, struct glint_error *err) {
    static const char *const normal[3] = {"normal.X", "normal.Y", "normal.Z"};
    const struct glint_encodings *e = &dump->encodings;
    size_t count = (size_t)dump->view->width * dump->view->height, stride = sizeof *water;
    struct water_pixel *w = malloc(count * sizeof *w);
    struct dump_part part;
    bool ok = w || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part water");
    ok = ok && dump_colors(&part, dump, "water", dump->view->width, dump->view->height, dump_half, &water->color,
                           stride, err);
    for (size_t i = 0; ok && i < count; i++) {
        w[i] = water[i];
        w[i].depth = encode_depth(e->depth, dump->view, water[i].depth);
        w[i].normal = encode_normal(e->normal, e->normal_space, dump->view, water[i].normal);
    }
    if (ok) {
        dump_channel(&part, "opacity", dump_half, &w->opacity, stride);
        put_normal(&part, normal, e->normal, &w->normal, stride);
        dump_channel(&part, "depth.Z", storage_depth(e->depth), &w->depth, stride);
        dump_channel(&part, "thickness.Z", dump_half, &w->thickness, stride);
        ok = dump_end(&part, dump, err);
    }
    free(w);
    return ok;
}

bool dump_glass(const struct dump *dump, const struct glass_pixel *glass, struct glint_error *err) {
    static const char *const normal[3] = {"normal.X", "normal.Y", "normal.Z"};
    const struct glint_encodings *e = &dump->encodings;
    size_t count = (size_t)dump->view->width * dump->view->height, stride = sizeof *glass;
    struct glass_pixel *g = malloc(count * sizeof *g);
    struct dump_part part;
    bool ok = g || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part transparent");
    ok = ok && dump_colors(&part, dump, "transparent", dump->view->width, dump->view->height, dump_half, &glass->color,
                           stride, err);
    for (size_t i = 0; ok && i < count; i++) {
        g[i] = glass[i];
        g[i].depth = encode_depth(e->depth, dump->view, glass[i].depth);
        g[i].normal = encode_normal(e->normal, e->normal_space, dump->view, glass[i].normal);
        g[i].roughness = encode_roughness(e->roughness, glass[i].roughness);
    }
    if (ok) {
        dump_channel(&part, "A", dump_half, &g->opacity, stride);
        put_normal(&part, normal, e->normal, &g->normal, stride);
        dump_channel(&part, "depth.Z", storage_depth(e->depth), &g->depth, stride);
        dump_channel(&part, "material.roughness", storage_roughness(e->roughness), &g->roughness, stride);
        ok = dump_end(&part, dump, err);
    }
    free(g);
    return ok;
}

bool dump_planar(const struct dump *dump, const struct view *mirrored, const struct glint_planar *planar,
                 const struct texel *texels, struct glint_error *err) {
    size_t count = (size_t)mirrored->width * mirrored->height;
    float *depth = malloc(count * sizeof *depth);
    struct dump_part part;
    bool ok = depth || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part planar.000");
    ok = ok && dump_colors(&part, dump, "planar.000", mirrored->width, mirrored->height, dump_half, &texels->color,
                           sizeof *texels, err);
    for (size_t i = 0; ok && i < count; i++)
        depth[i] = encode_depth(dump->encodings.depth, mirrored, texels[i].distance);
    if (ok) {
        dump_channel(&part, "depth.Z", storage_depth(dump->encodings.depth), depth, sizeof *depth);
        part.part.planar = planar;
        ok = dump_end(&part, dump, err);
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
    struct dump_part part;
    double noise;
    uint32_t width = dump->view->width, height = dump->view->height;
    if (!median_error(error, weight, (size_t)width * height, &noise))
        return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", name);
    if (!dump_colors(&part, dump, name, width, height, dump_float, color, sizeof *truth, err)) return false;
    dump_channel(&part, "weight", dump_float, weight, sizeof *truth);
    dump_channel(&part, "error", dump_half, error, sizeof *truth);
    const struct glint_attribute attributes[] = {
        {.name = "truthSamples", .type = GLINT_ATTRIBUTE_INT, .number = samples},
        {.name = "truthNoise", .type = GLINT_ATTRIBUTE_DOUBLE, .number = noise},
    };
    part.part.attributes = attributes;
    part.part.attribute_count = sizeof attributes / sizeof *attributes;
    return dump_end(&part, dump, err);
}

bool dump_truth(const struct dump *dump, const struct truth *truth, uint32_t samples, struct glint_error *err) {
    if (!dump_lobe(dump, "truth.reflection.ggx", truth, &truth->ggx, &truth->ggx_weight, &truth->ggx_error, samples,
                   err) ||
        !dump_lobe(dump, "truth.reflection.blinn_phong", truth, &truth->blinn_phong, &truth->phong_weight,
                   &truth->phong_error, samples, err))
        return false;
    struct dump_part part;
    dump_begin(&part, dump, "truth.mirror", dump->view->width, dump->view->height);
    dump_channel(&part, "distance.Z", dump_float, &truth->distance, sizeof *truth);
    dump_channel(&part, "visible", dump_half, &truth->visible, sizeof *truth);
    return dump_end(&part, dump, err);
}
