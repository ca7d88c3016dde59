/* A pipeline: one variant for each slot in it, with the values of its parameters. */
#ifndef GLINT_REPLAY_PIPELINE_H
#define GLINT_REPLAY_PIPELINE_H

#include "glint/replay.h"

struct pipeline_pass {
    const struct glint_pass *pass;
    double *values; /* parallel to the pass's rows; 0 for rows that are no parameter */
    char *shader;   /* path of the user's shader, or NULL */
};

struct glint_pipeline {
    char *name;
    struct pipeline_pass *passes; /* ordered by slot */
    size_t count;
    uint32_t rays;      /* rays a pixel; 0: 1 */
    uint32_t first_ray; /* index of the first ray */
};

enum { RAYS_MAX = 1024, FIRST_RAY_MAX = 1 << 24 };
const struct pipeline_pass *pipeline_find(const struct glint_pipeline *pipeline, const char *slot);
/* NULL if the pass has no such parameter. */
const double *pipeline_value(const struct pipeline_pass *entry, const char *parameter);

/* Puts a variant into a slot; "none" removes the slot. */
bool pipeline_use(struct glint_pipeline *pipeline, const char *slot, const char *variant, struct glint_error *err);

/* Whether a pass of the pipeline makes the reflection of every surface visible, also without specular and metalness. */
bool pipeline_shows_all(const struct glint_pipeline *pipeline);
/* Whether a variant of the pipeline traces every pixel. */
bool pipeline_traces_all_pixels(const struct glint_pipeline *pipeline);
/* The roughness limits of the tile ranges in rows DISPATCH_LIST: the highest of any smooth range and the lowest of any rough one. */
void pipeline_classes(const struct glint_pipeline *pipeline, float *smooth, float *rough);

#endif
