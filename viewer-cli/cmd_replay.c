/* glint replay: runs the passes on captures, writes every image and prints the time of each pass. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "replay/against.h"
#include "options/pass_names.h"
#include "io/pipe.h"
#include "options/pipeline_args.h"
#include "io/progress.h"
#include "report/report.h"
#include "replay/shot.h"
#include "io/table.h"
#include "watch/watch.h"

struct arguments {
    struct pipeline_args pipeline;
    struct list captures;
    const char *out, *cache;
    bool json, watch;
    struct against against;
};

enum { KEY_REPEAT = 256, KEY_WARMUP, KEY_PRECISION, KEY_DIAGNOSTICS, KEY_NO_CACHE, KEY_AGAINST, KEY_WATCH };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",      'o',             "RUN",  0, "Run folder to write: run.json and one EXR file per pass. With several captures, RUN/NAME for each in their order; "
        "frames that an interrupted replay with the same settings completed are kept. Without -o nothing is written; passes are "
        "only timed", 0},
    PIPELINE_OPTIONS,
    {"repeat",      KEY_REPEAT,      "N",    0, "Timed rounds after the warm-up (default: one round without warm-up)", 0},
    {"warmup",      KEY_WARMUP,      "N",    0, "Warm-up rounds before the timed rounds of --repeat (default 1)", 0},
    {"precision",   KEY_PRECISION,   "half|float", 0, "Format of images that are declared as half: half (default) or float", 0},
    {"diagnostics", KEY_DIAGNOSTICS, NULL,   0, "Also write the end reason, steps and fetches of each ray for all passes that run. All other images keep their bits", 0},
    {"no-cache",    KEY_NO_CACHE,    NULL,   0, "Run every pass even if nothing changed, and every frame even if it is complete", 0},
    CACHE_OPTION("results for cube maps", ". Not used with --no-cache and --repeat"),
    {"against",     KEY_AGAINST,     "truth|reference|both", 0, "Compare with a better solution. truth: the path-traced result of each effect in the capture (truth.*), for reflections mirror rays, too; turns on "
        "--diagnostics; use downsample.jitter=false to compare rays. reference: the preset reference on the same capture; "
        "reference=RUN: a run of glint reference. both (or both=RUN): both, and the difference between truth and reference. The "
        "truth has no fog: with truth, both and a RUN without fog it is left out here, too. With -o the run gets images of the error, "
        "error and flip, and reference_error and reference_flip; EFFECT_ precedes the names if several effects are compared", 0},
    EFFECTS_OPTION,
    METRIC_OPTIONS,
    {"watch",       KEY_WATCH,       NULL,   0, "Replay again whenever the preset file or a shader changes: RUN contains the newest version, RUN/first the first one, "
        "and RUN/watch.html compares both and reloads itself. Shaders that do not compile are ignored until they do. Stop with "
        "Ctrl-C", 0},
    {"json",        'j',             NULL,   0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint replay street.exr -o run", "runs all passes of the preset mafia3 and writes every image"},
    {"glint replay street.exr --repeat 20", "only measures times: median of 20 rounds"},
    {"glint replay street.exr -o run --set screen_trace.cells=64", "changes a parameter"},
    {"glint replay street.exr -o end --passes upscale,compose --inputs run",
     "runs only the end of the pipeline, on the images of another run"},
    {"glint replay street.exr -o run --shader resolve=my.comp --diagnostics", "replaces a shader"},
    {"glint replay street.exr --against truth --set downsample.jitter=false",
     "shows how many rays hit the right point, by end reason"},
    {"glint replay street.exr --against reference", "measures the error against the converged reference"},
    {"glint replay street.exr --against truth --metrics rmse,hdr_flip --ppd 40",
     "chooses metrics, and a shorter viewing distance"},
    {"glint replay street.exr -o run --shader resolve=my.comp --watch",
     "shows in run/watch.html what changes while you edit my.comp"},
    {"glint replay shots/room.0*.exr -o runs",
     "writes one run for each capture, runs/NAME; the same command completes an interrupted call"},
    {0},
};
static const char *const precisions[] = {"half", "float", NULL};

static const struct arg_target targets[] = {
    STORED('o', struct arguments, out),
    STORED('j', struct arguments, json),
    STORED(KEY_EFFECT, struct arguments, against.name),
    STORED_NUMBER(KEY_REPEAT, struct arguments, pipeline.replay.repeat, 1, 100000),
    STORED_NUMBER(KEY_WARMUP, struct arguments, pipeline.replay.warmup, 1, 100000),
    STORED(KEY_DIAGNOSTICS, struct arguments, pipeline.replay.diagnostics),
    STORED(KEY_NO_CACHE, struct arguments, pipeline.replay.no_cache),
    STORED(KEY_CACHE, struct arguments, cache),
    STORED(KEY_WATCH, struct arguments, watch),
    STORED(ARGP_KEY_ARG, struct arguments, captures),
    PIPELINE_TARGETS(struct arguments, pipeline),
    {0},
};

static error_t cmd_replay_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    struct glint_replay_options *r = &a->pipeline.replay;
    switch (key) {
    case KEY_PRECISION:
        r->float_precision = arg_choice("precision", arg, precisions, state) == 1;
        return 0;
    case KEY_AGAINST:
        against_parse(&a->against, arg, state);
        r->diagnostics = r->diagnostics || a->against.truth;
        return 0;
    case ARGP_KEY_END:
        if (a->watch && (!a->out || a->captures.count != 1)) argp_error(state, "--watch needs one capture and -o RUN");
        if (a->watch && (a->json || a->against.truth || a->against.reference))
            argp_error(state, "--watch cannot be combined with --json or --against");
        return 0;
    }
    return metric_args_parse(key, arg, state, &a->against.metrics);
}

struct job {
    const struct arguments *a;
    struct glint_device *device;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
    struct against *against;
    bool before; /* whether a capture was replayed, and its frame number */
    uint32_t number;
    json_t *warned; /* what was, as keys */
    json_t *runs;   /* NULL: print tables */
};

static const char *const phases[] = {"read", "upload", "passes", "readback", "write"};

static double milliseconds(uint64_t ns) {
    return (double)ns * 1e-6;
}

/* NaN, infinite and clamped values of a run. */
struct found {
    const struct glint_bad_values *bad;
    size_t count;
};

static void print_total(struct table *table, const char *what, double ms) {
    table_cell(table, "%s", what);
    table_cell(table, "%s", "");
    table_cell(table, "%.3f", ms);
    for (int k = 0; k < 3; k++) table_cell(table, "%s", "");
}

static void print_passes(const struct glint_pass_result *results, size_t count, bool cold) {
    static const char *const titles[] = {"<slot", "<variant", ">median ms", ">min", ">max", "<", NULL},
                             *const cold_titles[] = {"<slot", "<variant", ">cold ms", ">min", ">max", "<", NULL};
    struct table *table = table_create(cold ? cold_titles : titles);
    double frame = 0, cubes = 0;
    for (size_t i = 0; i < count; i++) {
        const struct glint_pass_result *r = &results[i];
        bool timed = r->ran && r->time.n > 0;
        table_cell(table, "%s", r->pass->slot);
        table_cell(table, "%s", r->pass->variant);
        if (timed) {
            table_cell(table, "%.3f", milliseconds(r->time.median_ns));
            table_cell(table, "%.3f", milliseconds(r->time.min_ns));
            table_cell(table, "%.3f", milliseconds(r->time.max_ns));
            *(r->cached_work ? &cubes : &frame) += milliseconds(r->time.median_ns);
        } else
            for (int k = 0; k < 3; k++) table_cell(table, "%s", "–");
        table_cell(table, "%s",
                   !r->ran          ? r->reason
                   : r->cached      ? "unchanged"
                   : r->pass->host  ? "on the host"
                   : r->cached_work ? "when a cube map changes"
                                    : "");
    }
    print_total(table, cubes > 0 ? "every frame" : "total", frame);
    if (cubes > 0) print_total(table, "cube maps", cubes);
    table_print(table, stdout);
    table_destroy(&table);
}

/* Prints the number of NaN, infinite and clamped values, and where the first of them was written. */
static void print_bad_values(const struct glint_bad_values *bad, size_t count) {
    uint64_t not_finite = 0, clamped = 0;
    size_t made = 0;
    for (size_t i = 0; i < count; i++) not_finite += bad[i].not_finite, clamped += bad[i].clamped;
    if (!count) return;
    while (made < count && !bad[made].pass) made++;
    putchar('\n');
    mark_print(MARK_WARN, "%llu values are NaN or infinite, %llu were clamped to the range of half; images: %zu",
               (unsigned long long)not_finite, (unsigned long long)clamped, count);
    putchar('\n');
    for (size_t i = 0; i < count; i++) {
        if (i != 0 && i != made) continue;
        if (bad[i].pass) printf("first written by the pass %s: ", bad[i].pass->slot);
        else printf("first in the capture: ");
        printf("%s %s at %u,%u: %g\n", bad[i].image, bad[i].channel, bad[i].x, bad[i].y, (double)bad[i].value);
    }
}

static void print_run(const char *capture, const char *folder, const struct comparison *compared,
                      const struct found *found, const struct job *job) {
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(job->replay, &count);
    const struct glint_device_info *device = glint_device_get_info(job->device);
    printf("%s on %s%s\n\n", name_text(capture), name_text(device->name),
           device->is_cpu ? " (a CPU device: times do not represent a GPU)" : "");
    print_passes(results, count, job->a->pipeline.replay.repeat == 0);
    print_bad_values(found->bad, found->count);
    if (job->a->pipeline.replay.repeat == 0)
        puts("cold: one round without warm-up, so times include first-use costs; use --repeat N to measure");
    putchar('\n');
    for (size_t i = 0; i < sizeof phases / sizeof *phases; i++)
        printf("%s%s %s", i ? ", " : "", phases[i], time_text(glint_replay_seconds(job->replay, phases[i])));
    putchar('\n');
    if (folder) printf("run: %s\n", name_text(folder));
    else puts("nothing written (-o RUN keeps the images)");
    for (size_t e = 0; e < job->against->effect_count; e++) {
        if (compared[e].several) printf("\n%s\n", compared[e].effect->title);
        against_print(&compared[e]);
    }
}

static json_t *bad_values_json(const struct found *found) {
    json_t *list = json_array();
    for (size_t i = 0; i < found->count; i++) {
        const struct glint_bad_values *bad = &found->bad[i];
        json_array_append_new(list,
                              json_pack("{s:s, s:s?, s:s, s:i, s:i, s:o, s:I, s:I}", "image", bad->image, "slot",
                                        bad->pass ? bad->pass->slot : NULL, "channel", bad->channel, "x", (int)bad->x,
                                        "y", (int)bad->y, "value", json_number((double)bad->value), "not_finite",
                                        (json_int_t)bad->not_finite, "clamped", (json_int_t)bad->clamped));
    }
    return list;
}

static json_t *run_json(const char *capture, const char *folder, const struct comparison *compared,
                        const struct found *found, const struct job *job) {
    const struct glint_replay *replay = job->replay;
    const struct glint_device_info *device = glint_device_get_info(job->device);
    json_t *passes = json_array(), *seconds = json_object();
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t i = 0; i < count; i++) {
        const struct glint_pass_result *r = &results[i];
        json_array_append_new(passes, json_pack("{s:s, s:s, s:b, s:b, s:b, s:s, s:{s:I, s:I, s:I, s:I, s:b}}", "slot",
                                                r->pass->slot, "variant", r->pass->variant, "ran", r->ran, "cached",
                                                r->cached, "cached_work", r->cached_work, "reason", r->reason,
                                                "time_ns", "n", (json_int_t)r->time.n, "min",
                                                (json_int_t)r->time.min_ns, "median", (json_int_t)r->time.median_ns,
                                                "max", (json_int_t)r->time.max_ns, "cold", r->time.cold));
    }
    for (size_t i = 0; i < sizeof phases / sizeof *phases; i++)
        json_object_set_new(seconds, phases[i], json_number(glint_replay_seconds(replay, phases[i])));
    json_t *run =
        json_pack("{s:s, s:s?, s:{s:s, s:s, s:b}, s:o, s:o}", "capture", capture, "run", folder, "device", "name",
                  device->name, "type", device->type, "cpu", device->is_cpu, "passes", passes, "seconds", seconds);
    json_object_set_new(run, "bad_values", bad_values_json(found));
    for (size_t e = 0; e < job->against->effect_count; e++) against_json(&compared[e], run);
    return run;
}

static void free_folders(char **folders, size_t count) {
    for (size_t i = 0; folders && i < count; i++) free(folders[i]);
    free(folders);
}

/* RUN, or RUN/NAME when there are several captures; malloc'd. NULL when memory is short. */
static char *run_folder(const struct arguments *a, const char *capture) {
    char *folder = NULL;
    const char *base = strrchr(capture, '/') ? strrchr(capture, '/') + 1 : capture;
    size_t length = strlen(base);
    if (length > 4 && !strcmp(base + length - 4, ".exr")) length -= 4;
    int failed = a->captures.count == 1 ? asprintf(&folder, "%s", a->out)
                                        : asprintf(&folder, "%s/%.*s", a->out, (int)length, base);
    return failed < 0 ? NULL : folder;
}

/* Run folders, one for each capture. */
static char **run_folders(const struct arguments *a, struct glint_error *err) {
    char **folders = calloc(a->captures.count, sizeof *folders);
    bool ok = folders != NULL;
    for (size_t i = 0; ok && i < a->captures.count; i++)
        ok = (folders[i] = run_folder(a, a->captures.items[i])) != NULL;
    if (ok) return folders;
    glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    free_folders(folders, a->captures.count);
    return NULL;
}

/* Prints the warnings of the last run, each once a call. */
static void warn(const struct job *job) {
    const char *text;
    for (size_t i = 0; (text = glint_replay_warning(job->replay, i)); i++) {
        if (!json_object_get(job->warned, text)) command_note(&cmd_replay, "%s", text);
        json_object_set_new(job->warned, text, json_true());
    }
}

/* A frame that does not follow the one before it begins without history, which the order of the arguments does not tell. */
static void note_gap(struct job *job, const struct glint_capture *capture, const char *history) {
    const struct glint_frame *frame = glint_capture_frame(capture);
    if (job->before && !history && !frame->cut && frame->number != job->number + 1)
        command_note(&cmd_replay, "%s: frame %u after frame %u: it begins without history", glint_capture_path(capture),
                     frame->number, job->number);
    job->before = true;
    job->number = frame->number;
}

/* `history`: run of the previous frame; NULL: the last replayed capture, if it is the previous frame. */
static bool replay_one(struct job *job, const char *path, const char *folder, const char *history,
                       struct glint_error *err) {
    struct glint_replay_options options = pipeline_args_options(&job->a->pipeline);
    const size_t effects = job->against->effect_count; /* 0: nothing is compared */
    const char *results[EFFECTS_MAX * GLINT_EFFECT_RESULTS + 1];
    options.history = history;
    options.results = against_results(job->against, results);
    struct progress progress;
    struct pipe pipe;
    struct comparison compared[EFFECTS_MAX] = {{.several = false}};
    const char *file = pipe_input(&pipe, path, err);
    struct glint_capture *capture = file ? glint_capture_open(file, NULL, err) : NULL;
    if (!capture) {
        pipe_finish(&pipe);
        return false;
    }
    note_gap(job, capture, history);
    /* Before anything is computed that could not be written. */
    struct glint_run_writer *writer = folder ? glint_run_writer_open(folder, err) : NULL;
    progress_begin(&progress);
    progress_phase(&progress, "replay");
    job->against->progress = progress_report;
    job->against->user = &progress;
    job->against->all = options.all;
    struct found found = {0};
    bool ok = (writer || !folder) && glint_replay_load(job->replay, capture, err) &&
              glint_replay_run(job->replay, job->pipeline, &options, progress_report, &progress, err);
    ok = ok &&
         (!folder || (report_keep_errors(folder, NULL, 0, err) &&
                      glint_replay_write_to(job->replay, writer, progress_report, &progress, err))) &&
         glint_replay_bad_values(job->replay, &found.bad, &found.count, err);
    for (size_t e = 0; ok && e < effects; e++)
        ok = against_compare(job->against, e, job->replay, capture, job->pipeline, &compared[e], err);
    ok = ok &&
         (!effects || !folder ||
          (report_keep_errors(folder, compared, effects, err) && against_write_images(compared, effects, folder, err)));
    progress_end(&progress);
    if (ok) warn(job);
    if (ok && job->runs) json_array_append_new(job->runs, run_json(path, folder, compared, &found, job));
    else if (ok) print_run(path, folder, compared, &found, job);
    for (size_t e = 0; ok && e < effects; e++) ok = against_valid(&compared[e], path, err);
    for (size_t e = 0; e < effects; e++) comparison_finish(&compared[e]);
    glint_run_writer_close(&writer);
    glint_replay_load(job->replay, NULL, NULL);
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    return ok;
}

static void report_kept(const struct job *job, const char *capture, const char *folder) {
    if (job->runs)
        json_array_append_new(job->runs, json_pack("{s:s, s:s, s:b}", "capture", capture, "run", folder, "kept", 1));
    else printf("%s: already complete, kept: %s\n", name_text(capture), name_text(folder));
}

/* Number of complete frames from the first on; frames after an incomplete one depend on it through their history. */
static bool count_kept(const struct job *job, char **folders, size_t *kept, struct glint_error *err) {
    const struct arguments *a = job->a;
    *kept = 0;
    if (!folders || a->captures.count < 2) return true;
    json_t *settings = shot_settings(job->pipeline, &a->pipeline, glint_device_get_info(job->device)->name, err);
    bool ok = settings ? shot_begin(a->out, settings, folders, a->captures.count, err)
                       : !err->code && glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    json_decref(settings);
    bool again = a->pipeline.replay.no_cache || a->pipeline.replay.repeat || a->against.truth || a->against.reference;
    for (bool has = true; ok && !again && has && *kept < a->captures.count; *kept += ok && has)
        ok = shot_has(folders[*kept], a->captures.items[*kept], &has, err);
    return ok;
}

/* Replays all captures even if some fail, but stops after Ctrl-C. */
static enum status replay_all(struct job *job) {
    const struct list *captures = &job->a->captures;
    enum status status = STATUS_DONE;
    struct glint_error err = {0};
    size_t kept = 0;
    char **folders = job->a->out ? run_folders(job->a, &err) : NULL;
    struct glint_folder_lock *lock = NULL; /* on the folder of a shot; that of one run is locked by its writer */
    if ((job->a->out && !folders) ||
        (folders && captures->count > 1 && !(lock = glint_folder_lock(job->a->out, &err))) ||
        !count_kept(job, folders, &kept, &err)) {
        glint_folder_unlock(&lock);
        free_folders(folders, captures->count);
        return command_fail(&cmd_replay, &err);
    }
    for (size_t i = 0; i < kept; i++) report_kept(job, captures->items[i], folders[i]);
    for (size_t i = kept; i < captures->count && status != STATUS_INTERRUPTED; i++) {
        err = (struct glint_error){0};
        const char *history = i == 0 ? job->a->pipeline.replay.history : NULL;
        bool follows = false;
        bool ok = i != kept || i == 0 || shot_follows(folders[i - 1], captures->items[i], &follows, &err);
        if (follows) history = folders[i - 1];
        ok = ok && replay_one(job, captures->items[i], folders ? folders[i] : NULL, history, &err);
        if (!ok) {
            enum status failed = command_fail(&cmd_replay, &err);
            if (failed > status) status = failed;
        }
        if (!job->runs && ok && i + 1 < captures->count) putchar('\n');
    }
    glint_folder_unlock(&lock);
    free_folders(folders, captures->count);
    return status;
}

static enum status cmd_replay_run(int argc, char **argv) {
    struct arguments a = {0};
    metric_args_complete(argc, argv);
    command_parse(&cmd_replay, argc, argv, &a);
    char *cache = pipeline_args_cache(a.cache);
    a.pipeline.replay.cache = cache;
    struct job job = {.a = &a, .against = &a.against, .warned = json_object()};
    struct glint_error err = {0};
    enum status status;
    const bool prepared = against_prepare(&a.against, &a.pipeline.without_fog, &err);
    const char *fogged = a.pipeline.without_fog ? captures_fogged(&a.captures) : NULL;
    a.pipeline.without_fog = fogged != NULL;
    if (prepared && !a.watch) job.pipeline = pipeline_args_create(&a.pipeline, &err);
    if (job.pipeline) pipeline_note_fog(&cmd_replay, job.pipeline, fogged);
    if (job.pipeline && a.out && a.captures.count > 1) shot_keep_history(&a.pipeline.outputs, job.pipeline);
    if (job.pipeline || a.watch) job.device = pipeline_args_device(&a.pipeline, &err);
    if (job.pipeline && job.device) job.replay = glint_replay_create(job.device, &err);
    if (job.device && a.watch) {
        status = watch_run(&(struct watch){&cmd_replay, &a.pipeline, a.captures.items[0], a.out, cache, job.device});
    } else if (job.replay && against_begin(&a.against, job.device, job.pipeline, &a.captures, &err)) {
        if (a.json) job.runs = json_array();
        status = replay_all(&job);
        if (job.runs && print_json(json_pack("{s:o}", "runs", job.runs)) != STATUS_DONE) status = STATUS_CHECK;
    } else status = command_fail(&cmd_replay, &err);
    against_finish(&a.against);
    glint_replay_destroy(&job.replay);
    glint_device_destroy(&job.device);
    glint_pipeline_destroy(&job.pipeline);
    json_decref(job.warned);
    pipeline_args_finish(&a.pipeline);
    list_free(&a.captures);
    free(cache);
    return status;
}

const struct command cmd_replay = {
    .name = "replay",
    .arguments = "F... -o RUN",
    .summary = "run the passes on captures and write every image",
    .description =
        "Runs the passes of a preset on captures and writes every intermediate image into a run folder: run.json and "
        "one EXR file per pass. At the end it prints the time of each pass: median, minimum and maximum of the timed "
        "rounds.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_replay_parse,
    .examples = examples,
    .values = metric_args_values,
    .run = cmd_replay_run,
};
