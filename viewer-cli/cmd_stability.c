/* glint stability: measures how rounding of the captured values changes each pixel, pass by pass. */
#include "command.h"
#include "options/effect_args.h"
#include "options/opened.h"
#include "io/progress.h"
#include "stability/stability.h"

struct arguments {
    struct pipeline_args pipeline;
    struct list inputs;
    struct glint_stability_options options;
    const char *capture, *out, *effect;
    double fail_above, fail_percent;
    bool fails, json;
};

enum { KEY_SEEDS = 256, KEY_PERTURB, KEY_BOUND, KEY_FAIL_ABOVE, KEY_FAIL_PERCENT, KEY_PRECISION };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",  'o',         "FOLDER",        0, "Folder for the results: layers of each pass for glint view, stability.json, and a sheet, stability.png", 0},
    {"seeds",   KEY_SEEDS,   "N",             0, "Number of perturbed replays (default 8)", 0},
    EFFECT_OPTION,
    {"perturb", KEY_PERTURB, "PART[:CHANNEL],...", 0, "Perturb only these values: gbuffer:depth, gbuffer:normal, lit, cubemap:distance ... (default: all)", 0},
    {"precision", KEY_PRECISION, "half|float", 0, "float (default): all images in float, so that only arithmetic is measured; half: images in their declared formats", 0},
    {"bound",   KEY_BOUND,   "X",             0, "Count pixels with an amplification above X as ill-conditioned (default 10, or the value of --fail-above)", 0},
    {"fail-above", KEY_FAIL_ABOVE, "X",       0, "Exit with status 1 if the amplification of any pixel exceeds X in any pass", 0},
    {"fail-percent", KEY_FAIL_PERCENT, "P",   0, "With --fail-above: allow this percentage of the pixels of each pass to exceed it (default 0)", 0},
    WHOLE_PIPELINE_OPTIONS("The pipeline"),
    SKIP_OPTION,
    {"json",    'j',         NULL,            0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint stability street.exr", "measures how stable a frame is, and which pass amplifies rounding"},
    {"glint stability street.exr -o stable", "also writes pictures: stable/stability.png"},
    {"glint view stable --image travelled -o worst.png", "shows the amplification of one image"},
    {"glint stability street.exr --perturb gbuffer:depth", "measures the effect of the precision of depth alone"},
    {"glint stability street.exr --fail-above 1000 --fail-percent 0.1",
     "checks for a script: exit status 1 if more than one pixel in a thousand is worse"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(ARGP_KEY_ARG, struct arguments, capture),
    STORED('o', struct arguments, out),
    STORED('j', struct arguments, json),
    STORED_NUMBER(KEY_SEEDS, struct arguments, options.seeds, 1, 255),
    STORED(KEY_EFFECT, struct arguments, effect),
    STORED_NAMES(KEY_PERTURB, struct arguments, inputs),
    PIPELINE_TARGETS(struct arguments, pipeline),
    {0},
};

static double positive(const char *option, const char *text, struct argp_state *state) {
    double value;
    arg_numbers(option, text, &value, 1, state);
    if (!(value >= 0)) argp_error(state, "--%s %s: expected a number that is not negative", option, text);
    return value;
}

static error_t cmd_stability_parse(int key, char *arg, struct argp_state *state) {
    static const char *const precisions[] = {"half", "float", NULL};
    struct arguments *a = state->input;
    switch (key) {
    case KEY_PRECISION:
        a->options.half = arg_choice("precision", arg, precisions, state) == 0;
        return 0;
    case KEY_BOUND:
        a->options.bound = positive("bound", arg, state);
        return 0;
    case KEY_FAIL_ABOVE:
        a->fails = true;
        a->fail_above = positive("fail-above", arg, state);
        return 0;
    case KEY_FAIL_PERCENT:
        a->fail_percent = positive("fail-percent", arg, state);
        return 0;
    case ARGP_KEY_END:
        if (a->fails && a->options.bound > 0)
            argp_error(state, "--bound and --fail-above set the same bound; use only one");
        if (a->fails) a->options.bound = a->fail_above;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* Prints to stderr which pass fails the check. */
static enum status check_limits(const struct arguments *a, const struct glint_stability *s) {
    enum status status = STATUS_DONE;
    for (size_t i = 0; a->fails && i < s->pass_count; i++) {
        const struct glint_stability_summary *found = &s->passes[i].summary;
        const double percent = found->compared ? 100 * (double)found->above / (double)found->compared : 0;
        if (percent <= a->fail_percent) continue;
        command_note(&cmd_stability, "%s: %.4g %% of the pixels exceed %g; the largest value is %.4g",
                     s->passes[i].pass->slot, percent, s->bound, found->largest);
        status = STATUS_CHECK;
    }
    return status;
}

static enum status report(const struct arguments *a, const struct stability_report *found) {
    struct glint_error err = {0};
    enum status status = STATUS_DONE;
    if (a->out && !stability_write(a->out, found, &err)) return command_fail(&cmd_stability, &err);
    if (a->json) status = print_json(stability_json(found));
    else stability_print(found);
    return status != STATUS_DONE ? status : check_limits(a, found->stability);
}

static enum status measure_stability(struct arguments *a, struct opened *opened, struct glint_error *err) {
    struct glint_stability stability = {0};
    struct progress progress;
    a->options.inputs = list_or_null(&a->inputs);
    a->options.all = a->pipeline.replay.all;
    a->options.skip = list_or_null(&a->pipeline.skip);
    progress_begin(&progress);
    progress_phase(&progress, "replays");
    const bool ok = glint_stability_measure(opened->replay, opened->capture, opened->pipeline, &a->options,
                                            progress_report, &progress, &stability, err);
    progress_end(&progress);
    const struct stability_report found = {.stability = &stability,
                                           .capture = a->capture,
                                           .effect = a->options.effect,
                                           .preset = glint_pipeline_name(opened->pipeline),
                                           .device = glint_device_get_info(opened->device)->name,
                                           .inputs = a->options.inputs,
                                           .half = a->options.half};
    const enum status status = ok ? report(a, &found) : command_fail(&cmd_stability, err);
    glint_stability_finish(&stability);
    return status;
}

static enum status cmd_stability_run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    struct opened opened = {0};
    command_parse(&cmd_stability, argc, argv, &a);
    bool ok = opened_init(&opened, &a.pipeline, a.capture, &err);
    if (ok) ok = (a.options.effect = effect_find(&cmd_stability, a.effect, opened.pipeline, false, NULL, &err)) != NULL;
    const enum status status = ok ? measure_stability(&a, &opened, &err) : command_fail(&cmd_stability, &err);
    opened_finish(&opened);
    pipeline_args_finish(&a.pipeline);
    list_free(&a.inputs);
    return status;
}

const struct command cmd_stability = {
    .name = "stability",
    .arguments = "F [-o FOLDER]",
    .summary = "measure how rounding of the captured values changes each pixel, pass by pass",
    .description =
        "Replays the capture as it is, and again with perturbed values that would round to the same stored ones: "
        "each is moved by half a step of its declared storage format, up or down at random. The relative change of a "
        "pixel is the root mean square of its changes over these replays; for lengths and radiance it is divided by "
        "the value (at least a hundredth of the mean of the image). The amplification of a pass is this change "
        "divided by the root of the sum of squares of the relative changes, at the same pixel, of all capture images "
        "that the pass depends on (for cube maps: over all texels). Replays in which a discrete decision of a pixel "
        "changes (the end reason of a ray, the chosen cube map or pixel; for filters, of any pixel within 8 pixels) "
        "are counted as flips and do not enter the change. Also reports how far the largest value of each image is "
        "from 65504, the limit of half floats. See docs/stability.md.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_stability_parse,
    .examples = examples,
    .run = cmd_stability_run,
};
