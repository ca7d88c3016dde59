/* Textures of glTF materials: MIP chains, and their effect on a surface. Independent of file formats. */
#ifndef SAMPLES_TEXTURE_H
#define SAMPLES_TEXTURE_H

#include "scene.h"

enum { TEXTURE_MAX_LEVELS = 14 };

struct texture {
    char *name; /* with `srgb`, the key for sharing textures */
    bool srgb;
    float decoded[256]; /* linear values of the 256 codes */
    uint32_t width, height, levels;
    uint8_t *texels; /* RGBA, level by level */
    size_t first[TEXTURE_MAX_LEVELS];
};

enum wrap { WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR };

struct map {
    const struct texture *texture; /* NULL: 1 everywhere */
    enum wrap wrap_u, wrap_v;
};

/* A glTF material: factors times maps. */
struct look {
    struct map color, surface /* roughness in g, metalness in b */, emission, normal;
    vec3 color_factor, emission_factor;
    float alpha_factor, roughness_factor, metalness_factor, normal_scale;
    float cutoff; /* texels with less alpha are holes; 0: there are no holes */
};

/* Additional properties of a vertex. */
struct skin {
    float u, v; /* v downwards, like image rows */
    vec3 color; /* factor of the base colour */
    float alpha;
    vec3 tangent;   /* along +u */
    vec3 bitangent; /* towards the top of the image */
};

/* Takes ownership of the pixels, even if it fails; returns 0 levels when out of memory. */
struct texture texture_make(uint8_t *pixels, uint32_t width, uint32_t height, bool srgb);
/* Linear RGBA, trilinear; `texels` is the footprint in texels. */
void texture_sample(const struct map *map, float u, float v, float texels, float rgba[4]);

/* Sets albedo, emission, roughness, metalness and normal of a point of a triangle; u and v are barycentric. */
void look_apply(const struct mesh *mesh, uint32_t triangle, float u, float v, struct surface *surface);
/* Whether the point is a hole of the alpha mask. */
bool look_hole(const struct mesh *mesh, uint32_t triangle, float u, float v);

#endif
