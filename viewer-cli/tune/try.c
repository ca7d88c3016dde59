/* Evaluates pipelines once on each capture that is tuned on, and records the results in the journal. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tune/tune.h"

/* ---- The journal ---- */

static json_t *axes_json(const struct tune *tune) {
    json_t *axes = json_array();
    for (size_t a = 0; a < tune->axis_count; a++) {
        const struct tune_axis *axis = &tune->axes[a];
        json_t *json = json_object();
        json_object_set_new(json, "name", json_string(axis->name));
        if (axis->texts) {
            json_t *texts = json_array();
            for (uint32_t c = 0; c < axis->axis.choices; c++) json_array_append_new(texts, json_string(axis->texts[c]));
            json_object_set_new(json, "choices", texts);
        } else json_object_set_new(json, "range", json_pack("[f, f]", axis->axis.lowest, axis->axis.highest));
        json_array_append_new(axes, json);
    }
    return axes;
}

static bool keep_tune_line(void *user, json_t *line) {
    struct tune *tune = user;
    const json_t *start = json_object_get(line, "start_ms");
    size_t s;
    json_t *value;
    if (json_is_array(start)) {
        if (json_array_size(start) != tune->captures.count) return false;
        json_array_foreach(start, s, value) tune->subjects[s].start_ms = json_number_value(value);
        return true;
    }
    const json_t *values = json_object_get(line, "values");
    if (json_array_size(json_object_get(line, "captures")) != tune->captures.count ||
        json_array_size(values) != tune->axis_count)
        return false;
    return json_array_append(tune->lines, line) == 0;
}

/* Everything that results depend on. Budget and seed do not belong to it, so that another search reuses the results. */
bool tune_open(struct tune *tune, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(tune->device);
    json_t *captures = captures_json(&tune->captures, false, err),
           *sources = captures ? shaders_json(tune->shaders, err) : NULL;
    if (!sources) {
        json_decref(captures);
        return false;
    }
    json_t *definition = json_pack(
        "{s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:s, s:o, s:o, s:I, s:I, s:s, s:s, s:b, s:[ss]}", "format", 1, "glint",
        GLINT_VERSION, "effect", tune->against.effect->name, "captures", captures, "pipeline",
        pipeline_json(tune->base), "shaders", sources, "axes", axes_json(tune), "cost",
        tune->fetches ? "fetches" : "ms", "slots", strings_json(tune->slots.items), "reference_runs",
        strings_json(tune->against.references.items), "reference_rays", (json_int_t)tune->against.rays, "rounds",
        (json_int_t)tune->rounds, "metric", glint_metric(tune->metric)->name, "against",
        tune->against.truth ? "truth" : "reference", "all", tune->all, "device", device->name, device->driver_version);
    tune->lines = json_array();
    tune->journal.folder = tune->folder;
    tune->journal.kind = "tuning";
    tune->journal.keep = keep_tune_line;
    tune->journal.user = tune;
    const bool ok = (definition && tune->lines) ? journal_open(&tune->journal, definition, err) : fail_memory(err);
    json_decref(definition);
    return ok;
}

/* ---- Evaluations ---- */

/* Alternates with the start, so that slow changes, such as of the device's clock, affect both. Runs whole frames on a GPU, so that caches
   have realistic contents; on a CPU, whole frames take too long and times do not represent a GPU anyway. */
static bool time_beside_start(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                              double *ms, struct glint_error *err) {
    double *ratios = calloc(2 * tune->rounds + 1, sizeof *ratios), *starts = ratios + tune->rounds;
    const bool whole = !glint_device_get_info(tune->device)->is_cpu;
    bool ok = ratios || fail_memory(err);
    for (uint32_t r = 0; ok && r < tune->rounds; r++) {
        double own = 0;
        glint_judge_next_round(subject->judge);
        ok = tune_time(tune, subject, tune->base, whole, &starts[r], err) &&
             tune_time(tune, subject, pipeline, whole, &own, err);
        ratios[r] = starts[r] > 0 ? own / starts[r] : NAN;
    }
    if (ok && subject->start_ms == 0) subject->start_ms = tune_median(starts, tune->rounds).value;
    if (ok) *ms = tune_median(ratios, tune->rounds).value * subject->start_ms;
    free(ratios);
    return ok;
}

/* A failure of the pipeline itself is recorded as missing figures and does not end the search. */
static bool evaluate_on(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                        json_t *line, struct glint_error *err) {
    const enum glint_target answer = answer_args_kind(&tune->against);
    struct glint_verdict verdict;
    struct glint_error own = {0};
    double error = NAN, cost = NAN;
    bool ok = tune_judge(tune, subject, pipeline, &verdict, &own);
    if (ok) {
        const struct glint_metric_table *table = &verdict.errors[answer];
        const struct glint_error no_truth = verdict.no_truth;
        if (tune->against.truth && no_truth.code != GLINT_OK)
            ok = glint_fail(&own, GLINT_ERROR_IO, "%s", no_truth.message);
        else if (!table->invalid_found && !table->invalid_truth) error = table->rows[0].of[tune->metric].value;
        cost = verdict.fetches_px;
        glint_verdict_finish(&verdict);
    }
    ok = ok && (tune->fetches || time_beside_start(tune, subject, pipeline, &cost, &own));
    if (!ok && (own.code == GLINT_ERROR_INTERRUPTED || own.code == GLINT_ERROR_MEMORY || own.code == GLINT_ERROR_IO ||
                glint_device_lost(tune->device)))
        return glint_fail(err, own.code, "%s", own.message);
    json_t *figures = json_pack("{s:o, s:o}", "error", json_number(ok ? error : NAN), "cost", json_number(cost));
    if (!ok) json_object_set_new(figures, "failed", json_string(own.message));
    json_array_append_new(json_object_get(line, "captures"), figures);
    return true;
}

static struct tune_figures figures_on(const json_t *line, size_t s) {
    const json_t *one = json_array_get(json_object_get(line, "captures"), s);
    const json_t *error = json_object_get(one, "error"), *cost = json_object_get(one, "cost");
    return (struct tune_figures){json_is_number(error) ? json_number_value(error) : NAN,
                                 json_is_number(cost) ? json_number_value(cost) : NAN};
}

/* Means over the captures; with --over worst, the largest ratio to the norm of the same capture, times the mean norm. */
static struct tune_figures sum_up(const struct tune *tune, const json_t *line) {
    const double count = (double)tune->captures.count;
    struct tune_figures mean = {0}, norm = {0}, most = {0};
    for (size_t s = 0; s < tune->captures.count; s++) {
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

static bool keep_start(struct tune *tune, struct glint_error *err) {
    json_t *start = json_array();
    for (size_t s = 0; s < tune->captures.count; s++)
        json_array_append_new(start, json_real(tune->subjects[s].start_ms));
    return journal_append(&tune->journal, json_pack("{s:o}", "start_ms", start), err);
}

/* Evaluates on all captures and appends to the journal. Takes ownership of `values`. */
static bool add_line(struct tune *tune, const struct glint_pipeline *pipeline, json_t *values,
                     struct glint_error *err) {
    const bool first = !tune->fetches && tune->subjects[0].start_ms == 0;
    json_t *line = json_pack("{s:o, s:[]}", "values", values, "captures");
    if (!line) return fail_memory(err);
    bool ok = true;
    for (size_t s = 0; ok && s < tune->captures.count; s++)
        ok = evaluate_on(tune, &tune->subjects[s], pipeline, line, err);
    if (!ok || (first && !keep_start(tune, err))) {
        json_decref(line);
        return false;
    }
    tune->fresh++;
    return journal_append(&tune->journal, line, err);
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

bool tune_evaluate(struct tune *tune, const double *values, struct tune_figures *figures, struct glint_error *err) {
    json_t *list = values_json(tune, values);
    const size_t number = (size_t)json_array_size(tune->lines) + 1;
    bool ok = true;
    if (!find_line(tune, list)) {
        struct glint_pipeline *pipeline = tune_pipeline(tune, values, err);
        snprintf(tune->label, sizeof tune->label, "point %zu of %u", number, tune->tries);
        ok = pipeline && add_line(tune, pipeline, json_incref(list), err) && tune_report(tune, NULL, 0);
        if (pipeline) glint_pipeline_destroy(&pipeline);
    }
    tune->done = fmin(1, (double)number / tune->tries);
    if (ok) *figures = sum_up(tune, find_line(tune, list));
    json_decref(list);
    return ok || glint_fail(err, err->code ? err->code : GLINT_ERROR_INTERRUPTED, "%s",
                            err->code ? err->message : "interrupted");
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
        tune->subjects[s].norm.cost = figures_on(line, s).cost / parts[s];
        tune->within += tune->subjects[s].norm.cost / (double)tune->captures.count;
    }
    json_decref(list);
}

/* Decodes the figures of a line of the journal. */
static void values_of(const struct tune *tune, const json_t *line, double *values) {
    for (size_t a = 0; a < tune->axis_count; a++) {
        const struct tune_axis *axis = &tune->axes[a];
        const char *text = json_string_value(json_array_get(json_object_get(line, "values"), a));
        values[a] = axis->texts ? axis->axis.start : strtod(text, NULL);
        for (uint32_t c = 0; c < axis->axis.choices; c++)
            if (!strcmp(axis->texts[c], text)) values[a] = c;
    }
}

bool tune_all_tried(const struct tune *tune, double **values, size_t *count, struct glint_error *err) {
    *count = json_array_size(tune->lines);
    *values = calloc(tune->axis_count * *count + 1, sizeof **values);
    for (size_t i = 0; *values && i < *count; i++)
        values_of(tune, json_array_get(tune->lines, i), *values + tune->axis_count * i);
    return *values || fail_memory(err);
}
