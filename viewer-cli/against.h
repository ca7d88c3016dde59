/* --against: how far a run is from a better answer, the truth in the capture or the preset `reference`. */
#ifndef GLINT_VIEWER_AGAINST_H
#define GLINT_VIEWER_AGAINST_H

#include <argp.h>
#include <jansson.h>

#include "glint/study.h"

struct against {
    bool truth, reference;
    bool all;                /* the reference runs every pass too */
    glint_progress progress; /* of the reference's replay */
    void *user;
    const char *run; /* the reference's run folder; NULL: it is replayed */
    struct glint_pipeline *pipeline;
    struct glint_replay *replay; /* its own, so that the history of the run it is compared with stays */
};

/* Reads "truth", "reference" or "reference=RUN". */
void against_parse(struct against *against, char *text, struct argp_state *state);
/* Makes ready for runs of `pipeline`; does nothing when there is nothing to compare with. */
bool against_begin(struct against *against, struct glint_device *device, const struct glint_pipeline *pipeline,
                   struct glint_error *err);
void against_finish(struct against *against);

struct comparison {
    const char *name; /* "truth", "reference" */
    bool has_rays, has_image, jittered;
    struct glint_trace_table rays;
    struct glint_image_errors image;
    char no_image[1024]; /* why, when there is none */
};
/* After a run. */
bool against_compare(struct against *against, struct glint_replay *replay, struct glint_capture *capture,
                     const struct glint_pipeline *pipeline, struct comparison *comparison, struct glint_error *err);
void against_print(const struct comparison *comparison);
json_t *against_json(const struct comparison *comparison);

#endif
