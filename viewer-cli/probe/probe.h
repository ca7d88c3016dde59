/* Records of one pixel through a pipeline: read from a replay, and written as text, JSON and a drawing. */
#ifndef GLINT_VIEWER_PROBE_H
#define GLINT_VIEWER_PROBE_H

#include <jansson.h>
#include <stdio.h>

#include "glint/probe.h"

/* The value of an image at the pixel, or at its texel if the image has the pipeline's resolution. */
struct probe_value {
    const struct glint_pass *pass; /* NULL: an image of the capture */
    const struct glint_row *row;
    uint32_t count;
    double values[4];
};
/* An image as a whole; texels NULL: the run has none. */
struct probe_image {
    float *texels;
    uint32_t width, height, components;
};

/* Records and values of one pipeline. */
struct probe_side {
    struct glint_pass_result *passes;
    size_t pass_count;
    struct glint_probe_trace trace;
    struct probe_value *values; /* in the order of passes, the capture's first */
    size_t value_count;
    struct probe_image depth_half, cubemap_distance, active_center;
    struct probe_image picture; /* the last one that the pipeline made */
    uint32_t cubemaps[16];      /* number of the capture's cube map in each place */
    uint32_t cubemap_count;
};

struct probe {
    const char *capture, *preset, *device;
    uint32_t pixel[2], texel[2], full[2], half[2];
    struct probe_side own, reference;
    bool has_reference;
};

/* read.c: runs the pipeline with the pixel probed. `progress` may be NULL. */
bool probe_run(struct probe *probe, struct probe_side *side, struct glint_replay *replay,
               const struct glint_pipeline *pipeline, const struct glint_replay_options *options,
               glint_progress progress, void *user, struct glint_error *err);
/* The pipeline with the reference tracers, which skip nothing; all other passes stay. */
struct glint_pipeline *probe_reference(const struct glint_pipeline *pipeline, struct glint_error *err);
void probe_side_finish(struct probe_side *side);
/* The last record of this kind by a pass of the slot; NULL: none. */
const struct glint_probe_record *probe_last(const struct probe_side *side, const char *slot, const char *kind);
/* "cubemap.003"; "none" where there is none. Static storage for a few calls. */
const char *probe_cubemap(const struct probe_side *side, double place);

/* Values of a record that belong together: a number, or NAME_x, NAME_y and NAME_z. */
struct probe_group {
    const char *unit;
    char name[32];
    size_t first, count;
};
size_t probe_groups(const struct glint_probe_row *kind, struct probe_group groups[GLINT_PROBE_VALUES]);
/* The same as text; enumerated values become words. */
void probe_group_text(const struct probe_side *side, const struct glint_probe_record *record,
                      const struct probe_group *group, char *text, size_t size);

/* text.c, json.c */
void probe_print(FILE *out, const struct probe *probe);
json_t *probe_json(const struct probe *probe);

#endif
