/* What glint batch status shows: a table of the shards, or JSON. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/batch.h"
#include "inside.h"
#include "io/console.h"
#include "io/shell.h"
#include "io/table.h"

size_t batch_choose(const struct batch *batch, bool *chosen) {
    size_t count = 0;
    for (size_t i = 0; i < batch->count; i++) {
        chosen[i] = !batch->shards[i].done && !batch_job_active(&batch->shards[i].job);
        count += chosen[i];
    }
    return count;
}

/* Slurm's word in small letters, or what the journal says. */
static void state_text(const struct batch_job *job, const char *otherwise, char text[BATCH_WORD]) {
    snprintf(text, BATCH_WORD, "%s", job->state[0] ? job->state : otherwise);
    for (char *p = text; *p; p++) *p = *p == '_' ? ' ' : (char)tolower((unsigned char)*p);
}

enum { TASK_TEXT = BATCH_WORD + 24 };
/* "12_3", "" if it was never submitted. */
static const char *task_text(const struct batch_job *job, size_t shard, char text[TASK_TEXT]) {
    snprintf(text, TASK_TEXT, job->job[0] ? "%s_%zu" : "%s", job->job, shard + 1);
    return text;
}

static const char *journal_text(const struct batch_shard *shard) {
    return shard->done ? "done" : shard->begun ? "begun" : "not begun";
}

static double seconds_left(const struct batch_shard *shard) {
    return shard->done                     ? 0
           : shard->total < shard->results ? 0
                                           : (double)(shard->total - shard->results) / shard->per_second;
}

/* Sums over all shards; those that have not begun are taken to be as large as the others. */
struct total {
    size_t results, total, finished;
    double seconds; /* NAN: not known */
};

static struct total sum(const struct batch *batch) {
    struct total total = {.seconds = NAN};
    size_t begun = 0;
    double rate = 0;
    for (size_t i = 0; i < batch->count; i++) {
        const struct batch_shard *shard = &batch->shards[i];
        const bool active = batch->asked ? batch_job_active(&shard->job) && shard->begun : shard->begun;
        total.results += shard->results;
        total.total += shard->done ? shard->results : shard->total;
        total.finished += shard->done;
        begun += shard->begun;
        if (active && !shard->done && isfinite(shard->per_second)) rate += shard->per_second;
    }
    if (begun) total.total = total.total * batch->count / begun;
    if (rate > 0 && total.total >= total.results) total.seconds = (double)(total.total - total.results) / rate;
    return total;
}

static const char *left_text(double seconds, char text[32]) {
    if (!isfinite(seconds)) text[0] = '\0';
    else if (seconds < 90) snprintf(text, 32, "%.0f s", seconds);
    else if (seconds < 5400) snprintf(text, 32, "%.0f min", seconds / 60);
    else snprintf(text, 32, "%.1f h", seconds / 3600);
    return text;
}

/* ---- JSON ---- */

static json_t *optional(const char *text) {
    return text[0] ? json_string(text) : json_null();
}

static json_t *shard_json(const struct batch *batch, size_t i) {
    const struct batch_shard *shard = &batch->shards[i];
    char state[BATCH_WORD], job[TASK_TEXT];
    state_text(&shard->job, journal_text(shard), state);
    return json_pack("{s:I, s:s, s:o, s:o, s:b, s:I, s:o, s:o, s:o}", "shard", (json_int_t)i + 1, "state", state, "job",
                     optional(task_text(&shard->job, i, job)), "reason", optional(shard->job.reason), "done",
                     (int)shard->done, "results", (json_int_t)shard->results, "of",
                     shard->begun ? json_integer((json_int_t)shard->total) : json_null(), "per_second",
                     json_number(shard->per_second), "seconds_left", json_number(seconds_left(shard)));
}

static json_t *merge_json(const struct batch *batch) {
    char state[BATCH_WORD];
    state_text(&batch->merge, "", state);
    return json_pack("{s:o, s:o, s:o, s:b}", "job", optional(batch->merge.job), "state", optional(state), "reason",
                     optional(batch->merge.reason), "done", (int)batch_is_merged(batch));
}

json_t *batch_json(const struct batch *batch) {
    const struct total total = sum(batch);
    json_t *shards = json_array(), *again = json_array();
    bool *chosen = calloc(batch->count, sizeof *chosen);
    if (chosen && batch->asked) batch_choose(batch, chosen);
    for (size_t i = 0; chosen && i < batch->count; i++) {
        json_array_append_new(shards, shard_json(batch, i));
        if (chosen[i]) json_array_append_new(again, json_integer((json_int_t)i + 1));
    }
    json_t *json =
        json_pack("{s:s, s:b, s:I, s:I, s:o, s:o, s:o, s:o}", "command", batch->command, "slurm", (int)batch->asked,
                  "results", (json_int_t)total.results, "shards_done", (json_int_t)total.finished, "seconds_left",
                  json_number(total.seconds), "shards", shards, "missing", again, "merge", merge_json(batch));
    free(chosen);
    return json;
}

/* ---- The table ---- */

static void count_cell(struct table *table, bool known, size_t count) {
    char text[32] = "";
    if (known) snprintf(text, sizeof text, "%zu", count);
    table_cell(table, "%s", text);
}

static void print_rows(const struct batch *batch) {
    char state[BATCH_WORD], left[32], job[TASK_TEXT];
    struct table *table =
        table_create((const char *const[]){">shard", "<state", "<job", ">results", ">of", ">a second", ">left", NULL});
    for (size_t i = 0; i < batch->count; i++) {
        const struct batch_shard *shard = &batch->shards[i];
        const bool active = batch_job_active(&shard->job);
        state_text(&shard->job, journal_text(shard), state);
        table_cell(table, "%zu", i + 1);
        table_cell(table, shard->job.reason[0] ? "%s (%s)" : "%s", state, shard->job.reason);
        table_mark(table, shard->done ? MARK_GOOD : batch->asked && !active ? MARK_FAIL : MARK_NONE);
        table_cell(table, "%s", task_text(&shard->job, i, job));
        count_cell(table, shard->begun, shard->results);
        count_cell(table, shard->begun, shard->total);
        table_cell(table, "%s", isfinite(shard->per_second) ? number_text(shard->per_second) : "");
        table_cell(table, "%s", shard->done || !shard->begun ? "" : left_text(seconds_left(shard), left));
    }
    table_print(table, stdout);
    table_destroy(&table);
}

/* The last line that the shard's job printed, "" if there is none. */
static void last_line(const struct batch *batch, size_t i, char line[256]) {
    enum { MOST = 1 << 26 };
    char name[128], path[4096], *text = NULL;
    line[0] = '\0';
    snprintf(name, sizeof name, BATCH_LOGS "/shard-%zu-%s.txt", i + 1, batch->shards[i].job.job);
    if (batch_path(batch, name, path, NULL)) text = inside_text(path, MOST, NULL);
    if (!text) return;
    size_t end = strlen(text);
    while (end && isspace((unsigned char)text[end - 1])) text[--end] = '\0';
    const char *last = strrchr(text, '\n');
    snprintf(line, 256, "%s", last ? last + 1 : text);
    free(text);
}

/* Why shards failed, of the first of them. */
static void print_reasons(const struct batch *batch, const bool *chosen) {
    enum { MOST_SHOWN = 3 };
    char line[256];
    for (size_t i = 0, shown = 0; i < batch->count && shown < MOST_SHOWN; i++) {
        if (!chosen[i] || !batch->shards[i].job.job[0]) continue;
        last_line(batch, i, line);
        if (line[0]) printf("%zu: %s\n", i + 1, name_text(line));
        shown += line[0] != '\0';
    }
}

static void print_command(const char *shards, const char *text, const char *folder) {
    printf("%s%s", shards, text);
    shell_path(stdout, folder);
    putchar('\n');
}

/* What to type next. */
static void print_next(const struct batch *batch, const struct total *total) {
    bool *chosen = calloc(batch->count, sizeof *chosen);
    const size_t missing = chosen && batch->asked ? batch_choose(batch, chosen) : 0;
    char *list = chosen ? batch_list(chosen, batch->count) : NULL, state[BATCH_WORD];
    const bool merged = batch_is_merged(batch), all = total->finished == batch->count;
    state_text(&batch->merge, "", state);
    if (missing) print_reasons(batch, chosen);
    if (missing && list) print_command(list, ": not done, and not in the queue: glint batch resubmit ", batch->folder);
    if (merged) print_command("", "merged: ", batch->folder);
    else if (batch->merge.state[0]) printf("the merge, job %s, is %s\n", batch->merge.job, state);
    else if (all) print_command("", "all shards are done, but not merged: glint merge ", batch->folder);
    free(list);
    free(chosen);
}

void batch_print(const struct batch *batch) {
    const struct total total = sum(batch);
    char left[32];
    print_rows(batch);
    printf("%zu results, %zu of %zu shards done%s%s\n", total.results, total.finished, batch->count,
           isfinite(total.seconds) ? ", about " : "", isfinite(total.seconds) ? left_text(total.seconds, left) : "");
    print_next(batch, &total);
}
