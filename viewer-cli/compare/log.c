/* The results of captures on disk: a line of JSON for each, so that the memory of a comparison does not grow with its captures, and an interrupted one
   goes on where it stopped. */
#include <math.h>
#include <stdlib.h>

#include "compare/compare.h"
#include "options/capture_set.h"
#include "record.h"

/* ---- The study that a journal belongs to ---- */

/* Everything that the results depend on. */
static json_t *define(const struct contest *contest, const struct list *captures, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(contest->device);
    json_t *hashes = captures_json(captures, captures->count > 1, err), *presets = json_array();
    for (size_t p = 0; p < contest->count; p++)
        json_array_append_new(presets, json_pack("{s:s, s:o}", "label", contest->contestants[p].label, "pipeline",
                                                 pipeline_json(contest->contestants[p].pipeline)));
    if (!hashes) {
        json_decref(presets);
        return NULL;
    }
    json_t *json = json_pack("{s:i, s:s, s:s, s:o, s:o, s:I, s:[ss]}", "format", 1, "glint", GLINT_VERSION, "effect",
                             contest->effect->name, "captures", hashes, "presets", presets, "repeat",
                             (json_int_t)contest->rounds, "device", device->name, device->driver_version);
    if (!json) fail_memory(err);
    return json;
}

/* ---- Lines ---- */

/* Keeps the figures of a capture in memory. */
static bool keep_figures(struct contest_log *log, size_t capture, const json_t *presets, struct glint_error *err) {
    const size_t count = log->contest->count;
    for (size_t p = 0; p < count; p++) {
        struct showing s;
        double *figures = &log->figures[(capture * count + p) * CONTEST_FIGURES];
        const bool ok = showing_read(log->contest->effect, json_array_get(presets, p), &s, err);
        const bool judged = ok && s.ran && s.judged[0];
        figures[CONTEST_ERROR] = judged && s.compared && s.shared.of[0].pixels ? s.shared.of[0].symmetric : (double)NAN;
        figures[CONTEST_MS] = ok && s.ran && s.frame.n ? s.frame.median : (double)NAN;
        figures[CONTEST_COVERAGE] = judged ? showing_coverage(&s, 0) : (double)NAN;
        showing_finish(&s);
        if (!ok) return false;
    }
    return true;
}

bool contest_log_keep(struct contest_log *log, size_t capture, const json_t *line, struct glint_error *err) {
    const json_t *presets = json_object_get(line, "presets");
    const bool failed = json_is_string(json_object_get(line, "failure"));
    if (!json_is_array(presets) || json_array_size(presets) != (failed ? 0 : log->contest->count))
        return survey_fail_line(&log->survey, capture, err);
    log->states[capture] = failed ? CONTEST_UNREADABLE : CONTEST_DONE;
    return failed || keep_figures(log, capture, presets, err);
}

json_t *contest_log_entry(const struct contest *contest, const struct showing *showings, const char *failure) {
    json_t *presets = json_array();
    for (size_t p = 0; showings && p < contest->count; p++)
        record_append(&presets, showing_json(contest->effect, contest->contestants[p].label, &showings[p]));
    json_t *line = json_pack("{s:o}", "presets", presets);
    if (!showings) record_set(&line, "failure", json_text(failure));
    return line;
}

/* ---- Reading back ---- */

json_t *contest_log_line(const struct contest_log *log, size_t capture) {
    struct contest_log *own = (struct contest_log *)log; /* whose place in the file is no state of it */
    return log->states[capture] == CONTEST_MISSING ? NULL : survey_line(&own->survey, capture, &own->fault);
}

static void forget(struct contest_log *log) {
    for (size_t p = 0; log->showings && p < log->contest->count; p++) showing_finish(&log->showings[p]);
    log->loaded = SIZE_MAX;
}

const struct showing *contest_log_showings(const struct contest_log *log, size_t capture) {
    struct contest_log *own = (struct contest_log *)log;
    if (log->loaded == capture) return log->showings;
    forget(own);
    json_t *line = contest_log_line(log, capture);
    const json_t *presets = json_object_get(line, "presets");
    for (size_t p = 0; p < json_array_size(presets); p++)
        showing_read(log->contest->effect, json_array_get(presets, p), &log->showings[p], &own->fault);
    json_decref(line);
    own->loaded = capture;
    return log->showings;
}

double contest_log_figure(const struct contest_log *log, size_t capture, size_t preset, enum contest_figure figure) {
    return log->figures[(capture * log->contest->count + preset) * CONTEST_FIGURES + figure];
}

bool contest_log_check(const struct contest_log *log, struct glint_error *err) {
    return !log->fault.code || glint_fail(err, log->fault.code, "%s", log->fault.message);
}

/* ---- Opening and closing ---- */

/* How long each capture takes, by its pixels, where that is asked for. */
static double *find_costs(const struct list *captures, const struct shard *shard, struct glint_error *err) {
    double *costs = calloc(captures->count + 1, sizeof *costs);
    bool ok = costs || fail_memory(err);
    for (size_t i = 0; ok && shard->count && i < captures->count; i++)
        ok = shard_pixels(captures->items[i], &costs[i], err);
    if (ok) return costs;
    free(costs);
    return NULL;
}

/* A capture from stdin is another one each time: there is nothing to resume. */
static bool open_survey(struct contest_log *log, const struct shard *shard, struct glint_error *err) {
    const bool stdin_too = survey_has_stdin(log->captures);
    double *costs = find_costs(log->captures, shard, err);
    if (!costs) return false;
    json_t *definition = log->survey.folder && !stdin_too ? define(log->contest, log->captures, err) : json_object();
    const bool ok = survey_open(&log->survey, definition, costs, stdin_too, err);
    free(costs);
    return ok;
}

bool contest_log_open(struct contest_log *log, const struct contest *contest, const struct list *captures,
                      const char *folder, const struct shard *shard, struct glint_error *err) {
    const size_t rows = captures->count * contest->count;
    *log = (struct contest_log){.contest = contest, .captures = captures, .loaded = SIZE_MAX};
    log->survey = (struct survey){.command = &cmd_compare,
                                  .item = "capture",
                                  .folder = folder,
                                  .shard = *shard,
                                  .count = captures->count,
                                  .reread = true};
    log->states = calloc(captures->count + 1, sizeof *log->states);
    log->figures = malloc((rows + 1) * CONTEST_FIGURES * sizeof *log->figures);
    log->showings = calloc(contest->count + 1, sizeof *log->showings);
    if (!log->states || !log->figures || !log->showings) return fail_memory(err);
    for (size_t i = 0; i < rows * CONTEST_FIGURES; i++) log->figures[i] = NAN;
    return open_survey(log, shard, err);
}

void contest_log_close(struct contest_log *log, bool finished) {
    forget(log);
    survey_close(&log->survey, finished);
    free(log->states);
    free(log->figures);
    free(log->showings);
    *log = (struct contest_log){0};
}
