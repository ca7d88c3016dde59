/* Sums up the rows of a sweep over rounds and captures, and finds the Pareto fronts. */
#include <math.h>
#include <stdlib.h>

#include "glint/sort.h"
#include "options/capture_set.h"
#include "sweep/sweep.h"

static double number(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

double sweep_figure(const struct sweep_row *row, const char *key) {
    return number(row->look, key);
}

double sweep_error(const struct sweep_row *row, const char *answer, const char *class, enum glint_metric metric) {
    const json_t *answers = json_object_get(row->look, "errors");
    return number(json_object_get(json_object_get(answers, answer), class), glint_metric(metric)->name);
}

double sweep_time(const struct sweep *sweep, const struct sweep_row *row, const char *key, double *low, double *high) {
    double *values = calloc(sweep->rounds + 1, sizeof *values), median = NAN;
    size_t count = 0;
    *low = *high = NAN;
    for (uint32_t r = 0; values && r < sweep->rounds; r++) {
        const double value = number(row->rounds[r], key);
        if (isfinite(value)) values[count++] = value;
    }
    if (count) {
        median = glint_median(values, count);
        *low = values[0];
        *high = values[count - 1];
    }
    free(values);
    return median;
}

const char *sweep_broken(const struct sweep *sweep, size_t capture) {
    const json_t *look = sweep->points ? sweep_row(sweep, capture, 0)->look : NULL;
    return json_is_true(json_object_get(look, "broken")) ? json_string_value(json_object_get(look, "failed")) : NULL;
}

static void add_value(struct sweep_sum *sum, double value, double captures) {
    sum->mean += value / captures;
    if (isnan(value) || value > sum->worst) sum->worst = value; /* NAN is kept */
}

/* The metric as an error: higher is worse. */
static double badness(const struct sweep *sweep, double error) {
    return glint_metric(sweep->metric)->higher_is_better ? -error : error;
}

static bool counts(const struct sweep *sweep, size_t c, const char *tag) {
    return !sweep_broken(sweep, c) && (!tag || capture_set_has_tag(&sweep->captures, c, tag));
}

size_t sweep_count(const struct sweep *sweep, const char *tag) {
    size_t count = 0;
    for (size_t c = 0; c < sweep->captures.count; c++) count += counts(sweep, c, tag);
    return count;
}

struct sweep_point sweep_sum(const struct sweep *sweep, size_t p, const char *tag) {
    const double captures = (double)sweep_count(sweep, tag);
    const struct sweep_sum zero = {0, -INFINITY};
    struct sweep_point point = {
        .valid = true, .error = zero, .frame_ms = zero, .cubemaps_ms = zero, .steps_px = zero, .fetches_px = zero};
    for (size_t c = 0; c < sweep->captures.count; c++) {
        const struct sweep_row *row = sweep_row(sweep, c, p);
        double low, high;
        if (!counts(sweep, c, tag)) continue;
        const double error = sweep_error(row, sweep->against.truth ? "truth" : "reference", "all", sweep->metric);
        point.valid = point.valid && isfinite(error) && sweep_figure(row, "invalid") == 0;
        add_value(&point.error, badness(sweep, error), captures);
        add_value(&point.cubemaps_ms, sweep_time(sweep, row, "cubemaps_ms", &low, &high), captures);
        add_value(&point.frame_ms, sweep_time(sweep, row, "frame_ms", &low, &high), captures);
        add_value(&point.steps_px, sweep_figure(row, "steps_px"), captures);
        add_value(&point.fetches_px, sweep_figure(row, "fetches_px"), captures);
        point.low_ms += low / captures;
        point.high_ms += high / captures;
    }
    point.error.mean = badness(sweep, point.error.mean);
    point.error.worst = badness(sweep, point.error.worst);
    return point;
}

struct ranked {
    double cost;
    size_t point;
};
static int by_cost(const void *a, const void *b) {
    const struct ranked *x = a, *y = b;
    if (x->cost != y->cost) return x->cost < y->cost ? -1 : 1;
    return (x->point > y->point) - (x->point < y->point);
}

static bool find_front(struct sweep *sweep, struct sweep_front *front, struct glint_error *err) {
    double *x = calloc(sweep->points + 1, sizeof *x), *y = calloc(sweep->points + 1, sizeof *y);
    struct ranked *ranked = calloc(sweep->points + 1, sizeof *ranked);
    front->on = calloc(sweep->points + 1, sizeof *front->on);
    front->points = calloc(sweep->points + 1, sizeof *front->points);
    bool ok = (x && y && ranked && front->on && front->points) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t p = 0; ok && p < sweep->points; p++) {
        const struct sweep_point *s = &sweep->sums[p];
        const struct sweep_sum cost = front->time ? s->frame_ms : s->fetches_px;
        x[p] = front->worst ? cost.worst : cost.mean;
        y[p] = s->valid ? badness(sweep, front->worst ? s->error.worst : s->error.mean) : NAN;
    }
    ok = ok && glint_pareto(x, y, sweep->points, front->on, err);
    for (size_t p = 0; ok && p < sweep->points; p++)
        if (front->on[p]) ranked[front->count++] = (struct ranked){x[p], p};
    if (ok) qsort(ranked, front->count, sizeof *ranked, by_cost);
    for (size_t i = 0; ok && i < front->count; i++) front->points[i] = ranked[i].point;
    free(ranked);
    free(y);
    free(x);
    return ok;
}

bool sweep_sum_up(struct sweep *sweep, struct glint_error *err) {
    static const struct sweep_front kinds[SWEEP_FRONTS] = {
        {.name = "time", .title = "GPU time", .time = true},
        {.name = "fetches", .title = "fetches per pixel"},
        {.name = "time_worst", .title = "GPU time, worst capture", .time = true, .worst = true},
        {.name = "fetches_worst", .title = "fetches per pixel, worst capture", .worst = true}};
    sweep->sums = calloc(sweep->points + 1, sizeof *sweep->sums);
    if (!sweep->sums) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    const size_t captures = sweep_count(sweep, NULL);
    if (!captures)
        return glint_fail(err, GLINT_ERROR_FORMAT, "no capture can be swept: %.900s", sweep_broken(sweep, 0));
    for (size_t p = 0; p < sweep->points; p++) sweep->sums[p] = sweep_sum(sweep, p, NULL);
    for (int k = 0; k < SWEEP_FRONTS; k++) {
        if ((kinds[k].time && !sweep->rounds) || (kinds[k].worst && captures < 2)) continue;
        sweep->fronts[sweep->front_count] = kinds[k];
        if (!find_front(sweep, &sweep->fronts[sweep->front_count++], err)) return false;
    }
    return true;
}
