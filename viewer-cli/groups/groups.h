/* Figures over the captures of a set: of all, and of those with each tag; with intervals that take captures of one shot together. */
#ifndef GLINT_VIEWER_GROUPS_H
#define GLINT_VIEWER_GROUPS_H

#include <jansson.h>

#include "glint/metrics.h"
#include "io/table.h"
#include "options/args.h"

enum { CAPTURE_GROUPS = 1 + 64 }; /* of all captures, and of the first 64 tags */
/* Captures that are shown whole, with pictures: all, or the worst of more. */
enum { CAPTURES_SHOWN = 10 };

struct capture_group {
    const char *tag;        /* NULL: all captures */
    size_t captures, shots; /* those that count */
};
struct capture_groups {
    const struct list *captures;
    bool *counts; /* of each capture: it has results */
    struct capture_group of[CAPTURE_GROUPS];
    size_t count;
    size_t *
        shots; /* of each capture: captures of one shot resemble each other, and are drawn together for the intervals */
    size_t shot_count;
    double *values; /* of the group that is being averaged */
};
/* Finds the groups and shots of captures, of which those count that have results. Finish it even if this fails. */
bool capture_groups_find(struct capture_groups *groups, const struct list *captures, const bool *counts,
                         struct glint_error *err);
void capture_groups_finish(struct capture_groups *groups);
/* The mean over the captures of a group, with its 95 % interval by a bootstrap over shots. `values`: of all captures, NAN where it is not known. For a
   paired difference these are the differences in each capture. */
bool capture_groups_mean(const struct capture_groups *groups, size_t group, const double *values,
                         struct glint_figure *mean, struct glint_error *err);
/* The captures in order[]: those with the largest values first, then unknown ones, last those that do not count. */
bool capture_groups_rank(const struct capture_groups *groups, const double *values, size_t *order,
                         struct glint_error *err);

/* ---- shown.c: in tables, JSON and pages ---- */

/* What a row about a group begins with, its name ("all", or the tag), captures and shots: titles and cells of a table, the columns and a row of a page's table, and an
   object {"tag", "captures", "shots"}. */
#define GROUP_TITLES "<captures", ">number", ">shots"
void group_cells(struct table *table, const struct capture_group *group);
json_t *group_page_table(json_t *blocks);
json_t *group_page_row(const struct capture_group *group);
json_t *group_json(const struct capture_group *group);
/* "0.012 (0.010 to 0.014)", without an interval that is not known; "+0.012 (…)" for a difference. */
void figure_cell(struct table *table, const struct glint_figure *figure);
void difference_cell(struct table *table, const struct glint_figure *difference);
/* {"value", "low", "high"} */
json_t *figure_json(const struct glint_figure *figure);
/* A cell of a page, in units of 1 / factor. */
json_t *figure_page_cell(const struct glint_figure *figure, double factor);
/* "indoor, rain"; malloc'd. */
char *capture_tags_text(const struct list *captures, size_t capture);

#endif
