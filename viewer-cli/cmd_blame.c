/* glint blame: which slot a frame's error comes from, and what mending it would cost. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blame/blame.h"
#include "options/pass_names.h"
#include "options/pipeline_args.h"

struct arguments {
    struct blame blame;
    struct pipeline_args pipeline;
    const char *metric;
    bool json, progress;
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
    {"output",    'o',           "FOLDER",        0, "Where all results are kept, with a page and charts of what is known so far; an interrupted call goes on from what is there", 0},
    {"metric",    KEY_METRIC,    "NAME",          0, "The error that is shared out (default symmetric): symmetric, relative_mse, rmse, clean_relative_mse, clean_rmse, "
                                                     "flip or hdr_flip", 0},
    {"reference", KEY_REFERENCE, "RUN|truth",     0, "What errors are against: a run of glint reference (one for each capture), or the truth in the capture "
                                                     "(default: a reference traced once, kept in the folder; the truth is reported beside it)", 0},
    {"rays",      KEY_RAYS,      "N",             0, "Rays a pixel of the reference that is traced (default 64)", 0},
    {"player-rays", KEY_PLAYER_RAYS, "N",         0, "Rays a pixel of pipelines whose rays are exchanged (default: those of the preset reference)", 0},
    {"shot",      KEY_SHOT,      NULL,            0, "The captures are frames of a shot, one after the other: the last is blamed, and each pipeline runs those "
                                                     "before it first, so that what remembers frames has a history", 0},
    {"exact",     KEY_EXACT,     "N",             0, "Up to N players all pipelines are run, 2^N at most, and shares are exact (default 8)", 0},
    {"interval",  KEY_INTERVAL,  "PERCENT",       0, "With more players: permutations are drawn until no share's 95 % interval is wider than ± this part "
                                                     "of what is shared out (default 2)", 0},
    {"permutations", KEY_PERMUTATIONS, "N",       0, "At most so many (default 200)", 0},
    {"seed",      KEY_SEED,      "N",             0, "Of the permutations (default 1)", 0},
    {"repeat",    KEY_REPEAT,    "N",             0, "Timed rounds, in turns: each pipeline once a round, when all shares are known and shown (default 3; 0: no times)", 0},
    WHOLE_PIPELINE_OPTIONS("The pipeline"),
    PROGRESS_OPTION,
    {"json",      'j',           NULL,            0, "Print JSON, as in FOLDER/shares.json", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint blame street.exr -o blame", "where the error of mafia3 comes from; blame/index.html shows it"},
    {"glint blame street.exr room.exr -o both -p mafia_de", "another preset on two captures: the mean, and each"},
    {"glint blame street.exr --repeat 0", "no times, nothing kept: the table alone"},
    {"glint blame street.exr --metric relative_mse --reference truth",
     "against the path tracer, what is missing included"},
    {"glint blame --shot street.0001.exr street.0002.exr street.0003.exr",
     "the third frame of a shot, with its history"},
    {"glint blame street.exr -o quick --exact 0 --interval 5", "permutations until shares are known to ± 5 %"},
    {"glint blame street.exr -o blame --interval 1", "the same folder again: only what is new is run"},
    {"glint passes screen_trace", "what the reference of a slot is"},
    {0},
};

extern const struct command cmd_blame;

static void split_shot(struct blame *blame, struct argp_state *state) {
    const struct list all = blame->captures;
    if (all.count < 2) argp_error(state, "--shot: expected the frames before as well");
    blame->captures = (struct list){0};
    list_add(&blame->captures, all.items[all.count - 1], state);
    blame->before = all;
    blame->before.items[--blame->before.count] = NULL;
}

static error_t parse_more(int key, char *arg, struct argp_state *state, struct arguments *a) {
    struct blame *blame = &a->blame;
    switch (key) {
    case KEY_REFERENCE:
    case KEY_RAYS:
        return answer_args_parse(key, arg, state, &blame->against);
    case KEY_SHOT:
        blame->shot = true;
        return 0;
    case KEY_PLAYER_RAYS:
        blame->player_rays = arg_uint("player-rays", arg, 1, 1024, state);
        return 0;
    case ARGP_KEY_ARG:
        list_add(&blame->captures, arg, state);
        return 0;
    case ARGP_KEY_END:
        if (!blame->captures.count) argp_error(state, "which capture?");
        if (blame->shot) split_shot(blame, state);
        answer_args_check(&blame->against, blame->captures.count, state);
        return 0;
    }
    return pipeline_args_parse(key, arg, state, &a->pipeline);
}

static error_t cmd_blame_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    struct glint_shapley_options *shapley = &a->blame.options;
    double percent;
    switch (key) {
    case 'o':
        a->blame.out = arg;
        return 0;
    case 'j':
        a->json = true;
        return 0;
    case KEY_PROGRESS:
        a->progress = true;
        return 0;
    case KEY_METRIC:
        a->metric = arg;
        return 0;
    case KEY_EXACT:
        shapley->exact = arg_uint("exact", arg, 0, GLINT_PLAYERS_MAX, state);
        return 0;
    case KEY_INTERVAL:
        arg_numbers("interval", arg, &percent, 1, state);
        if (!(percent > 0 && percent <= 100))
            argp_error(state, "--interval %s: expected per cent, above 0 and up to 100", arg);
        shapley->interval = 0.01 * percent;
        return 0;
    case KEY_PERMUTATIONS:
        shapley->permutations = arg_uint("permutations", arg, 2, 1000000, state);
        return 0;
    case KEY_SEED:
        shapley->seed = arg_uint("seed", arg, 0, UINT32_MAX, state);
        return 0;
    case KEY_REPEAT:
        a->blame.rounds = arg_uint("repeat", arg, 0, 100000, state);
        return 0;
    }
    return parse_more(key, arg, state, a);
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
    if (!blame->base || !pipeline_fog_off(blame->base, err) || !pipeline_args_apply(&a->pipeline, blame->base, err))
        return false;
    if (!(blame->players = glint_players_create(blame->base, blame->player_rays, err))) return false;
    blame->count = glint_players_count(blame->players);
    return (blame->device = pipeline_args_device(&a->pipeline, err)) && blame_open(blame, &a->pipeline.shader, err);
}

/* Answers as soon as they are known; times take as long again and more. */
static bool work(struct blame *blame, bool json, bool *shown, struct glint_error *err) {
    if (!blame_find_shares(blame, err) || !blame_tell(blame, true, err)) return false;
    progress_end(blame->progress);
    if (!json) blame_print_shares(blame);
    *shown = true;
    if (!blame_find_times(blame, err)) return false;
    blame->complete = true;
    return blame_tell(blame, true, err);
}

/* What is known so far, in the folder and on the screen. */
static void interrupted(struct blame *blame, bool json, bool shown) {
    struct glint_error err = {0};
    if (!blame_tell(blame, true, &err)) command_note(&cmd_blame, "%s", err.message);
    if (!json && !shown && blame_is_known(&blame->captured[0])) blame_print_shares(blame);
    if (!json && shown) blame_print_times(blame);
    if (blame->out)
        command_note(&cmd_blame, "%s keeps what was found; the same command goes on from there", blame->out);
}

static enum status cmd_blame_run(int argc, char **argv) {
    struct arguments a = {.blame = {.metric = GLINT_METRIC_SYMMETRIC,
                                    .rounds = 3,
                                    .options = {.exact = 8, .interval = 0.02, .permutations = 200, .seed = 1}}};
    struct glint_error err = {0};
    struct progress progress;
    bool shown = false;
    command_parse(&cmd_blame, argc, argv, &a);
    struct blame *blame = &a.blame;
    progress_begin(&progress);
    blame->progress = &progress;
    progress.lines = a.progress;
    const bool ok = begin_blame(&a, &err) && work(blame, a.json, &shown, &err);
    progress_end(&progress);
    enum status status = ok ? STATUS_DONE : command_fail(&cmd_blame, &err);
    if (!ok && err.code == GLINT_ERROR_INTERRUPTED && blame->captured) interrupted(blame, a.json, shown);
    if (ok && a.json) status = print_json(blame_json(blame));
    else if (ok) blame_print_times(blame);
    struct glint_device *device = blame->device;
    blame_finish(blame);
    if (device) glint_device_destroy(&device);
    pipeline_args_finish(&a.pipeline);
    return status;
}

const struct command cmd_blame = {
    .name = "blame",
    .arguments = "F... [-o FOLDER]",
    .summary = "which slot the error comes from, and what mending it would cost",
    .description =
        "Exchanges the slots of a pipeline for their references, as the passes declare them, runs what follows anew, "
        "and "
        "finds what each is to blame for. A slot \"removes\" the error that goes when it alone is the reference's, and "
        "\"makes\" the error that comes when it alone is kept and all others are the reference's. Where both differ, "
        "slots interact: a blur mends what few rays leave, and does harm where there are many. The share (Shapley "
        "value) "
        "is the mean of what a slot changes over all orders in which slots can be exchanged one after the other; "
        "shares "
        "add up to the error of the preset less that of the reference. A negative one makes the picture better than it "
        "would be without. Any error can be shared out; symmetric, relative_mse and flip are means over pixels, so "
        "that "
        "shares are, too. Slots that cannot be exchanged alone are one player, and the output says why. Fog is off, "
        "which "
        "the truth lacks. Captures are taken each by itself, without the history of a shot; --shot gives it one.",
    .options = options,
    .parse = cmd_blame_parse,
    .examples = examples,
    .run = cmd_blame_run,
};
