/* glint diff: whether two images, two runs, or a run and the game's own intermediates are the same. */
#include "diff/options.h"

struct arguments {
    const char *paths[2];
    size_t count;
    struct diff_args diff;
};

static const struct argp_option options[] = {DIFF_OPTIONS, {0}};
static const struct example examples[] = {
    {"glint diff a.exr b.exr", "every part and channel; exit 0 same, 1 warning, 2 failure, 3 other size, 4 unreadable"},
    {"glint diff -fail 0.004 -failpercent 1 a.exr b.exr -o heat.png", "idiff's options, and where they differ"},
    {"glint diff run run2", "which parameters differ, and the first pass that does"},
    {"glint diff run run2 --html diff.html",
     "a page to look at them with: slider, flicker, heat map, values under the pointer"},
    {"glint diff planned all", "a run beside one of --all: whether its plan changed a bit of what both have"},
    {"glint diff run:travelled run2:travelled", "one image of each"},
    {"glint diff run street.exr", "a run against the engine's own intermediates (engine.SLOT.IMAGE)"},
    {"glint diff run run2 --metrics rmse,flip --json", "with figures of docs/metrics.md"},
    {0},
};

extern const struct command cmd_diff;

static error_t cmd_diff_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->count == 2) argp_error(state, "two at a time; %s is the third", arg);
        a->paths[a->count++] = arg;
        return 0;
    case ARGP_KEY_END:
        if (a->count < 2) argp_error(state, "expected two images or runs");
        return 0;
    }
    return diff_args_parse(key, arg, state, &a->diff);
}

static enum status cmd_diff_run(int argc, char **argv) {
    struct arguments a = {.diff = diff_args_default()};
    struct glint_error err = {0};
    struct diff diff;
    command_parse(&cmd_diff, argc, argv, &a);
    const bool ok = diff_args_compare(&a.diff, a.paths, &diff, &err);
    const enum diff_status status = ok ? diff.status : diff_args_fail(&cmd_diff, &err);
    if (ok && a.diff.json) print_json(diff_json(&diff));
    else if (ok && !a.diff.quiet) diff_print(&diff, a.diff.verbose);
    diff_finish(&diff);
    return (enum status)status;
}

const struct command cmd_diff = {
    .name = "diff",
    .arguments = "A B",
    .summary = "whether two images, two runs, or a run and the engine's own intermediates are the same",
    .description =
        "A and B are EXR files, runs, or one image of either (F:PART:LAYER, RUN:IMAGE); a run and a capture compare "
        "the "
        "run with the engine's intermediates in the capture. Limits and exit codes are those of idiff: 0 the same, 1 a "
        "warning, 2 a failure, 3 not the same size, 4 cannot be read (5: wrong usage). An image or a channel that one "
        "side "
        "lacks is a failure. NaN is the same as NaN, and nothing else. For each image: the share of pixels that differ "
        "at "
        "all, how many are over the limit, the largest difference with its pixel, channel and both values. Of two "
        "runs: "
        "what they say differently of themselves, and the first image, in the order of the passes, that differs. "
        "Beside a "
        "run of --all, one as planned is compared in what both have: images that its plan does without are named and "
        "no "
        "failure, and where it traces no ray only the picture counts.",
    .options = options,
    .one_dash = true,
    .usage_status = DIFF_USAGE,
    .parse = cmd_diff_parse,
    .examples = examples,
    .values = metric_args_values,
    .run = cmd_diff_run,
};
