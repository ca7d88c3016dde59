/* FLIP of two images that a display shows. */
#ifndef GLINT_STUDY_FLIP_H
#define GLINT_STUDY_FLIP_H

#include "comparison.h"
#include "filter.h"

enum { FOUND, TRUTH, IMAGES };

/* What the color and the feature pipeline make of an image: planes of floats. */
struct flip_image {
    float *lab[3]; /* filtered, in L*a*b* with Hunt's adjustment */
    float *edge, *point;
};

struct flip {
    const struct comparison *c;
    size_t pixels;
    struct kernel achromatic, red_green, blue_yellow[2], smooth, edge, point;
    float share[2]; /* of the two Gaussians of blue-yellow */
    float *planes;  /* all of the following */
    float *opponent[3], *work[4];
    struct flip_image of[IMAGES];
    float exposure; /* the shown image's, f-stops */
    bool tone_mapped;
    bool found; /* which image is being made */
    float *map; /* the larger of it and the new value is kept */
};

bool flip_begin(struct flip *flip, const struct comparison *c, struct glint_error *err);
void flip_end(struct flip *flip);
/* Both images at an exposure, clipped to [0, 1] or tone mapped, into `map`. */
void flip_add(struct flip *flip, double exposure, bool tone_mapped, float *map);

#endif
