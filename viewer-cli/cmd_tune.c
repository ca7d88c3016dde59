/* glint tune: the best parameters within a budget. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "io/shell.h"
#include "options/pass_names.h"
#include "options/pipeline_args.h"
#include "tune/overall.h"
#include "tune/tune.h"

struct arguments {
    struct tune tune;
    struct pipeline_args pipeline;
    const char *metric, *budget_ms, *budget_fetches, *error, *cost;
    bool json, overwrite;
    struct shard_record record;
};

enum {
    KEY_BUDGET_MS = 256,
    KEY_BUDGET_FETCHES,
    KEY_ERROR,
    KEY_COST,
    KEY_SLOTS,
    KEY_VARY,
    KEY_HELD_OUT,
    KEY_BASELINE,
    KEY_OVER,
    KEY_TRIES,
    KEY_SEED,
    KEY_ROUNDS,
    KEY_REPEAT,
    KEY_FOLDER,
    KEY_METRIC
};

/* clang-format off */
static const struct argp_option options[] = {
    {"budget-ms", KEY_BUDGET_MS, "T",            0, "Minimize the error within this GPU time per frame; 50% is half the time of the start preset", 0},
    {"budget-fetches", KEY_BUDGET_FETCHES, "N",  0, "Minimize the error within this number of texture fetches of the trace passes per pixel, which does not depend on the "
        "device; 50% is half of the start preset's", 0},
    {"error",     KEY_ERROR,     "E",            0, "Minimize the cost with at most this error; 110% allows a tenth more than the start preset", 0},
    {"cost",      KEY_COST,      "ms|fetches",   0, "Cost that --error minimizes (default ms)", 0},
    {"slots",     KEY_SLOTS,     "SLOT,...",     0, "Count only the time of these slots (default: all per-frame passes)", 0},
    {"vary",      KEY_VARY,      "NAME[=VALUES]", 0, "Parameters to tune: SLOT.PARAM in its declared range, SLOT.PARAM=A..B, SLOT.PARAM=A,B, SLOT=VARIANT,VARIANT, "
        "pipeline.rays=A..B (default: all parameters that can influence the result of the effect)", 0},
    {"output",    'o',           "PRESET.json",  0, "Preset to write, with a record of how it was found; --preset reads it", 0},
    OVERWRITE_OPTION,
    {"folder",    KEY_FOLDER,    "FOLDER",       0, "Folder for evaluations, references and the page (default: PRESET.tune). A search resumes from it, and a search with "
        "another budget and the same start reuses its evaluations", 0},
    {"held-out",  KEY_HELD_OUT,  "F",            0, "Capture on which the result is measured, but not tuned; may be repeated", 0},
    {"baseline",  KEY_BASELINE,  "scale",        0, "Also measure a baseline without a search: all counts of steps, cells, samples, taps and rays of the start, scaled by "
        "the largest factor that meets the limit. The budget becomes the cost of this baseline on each capture, and the search "
        "starts from it. In the end the factor is chosen on each capture so that the baseline costs at least as much as the "
        "tuned preset", 0},
    {"over",      KEY_OVER,      "mean|worst",   0, "With several captures, use the mean error and cost, or the worst ones relative to the baseline (or to the start, "
        "without a baseline) on the same capture (default mean)", 0},
    {"tries",     KEY_TRIES,     "N",            0, "Maximum number of evaluations (default 150, plus 3 for each parameter). If the final timing shows that the times during "
        "the search were off, the search is repeated up to three times with N/4 further evaluations each. With fewer than about "
        "three evaluations for each parameter, groups of parameters are moved together first, and only the most effective ones "
        "one by one", 0},
    {"seed",      KEY_SEED,      "N",            0, "Seed of the restarts of the search (default 1)", 0},
    {"rounds",    KEY_ROUNDS,    "N",            0, "Timed rounds of each evaluation, alternating with the start preset (default 3)", 0},
    {"repeat",    KEY_REPEAT,    "N",            0, "Timed rounds of the final comparison (default 15; 0: no times)", 0},
    SHARD_OPTION,
    EFFECT_OPTION,
    {"reference", KEY_REFERENCE, "RUN|truth",    0, "Errors are measured against this: the run of glint reference (once for each capture, including the held-out ones), or "
        "the truth in the capture (default: a reference is traced once and kept in the folder)", 0},
    TRACED_OPTIONS,
    {"metric",    KEY_METRIC,    "NAME",         0, "Error metric, averaged over the captures (default rmse), one of ", 0},
    WHOLE_PIPELINE_OPTIONS("Preset to start from"),
    {"json",      'j',           NULL,           0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint tune street.exr -o half.json --budget-ms 50%", "minimizes the error in half the time of mafia3"},
    {"glint replay street.exr -p ./half.json", "uses the tuned preset"},
    {"glint tune street.exr -o quarter.json --budget-ms 25% --folder half.tune",
     "tunes for another budget and reuses the evaluations"},
    {"glint tune street.exr room.exr --held-out hotel.exr -o both.json --budget-fetches 40 --baseline scale",
     "tunes on two captures without timing, and compares with a scaled start preset, also on a third capture"},
    {"glint tune street.exr -o march.json --budget-ms 0.1 --slots cubemap_trace --vary cubemap_trace.steps_hq=4..64 "
     "--vary cubemap_trace.refinements",
     "tunes two parameters for the time of one pass"},
    {"glint tune street.exr -o trace.json --budget-ms 50% --vary screen_trace=hiz,linear --vary screen_trace.cells "
     "--vary screen_trace.steps",
     "also chooses between variants, each with its own parameters"},
    {"glint tune street.exr -o cheap.json --error 105%", "minimizes the time while the error grows by at most 5 %"},
    {"glint tune frames/ -o half.json --budget-fetches 50% --shard 1/4; glint merge half.tune",
     "does so with three other processes, --shard 2/4 to 4/4, that share the evaluations; then writes the preset"},
    {"glint report half.tune -o half.html", "writes the result page as a single file"},
    {0},
};

static const struct arg_target targets[] = {
    STORED_NUMBER(KEY_TRIES, struct arguments, tune.tries, 1, 100000),
    STORED_NUMBER(KEY_SEED, struct arguments, tune.seed, 0, UINT32_MAX),
    STORED_NUMBER(KEY_ROUNDS, struct arguments, tune.rounds, 1, 1000),
    STORED_NUMBER(KEY_REPEAT, struct arguments, tune.repeat, 0, 10000),
    STORED(KEY_METRIC, struct arguments, metric),
    STORED(KEY_BUDGET_MS, struct arguments, budget_ms),
    STORED(KEY_BUDGET_FETCHES, struct arguments, budget_fetches),
    STORED(KEY_ERROR, struct arguments, error),
    STORED_NAMES(KEY_SLOTS, struct arguments, tune.slots),
    STORED(KEY_VARY, struct arguments, tune.vary),
    STORED(KEY_HELD_OUT, struct arguments, tune.held_out),
    STORED(KEY_FOLDER, struct arguments, tune.folder),
    STORED_OUTPUT('o', struct arguments, tune.out, OUTPUT_JSON),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED('j', struct arguments, json),
    STORED_CAPTURES(struct arguments, tune.captures),
    PIPELINE_TARGETS(struct arguments, pipeline),
    {0},
};

static char *cmd_tune_values(int key) {
    const char *names[GLINT_METRIC_COUNT + 1] = {NULL};
    size_t n = 0;
    for (size_t m = GLINT_METRIC_RMSE; m < GLINT_METRIC_COUNT; m++)
        if (!glint_metric(m)->higher_is_better) names[n++] = glint_metric(m)->name;
    return key == KEY_METRIC ? join_names("", names) : NULL;
}

/* "0.3" or "50%" */
static void read_limit(struct tune *tune, const char *option, const char *text, struct argp_state *state) {
    char *end;
    const double value = strtod(text, &end);
    tune->part = !strcmp(end, "%");
    tune->limit = tune->part ? value / 100 : value;
    if (end == text || (*end && !tune->part) || !isfinite(value) || !(value > 0))
        argp_error(state,
                   "--%s %s: expected a number above 0, or a percentage of the start preset's value such as 50%%",
                   option, text);
}

static void check_arguments(struct arguments *a, struct argp_state *state) {
    struct tune *tune = &a->tune;
    const size_t all = tune->captures.count + tune->held_out.count;
    if (!!a->budget_ms + !!a->budget_fetches + !!a->error != 1)
        argp_error(state, "expected one of --budget-ms, --budget-fetches and --error");
    if (!tune->out) argp_error(state, "no output file given: -o PRESET.json");
    if (a->cost && !a->error) argp_error(state, "--cost can only be used with --error");
    answer_args_check(&tune->against, all, state);
    tune->by_error = a->error != NULL;
    tune->fetches = a->budget_fetches || (a->cost && !strcmp(a->cost, "fetches"));
    if (tune->fetches && tune->slots.count)
        argp_error(state, "--slots cannot be used with fetches, which are always those of the trace passes");
    if (a->error) read_limit(tune, "error", a->error, state);
    else if (a->budget_ms) read_limit(tune, "budget-ms", a->budget_ms, state);
    else read_limit(tune, "budget-fetches", a->budget_fetches, state);
}

static error_t cmd_tune_parse(int key, char *arg, struct argp_state *state) {
    static const char *const costs[] = {"ms", "fetches", NULL}, *const baselines[] = {"scale", NULL},
                             *const overs[] = {"mean", "worst", NULL};
    struct arguments *a = state->input;
    struct tune *tune = &a->tune;
    switch (key) {
    case KEY_COST:
        arg_choice("cost", arg, costs, state);
        a->cost = arg;
        return 0;
    case KEY_BASELINE:
        tune->baseline = arg_choice("baseline", arg, baselines, state) == 0;
        return 0;
    case KEY_OVER:
        tune->worst = arg_choice("over", arg, overs, state) == 1;
        return 0;
    case KEY_SHARD:
        shard_parse(&tune->shard, arg, state);
        return 0;
    case ARGP_KEY_END:
        check_arguments(a, state);
        return 0;
    }
    return answer_args_parse(key, arg, state, &tune->against);
}

static bool choose_metric(struct arguments *a, struct glint_error *err) {
    if (!answer_args_metric(a->metric, &a->tune.metric, err)) return false;
    if (a->tune.metric == GLINT_METRIC_MEAN || glint_metric(a->tune.metric)->higher_is_better)
        return glint_fail(err, GLINT_ERROR_USAGE, "--metric %s: expected an error, which is better when lower",
                          a->metric);
    return true;
}

/* Writes what there is to do: an equal share of about all evaluations. */
static bool record_shard(struct arguments *a, bool first, struct glint_error *err) {
    const struct tune *tune = &a->tune;
    if (!tune->shard.count) return true;
    a->record.shard = tune->shard;
    a->record.folder = tune->folder;
    a->record.results = (1 + (size_t)tune->tries) * tune->captures.count / tune->shard.count + 1;
    return first ? shard_begin(&a->record, err) : shard_write(&a->record, false, err);
}

static bool begin_tune(struct arguments *a, struct glint_error *err) {
    struct tune *tune = &a->tune;
    tune->all = a->pipeline.replay.all;
    tune->shaders = &a->pipeline.shader;
    for (size_t i = 0; i < tune->slots.count; i++)
        if (!glint_slot_check(tune->slots.items[i], err)) return false;
    const char *fogged = tune->against.truth ? captures_fogged(&tune->captures) : NULL;
    a->pipeline.without_fog = fogged != NULL;
    if (!choose_metric(a, err) || !(tune->base = pipeline_args_create(&a->pipeline, err))) return false;
    pipeline_note_fog(&cmd_tune, tune->base, fogged);
    if (!answer_args_effect(&tune->against, &cmd_tune, tune->base, &tune->captures, err)) return false;
    /* What --vary names is checked before the reference is traced; without it, the axes depend on what ran. */
    const bool named = tune->vary.count > 0;
    if ((named && !tune_make_axes(tune, err)) || !(tune->device = pipeline_args_device(&a->pipeline, err)) ||
        !tune_make_subjects(tune, err) || !tune_open(tune, err) || !record_shard(a, true, err))
        return false;
    if (!tune_shards_open(tune, err) || !tune_begin_captures(tune, err) || (!named && !tune_make_axes(tune, err)) ||
        !tune_check_lines(tune, err))
        return false;
    if (!tune->axis_count)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "none of the parameters that may be tuned changes the %s of these captures",
                          tune->against.effect->noun);
    const uint32_t usual = 150 + 3 * (uint32_t)tune->axis_count;
    if (!tune->tries) tune->tries = usual;
    if (tune->tries < 3 * tune->axis_count)
        command_note(&cmd_tune,
                     "%u tries are few for %zu parameters, and may find little; without --tries it is %u, and --vary "
                     "tunes fewer",
                     tune->tries, tune->axis_count, usual);
    return record_shard(a, false, err);
}

/* An interrupted search writes the best preset so far. */
static enum status report_interrupted_tune(struct tune *tune) {
    struct glint_error err = {0};
    const bool some = tune->found.count && tune->found.feasible && !tune->shard.count;
    if (some && !tune_write_preset(tune, &err)) return command_fail(&cmd_tune, &err);
    char text[512];
    journal_describe_kept(&tune->journal, "evaluations", text);
    command_note(&cmd_tune, "%s%s%s", some ? tune->out : "",
                 some ? " is the best preset so far, without final timing; " : "", text);
    return STATUS_INTERRUPTED;
}

/* A shard's part of the search. The final comparison and what follows need all of it, and times that are measured together (glint merge). */
static bool run_shard(struct arguments *a, struct glint_error *err) {
    struct tune *tune = &a->tune;
    if (!tune_search(tune, err)) return false;
    a->record.results = tune->journal.results;
    return shard_write(&a->record, true, err);
}

static bool search_and_write(struct tune *tune, struct glint_error *err) {
    return tune_search(tune, err) && (tune->found.feasible || tune_fail_least(tune, err)) && tune_choose(tune, err) &&
           tune_confirm(tune, err) && tune_sum_up(tune, err) && tune_write_preset(tune, err) &&
           tune_write_page(tune, err);
}

void tune_finish(struct tune *tune) {
    tune_overall_finish(tune);
    for (size_t i = 0; tune->measured && i < tune->subject_count * TUNE_CONTENDERS; i++)
        glint_metric_table_finish(&tune->measured[i].errors);
    for (size_t s = 0; tune->subjects && s < tune->subject_count; s++) tune_unload_subject(tune, s);
    for (int k = 0; k < TUNE_CONTENDERS; k++)
        if (tune->contenders[k]) glint_pipeline_destroy(&tune->contenders[k]);
    json_decref(tune->provenance);
    for (size_t a = 0; a < tune->axis_count; a++) free(tune->axes[a].texts);
    glint_search_result_finish(&tune->found);
    /* A search that failed before its first result may be tried with other arguments. */
    if (tune->journal.log > 0 && !tune->journal.results && !tune->shard.count)
        journal_remove(tune->folder, tune->journal.kind);
    journal_close(&tune->journal);
    tune_shards_close(tune);
    json_decref(tune->definition);
    json_decref(tune->single);
    json_decref(tune->lines);
    for (size_t s = 0; tune->subjects && s < tune->subject_count; s++) {
        json_decref(tune->subjects[s].slots);
        free(tune->subjects[s].broken);
    }
    free(tune->measured);
    free(tune->subjects);
    free(tune->axes);
    free(tune->scaling);
    free(tune->left);
    if (tune->base) glint_pipeline_destroy(&tune->base);
    if (tune->device) glint_device_destroy(&tune->device);
    answer_args_finish(&tune->against);
    struct list *const lists[] = {&tune->captures, &tune->held_out, &tune->vary, &tune->slots};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) list_free(lists[i]);
}

/* The number of arguments from here on that one process does not have that makes all: a share, or what glint merge adds. */
static int count_of_shards(char **argv) {
    const bool added = !strcmp(argv[0], "--folder") && argv[1] && argv[2] && argv[3] && !strcmp(argv[2], "--shard") &&
                       !strcmp(argv[3], "whole");
    if (added) return 4 + (argv[4] && !strcmp(argv[4], "--json"));
    if (!strcmp(argv[0], "--shard")) return argv[1] ? 2 : 1;
    return !strncmp(argv[0], "--shard=", strlen("--shard="));
}

/* As one process is called that makes all. */
static char *command_line(int argc, char **argv) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs("glint tune", out);
    for (int i = 1; i < argc;) {
        const int skipped = count_of_shards(argv + i);
        i += skipped;
        if (skipped) continue;
        fputc(' ', out);
        shell_word(out, argv[i++]);
    }
    fclose(out);
    return text;
}

/* PRESET.tune, and of a shard its own folder in it. */
static bool find_folders(struct tune *tune, char common[4096], char own[4096], struct glint_error *err) {
    snprintf(common, 4096, "%.*s.tune", (int)(strlen(tune->out) - strlen(".json")), tune->out);
    tune->common = tune->folder ? tune->folder : common;
    tune->folder = tune->shard.count ? own : tune->common;
    return !tune->shard.count || shard_folder(&tune->shard, tune->common, own, err);
}

static enum status report_tune(const struct arguments *a) {
    const struct tune *tune = &a->tune;
    enum status status = STATUS_DONE;
    if (tune->shard.count)
        return shard_report(&a->record, "evaluations", tune->captures.count + json_object_size(tune->single), a->json);
    if (a->json) status = print_json(tune_json(tune));
    else tune_print(tune);
    for (size_t s = 0; s < tune->subject_count; s++) {
        if (!tune->subjects[s].broken) continue;
        command_note(&cmd_tune, "left out: %s", tune->subjects[s].broken);
        status = STATUS_CHECK;
    }
    if (tune->confirmed_within) return status;
    command_note(&cmd_tune, "no evaluated point meets the limit in the final timing; %s contains the nearest one",
                 tune->out);
    return STATUS_CHECK;
}

/* The arguments in the order in which they were given, which parsing changes and the page of the merged result shows; NULL without memory. Owned by `owner`. */
static char **keep_arguments(int argc, char **argv, json_t *owner) {
    char **kept = calloc((size_t)argc + 1, sizeof *kept);
    for (int i = 0; kept && i < argc; i++) {
        json_t *text = json_stringn_nocheck(argv[i], strlen(argv[i]));
        kept[i] = (char *)json_string_value(text);
        if (json_array_append_new(owner, text) == 0) continue;
        free(kept);
        return NULL;
    }
    return kept;
}

static enum status cmd_tune_run(int argc, char **argv) {
    struct arguments a = {.tune = {.metric = GLINT_METRIC_RMSE,
                                   .seed = 1,
                                   .against = {.rays = GLINT_JUDGE_RAYS},
                                   .rounds = 3,
                                   .repeat = 15},
                          .record = {.argc = argc, .result = "page.json"}};
    struct glint_error err = {0};
    struct progress progress;
    struct tune *tune = &a.tune;
    json_t *texts = json_array();
    char common[4096], own[4096], *line = command_line(argc, argv), **kept = keep_arguments(argc, argv, texts);
    command_parse(&cmd_tune, argc, argv, &a);
    tune->command_line = line ? line : "glint tune";
    tune->progress = &progress;
    progress_begin(&progress);
    a.record.argv = kept;
    const bool ok = (kept || fail_memory(&err)) && find_folders(tune, common, own, &err) && begin_tune(&a, &err) &&
                    (tune->shard.count ? run_shard(&a, &err) : search_and_write(tune, &err));
    progress_end(&progress);
    const enum status status = ok                                    ? report_tune(&a)
                               : err.code == GLINT_ERROR_INTERRUPTED ? report_interrupted_tune(tune)
                                                                     : command_fail(&cmd_tune, &err);
    tune_finish(tune);
    pipeline_args_finish(&a.pipeline);
    json_decref(texts);
    free(kept);
    free(line);
    return status;
}

const struct command cmd_tune = {
    .name = "tune",
    .arguments = "F... -o PRESET.json --budget-ms T",
    .summary = "find the best parameters within a budget of time or error",
    .description =
        "Searches the parameters of a preset for the least error within a budget, or for the least cost within an "
        "error limit, and writes the result as a preset. The error is that of the effect's result against the "
        "reference, "
        "averaged over the captures. Parameters that cannot matter are left out and listed with the reason: those of "
        "passes that do not run, of work on cube maps that is not done every frame, of passes after the result, "
        "those that would change the reference, and assumptions that the reference has to make as well. Each "
        "remaining parameter is first moved alone, and those without effect are left out too. A step is an eighth of "
        "the range, or a factor of two in ranges over several decades. With --budget-fetches, the same seed always "
        "gives the same preset. Times are medians of rounds that alternate with the start preset and still have an "
        "error of some per cent; therefore the result is timed again against the start. If it exceeds the budget or "
        "leaves a part of it unused, the search continues with corrected times; the preset is the point with the "
        "least error that meets the budget in the final timing. Every evaluation is stored at once: the same command "
        "resumes an interrupted search, and the preset file then contains the best point so far. With --shard, several "
        "processes run the same search at the same time, and share out the evaluations of each round: any of them may "
        "be "
        "missing, late or killed, and the others go on. glint merge FOLDER then makes the final comparison and the "
        "preset.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_tune_parse,
    .examples = examples,
    .values = cmd_tune_values,
    .rounds = true,
    .run = cmd_tune_run,
};
