/* What is asked of Slurm: sbatch, squeue, sacct and scancel. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/batch.h"
#include "io/program.h"

/* ---- States ---- */

static const char *const ended[] = {"BOOT_FAIL", "CANCELLED",     "COMPLETED", "DEADLINE", "FAILED",
                                    "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "REVOKED",  "TIMEOUT"};

bool batch_job_active(const struct batch_job *job) {
    bool active = job->state[0] != '\0';
    for (size_t i = 0; i < sizeof ended / sizeof *ended; i++) active = active && strcmp(job->state, ended[i]) != 0;
    return active;
}

static void set_state(struct batch_job *job, const char *state, const char *reason) {
    snprintf(job->state, sizeof job->state, "%.*s", (int)strcspn(state, " +"), state); /* "CANCELLED by 1000" */
    const bool tells = reason && strcmp(reason, "None") != 0;
    snprintf(job->reason, sizeof job->reason, "%.*s", (int)sizeof job->reason - 1, tells ? reason : "");
}

/* Of a task of an array, or of a whole job, whose task is no number. */
static void take_state(struct batch *batch, const char *job, const char *task, const char *state, const char *reason) {
    char *end;
    const unsigned long shard = strtoul(task ? task : "", &end, 10);
    if (!strcmp(job, batch->merge.job)) set_state(&batch->merge, state, reason);
    else if (task && end != task && !*end && shard >= 1 && shard <= batch->count &&
             !strcmp(batch->shards[shard - 1].job.job, job))
        set_state(&batch->shards[shard - 1].job, state, reason);
}

/* Lines "JOB|TASK|STATE|REASON" of squeue, or "JOB_TASK|STATE" of sacct. */
static void take_lines(struct batch *batch, char *text, bool queue) {
    for (char *line; (line = strsep(&text, "\n")) != NULL;) {
        char *job = strsep(&line, queue ? "|" : "_|");
        const bool tasked = queue || (line && strchr(line, '|'));
        char *task = tasked ? strsep(&line, "|") : NULL, *state = strsep(&line, "|"), *reason = queue ? line : NULL;
        if (job && *job && state && *state) take_state(batch, job, task, state, reason);
    }
}

/* "--jobs=12,13", malloc'd: the last job of each shard, and the merge; "" if nothing was submitted. */
static char *job_option(const struct batch *batch) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    const char *before = "";
    for (size_t i = 0; i <= batch->count; i++) {
        const char *job = i < batch->count ? batch->shards[i].job.job : batch->merge.job;
        if (!*job || !strcmp(job, before)) continue;
        fprintf(out, "%s%s", *before ? "," : "--jobs=", job);
        before = job;
    }
    fclose(out);
    return text;
}

static bool knows_all(const struct batch *batch) {
    bool all = batch->merge.state[0] || !batch->merge.job[0];
    for (size_t i = 0; i < batch->count; i++)
        all = all && (batch->shards[i].job.state[0] || !batch->shards[i].job.job[0]);
    return all;
}

bool batch_ask(struct batch *batch, struct glint_error *err) {
    char *jobs = job_option(batch);
    if (!jobs) return fail_memory(err);
    if (!*jobs) return free(jobs), true;
    const char *const queue[] = {"squeue", "--noheader", "--array", "--states=all", "--format=%F|%K|%T|%r", jobs, NULL};
    const char *const accounts[] = {"sacct", "--noheader", "--parsable2", "--allocations", "--format=JobID,State",
                                    jobs,    NULL};
    struct glint_error own = {0};
    char *text = program_run(queue, ".", &own);
    /* What ended some minutes ago is in no queue, and a list of such jobs alone is an error. */
    batch->asked = text || strstr(own.message, "Invalid job id");
    if (!batch->asked) *err = own;
    if (text) take_lines(batch, text, true);
    free(text);
    text = batch->asked && !knows_all(batch) ? program_run(accounts, ".", &own) : NULL; /* where there is accounting */
    if (text) take_lines(batch, text, false);
    free(text);
    free(jobs);
    return batch->asked;
}

/* ---- Submitting ---- */

/* Submits a script, and stores the number of its job. */
static bool submit(const struct batch *batch, const char *option, const char *script, char job[BATCH_WORD],
                   struct glint_error *err) {
    const char *const words[] = {
        "sbatch", "--parsable", "--kill-on-invalid-dep=yes", option ? option : script, option ? script : NULL, NULL};
    char *text = program_run(words, batch->folder, err);
    if (!text) return false;
    const size_t length = strspn(text, "0123456789"); /* the name of a cluster may follow */
    const bool ok = length > 0 && length < BATCH_WORD && strchr(";\n", text[length]);
    snprintf(job, BATCH_WORD, "%.*s", ok ? (int)length : 0, text);
    if (!ok) glint_fail(err, GLINT_ERROR_IO, "sbatch: expected the number of a job, found '%.80s'", text);
    free(text);
    return ok;
}

/* "--dependency=afterok:12:11_3", malloc'd; NULL if there is nothing to wait for, or no memory. */
static char *dependency(const struct batch *batch, const char *array) {
    char *text = NULL;
    size_t size = 0;
    bool any = array[0] != '\0';
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fprintf(out, "--dependency=afterok%s%s", any ? ":" : "", array);
    for (size_t i = 0; i < batch->count; i++) {
        const struct batch_job *job = &batch->shards[i].job;
        if (!batch_job_active(job) || !strcmp(job->job, array)) continue;
        fprintf(out, ":%s_%zu", job->job, i + 1);
        any = true;
    }
    fclose(out);
    if (any) return text;
    free(text);
    return NULL;
}

bool batch_submit(struct batch *batch, const bool *chosen, struct glint_error *err) {
    char array[BATCH_WORD] = "", merge[BATCH_WORD];
    char *list = batch_list(chosen, batch->count), *option = NULL;
    bool ok = list && (!*list || asprintf(&option, "--array=%s", list) > 0);
    if (!ok) fail_memory(err);
    if (ok && *list)
        ok = submit(batch, option, BATCH_SHARD_SCRIPT, array, err) && batch_note_array(batch, array, chosen, err);
    free(option);
    free(list);
    if (!ok) return false;
    option = dependency(batch, array);
    ok = submit(batch, option, BATCH_MERGE_SCRIPT, merge, err) && batch_note_merge(batch, merge, err);
    free(option);
    return ok;
}

bool batch_cancel(const struct batch *batch, const char *const *jobs, struct glint_error *err) {
    size_t count = 0;
    while (jobs[count]) count++;
    const char **words = calloc(count + 2, sizeof *words);
    if (!words) return fail_memory(err);
    words[0] = "scancel";
    memcpy(words + 1, jobs, count * sizeof *words);
    char *text = program_run(words, batch->folder, err);
    free(words);
    free(text);
    return text != NULL;
}
