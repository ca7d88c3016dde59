/* Attributes the error of a pipeline to its slots: evaluates pipelines in which some slots are replaced by their references, on every
   capture, and computes the share of each slot. */
#ifndef GLINT_VIEWER_BLAME_H
#define GLINT_VIEWER_BLAME_H

#include <math.h>

#include "draw/page/page.h"
#include "glint/blame.h"
#include "groups/groups.h"
#include "journal/journal.h"
#include "journal/shard.h"
#include "options/answer_args.h"
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

/* A capture: where its results are in the journal, and what they come to. */
struct blame_look {
    uint32_t coalition;
    int64_t at;
};
struct blame_round {
    bool known;
    double ms;
};
struct blame_capture {
    struct blame_sum sum;
    struct blame_look *looks; /* until the shares are known */
    size_t look_count, look_room;
    struct blame_round *rounds; /* [round · timed_count + timed coalition]; NULL before the first */
    bool failed;                /* it has no results */
    int64_t failed_at;          /* the line that says why; -1: none, or that of another shard */
};

/* Figures over the captures with results: of all, and of those with each tag. */
enum blame_figure { BLAME_SHARE, BLAME_REMOVED, BLAME_MADE, BLAME_BELOW /* the largest mean share */, BLAME_FIGURES };
struct blame_overall {
    struct capture_groups groups;
    struct glint_figure *figures; /* of each group and answer: blame_figure_of */
    size_t *order;                /* the captures with the largest errors first, those without results last */
    size_t shown[CAPTURES_SHOWN]; /* captures that are shown whole */
    size_t shown_count, failed;
    bool rows; /* there are more captures */
};

struct blame {
    const char *out; /* of a shard its own folder; NULL: results are not written */
    struct shard shard;
    bool divided;      /* a capture may be divided between shards: all its coalitions are evaluated */
    size_t begin, end; /* the shard's part: of captures, or of their coalitions (blame_works_on) */
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

    size_t count;                              /* number of players */
    uint32_t timed[2 * GLINT_PLAYERS_MAX + 2]; /* coalitions that are timed, ascending */
    size_t timed_count;
    struct journal journal;
    json_t *definition;
    struct blame_capture *of; /* one for each capture */
    struct blame_sum mean;    /* mean of the captures whose shares are known, or the first capture */
    struct blame_overall overall;
    bool drawn;    /* the pictures of the captures that are shown are there */
    bool complete; /* all shares and times are known */
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
/* Whether the shares of a capture are known. */
static inline bool blame_has_shares(const struct blame *blame, size_t capture) {
    const struct glint_shapley *of = &blame->of[capture].sum.shapley;
    return !blame->of[capture].failed && (of->exact || of->permutations);
}
/* Error removed per added millisecond by replacing the player, or (*already) error that the player itself avoids per millisecond, if its
   reference takes less time but has more error. NAN in other cases and without times. */
double blame_bought(const struct blame_sum *sum, size_t player, size_t value, bool *already);
/* "exact, from all 128 pipelines" */
void blame_how(const struct blame_sum *sum, char text[96]);
/* The player with the largest share of the error. */
size_t blame_largest(const struct blame *blame, const struct blame_sum *sum, size_t value);

/* log.c: OUT/blame.json defines the work, OUT/log.jsonl has a line for each result. */
bool blame_open(struct blame *blame, const struct list *shaders, struct glint_error *err);
/* Finds the part of a shard, by the sizes of the captures. */
bool blame_cut(struct blame *blame, struct glint_error *err);
bool blame_works_on(const struct blame *blame, size_t capture, uint32_t coalition);
/* The most coalitions of a capture that are evaluated. */
size_t blame_looks(const struct blame *blame);
/* How many results the shard will have, of all captures. *all: how many there are. */
size_t blame_expected(const struct blame *blame, size_t *all);
/* The place in the journal of what was found for a coalition; -1: nothing. */
int64_t blame_found(const struct blame *blame, size_t capture, uint32_t coalition);
/* Times of a capture; NULL without memory. */
struct blame_round *blame_rounds(struct blame *blame, size_t capture);
void blame_forget_looks(struct blame_capture *capture);
/* Why a capture has no results; malloc'd. */
char *blame_failure(const struct blame *blame, size_t capture);

/* run.c: evaluates what is not in the log yet: first the shares of all captures, then times. Both publish intermediate results. A capture that fails by
   itself, of several, has a line that says so. */
bool blame_find_shares(struct blame *blame, struct glint_error *err);
bool blame_find_times(struct blame *blame, struct glint_error *err);
/* Pictures of the captures that are shown: what the pipeline shows, its error, and the error without the largest share. */
bool blame_draw(struct blame *blame, struct glint_error *err);
/* "pictures/error-12.png" */
void blame_picture_name(const char *what, size_t capture, char name[64]);

/* publish.c: writes the results so far into the folder, if there is one, at most every few seconds. `at_once`: regardless of the interval. */
bool blame_publish(struct blame *blame, bool at_once, struct glint_error *err);

/* sum.c */
/* The values in a line of the log; NAN where it has none. */
void blame_values(const struct blame *blame, const json_t *line, double values[BLAME_VALUES]);
void blame_sum_times(struct blame *blame, size_t capture);
/* Fails if no capture has results. */
bool blame_sum_up(struct blame *blame, struct glint_error *err);
/* Fills `timed`: the preset, the reference, and both with one player replaced or kept. */
void blame_choose_timed(struct blame *blame);

/* overall.c: of several captures. */
bool blame_overall_find(struct blame *blame, struct glint_error *err);
void blame_overall_finish(struct blame_overall *overall);
void blame_print_overall(const struct blame *blame);
/* [{"tag", "captures", "shots", "errors": {ANSWER: {"preset", "reference", "players"}}}, …] */
json_t *blame_overall_json(const struct blame *blame);
json_t *blame_worst_json(const struct blame *blame);
void blame_page_overall(const struct blame *blame, json_t *document);
/* A row for each capture, the worst first. */
void blame_page_rows(const struct blame *blame, json_t *document);

/* table.c */
void blame_print_shares(const struct blame *blame);
void blame_print_times(const struct blame *blame);
/* Capture by capture, as print_json has it with an indent of 2. */
void blame_write_json(FILE *out, const struct blame *blame, size_t indent);

/* page.c: OUT/index.html, OUT/page.json, OUT/shares.svg and, with times, OUT/bought.svg. */
bool blame_write_page(struct blame *blame, struct glint_error *err);

#endif
