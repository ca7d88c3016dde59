/* Textures of glTF materials: MIP chains, and what they make of a surface. Knows no file format. */
#ifndef SAMPLES_TEXTURE_H
#define SAMPLES_TEXTURE_H

#include "scene.h"

enum { TEXTURE_MAX_LEVELS = 14 };

struct texture {
    char *name; /* with `srgb`, what it is found by */
    bool srgb;
    float decoded[256]; /* of a colour's codes */
    uint32_t width, height, levels;
    uint8_t *texels; /* RGBA, level after level */
    size_t first[TEXTURE_MAX_LEVELS];
};

enum wrap { WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR };

struct map {
    const struct texture *texture; /* NULL: 1 everywhere */
    enum wrap wrap_u, wrap_v;
};

/* A material as glTF has it: factors times maps. */
struct look {
    struct map color, surface /* roughness in g, metalness in b */, emission, normal;
    vec3 color_factor, emission_factor;
    float alpha_factor, roughness_factor, metalness_factor, normal_scale;
    float cutoff; /* what has less alpha is not there; 0: all of it is */
};

/* What a vertex adds to its position and normal. */
struct skin {
    float u, v; /* v downwards, as the image's rows */
    vec3 color; /* times the base colour */
    float alpha;
    vec3 tangent;   /* along +u */
    vec3 bitangent; /* towards the image's top */
};

/* Takes the pixels over, also when it fails; 0 levels when there is no memory. */
struct texture texture_make(uint8_t *pixels, uint32_t width, uint32_t height, bool srgb);
/* Linear RGBA, bilinear between texels and linear between levels; `texels` is the footprint in texels. */
void texture_sample(const struct map *map, float u, float v, float texels, float rgba[4]);

/* Albedo, emission, roughness, metalness and normal of a point of a triangle; u and v are barycentric. */
void look_apply(const struct mesh *mesh, uint32_t triangle, float u, float v, struct surface *surface);
/* Whether an alpha mask leaves the point out. */
bool look_hole(const struct mesh *mesh, uint32_t triangle, float u, float v);

#endif
