/* What the values of an image are, in numbers. */
#ifndef GLINT_VIEWER_VIEW_STATISTICS_H
#define GLINT_VIEWER_VIEW_STATISTICS_H

#include <jansson.h>

#include "draw/view/falsecolor.h"

enum { STATISTICS_BINS_MAX = 4096 };

struct statistics_options {
    bool table, histogram, json;
    uint32_t bins;
    struct falsecolor_options range; /* ends and scale of histograms; without them, all finite values */
};

/* Prints what is asked for, by channel, to stdout. */
bool statistics_print(const struct source *source, const struct statistics_options *options, struct glint_error *err);

#endif
