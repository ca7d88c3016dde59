/* Parts of the search: axes as steps, points that were tried, the polishing by COBYLA. */
#ifndef GLINT_STUDY_SEARCH_H
#define GLINT_STUDY_SEARCH_H

#include "glint/search.h"

struct search {
    const struct glint_search_axis *axes;
    size_t count;
    const struct glint_search_options *options;
    glint_search_try try_point;
    void *user;
    struct glint_search_result *result;
    size_t room;
    uint64_t random;
    double *scratch; /* values of the point under way */
};

/* Where a value lies on its axis in steps, 0 to axis_length, and the value there; of choices the choice. */
double axis_steps(const struct glint_search_axis *axis, double value);
double axis_length(const struct glint_search_axis *axis);
double axis_value_at(const struct glint_search_axis *axis, double steps);
/* Steps of the next other value at least `step` away (negative: below); NAN when the range ends there. */
double axis_move(const struct glint_search_axis *axis, double from, double step);

/* search_points.c */
/* Whether a try came to figures at all. */
bool search_answers(const struct glint_search_figures *figures);
/* The figures at a place given in steps, tried now or before; NULL when that failed, or, `err` untouched, when no try is left.
   Errors of all parts begin as GLINT_OK. */
const struct glint_search_point *search_at(struct search *search, const double *steps, struct glint_error *err);
/* Whether they are known without a try. */
bool search_knows(struct search *search, const double *steps);
bool search_spent(const struct search *search);
/* Weighs all axes with some `tries` around the centre, whose figures are `at`: what each, or the group that it is still in,
   changes of both figures, shared out evenly; 0: nothing, at most SEARCH_HEAVIEST, where there was no answer. */
#define SEARCH_HEAVIEST 1.0
bool search_screen(struct search *search, const double *centre, const struct glint_search_figures *at, uint32_t tries,
                   double *weight, struct glint_error *err);
/* COBYLA from `centre` over the listed axes, none of them a choice. */
bool search_polish(struct search *search, const double *centre, const size_t *axes, size_t count, uint32_t tries,
                   struct glint_error *err);

#endif
