/* glint diff: compares two images, two runs, or a run with the engine's own intermediate images. */
#include "command.h"
#include "diff/options.h"

struct arguments {
    const char *paths[2];
    size_t count;
    struct diff_args diff;
};

static const struct argp_option options[] = {DIFF_OPTIONS("FILE.png", "Write " DIFF_HEAT), {0}};
static const struct example examples[] = {
    {"glint diff a.exr b.exr", "compares all parts and channels"},
    {"glint diff -fail 0.004 -failpercent 1 a.exr b.exr -o heat.png", "uses options of idiff, and writes a heat map"},
    {"glint diff run run2", "shows which parameters and which pass differ first"},
    {"glint diff run run2 --html diff.html", "writes a page with slider, flicker, heat map and pixel values"},
    {"glint diff planned all", "checks that a plan changed no bit, by a run with --all"},
    {"glint diff run:travelled run2:travelled", "compares one image"},
    {"glint diff run street.exr", "compares a run with the engine's images (engine.SLOT.IMAGE)"},
    {"glint diff run:reflection street.exr:truth.reflection.ggx --metrics",
     "compares an image with a part of a capture"},
    {"glint diff run:reflection_half run:reflection --resample", "compares images of different sizes"},
    {"glint diff run run2 --metrics rmse,flip --json", "prints image metrics (see docs/metrics.md)"},
    {0},
};

static const struct arg_target targets[] = {
    DIFF_TARGETS(struct arguments, diff),
    {0},
};

static error_t cmd_diff_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->count == 2) argp_error(state, "expected two images or runs, found also %s", arg);
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
    metric_args_complete(argc, argv);
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
    .summary = "compare two images, two runs, or a run with the engine's intermediate images",
    .description =
        "A and B are EXR files, runs, or one image of either (F:PART:LAYER, RUN:IMAGE). For a run and a capture, the "
        "run is compared with the engine's own intermediate images in the capture, and one image of the run with the "
        "part of the capture that is named (F:PART), decoded. Limits and exit codes are those "
        "of idiff: 0 equal, 1 warning, 2 failure, 3 different size, 4 unreadable (5: wrong usage). An image or "
        "channel that only one side contains is a failure. NaN equals only NaN. For each image the output shows the "
        "share of pixels that differ at all, the number of pixels over the limit, the RMS of all channels and, for an "
        "image with alpha, of R, G and B alone, and the largest difference with its pixel, channel and both values; "
        "for two runs also differences of their settings and the first image, in "
        "the order of the passes, that differs. If one run was made with --all and the other with a plan, only "
        "common images are compared: images that the plan does not need are listed and are no failure, and pixels "
        "for which the plan traces no ray are compared only in the final image.",
    .options = options,
    .targets = targets,
    .one_dash = true,
    .usage_status = DIFF_USAGE,
    .parse = cmd_diff_parse,
    .examples = examples,
    .values = metric_args_values,
    .run = cmd_diff_run,
};
