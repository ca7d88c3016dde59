/* Small captures through a pipeline, and the images that come of them. */
#ifndef GLINT_SELFTEST_PICTURE_H
#define GLINT_SELFTEST_PICTURE_H

#include "harness/case.h"
#include "oracles/open_box.h"

struct picture {
    union {
        float *values; /* the caller frees */
        uint32_t *whole;
    };
    uint32_t width, height, components;
    bool whole_numbers;
};

struct pictures {
    const struct case_context *context;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
    struct glint_capture *capture; /* of the last replay */
};

/* The shortest pipeline, with more slots, as in a preset, each with a comma after it. */
bool pictures_begin(struct pictures *pictures, const struct case_context *context, const char *slots,
                    struct glint_error *err);
/* A preset by its name. */
bool pictures_begin_preset(struct pictures *pictures, const struct case_context *context, const char *preset,
                           struct glint_error *err);
void pictures_end(struct pictures *pictures);
/* Replays a capture. Its images are there until the next one; images in half where options say so. */
bool pictures_replay(struct pictures *pictures, const char *path, const struct glint_replay_options *options,
                     struct glint_error *err);
bool pictures_box(struct pictures *pictures, const struct open_box *box, struct glint_error *err);
bool pictures_read(const struct pictures *pictures, const char *image, struct picture *out, struct glint_error *err);
/* The composed picture of a capture, in floats. */
bool pictures_compose(struct pictures *pictures, const char *path, struct picture *out, struct glint_error *err);

/* A difference beyond `bound`, by no more than `within`, is a tie. */
struct picture_ties {
    double bound, within;
};
/* The largest difference of two pictures' components, in absolute values: into a finding. Components that are infinite in
   both agree. skip: pixels that are not compared; NULL: all are. ties: NULL: none. */
void pictures_compare(const struct picture *expected, const struct picture *found, const bool *skip,
                      const struct picture_ties *ties, struct glint_selftest_finding *finding);

#endif
