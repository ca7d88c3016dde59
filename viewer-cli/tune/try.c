/* Evaluates points over all captures that are tuned on, and sums up their figures. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tune/tune.h"

bool tune_begin_captures(struct tune *tune, struct glint_error *err) {
    if (!tune_share(tune, NULL, err)) return false;
    for (size_t s = 0; s < tune->captures.count && !tune->shard.count; s++)
        if (!tune_note_beginning(tune, s, err)) return false;
    return tune_live(tune) ||
           glint_fail(err, GLINT_ERROR_USAGE, "none of the %zu captures can be tuned on; the first: %s",
                      tune->captures.count, tune->subjects[0].broken);
}
/* ---- Figures ---- */

static struct tune_figures figures_on(const json_t *line, size_t s) {
    const json_t *one = json_array_get(json_object_get(line, "captures"), s);
    const json_t *error = json_object_get(one, "error"), *cost = json_object_get(one, "cost");
    return (struct tune_figures){json_is_number(error) ? json_number_value(error) : NAN,
                                 json_is_number(cost) ? json_number_value(cost) : NAN};
}

/* Means over the captures; with --over worst, the largest ratio to the norm of the same capture, times the mean norm. */
static struct tune_figures sum_up(const struct tune *tune, const json_t *line) {
    const double count = (double)tune_live(tune);
    struct tune_figures mean = {0}, norm = {0}, most = {0};
    for (size_t s = 0; s < tune->captures.count; s++) {
        if (tune->subjects[s].broken) continue;
        const struct tune_figures here = figures_on(line, s), by = tune->subjects[s].norm;
        mean.error += here.error / count, mean.cost += here.cost / count;
        norm.error += by.error / count, norm.cost += by.cost / count;
        most.error = fmax(most.error, here.error / by.error), most.cost = fmax(most.cost, here.cost / by.cost);
    }
    if (!isfinite(mean.error) || !isfinite(mean.cost)) return (struct tune_figures){NAN, NAN};
    if (tune->worst && norm.error > 0) mean.error = most.error * norm.error;
    if ((tune->worst || tune->scaled_within) && norm.cost > 0) mean.cost = most.cost * norm.cost;
    return mean;
}

static const json_t *find_line(const struct tune *tune, const json_t *values) {
    size_t i;
    const json_t *line;
    json_array_foreach(tune->lines, i, line) if (json_equal(json_object_get(line, "values"), values)) return line;
    return NULL;
}
static json_t *values_json(const struct tune *tune, const double *values) {
    json_t *list = json_array();
    for (size_t a = 0; a < tune->axis_count; a++) {
        char text[TUNE_TEXT];
        tune_value_text(&tune->axes[a], values[a], text);
        json_array_append_new(list, json_string(text));
    }
    return list;
}
/* ---- Points ---- */

static bool keep_start(struct tune *tune, struct glint_error *err) {
    json_t *start = json_array();
    if (tune->fetches || tune->timed) return json_decref(start), true;
    for (size_t s = 0; s < tune->captures.count; s++)
        json_array_append_new(start, json_real(tune->subjects[s].start_ms));
    return journal_append(&tune->journal, json_pack("{s:o}", "start_ms", start), err);
}

/* The figures on all captures, which are known on each; null on those that are left out. */
static json_t *put_together(const struct tune *tune, json_t *values) {
    json_t *captures = json_array();
    bool ok = captures != NULL;
    for (size_t s = 0; ok && s < tune->captures.count; s++) {
        char *key = tune_point_key(s, values);
        const json_t *single = key ? json_object_get(tune->single, key) : NULL;
        json_t *figures = single ? json_pack("{s:O, s:O}", "error", json_object_get(single, "error"), "cost",
                                             json_object_get(single, "cost"))
                                 : json_null();
        if (single && json_object_get(single, "failed"))
            json_object_set(figures, "failed", json_object_get(single, "failed"));
        ok = key && (single || tune->subjects[s].broken) && json_array_append_new(captures, figures) == 0;
        free(key);
    }
    json_t *line = ok ? json_pack("{s:O, s:O}", "values", values, "captures", captures) : NULL;
    json_decref(captures);
    return line;
}

static bool add_line(struct tune *tune, json_t *values, struct glint_error *err) {
    json_t *points = json_pack("[O]", values);
    if (!points) return fail_memory(err);
    bool known = true;
    for (size_t s = 0; s < tune->captures.count; s++) known = known && tune_is_known(tune, s, values);
    bool ok = tune_share(tune, points, err);
    json_decref(points);
    if (!ok) return false;
    json_t *line = put_together(tune, values);
    if (!line) return fail_memory(err);
    if (tune->shard.count) return json_array_append_new(tune->lines, line) == 0 || fail_memory(err);
    if (!keep_start(tune, err)) return json_decref(line), false;
    tune->fresh += !known;
    return journal_append(&tune->journal, line, err);
}

bool tune_evaluate(struct tune *tune, const double *values, struct tune_figures *figures, struct glint_error *err) {
    json_t *list = values_json(tune, values);
    const size_t number = (size_t)json_array_size(tune->lines) + 1;
    bool ok = true;
    snprintf(tune->label, sizeof tune->label, "point %zu of %u", number, tune->tries);
    if (!find_line(tune, list)) ok = add_line(tune, list, err) && tune_report(tune, NULL, 0);
    tune->done = fmin(1, (double)number / tune->tries);
    if (ok) *figures = sum_up(tune, find_line(tune, list));
    json_decref(list);
    return ok || glint_fail(err, err->code ? err->code : GLINT_ERROR_INTERRUPTED, "%s",
                            err->code ? err->message : "interrupted");
}

bool tune_announce(void *user, const double *values, size_t count, struct glint_error *err) {
    struct tune *tune = user;
    if (!tune->shard.count) return true;
    json_t *points = json_array();
    bool ok = points || fail_memory(err);
    for (size_t i = 0; ok && i < count; i++) {
        json_t *list = values_json(tune, values + i * tune->axis_count);
        if (find_line(tune, list)) json_decref(list);
        else ok = json_array_append_new(points, list) == 0 || fail_memory(err);
    }
    snprintf(tune->label, sizeof tune->label, "%zu points", json_array_size(points));
    ok = ok && (!json_array_size(points) || tune_share(tune, points, err));
    json_decref(points);
    return ok;
}

void tune_set_norm(struct tune *tune, const double *values) {
    json_t *list = values_json(tune, values);
    const json_t *line = find_line(tune, list);
    for (size_t s = 0; s < tune->captures.count; s++) tune->subjects[s].norm = figures_on(line, s);
    json_decref(list);
}

void tune_correct(struct tune *tune, const double *values, double part, const double *parts) {
    json_t *list = values_json(tune, values);
    const json_t *line = find_line(tune, list);
    tune->within = tune->scaled_within ? 0 : sum_up(tune, line).cost / part;
    for (size_t s = 0; s < tune->captures.count && tune->scaled_within; s++) {
        if (tune->subjects[s].broken) continue;
        tune->subjects[s].norm.cost = figures_on(line, s).cost / parts[s];
        tune->within += tune->subjects[s].norm.cost / (double)tune_live(tune);
    }
    json_decref(list);
}

bool tune_all_tried(const struct tune *tune, double **values, size_t *count, struct glint_error *err) {
    *count = json_array_size(tune->lines);
    *values = calloc(tune->axis_count * *count + 1, sizeof **values);
    for (size_t i = 0; *values && i < *count; i++)
        tune_values_of(tune, json_object_get(json_array_get(tune->lines, i), "values"), *values + tune->axis_count * i);
    return *values || fail_memory(err);
}
