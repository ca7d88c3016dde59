/* A table of colours made by OpenColorIO, as the part lut of a capture. */
#ifndef GLINT_VIEWER_LUT_H
#define GLINT_VIEWER_LUT_H

#include "draw/view/ocio.h"
#include "glint/edit.h"

enum { LUT_SIZE = 65, LUT_SIZE_MAX = 128, LUT_STOPS_LOW = -10, LUT_STOPS_HIGH = 7 };

struct lut_options {
    struct ocio_options ocio;
    uint32_t size;   /* entries in a row */
    double stops[2]; /* glint.lutStops */
};

/* Adds the part, or replaces it: what the view shows of linear light, as the display gets it, limited to [0, 1]. */
bool lut_add(struct glint_edit *edit, const struct lut_options *options, struct glint_error *err);

#endif
