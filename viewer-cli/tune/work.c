/* The journal of a search, and the work whose results it has: running the start on a capture, and evaluating a point on one. A shard has a line for each; one process
   has a line for each point, which is put together of those (try.c). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "record.h"
#include "tune/tune.h"

/* ---- The journal ---- */

/* null: all parameters that can matter, which the pipeline and the captures tell. */
static json_t *axes_json(const struct tune *tune) {
    if (!tune->vary.count) return json_null();
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

static bool is_list_of_texts(const json_t *values) {
    for (size_t a = 0; a < json_array_size(values); a++)
        if (!json_is_string(json_array_get(values, a))) return false;
    return json_is_array(values);
}

static bool are_values(const struct tune *tune, const json_t *values) {
    return is_list_of_texts(values) && (!tune->axes || json_array_size(values) == tune->axis_count);
}

static bool keep_start_times(struct tune *tune, const json_t *start) {
    if (json_array_size(start) != tune->captures.count) return false;
    for (size_t s = 0; s < tune->captures.count; s++)
        tune->subjects[s].start_ms = json_number_value(json_array_get(start, s));
    return tune->timed = true;
}

/* What came of the start on a capture. */
static bool keep_beginning(struct tune_subject *subject, const json_t *line) {
    json_t *slots = json_object_get(line, "slots");
    const char *broken = json_string_value(json_object_get(line, "broken"));
    if (subject->slots || subject->broken) return slots || broken;
    if (json_is_object(slots)) subject->slots = json_incref(slots);
    else if (broken) subject->broken = strdup(broken);
    return subject->slots || subject->broken;
}

char *tune_point_key(size_t capture, const json_t *values) {
    char *texts = values ? record_text(values, JSON_COMPACT) : strdup("start"), *key = NULL;
    if (texts && asprintf(&key, "%zu %s", capture, texts) < 0) key = NULL;
    free(texts);
    return key;
}

/* A point on one capture. */
static bool keep_single(struct tune *tune, size_t capture, json_t *line) {
    struct tune_subject *subject = &tune->subjects[capture];
    const json_t *values = json_object_get(line, "values"), *start = json_object_get(line, "start_ms");
    if (!are_values(tune, values)) return false;
    char *key = tune_point_key(capture, values);
    if (json_is_number(start) && subject->start_ms == 0) subject->start_ms = json_number_value(start);
    const bool ok = key && (json_object_get(tune->single, key) || json_object_set(tune->single, key, line) == 0);
    free(key);
    return ok;
}

bool tune_keep_line(void *user, json_t *line) {
    struct tune *tune = user;
    const json_t *start = json_object_get(line, "start_ms"), *capture = json_object_get(line, "capture");
    if (json_is_array(start)) return keep_start_times(tune, start);
    if (!capture)
        return json_array_size(json_object_get(line, "captures")) == tune->captures.count &&
               are_values(tune, json_object_get(line, "values")) && json_array_append(tune->lines, line) == 0;
    const json_int_t s = json_integer_value(capture);
    if (!json_is_integer(capture) || s < 0 || s >= (json_int_t)tune->captures.count) return false;
    return json_object_get(line, "values") ? keep_single(tune, (size_t)s, line)
                                           : keep_beginning(&tune->subjects[s], line);
}

static bool keep_own_line(void *user, json_t *line) {
    struct tune *tune = user;
    if (!tune_keep_line(user, line)) return false;
    if (json_object_get(line, "capture") && !json_object_get(line, "values"))
        tune->subjects[json_integer_value(json_object_get(line, "capture"))].noted = true;
    return true;
}

/* Everything that results depend on. Budget and seed do not belong to it, so that another search reuses the results. */
bool tune_open(struct tune *tune, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(tune->device);
    json_t *captures = captures_json(&tune->captures, tune->captures.count > 1, err),
           *sources = captures ? shaders_json(tune->shaders, err) : NULL;
    if (!sources) {
        json_decref(captures);
        return false;
    }
    tune->definition = json_pack(
        "{s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:s, s:o, s:o, s:I, s:I, s:s, s:s, s:b, s:[ss]}", "format", 1, "glint",
        GLINT_VERSION, "effect", tune->against.effect->name, "captures", captures, "pipeline",
        pipeline_json(tune->base), "shaders", sources, "axes", axes_json(tune), "cost",
        tune->fetches ? "fetches" : "ms", "slots", strings_json(tune->slots.items), "reference_runs",
        strings_json(tune->against.references.items), "reference_rays", (json_int_t)tune->against.rays, "rounds",
        (json_int_t)tune->rounds, "metric", glint_metric(tune->metric)->name, "against",
        tune->against.truth ? "truth" : "reference", "all", tune->all, "device", device->name, device->driver_version);
    tune->lines = json_array();
    tune->single = json_object();
    tune->journal = (struct journal){.folder = tune->folder, .kind = "tune", .keep = keep_own_line, .user = tune};
    return ((tune->definition && tune->lines && tune->single) || fail_memory(err)) &&
           journal_open(&tune->journal, tune->definition, err);
}

bool tune_check_lines(const struct tune *tune, struct glint_error *err) {
    const char *key;
    json_t *line;
    size_t i;
    bool ok = true;
    json_array_foreach(tune->lines, i, line) ok = ok && are_values(tune, json_object_get(line, "values"));
    json_object_foreach(tune->single, key, line) ok = ok && are_values(tune, json_object_get(line, "values"));
    return ok || glint_fail(err, GLINT_ERROR_FORMAT, "%s/log.jsonl: expected values of %zu parameters in each line",
                            tune->folder, tune->axis_count);
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

/* Whether a failure ends the search; that of a pipeline itself is recorded. */
static bool ends_search(const struct tune *tune, const struct glint_error *own) {
    return own->code == GLINT_ERROR_INTERRUPTED || own->code == GLINT_ERROR_MEMORY || own->code == GLINT_ERROR_IO ||
           glint_device_lost(tune->device);
}

/* The figures of a pipeline on a capture; missing ones where it fails. NULL with an error. */
static json_t *evaluate_on(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                           struct glint_error *err) {
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
    if (!ok && ends_search(tune, &own)) return glint_fail(err, own.code, "%s", own.message), NULL;
    json_t *figures = json_pack("{s:o, s:o}", "error", json_number(ok ? error : NAN), "cost", json_number(cost));
    if (figures && !ok) json_object_set_new(figures, "failed", json_string(own.message));
    if (!figures) fail_memory(err);
    return figures;
}
void tune_values_of(const struct tune *tune, const json_t *texts, double *values) {
    for (size_t a = 0; a < tune->axis_count; a++) {
        const struct tune_axis *axis = &tune->axes[a];
        const char *text = json_string_value(json_array_get(texts, a));
        values[a] = axis->texts ? axis->axis.start : strtod(text, NULL);
        for (uint32_t c = 0; c < axis->axis.choices; c++)
            if (!strcmp(axis->texts[c], text)) values[a] = c;
    }
}
/* ---- Work that shards share out ---- */

static bool begin_subject(struct tune *tune, size_t s, struct glint_error *err) {
    struct tune_subject *subject = &tune->subjects[s];
    struct glint_verdict verdict;
    progress_phase(tune->progress, "start");
    snprintf(tune->label, sizeof tune->label, "%s", glint_pipeline_name(tune->base));
    if (!tune_load_subject(tune, s, 0, err) || !tune_judge(tune, subject, tune->base, &verdict, err)) return false;
    glint_verdict_finish(&verdict);
    return true;
}

/* Runs the start, and finds what its passes did, or why the capture is left out. */
static bool begin_capture(struct tune *tune, size_t s, struct glint_error *err) {
    struct tune_subject *subject = &tune->subjects[s];
    struct glint_error own = {0};
    if (begin_subject(tune, s, &own)) return (subject->slots = tune_slots(tune, subject, err)) != NULL;
    tune_unload_subject(tune, s);
    if (!tune_fails_alone(tune, s, &own)) return glint_fail(err, own.code, "%s", own.message);
    return (subject->broken = strdup(own.message)) != NULL || fail_memory(err);
}

bool tune_note_beginning(struct tune *tune, size_t s, struct glint_error *err) {
    const struct tune_subject *subject = &tune->subjects[s];
    return subject->noted ||
           journal_append(&tune->journal,
                          subject->broken ? json_pack("{s:I, s:s}", "capture", (json_int_t)s, "broken", subject->broken)
                                          : json_pack("{s:I, s:O}", "capture", (json_int_t)s, "slots", subject->slots),
                          err);
}

bool tune_is_known(const struct tune *tune, size_t s, const json_t *values) {
    const struct tune_subject *subject = &tune->subjects[s];
    if (!values || subject->broken) return subject->broken || subject->slots;
    char *key = tune_point_key(s, values);
    const bool known = key && json_object_get(tune->single, key);
    free(key);
    return known;
}

static bool do_point(struct tune *tune, size_t s, const json_t *texts, struct glint_error *err) {
    struct tune_subject *subject = &tune->subjects[s];
    const bool first = !tune->fetches && subject->start_ms == 0;
    double *values = calloc(tune->axis_count + 1, sizeof *values);
    if (!values) return fail_memory(err);
    tune_values_of(tune, texts, values);
    struct glint_pipeline *pipeline = tune_load_subject(tune, s, 0, err) ? tune_pipeline(tune, values, err) : NULL;
    json_t *line = pipeline ? evaluate_on(tune, subject, pipeline, err) : NULL;
    bool ok = line != NULL;
    if (ok && first) json_object_set_new(line, "start_ms", json_real(subject->start_ms));
    if (ok && tune->shard.count) {
        json_object_set_new(line, "capture", json_integer((json_int_t)s));
        json_object_set(line, "values", (json_t *)texts);
        ok = journal_append(&tune->journal, line, err);
    } else if (ok) {
        char *key = tune_point_key(s, texts);
        ok = (key && json_object_set_new(tune->single, key, line) == 0) || fail_memory(err);
        free(key);
    }
    if (pipeline) glint_pipeline_destroy(&pipeline);
    free(values);
    tune->fresh += ok && tune->shard.count;
    return ok;
}

bool tune_do(struct tune *tune, size_t s, const json_t *values, struct glint_error *err) {
    if (values) return do_point(tune, s, values, err);
    return begin_capture(tune, s, err) && (!tune->shard.count || tune_note_beginning(tune, s, err));
}
