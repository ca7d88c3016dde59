/* The final comparison over all captures and over those with each tag, and which captures are the worst. */
#ifndef GLINT_VIEWER_TUNE_OVERALL_H
#define GLINT_VIEWER_TUNE_OVERALL_H

#include "groups/groups.h"
#include "tune/tune.h"

/* Finds the figures and the order of the captures, when they are measured. */
bool tune_sum_up(struct tune *tune, struct glint_error *err);
void tune_overall_finish(struct tune *tune);
/* The subjects in the order in which they are told: the largest error of the tuned preset first, those that are left out after them, held-out ones last. */
size_t tune_ranked(const struct tune *tune, size_t place);
/* Whether the subject at this place is told whole, which the first ten are. */
bool tune_is_shown(const struct tune *tune, size_t place);
/* Prints the figures, and a row for each capture that is left out, or of more than ten for all. */
void tune_print_overall(const struct tune *tune);
/* The figures as JSON; and as sections of the page, with the same rows. */
json_t *tune_overall_json(const struct tune *tune);
void tune_page_overall(const struct tune *tune, json_t *document);

#endif
