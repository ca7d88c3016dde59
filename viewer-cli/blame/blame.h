/* Attributes the error of a pipeline to its slots: evaluates pipelines in which some slots are replaced by their references, on every
   capture, and computes the share of each slot. */
#ifndef GLINT_VIEWER_BLAME_H
#define GLINT_VIEWER_BLAME_H

#include <math.h>

#include "draw/page/page.h"
#include "options/answer_args.h"
#include "glint/blame.h"
#include "journal/journal.h"
#include "io/progress.h"

/* Values of a coalition (a set of replaced players): errors by class of pixels against reference and truth, the chosen one first, and
   texture fetches. */
enum { BLAME_CLASSES = GLINT_CLASS_COUNT, BLAME_FETCHES = GLINT_TARGET_COUNT * BLAME_CLASSES, BLAME_VALUES };

/* Milliseconds per frame, NAN if not timed: added when only this player is replaced; saved when only this player is kept. */
struct blame_time {
    double preset, reference; /* time of the whole pipelines */
    double added[GLINT_PLAYERS_MAX], saved[GLINT_PLAYERS_MAX];
};
/* Results of one capture, or the mean of several. */
struct blame_sum {
    struct glint_shapley shapley;
    struct blame_time time;
};

struct blame {
    const char *out; /* NULL: results are not written */
    struct list captures;
    bool shot;          /* the captures are consecutive frames, and the error of the last is attributed */
    struct list before; /* earlier frames of the shot, which each pipeline runs first */
    struct glint_pipeline *base;
    struct glint_players *players;
    struct glint_device *device;
    struct answer_args against; /* reference or truth */
    bool all;
    uint32_t rounds, player_rays;
    enum glint_metric metric;
    uint32_t metrics;
    struct glint_shapley_options options;
    struct progress *progress;

    size_t count; /* number of players */
    struct journal journal;
    json_t *definition, *lines; /* lines: results, by blame_look_key and blame_time_key */
    struct blame_sum *captured; /* one for each capture */
    struct blame_sum mean;      /* mean of the captures whose shares are known, or the first capture */
    bool complete;              /* all shares and times are known */
    struct timespec published;
    double publish_seconds; /* taken by the last time */
    struct page_charts charts;
};
void blame_finish(struct blame *blame);
/* The classes of the effect, all pixels first, and the name of one. */
static inline size_t blame_classes(const struct blame *blame) {
    return 1 + glint_effect_class_count(blame->against.effect);
}
static inline const char *blame_class(const struct blame *blame, size_t class) {
    return glint_effect_class_name(blame->against.effect, class);
}
static inline size_t blame_value(size_t answer, size_t class) {
    return answer * BLAME_CLASSES + class;
}
/* Whether the first (place 0) or the second value is against the reference or the truth. */
static inline enum glint_target blame_answer(const struct blame *blame, size_t place) {
    return (place == 0) == answer_args_kind(&blame->against);
}
/* The error that disappears when only this player is replaced; the error that appears when only this player is kept; its share of
   the difference between preset and reference. */
static inline double blame_removed(const struct blame_sum *sum, size_t player, size_t value) {
    return -sum->shapley.first[player * BLAME_VALUES + value];
}
static inline double blame_made(const struct blame_sum *sum, size_t player, size_t value) {
    return -sum->shapley.last[player * BLAME_VALUES + value];
}
/* NAN as long as the share is not known. */
static inline double blame_share(const struct blame_sum *sum, size_t player, size_t value) {
    const bool known = sum->shapley.exact || sum->shapley.permutations;
    return known ? -sum->shapley.share[player * BLAME_VALUES + value] : (double)NAN;
}
/* Whether there are any results: single replacements are evaluated first, then shares, then times. */
static inline bool blame_is_known(const struct blame_sum *sum) {
    return sum->shapley.share != NULL;
}
static inline double blame_half(const struct blame_sum *sum, size_t player, size_t value) {
    return sum->shapley.half[player * BLAME_VALUES + value];
}
static inline double blame_total(const struct blame_sum *sum, size_t value) {
    return sum->shapley.none[value] - sum->shapley.all[value];
}
/* Error removed per added millisecond by replacing the player, or (*already) error that the player itself avoids per millisecond, if its
   reference takes less time but has more error. NAN in other cases and without times. */
double blame_bought(const struct blame_sum *sum, size_t player, size_t value, bool *already);
/* "exact, from all 128 pipelines" */
void blame_how(const struct blame_sum *sum, char text[96]);

/* run.c: evaluates what is not in the log yet: first the shares of all captures, then times. Both publish intermediate results. */
bool blame_open(struct blame *blame, const struct list *shaders, struct glint_error *err);
bool blame_find_shares(struct blame *blame, struct glint_error *err);
bool blame_find_times(struct blame *blame, struct glint_error *err);

/* publish.c: writes the results so far into the folder, if there is one, at most every few seconds. `at_once`: regardless of the interval. */
bool blame_publish(struct blame *blame, bool at_once, struct glint_error *err);

/* blame_sum.c */
/* The values in a line of the log; NAN where it has none. */
void blame_values(const struct blame *blame, const json_t *line, double values[BLAME_VALUES]);
void blame_sum_times(struct blame *blame, size_t capture);
bool blame_sum_up(struct blame *blame, struct glint_error *err);
/* The coalitions that are timed: the preset, the reference, and both with one player replaced or kept. Returns their number. */
size_t blame_timed(const struct blame *blame, uint32_t timed[2 * GLINT_PLAYERS_MAX + 2]);
/* Keys of `lines`. */
void blame_look_key(size_t capture, uint32_t coalition, char key[64]);
void blame_time_key(size_t capture, uint32_t coalition, uint32_t round, char key[64]);

/* blame_table.c */
void blame_print_shares(const struct blame *blame);
void blame_print_times(const struct blame *blame);
json_t *blame_json(const struct blame *blame);

/* blame_page.c: OUT/index.html, OUT/page.json, OUT/shares.svg and, with times, OUT/bought.svg. */
bool blame_write_page(struct blame *blame, struct glint_error *err);

#endif
