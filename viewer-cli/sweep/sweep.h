/* A sweep: results of every point of a space of pipelines on every capture, and their summary. */
#ifndef GLINT_VIEWER_SWEEP_H
#define GLINT_VIEWER_SWEEP_H

#include <jansson.h>

#include "capture/missing.h"
#include "options/answer_args.h"
#include "options/args.h"
#include "glint/space.h"
#include "groups/groups.h"
#include "journal/journal.h"
#include "journal/shard.h"
#include "io/progress.h"

/* One point on one capture: what tables and fronts need of it, and where its line is in the journal. */
enum sweep_state { SWEEP_MISSING, SWEEP_DONE, SWEEP_FAILED, SWEEP_BROKEN /* as all of its capture */ };
struct sweep_row {
    enum sweep_state state;
    int64_t at;
    double error, invalid, steps_px, fetches_px; /* NAN: unknown */
};
enum sweep_cost { SWEEP_FRAME, SWEEP_CUBEMAPS, SWEEP_COSTS };
struct sweep_round {
    bool known;
    int64_t at;
    double ms[SWEEP_COSTS];
};
/* The lines of a row, read back. */
struct sweep_lines {
    json_t *look, **rounds; /* NULL: none */
};

/* The Pareto-optimal points among those with a valid error. */
struct sweep_front {
    const char *name; /* "time", "fetches", "time_worst", "fetches_worst" */
    const char *title;
    bool time, worst;
    bool *on;
    size_t *points, count; /* points on the front, from the cheapest */
};
enum { SWEEP_FRONTS = 4 };

/* Mean and worst over the captures. NAN if unknown. */
struct sweep_sum {
    double mean, worst;
};
struct sweep_point {
    bool valid; /* has an error on every capture */
    struct sweep_sum error, frame_ms, cubemaps_ms, steps_px, fetches_px;
    double low_ms, high_ms; /* lowest and highest round, mean over the captures */
};

/* Figures over the captures with results: of all, and of those with each tag. */
struct sweep_group {
    size_t best; /* the point with the least mean error; the number of points if none is known */
    struct glint_figure *error, *beyond; /* of each point: its mean error, and what that is more than the best one's */
};
struct sweep_overall {
    struct capture_groups captures;
    struct sweep_group *groups;   /* one for each of theirs */
    size_t *order;                /* the captures with the largest mean errors first, those without results last */
    size_t shown[CAPTURES_SHOWN]; /* captures that are shown with pictures: all, or the worst of more */
    size_t shown_count, broken;
};

struct sweep {
    const char *out; /* of a shard its own folder */
    struct shard shard;
    size_t begin, end; /* the rows that are worked on: all of them, or those of the shard */
    struct list captures;
    struct glint_pipeline *base;
    struct glint_space *space;
    struct glint_device *device;
    struct answer_args against; /* what errors are measured against */
    bool whole, all, pictures;
    uint32_t rounds;
    enum glint_metric metric;
    uint32_t metrics;
    struct progress *progress;
    struct missing missing; /* what the captures lack of what the pipelines read */

    size_t points;
    struct sweep_row *rows;    /* index: capture · points + point */
    struct sweep_round *timed; /* index: row · rounds + round */
    double seconds[3];         /* wall-clock time of looks, metrics and pictures, over all calls */
    struct journal journal;
    struct glint_error fault; /* what could not be read back from it */
    json_t *definition;
    struct sweep_overall overall;
    struct sweep_point *sums;
    struct sweep_front fronts[SWEEP_FRONTS];
    size_t front_count;
};
void sweep_finish(struct sweep *sweep);
static inline struct sweep_row *sweep_row(const struct sweep *sweep, size_t capture, size_t point) {
    return &sweep->rows[capture * sweep->points + point];
}
static inline struct sweep_round *sweep_rounds(const struct sweep *sweep, size_t capture, size_t point) {
    return &sweep->timed[(capture * sweep->points + point) * sweep->rounds];
}
/* More captures than are shown with pictures. */
static inline bool sweep_is_large(const struct sweep *sweep) {
    return sweep->captures.count > CAPTURES_SHOWN;
}
static inline bool sweep_works_on(const struct sweep *sweep, size_t capture, size_t point) {
    const size_t row = capture * sweep->points + point;
    return row >= sweep->begin && row < sweep->end;
}
/* "screen_trace.steps=16 resolve.fog=true", malloc'd; NULL when memory is short. */
char *sweep_point_text(const struct sweep *sweep, size_t point);
/* "OUT/name"; the path is at most 4096 long. */
bool sweep_path(const struct sweep *sweep, const char *name, char path[4096], struct glint_error *err);

/* log.c: OUT/sweep.json defines the sweep, OUT/log.jsonl has a line for each result. */
/* Finds the shard's rows, by the sizes of the captures. */
bool sweep_cut(struct sweep *sweep, struct glint_error *err);
/* Begins the folder, or resumes it. A folder with another sweep is an error that names the difference. */
bool sweep_open(struct sweep *sweep, const char *const *axes, const char *sample, const struct list *shaders,
                struct glint_error *err);

/* Reads a row back. What cannot be read is noted in sweep->fault. Release it with sweep_release. */
struct sweep_lines sweep_read(const struct sweep *sweep, size_t capture, size_t point);
void sweep_release(const struct sweep *sweep, struct sweep_lines *lines);

/* run.c */
/* Evaluates missing results. Failures of points are recorded in the log and do not stop the others. */
bool sweep_run(struct sweep *sweep, struct glint_error *err);
/* Pictures of the points on fronts, on the captures that are shown: the error of each, and the difference from one to the next. */
bool sweep_draw_fronts(struct sweep *sweep, struct glint_error *err);
/* Names of pictures in OUT; "" for none. `what`: "picture", "error". */
void sweep_picture_name(const char *what, size_t capture, size_t point, char name[96]);
void sweep_change_name(size_t capture, size_t from, size_t to, char name[96]);

/* sum.c */
/* Whether a capture has no results, which one of several may not have. It is left out of the figures of all. */
bool sweep_broken(const struct sweep *sweep, size_t capture);
/* Why a row, or its capture, has no results; malloc'd, NULL if it has. */
char *sweep_failure(const struct sweep *sweep, size_t capture, size_t point);
bool sweep_sum_up(struct sweep *sweep, struct glint_error *err);
/* The captures that have results, and a point's figures over them: all, or those with a tag. */
size_t sweep_count(const struct sweep *sweep, const char *tag);
struct sweep_point sweep_sum(const struct sweep *sweep, size_t point, const char *tag);
/* The metric as an error: higher is worse. */
double sweep_badness(const struct sweep *sweep, double error);
/* "all", then the classes of the effect's pixels; NULL past the last. */
static inline const char *sweep_class(const struct sweep *sweep, size_t i) {
    const struct glint_effect *effect = sweep->against.effect;
    return i <= glint_effect_class_count(effect) ? glint_effect_class_name(effect, i) : NULL;
}
/* Figures of a line; NAN when it has none. */
double sweep_number(const json_t *line, const char *key);
double sweep_error(const json_t *look, const char *answer, const char *class, enum glint_metric metric);
/* Median of values, with the lowest and the highest; NAN without any. Sorts them. */
double sweep_median(double *values, size_t count, double *low, double *high);
/* The same of a row's rounds. */
double sweep_time(const struct sweep *sweep, size_t capture, size_t point, enum sweep_cost cost, double *low,
                  double *high);

/* overall.c: of several captures. */
bool sweep_overall_find(struct sweep *sweep, struct glint_error *err);
void sweep_overall_finish(struct sweep_overall *overall);
void sweep_print_overall(const struct sweep *sweep);
/* Adds "low" and "high" to a point's error, and "beyond_best", of a group. */
void sweep_overall_add(const struct sweep *sweep, size_t group, size_t point, json_t *figures);
/* [{"capture", "error"}, …] */
json_t *sweep_worst_json(const struct sweep *sweep);
void sweep_page_overall(const struct sweep *sweep, json_t *document);
/* The worst captures of many with their pictures, and a row for each. */
void sweep_page_captures(const struct sweep *sweep, json_t *document);

/* curve.c: a sweep of one parameter. */
struct page_charts;
/* The point beyond which larger values of the parameter reduce the error less; sweep->points if there is none or several axes. */
size_t sweep_knee(const struct sweep *sweep);
/* Adds charts of error and costs against the parameter, with the knee, and writes them as parameter-….svg; else does nothing. */
bool sweep_add_curve(const struct sweep *sweep, struct page_charts *charts, json_t *document, struct glint_error *err);

/* table.c */
void sweep_print(const struct sweep *sweep);

/* write.c: row by row. */
void sweep_write_json(FILE *out, const struct sweep *sweep, size_t indent);
void sweep_write_csv(FILE *out, const struct sweep *sweep);

/* page.c: OUT/index.html, OUT/page.json and a chart for each front. */
bool sweep_write_page(const struct sweep *sweep, struct glint_error *err);

#endif
