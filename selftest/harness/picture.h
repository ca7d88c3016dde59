/* Replays small captures, and reads their images. */
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

/* The shortest pipeline with additional slots as in a preset, each followed by a comma. */
bool pictures_begin(struct pictures *pictures, const struct case_context *context, const char *slots,
                    struct glint_error *err);
/* A preset by its name. */
bool pictures_begin_preset(struct pictures *pictures, const struct case_context *context, const char *preset,
                           struct glint_error *err);
void pictures_end(struct pictures *pictures);
/* Replays a capture, whose images are valid until the next call; images are in half if requested. */
bool pictures_replay(struct pictures *pictures, const char *path, const struct glint_replay_options *options,
                     struct glint_error *err);
bool pictures_box(struct pictures *pictures, const struct open_box *box, struct glint_error *err);
bool pictures_read(const struct pictures *pictures, const char *image, struct picture *out, struct glint_error *err);
/* The composed image of a capture in floats. */
bool pictures_compose(struct pictures *pictures, const char *path, struct picture *out, struct glint_error *err);

/* A difference beyond `bound`, by at most `within`, is a tie. */
struct picture_ties {
    double bound, within;
};
/* Adds the largest absolute difference of components to a finding. Infinities in both are equal. skip: pixels that are not compared;
   NULL: none. ties: NULL: none. */
void pictures_compare(const struct picture *expected, const struct picture *found, const bool *skip,
                      const struct picture_ties *ties, struct glint_selftest_finding *finding);

#endif
