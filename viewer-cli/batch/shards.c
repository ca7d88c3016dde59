/* How far the shards are, by what they leave in their folders (the code of shards is journal/'s). */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "batch/batch.h"
#include "inside.h"
#include "io/output.h"
#include "journal/journal.h"

/* Whole lines of a file that may be cut in its last one, or be none yet; and when it was written last. */
static bool count_lines(const char *path, size_t *lines, double *written, struct glint_error *err) {
    enum { PIECE = 1 << 16 };
    char piece[PIECE];
    struct stat info;
    glint_file file;
    uint64_t bytes;
    size_t got = 0;
    *lines = 0;
    *written = NAN;
    if (access(path, F_OK) != 0) return true;
    if (!inside_open(&file, path, UINT64_MAX, &bytes, err)) return false;
    for (uint64_t at = 0; at < bytes; at += got) {
        if (!glint_file_read(file, piece, PIECE, at, &got)) break;
        if (!got) break;
        for (size_t i = 0; i < got; i++) *lines += piece[i] == '\n';
    }
    if (stat(path, &info) == 0) *written = (double)info.st_mtim.tv_sec + (double)info.st_mtim.tv_nsec * 1e-9;
    glint_file_close(file);
    return true;
}

/* shard.json is written when the shard is started. */
static bool read_shard(struct batch *batch, size_t i, struct glint_error *err) {
    struct batch_shard *shard = &batch->shards[i];
    char folder[64], name[128], path[4096];
    struct stat info;
    double written;
    shard->per_second = NAN;
    snprintf(folder, sizeof folder, "shards/%zu-of-%zu", i + 1, batch->count);
    snprintf(name, sizeof name, "%s/shard.json", folder);
    if (!batch_path(batch, name, path, err)) return false;
    if (stat(path, &info) != 0) return true;
    json_t *json = json_inside(path, err);
    if (!json) return false;
    const json_int_t results = json_integer_value(json_object_get(json, "results"));
    const json_int_t kept = json_integer_value(json_object_get(json, "kept"));
    const char *command = json_string_value(json_object_get(json, "command"));
    if (!batch->command[0] && command) snprintf(batch->command, sizeof batch->command, "%s", command);
    json_decref(json);
    if (results < 1) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected the number of \"results\"", path);
    shard->begun = true;
    shard->results = (size_t)results;
    snprintf(name, sizeof name, "%s/log.jsonl", folder);
    if (!batch_path(batch, name, path, err) || !count_lines(path, &shard->done, &written, err)) return false;
    const double seconds = written - ((double)info.st_mtim.tv_sec + (double)info.st_mtim.tv_nsec * 1e-9);
    if (seconds > 0 && shard->done > (size_t)kept) shard->per_second = (double)(shard->done - (size_t)kept) / seconds;
    return true;
}

bool batch_read_shards(struct batch *batch, struct glint_error *err) {
    for (size_t i = 0; i < batch->count; i++)
        if (!read_shard(batch, i, err)) return false;
    return true;
}

bool batch_is_merged(const struct batch *batch) {
    char path[4096];
    return batch_path(batch, "index.html", path, NULL) && access(path, F_OK) == 0;
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
