/* Renders images of a world: the buffers of an engine's frame, cube maps, and the truth. */
#ifndef SAMPLES_RENDER_H
#define SAMPLES_RENDER_H

#include "parallel.h"
#include "view.h"
#include "world.h"

struct pixel {
    float depth; /* along the view axis; INFINITY: sky */
    vec3 normal; /* rounded to half floats as in the engine's G-buffer */
    vec3 vertex_normal, albedo;
    float roughness, metalness, specular;
    float motion[3]; /* previous uv minus current uv; likewise for depth, 0 for sky */
    uint32_t stencil;
    vec3 lit, indirect, emission, lamps; /* the latter three are parts of lit; 0 for sky */
};

/* The surface hit by the ray through a pixel's jittered centre. */
/* The surface at any point of the picture, in pixels, and the hit there, without motion; `odd`: stippled meshes are left out. */
struct pixel pixel_at(const struct world *world, const struct view *view, double x, double y, bool odd,
                      struct hit *hit);
struct hit primary_hit(const struct world *world, const struct view *view, uint32_t x, uint32_t y);

/* `pixels` has room for the size of the view. */
bool render_frame(const struct world *world, const struct view *view, const struct view *previous, struct pixel *pixels,
                  struct job *job, double weight, struct glint_error *err);

struct texel {
    vec3 color;
    float alpha;    /* 0: sky */
    float distance; /* from the centre; INFINITY: sky */
};

/* N × 6N texels: faces +X -X +Y -Y +Z -Z one below the other, oriented as in Vulkan. */
bool render_cubemap(const struct world *world, vec3 center, uint32_t size, struct texel *texels, struct job *job,
                    double weight, struct glint_error *err);
bool render_sky(const struct world *world, uint32_t size, struct texel *texels, struct job *job, double weight,
                struct glint_error *err);
vec3 cube_direction(uint32_t face, uint32_t x, uint32_t y, uint32_t size);

struct truth {
    vec3 ggx, blinn_phong;          /* mean radiance over the lobe */
    float ggx_weight, phong_weight; /* fraction of the samples that leave the surface; 0: no surface */
    float ggx_error, phong_error;   /* relative standard error of the mean's luminance */
    float distance, visible;        /* of the exact mirror ray; INFINITY: sky */
};

/* Accumulates the mean of several renderings. */
struct truth_sum {
    double color[2][3], square[2]; /* squared absolute errors */
    uint32_t count[2];
};
void truth_add(struct truth_sum *sum, const struct truth *truth);
/* Computes mean colours and errors; other members do not change. */
void truth_mean(const struct truth_sum *sum, struct truth *truth);

/* `first`: number of samples of the sequence that were used before; `finished`: includes what the hit surfaces reflect. */
bool render_truth(const struct world *world, const struct view *view, const struct pixel *pixels, uint32_t samples,
                  uint32_t first, bool finished, struct truth *truth, struct job *job, double weight,
                  struct glint_error *err);

/* Averages lobes over all jitter positions of a pixel that show a surface. Distances stay those of the sample. */
bool truth_average(const struct world *world, const struct glint_sample_options *options, uint32_t number,
                   struct truth *truth, struct job *job, struct glint_error *err);

#endif
