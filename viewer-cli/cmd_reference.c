/* glint reference: traces the converged reflection, and reports its noise and its dependence on assumptions. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "glint/reference.h"
#include "options/effect_args.h"
#include "options/opened.h"
#include "io/progress.h"
#include "io/table.h"

struct arguments {
    struct pipeline_args pipeline;
    const char *capture, *out, *like, *effect, *cache;
    uint32_t rays, sensitivity;
    double noise;
    bool overwrite, json, progress;
};

enum { KEY_RAYS = 256, KEY_NOISE, KEY_SENSITIVITY, KEY_LIKE, KEY_PROGRESS };
enum { RAYS = 64, RAYS_FOR_NOISE = 16384, RAYS_FOR_SENSITIVITY = 32 };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",      'o',             "RUN",  0, "Run folder for the reference, readable by --against reference=RUN and glint view. An interrupted reference resumes from "
        "it, and a larger --rays adds rays to a complete one", 0},
    {"rays",        KEY_RAYS,        "N",    0, "Rays per pixel, rounded up to a multiple of 16 (default 64; with --noise at most 16384)", 0},
    {"noise",       KEY_NOISE,       "E",    0, "Stop when the noise is at most this fraction of the mean result, such as 0.01 for 1 %", 0},
    {"sensitivity", KEY_SENSITIVITY, "RAYS", OPTION_ARG_OPTIONAL, "Also trace with each assumption that the capture cannot settle, such as the thickness of objects, halved and doubled, "
        "with this number of rays per pixel (default 32)", 0},
    EFFECT_OPTION,
    {"like",        KEY_LIKE,        "PRESET|FILE", 0, "Make the reference for this preset: with the lobe that it samples and with its fog", 0},
    USE_OPTION,
    {"set",         KEY_SET,         "SLOT.PARAM=VALUE", 0, "Set a parameter, such as pipeline.fog=false to compare with the truth, which has no fog", 0},
    ALL_OPTION,
    CACHE_OPTION("references with -o and without --noise", ""),
    {"overwrite",   KEY_OVERWRITE,   NULL,   0, "Delete an existing reference in the folder first", 0},
    DEVICE_OPTION,
    LIMIT_OPTION,
    PROGRESS_OPTION,
    {"json",        'j',             NULL,   0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint reference street.exr -o reference --rays 256",
     "traces 256 rays per pixel; a second call with --rays 1024 adds 768"},
    {"glint reference street.exr -o reference --noise 0.01", "traces rays until the noise is 1 %"},
    {"glint reference street.exr -o reference --sensitivity", "also measures the influence of the assumptions"},
    {"glint replay street.exr --against reference=reference", "compares a preset with it"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(ARGP_KEY_ARG, struct arguments, capture),
    STORED('o', struct arguments, out),
    STORED('j', struct arguments, json),
    STORED_NUMBER(KEY_RAYS, struct arguments, rays, 1, GLINT_REFERENCE_RAYS_MAX),
    STORED(KEY_EFFECT, struct arguments, effect),
    STORED(KEY_CACHE, struct arguments, cache),
    STORED(KEY_LIKE, struct arguments, like),
    STORED(KEY_PROGRESS, struct arguments, progress),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    PIPELINE_TARGETS(struct arguments, pipeline),
    {0},
};

static double arg_noise(const char *text, struct argp_state *state) {
    double noise = 0;
    arg_numbers("noise", text, &noise, 1, state);
    if (!(noise > 0 && noise < 1)) argp_error(state, "--noise=%s: expected a number between 0 and 1", text);
    return noise;
}

static error_t cmd_reference_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case KEY_NOISE:
        a->noise = arg_noise(arg, state);
        return 0;
    case KEY_SENSITIVITY:
        a->sensitivity = arg ? arg_uint("sensitivity", arg, 1, GLINT_REFERENCE_RAYS_MAX, state) : RAYS_FOR_SENSITIVITY;
        return 0;
    case ARGP_KEY_END:
        if (a->rays == 0) a->rays = a->noise > 0 ? RAYS_FOR_NOISE : RAYS;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* Error of the reference against the truth, where the capture contains one: light that the data of the capture cannot show. */
struct missing {
    bool known, fog;
    struct glint_image_errors errors;
};

static void number_or_dash(struct table *table, bool there, double value) {
    if (there) table_cell(table, "%.5f", value);
    else table_cell(table, "%s", "–");
}

static void print_noise(const struct glint_effect *effect, const struct glint_reference_state *state,
                        const struct missing *missing) {
    static const char *const titles[] = {"<surfaces", ">mean", ">noise", ">relative %", ">missing information", NULL};
    struct table *table = table_create(titles);
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_reference_noise *noise = &state->noise[k];
        if (noise->pixels == 0) continue;
        table_cell(table, "%s", glint_effect_class_name(effect, k));
        table_cell(table, "%.5f", noise->mean);
        table_cell(table, "%.5f", noise->error);
        table_cell(table, "%.2f", 100 * noise->relative);
        number_or_dash(table, missing->known, missing->errors.of[k].clean_rmse);
    }
    table_print(table, stdout);
    table_destroy(&table);
    puts("noise: standard error of the mean, from the difference between two halves of the rays; relative: divided by "
         "the mean");
    if (missing->known)
        puts("missing information: RMSE against the truth in the capture, less what the noise of both adds");
    if (missing->known && missing->fog)
        puts("the truth has no fog, but this reference has; use --set pipeline.fog=false to compare them");
}

static void print_sensitivity(const struct glint_reference_sensitivity *s) {
    static const char *const titles[] = {"<assumed",    ">value", ">tried", ">mean change", ">RMSE", ">noise",
                                         ">relative %", "<",      NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < s->count; i++) {
        const struct glint_reference_assumption *row = &s->rows[i];
        const struct glint_reference_change *all = &row->of[0];
        table_cell(table, "%s.%s", row->pass->slot, row->row->name);
        table_cell(table, "%s", number_text(row->value));
        table_cell(table, "%s", number_text(row->tried));
        if (row->ran) table_cell(table, "%+.5f", all->mean);
        else table_cell(table, "%s", "–");
        number_or_dash(table, row->ran, all->rmse);
        number_or_dash(table, row->ran, all->noise);
        if (row->ran) table_cell(table, "%.2f", 100 * all->relative);
        else table_cell(table, "%s", "–");
        table_cell(table, "%s", row->reason);
    }
    printf("\nassumptions that the capture cannot settle, halved and doubled, with %u rays per pixel each:\n", s->rays);
    table_print(table, stdout);
    table_destroy(&table);
    if (s->count == 0) puts("the passes declare no assumptions");
    else
        puts("RMSE: between the references with both values, traced with the same random numbers, less what the "
             "noise of their difference adds");
}

static json_t *missing_json(const struct glint_effect *effect, const struct missing *missing) {
    json_t *rows = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_image_error *e = &missing->errors.of[k];
        if (e->pixels == 0) continue;
        json_array_append_new(rows, json_pack("{s:s, s:I, s:o, s:o, s:o, s:o, s:o}", "surfaces",
                                              glint_effect_class_name(effect, k), "pixels", (json_int_t)e->pixels,
                                              "mean_error", json_number(e->mean), "rmse", json_number(e->rmse), "noise",
                                              json_number(e->truth_noise), "clean_rmse", json_number(e->clean_rmse),
                                              "clean_relative_mse", json_number(e->clean_relative_mse)));
    }
    return rows;
}

static bool compare_with_truth(const struct glint_reference *reference, struct glint_capture *capture,
                               const struct glint_effect *effect, const struct glint_pipeline *pipeline,
                               struct missing *missing, struct glint_error *err) {
    struct glint_error no_truth = {0};
    struct glint_pixels truth = {0}, own = {0};
    float *truth_error = NULL, *own_error = NULL;
    uint8_t *labels = NULL;
    missing->known = glint_study_truth(capture, effect, pipeline, &truth, &truth_error, &no_truth);
    missing->fog = glint_capture_frame(capture)->has_fog && pipeline_fog(pipeline);
    if (!missing->known && no_truth.code != GLINT_ERROR_FORMAT) /* it may have one */
        return glint_fail(err, no_truth.code, "%s", no_truth.message);
    bool ok = !missing->known ||
              ((labels = glint_study_labels(capture, effect, err)) != NULL &&
               glint_reference_pixels(reference, &own, &own_error, err) &&
               glint_study_reference_bias(&own, own_error, &truth, truth_error, labels, &missing->errors, err));
    free(labels);
    free(truth_error);
    free(own_error);
    glint_pixels_finish(&truth);
    glint_pixels_finish(&own);
    return ok;
}

/* The library's JSON of the reference, and its error against the truth. */
static enum status print_as_json(const struct glint_reference *reference, const struct glint_effect *effect,
                                 const struct arguments *a, const struct missing *missing) {
    char *text = glint_reference_json(reference);
    json_t *json = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    if (!json) return STATUS_CHECK;
    json_object_set_new(json, "effect", json_string(effect->name));
    json_object_set_new(json, "capture", json_string(a->capture));
    if (a->out) json_object_set_new(json, "run", json_string(a->out));
    if (missing->known) json_object_set_new(json, "missing_information", missing_json(effect, missing));
    return print_json(json);
}

static void print_all(const struct glint_reference *reference, const struct glint_effect *effect,
                      const struct arguments *a, const struct glint_device_info *device, const struct missing *missing,
                      const struct glint_reference_sensitivity *sensitivity) {
    const struct glint_reference_state *state = glint_reference_state(reference);
    printf("%s on %s: %u rays per pixel in %s\n\n", name_text(a->capture), name_text(device->name), state->rays,
           time_text(state->seconds));
    print_noise(effect, state, missing);
    if (a->noise > 0 && state->noise[0].relative > a->noise)
        printf("the noise is still above the requested %g %%: use more --rays\n", 100 * a->noise);
    if (a->sensitivity) print_sensitivity(sensitivity);
    if (a->out) printf("\nreference: %s\n", name_text(a->out));
    else puts("\nnothing written (-o RUN keeps it)");
}

static uint32_t rays_of(const struct glint_reference *reference) {
    const struct glint_reference_state *state = glint_reference_state(reference);
    return state->rays + state->begun;
}

static void note_interrupted(const struct glint_reference_state *state, const char *folder) {
    const uint32_t traced = state->rays + state->begun;
    if (state->kept)
        command_note(&cmd_reference, "%u rays per pixel are kept in %s; the same command resumes from there",
                     state->kept, folder);
    if (traced > state->kept)
        command_note(&cmd_reference, "%u rays per pixel are lost: they could not be written to %s",
                     traced - state->kept, folder);
    else if (!traced) command_note(&cmd_reference, "interrupted before the first ray of all pixels: nothing is kept");
}

/* Opens a device that was lost again. */
static bool continue_reference(struct glint_reference *reference, struct opened *opened, struct glint_error *err) {
    command_note(&cmd_reference, "%s; going on after %u rays per pixel", err->message, rays_of(reference));
    *err = (struct glint_error){0};
    glint_replay_destroy(&opened->replay);
    if (!glint_device_reopen(opened->device, err) || !(opened->replay = glint_replay_create(opened->device, err)) ||
        !glint_replay_load(opened->replay, opened->capture, err))
        return false;
    glint_reference_continue(reference, opened->replay);
    return true;
}

/* Goes on with a new device when it is lost, unless it has traced no ray since it was lost before. */
static bool trace_rays(const struct arguments *a, struct glint_reference *reference, struct opened *opened,
                       struct progress *progress, struct glint_error *err) {
    uint32_t lost_at = UINT32_MAX;
    while (!glint_reference_trace(reference, a->rays, a->noise, progress_report, progress, err)) {
        if (!glint_device_lost(opened->device) || glint_device_given_up(opened->device)) return false;
        if (rays_of(reference) == lost_at) {
            const struct glint_error own = *err;
            return glint_fail(err, own.code, "after %u rays per pixel, tried twice: %s", lost_at, own.message);
        }
        lost_at = rays_of(reference);
        if (!continue_reference(reference, opened, err)) return false;
    }
    return true;
}

static enum status trace_reference(const struct arguments *a, const struct glint_effect *effect, struct opened *opened,
                                   struct glint_error *err) {
    struct glint_replay *replay = opened->replay;
    struct glint_capture *capture = opened->capture;
    const struct glint_pipeline *pipeline = opened->pipeline;
    const struct glint_reference_options options = {.effect = effect,
                                                    .folder = a->out,
                                                    .cache = a->cache,
                                                    .overwrite = a->overwrite,
                                                    .all = a->pipeline.replay.all};
    struct glint_reference_sensitivity sensitivity = {0};
    struct missing missing = {0};
    struct progress progress;
    enum status status = STATUS_DONE;
    progress_begin(&progress);
    progress.lines = a->progress;
    progress_phase(&progress, "reference");
    struct glint_reference *reference = glint_replay_load(replay, capture, err)
                                            ? glint_reference_create(replay, capture, pipeline, &options, err)
                                            : NULL;
    bool ok = reference && trace_rays(a, reference, opened, &progress, err) &&
              (!a->sensitivity ||
               glint_reference_sensitivity(reference, a->sensitivity, progress_report, &progress, &sensitivity, err)) &&
              compare_with_truth(reference, capture, effect, pipeline, &missing, err);
    progress_end(&progress);
    if (!ok) status = command_fail(&cmd_reference, err);
    else if (a->json) status = print_as_json(reference, effect, a, &missing);
    else print_all(reference, effect, a, glint_device_get_info(opened->device), &missing, &sensitivity);
    if (reference && (status == STATUS_INTERRUPTED || glint_device_lost(opened->device)) && a->out)
        note_interrupted(glint_reference_state(reference), a->out);
    glint_reference_destroy(&reference);
    return status;
}

/* The preset `reference` with the lobe and fog of --like's preset and the settings of this call. */
static struct glint_pipeline *create_pipeline(struct arguments *a, struct glint_error *err) {
    struct glint_pipeline *pipeline = NULL;
    struct glint_pipeline *like = a->like ? glint_pipeline_create(a->like, err) : NULL;
    if (a->like && !like) return NULL;
    a->pipeline.preset = "reference";
    if (!like) return pipeline_args_create(&a->pipeline, err);
    pipeline = glint_study_reference(like, err);
    glint_pipeline_destroy(&like);
    if (pipeline && !pipeline_args_apply(&a->pipeline, pipeline, err)) glint_pipeline_destroy(&pipeline);
    return pipeline;
}

static enum status cmd_reference_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_reference, argc, argv, &a);
    char *cache = a.out ? pipeline_args_cache(a.cache) : NULL;
    a.cache = cache;
    struct glint_error err = {0};
    struct opened opened = {.pipeline = create_pipeline(&a, &err)};
    const struct glint_effect *effect =
        opened.pipeline ? effect_find(&cmd_reference, a.effect, opened.pipeline, true, NULL, &err) : NULL;
    const bool ok = effect && opened_init(&opened, &a.pipeline, a.capture, &err);
    const enum status status = ok ? trace_reference(&a, effect, &opened, &err) : command_fail(&cmd_reference, &err);
    opened_finish(&opened);
    pipeline_args_finish(&a.pipeline);
    free(cache);
    return status;
}

const struct command cmd_reference = {
    .name = "reference",
    .arguments = "F -o RUN",
    .summary = "trace the converged reflection from the data of a capture",
    .description =
        "Traces many rays per pixel over the whole lobe of each surface, in fine steps, and reports the remaining "
        "noise: the rays are traced as two halves without common random numbers, and the noise is their difference. "
        "The difference between a preset and the reference is the error of the preset's algorithms. The difference "
        "between the reference and the truth, if the capture contains it, is due to information that is missing in "
        "the capture. The truth has no fog: to compare with it, trace the reference with --set pipeline.fog=false, "
        "and use the same setting in glint replay --against both=RUN.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_reference_parse,
    .examples = examples,
    .run = cmd_reference_run,
};
