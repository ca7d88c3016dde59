/* How far the shards are, by what they leave in their folders (the code of shards is journal/'s). */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "batch/batch.h"
#include "io/output.h"
#include "journal/journal.h"
#include "journal/shard.h"

/* Whether there is such a file, and when it was written last. */
static bool is_there(const char *path, double *written) {
    struct stat info;
    if (lstat(path, &info) != 0) return false;
    *written = (double)info.st_mtim.tv_sec + (double)info.st_mtim.tv_nsec * 1e-9;
    return true;
}

/* Takes over what shard.json says, which is written when the shard is started, and when it is done. */
static bool take_record(struct batch *batch, struct batch_shard *shard, const char *path, size_t *kept,
                        struct glint_error *err) {
    json_t *json = json_inside(path, err);
    if (!json) return false;
    const json_t *total = json_object_get(json, "results");
    const json_int_t before = json_integer_value(json_object_get(json, "kept"));
    const char *command = json_string_value(json_object_get(json, "command")),
               *result = json_string_value(json_object_get(json, "result"));
    const bool ok = json_is_integer(total) && json_integer_value(total) >= 0 && before >= 0;
    if (result && result[0] != '/' && !strstr(result, ".."))
        snprintf(batch->result, sizeof batch->result, "%s", result);
    shard->total = ok ? (size_t)json_integer_value(total) : 0;
    shard->done = json_is_true(json_object_get(json, "done"));
    *kept = ok ? (size_t)before : 0;
    if (!batch->command[0] && command) snprintf(batch->command, sizeof batch->command, "%s", command);
    json_decref(json);
    return ok || glint_fail(err, GLINT_ERROR_FORMAT,
                            "%s: expected numbers of \"results\" and of those that were \"kept\"", path);
}

static bool read_shard(struct batch *batch, size_t i, struct glint_error *err) {
    struct batch_shard *shard = &batch->shards[i];
    char folder[4096], path[4096];
    const struct shard share = {(uint32_t)i + 1, (uint32_t)batch->count};
    struct journal_count count = {0};
    double started;
    size_t kept;
    shard->per_second = NAN;
    if (!shard_folder(&share, batch->folder, folder, err) || !journal_path(folder, "shard.json", path, err))
        return false;
    if (!(shard->begun = is_there(path, &started))) return true;
    batch->changed = fmax(batch->changed, started);
    if (!take_record(batch, shard, path, &kept, err)) return false;
    if (!journal_count_lines(folder, &count, err)) return false;
    shard->results = count.lines;
    if (!shard->done && count.written > started && shard->results > kept)
        shard->per_second = (double)(shard->results - kept) / (count.written - started);
    return true;
}

bool batch_read_shards(struct batch *batch, struct glint_error *err) {
    for (size_t i = 0; i < batch->count; i++)
        if (!read_shard(batch, i, err)) return false;
    return true;
}

bool batch_is_merged(const struct batch *batch) {
    char path[4096];
    double written;
    bool done = batch->count > 0;
    for (size_t i = 0; i < batch->count; i++) done = done && batch->shards[i].done;
    return done && batch_path(batch, batch->result[0] ? batch->result : "index.html", path, NULL) &&
           is_there(path, &written) && written >= batch->changed;
}

char *batch_list(const bool *chosen, size_t count) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (size_t i = 0; out && i < count; i++) {
        size_t end = i;
        if (!chosen[i]) continue;
        while (end + 1 < count && chosen[end + 1]) end++;
        fprintf(out, "%s%zu", ftell(out) > 0 ? "," : "", i + 1);
        if (end > i) fprintf(out, "-%zu", end + 1);
        i = end;
    }
    if (out) fclose(out);
    return text;
}
