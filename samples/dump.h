/* Writes buffers as parts of a capture, as an engine would store them: encoded, rounded, declared. */
#ifndef SAMPLES_DUMP_H
#define SAMPLES_DUMP_H

#include "glass.h"
#include "water.h"

struct dump {
    const char *settings; /* settings attribute of parts without attributes of their own; NULL: none */
    struct glint_writer *writer;
    struct glint_encodings encodings;
    double pre_exposure; /* for pre-exposed colour */
    const struct view *view;
};

/* `name` is "gbuffer" or "previous.gbuffer". Normals in view space are in that of the given view. */
bool dump_gbuffer(const struct dump *dump, const char *name, const struct view *view, const struct pixel *pixels,
                  struct glint_error *err);
bool dump_lit(const struct dump *dump, const char *name, const struct pixel *pixels, struct glint_error *err);
bool dump_cubemap(const struct dump *dump, uint32_t index, const struct glint_cubemap *map, uint32_t size,
                  const struct texel *texels, struct glint_error *err);
/* A cube map whose pixels are in another file. */
bool dump_cubemap_elsewhere(const struct dump *dump, uint32_t index, const struct glint_cubemap *map, uint32_t size,
                            const char *sibling, struct glint_error *err);
bool dump_sky(const struct dump *dump, uint32_t size, const struct texel *texels, struct glint_error *err);
bool dump_water(const struct dump *dump, const struct water_pixel *water, struct glint_error *err);
/* Colours of the picture's size. */
bool dump_picture(const struct dump *dump, const char *name, const vec3 *first, size_t stride_bytes,
                  struct glint_error *err);
/* The final image. */
bool dump_scene(const struct dump *dump, const vec3 *scene, size_t stride_bytes, struct glint_error *err);
bool dump_glass(const struct dump *dump, const struct glass_pixel *glass, struct glint_error *err);
/* Rendered by the mirrored camera; `planar` holds the plane and that camera as stored. */
bool dump_planar(const struct dump *dump, const struct view *mirrored, const struct glint_planar *planar,
                 const struct texel *texels, struct glint_error *err);
bool dump_truth(const struct dump *dump, const struct truth *truth, uint32_t samples, struct glint_error *err);

#endif
