/* A run's images in one EXR file for other programs. */
#ifndef GLINT_VIEWER_EXPORT_H
#define GLINT_VIEWER_EXPORT_H

#include <jansson.h>

#include "glint/replay.h"
#include "options/args.h"

struct export_options {
    const char *run, *out;
    bool multilayer;
    struct list images; /* empty: all */
};

/* What became of the images, for a message. */
struct export_counts {
    size_t written, enlarged, left_out;
    uint32_t width, height; /* of the picture */
    bool camera;            /* false: the run was written before run.json had the whole camera */
};

/* Writes the file, complete or not at all. */
bool export_run(const struct export_options *options, struct export_counts *counts, struct glint_error *err);

#endif
