/* A stand-in for an engine: what it has in memory once a frame's textures are read back. integration.c and integration.cc make a
   capture of it, and light.c one with its light and shadows; an engine has its own structures in this place. */
#ifndef ENGINE_H
#define ENGINE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A texture as read back: rows are further apart than their pixels need, as graphics APIs want them. */
struct engine_texture {
    uint32_t width, height;
    size_t pixel_bytes, row_bytes;
    uint8_t *bytes;
};

struct engine_camera {
    double world_to_view[16], view_to_clip[16]; /* row-major, for column vectors; the projection contains the jitter */
    double jitter_px[2];
};

struct engine_probe {
    double position[3];
    struct engine_texture color;    /* RGBA16F, six faces below each other; alpha is 0 where sky is seen */
    struct engine_texture distance; /* R32F; +inf where sky is seen */
};

struct engine_sun {
    double direction[3]; /* unit vector in world space, towards the sun */
    double irradiance;   /* white, on a surface that faces the sun */
};

struct engine_shadow {
    double world_to_shadow
        [16]; /* row-major, for column vectors: x and y in [-1, 1] over the map, y up, and z as `depth` has it */
    struct engine_texture depth; /* R32F, 0 at the sun's end */
};

#define ENGINE_PROBES 2
struct engine_frame {
    uint32_t number;
    struct engine_camera camera, previous;
    struct engine_texture depth;    /* D32F, reversed, no far plane */
    struct engine_texture normal;   /* RG16, octahedral, world space */
    struct engine_texture material; /* RGBA8: roughness, metalness, specular, unused */
    struct engine_texture albedo;   /* RGBA8 */
    struct engine_texture motion;   /* RG32F: previous uv minus current uv */
    struct engine_texture lit;      /* RGBA16F: diffuse light and sky, linear */
    struct engine_texture ambient;  /* RGBA16F: the part of `lit` that is the sky's */
    struct engine_texture sky;      /* RGBA16F, six faces below each other */
    struct engine_sun sun;
    struct engine_shadow shadow;
    struct engine_probe probes[ENGINE_PROBES];
};

/* Renders a frame of a walled yard under a clear sky. NULL if memory is exhausted. */
struct engine_frame *engine_render(uint32_t number);
void engine_free(struct engine_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
