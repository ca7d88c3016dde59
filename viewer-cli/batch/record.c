/* batch.json: how many shards there are, and which jobs were submitted, in this order:
   {"format": 1, "command": "sweep", "shards": 8, "jobs": [{"job": "12", "shards": [1, …]}, {"job": "13", "merge": true}, …]} */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "batch/batch.h"
#include "glint/replay.h"
#include "io/output.h"
#include "journal/journal.h"
#include "journal/shard.h"
#include "record.h"

#define RECORD "batch.json"

bool batch_path(const struct batch *batch, const char *name, char path[4096], struct glint_error *err) {
    return journal_path(batch->folder, name, path, err);
}

/* The lock is on the folder of logs, since the folder itself is that of the merge. It is made before: one that the lock makes goes with it while it is empty. */
static bool lock(struct batch *batch, struct glint_error *err) {
    char path[4096];
    return batch_path(batch, BATCH_LOGS, path, err) && glint_make_folder(path, err) &&
           (batch->lock = glint_folder_lock(path, err)) != NULL;
}

static bool make_shards(struct batch *batch, size_t count, struct glint_error *err) {
    batch->count = count;
    batch->shards = calloc(count, sizeof *batch->shards);
    return batch->shards || fail_memory(err);
}

/* Slurm replaces %x in the whole path of a log, and a backslash keeps it from doing so. */
static bool check_name(const char *folder, struct glint_error *err) {
    char *here = realpath(".", NULL), *whole = realpath(folder, NULL); /* which need not be there yet */
    const bool ok =
        !strpbrk(whole ? whole : folder, "%\\") && (whole || folder[0] == '/' || !here || !strpbrk(here, "%\\"));
    free(here);
    free(whole);
    return ok || glint_fail(err, GLINT_ERROR_USAGE,
                            "%s: Slurm does not write logs into a folder with %% or \\ in its path", folder);
}

/* Whether there is a record of jobs, or one that cannot be read. */
static bool was_submitted(const char *path) {
    if (access(path, F_OK) != 0) return false;
    json_t *record = json_inside(path, NULL);
    const json_t *jobs = json_object_get(record, "jobs");
    const bool none = json_is_array(jobs) && json_array_size(jobs) == 0;
    json_decref(record);
    return !none;
}

bool batch_create(struct batch *batch, const char *folder, const char *command, size_t shards,
                  struct glint_error *err) {
    char path[4096];
    *batch = (struct batch){.folder = folder};
    snprintf(batch->command, sizeof batch->command, "%s", command);
    if (!check_name(folder, err) || !lock(batch, err) || !batch_path(batch, RECORD, path, err) ||
        !make_shards(batch, shards, err))
        return false;
    if (was_submitted(path))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: there is a batch in this folder already, which glint batch resubmit continues; choose "
                          "another folder",
                          folder);
    batch->record = json_pack("{s:i, s:s, s:s, s:I, s:[]}", "format", 1, "glint", GLINT_VERSION, "command", command,
                              "shards", (json_int_t)shards, "jobs");
    return batch->record || fail_memory(err);
}

bool batch_write(const struct batch *batch, struct glint_error *err) {
    char path[4096];
    if (!batch_path(batch, RECORD, path, err)) return false;
    char *text = record_text(batch->record, JSON_INDENT(1));
    const bool ok = text ? output_text(path, text, err) : fail_memory(err);
    free(text);
    return ok;
}

/* ---- Jobs ---- */

static bool note(struct batch *batch, json_t *entry, struct glint_error *err) {
    json_t *jobs = json_object_get(batch->record, "jobs");
    return (entry && json_array_append_new(jobs, entry) == 0) || fail_memory(err);
}

bool batch_note_array(struct batch *batch, const char *job, const bool *chosen, struct glint_error *err) {
    json_t *shards = json_array();
    for (size_t i = 0; i < batch->count; i++) {
        if (!chosen[i]) continue;
        record_append(&shards, json_integer((json_int_t)i + 1));
        batch->shards[i].job = (struct batch_job){0};
        snprintf(batch->shards[i].job.job, BATCH_WORD, "%s", job);
    }
    return note(batch, json_pack("{s:s, s:o}", "job", job, "shards", shards), err) && batch_write(batch, err);
}

bool batch_note_merge(struct batch *batch, const char *job, struct glint_error *err) {
    batch->merge = (struct batch_job){0};
    snprintf(batch->merge.job, BATCH_WORD, "%s", job);
    return note(batch, json_pack("{s:s, s:b}", "job", job, "merge", 1), err) && batch_write(batch, err);
}

/* ---- Reading ---- */

/* Whether the text is the number of a job, and nothing that a program could take as an option. */
static bool is_number(const char *text) {
    return text && *text && strlen(text) < BATCH_WORD && !text[strspn(text, "0123456789")];
}

static bool read_job(struct batch *batch, const json_t *entry) {
    const char *job = json_string_value(json_object_get(entry, "job"));
    const json_t *shards = json_object_get(entry, "shards"), *item;
    size_t i;
    if (!is_number(job)) return false;
    if (json_is_true(json_object_get(entry, "merge"))) {
        snprintf(batch->merge.job, BATCH_WORD, "%s", job);
        return true;
    }
    json_array_foreach(shards, i, item) {
        const json_int_t shard = json_integer_value(item);
        if (shard < 1 || shard > (json_int_t)batch->count) return false;
        snprintf(batch->shards[shard - 1].job.job, BATCH_WORD, "%s", job);
    }
    return json_is_array(shards);
}

static bool read_record(struct batch *batch, const char *path, struct glint_error *err) {
    if (!(batch->record = json_inside(path, err))) return false;
    const json_t *jobs = json_object_get(batch->record, "jobs"), *entry;
    const char *command = json_string_value(json_object_get(batch->record, "command"));
    const json_int_t shards = json_integer_value(json_object_get(batch->record, "shards"));
    size_t i;
    if (json_integer_value(json_object_get(batch->record, "format")) != 1)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected \"format\": 1", path);
    if (!command || strlen(command) >= sizeof batch->command)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected the name of a \"command\"", path);
    if (shards < 1 || shards > BATCH_MOST_SHARDS)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected 1 to %d \"shards\"", path, BATCH_MOST_SHARDS);
    if (!json_is_array(jobs)) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a list of \"jobs\"", path);
    snprintf(batch->command, sizeof batch->command, "%s", command);
    if (!make_shards(batch, (size_t)shards, err)) return false;
    json_array_foreach(jobs, i, entry) if (!read_job(batch, entry)) return glint_fail(
        err, GLINT_ERROR_FORMAT, "%s: job %zu: expected its number and \"shards\" from 1 to %lld, or \"merge\"", path,
        i + 1, (long long)shards);
    return true;
}

/* The number of shards that the names of their folders, K-of-N, say. */
static bool count_folders(struct batch *batch, struct glint_error *err) {
    char path[4096];
    unsigned found = 0;
    struct shard shard;
    if (!batch_path(batch, "shards", path, err)) return false;
    DIR *dir = opendir(path);
    bool same = true;
    for (const struct dirent *entry; dir && same && (entry = readdir(dir)) != NULL;) {
        if (!shard_of_name(entry->d_name, &shard) || shard.count > BATCH_MOST_SHARDS) continue;
        same = !found || found == shard.count;
        if (same) found = shard.count;
        else
            glint_fail(err, GLINT_ERROR_FORMAT, "%s: has shards of %u and shards of %u; expected one set", path,
                       shard.count, found);
    }
    if (dir) closedir(dir);
    if (!found)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: expected a folder of glint batch, or one with shards; found no " RECORD
                          " and no shards/K-of-N",
                          batch->folder);
    return same && make_shards(batch, found, err);
}

bool batch_open(struct batch *batch, const char *folder, bool locked, struct glint_error *err) {
    char path[4096];
    *batch = (struct batch){.folder = folder};
    if (!batch_path(batch, RECORD, path, err)) return false;
    const bool recorded = access(path, F_OK) == 0;
    if (!recorded && locked)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected the folder of a batch, found no " RECORD, folder);
    return (!locked || lock(batch, err)) && (recorded ? read_record(batch, path, err) : count_folders(batch, err)) &&
           batch_read_shards(batch, err);
}

void batch_finish(struct batch *batch) {
    glint_folder_unlock(&batch->lock);
    json_decref(batch->record);
    free(batch->shards);
}
