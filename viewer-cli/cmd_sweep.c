/* glint sweep: measures accuracy against time over ranges of parameters and variants. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "options/pipeline_args.h"
#include "sweep/sweep.h"
#include "io/console.h"
#include "io/output.h"

struct arguments {
    struct sweep sweep;
    struct pipeline_args pipeline;
    struct list axes;
    const char *sample, *metric;
    uint32_t hypercube, seed;
    bool json;
    char folder[4096]; /* of a shard */
};

enum { KEY_VARY = 256, KEY_SAMPLE, KEY_SEED, KEY_REPEAT, KEY_WHOLE, KEY_METRIC, KEY_NO_PICTURES };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",    'o',           "FOLDER",        0, "Folder for all results; an interrupted sweep resumes from it", 0},
    {"vary",      KEY_VARY,      "NAMES=VALUES",  0, "What to vary: SLOT.PARAM=A..B[:STEP|:log|:logN], SLOT.PARAM=A,B,C or SLOT=VARIANT,VARIANT; names joined by + take the "
        "same value. Several --vary make a grid", 0},
    {"sample",    KEY_SAMPLE,    "lhs:N",         0, "Sample N points with a Latin hypercube instead of a full grid", 0},
    {"seed",      KEY_SEED,      "N",             0, "Seed of --sample (default 1)", 0},
    {"repeat",    KEY_REPEAT,    "N",             0, "Timed rounds; every round runs each point once (default 3; 0: no times)", 0},
    {"whole",     KEY_WHOLE,     NULL,            0, "Run all passes of each point in every round, instead of sharing the passes that points have in common", 0},
    SHARD_OPTION,
    EFFECT_OPTION,
    {"reference", KEY_REFERENCE, "RUN|truth",     0, "Errors are measured against this: the run of glint reference (once for each capture), or the truth in the capture "
        "(default: a reference is traced once and kept in the folder)", 0},
    TRACED_OPTIONS,
    {"metric",    KEY_METRIC,    "NAME",          0, "Error metric of the Pareto fronts (default rmse), one of ", 0},
    {"no-pictures", KEY_NO_PICTURES, NULL,        0, "Do not write pictures", 0},
    WHOLE_PIPELINE_OPTIONS("The pipeline that is varied"),
    {"json",      'j',           NULL,            0, "Print JSON, as in FOLDER/points.json", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint sweep street.exr -o steps --vary screen_trace.cells=8..512:log",
     "varies one parameter from 8 to 512 in powers of two"},
    {"glint sweep street.exr room.exr -o both --vary screen_trace=linear,hiz,dda",
     "compares variants on two captures: mean and worst case"},
    {"glint sweep street.exr -o grid --vary cubemap_trace.steps_hq=8..64:8 --vary cubemap_trace.refinements=1..6",
     "makes a grid of two parameters"},
    {"glint sweep street.exr -o tied --vary cubemap_trace.steps_hq+cubemap_trace.steps_lq=4..128:log9",
     "varies two parameters together"},
    {"glint sweep street.exr -o many --sample lhs:100 --vary temporal.history=0..32 --vary downsample.share=0.2..1",
     "samples both ranges evenly with a hundred points"},
    {"glint sweep street.exr -o free --repeat 0 --vary screen_trace.steps=4..128:log -p kf2",
     "skips timing: fetches per pixel are the same on every device"},
    {"glint reference street.exr -o ref --rays 256", "makes a better reference, for --reference ref"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(KEY_METRIC, struct arguments, metric),
    STORED_CAPTURES(struct arguments, sweep.captures),
    STORED('o', struct arguments, sweep.out),
    STORED('j', struct arguments, json),
    STORED(KEY_VARY, struct arguments, axes),
    STORED_NUMBER(KEY_SEED, struct arguments, seed, 0, UINT32_MAX),
    STORED_NUMBER(KEY_REPEAT, struct arguments, sweep.rounds, 0, 100000),
    STORED(KEY_WHOLE, struct arguments, sweep.whole),
    PIPELINE_TARGETS(struct arguments, pipeline),
    {0},
};

static char *cmd_sweep_values(int key) {
    const char *names[GLINT_METRIC_COUNT + 1] = {NULL};
    for (size_t m = 0; m < GLINT_METRIC_COUNT; m++) names[m] = glint_metric(m)->name;
    return key == KEY_METRIC ? join_names("", names) : NULL;
}

static void parse_sample(struct arguments *a, char *text, struct argp_state *state) {
    if (strncmp(text, "lhs:", 4) != 0 || !isdigit((unsigned char)text[4]))
        argp_error(state, "--sample %s: expected lhs:N, such as lhs:100", text);
    else a->hypercube = arg_uint("sample", text + 4, 1, 100000, state);
    a->sample = text;
}

static error_t cmd_sweep_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case KEY_SAMPLE:
        parse_sample(a, arg, state);
        return 0;
    case KEY_SHARD:
        shard_parse(&a->sweep.shard, arg, state);
        return 0;
    case KEY_NO_PICTURES:
        a->sweep.pictures = false;
        return 0;
    case ARGP_KEY_END:
        if (!a->sweep.out) argp_error(state, "no output folder given: -o FOLDER");
        if (!a->axes.count) argp_error(state, "nothing to vary: --vary SLOT.PARAM=A..B");
        answer_args_check(&a->sweep.against, a->sweep.captures.count, state);
        return 0;
    }
    return answer_args_parse(key, arg, state, &a->sweep.against);
}

/* The order in which the slots run. */
static bool sort_points(struct sweep *sweep, struct glint_error *err) {
    struct glint_capture *capture = NULL;
    for (size_t c = 0; c < sweep->captures.count && !capture; c++)
        capture = glint_capture_open(sweep->captures.items[c], NULL, err);
    struct glint_replay *replay = capture ? glint_replay_create(NULL, err) : NULL;
    const struct glint_plan_entry *entries;
    size_t count = 0;
    bool ok = replay && glint_replay_load(replay, capture, err) &&
              glint_replay_plan(replay, sweep->base, NULL, &entries, &count, err);
    const char **slots = ok ? calloc(count + 1, sizeof *slots) : NULL;
    for (size_t i = 0; slots && i < count; i++) slots[i] = entries[i].pass->slot;
    if (ok)
        ok = slots ? glint_space_sort(sweep->space, slots, err) : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    free(slots);
    if (replay) glint_replay_destroy(&replay);
    if (capture) glint_capture_close(&capture);
    return ok;
}

static bool begin_sweep(struct arguments *a, struct glint_error *err) {
    struct sweep *sweep = &a->sweep;
    sweep->all = a->pipeline.replay.all;
    if (!answer_args_metric(a->metric, &sweep->metric, err)) return false;
    sweep->metrics = GLINT_METRICS_CHEAP | 1u << sweep->metric;
    const char *fogged = sweep->against.truth ? captures_fogged(&sweep->captures) : NULL;
    a->pipeline.without_fog = fogged != NULL;
    if (!(sweep->base = pipeline_args_create(&a->pipeline, err))) return false;
    pipeline_note_fog(&cmd_sweep, sweep->base, fogged);
    if (!answer_args_effect(&sweep->against, &cmd_sweep, sweep->base, &sweep->captures, err)) return false;
    sweep->space = a->hypercube ? glint_space_create_hypercube(sweep->base, a->axes.items, a->hypercube, a->seed, err)
                                : glint_space_create(sweep->base, a->axes.items, err);
    char sample[64] = "grid";
    if (a->hypercube) snprintf(sample, sizeof sample, "lhs:%u seed %u", a->hypercube, a->seed);
    sweep->points = sweep->space ? glint_space_count(sweep->space) : 0;
    return sweep->space && sort_points(sweep, err) && sweep_cut(sweep, err) &&
           (sweep->device = pipeline_args_device(&a->pipeline, err)) &&
           sweep_open(sweep, a->axes.items, sample, &a->pipeline.shader, err);
}

static bool write_table(const struct sweep *sweep, const char *name, struct glint_error *err) {
    char path[4096];
    struct output output;
    if (!sweep_path(sweep, name, path, err) || !output_open(&output, path, err)) return false;
    if (!strcmp(name, "points.csv")) sweep_write_csv(output.file, sweep);
    else sweep_write_json(output.file, sweep, 1);
    const bool whole = sweep->fault.code == GLINT_OK;
    if (!whole) *err = sweep->fault;
    return output_close(&output, whole, err);
}

/* Points that failed, and figures that are none. */
static enum status report_failures(const struct sweep *sweep) {
    enum status status = STATUS_DONE;
    for (size_t c = 0; c < sweep->captures.count; c++) {
        if (!sweep_broken(sweep, c)) continue;
        char *failure = sweep_failure(sweep, c, 0);
        command_note(&cmd_sweep, "left out: %s", failure ? failure : "");
        free(failure);
        status = STATUS_CHECK;
    }
    for (size_t i = 0; i < sweep->captures.count * sweep->points; i++) {
        const size_t c = i / sweep->points, p = i % sweep->points;
        const double invalid = sweep->rows[i].invalid;
        if (sweep_broken(sweep, c) || (sweep->rows[i].state != SWEEP_FAILED && !(invalid > 0))) continue;
        char *point = sweep_point_text(sweep, p), *failed = sweep_failure(sweep, c, p);
        const char *capture = sweep->captures.items[c];
        if (failed) command_note(&cmd_sweep, "%s: %s: %s", capture, point, failed);
        else command_note(&cmd_sweep, "%s: %s: NaN or infinite in %.0f pixels", capture, point, invalid);
        free(point);
        free(failed);
        status = STATUS_CHECK;
    }
    return status;
}

static void note_kept(const struct sweep *sweep) {
    char text[512];
    journal_describe_kept(&sweep->journal, "results", text);
    command_note(&cmd_sweep, "%s", text);
}

/* What one of several processes does: its part of the results, without what is made of all. */
static bool run_shard(struct sweep *sweep, int argc, char **argv, struct glint_error *err) {
    struct shard_record record = {.shard = sweep->shard,
                                  .folder = sweep->out,
                                  .results = (sweep->end - sweep->begin) * (1 + (size_t)sweep->rounds),
                                  .argc = argc,
                                  .argv = argv};
    return shard_begin(&record, err) && sweep_run(sweep, err) && shard_write(&record, true, err);
}

static bool run_whole(struct sweep *sweep, struct glint_error *err) {
    return sweep_run(sweep, err) && sweep_sum_up(sweep, err) && write_table(sweep, "points.json", err) &&
           write_table(sweep, "points.csv", err) && sweep_draw_fronts(sweep, err) && sweep_write_page(sweep, err);
}

static enum status report_shard(const struct arguments *a) {
    const struct sweep *sweep = &a->sweep;
    const size_t rows = sweep->end - sweep->begin, all = sweep->captures.count * sweep->points;
    if (a->json)
        return print_json(json_pack("{s:I, s:I, s:I, s:I, s:s}", "shard", (json_int_t)sweep->shard.number, "of",
                                    (json_int_t)sweep->shard.count, "points", (json_int_t)rows, "of_points",
                                    (json_int_t)all, "folder", sweep->out));
    printf("shard %u of %u: %zu of %zu points on captures are done in %s\n", sweep->shard.number, sweep->shard.count,
           rows, all, name_text(sweep->out));
    return STATUS_DONE;
}

static enum status cmd_sweep_run(int argc, char **argv) {
    struct arguments a = {.sweep = {.rounds = 3, .pictures = true, .metric = GLINT_METRIC_RMSE}, .seed = 1};
    struct glint_error err = {0};
    struct progress progress;
    command_parse(&cmd_sweep, argc, argv, &a);
    struct sweep *sweep = &a.sweep;
    const bool shard = sweep->shard.count > 0;
    progress_begin(&progress);
    sweep->progress = &progress;
    bool ok = !shard || shard_folder(&sweep->shard, sweep->out, a.folder, &err);
    if (ok && shard) sweep->out = a.folder;
    ok = ok && begin_sweep(&a, &err) && (shard ? run_shard(sweep, argc, argv, &err) : run_whole(sweep, &err));
    progress_end(&progress);
    enum status status = ok ? STATUS_DONE : command_fail(&cmd_sweep, &err);
    if (!ok && err.code == GLINT_ERROR_INTERRUPTED) note_kept(sweep);
    missing_note(&cmd_sweep, &sweep->missing, 0);
    if (ok && shard) status = report_shard(&a);
    else if (ok && a.json) {
        console_plain(true);
        sweep_write_json(stdout, sweep, 2);
        putchar('\n');
    } else if (ok) sweep_print(sweep);
    if (ok && status == STATUS_DONE && !shard) status = report_failures(sweep);
    sweep_finish(sweep);
    if (sweep->device) glint_device_destroy(&sweep->device);
    pipeline_args_finish(&a.pipeline);
    list_free(&a.axes);
    return status;
}

const struct command cmd_sweep = {
    .name = "sweep",
    .arguments = "F... -o FOLDER --vary NAMES=VALUES",
    .summary = "measure accuracy against time over ranges of parameters and variants",
    .description =
        "Replays captures with every combination of the values that --vary names, and finds the Pareto-optimal "
        "points: those for which no other point has less error in the same GPU time, or less error with the same "
        "number of texture fetches per pixel, which does not depend on the device. Captures are uploaded once, and "
        "points are ordered so that only passes whose inputs or parameters change are run again. Fog stays as the "
        "preset sets it. The folder contains the page index.html, a chart of each front as SVG, for one numeric "
        "parameter also charts of error and cost against it with the knee (the value beyond which larger "
        "ones reduce the error less), points.csv, "
        "points.json, pictures, and log.jsonl, to which each result is appended as soon as it is known: the same "
        "command resumes an interrupted sweep. Of several captures it has errors of all and of those with each tag, "
        "with "
        "95 % intervals (bootstrap over shots), and of more than ten the worst first, ten of them with pictures. Each "
        "capture is replayed without the history of previous frames. "
        "Times are measured after a warm-up with shaders without diagnostics; passes that several points share are "
        "timed once a round.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_sweep_parse,
    .examples = examples,
    .values = cmd_sweep_values,
    .run = cmd_sweep_run,
};
