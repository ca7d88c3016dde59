/* A pipeline: one variant for each slot in it, with the values of its parameters. */
#ifndef GLINT_REPLAY_PIPELINE_H
#define GLINT_REPLAY_PIPELINE_H

#include "glint/replay.h"

struct pipeline_pass {
    const struct glint_pass *pass;
    double *values; /* one for each row; rows without a value hold 0 */
    char *shader;   /* the user's file, or NULL */
};

struct glint_pipeline {
    char *name;
    struct pipeline_pass *passes; /* ordered by slot */
    size_t count;
    uint32_t rays;      /* a frame; 0: 1 */
    uint32_t first_ray; /* number of the first one */
};

enum { RAYS_MAX = 1024, FIRST_RAY_MAX = 1 << 24 };
const struct pipeline_pass *pipeline_find(const struct glint_pipeline *pipeline, const char *slot);
/* NULL: the pass has no such parameter. */
const double *pipeline_value(const struct pipeline_pass *entry, const char *parameter);

/* Puts a variant into its slot; "none" empties it. */
bool pipeline_use(struct glint_pipeline *pipeline, const char *slot, const char *variant, struct glint_error *err);
bool pipeline_slot_exists(const char *slot); /* in any pipeline */
/* Fails with the slots that there are. */
bool pipeline_unknown_slot(const char *slot, struct glint_error *err);

/* Whether a pass of the pipeline shows the reflections of surfaces without specular and metal, too. */
bool pipeline_shows_all(const struct glint_pipeline *pipeline);
/* Whether a variant of the pipeline traces every pixel. */
bool pipeline_traces_all_pixels(const struct glint_pipeline *pipeline);
/* The largest roughness of a surface that some pass takes as smooth, and the least of a rough one: rows DISPATCH_LIST. */
void pipeline_classes(const struct glint_pipeline *pipeline, float *smooth, float *rough);

#endif
