/* Sums up the rows of a sweep over rounds and captures, and finds the Pareto fronts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/sort.h"
#include "options/capture_set.h"
#include "sweep/sweep.h"

double sweep_number(const json_t *line, const char *key) {
    const json_t *value = json_object_get(line, key);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

double sweep_error(const json_t *look, const char *answer, const char *class, enum glint_metric metric) {
    const json_t *answers = json_object_get(look, "errors");
    return sweep_number(json_object_get(json_object_get(answers, answer), class), glint_metric(metric)->name);
}

double sweep_median(double *values, size_t count, double *low, double *high) {
    *low = *high = NAN;
    if (!count) return NAN;
    const double median = glint_median(values, count);
    *low = values[0];
    *high = values[count - 1];
    return median;
}

double sweep_time(const struct sweep *sweep, size_t capture, size_t point, enum sweep_cost cost, double *low,
                  double *high) {
    double *values = calloc(sweep->rounds + 1, sizeof *values);
    const struct sweep_round *rounds = sweep_rounds(sweep, capture, point);
    size_t count = 0;
    for (uint32_t r = 0; values && r < sweep->rounds; r++)
        if (rounds[r].known && isfinite(rounds[r].ms[cost])) values[count++] = rounds[r].ms[cost];
    const double median = sweep_median(values, count, low, high);
    free(values);
    return median;
}

bool sweep_broken(const struct sweep *sweep, size_t capture) {
    return sweep->points && sweep_row(sweep, capture, 0)->state == SWEEP_BROKEN;
}

char *sweep_failure(const struct sweep *sweep, size_t capture, size_t point) {
    if (sweep_row(sweep, capture, point)->state < SWEEP_FAILED) return NULL;
    struct sweep_lines lines = sweep_read(sweep, capture, point);
    const char *failed = json_string_value(json_object_get(lines.look, "failed"));
    char *text = strdup(failed ? failed : sweep->fault.message);
    sweep_release(sweep, &lines);
    return text;
}

static void add_value(struct sweep_sum *sum, double value, double captures) {
    sum->mean += value / captures;
    if (isnan(value) || value > sum->worst) sum->worst = value; /* NAN is kept */
}

double sweep_badness(const struct sweep *sweep, double error) {
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
        point.valid = point.valid && isfinite(row->error) && row->invalid == 0;
        add_value(&point.error, sweep_badness(sweep, row->error), captures);
        add_value(&point.cubemaps_ms, sweep_time(sweep, c, p, SWEEP_CUBEMAPS, &low, &high), captures);
        add_value(&point.frame_ms, sweep_time(sweep, c, p, SWEEP_FRAME, &low, &high), captures);
        add_value(&point.steps_px, row->steps_px, captures);
        add_value(&point.fetches_px, row->fetches_px, captures);
        point.low_ms += low / captures;
        point.high_ms += high / captures;
    }
    point.error.mean = sweep_badness(sweep, point.error.mean);
    point.error.worst = sweep_badness(sweep, point.error.worst);
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
        y[p] = s->valid ? sweep_badness(sweep, front->worst ? s->error.worst : s->error.mean) : NAN;
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
    if (!captures) {
        char *why = sweep_failure(sweep, 0, 0);
        glint_fail(err, GLINT_ERROR_FORMAT, "no capture can be swept: %.900s", why ? why : "");
        free(why);
        return false;
    }
    for (size_t p = 0; p < sweep->points; p++) sweep->sums[p] = sweep_sum(sweep, p, NULL);
    for (int k = 0; k < SWEEP_FRONTS; k++) {
        if ((kinds[k].time && !sweep->rounds) || (kinds[k].worst && captures < 2)) continue;
        sweep->fronts[sweep->front_count] = kinds[k];
        if (!find_front(sweep, &sweep->fronts[sweep->front_count++], err)) return false;
    }
    return sweep_overall_find(sweep, err);
}
