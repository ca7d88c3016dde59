/* The panels of a pixel's drawing. */
#ifndef GLINT_VIEWER_PROBE_DRAW_H
#define GLINT_VIEWER_PROBE_DRAW_H

#include "probe/panel.h"
#include "probe/probe.h"

enum { DRAW_POINTS = 900, DRAW_LOOKS = 12 };

/* What one pass told of one ray. */
struct told {
    const struct glint_probe_record *records;
    size_t count;
};
/* The last one of this kind, or NULL. */
const struct glint_probe_record *told_last(const struct told *told, const char *kind);

struct drawing {
    FILE *out;
    const struct probe *probe;
    double top;            /* of the next panel */
    bool used[DRAW_LOOKS]; /* for the legend */
    json_t *uri;           /* the picture as a text; NULL: there is none */
    double (*points)[2];   /* DRAW_POINTS of them, for one curve at a time */
};

double draw_value(const struct glint_probe_record *record, const char *name);
/* The next panel, without its axes. */
struct panel draw_panel(const struct drawing *drawing);
/* Title, what the pass says of the ray's end, axes. */
void draw_begin(const struct panel *panel, const char *title, const struct told *told, const char *kind);
/* The points as what is seen, with all that lies behind it. */
void draw_seen(const struct drawing *drawing, const struct panel *panel);
/* Colour of a step's decision. */
const char *draw_color(const struct glint_probe_record *step);
void draw_step(struct drawing *drawing, const struct panel *panel, const struct glint_probe_record *step, double x,
               double y, size_t number);
/* How far the reference's ray got when it hit, in the same slot; NaN when it did not. */
double draw_reference_m(const struct drawing *drawing, const struct told *told, const char *kind);
void draw_reference(const struct panel *panel, double x, double travelled_m);
void draw_end(struct drawing *drawing, const struct panel *panel);

/* The picture that the pipeline made, as a text for an image; and that text where <use href="#picture"/> finds it. */
json_t *draw_encode(const struct probe *probe, struct glint_error *err);
void draw_define(struct drawing *drawing);

/* Nothing where the pass told of no such ray. */
void draw_picture(struct drawing *drawing, const struct told *told, double left, double width);
void draw_screen(struct drawing *drawing, const struct told *told);
void draw_cubes(struct drawing *drawing, const struct told *told);
void draw_mixtures(struct drawing *drawing, const struct told *told);

#endif
