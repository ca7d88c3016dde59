/* Cases of the group "time": what each frame of a shot is, and what its pixels may take of the frame before. */
#ifndef GLINT_SELFTEST_HISTORY_CASE_H
#define GLINT_SELFTEST_HISTORY_CASE_H

#include "harness/frames.h"

/* Texels of the frame before, with weights that sum to 1, and as many samples of them as count. */
struct history_texels {
    size_t count; /* 0: there is nothing */
    size_t pixel[4];
    double weight[4], longest;
};

struct shot {
    const char *name, *what;
    const char *settings[5]; /* as frames_begin() takes them; NULL-terminated */
    bool sharp;              /* temporal_sharp is looked at, not temporal */
    bool summed;             /* compared with the double's own history, not with what the device had a frame before */
    bool half;               /* images as passes declare them */
    int frames;
    void (*stage)(struct frame *frame, int n); /* what is not ordinary in frame n, from 1; NULL: nothing */
    /* From *past, which is the pixel's own place and 15 samples, to what the pixel has; NULL: it stays. */
    void (*past)(const struct frame *frame, int n, size_t pixel, struct history_texels *past);
    /* From the pixel's own colour and 1 to what the frame has by itself, and how many samples that is; NULL: they stay. */
    void (*now)(const struct frame *frame, size_t pixel, bool has_past, double color[4], double *samples);
    /* What is made of the history's colour; NULL: it stays. */
    void (*hold)(const struct frame *frame, size_t pixel, double color[4]);
    double bound;
    const char *reason;
};

struct shot_list {
    const struct shot *items;
    size_t count;
    const char *source; /* what all of them evaluate of passes/shared, beside the pass itself; or NULL */
};
extern const struct shot_list time_surfaces, time_views, time_sharp;

/* The four texels around a place (0.5 is the middle of the first one) that lie in the picture, without those of a weight
   below 0.001. */
void history_texels_at(struct history_texels *past, double x, double y);

#endif
