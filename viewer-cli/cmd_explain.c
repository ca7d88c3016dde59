/* glint explain: says in a few sentences how a run got the reflection of one pixel, and what would change it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "draw/page/page.h"
#include "explain/explain.h"
#include "glint/reference.h"
#include "io/table.h"
#include "options/effect_args.h"
#include "options/run_source.h"

enum { TRIES = 64 };

struct arguments {
    const char *run, *capture, *device, *against, *out, *effect;
    int32_t pixel[2];
    bool has_pixel, json, overwrite;
    uint32_t tries;
};

enum { KEY_CAPTURE = 256, KEY_AGAINST, KEY_TRIES };

/* clang-format off */
static const struct argp_option options[] = {
    {"capture", KEY_CAPTURE, "F",         0, "The capture that the run was made of, if it is no longer where run.json says", 0},
    {"against", KEY_AGAINST, "RUN",       0, "Compare with the result of this run, such as one of glint reference (default: the truth in the capture, where it has one)", 0},
    {"effect",  KEY_EFFECT,  "EFFECT",    0, "Effect that is explained, of those that glint passes lists (default: the first whose result the run holds)", 0},
    {"tries",   KEY_TRIES,   "N",         0, "Try at most N single changes of parameters and variants, 0 to 1000; each replays what it changes (default 64)", 0},
    {"output",  'o',         "FILE.html", 0, "Write the sentences and all that was tried as a page", 0},
    OVERWRITE_OPTION,
    DEVICE_OPTION,
    {"json",    'j',         NULL,        0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint replay street.exr -o street", "makes a run"},
    {"glint explain street 640,500", "explains its pixel 640,500"},
    {"glint explain street 640,500 --tries 0", "only says what happened, which takes three replays"},
    {"glint explain street 640,500 --json | jq -r .best.change", "prints the one change that helps most"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(KEY_CAPTURE, struct arguments, capture),
    STORED(KEY_AGAINST, struct arguments, against),
    STORED(KEY_EFFECT, struct arguments, effect),
    STORED_NUMBER(KEY_TRIES, struct arguments, tries, 0, EXPLAIN_TRIES_MAX),
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_HTML),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED('d', struct arguments, device),
    STORED('j', struct arguments, json),
    {0},
};

static error_t cmd_explain_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->has_pixel) argp_error(state, "expected one run and one pixel, found also %s", arg);
        if (!a->run) a->run = arg;
        else arg_pixel(arg, a->pixel, state), a->has_pixel = true;
        return 0;
    case ARGP_KEY_END:
        if (!a->run) argp_error(state, "no run given");
        if (!a->has_pixel) argp_error(state, "no pixel of %s given: X,Y from the top left corner", a->run);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* ---- What is true ---- */

static bool load_truth(struct explain *e, const char *against, struct glint_error *err) {
    struct glint_error cause = {0};
    if (against) {
        struct glint_run *run = glint_run_open(against, err);
        const bool ok = run && glint_study_run_result(run, e->effect, &e->true_pixels, err) &&
                        glint_study_run_error(run, e->effect, &e->true_error, err);
        glint_run_close(&run);
        if (!ok) return false;
    } else if (!glint_study_truth(e->opened->capture, e->effect, e->opened->pipeline, &e->true_pixels, &e->true_error,
                                  &cause)) {
        if (cause.code == GLINT_ERROR_FORMAT) return true; /* the capture has none */
        if (err) *err = cause;
        return false;
    }
    if (e->true_pixels.width != e->probe.full[0] || e->true_pixels.height != e->probe.full[1])
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: the %s is %u x %u, expected %u x %u",
                          against ? against : "the capture's truth", e->effect->noun, e->true_pixels.width,
                          e->true_pixels.height, e->probe.full[0], e->probe.full[1]);
    e->truth = against ? against : "truth";
    /* The truth has no fog, and a reference may have none. */
    e->without_fog = !against && glint_capture_frame(e->opened->capture)->has_fog && pipeline_fog(e->opened->pipeline);
    return !e->without_fog || pipeline_fog_off(e->opened->pipeline, err);
}

/* ---- Output ---- */

/* A sentence a line. */
static void print_sentences(const json_t *sentences) {
    size_t i;
    const json_t *sentence;
    json_array_foreach(sentences, i, sentence) puts(name_text(json_string_value(sentence)));
}

static bool write_page(const struct explain *e, const char *path, const json_t *sentences, struct glint_error *err) {
    char title[300];
    size_t i;
    const json_t *sentence;
    snprintf(title, sizeof title, "%.200s: pixel %u,%u", e->run, e->probe.pixel[0], e->probe.pixel[1]);
    json_t *document = page_create(title);
    page_fact(document, "run", e->run);
    page_fact(document, "capture", e->probe.capture);
    page_fact(document, "device", e->probe.device);
    json_t *blocks = page_section(document, "What happened to the pixel");
    json_array_foreach(sentences, i, sentence) page_text(blocks, "text", json_string_value(sentence));
    if (e->tried) {
        json_t *table = page_table(page_section(document, "What was tried"));
        page_column(table, "change", "");
        page_column(table, "now", "");
        page_column(table, "symmetric error", "|");
        if (e->goal == EXPLAIN_RESULT) page_column(table, "of the pixels around it", "|");
        for (size_t t = 0; t < e->tried; t++) {
            json_t *row =
                json_pack("[s, s, o]", e->tries[t].change, e->tries[t].before, json_number(e->tries[t].error));
            if (e->goal == EXPLAIN_RESULT) json_array_append_new(row, json_number(e->tries[t].around));
            page_row(table, row);
        }
    }
    const bool ok = page_write(path, document, NULL, err);
    json_decref(document);
    return ok;
}

static enum status report(const struct arguments *a, const struct explain *e, struct glint_error *err) {
    json_t *sentences = explain_sentences(e);
    enum status status = STATUS_DONE;
    if (a->out && !write_page(e, a->out, sentences, err)) status = command_fail(&cmd_explain, err);
    else if (a->json) status = print_json(explain_json(e, sentences));
    else print_sentences(sentences);
    json_decref(sentences);
    return status;
}

/* ---- The command ---- */

/* The same ray, traced by the reference tracers. */
static bool probe_both(struct explain *e, struct glint_error *err) {
    struct glint_pipeline *reference = probe_reference(e->opened->pipeline, err);
    const bool ok =
        reference &&
        probe_run(&e->probe, &e->probe.own, e->opened->replay, e->opened->pipeline, &e->options, NULL, NULL, err) &&
        probe_run(&e->probe, &e->probe.reference, e->opened->replay, reference, &e->options, NULL, NULL, err);
    if (reference) glint_pipeline_destroy(&reference);
    e->probe.has_reference = ok;
    return ok;
}

static bool explain_pixel(struct explain *e, const struct arguments *a, const struct run_source *source,
                          struct glint_error *err) {
    const struct glint_part_info *picture = glint_capture_find(e->opened->capture, GLINT_PART_GBUFFER);
    if (picture) memcpy(e->probe.full, (uint32_t[]){picture->width, picture->height}, sizeof e->probe.full);
    if (e->probe.pixel[0] >= e->probe.full[0] || e->probe.pixel[1] >= e->probe.full[1])
        return glint_fail(err, GLINT_ERROR_USAGE, "pixel %u,%u is outside of %s, which is %u x %u", e->probe.pixel[0],
                          e->probe.pixel[1], a->run, e->probe.full[0], e->probe.full[1]);
    struct progress progress;
    e->progress = &progress;
    progress_begin(&progress);
    const bool ok = run_source_fits(source, a->run, e->opened->capture, err) &&
                    glint_replay_load(e->opened->replay, e->opened->capture, err) && load_truth(e, a->against, err) &&
                    probe_both(e, err) && explain_find(e, err);
    progress_end(&progress);
    return ok;
}

/* The probe records the rays of one effect alone: whose passes make the radiance that arrives along them. */
static bool is_explained(const struct glint_effect *effect, const char *run, struct glint_error *err) {
    const char *image;
    const struct glint_pass *resolve = glint_pass_with_role(GLINT_ROLE_RAY_RADIANCE, &image);
    if (!resolve || !strcmp(resolve->effect, effect->name)) return true;
    return glint_fail(err, GLINT_ERROR_USAGE,
                      "%s: the %s cannot be explained: glint explain follows the rays of the effect %s alone", run,
                      effect->noun, resolve->effect);
}

static enum status explain_run(const struct arguments *a, struct opened *opened, const struct run_source *source,
                               struct glint_error *err) {
    struct glint_run *run = glint_run_open(a->run, err);
    const struct glint_effect *effect = run ? effect_of_run(a->effect, run, err) : NULL;
    glint_run_close(&run);
    if (!effect || !is_explained(effect, a->run, err)) return command_fail(&cmd_explain, err);
    struct explain e = {.effect = effect,
                        .run = a->run,
                        .opened = opened,
                        .limit = a->tries,
                        .options = {.all = source->all,
                                    .float_precision = source->float_precision,
                                    .history = source->history[0] ? source->history : NULL,
                                    .inputs = source->inputs[0] ? source->inputs : NULL},
                        .probe = {.capture = glint_capture_path(opened->capture),
                                  .preset = glint_pipeline_name(opened->pipeline),
                                  .device = glint_device_get_info(opened->device)->name,
                                  .pixel = {(uint32_t)a->pixel[0], (uint32_t)a->pixel[1]}}};
    const enum status status = explain_pixel(&e, a, source, err) ? report(a, &e, err) : command_fail(&cmd_explain, err);
    probe_side_finish(&e.probe.own);
    probe_side_finish(&e.probe.reference);
    glint_pixels_finish(&e.true_pixels);
    free(e.true_error);
    free(e.tries);
    return status;
}

static enum status cmd_explain_run(int argc, char **argv) {
    struct arguments a = {.tries = TRIES};
    struct glint_error err = {0};
    struct opened opened = {0};
    struct run_source source = {0};
    command_parse(&cmd_explain, argc, argv, &a);
    const struct pipeline_args args = {.device = a.device};
    bool ok = run_source_read(&source, a.run, &err);
    if (ok) {
        opened.pipeline = source.pipeline;
        source.pipeline = NULL;
        ok = opened_init(&opened, &args, a.capture ? a.capture : source.capture, &err);
    }
    const enum status status = ok ? explain_run(&a, &opened, &source, &err) : command_fail(&cmd_explain, &err);
    opened_finish(&opened);
    run_source_finish(&source);
    return status;
}

const struct command cmd_explain = {
    .name = "explain",
    .arguments = "RUN X,Y [-o FILE.html]",
    .numbers = true,
    .summary = "say in a few sentences why a pixel looks as it does",
    .description =
        "Explains reflections. Replays a run with one pixel recorded and says which tracer ended its ray, where and "
        "why, where its colour "
        "came "
        "from, what filters made of it, and how far it is from what is right: the same ray of the reference tracers, "
        "which skip nothing, and the true result, where the capture holds it or --against names a run of glint "
        "reference. If the pixel is wrong, single changes are tried, first of what decides about this ray: every "
        "number "
        "at four times and a quarter of its value, every other choice, and at last other variants. Where the ray is "
        "right, 16 "
        "times the rays come first, which show whether it is noise. The change that "
        "lowers the error most is named if it removes a third of it or more; where filters are at fault, only if the 9 "
        "x 9 "
        "pixels around do not get worse. Errors are symmetric errors, |found - right| / (|found| + |right| + 0.05), "
        "the mean over red, green and blue.\n"
        "X,Y counts pixels from the top left corner. glint probe shows every step in tables.",
    .options = options,
    .targets = targets,
    .parse = cmd_explain_parse,
    .examples = examples,
    .run = cmd_explain_run,
};
