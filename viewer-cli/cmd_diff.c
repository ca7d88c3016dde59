/* glint diff: whether two images, two runs, or a run and the game's own intermediates are the same. */
#include <string.h>

#include "args.h"
#include "diff/diff.h"
#include "metric_args.h"
#include "progress.h"

struct arguments {
    const char *paths[2];
    size_t count;
    struct diff_options options;
    const char *heat;
    bool heat_of_differences, verbose, quiet, json;
};

enum {
    KEY_FAIL = 256,
    KEY_FAIL_RELATIVE,
    KEY_FAIL_PERCENT,
    KEY_HARD_FAIL,
    KEY_ALLOW,
    KEY_WARN,
    KEY_WARN_RELATIVE,
    KEY_WARN_PERCENT,
    KEY_HARD_WARN,
    KEY_ONLY_DIFFERENT
};

/* clang-format off */
static const struct argp_option options[] = {
    {"fail",          KEY_FAIL,          "X", 0, "A pixel fails when a value differs by more than X (default 1e-6)", 0},
    {"failrelative",  KEY_FAIL_RELATIVE, "X", 0, "… and by more than X of the mean of both magnitudes (default 0)", 0},
    {"failpercent",   KEY_FAIL_PERCENT,  "P", 0, "So many per cent of the pixels may fail (default 0)", 0},
    {"hardfail",      KEY_HARD_FAIL,     "X", 0, "One value that differs by more than X is enough (default: infinite)", 0},
    {"allowfailures", KEY_ALLOW,         "N", 0, "Up to N pixels of an image may fail by any amount, and it is the same (default 0)", 0},
    {"warn",          KEY_WARN,          "X", 0, "As --fail, for warnings (default 1e-6)", 0},
    {"warnrelative",  KEY_WARN_RELATIVE, "X", 0, "As --failrelative (default 0)", 0},
    {"warnpercent",   KEY_WARN_PERCENT,  "P", 0, "As --failpercent (default 0)", 0},
    {"hardwarn",      KEY_HARD_WARN,     "X", 0, "As --hardfail (default: infinite)", 0},
    {"output",        'o',               "FILE.png", 0, "Heat map of the differences; of several images a sheet of those that differ", 0},
    {"od",            KEY_ONLY_DIFFERENT, NULL, 0, "Write that only when something differs", 0},
    METRIC_OPTIONS,
    {"all",           'a',               NULL, 0, "As idiff's -a, which is what this command does anyway", 0},
    {"verbose",       'v',               NULL, 0, "List images that are the same, too", 0},
    {"quiet",         'q',               NULL, 0, "Print nothing: the exit status says it", 0},
    {"json",          'j',               NULL, 0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint diff a.exr b.exr", "every part and channel; exit 0 same, 1 warning, 2 failure, 3 other size, 4 unreadable"},
    {"glint diff -fail 0.004 -failpercent 1 a.exr b.exr -o heat.png", "idiff's options, and where they differ"},
    {"glint diff run run2", "which parameters differ, and the first pass that does"},
    {"glint diff run:travelled run2:travelled", "one image of each"},
    {"glint diff run street.exr", "a run against the engine's own intermediates (engine.SLOT.IMAGE)"},
    {"glint diff run run2 --metrics rmse,flip --json", "with figures of docs/metrics.md"},
    {0},
};

extern const struct command cmd_diff;

static error_t parse_limit(int key, char *arg, struct argp_state *state, struct glint_difference_limits *limits) {
    double value;
    arg_numbers("limit", arg, &value, 1, state);
    if (!(value >= 0)) argp_error(state, "%s: expected a number that is not negative", arg);
    switch (key) {
    case KEY_FAIL:
        limits->fail.absolute = value;
        return 0;
    case KEY_FAIL_RELATIVE:
        limits->fail.relative = value;
        return 0;
    case KEY_FAIL_PERCENT:
        limits->fail.percent = value;
        return 0;
    case KEY_HARD_FAIL:
        limits->fail.hard = value;
        return 0;
    case KEY_WARN:
        limits->warn.absolute = value;
        return 0;
    case KEY_WARN_RELATIVE:
        limits->warn.relative = value;
        return 0;
    case KEY_WARN_PERCENT:
        limits->warn.percent = value;
        return 0;
    case KEY_HARD_WARN:
        limits->warn.hard = value;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static error_t parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case 'o':
        a->heat = arg;
        a->options.heat = true;
        return 0;
    case KEY_ONLY_DIFFERENT:
        a->heat_of_differences = true;
        return 0;
    case KEY_ALLOW:
        a->options.limits.allow_failures = arg_uint("allowfailures", arg, 0, UINT32_MAX, state);
        return 0;
    case 'a':
        return 0;
    case 'v':
        a->verbose = true;
        return 0;
    case 'q':
        a->quiet = true;
        return 0;
    case 'j':
        a->json = true;
        return 0;
    case ARGP_KEY_ARG:
        if (a->count == 2) argp_error(state, "two at a time; %s is the third", arg);
        a->paths[a->count++] = arg;
        return 0;
    case ARGP_KEY_END:
        if (a->count < 2) argp_error(state, "expected two images or runs");
        return 0;
    }
    if (key >= KEY_FAIL && key <= KEY_HARD_WARN) return parse_limit(key, arg, state, &a->options.limits);
    return metric_args_parse(key, arg, state, &a->options.metrics);
}

static enum diff_status fail(const struct glint_error *err) {
    const enum status status = command_fail(&cmd_diff, err);
    return status == STATUS_INTERRUPTED ? (enum diff_status)STATUS_INTERRUPTED
           : status == STATUS_USAGE     ? DIFF_USAGE
                                        : DIFF_FILE;
}

static enum status run(int argc, char **argv) {
    struct arguments a = {.options = {.limits = glint_difference_limits()}};
    struct glint_error err = {0};
    struct progress progress;
    command_parse(&cmd_diff, argc, argv, &a);
    struct diff diff = {.options = a.options};
    progress_begin(&progress);
    bool ok = diff_sides_open(diff.sides, a.paths, &err) && diff_compare(&diff, progress_report, &progress, &err);
    progress_end(&progress);
    if (ok && a.heat && (!a.heat_of_differences || diff.status)) ok = diff_write_heat(a.heat, &diff, &err);
    enum diff_status status = ok ? diff.status : fail(&err);
    if (ok && a.json) print_json(diff_json(&diff));
    else if (ok && !a.quiet) diff_print(&diff, a.verbose);
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
        "what they say differently of themselves, and the first image, in the order of the passes, that differs.",
    .options = options,
    .one_dash = true,
    .usage_status = DIFF_USAGE,
    .parse = parse,
    .examples = examples,
    .values = metric_args_values,
    .run = run,
};
