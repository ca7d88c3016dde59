/* Values as colours, with a legend that says what they mean. */
#ifndef GLINT_VIEWER_FALSECOLOR_H
#define GLINT_VIEWER_FALSECOLOR_H

#include "draw/view/picture.h"
#include "draw/view/source.h"

/* Depth, steps and weight are distances with a scale of their own: logarithmic, from 0, 0 to 1. */
enum kind {
    KIND_AUTO,
    KIND_COLOR,
    KIND_DISTANCE,
    KIND_DEPTH,
    KIND_STEPS,
    KIND_WEIGHT,
    KIND_NORMAL,
    KIND_INDEX,
    KIND_REASON,
    KIND_INVALID,
    KIND_RAW
};
extern const char *const kind_names[]; /* "auto", "color", …, NULL */

enum scale { SCALE_AUTO, SCALE_LINEAR, SCALE_LOG }; /* auto: logarithmic for lengths over more than 1 : 20 */

struct falsecolor_options {
    enum scale scale;
    bool range_given;
    double low, high;
    bool percentiles_given; /* else 0.5 and 99.5 */
    double percentiles[2];
};

/* What a source most likely is: from its unit and the names of its channels. */
enum kind kind_of(const struct source *source);

/* A scale for `falsecolor_draw`: what its legend will say. */
struct legend {
    enum kind kind;
    char title[400];
    double low, high;
    bool logarithmic, has_infinite, has_invalid, has_none; /* has_none: texels without a value, -inf */
    bool has_zero;                                         /* 0 or less on a logarithmic scale */
    double shares[257];                                    /* of each index, the last for all others; sums to 1 */
};

/* Every kind but KIND_COLOR. Without a range, percentiles of the finite values. */
bool falsecolor_draw(struct picture *picture, struct legend *legend, const struct source *source, enum kind kind,
                     const struct falsecolor_options *options, struct glint_error *err);
/* Its legend alone: the range, and whether it is logarithmic. */
bool falsecolor_prepare(struct legend *legend, const struct source *source, enum kind kind,
                        const struct falsecolor_options *options, struct glint_error *err);
/* A colour image's name, and nothing else. */
struct legend legend_of_color(const struct source *source);
/* Puts "LABEL: " before its title; the label ends at a slash. */
void legend_label(struct legend *legend, const char *label);
/* Adds the legend below the picture. */
bool legend_add(struct picture *picture, const struct legend *legend, struct glint_error *err);

#endif
