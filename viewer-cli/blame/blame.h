/* Blame: every pipeline between one and its reference that is asked for, on every capture, and what each exchanged slot is
   worth. */
#ifndef GLINT_VIEWER_BLAME_H
#define GLINT_VIEWER_BLAME_H

#include <math.h>

#include "options/answer_args.h"
#include "glint/blame.h"
#include "journal/journal.h"
#include "io/progress.h"

/* What a coalition is worth: errors against both answers by class, the chosen answer first, and texture fetches. */
enum { BLAME_CLASSES = GLINT_SURFACE_COUNT, BLAME_FETCHES = GLINT_TARGET_COUNT * BLAME_CLASSES, BLAME_VALUES };
extern const char *const blame_classes[BLAME_CLASSES];

/* Milliseconds a frame, NAN without: what exchanging a player alone adds, and what having it alone as it is saves. */
struct blame_time {
    double preset, reference; /* of the whole pipelines */
    double added[GLINT_PLAYERS_MAX], saved[GLINT_PLAYERS_MAX];
};
/* Of one capture, or the mean of several. */
struct blame_sum {
    struct glint_shapley shapley;
    struct blame_time time;
};

struct blame {
    const char *out; /* NULL: nothing is kept */
    struct list captures;
    bool shot;          /* the captures are frames one after the other, and the last is blamed */
    struct list before; /* of the shot: what each pipeline runs first */
    struct glint_pipeline *base;
    struct glint_players *players;
    struct glint_device *device;
    struct answer_args against; /* which answer comes first */
    bool all;
    uint32_t rounds, player_rays;
    enum glint_metric metric;
    uint32_t metrics;
    struct glint_shapley_options options;
    struct progress *progress;

    size_t count; /* of players */
    struct journal journal;
    json_t *definition, *lines; /* lines: by blame_look_key, blame_time_key */
    struct blame_sum *captured; /* of each capture */
    struct blame_sum mean;      /* of those whose shares are known, or of the first; the only one's when there is one */
    bool complete;              /* all shares, and all times */
    struct timespec told;
};
void blame_finish(struct blame *blame);
static inline size_t blame_value(size_t answer, size_t class) {
    return answer * BLAME_CLASSES + class;
}
/* The answer in the first place, and in the second. */
static inline enum glint_target blame_answer(const struct blame *blame, size_t place) {
    return (place == 0) == answer_args_kind(&blame->against);
}
/* The error that the player takes away (positive) or makes when it alone is exchanged in the preset; that it makes when it
   alone is as it is in the reference; its share of what lies between both. */
static inline double blame_removed(const struct blame_sum *sum, size_t player, size_t value) {
    return -sum->shapley.first[player * BLAME_VALUES + value];
}
static inline double blame_made(const struct blame_sum *sum, size_t player, size_t value) {
    return -sum->shapley.last[player * BLAME_VALUES + value];
}
/* NAN as long as it is not known. */
static inline double blame_share(const struct blame_sum *sum, size_t player, size_t value) {
    const bool known = sum->shapley.exact || sum->shapley.permutations;
    return known ? -sum->shapley.share[player * BLAME_VALUES + value] : (double)NAN;
}
/* Whether it says anything: what one exchange changes is known first, then shares, then times. */
static inline bool blame_is_known(const struct blame_sum *sum) {
    return sum->shapley.share != NULL;
}
static inline double blame_half(const struct blame_sum *sum, size_t player, size_t value) {
    return sum->shapley.half[player * BLAME_VALUES + value];
}
static inline double blame_total(const struct blame_sum *sum, size_t value) {
    return sum->shapley.none[value] - sum->shapley.all[value];
}
/* Error for each millisecond: what exchanging the player buys, or (*already) what it buys as it is where its reference takes
   less time and errs more. NAN when neither, or without times. */
double blame_bought(const struct blame_sum *sum, size_t player, size_t value, bool *already);
/* "exact, of all 128 pipelines" */
void blame_how(const struct blame_sum *sum, char text[96]);

/* blame_run.c: finds what is missing: the shares of all captures, then times. Both tell what is known as they go. */
bool blame_open(struct blame *blame, const struct list *shaders, struct glint_error *err);
bool blame_find_shares(struct blame *blame, struct glint_error *err);
bool blame_find_times(struct blame *blame, struct glint_error *err);

/* blame_tell.c: writes what is known so far into the folder, if there is one. `at_once`: though it was done a moment ago. */
bool blame_tell(struct blame *blame, bool at_once, struct glint_error *err);

/* blame_sum.c */
/* What a line of a look says; NAN where it does not. */
void blame_values(const struct blame *blame, const json_t *line, double values[BLAME_VALUES]);
void blame_sum_times(struct blame *blame, size_t capture);
bool blame_sum_up(struct blame *blame, struct glint_error *err);
/* Coalitions that are timed: the preset, the reference, and both with one player exchanged; returns how many. */
size_t blame_timed(const struct blame *blame, uint32_t timed[2 * GLINT_PLAYERS_MAX + 2]);
/* Keys of `lines`. */
void blame_look_key(size_t capture, uint32_t coalition, char key[64]);
void blame_time_key(size_t capture, uint32_t coalition, uint32_t round, char key[64]);

/* blame_table.c */
void blame_print_shares(const struct blame *blame);
void blame_print_times(const struct blame *blame);
json_t *blame_json(const struct blame *blame);

/* blame_page.c: OUT/index.html, OUT/page.json, OUT/shares.svg and, with times, OUT/bought.svg. */
bool blame_write_page(const struct blame *blame, struct glint_error *err);

#endif
