/* FLIP of two images as shown on a display. */
#ifndef GLINT_STUDY_FLIP_H
#define GLINT_STUDY_FLIP_H

#include "comparison.h"
#include "filter.h"

enum { FOUND, TRUTH, IMAGES };

/* Results of the color and the feature pipeline for an image: planes of floats. */
struct flip_image {
    float *lab[3]; /* filtered, in L*a*b* with Hunt's adjustment */
    float *edge, *point;
};

struct flip {
    const struct comparison *c;
    size_t pixels;
    struct kernel achromatic, red_green, blue_yellow[2], smooth, edge, point;
    float share[2];                         /* weights of the two Gaussians of blue-yellow */
    float *planes;                          /* memory of all following planes */
    float *opponent[3], *work[4], *lengths; /* lengths: where find_features writes */
    struct flip_image of[IMAGES];
    float exposure; /* f-stops */
    bool tone_mapped;
    bool found; /* which image is being processed */
    float *map; /* the result: the maximum over all calls */
};

bool flip_begin(struct flip *flip, const struct comparison *c, struct glint_error *err);
void flip_end(struct flip *flip);
/* Compares both images at an exposure, clipped to [0, 1] or tone mapped, and sets `map` to the maximum of its value and the result. */
void flip_add(struct flip *flip, double exposure, bool tone_mapped, float *map);

#endif
