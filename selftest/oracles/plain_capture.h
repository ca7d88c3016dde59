/* Small captures by closed form. */
#ifndef GLINT_SELFTEST_PLAIN_CAPTURE_H
#define GLINT_SELFTEST_PLAIN_CAPTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/capture.h"

/* Planes of values, in this order. */
enum plain_channel {
    PLAIN_DEPTH,
    PLAIN_NORMAL_X,
    PLAIN_NORMAL_Y,
    PLAIN_NORMAL_Z,
    PLAIN_ROUGHNESS,
    PLAIN_METALNESS,
    PLAIN_SPECULAR,
    PLAIN_ALBEDO_R,
    PLAIN_ALBEDO_G,
    PLAIN_ALBEDO_B,
    PLAIN_MOTION_X,
    PLAIN_MOTION_Y,
    PLAIN_LIT_R,
    PLAIN_LIT_G,
    PLAIN_LIT_B,
    PLAIN_CHANNELS
};

/* The camera at the origin looks along -z at the wall z = -5 m; with `floor`, y = -1 m is a mirror-like floor below it and
   the wall's light depends on the place. */
struct plain {
    uint32_t width, height;
    float roughness;
    double fov_y_degrees;
    bool floor;
    /* Changes the values before they are written; NULL: not. values[channel · pixels + y · width + x]. */
    void (*spoil)(const struct plain *plain, float *values);
    const float *scene;    /* R G B of the finished picture everywhere; NULL: none */
    const float *fresnel;  /* material.fresnel everywhere; NULL: none */
    const float *motion_m; /* motion.Z everywhere; NULL: none */
    void (*vertex_normal)(const struct plain *plain, uint32_t x, uint32_t y, float out[3]); /* NULL: none */
    bool
        foreground; /* the right half has stencil id 5, which is of the class `foreground`: its bits 6 are 4; the left one 7 */
    const char *class_name; /* the class of that id; NULL: foreground */
    uint32_t frame;         /* number; 0: 1 */
    bool first;             /* the number is 0 */
    bool cut;
    double exposure;                             /* of the frame; 0: 1 */
    const double *lut_stops;                     /* 2 values; NULL: none */
    double jitter_px[2], previous_jitter_px[2];  /* of the projection; the wall's motion says both */
    const double *world_to_view;                 /* 16 values; NULL: as above */
    const struct glint_fog *fog;                 /* NULL: none */
    const struct glint_atmosphere *atmosphere;   /* NULL: none */
    const struct glint_clouds *clouds;           /* NULL: none; their textures are parts */
    const struct glint_material_model *material; /* NULL: as the format has it */
    const struct glint_sun *sun;                 /* NULL: none */
    const struct glint_light *lights;            /* light_count of them */
    uint32_t light_count;
    float (*sun_mask)(const struct plain *plain, uint32_t x, uint32_t y); /* NULL: none */
    /* The sun's shadow map, 256 wide; NULL: none. */
    float (*shadow_map)(const struct plain *plain, double u, double v);
    struct glint_shadow shadow;
    /* More maps, from shadow.001 on, each half as wide as the one before; 0: none. */
    float (*cascade)(const struct plain *plain, uint32_t number, double u, double v);
    const struct glint_shadow *cascades;
    uint32_t cascade_count;
    enum glint_axis up;
    enum glint_compression compression;
    const void *user; /* for `spoil` */
    /* Cube maps, cube_size wide: R G B A and distance in a unit direction. NULL: none. */
    uint32_t cube_size, cube_count;
    bool color_only; /* without distances */
    struct glint_cubemap cubes[4];
    void (*cube)(uint32_t number, const double direction[3], float out[5]);
    double (*distance)(uint32_t number, const double direction[3]); /* instead of `cube`: all white, in less memory */
    void (*sky)(const double direction[3], float out[3]);           /* as wide as the cube maps; NULL: none */
    /* What lies over the picture at a pixel; NULL: nothing. Colour, opacity, normal and depth, then the water's thickness or
       the pane's roughness; a depth of +inf: nothing there. */
    void (*water)(uint32_t x, uint32_t y, float out[9]);
    void (*pane)(uint32_t x, uint32_t y, float out[9]);
    const struct glint_part *part; /* one part more, or part_count of them; NULL: none */
    uint32_t part_count;
};
bool plain_write(const char *path, const struct plain *plain, struct glint_error *err);

/* Unit direction of a texel of a face (+X -X +Y -Y +Z -Z) in Vulkan's orientation; x and y may be any place on it. */
void plain_direction(uint32_t face, double x, double y, uint32_t size, double out[3]);

#endif
