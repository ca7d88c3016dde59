/* The common parts of all panels of a drawing. */
#ifndef GLINT_VIEWER_PROBE_DRAWING_H
#define GLINT_VIEWER_PROBE_DRAWING_H

#include "draw/probe/panel.h"
#include "probe/probe.h"

enum { DRAW_POINTS = 900, DRAW_DECISIONS = 12 };

/* The records of one pass for one ray. */
struct ray_records {
    const struct glint_probe_record *records;
    size_t count;
};
/* The last record of this kind, or NULL. */
const struct glint_probe_record *ray_records_last(const struct ray_records *records, const char *kind);

/* Sizes in px of the drawing and of a panel's plot area. DRAW_STRIDE is the distance between the tops of two panels. */
enum {
    DRAW_WIDTH = 1000,
    DRAW_LEFT = 76,
    DRAW_AREA = DRAW_WIDTH - DRAW_LEFT - 24,
    DRAW_HEIGHT = 260,
    DRAW_STRIDE = DRAW_HEIGHT + 116
};

/* The colour of a decision. */
struct draw_decision {
    const char *decision, *color;
};
extern const struct draw_decision draw_decisions[DRAW_DECISIONS];

struct drawing {
    FILE *out;
    const struct probe *probe;
    double top;                /* of the next panel */
    bool used[DRAW_DECISIONS]; /* decisions that the legend explains */
    json_t *uri;               /* the final image as a data URI; NULL: none */
    double (*points)[2];       /* DRAW_POINTS points, reused for each curve */
};

bool draw_is_screen_step(const struct glint_probe_record *record);
double draw_value(const struct glint_probe_record *record, const char *name);
/* The next panel, without its axes. */
struct panel draw_panel(const struct drawing *drawing);
/* Draws the title, the end reason of the ray, and the axes. */
void draw_begin(const struct panel *panel, const char *title, const struct ray_records *records, const char *kind);
/* Draws the points as the visible surface, and fills the space behind it. */
void draw_surface(const struct drawing *drawing, const struct panel *panel);
const char *draw_decision_color(const struct glint_probe_record *step);
void draw_step(struct drawing *drawing, const struct panel *panel, const struct glint_probe_record *step, double x,
               double y, size_t number);
/* The distance at which the reference's ray of the same slot hits; NaN for a miss. */
double draw_reference_m(const struct drawing *drawing, const struct ray_records *records, const char *kind);
void draw_reference(const struct panel *panel, double x, double travelled_m);
void draw_end(struct drawing *drawing, const struct panel *panel);

#endif
