/* Draws values as false colours, with a legend. */
#ifndef GLINT_VIEWER_FALSECOLOR_H
#define GLINT_VIEWER_FALSECOLOR_H

#include "draw/view/picture.h"
#include "draw/view/source.h"

/* Depth, steps and weights are drawn like distances with a fixed scale: logarithmic, from 0, and from 0 to 1. */
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

enum scale { SCALE_AUTO, SCALE_LINEAR, SCALE_LOG }; /* auto: logarithmic for lengths whose range is more than 1 : 20 */

struct falsecolor_options {
    enum scale scale;
    bool range_given;
    double low, high;
    bool percentiles_given; /* else the percentiles 0.5 and 99.5 */
    double percentiles[2];
};

/* Guesses the kind of a source from its unit and channel names. */
enum kind kind_of(const struct source *source);

/* The scale of a false-colour picture, as its legend shows it. */
struct legend {
    enum kind kind;
    char title[400];
    double low, high;
    bool logarithmic, has_infinite, has_invalid, has_none; /* has_none: texels without a value, -inf */
    bool has_zero;                                         /* values <= 0 on a logarithmic scale */
    double shares[257]; /* fraction of each index, the last one of all others; the sum is 1 */
};

/* Draws every kind but KIND_COLOR. Without a range, percentiles of the finite values are used. */
bool falsecolor_draw(struct picture *picture, struct legend *legend, const struct source *source, enum kind kind,
                     const struct falsecolor_options *options, struct glint_error *err);
/* Computes the legend only: the range and the scale. */
bool falsecolor_prepare(struct legend *legend, const struct source *source, enum kind kind,
                        const struct falsecolor_options *options, struct glint_error *err);
/* The legend of a colour image, which has only a title. */
struct legend legend_of_color(const struct source *source);
/* Puts "LABEL: " before the title; LABEL ends at a slash. */
void legend_label(struct legend *legend, const char *label);
/* What the legend lists: colours and what they stand for. */
struct legend_item {
    struct rgb color;
    char text[64];
    double share; /* of the pixels; -1: unknown */
};
struct legend_items {
    struct legend_item of[264];
    size_t count;
};
void legend_list(const struct legend *legend, struct legend_items *items);
bool legend_has_scale(const struct legend *legend); /* colours stand for values from `low` to `high` */
/* What a value is called, if it has a name: an end reason ("left screen"), or index 255 ("none"). */
bool legend_value_name(enum kind kind, double value, char name[64]);
/* Adds the legend below the picture. */
bool legend_add(struct picture *picture, const struct legend *legend, struct glint_error *err);

#endif
