/* Decals on the ground, as an engine draws them: into buffers of their own, with a mark in the stencil, before it lights the picture. */
#ifndef SAMPLES_DECALS_H
#define SAMPLES_DECALS_H

#include "dump.h"

struct decal {
    vec3 albedo, normal;
    float roughness, specular, alpha; /* alpha 0: none */
};

/* Adds the stencil class of decals. */
void decals_mark(struct scene *scene);
/* The decals of a picture, malloc'd. Their pixels get STENCIL_DECAL. */
struct decal *decals_draw(const struct view *view, struct pixel *pixels, struct glint_error *err);
/* Lights the pixels with the decals' albedo; the G-buffer's own stays. Call it once. */
void decals_light(const struct decal *decals, const struct view *view, struct pixel *pixels);
bool decals_write(const struct dump *dump, const struct decal *decals, struct glint_error *err);

#endif
