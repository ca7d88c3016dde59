/* A sweep: results of every point of a space of pipelines on every capture, and their summary. */
#ifndef GLINT_VIEWER_SWEEP_H
#define GLINT_VIEWER_SWEEP_H

#include <jansson.h>

#include "capture/missing.h"
#include "options/answer_args.h"
#include "options/args.h"
#include "glint/space.h"
#include "journal/journal.h"
#include "journal/shard.h"
#include "io/progress.h"

/* One point on one capture: lines of the log, as they were written. */
struct sweep_row {
    json_t *look;    /* NULL: not evaluated yet */
    json_t **rounds; /* one for each timed round, NULL: not timed yet */
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
    struct sweep_row *rows; /* index: capture · points + point */
    struct journal journal;
    json_t *definition;
    struct sweep_point *sums;
    struct sweep_front fronts[SWEEP_FRONTS];
    size_t front_count;
};
void sweep_finish(struct sweep *sweep);
static inline struct sweep_row *sweep_row(const struct sweep *sweep, size_t capture, size_t point) {
    return &sweep->rows[capture * sweep->points + point];
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

/* sweep_run.c */
/* Evaluates missing results. Failures of points are recorded in the log and do not stop the others. */
bool sweep_run(struct sweep *sweep, struct glint_error *err);
/* Pictures of the points on fronts: the error of each, and the difference from one to the next. */
bool sweep_draw_fronts(struct sweep *sweep, struct glint_error *err);
/* Names of pictures in OUT; "" for none. `what`: "picture", "error". */
void sweep_picture_name(const char *what, size_t capture, size_t point, char name[96]);
void sweep_change_name(size_t capture, size_t from, size_t to, char name[96]);

/* sum.c */
/* Why a capture has no results, which one of several may not have; NULL for one that has. It is left out of the figures of all. */
const char *sweep_broken(const struct sweep *sweep, size_t capture);
bool sweep_sum_up(struct sweep *sweep, struct glint_error *err);
/* The captures that have results, and a point's figures over them: all, or those with a tag. */
size_t sweep_count(const struct sweep *sweep, const char *tag);
struct sweep_point sweep_sum(const struct sweep *sweep, size_t point, const char *tag);
/* Figures of one row; NAN when it has none. */
double sweep_figure(const struct sweep_row *row, const char *key);
/* "all", then the classes of the effect's pixels; NULL past the last. */
static inline const char *sweep_class(const struct sweep *sweep, size_t i) {
    const struct glint_effect *effect = sweep->against.effect;
    return i <= glint_effect_class_count(effect) ? glint_effect_class_name(effect, i) : NULL;
}
double sweep_error(const struct sweep_row *row, const char *answer, const char *class, enum glint_metric metric);
/* Median of the rounds, with the lowest and the highest; NAN without any. `key`: "frame_ms", "cubemaps_ms". */
double sweep_time(const struct sweep *sweep, const struct sweep_row *row, const char *key, double *low, double *high);

/* curve.c: a sweep of one parameter. */
struct page_charts;
/* The point beyond which larger values of the parameter reduce the error less; sweep->points if there is none or several axes. */
size_t sweep_knee(const struct sweep *sweep);
/* Adds charts of error and costs against the parameter, with the knee, and writes them as parameter-….svg; else does nothing. */
bool sweep_add_curve(const struct sweep *sweep, struct page_charts *charts, json_t *document, struct glint_error *err);

/* sweep_table.c */
void sweep_print(const struct sweep *sweep);
json_t *sweep_json(const struct sweep *sweep);
char *sweep_csv(const struct sweep *sweep); /* malloc'd; NULL when memory is short */

/* sweep_page.c: OUT/index.html, OUT/page.json and a chart for each front. */
bool sweep_write_page(const struct sweep *sweep, struct glint_error *err);

#endif
