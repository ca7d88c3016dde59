/* Figures over all captures of a comparison, and over those with each tag. */
#ifndef GLINT_VIEWER_COMPARE_OVERALL_H
#define GLINT_VIEWER_COMPARE_OVERALL_H

#include "compare/compare.h"

enum { CONTEST_PAIRED = 2 }; /* the figures whose differences are of interest: the first of enum contest_figure */

/* Captures with a tag. */
struct contest_group {
    const struct capture_group *of;
    size_t best;                /* the preset with the least mean error */
    struct glint_figure *means; /* [preset][CONTEST_FIGURES] */
    /* [a][b][CONTEST_PAIRED]: the mean of b's figure less a's in the same capture, of the captures that have both. */
    struct glint_figure *pairs;
};
struct contest_overall {
    struct capture_groups captures;
    struct contest_group *groups; /* one for each of theirs */
    size_t *order;                /* the captures with the largest errors first, those that could not be read last */
    size_t unreadable;
};
bool contest_overall_find(struct contest_overall *overall, const struct contest_log *log, struct glint_error *err);
void contest_overall_finish(struct contest_overall *overall);
/* The largest error of any preset over the pixels that all presets cover, by which captures are ordered; NAN if none is known. */
double contest_worst_error(const struct contest_log *log, size_t capture);

/* Prints the figures; of more captures than are shown whole also a row for each, the worst first. */
void contest_print_overall(const struct contest_table *table, const struct contest_overall *overall);
json_t *contest_overall_json(const struct contest_table *table, const struct contest_overall *overall);
/* Sections of the page: the figures, and the captures as rows if `rows`. */
void contest_page_figures(json_t *document, const struct contest_table *table, const struct contest_overall *overall);
void contest_page_rows(json_t *document, const struct contest_table *table, const struct contest_overall *overall);

#endif
