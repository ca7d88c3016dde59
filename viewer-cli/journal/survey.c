/* Surveys: one result for each of many captures, in a journal. */
#include "journal/survey.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "io/output.h"
#include "record.h"

void survey_check(const struct shard *shard, const char *out, struct argp_state *state) {
    if (shard->count && !out) argp_error(state, "--shard: no folder given for the share: -o FOLDER");
}

bool survey_place(struct survey *survey, const char *out, struct glint_error *err) {
    survey->folder = survey->shard.count ? survey->own : out;
    return !survey->shard.count || shard_folder(&survey->shard, out, survey->own, err);
}

/* ---- What a journal belongs to ---- */

json_t *survey_file(const char *path, double *bytes) {
    struct stat info;
    if (stat(path, &info) != 0) return json_string(strerror(errno));
    *bytes += (double)info.st_size;
    return json_sprintf("%lld bytes of %lld.%09ld", (long long)info.st_size, (long long)info.st_mtim.tv_sec,
                        info.st_mtim.tv_nsec);
}

bool survey_has_stdin(const struct list *captures) {
    for (size_t i = 0; i < captures->count; i++)
        if (!strcmp(captures->items[i], "-")) return true;
    return false;
}

static bool open_files(struct survey *survey, const struct list *captures, struct glint_error *err) {
    json_t *files = json_array();
    double *costs = calloc(captures->count + 1, sizeof *costs);
    survey->count = captures->count;
    for (size_t i = 0; costs && survey->folder && i < captures->count; i++)
        record_append(&files, survey_file(captures->items[i], &costs[i]));
    json_t *definition = json_pack("{s:i, s:s, s:o}", "format", 1, "glint", GLINT_VERSION, "captures", files);
    const bool whole = (costs && definition) || fail_memory(err);
    const bool ok = whole && survey_open(survey, definition, costs, survey_has_stdin(captures), err);
    if (!whole) json_decref(definition);
    free(costs);
    return ok;
}

/* ---- Lines ---- */

static bool keep_line(void *user, json_t *line) {
    struct survey *survey = user;
    const json_t *number = json_object_get(line, survey->item);
    const json_int_t i = json_integer_value(number);
    if (!json_is_integer(number) || i < 0 || i >= (json_int_t)survey->count) return false;
    survey->at[i] = survey->journal.at;
    return true;
}

static void cut(struct survey *survey, const double *costs, struct shard_cost *each) {
    for (size_t i = 0; i < survey->count; i++) each[i] = (struct shard_cost){0, costs[i] > 1 ? costs[i] : 1};
    shard_cut(&survey->shard, each, survey->count, 1, &survey->begin, &survey->end);
}

static bool open_journal(struct survey *survey, const json_t *definition, bool unrepeatable, struct glint_error *err) {
    survey->journal =
        (struct journal){.kind = survey->command->name, .reread = survey->reread, .keep = keep_line, .user = survey};
    if (survey->folder && !unrepeatable) survey->journal.folder = survey->folder;
    else if (survey->folder && !(survey->lock = glint_folder_lock(survey->folder, err))) return false;
    if (journal_open(&survey->journal, definition, err)) return true;
    survey->journal.folder = NULL; /* what could not be read is not removed */
    return false;
}

bool survey_open(struct survey *survey, json_t *definition, const double *costs, bool unrepeatable,
                 struct glint_error *err) {
    struct shard_cost *each = calloc(survey->count + 1, sizeof *each);
    survey->at = malloc((survey->count + 1) * sizeof *survey->at);
    for (size_t i = 0; survey->at && i < survey->count; i++) survey->at[i] = -1;
    bool ok = definition && ((each && survey->at) || fail_memory(err));
    if (ok && unrepeatable && survey->shard.count)
        ok = glint_fail(err, GLINT_ERROR_USAGE, "--shard: expected captures that each process can read, found stdin");
    if (ok) cut(survey, costs, each);
    ok = ok && open_journal(survey, definition, unrepeatable, err);
    free(each);
    json_decref(definition);
    return ok;
}

bool survey_has(const struct survey *survey, size_t i) {
    return survey->at[i] >= 0;
}

json_t *survey_line(struct survey *survey, size_t i, struct glint_error *err) {
    return journal_read(&survey->journal, survey->at[i], err);
}

bool survey_fail_line(const struct survey *survey, size_t i, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s: the result of %s %zu is not one of this %s", survey->folder,
                      survey->item, i, survey->command->name);
}

json_t *survey_take(struct survey *survey, size_t i, survey_make make, void *user, struct glint_error *err) {
    if (survey_has(survey, i)) return survey_line(survey, i, err);
    json_t *found = make(user, i, err);
    if (!found) return NULL;
    json_t *line = json_pack("{s:I}", survey->item, (json_int_t)i);
    bool ok = (line && json_object_update(line, found) == 0) || fail_memory(err);
    json_decref(found);
    ok = ok && journal_append(&survey->journal, json_incref(line), err);
    if (ok) return line;
    json_decref(line);
    return NULL;
}

/* ---- Shares and results ---- */

bool survey_begin_shard(struct survey *survey, int argc, char **argv, struct glint_error *err) {
    survey->record = (struct shard_record){.shard = survey->shard,
                                           .folder = survey->folder,
                                           .results = survey->end - survey->begin,
                                           .argc = argc,
                                           .argv = argv,
                                           .result = SURVEY_RESULT};
    return !survey->shard.count || shard_begin(&survey->record, err);
}

bool survey_end_shard(struct survey *survey, struct glint_error *err) {
    return !survey->shard.count || shard_write(&survey->record, true, err);
}

bool survey_begin_files(struct survey *survey, const char *out, const struct list *captures, int argc, char **argv,
                        struct glint_error *err) {
    return survey_place(survey, out, err) && open_files(survey, captures, err) &&
           survey_begin_shard(survey, argc, argv, err);
}

void survey_note_kept(const struct survey *survey) {
    char text[512];
    if (!survey->journal.folder) return;
    journal_describe_kept(&survey->journal, "results", text);
    command_note(survey->command, "%s", text);
}

bool survey_has_result(const struct survey *survey) {
    return survey->folder && !survey->shard.count;
}

bool survey_write_json(const struct survey *survey, json_t *json, struct glint_error *err) {
    char path[4096], *text = json ? record_text(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    struct output output;
    json_decref(json);
    if (!text)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: out of memory, or a path that is not UTF-8", survey->folder);
    bool ok = journal_path(survey->folder, SURVEY_RESULT, path, err) && output_open(&output, path, err);
    if (ok) {
        fprintf(output.file, "%s\n", text);
        ok = output_close(&output, true, err);
    }
    free(text);
    return ok;
}

void survey_close(struct survey *survey, bool finished) {
    const bool kept = survey->shard.count || (!finished && survey->journal.results);
    if (survey->journal.folder && survey->journal.log > 0 && !kept)
        journal_remove(survey->folder, survey->command->name);
    journal_close(&survey->journal);
    glint_folder_unlock(&survey->lock);
    free(survey->at);
    survey->at = NULL;
}
