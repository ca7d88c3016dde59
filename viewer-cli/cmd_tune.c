/* glint tune: the best parameters within a budget. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/pass_names.h"
#include "options/pipeline_args.h"
#include "tune/tune.h"

struct arguments {
    struct tune tune;
    struct pipeline_args pipeline;
    const char *metric, *budget_ms, *budget_fetches, *error, *cost;
    bool json;
};

enum {
    KEY_BUDGET_MS = 256,
    KEY_BUDGET_FETCHES,
    KEY_ERROR,
    KEY_COST,
    KEY_SLOTS,
    KEY_VARY,
    KEY_UNSEEN,
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
    {"budget-ms", KEY_BUDGET_MS, "T",            0, "The least error within this GPU time of a frame; 50% is half of the start's", 0},
    {"budget-fetches", KEY_BUDGET_FETCHES, "N",  0, "The least error within so many texture fetches of the traces a pixel, which no device changes; 50% likewise", 0},
    {"error",     KEY_ERROR,     "E",            0, "The least cost whose error is at most this; 110% is a tenth more than the start's", 0},
    {"cost",      KEY_COST,      "ms|fetches",   0, "What --error makes least (default ms)", 0},
    {"slots",     KEY_SLOTS,     "SLOT,...",     0, "The time of these alone counts (default: of all that a frame runs)", 0},
    {"vary",      KEY_VARY,      "NAME[=VALUES]", 0, "What may move: SLOT.PARAM in its declared range, SLOT.PARAM=A..B, SLOT.PARAM=A,B, "
                                                     "SLOT=VARIANT,VARIANT, pipeline.rays=A..B (default: every parameter that is declared and "
                                                     "can make a difference to the reflection)", 0},
    {"output",    'o',           "PRESET.json",  0, "The preset that is found, with where it comes from; --preset reads it", 0},
    {"folder",    KEY_FOLDER,    "FOLDER",       0, "Where evaluations, references and the page are kept (default: PRESET.tune); a search goes on from what is there, "
                                                    "and another budget of the same start finds its points again", 0},
    {"unseen",    KEY_UNSEEN,    "F",            0, "A capture to measure what was found on, and not to tune on; may be repeated", 0},
    {"baseline",  KEY_BASELINE,  "scale",        0, "Measure beside it what is found without a search: all counts of steps, cells, samples, taps and rays "
                                                    "that may move and cost something, times the largest factor that keeps the limit. A budget becomes what that "
                                                    "costs, on each capture, and the search knows it from the start; in the end its factor on each capture is the least "
                                                    "that costs no less than what was found", 0},
    {"over",      KEY_OVER,      "mean|worst",   0, "Of several captures: the means count, or the one that errs most, and the one that costs most, in parts "
                                                    "of what the baseline does there, without one of what the start does (default mean)", 0},
    {"tries",     KEY_TRIES,     "N",            0, "Points to try at most, and a fourth of that again each time, three at most, that measured times correct the search's "
                                                    "(default 150, and 3 for each parameter). With fewer than some three for each parameter, groups of parameters are moved together "
                                                    "first, and those that change most are searched one by one", 0},
    {"seed",      KEY_SEED,      "N",            0, "Of the search's new starts (default 1)", 0},
    {"rounds",    KEY_ROUNDS,    "N",            0, "Timed rounds of a point, each in turn with the start (default 3)", 0},
    {"repeat",    KEY_REPEAT,    "N",            0, "Timed rounds in the end, of all that is compared (default 15; 0: no times)", 0},
    {"reference", KEY_REFERENCE, "RUN|truth",    0, "What errors are against: a run of glint reference (one for each capture, the unseen ones too), or the truth "
                                                    "in the capture (default: a reference traced once and kept in the folder)", 0},
    {"rays",      KEY_RAYS,      "N",            0, "Rays a pixel of the reference that is traced (default 64)", 0},
    {"metric",    KEY_METRIC,    "NAME",         0, "The error, mean over the captures (default rmse); there are ", 0},
    WHOLE_PIPELINE_OPTIONS("The start"),
    {"json",      'j',           NULL,           0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint tune street.exr -o half.json --budget-ms 50%", "half of mafia3's time: the least error of all parameters"},
    {"glint replay street.exr -p ./half.json", "what was found, as any preset"},
    {"glint tune street.exr -o quarter.json --budget-ms 25% --folder half.tune",
     "another budget, from the same evaluations"},
    {"glint tune street.exr room.exr --unseen hotel.exr -o both.json --budget-fetches 40 --baseline scale",
     "two captures, without times; is it better than all steps scaled, on a third one too?"},
    {"glint tune street.exr -o march.json --budget-ms 0.1 --slots cubemap_trace --vary cubemap_trace.steps_hq=4..64 "
     "--vary cubemap_trace.refinements",
     "two parameters, and the time of one pass"},
    {"glint tune street.exr -o trace.json --budget-ms 50% --vary screen_trace=hiz,linear --vary screen_trace.cells "
     "--vary screen_trace.steps",
     "variants too, each with its own parameters"},
    {"glint tune street.exr -o cheap.json --error 105%", "as good but for a twentieth, in the least time"},
    {"glint report half.tune -o half.html", "the page again, to send"},
    {0},
};

extern const struct command cmd_tune;

static char *cmd_tune_values(int key) {
    const char *names[GLINT_METRIC_COUNT + 1] = {NULL};
    size_t n = 0;
    for (size_t m = GLINT_METRIC_RMSE; m < GLINT_METRIC_COUNT; m++)
        if (!glint_metric(m)->higher_is_better) names[n++] = glint_metric(m)->name;
    return key == KEY_METRIC ? join_names("", names) : NULL;
}

static error_t parse_search(int key, char *arg, struct argp_state *state, struct arguments *a) {
    struct tune *tune = &a->tune;
    switch (key) {
    case KEY_TRIES:
        tune->tries = arg_uint("tries", arg, 1, 100000, state);
        return 0;
    case KEY_SEED:
        tune->seed = arg_uint("seed", arg, 0, UINT32_MAX, state);
        return 0;
    case KEY_ROUNDS:
        tune->rounds = arg_uint("rounds", arg, 1, 1000, state);
        return 0;
    case KEY_REPEAT:
        tune->repeat = arg_uint("repeat", arg, 0, 10000, state);
        return 0;
    case KEY_REFERENCE:
    case KEY_RAYS:
        return answer_args_parse(key, arg, state, &tune->against);
    case KEY_METRIC:
        a->metric = arg;
        return 0;
    case KEY_SHADER:
        list_add(&tune->shaders, arg, state);
        break;
    }
    return pipeline_args_parse(key, arg, state, &a->pipeline);
}

/* "0.3" or "50%" */
static void read_limit(struct tune *tune, const char *option, const char *text, struct argp_state *state) {
    char *end;
    const double value = strtod(text, &end);
    tune->part = !strcmp(end, "%");
    tune->limit = tune->part ? value / 100 : value;
    if (end == text || (*end && !tune->part) || !isfinite(value) || !(value > 0))
        argp_error(state, "--%s %s: expected a number above 0, or a part of the start's such as 50%%", option, text);
}

static void check_arguments(struct arguments *a, struct argp_state *state) {
    struct tune *tune = &a->tune;
    const size_t length = tune->out ? strlen(tune->out) : 0, all = tune->captures.count + tune->unseen.count;
    if (!tune->captures.count) argp_error(state, "which capture?");
    if (!!a->budget_ms + !!a->budget_fetches + !!a->error != 1)
        argp_error(state, "which limit? one of --budget-ms, --budget-fetches, --error");
    if (!tune->out) argp_error(state, "where to? -o PRESET.json");
    if (length <= 5 || strcmp(tune->out + length - 5, ".json") != 0 || tune->out[length - 6] == '/')
        argp_error(state, "-o %s: expected a preset's file, NAME.json", tune->out);
    if (a->cost && !a->error) argp_error(state, "--cost: a budget says what it is of");
    answer_args_check(&tune->against, all, state);
    tune->by_error = a->error != NULL;
    tune->fetches = a->budget_fetches || (a->cost && !strcmp(a->cost, "fetches"));
    if (tune->fetches && tune->slots.count) argp_error(state, "--slots: is for times; fetches are those of the traces");
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
    case KEY_BUDGET_MS:
        a->budget_ms = arg;
        return 0;
    case KEY_BUDGET_FETCHES:
        a->budget_fetches = arg;
        return 0;
    case KEY_ERROR:
        a->error = arg;
        return 0;
    case KEY_COST:
        arg_choice("cost", arg, costs, state);
        a->cost = arg;
        return 0;
    case KEY_SLOTS:
        list_split(&tune->slots, arg, state);
        return 0;
    case KEY_VARY:
        list_add(&tune->vary, arg, state);
        return 0;
    case KEY_UNSEEN:
        list_add(&tune->unseen, arg, state);
        return 0;
    case KEY_BASELINE:
        tune->baseline = arg_choice("baseline", arg, baselines, state) == 0;
        return 0;
    case KEY_OVER:
        tune->worst = arg_choice("over", arg, overs, state) == 1;
        return 0;
    case KEY_FOLDER:
        tune->folder = arg;
        return 0;
    case 'o':
        tune->out = arg;
        return 0;
    case 'j':
        a->json = true;
        return 0;
    case ARGP_KEY_ARG:
        list_add(&tune->captures, arg, state);
        return 0;
    case ARGP_KEY_END:
        check_arguments(a, state);
        return 0;
    }
    return parse_search(key, arg, state, a);
}

static bool choose_metric(struct arguments *a, struct glint_error *err) {
    if (!answer_args_metric(a->metric, &a->tune.metric, err)) return false;
    if (a->tune.metric == GLINT_METRIC_MEAN || glint_metric(a->tune.metric)->higher_is_better)
        return glint_fail(err, GLINT_ERROR_USAGE, "--metric %s: expected an error, which is better when lower",
                          a->metric);
    return true;
}

static bool begin_tune(struct arguments *a, struct glint_error *err) {
    struct tune *tune = &a->tune;
    tune->all = a->pipeline.replay.all;
    for (size_t i = 0; i < tune->slots.count; i++)
        if (!check_slot(tune->slots.items[i], strlen(tune->slots.items[i]), err)) return false;
    if (!choose_metric(a, err) || !(tune->base = pipeline_args_create(&a->pipeline, err)) ||
        !(tune->device = pipeline_args_device(&a->pipeline, err)) || !glint_make_folder(tune->folder, err) ||
        !tune_load(tune, err) || !tune_make_axes(tune, err))
        return false;
    if (!tune->axis_count) return glint_fail(err, GLINT_ERROR_USAGE, "nothing that may move makes a difference here");
    if (!tune->tries) tune->tries = 150 + 3 * (uint32_t)tune->axis_count;
    return tune_open(tune, err);
}

/* An interrupted search leaves its best so far. */
static enum status interrupted(const struct tune *tune) {
    struct glint_error err = {0};
    const bool some = tune->found.count && tune->found.feasible;
    if (some && !tune_write_preset(tune, &err)) return command_fail(&cmd_tune, &err);
    command_note(&cmd_tune, "%s%s%s keeps what was found; the same command goes on from there", some ? tune->out : "",
                 some ? " is the best so far, not measured again; " : "", tune->folder);
    return STATUS_INTERRUPTED;
}

static bool work(struct tune *tune, struct glint_error *err) {
    return tune_search(tune, err) && (tune->found.feasible || tune_fail_least(tune, err)) && tune_choose(tune, err) &&
           tune_confirm(tune, err) && tune_write_preset(tune, err) && tune_write_page(tune, err);
}

void tune_finish(struct tune *tune) {
    for (size_t i = 0; tune->measured && i < tune->subject_count * TUNE_CONTENDERS; i++)
        glint_metric_table_finish(&tune->measured[i].errors);
    for (size_t s = 0; tune->subjects && s < tune->subject_count; s++) tune_unload_subject(tune, s);
    for (int k = 0; k < TUNE_CONTENDERS; k++)
        if (tune->contenders[k]) glint_pipeline_destroy(&tune->contenders[k]);
    for (size_t a = 0; a < tune->axis_count; a++) free(tune->axes[a].texts);
    glint_search_result_finish(&tune->found);
    journal_close(&tune->journal);
    json_decref(tune->lines);
    free(tune->measured);
    free(tune->subjects);
    free(tune->axes);
    free(tune->scaling);
    free(tune->left);
    if (tune->base) glint_pipeline_destroy(&tune->base);
    if (tune->device) glint_device_destroy(&tune->device);
    struct list *const lists[] = {&tune->captures, &tune->unseen, &tune->against.references,
                                  &tune->vary,     &tune->slots,  &tune->shaders};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) list_free(lists[i]);
}

static char *command_line(int argc, char **argv) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs("glint tune", out);
    for (int i = 1; i < argc; i++) fprintf(out, " %s", argv[i]);
    fclose(out);
    return text;
}

static enum status cmd_tune_run(int argc, char **argv) {
    struct arguments a = {
        .tune = {
            .metric = GLINT_METRIC_RMSE, .seed = 1, .against = {.rays = GLINT_JUDGE_RAYS}, .rounds = 3, .repeat = 15}};
    struct glint_error err = {0};
    struct progress progress;
    struct tune *tune = &a.tune;
    char folder[4096], *line = command_line(argc, argv);
    command_parse(&cmd_tune, argc, argv, &a);
    snprintf(folder, sizeof folder, "%.*s.tune", (int)(strlen(tune->out) - strlen(".json")), tune->out);
    if (!tune->folder) tune->folder = folder;
    tune->command_line = line ? line : "glint tune";
    tune->progress = &progress;
    progress_begin(&progress);
    const bool ok = begin_tune(&a, &err) && work(tune, &err);
    progress_end(&progress);
    enum status status = ok                                    ? STATUS_DONE
                         : err.code == GLINT_ERROR_INTERRUPTED ? interrupted(tune)
                                                               : command_fail(&cmd_tune, &err);
    if (ok && a.json) status = print_json(tune_json(tune));
    else if (ok) tune_print(tune);
    if (ok && status == STATUS_DONE && !tune->confirmed_within) {
        command_note(&cmd_tune, "measured again, no point that was tried keeps the limit; %s is the nearest",
                     tune->out);
        status = STATUS_CHECK;
    }
    tune_finish(tune);
    pipeline_args_finish(&a.pipeline);
    free(line);
    return status;
}

const struct command cmd_tune = {
    .name = "tune",
    .arguments = "F... -o PRESET.json --budget-ms T",
    .summary = "the best parameters within a budget of time or error",
    .description =
        "Searches the values of a preset's parameters for the least error within a budget, or for the least cost "
        "within an error, "
        "and writes what it finds as a preset. Errors are of the reflection against the reference, mean over the "
        "captures. "
        "Parameters that cannot matter are left out, and listed with the reason: passes that do not run, work on cube "
        "maps "
        "that no frame pays for, what runs after the reflection, what would ask for another reference, what a "
        "reference must assume. "
        "Of the others each is moved alone first; those that change nothing are left out, too. Steps are of an eighth "
        "of a range, or of a "
        "doubling where it spans decades. "
        "With --budget-fetches the same seed gives the same preset on every run. Times are medians of rounds in turns "
        "with the "
        "start, and off by some per cent: what is found is measured again in turns, and where it takes more than the "
        "budget, or leaves some of it, the search goes on with its times corrected; of all points the preset is the "
        "one that errs least "
        "and, measured, keeps the budget. Every evaluation is kept as it is found: the same command goes on after "
        "an interruption, "
        "and what was the best by then is in the preset's file.",
    .options = options,
    .parse = cmd_tune_parse,
    .examples = examples,
    .values = cmd_tune_values,
    .run = cmd_tune_run,
};
