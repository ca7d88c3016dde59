/* What the panels of a pixel's drawing share. */
#ifndef GLINT_VIEWER_PROBE_DRAWING_H
#define GLINT_VIEWER_PROBE_DRAWING_H

#include "draw/probe/panel.h"
#include "probe/probe.h"

enum { DRAW_POINTS = 900, DRAW_LOOKS = 12 };

/* What one pass recorded of one ray. */
struct ray_records {
    const struct glint_probe_record *records;
    size_t count;
};
/* The last one of this kind, or NULL. */
const struct glint_probe_record *ray_records_last(const struct ray_records *records, const char *kind);

/* Sizes in px: the whole, and the area of a panel, whose next one lies DRAW_STRIDE below. */
enum {
    DRAW_WIDTH = 1000,
    DRAW_LEFT = 76,
    DRAW_AREA = DRAW_WIDTH - DRAW_LEFT - 24,
    DRAW_HEIGHT = 260,
    DRAW_STRIDE = DRAW_HEIGHT + 116
};

/* A colour for each decision, by its name. */
struct draw_look {
    const char *decision, *color;
};
extern const struct draw_look draw_looks[DRAW_LOOKS];

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
void draw_begin(const struct panel *panel, const char *title, const struct ray_records *records, const char *kind);
/* The points as what is seen, with all that lies behind it. */
void draw_seen(const struct drawing *drawing, const struct panel *panel);
/* Colour of a step's decision. */
const char *draw_decision_color(const struct glint_probe_record *step);
void draw_step(struct drawing *drawing, const struct panel *panel, const struct glint_probe_record *step, double x,
               double y, size_t number);
/* How far the reference's ray got when it hit, in the same slot; NaN when it did not. */
double draw_reference_m(const struct drawing *drawing, const struct ray_records *records, const char *kind);
void draw_reference(const struct panel *panel, double x, double travelled_m);
void draw_end(struct drawing *drawing, const struct panel *panel);

#endif
