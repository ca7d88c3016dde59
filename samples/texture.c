/* Box-filtered MIP levels in 8 bits. Colours are averaged as linear light. */
#include "texture.h"

#include <stdlib.h>

static float linear(float code) {
    return code <= 0.04045f ? code / 12.92f : powf((code + 0.055f) / 1.055f, 2.4f);
}

static uint8_t code_of(float value, bool curved) {
    float code = !curved ? value : value <= 0.0031308f ? 12.92f * value : 1.055f * powf(value, 1 / 2.4f) - 0.055f;
    return (uint8_t)(255 * clampf(code, 0, 1) + 0.5f);
}

static uint32_t side(uint32_t first, uint32_t level) {
    return first >> level ? first >> level : 1;
}

static float value_at(const struct texture *t, const uint8_t *texel, int channel) {
    return channel < 3 ? t->decoded[texel[channel]] : (float)texel[channel] / 255;
}

static void shrink(struct texture *t, uint32_t level) {
    uint32_t w = side(t->width, level), h = side(t->height, level);
    uint32_t from_w = side(t->width, level - 1), from_h = side(t->height, level - 1);
    const uint8_t *from = t->texels + t->first[level - 1];
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++)
            for (int c = 0; c < 4; c++) {
                float sum = 0;
                for (uint32_t k = 0; k < 4; k++) {
                    uint32_t sx = 2 * x + (k & 1), sy = 2 * y + (k >> 1);
                    if (sx >= from_w) sx = from_w - 1;
                    if (sy >= from_h) sy = from_h - 1;
                    sum += value_at(t, from + 4 * ((size_t)sy * from_w + sx), c);
                }
                t->texels[t->first[level] + 4 * ((size_t)y * w + x) + (size_t)c] = code_of(sum / 4, t->srgb && c < 3);
            }
}

struct texture texture_make(uint8_t *pixels, uint32_t width, uint32_t height, bool srgb) {
    struct texture t = {.srgb = srgb, .width = width, .height = height};
    size_t bytes = 0;
    uint32_t levels = 0;
    do {
        t.first[levels] = bytes;
        bytes += (size_t)side(width, levels) * side(height, levels) * 4;
    } while ((width | height) >> ++levels && levels < TEXTURE_MAX_LEVELS);
    uint8_t *texels = realloc(pixels, bytes);
    if (!texels) {
        free(pixels);
        return t;
    }
    t.texels = texels;
    for (int i = 0; i < 256; i++) t.decoded[i] = srgb ? linear((float)i / 255) : (float)i / 255;
    t.levels = levels;
    for (uint32_t level = 1; level < levels; level++) shrink(&t, level);
    return t;
}

/* The index of a texel on one axis; `at` is an integer. */
static uint32_t wrapped(float at, uint32_t size, enum wrap wrap) {
    float n = (float)size;
    if (wrap == WRAP_REPEAT) at -= n * floorf(at / n);
    if (wrap == WRAP_MIRROR) {
        at -= 2 * n * floorf(at / (2 * n));
        if (at >= n) at = 2 * n - 1 - at;
    }
    return (uint32_t)clampf(at, 0, n - 1);
}

static void bilinear(const struct map *map, uint32_t level, float u, float v, float weight, float rgba[4]) {
    const struct texture *t = map->texture;
    uint32_t w = side(t->width, level), h = side(t->height, level);
    float x = u * (float)w - 0.5f, y = v * (float)h - 0.5f, fx = x - floorf(x), fy = y - floorf(y);
    for (int k = 0; k < 4; k++) {
        uint32_t sx = wrapped(floorf(x) + (float)(k & 1), w, map->wrap_u);
        uint32_t sy = wrapped(floorf(y) + (float)(k >> 1), h, map->wrap_v);
        float share = weight * (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        const uint8_t *texel = t->texels + t->first[level] + 4 * ((size_t)sy * w + sx);
        for (int c = 0; c < 4; c++) rgba[c] += share * value_at(t, texel, c);
    }
}

void texture_sample(const struct map *map, float u, float v, float texels, float rgba[4]) {
    for (int c = 0; c < 4; c++) rgba[c] = map->texture ? 0 : 1;
    if (!map->texture) return;
    float level = texels > 1 ? log2f(texels) : 0, last = (float)(map->texture->levels - 1);
    level = clampf(level, 0, last);
    uint32_t finer = (uint32_t)level;
    float coarse = level - (float)finer;
    bilinear(map, finer, u, v, 1 - coarse, rgba);
    if (coarse > 0) bilinear(map, finer + 1, u, v, coarse, rgba);
}

struct point {
    float u, v;
    float density; /* uv per metre */
};

static struct point point_of(const struct mesh *mesh, uint32_t triangle, float u, float v) {
    const uint32_t *i = mesh->triangles + 3 * (size_t)triangle;
    const struct skin *a = &mesh->skins[i[0]], *b = &mesh->skins[i[1]], *c = &mesh->skins[i[2]];
    const vec3 *p = mesh->positions;
    float w = 1 - u - v, bu = b->u - a->u, bv = b->v - a->v, cu = c->u - a->u, cv = c->v - a->v;
    float area = length(cross(sub(p[i[1]], p[i[0]]), sub(p[i[2]], p[i[0]]))), mapped = fabsf(bu * cv - bv * cu);
    return (struct point){w * a->u + u * b->u + v * c->u, w * a->v + u * b->v + v * c->v,
                          area > 0 ? sqrtf(mapped / area) : 0};
}

static void look_up(const struct map *map, const struct point *at, float footprint, float rgba[4]) {
    float size = map->texture ? sqrtf((float)map->texture->width * (float)map->texture->height) : 1;
    texture_sample(map, at->u, at->v, footprint * at->density * size, rgba);
}

static vec3 first_three(const float rgba[4]) {
    return v3(rgba[0], rgba[1], rgba[2]);
}

static vec3 mapped_normal(const struct mesh *mesh, const uint32_t *i, float u, float v, const float rgba[4],
                          vec3 normal) {
    const struct skin *a = &mesh->skins[i[0]], *b = &mesh->skins[i[1]], *c = &mesh->skins[i[2]];
    float w = 1 - u - v, strength = mesh->material.look->normal_scale;
    vec3 t = unit(along(along(scale(a->tangent, w), b->tangent, u), c->tangent, v));
    vec3 s = unit(along(along(scale(a->bitangent, w), b->bitangent, u), c->bitangent, v));
    vec3 smooth = unit(along(along(scale(mesh->normals[i[0]], w), mesh->normals[i[1]], u), mesh->normals[i[2]], v));
    vec3 n = add(add(scale(t, strength * (2 * rgba[0] - 1)), scale(s, strength * (2 * rgba[1] - 1))),
                 scale(smooth, 2 * rgba[2] - 1));
    if (!(length(n) > 1e-4f)) return normal;
    return dot(smooth, normal) < 0 ? scale(unit(n), -1) : unit(n);
}

void look_apply(const struct mesh *mesh, uint32_t triangle, float u, float v, struct surface *surface) {
    const struct look *look = mesh->material.look;
    const uint32_t *i = mesh->triangles + 3 * (size_t)triangle;
    struct point at = point_of(mesh, triangle, u, v);
    float rgba[4];
    vec3 vertex =
        along(along(scale(mesh->skins[i[0]].color, 1 - u - v), mesh->skins[i[1]].color, u), mesh->skins[i[2]].color, v);
    look_up(&look->color, &at, surface->footprint, rgba);
    surface->albedo = times(times(look->color_factor, vertex), first_three(rgba));
    look_up(&look->emission, &at, surface->footprint, rgba);
    surface->emission = times(look->emission_factor, first_three(rgba));
    look_up(&look->surface, &at, surface->footprint, rgba);
    surface->roughness = look->roughness_factor * rgba[1];
    surface->metalness = look->metalness_factor * rgba[2];
    if (!look->normal.texture) return;
    look_up(&look->normal, &at, surface->footprint, rgba);
    surface->normal = mapped_normal(mesh, i, u, v, rgba, surface->normal);
}

bool look_hole(const struct mesh *mesh, uint32_t triangle, float u, float v) {
    const struct look *look = mesh->material.look;
    const uint32_t *i = mesh->triangles + 3 * (size_t)triangle;
    struct point at = point_of(mesh, triangle, u, v);
    float rgba[4], vertex = (1 - u - v) * mesh->skins[i[0]].alpha + u * mesh->skins[i[1]].alpha;
    vertex += v * mesh->skins[i[2]].alpha;
    texture_sample(&look->color, at.u, at.v, 0, rgba);
    return look->alpha_factor * vertex * rgba[3] < look->cutoff;
}
