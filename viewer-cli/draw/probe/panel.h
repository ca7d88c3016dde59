/* Panels of a drawing as SVG: two axes, filled profiles, lines and marks. */
#ifndef GLINT_VIEWER_PROBE_PANEL_H
#define GLINT_VIEWER_PROBE_PANEL_H

#include <stdbool.h>
#include <stdio.h>

enum panel_scale {
    PANEL_LINEAR,
    PANEL_LOG,
    PANEL_INVERSE /* linear in 1/value, in which planes in space are straight lines */
};

struct panel_axis {
    const char *name;
    enum panel_scale scale;
    double low, high; /* high of PANEL_INVERSE may be +inf */
};
struct panel {
    FILE *out;
    double left, top, width, height; /* plot area in px */
    struct panel_axis x, y;
};

double panel_x(const struct panel *panel, double value);
double panel_y(const struct panel *panel, double value);
bool panel_shows(const struct panel *panel, double x);

/* Writes a text with SVG's special characters escaped. */
void svg_text(FILE *out, const char *text);
/* Begins the panel with its title, a subtitle, the grid and the labelled axes. What is drawn until panel_end is clipped to it. */
void panel_begin(const struct panel *panel, const char *title, const char *subtitle);
void panel_end(const struct panel *panel);
/* Draws a line through points in units of the axes; NaN interrupts it. `style`: SVG attributes. */
void panel_line(const struct panel *panel, const double (*points)[2], size_t count, const char *style);
/* The same, filled up to the top of the panel. */
void panel_solid(const struct panel *panel, const double (*points)[2], size_t count, const char *style);
void panel_mark(const struct panel *panel, double x, double y, double radius, const char *style, const char *hint);
/* Draws a vertical line at x, with a label at the top of the panel in line `row`. */
void panel_across(const struct panel *panel, double x, int row, const char *label, const char *color);

#endif
