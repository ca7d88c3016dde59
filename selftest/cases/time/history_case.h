/* Cases of the group "time": the frames of a shot, and the history that each pixel may use. */
#ifndef GLINT_SELFTEST_HISTORY_CASE_H
#define GLINT_SELFTEST_HISTORY_CASE_H

#include "harness/frames.h"

/* Texels of the previous frame with weights that sum to 1, and the number of samples that they count for. */
struct history_texels {
    size_t count; /* 0: there is no history */
    size_t pixel[4];
    double weight[4], longest;
};

struct shot {
    const char *name, *what;
    const char *settings[5]; /* as frames_begin() takes them; NULL-terminated */
    bool sharp;              /* checks temporal_sharp instead of temporal */
    bool summed;             /* compared with a history in double precision instead of the device's history */
    bool half;               /* images have their declared formats */
    int frames;
    void (*stage)(struct frame *frame, int n); /* changes frame n, counted from 1; or NULL */
    /* Changes *past, which is the pixel's own position with 15 samples, to the pixel's history; NULL: no change. */
    void (*past)(const struct frame *frame, int n, size_t pixel, struct history_texels *past);
    /* Changes the pixel's own colour and sample count of 1 to those that the frame itself yields; NULL: no change. */
    void (*now)(const struct frame *frame, size_t pixel, bool has_past, double color[4], double *samples);
    /* Changes the colour of the history; NULL: no change. */
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

/* The four texels around a position (0.5 is the centre of the first texel) that are in the picture and have a weight of at least 0.001. */
void history_texels_at(struct history_texels *past, double x, double y);

#endif
