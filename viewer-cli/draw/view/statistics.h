/* Statistics of the values of an image. */
#ifndef GLINT_VIEWER_VIEW_STATISTICS_H
#define GLINT_VIEWER_VIEW_STATISTICS_H

#include <jansson.h>

#include "draw/view/falsecolor.h"

enum { STATISTICS_BINS_MAX = 4096 };

struct statistics_options {
    bool table, histogram, json;
    uint32_t bins;
    struct falsecolor_options range; /* range and scale of histograms; default: all finite values */
};

/* Prints the requested statistics of each channel to stdout. */
bool statistics_print(const struct source *source, const struct statistics_options *options, struct glint_error *err);
/* [{"channel", "min", "p1", "median", "p99", "max", "mean", "deviation", "finite", "zero", "nan", "infinite", "minus_infinite"}, …] of the
   channels; NULL on failure. */
json_t *statistics_json(const struct source *source, struct glint_error *err);

#endif
