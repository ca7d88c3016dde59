/* Panels of a drawing: two axes, a profile, lines and marks, as SVG. */
#ifndef GLINT_VIEWER_PROBE_PANEL_H
#define GLINT_VIEWER_PROBE_PANEL_H

#include <stdbool.h>
#include <stdio.h>

enum panel_scale {
    PANEL_LINEAR,
    PANEL_LOG,
    PANEL_INVERSE /* in 1/value: what is a plane in space is a straight line */
};

struct panel_axis {
    const char *name;
    enum panel_scale scale;
    double low, high; /* high of PANEL_INVERSE may be +inf */
};
struct panel {
    FILE *out;
    double left, top, width, height; /* of the area within the axes, in px */
    struct panel_axis x, y;
};

double panel_x(const struct panel *panel, double value);
double panel_y(const struct panel *panel, double value);
bool panel_shows(const struct panel *panel, double x); /* within the axis */

/* Escapes what a text may not hold in SVG. */
void svg_text(FILE *out, const char *text);
/* Opens the panel with its title, a line under it, grid, ticks and the axes' names; what follows is cut at its border. */
void panel_begin(const struct panel *panel, const char *title, const char *subtitle);
void panel_end(const struct panel *panel);
/* A line through points, values of the axes; points that are NaN break it. `style`: SVG attributes. */
void panel_line(const struct panel *panel, const double (*points)[2], size_t count, const char *style);
/* The same, filled up to the top of the panel. */
void panel_solid(const struct panel *panel, const double (*points)[2], size_t count, const char *style);
void panel_mark(const struct panel *panel, double x, double y, double radius, const char *style, const char *hint);
/* A line across at x, labelled at the top of the panel; `row`: below how many other labels. */
void panel_across(const struct panel *panel, double x, int row, const char *label, const char *color);

#endif
