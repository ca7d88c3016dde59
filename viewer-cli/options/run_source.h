/* What a run was made of, as its run.json states it, so that it can be replayed. */
#ifndef GLINT_VIEWER_RUN_SOURCE_H
#define GLINT_VIEWER_RUN_SOURCE_H

#include "glint/replay.h"

struct run_source {
    struct glint_pipeline *pipeline; /* its variants and values, also those of a preset that is no longer there */
    bool all, float_precision;
    char capture[4096], history[4096], inputs[4096]; /* "": none */
    char hash[33];                                   /* glint_capture_hash of the capture; "": unknown */
};

/* Files that run.json names are looked for as they are written, and then from the folder in which the run lies. */
bool run_source_read(struct run_source *source, const char *folder, struct glint_error *err);
/* Fails if the capture is not the one that the run was made of. */
bool run_source_fits(const struct run_source *source, const char *folder, struct glint_capture *capture,
                     struct glint_error *err);
void run_source_finish(struct run_source *source);

#endif
