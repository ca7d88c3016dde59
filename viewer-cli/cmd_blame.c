/* glint blame: attributes the error of a frame to the slots of the pipeline. */
#include <math.h>
#include <stdlib.h>

#include "command.h"
#include "io/console.h"
#include "blame/blame.h"
#include "options/pass_names.h"
#include "options/pipeline_args.h"

struct arguments {
    struct blame blame;
    struct pipeline_args pipeline;
    const char *metric;
    bool json, progress;
    char folder[4096]; /* of a shard */
};

enum {
    KEY_SEED = 256,
    KEY_REPEAT,
    KEY_PLAYER_RAYS,
    KEY_METRIC,
    KEY_SHOT,
    KEY_EXACT,
    KEY_INTERVAL,
    KEY_PERMUTATIONS,
    KEY_PROGRESS
};

/* clang-format off */
static const struct argp_option options[] = {
    {"output",    'o',           "FOLDER",        0, "Folder for all results, with a page and charts that are updated during the work; an interrupted call resumes from it", 0},
    {"metric",    KEY_METRIC,    "NAME",          0, "Error metric that is attributed to the slots (default symmetric): symmetric, relative_mse, rmse, clean_relative_mse, "
        "clean_rmse, flip or hdr_flip", 0},
    EFFECT_OPTION,
    {"reference", KEY_REFERENCE, "RUN|truth",     0, "Errors are measured against this: the run of glint reference (once for each capture), or the truth in the capture "
        "(default: a reference is traced once and kept in the folder; the error against the truth is reported too)", 0},
    TRACED_OPTIONS,
    {"player-rays", KEY_PLAYER_RAYS, "N",         0, "Rays per pixel in pipelines in which the ray count is replaced by that of the reference (default: that of the preset "
        "reference)", 0},
    {"shot",      KEY_SHOT,      NULL,            0, "The captures are consecutive frames: the error of the last one is attributed, and every pipeline runs the others first, "
        "so that temporal passes have a history", 0},
    {"exact",     KEY_EXACT,     "N",             0, "With up to N players, run all 2^N pipelines and compute exact shares (default 8)", 0},
    {"interval",  KEY_INTERVAL,  "PERCENT",       0, "With more players, draw random permutations until the 95 % interval of every share is narrower than ± this percentage "
        "of the attributed error (default 2)", 0},
    {"permutations", KEY_PERMUTATIONS, "N",       0, "Draw at most N permutations (default 200)", 0},
    {"seed",      KEY_SEED,      "N",             0, "Seed of the permutations (default 1)", 0},
    {"repeat",    KEY_REPEAT,    "N",             0, "Timed rounds after the shares are known; every round runs each pipeline once (default 3; 0: no times)", 0},
    SHARD_OPTION,
    WHOLE_PIPELINE_OPTIONS("The pipeline"),
    PROGRESS_OPTION,
    {"json",      'j',           NULL,            0, "Print JSON, as in FOLDER/shares.json", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint blame street.exr -o blame", "attributes the error of mafia3; see blame/index.html"},
    {"glint blame street.exr room.exr -o both -p mafia_de",
     "analyses another preset on two captures: each, and the mean"},
    {"glint blame street.exr --repeat 0", "prints only the table, without times"},
    {"glint blame street.exr --metric relative_mse --reference truth",
     "uses the path-traced truth, which includes what the capture does not contain"},
    {"glint blame --shot street.0001.exr street.0002.exr street.0003.exr",
     "analyses the third frame of a shot, with its history"},
    {"glint blame street.exr -o quick --exact 0 --interval 5",
     "draws permutations until the shares are known to ± 5 %"},
    {"glint blame street.exr -o blame --interval 1",
     "refines the results in the folder; known pipelines are not run again"},
    {"glint blame shots/ -o blame --shard 3/8", "does the third of eight shares, in blame/shards/3-of-8"},
    {"glint passes screen_trace", "shows the reference of a slot"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(KEY_SHOT, struct arguments, blame.shot),
    STORED_NUMBER(KEY_PLAYER_RAYS, struct arguments, blame.player_rays, 1, 1024),
    STORED_CAPTURES(struct arguments, blame.captures),
    STORED('o', struct arguments, blame.out),
    STORED('j', struct arguments, json),
    STORED(KEY_PROGRESS, struct arguments, progress),
    STORED(KEY_METRIC, struct arguments, metric),
    STORED_NUMBER(KEY_EXACT, struct arguments, blame.options.exact, 0, GLINT_PLAYERS_MAX),
    STORED_NUMBER(KEY_PERMUTATIONS, struct arguments, blame.options.permutations, 2, 1000000),
    STORED_NUMBER(KEY_SEED, struct arguments, blame.options.seed, 0, UINT32_MAX),
    STORED_NUMBER(KEY_REPEAT, struct arguments, blame.rounds, 0, 100000),
    PIPELINE_TARGETS(struct arguments, pipeline),
    {0},
};

static void split_shot(struct blame *blame, struct argp_state *state) {
    const struct list all = blame->captures;
    if (all.count < 2) argp_error(state, "--shot: expected at least two frames");
    blame->captures = (struct list){0};
    list_add(&blame->captures, all.items[all.count - 1], state);
    blame->before = all;
    blame->before.items[--blame->before.count] = NULL;
}

static error_t cmd_blame_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    struct blame *blame = &a->blame;
    double percent;
    switch (key) {
    case KEY_INTERVAL:
        arg_numbers("interval", arg, &percent, 1, state);
        if (!(percent > 0 && percent <= 100))
            argp_error(state, "--interval %s: expected a percentage above 0 and up to 100", arg);
        blame->options.interval = 0.01 * percent;
        return 0;
    case KEY_SHARD:
        shard_parse(&blame->shard, arg, state);
        return 0;
    case ARGP_KEY_END:
        if (blame->shot) split_shot(blame, state);
        if (blame->shard.count && !blame->out) argp_error(state, "--shard: no output folder given: -o FOLDER");
        answer_args_check(&blame->against, blame->captures.count, state);
        return 0;
    }
    return answer_args_parse(key, arg, state, &blame->against);
}

static bool choose_metric(struct arguments *a, struct glint_error *err) {
    if (!answer_args_metric(a->metric, &a->blame.metric, err)) return false;
    if (a->blame.metric == GLINT_METRIC_MEAN || glint_metric(a->blame.metric)->higher_is_better)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "--metric %s: expected an error, 0 for equal images, such as symmetric or relative_mse",
                          a->metric);
    a->blame.metrics = GLINT_METRICS_CHEAP | 1u << a->blame.metric;
    return true;
}

static bool begin_blame(struct arguments *a, struct glint_error *err) {
    struct blame *blame = &a->blame;
    blame->all = a->pipeline.replay.all;
    if (!choose_metric(a, err)) return false;
    blame->base = glint_pipeline_create(a->pipeline.preset ? a->pipeline.preset : "mafia3", err);
    const char *fogged = captures_fogged(&blame->captures);
    a->pipeline.without_fog = fogged != NULL; /* of all answers, so that shares of different ones can be compared */
    if (!blame->base || !pipeline_args_apply(&a->pipeline, blame->base, err)) return false;
    pipeline_note_fog(&cmd_blame, blame->base, fogged);
    if (!answer_args_effect(&blame->against, &cmd_blame, blame->base, &blame->captures, err) ||
        !(blame->players = glint_players_create(blame->base, blame->against.effect, blame->player_rays, err)))
        return false;
    blame->count = glint_players_count(blame->players);
    return (blame->device = pipeline_args_device(&a->pipeline, err)) && blame_open(blame, &a->pipeline.shader, err);
}

/* Prints the shares as soon as they are known, because times take at least as long again. */
static bool attribute_error(struct blame *blame, bool json, bool *shown, struct glint_error *err) {
    if (!blame_find_shares(blame, err) || !blame_sum_up(blame, err) || !blame_draw(blame, err)) return false;
    if (blame->rounds && !blame_publish(blame, true, err)) return false;
    progress_end(blame->progress);
    if (!json) blame_print_shares(blame);
    *shown = true;
    if (!blame_find_times(blame, err)) return false;
    blame->complete = true;
    return blame_publish(blame, true, err);
}

/* What one of several processes does: its part of the results, without what is made of all. */
static enum status run_shard(struct blame *blame, const struct arguments *a, int argc, char **argv,
                             struct glint_error *err) {
    size_t all;
    struct shard_record record = {.shard = blame->shard,
                                  .folder = blame->out,
                                  .results = blame_expected(blame, &all),
                                  .argc = argc,
                                  .argv = argv};
    const bool ok = shard_begin(&record, err) && blame_find_shares(blame, err) && blame_find_times(blame, err) &&
                    shard_write(&record, true, err);
    progress_end(blame->progress);
    return ok ? shard_report(&record, "results", all, a->json) : command_fail(&cmd_blame, err);
}

/* Captures without results. */
static enum status report_failures(const struct blame *blame) {
    enum status status = STATUS_DONE;
    for (size_t c = 0; c < blame->captures.count; c++) {
        char *failure = blame_failure(blame, c);
        if (!failure) continue;
        command_note(&cmd_blame, "left out: %s", failure);
        free(failure);
        status = STATUS_CHECK;
    }
    return status;
}

/* Writes and prints the results so far. */
static void report_interrupted_blame(struct blame *blame, bool json, bool shown) {
    struct glint_error err = {0};
    if (!blame_publish(blame, true, &err)) command_note(&cmd_blame, "%s", err.message);
    if (!json && !shown && blame_is_known(&blame->mean)) blame_print_shares(blame);
    if (!json && shown) blame_print_times(blame);
    if (!blame->out) return;
    char text[512];
    journal_describe_kept(&blame->journal, "results", text);
    command_note(&cmd_blame, "%s", text);
}

static enum status run_whole(struct blame *blame, const struct arguments *a, struct glint_error *err) {
    bool shown = false;
    const bool ok = attribute_error(blame, a->json, &shown, err);
    progress_end(blame->progress);
    if (!ok) {
        const enum status status = command_fail(&cmd_blame, err);
        if (err->code == GLINT_ERROR_INTERRUPTED) report_interrupted_blame(blame, a->json, shown);
        return status;
    }
    if (a->json) {
        console_plain(true);
        blame_write_json(stdout, blame, 2);
        putchar('\n');
    } else blame_print_times(blame);
    return report_failures(blame);
}

static enum status cmd_blame_run(int argc, char **argv) {
    struct arguments a = {.blame = {.metric = GLINT_METRIC_SYMMETRIC,
                                    .rounds = 3,
                                    .options = {.exact = 8, .interval = 0.02, .permutations = 200, .seed = 1}}};
    struct glint_error err = {0};
    struct progress progress;
    command_parse(&cmd_blame, argc, argv, &a);
    struct blame *blame = &a.blame;
    progress_begin(&progress);
    blame->progress = &progress;
    progress.lines = a.progress;
    bool ok = !blame->shard.count || shard_folder(&blame->shard, blame->out, a.folder, &err);
    if (ok && blame->shard.count) blame->out = a.folder;
    ok = ok && begin_blame(&a, &err);
    enum status status = ok ? STATUS_DONE : command_fail(&cmd_blame, &err);
    if (ok) status = blame->shard.count ? run_shard(blame, &a, argc, argv, &err) : run_whole(blame, &a, &err);
    progress_end(&progress);
    struct glint_device *device = blame->device;
    blame_finish(blame);
    if (device) glint_device_destroy(&device);
    pipeline_args_finish(&a.pipeline);
    return status;
}

const struct command cmd_blame = {
    .name = "blame",
    .arguments = "F... [-o FOLDER]",
    .summary = "attribute the error to the slots, and show what removing it would cost",
    .description =
        "Replaces slots of the pipeline by their references, which the passes declare, runs the following passes "
        "again, and attributes the error to the slots. A slot, or a group of slots that can only be replaced "
        "together, is called a player, as in game theory; the output explains why slots form a group. The column "
        "\"removes\" is the error that disappears when only this player is replaced by its reference; \"makes\" is the "
        "error that appears when only this player is kept and all others are replaced. Where the two differ, players "
        "interact: a blur hides the noise of few rays, but costs sharpness when there are many. The share (Shapley "
        "value) is the mean change of error by a player over all orders in which players can be replaced; shares add "
        "up to the error of the preset minus the error of its reference. A player with a negative share improves the "
        "image. Any metric can be used; symmetric, relative_mse and flip are means over pixels. Fog is off, because "
        "the truth has none. Each capture is replayed without the history of previous frames, except with --shot. Of "
        "several captures the folder and the output have figures of all and of those with each tag, with 95 % "
        "intervals "
        "(bootstrap over shots), and the captures with the largest errors first, ten of them with pictures; one that "
        "cannot be read is left out, and the exit status is then 1.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_blame_parse,
    .examples = examples,
    .run = cmd_blame_run,
};
