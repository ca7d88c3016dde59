/* Shards of a study: equal shares of its work. */
#include "journal/shard.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/capture.h"
#include "io/console.h"
#include "journal/journal.h"
#include "record.h"

/* "K", `between`, "N", and nothing else. */
static bool read_share(const char *text, const char *between, struct shard *shard) {
    int used = 0;
    if (sscanf(text, "%7u%n", &shard->number, &used) != 1 || strncmp(text + used, between, strlen(between)) != 0)
        return false;
    text += (size_t)used + strlen(between);
    return sscanf(text, "%7u%n", &shard->count, &used) == 1 && !text[used] && shard->number &&
           shard->number <= shard->count;
}

bool shard_of_name(const char *name, struct shard *shard) {
    return read_share(name, "-of-", shard);
}

void shard_parse(struct shard *shard, const char *text, struct argp_state *state) {
    *shard = (struct shard){0};
    if (strcmp(text, "whole") != 0 && !read_share(text, "/", shard))
        argp_error(state, "--shard %s: expected K/N, a share from 1 to N of N, such as 3/8", text);
}

bool shard_folder(const struct shard *shard, const char *out, char path[4096], struct glint_error *err) {
    return snprintf(path, 4096, "%s/shards/%u-of-%u", out, shard->number, shard->count) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", out);
}

bool shard_pixels(const char *path, double *pixels, struct glint_error *err) {
    struct glint_error own = {0};
    struct glint_capture *capture = glint_capture_open(path, NULL, &own);
    const struct glint_part_info *part = capture ? glint_capture_find(capture, GLINT_PART_GBUFFER) : NULL;
    *pixels = part ? (double)part->width * part->height : 1;
    glint_capture_close(&capture);
    return own.code != GLINT_ERROR_MEMORY || fail_memory(err);
}

/* The place in the order of all points at which this part of the whole cost is done. */
static size_t place_of(double part, const struct shard_cost *captures, size_t count, size_t points) {
    double whole = 0, before = 0;
    for (size_t c = 0; c < count; c++) whole += captures[c].first + (double)points * captures[c].each;
    for (size_t c = 0; c < count; c++) {
        const double own = captures[c].first + (double)points * captures[c].each, left = part * whole - before;
        before += own;
        if (left >= own) continue;
        /* Who works on the second part of a capture does its first work, too. */
        const double point = (left - captures[c].first) / captures[c].each;
        if (left < 0.5 * own && left < 2 * captures[c].first) return c * points;
        if (own - left < captures[c].first) return (c + 1) * points;
        return c * points + (size_t)fmax(0, round(point));
    }
    return count * points;
}

void shard_cut(const struct shard *shard, const struct shard_cost *captures, size_t count, size_t points, size_t *begin,
               size_t *end) {
    *begin = 0;
    *end = count * points;
    if (!shard->count) return;
    if (shard->number > 1) *begin = place_of((shard->number - 1.) / shard->count, captures, count, points);
    if (shard->number < shard->count) *end = place_of((double)shard->number / shard->count, captures, count, points);
}

static json_t *arguments_json(const struct shard_record *record) {
    json_t *arguments = json_array();
    bool fits = arguments != NULL;
    for (int i = 1; fits && i < record->argc; i++)
        fits = json_array_append_new(arguments, json_string(record->argv[i])) == 0;
    if (fits) return arguments;
    json_decref(arguments);
    return NULL;
}

bool shard_write(const struct shard_record *record, bool done, struct glint_error *err) {
    char path[4096], here[4096];
    if (!getcwd(here, sizeof here))
        return glint_fail(err, GLINT_ERROR_IO, "the working directory: %s", strerror(errno));
    json_t *arguments = arguments_json(record);
    if (!arguments) return glint_fail(err, GLINT_ERROR_USAGE, "out of memory, or an argument that is not UTF-8");
    json_t *json =
        json_pack("{s:i, s:s, s:s, s:I, s:I, s:I, s:I, s:b, s:o, s:s}", "format", 1, "command", record->argv[0],
                  "result", record->result ? record->result : "index.html", "shard", (json_int_t)record->shard.number,
                  "of", (json_int_t)record->shard.count, "results", (json_int_t)record->results, "kept",
                  (json_int_t)record->kept, "done", done, "arguments", arguments, "folder", here);
    char *text = json ? record_text(json, JSON_INDENT(1)) : NULL;
    json_decref(json);
    const bool ok = text ? journal_path(record->folder, "shard.json", path, err) && output_text(path, text, err)
                         : glint_fail(err, GLINT_ERROR_USAGE, "%s: out of memory, or not UTF-8", here);
    free(text);
    return ok;
}

bool shard_begin(struct shard_record *record, struct glint_error *err) {
    struct journal_count count = {0};
    if (!journal_count_lines(record->folder, &count, err)) return false;
    record->kept = count.lines;
    return shard_write(record, false, err);
}

enum status shard_report(const struct shard_record *record, const char *what, size_t all, bool json) {
    const struct shard *shard = &record->shard;
    if (json)
        return print_json(json_pack("{s:I, s:I, s:I, s:I, s:s}", "shard", (json_int_t)shard->number, "of",
                                    (json_int_t)shard->count, "results", (json_int_t)record->results, "of_results",
                                    (json_int_t)all, "folder", record->folder));
    printf("shard %u of %u: %zu of %zu %s are done in %s\n", shard->number, shard->count, record->results, all, what,
           name_text(record->folder));
    return STATUS_DONE;
}
