/* The results of captures on disk: a line of JSON for each, so that the memory of a comparison does not grow with its captures, and an interrupted one
   goes on where it stopped. With a folder the lines are in its journal, too. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
static bool keep_figures(struct contest_log *log, size_t capture, const json_t *presets) {
    const size_t count = log->contest->count;
    struct glint_error err = {0};
    for (size_t p = 0; p < count; p++) {
        struct showing s;
        double *figures = &log->figures[(capture * count + p) * CONTEST_FIGURES];
        const bool ok = showing_read(log->contest->effect, json_array_get(presets, p), &s, &err);
        const bool judged = ok && s.ran && s.judged[0];
        figures[CONTEST_ERROR] = judged && s.compared && s.shared.of[0].pixels ? s.shared.of[0].symmetric : (double)NAN;
        figures[CONTEST_MS] = ok && s.ran && s.frame.n ? s.frame.median : (double)NAN;
        figures[CONTEST_COVERAGE] = judged ? showing_coverage(&s, 0) : (double)NAN;
        showing_finish(&s);
        if (!ok) return false;
    }
    return true;
}

/* Writes a line where it is found again; false when it does not belong to this comparison. */
static bool keep_line(void *user, json_t *line) {
    struct contest_log *log = user;
    const json_t *number = json_object_get(line, "capture"), *presets = json_object_get(line, "presets");
    const json_int_t capture = json_integer_value(number);
    const bool failed = json_is_string(json_object_get(line, "failure"));
    if (!json_is_integer(number) || capture < 0 || capture >= (json_int_t)log->captures->count ||
        !json_is_array(presets) || json_array_size(presets) != (failed ? 0 : log->contest->count))
        return false;
    char *text = record_text(line, JSON_COMPACT);
    struct contest_entry *entry = &log->entries[capture];
    const bool ok = text && fseek(log->spool, 0, SEEK_END) == 0 && (entry->at = ftell(log->spool)) >= 0 &&
                    fprintf(log->spool, "%s\n", text) > 0 && (failed || keep_figures(log, (size_t)capture, presets));
    if (!ok) glint_fail(&log->fault, GLINT_ERROR_IO, "the temporary file of results: %s", strerror(errno));
    entry->state = failed ? CONTEST_UNREADABLE : CONTEST_DONE;
    free(text);
    return ok;
}

bool contest_log_add(struct contest_log *log, size_t capture, const struct showing *showings, const char *failure,
                     struct glint_error *err) {
    const struct contest *contest = log->contest;
    json_t *presets = json_array();
    for (size_t p = 0; showings && p < contest->count; p++)
        json_array_append_new(presets, showing_json(contest->effect, contest->contestants[p].label, &showings[p]));
    json_t *line = json_pack("{s:I, s:o}", "capture", (json_int_t)capture, "presets", presets);
    if (!showings) json_object_set_new(line, "failure", json_string(failure));
    return journal_append(&log->journal, line, err) && contest_log_check(log, err);
}

/* ---- Reading back ---- */

json_t *contest_log_line(const struct contest_log *log, size_t capture) {
    struct contest_log *own = (struct contest_log *)log; /* whose place in the file is no state of it */
    char *text = NULL;
    size_t size = 0;
    json_t *line = NULL;
    if (log->entries[capture].state == CONTEST_MISSING) return NULL;
    errno = 0;
    const bool found = fseek(log->spool, log->entries[capture].at, SEEK_SET) == 0 &&
                       getline(&text, &size, log->spool) > 0 && !ferror(log->spool);
    const int why = errno;
    if (found) line = json_loads(text, 0, NULL);
    if (!line)
        glint_fail(&own->fault, GLINT_ERROR_IO, "the temporary file of results: cannot be read back: %s",
                   strerror(why));
    free(text);
    return line;
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

/* A capture from stdin is another one each time: there is nothing to resume. */
static bool reads_stdin(const struct list *captures) {
    for (size_t i = 0; i < captures->count; i++)
        if (!strcmp(captures->items[i], "-")) return true;
    return false;
}

static bool open_journal(struct contest_log *log, struct glint_error *err) {
    if (!log->folder) return true;
    if (reads_stdin(log->captures)) return (log->lock = glint_folder_lock(log->folder, err)) != NULL;
    json_t *definition = define(log->contest, log->captures, err);
    log->journal.folder = log->folder;
    const bool ok = definition && journal_open(&log->journal, definition, err);
    json_decref(definition);
    return ok;
}

bool contest_log_open(struct contest_log *log, const struct contest *contest, const struct list *captures,
                      const char *folder, struct glint_error *err) {
    const size_t rows = captures->count * contest->count;
    *log = (struct contest_log){.contest = contest, .captures = captures, .folder = folder, .loaded = SIZE_MAX};
    log->journal = (struct journal){.kind = "compare", .keep = keep_line, .user = log};
    log->entries = calloc(captures->count + 1, sizeof *log->entries);
    log->figures = malloc((rows + 1) * CONTEST_FIGURES * sizeof *log->figures);
    log->showings = calloc(contest->count + 1, sizeof *log->showings);
    if (!log->entries || !log->figures || !log->showings) return fail_memory(err);
    for (size_t i = 0; i < rows * CONTEST_FIGURES; i++) log->figures[i] = NAN;
    if (!(log->spool = tmpfile()))
        return glint_fail(err, GLINT_ERROR_IO, "a temporary file for results: %s", strerror(errno));
    return open_journal(log, err);
}

void contest_log_remove(const char *folder) {
    static const char *const names[] = {"log.jsonl", "compare.json"};
    char path[4096];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (journal_path(folder, names[i], path, NULL)) unlink(path);
}

void contest_log_close(struct contest_log *log, bool finished) {
    if (log->journal.log > 0 && (finished || !log->journal.results)) contest_log_remove(log->folder);
    forget(log);
    journal_close(&log->journal);
    glint_folder_unlock(&log->lock);
    if (log->spool) fclose(log->spool);
    free(log->entries);
    free(log->figures);
    free(log->showings);
    *log = (struct contest_log){0};
}
