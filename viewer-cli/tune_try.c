/* Evaluates pipelines on all captures that are tuned on, once each, and keeps what was found. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tune.h"

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

bool tune_report(void *user, const char *what, double done) {
    struct tune *tune = user;
    (void)what;
    (void)done;
    return progress_report(tune->progress, tune->label, tune->done);
}

void tune_unload_subject(struct tune *tune, size_t s) {
    struct tune_subject *subject = &tune->subjects[s];
    if (subject->judge) glint_judge_destroy(&subject->judge);
    if (subject->capture) glint_capture_close(&subject->capture);
}

bool tune_load_subject(struct tune *tune, size_t s, uint32_t resamples, struct glint_error *err) {
    struct tune_subject *subject = &tune->subjects[s];
    struct glint_judge_options options = answer_args_judge(&tune->against, tune->folder, s);
    options.all = tune->all;
    options.metrics = GLINT_METRICS_CHEAP | 1u << tune->metric;
    options.resamples = resamples;
    options.keep_resampled = resamples != 0;
    options.seed = 1;
    const enum glint_answer answer = answer_args_kind(&tune->against);
    const float *error;
    return (subject->capture = glint_capture_open(subject->path, NULL, err)) &&
           (subject->judge = glint_judge_create(tune->device, &options, err)) &&
           glint_judge_load(subject->judge, subject->capture, err) &&
           glint_judge_answer(subject->judge, answer, tune->base, &error, progress_report, tune->progress, err);
}

bool tune_load(struct tune *tune, struct glint_error *err) {
    tune->subject_count = tune->captures.count + tune->unseen.count;
    tune->subjects = calloc(tune->subject_count + 1, sizeof *tune->subjects);
    if (!tune->subjects) return no_memory(err);
    for (size_t s = 0; s < tune->subject_count; s++) {
        struct tune_subject *subject = &tune->subjects[s];
        subject->unseen = s >= tune->captures.count;
        subject->path = subject->unseen ? tune->unseen.items[s - tune->captures.count] : tune->captures.items[s];
        if (subject->unseen) continue;
        struct glint_verdict verdict;
        snprintf(tune->label, sizeof tune->label, "%s", glint_pipeline_name(tune->base));
        if (!tune_load_subject(tune, s, 0, err) ||
            !glint_judge_look(subject->judge, tune->base, 0, &verdict, tune_report, tune, err))
            return false;
        glint_verdict_finish(&verdict);
    }
    return true;
}

double tune_frame_ms(const struct tune *tune, const struct glint_cost *cost) {
    uint64_t ns = 0;
    for (size_t i = 0; i < cost->pass_count; i++) {
        bool counts = !tune->slots.count;
        for (size_t k = 0; k < tune->slots.count; k++)
            counts |= !strcmp(cost->passes[i].pass->slot, tune->slots.items[k]);
        if (counts && !cost->passes[i].cached_work) ns += cost->passes[i].ns;
    }
    return (double)ns * 1e-6;
}

/* ---- What is kept ---- */

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

static bool keep(void *user, json_t *line) {
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
        (!json_is_number(json_object_get(line, "scale")) && json_array_size(values) != tune->axis_count))
        return false;
    return json_array_append(tune->lines, line) == 0;
}

/* All that figures depend on. Neither the budget nor the seed: another search finds them again. */
bool tune_open(struct tune *tune, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(tune->device);
    json_t *captures = captures_json(&tune->captures, err),
           *sources = captures ? shaders_json(&tune->shaders, err) : NULL;
    if (!sources) {
        json_decref(captures);
        return false;
    }
    json_t *definition =
        json_pack("{s:i, s:s, s:o, s:o, s:o, s:o, s:s, s:o, s:o, s:I, s:I, s:s, s:s, s:b, s:[ss]}", "format", 1,
                  "glint", GLINT_VERSION, "captures", captures, "pipeline", pipeline_json(tune->base), "shaders",
                  sources, "axes", axes_json(tune), "cost", tune->fetches ? "fetches" : "ms", "slots",
                  strings_json(tune->slots.items), "reference_runs", strings_json(tune->against.references.items),
                  "reference_rays", (json_int_t)tune->against.rays, "rounds", (json_int_t)tune->rounds, "metric",
                  glint_metric(tune->metric)->name, "against", tune->against.truth ? "truth" : "reference", "all",
                  tune->all, "device", device->name, device->driver_version);
    tune->lines = json_array();
    tune->journal.folder = tune->folder;
    tune->journal.kind = "tuning";
    tune->journal.keep = keep;
    tune->journal.user = tune;
    const bool ok = (definition && tune->lines) ? journal_open(&tune->journal, definition, err) : no_memory(err);
    json_decref(definition);
    return ok;
}

/* ---- Evaluations ---- */

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count) {
    qsort(values, count, sizeof *values, ascending);
    return count ? (values[(count - 1) / 2] + values[count / 2]) / 2 : NAN;
}

static bool time_once(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                      double *ms, struct glint_error *err) {
    struct glint_cost cost;
    if (!glint_judge_time(subject->judge, pipeline, 0, false, &cost, tune_report, tune, err)) return false;
    *ms = tune_frame_ms(tune, &cost);
    glint_cost_finish(&cost);
    return true;
}

/* In turns with the start: what changes with time, as a device's clock, is in both. */
static bool time_beside_start(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                              double *ms, struct glint_error *err) {
    double *ratios = calloc(2 * tune->rounds + 1, sizeof *ratios), *starts = ratios + tune->rounds;
    bool ok = ratios || no_memory(err);
    for (uint32_t r = 0; ok && r < tune->rounds; r++) {
        double own = 0;
        glint_judge_next_round(subject->judge);
        ok = time_once(tune, subject, tune->base, &starts[r], err) && time_once(tune, subject, pipeline, &own, err);
        ratios[r] = starts[r] > 0 ? own / starts[r] : NAN;
    }
    if (ok && subject->start_ms == 0) subject->start_ms = median(starts, tune->rounds);
    if (ok) *ms = median(ratios, tune->rounds) * subject->start_ms;
    free(ratios);
    return ok;
}

/* Failures that a pipeline has itself are figures that it has not. */
static bool evaluate_on(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                        json_t *line, struct glint_error *err) {
    const enum glint_answer answer = answer_args_kind(&tune->against);
    struct glint_verdict verdict;
    struct glint_error own = {0};
    double error = NAN, cost = NAN;
    bool ok = glint_judge_look(subject->judge, pipeline, 0, &verdict, tune_report, tune, &own);
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
    if (!ok && (own.code == GLINT_ERROR_INTERRUPTED || own.code == GLINT_ERROR_MEMORY || own.code == GLINT_ERROR_IO))
        return glint_fail(err, own.code, "%s", own.message);
    json_t *figures = json_pack("{s:o, s:o}", "error", json_number(ok ? error : NAN), "cost", json_number(cost));
    if (!ok) json_object_set_new(figures, "failed", json_string(own.message));
    json_array_append_new(json_object_get(line, "captures"), figures);
    return true;
}

static bool sum_up(const json_t *line, struct tune_figures *figures) {
    const json_t *captures = json_object_get(line, "captures"), *one;
    const double count = (double)json_array_size(captures);
    size_t i;
    *figures = (struct tune_figures){0};
    json_array_foreach(captures, i, one) {
        const json_t *error = json_object_get(one, "error"), *cost = json_object_get(one, "cost");
        figures->error += (json_is_number(error) ? json_number_value(error) : NAN) / count;
        figures->cost += (json_is_number(cost) ? json_number_value(cost) : NAN) / count;
    }
    return true;
}

static bool keep_start(struct tune *tune, struct glint_error *err) {
    json_t *start = json_array();
    for (size_t s = 0; s < tune->captures.count; s++)
        json_array_append_new(start, json_real(tune->subjects[s].start_ms));
    return journal_append(&tune->journal, json_pack("{s:o}", "start_ms", start), err);
}

/* `key` with `value`, which is taken, tells this pipeline from others. */
static bool evaluate(struct tune *tune, const struct glint_pipeline *pipeline, const char *key, json_t *value,
                     struct tune_figures *figures, struct glint_error *err) {
    const bool first = !tune->fetches && tune->subjects[0].start_ms == 0;
    size_t i;
    json_t *line;
    json_array_foreach(tune->lines, i, line) if (json_equal(json_object_get(line, key), value)) {
        json_decref(value);
        return sum_up(line, figures);
    }
    if (!(line = json_pack("{s:o, s:[]}", key, value, "captures"))) return no_memory(err);
    bool ok = true;
    for (size_t s = 0; ok && s < tune->captures.count; s++)
        ok = evaluate_on(tune, &tune->subjects[s], pipeline, line, err);
    ok = ok && (!first || keep_start(tune, err)) && sum_up(line, figures);
    if (!ok) {
        json_decref(line);
        return false;
    }
    tune->fresh++;
    return journal_append(&tune->journal, line, err);
}

static bool try_values(void *user, const double *values, struct glint_search_figures *figures,
                       struct glint_error *err) {
    struct tune *tune = user;
    struct tune_figures found;
    json_t *key = json_array();
    for (size_t a = 0; a < tune->axis_count; a++) {
        char text[TUNE_TEXT];
        tune_value_text(&tune->axes[a], values[a], text);
        json_array_append_new(key, json_string(text));
    }
    struct glint_pipeline *pipeline = tune_pipeline(tune, values, err);
    const size_t number = (size_t)json_array_size(tune->lines) + 1;
    if (!pipeline) {
        json_decref(key);
        return false;
    }
    snprintf(tune->label, sizeof tune->label, "point %zu", number);
    const bool ok = evaluate(tune, pipeline, "values", key, &found, err) && tune_report(tune, NULL, 0);
    glint_pipeline_destroy(&pipeline);
    tune->done = 0.9 * fmin(1, (double)number / tune->tries);
    if (!ok)
        return glint_fail(err, err->code ? err->code : GLINT_ERROR_INTERRUPTED, "%s",
                          err->code ? err->message : "interrupted");
    *figures = (struct glint_search_figures){tune->by_error ? found.cost : found.error,
                                             tune->by_error ? found.error : found.cost};
    return true;
}

bool tune_search(struct tune *tune, struct glint_error *err) {
    enum { NOISE_PER_CENT = 2 };
    struct glint_search_axis *axes = calloc(tune->axis_count + 1, sizeof *axes);
    double *start = calloc(tune->axis_count + 1, sizeof *start);
    struct glint_search_figures at;
    bool ok = (axes && start) || no_memory(err);
    for (size_t a = 0; ok && a < tune->axis_count; a++) {
        axes[a] = tune->axes[a].axis;
        axes[a].hidden = tune->axes[a].other;
        start[a] = axes[a].start;
    }
    ok = ok && try_values(tune, start, &at, err);
    if (ok) {
        tune->start = tune->by_error ? (struct tune_figures){at.limited, at.wanted}
                                     : (struct tune_figures){at.wanted, at.limited};
        tune->within = tune->limit * (tune->part ? at.limited : 1);
        const struct glint_search_options options = {.limit = tune->within,
                                                     .tries = tune->tries,
                                                     .seed = tune->seed,
                                                     .noise = tune->fetches ? 0 : NOISE_PER_CENT * 0.01};
        ok = glint_search(axes, tune->axis_count, &options, try_values, tune, &tune->found, err);
    }
    tune->chosen = tune->found.best;
    free(start);
    free(axes);
    return ok;
}

static bool evaluate_scale(struct tune *tune, double factor, struct tune_figures *figures, struct glint_error *err) {
    struct glint_pipeline *pipeline = tune_scaled(tune, factor, err);
    snprintf(tune->label, sizeof tune->label, "all steps times %.3g", factor);
    const bool ok = pipeline && evaluate(tune, pipeline, "scale", json_real(factor), figures, err);
    if (pipeline) glint_pipeline_destroy(&pipeline);
    return ok;
}

/* By halving: costs rise with the factor. Where even the smallest costs more, it is the smallest. */
bool tune_find_scale(struct tune *tune, struct glint_error *err) {
    enum { HALVINGS = 9 };
    const struct glint_search_figures *tuned = &tune->found.points[tune->chosen].figures;
    const double cost = tune->by_error ? tuned->wanted : tuned->limited;
    double low = -10, high = 3; /* of the factor, as powers of two */
    if (!evaluate_scale(tune, exp2(low), &tune->scaled, err)) return false;
    tune->factor = exp2(low);
    for (int i = 0; tune->scaled.cost < cost && i < HALVINGS; i++) {
        struct tune_figures figures;
        const double middle = (low + high) / 2;
        if (!evaluate_scale(tune, exp2(middle), &figures, err)) return false;
        if (figures.cost >= cost) {
            high = middle;
        } else low = middle;
    }
    if (tune->scaled.cost < cost) {
        tune->factor = exp2(high);
        return evaluate_scale(tune, tune->factor, &tune->scaled, err);
    }
    return true;
}
