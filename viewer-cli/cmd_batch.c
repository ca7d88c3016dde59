/* glint batch: a command in shards, as jobs of Slurm. */
#include "command.h"

#include <stdlib.h>
#include <string.h>

#include "batch/batch.h"
#include "batch/studied.h"
#include "io/shell.h"

struct arguments;
/* What is done to the folder of a batch. */
struct action {
    const char *name;
    enum status (*run)(const struct arguments *a, struct batch *batch, struct glint_error *err);
};

struct arguments {
    const char *out, *partition;
    struct list sbatch, operands;
    uint32_t shards, gpus;
    bool slurm, wait, json;
    const struct command *command; /* that is cut into shards, or NULL */
    const struct action *action;   /* on the folder of a batch, or NULL */
    struct list options;           /* of that command, malloc'd */
    char *folder;                  /* `out`, where it is malloc'd */
};

/* Other than those of the commands whose options are passed on. */
enum { KEY_SLURM = 6144, KEY_SHARDS, KEY_GPUS, KEY_PARTITION, KEY_SBATCH, KEY_NO_SUBMIT };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",        'o',           "FOLDER", 0, "Folder for the job scripts, the shards and the merged results", 0},
    {"slurm",         KEY_SLURM,     NULL,     0, "Submit to Slurm", 0},
    {"shards",        KEY_SHARDS,    "N",      0, "Number of shards, each a task of the job array (default 8)", 0},
    {"gpus-per-task", KEY_GPUS,      "N",      0, "GPUs that each task asks Slurm for (default: none)", 0},
    {"partition",     KEY_PARTITION, "NAME",   0, "Partition that the jobs go to (default: Slurm's)", 0},
    {"sbatch",        KEY_SBATCH,    "OPTION", 0, "A further option of sbatch, such as --sbatch=--time=1:00:00; may be repeated", 0},
    {"no-submit",     KEY_NO_SUBMIT, NULL,     0, "Write the job scripts, but do not submit them: resubmit does, when they have been changed", 0},
    {"json",          'j',           NULL,     0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint batch sweep shots/ -o steps --vary screen_trace.cells=8..512:log --slurm --shards 32 --gpus-per-task 1",
     "submits a sweep as an array of 32 tasks, and a job that merges their results"},
    {"glint batch sweep shots/ -o steps --vary screen_trace.cells=8..512:log --slurm --sbatch=--time=2:00:00 "
     "--sbatch=--account=render",
     "passes options on to sbatch"},
    {"glint batch lint shots/ -o linted --slurm --shards 32", "does so with another command that has --shard"},
    {"glint batch tune shots/ -o half.json --budget-fetches 50% --slurm",
     "tunes a preset, in the folder half.tune; its shards share out each round of evaluations"},
    {"glint batch status steps", "shows the state of each shard, and how far it is"},
    {"glint batch resubmit steps", "submits again what is not done and not in the queue"},
    {"glint batch cancel steps", "takes the jobs out of the queue; what they have done is kept"},
    {0},
};

static const struct arg_target targets[] = {
    STORED('o', struct arguments, out),
    STORED(KEY_SLURM, struct arguments, slurm),
    STORED_NUMBER(KEY_SHARDS, struct arguments, shards, 1, BATCH_MOST_SHARDS),
    STORED_NUMBER(KEY_GPUS, struct arguments, gpus, 1, 1024),
    STORED(KEY_PARTITION, struct arguments, partition),
    STORED(KEY_SBATCH, struct arguments, sbatch),
    STORED(KEY_NO_SUBMIT, struct arguments, wait),
    STORED('j', struct arguments, json),
    STORED(ARGP_KEY_ARG, struct arguments, operands),
    {0},
};

static void check_sbatch(const struct arguments *a, struct argp_state *state) {
    for (size_t i = 0; i < a->sbatch.count; i++) {
        const char *option = a->sbatch.items[i];
        if (option[0] != '-') argp_error(state, "--sbatch %s: expected an option, such as --time=1:00:00", option);
        if (strpbrk(option, "\r\n")) argp_error(state, "--sbatch: a line of a job script has no line breaks");
    }
    if (a->partition && strpbrk(a->partition, "\r\n"))
        argp_error(state, "--partition: a line of a job script has no line breaks");
}

/* Of a command whose --folder names its folder, -o is an option like others. */
static void find_folder(struct arguments *a, struct argp_state *state) {
    static const char given[] = "--folder=";
    char *output = NULL, *folder = NULL;
    const char *dot = strrchr(a->out, '.');
    if (!dot || strcmp(dot, ".json") != 0) argp_error(state, "-o %s: expected NAME.json", a->out);
    for (size_t i = 0; i < a->options.count; i++)
        if (!strncmp(a->options.items[i], given, strlen(given))) folder = strdup(a->options.items[i] + strlen(given));
    if (!folder && asprintf(&folder, "%.*s.%s", (int)(dot - a->out), a->out, a->command->name) < 0) folder = NULL;
    if (!folder || asprintf(&output, "--output=%s", a->out) < 0) argp_failure(state, 1, 0, "out of memory");
    list_add(&a->options, output, state);
    a->out = a->folder = folder;
}

static void check_study(struct arguments *a, struct argp_state *state) {
    if (!a->operands.count) argp_error(state, "no %s given", a->command->operand ? a->command->operand : "capture");
    if (!a->out)
        argp_error(state, "no output %s", a->command->rounds ? "given: -o NAME.json" : "folder given: -o FOLDER");
    if (a->command->rounds) find_folder(a, state);
    if (!a->shards) a->shards = 8;
    if (!a->slurm) argp_error(state, "expected the system that runs the shards: --slurm");
    for (size_t i = 0; i < a->operands.count; i++)
        if (!strcmp(a->operands.items[i], "-")) argp_error(state, "jobs cannot read from stdin, -");
    check_sbatch(a, state);
}

/* Keeps an option of the command as one word. */
static void keep_option(struct arguments *a, int key, const char *value, struct argp_state *state) {
    const struct argp_option *option = command_option(a->command, key);
    char *word = NULL;
    if (!strcmp(option->name, "shard")) argp_error(state, "--shard is what each job gets from its script");
    if (asprintf(&word, "--%s%s%s", option->name, value ? "=" : "", value ? value : "") >= 0)
        list_add(&a->options, word, state);
}

static void check_arguments(struct arguments *a, struct argp_state *state) {
    char *names = a->command || a->action ? NULL : batch_studied_names();
    if (a->command) check_study(a, state);
    else if (!a->action)
        argp_error(state, "expected a command with --shard (%s), or status, resubmit or cancel%s%s", names ? names : "",
                   a->operands.count ? ", found " : "", a->operands.count ? a->operands.items[0] : "");
    else if (a->operands.count != 1) argp_error(state, "expected one folder of a batch");
    else if (a->out || a->slurm || a->shards || a->gpus || a->partition || a->sbatch.count || a->wait)
        argp_error(state, "%s has no option but --json: the others are those of the job scripts", a->action->name);
}

static error_t cmd_batch_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    if (key == ARGP_KEY_END) check_arguments(a, state);
    if (!a->command || key <= ARGP_KEY_ARG || key >= ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    keep_option(a, key, arg, state);
    return 0;
}

/* ---- What is printed ---- */

static void print_hint(const char *action, const char *folder, const char *what) {
    printf("  glint batch %s ", action);
    shell_path(stdout, folder);
    printf("  %s\n", what);
}

static void print_submitted(const struct batch *batch, const bool *chosen) {
    char *list = batch_list(chosen, batch->count);
    size_t first = 0;
    while (first < batch->count && !chosen[first]) first++;
    if (first < batch->count)
        printf("submitted: shards %s of %zu as job %s, and the merge as job %s, which waits for them\n",
               list ? list : "", batch->count, batch->shards[first].job.job, batch->merge.job);
    else printf("submitted: the merge as job %s\n", batch->merge.job);
    free(list);
    print_hint("status", batch->folder, "shows how far they are");
    print_hint("resubmit", batch->folder, "submits again what failed");
    print_hint("cancel", batch->folder, "takes them out of the queue");
}

static enum status tell_submitted(const struct arguments *a, const struct batch *batch, const bool *chosen) {
    if (a->json) return print_json(batch_json(batch));
    print_submitted(batch, chosen);
    return STATUS_DONE;
}

/* ---- What it does ---- */

static enum status run_study(const struct arguments *a, struct batch *batch, struct glint_error *err) {
    const struct batch_script script = {.output = a->out,
                                        .option = a->command->rounds ? "folder" : "output",
                                        .options = a->options.items,
                                        .operands = a->operands.items,
                                        .partition = a->partition,
                                        .gpus = a->gpus,
                                        .sbatch = a->sbatch.items};
    if (!batch_create(batch, a->out, a->command->name, a->shards, err) || !batch_write_scripts(batch, &script, err) ||
        !batch_write(batch, err))
        return command_fail(&cmd_batch, err);
    bool *all = malloc(a->shards * sizeof *all);
    if (!all) return fail_memory(err), command_fail(&cmd_batch, err);
    memset(all, true, a->shards * sizeof *all);
    enum status status = STATUS_DONE;
    if (a->wait && !a->json) print_hint("resubmit", a->out, "submits the job scripts that are there now");
    else if (a->wait) status = print_json(batch_json(batch));
    else if (batch_submit(batch, all, err)) status = tell_submitted(a, batch, all);
    else status = command_fail(&cmd_batch, err);
    free(all);
    return status;
}

static enum status run_status(const struct arguments *a, struct batch *batch, struct glint_error *err) {
    struct glint_error silent = {0};
    if (!batch_open(batch, a->operands.items[0], false, err)) return command_fail(&cmd_batch, err);
    if (!batch_ask(batch, &silent))
        command_note(&cmd_batch, "%s; what follows is from the journals alone", silent.message);
    if (a->json) return print_json(batch_json(batch));
    batch_print(batch);
    return STATUS_DONE;
}

/* A merge that waits for a job that failed never runs. */
static bool replace_merge(struct batch *batch, struct glint_error *err) {
    const char *const jobs[] = {batch->merge.job, NULL};
    return !batch_job_active(&batch->merge) || batch_cancel(batch, jobs, err);
}

static enum status run_resubmit(const struct arguments *a, struct batch *batch, struct glint_error *err) {
    if (!batch_open(batch, a->operands.items[0], true, err) || !batch_ask(batch, err))
        return command_fail(&cmd_batch, err);
    bool *chosen = calloc(batch->count, sizeof *chosen);
    if (!chosen) return fail_memory(err), command_fail(&cmd_batch, err);
    const size_t missing = batch_choose(batch, chosen);
    enum status status = STATUS_DONE;
    if (!missing && (batch_job_active(&batch->merge) || batch_is_merged(batch))) {
        if (a->json) status = print_json(batch_json(batch));
        else
            printf("nothing is missing: %s\n",
                   batch_is_merged(batch) ? "the shards are merged" : "what is not done is in the queue");
    } else if (replace_merge(batch, err) && batch_submit(batch, chosen, err)) status = tell_submitted(a, batch, chosen);
    else status = command_fail(&cmd_batch, err);
    free(chosen);
    return status;
}

static enum status run_cancel(const struct arguments *a, struct batch *batch, struct glint_error *err) {
    if (!batch_open(batch, a->operands.items[0], true, err) || !batch_ask(batch, err))
        return command_fail(&cmd_batch, err);
    const char **jobs = calloc(batch->count + 2, sizeof *jobs);
    size_t count = 0;
    if (!jobs) return fail_memory(err), command_fail(&cmd_batch, err);
    if (batch_job_active(&batch->merge)) jobs[count++] = batch->merge.job;
    for (size_t i = 0; i < batch->count; i++) {
        const struct batch_job *job = &batch->shards[i].job;
        if (batch_job_active(job) && (!count || strcmp(jobs[count - 1], job->job) != 0)) jobs[count++] = job->job;
    }
    const bool ok = !count || batch_cancel(batch, jobs, err);
    if (ok) printf(count ? "taken out of the queue:" : "nothing is in the queue");
    for (size_t i = 0; ok && i < count; i++) printf(" %s", jobs[i]);
    if (ok) putchar('\n');
    free(jobs);
    return ok ? STATUS_DONE : command_fail(&cmd_batch, err);
}

static const struct action actions[] = {{"status", run_status}, {"resubmit", run_resubmit}, {"cancel", run_cancel}};

static enum status cmd_batch_run(int argc, char **argv) {
    struct arguments a = {.command = argc > 1 ? batch_studied(argv[1]) : NULL};
    struct command whole = cmd_batch;
    struct batch batch = {0};
    struct glint_error err = {0};
    if (a.command && !batch_widen(&cmd_batch, a.command, &whole)) {
        fail_memory(&err);
        return command_fail(&cmd_batch, &err);
    }
    for (size_t i = 0; argc > 1 && i < sizeof actions / sizeof *actions; i++)
        if (!strcmp(argv[1], actions[i].name)) a.action = &actions[i];
    const int skipped = a.command || a.action;
    command_parse(&whole, argc - skipped, argv + skipped, &a);
    const enum status status = a.action ? a.action->run(&a, &batch, &err) : run_study(&a, &batch, &err);
    batch_finish(&batch);
    for (size_t i = 0; i < a.options.count; i++) free((char *)a.options.items[i]);
    free(a.folder);
    list_free(&a.options);
    list_free(&a.operands);
    list_free(&a.sbatch);
    if (a.command) free((struct argp_option *)whole.options);
    return status;
}

const struct command cmd_batch = {
    .name = "batch",
    .arguments = "COMMAND|status|resubmit|cancel F...|FOLDER",
    .summary = "run a study in shards, as jobs of Slurm",
    .description =
        "glint batch COMMAND takes the arguments of a command that has --shard, such as sweep, tune, compare, "
        "lint, validate or check, cuts it into shards, and submits them to Slurm "
        "as a job array, and a "
        "job that merges their results and waits for them. FOLDER then contains the job scripts shard.sbatch and "
        "merge.sbatch, which can be changed and submitted by hand, batch.json (the jobs), logs, shards, and after the "
        "merge what one process would "
        "have made there. The folder, the captures and glint must have the same names on all machines. Queueing, "
        "placing, limits and retries are Slurm's.\n\n"
        "glint batch status FOLDER shows the state of each shard in Slurm's words, and by its journal how many "
        "results there are, of how many, at what rate, and the time left; without Slurm, from the journals alone, "
        "whatever started the shards. glint batch resubmit FOLDER submits again what is not done and neither "
        "waiting nor running: a shard goes on where it stopped. glint batch cancel FOLDER takes all jobs out of the "
        "queue.",
    .options = options,
    .targets = targets,
    .parse = cmd_batch_parse,
    .examples = examples,
    .run = cmd_batch_run,
};
