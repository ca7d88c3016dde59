/* Small captures through a short pipeline. */
#ifndef GLINT_VIEWER_SELFTEST_PICTURE_H
#define GLINT_VIEWER_SELFTEST_PICTURE_H

#include "glint/samples.h"
#include "selftest.h"

struct picture_of {
    float *rgba; /* the caller frees */
    uint32_t width, height;
};

struct pictures {
    const struct selftest *test;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
};

/* 96 x 64, with cube maps of the very scene. */
extern const struct glint_sample_options pictures_sample;

/* slots: more of them, as in a preset, each with a comma after it. */
bool pictures_begin(struct pictures *pictures, const struct selftest *test, const char *slots, struct glint_error *err);
void pictures_end(struct pictures *pictures);
/* The composed picture of a capture, in floats. */
bool pictures_compose(const struct pictures *pictures, const char *path, struct picture_of *out,
                      struct glint_error *err);

#endif
