/* glint info: shows the contents of captures, runs and other EXR files. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command.h"
#include "options/args.h"
#include "capture/camera_facts.h"
#include "capture/damaged.h"
#include "capture/missing.h"
#include "capture/depth_facts.h"
#include "capture/info_light.h"
#include "capture/info_tables.h"
#include "io/pipe.h"
#include "io/progress.h"
#include "io/table.h"

struct arguments {
    const char *path;
    bool json, headers, survey;
};

enum { KEY_HEADERS = 256, KEY_SURVEY };

static const struct argp_option options[] = {
    {"headers", KEY_HEADERS, NULL, 0,
     "Read no pixels: no ranges and no survey. Of a damaged file, or a capture that breaks rules of the format, what "
     "can be "
     "read is listed, and where it breaks; the exit status is 1",
     0},
    {"survey", KEY_SURVEY, NULL, 0,
     "Print only the survey, which counts on the device what the pixels of a capture need", 0},
    {"json", 'j', NULL, 0, "Print JSON", 0},
    {0},
};
static const struct example examples[] = {
    {"glint info street.exr", "lists parts, channels with ranges, camera and cube maps"},
    {"glint info street.exr --survey", "shows the figures that a plan is based on"},
    {"glint info run", "lists the images of a run; with --json prints its run.json"},
    {"glint info run/05-cubemap_trace.exr", "lists parts and ranges of any EXR file"},
    {"glint info street.exr --json | jq .camera.position", "prints one value for a script"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(ARGP_KEY_ARG, struct arguments, path),
    STORED('j', struct arguments, json),
    STORED(KEY_HEADERS, struct arguments, headers),
    STORED(KEY_SURVEY, struct arguments, survey),
    {0},
};

static json_t *channels_json(const struct channel_table *all, const char *part) {
    json_t *list = json_array();
    for (size_t i = 0; i < all->count; i++) {
        const struct channel_row *row = &all->rows[i];
        if (strcmp(row->part, part) != 0) continue;
        json_t *channel = json_pack("{s:s, s:s, s:s, s:s, s:s}", "name", row->channel, "stored", row->stored, "storage",
                                    row->storage, "encoding", row->encoding, "unit", row->unit);
        const struct channel_stats *s = &row->stats;
        if (row->has_stats)
            json_object_set_new(channel, "range",
                                json_pack("{s:I, s:o, s:o, s:o, s:I, s:I}", "values", (json_int_t)s->count, "min",
                                          json_number(s->min), "max", json_number(s->max), "mean",
                                          json_number(stats_mean(s)), "nan", (json_int_t)s->nan, "inf",
                                          (json_int_t)s->inf));
        json_array_append_new(list, channel);
    }
    return list;
}

static json_t *camera_json(const struct glint_frame *frame) {
    const struct camera_facts c = camera_facts(frame);
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:s}", "position", json_numbers(c.position, 3), "forward",
                     json_numbers(c.forward, 3), "fov_x_deg", json_number(c.fov_x_deg), "fov_y_deg",
                     json_number(c.fov_y_deg), "near", json_number(c.near), "far", json_number(c.far), "up",
                     axis_name(frame->up));
}

/* A level with the roughness that it is for, and where the probe is. */
static json_t *probe_json(const struct glint_capture *capture, const struct glint_part_info *part) {
    const struct glint_part_info *levels[GLINT_MAX_LEVELS];
    double roughness[GLINT_MAX_LEVELS];
    const struct glint_probe *probe = &part->probe;
    glint_capture_probe(capture, part->index, levels, roughness);
    json_t *json = json_pack("{s:i, s:f}", "level", (int)part->level, "roughness", roughness[part->level]);
    if (probe->has_ground) json_object_set_new(json, "ground_deg", json_real(probe->ground));
    if (probe->has_box)
        json_object_update_new(json,
                               json_pack("{s:o, s:o, s:o}", "center", json_numbers(probe->box.center, 3), "box_min",
                                         json_numbers(probe->box.min, 3), "box_max", json_numbers(probe->box.max, 3)));
    return json;
}

static json_t *part_json(const struct glint_capture *capture, const struct glint_part_info *part,
                         const struct channel_table *all) {
    json_t *json =
        json_pack("{s:s, s:s?, s:I, s:I, s:b, s:o}", "name", part->name, "role", part->role ? part->role->name : NULL,
                  "width", (json_int_t)part->width, "height", (json_int_t)part->height, "previous", part->previous,
                  "channels", channels_json(all, part->name));
    if (part->sibling[0]) json_object_set_new(json, "sibling", json_string(part->sibling));
    if (part->has_cubemap)
        json_object_set_new(
            json, "cubemap",
            json_pack("{s:o, s:b, s:f, s:s, s:I}", "center", json_numbers(part->cubemap.center, 3), "outdoor",
                      part->cubemap.outdoor, "fade", part->cubemap.fade > 0 ? part->cubemap.fade : 1.0, "inner",
                      cubemap_volume_name(part->cubemap.inner), "age_frames", (json_int_t)part->cubemap.age_frames));
    if (part->has_probe) json_object_set_new(json, "probe", probe_json(capture, part));
    light_part_json(part, json);
    if (part->sky.has_ground) json_object_set_new(json, "ground_deg", json_real(part->sky.ground));
    return json;
}

static json_t *survey_json(const struct glint_survey *survey) {
    json_t *bins = json_array();
    for (int i = 0; i < GLINT_SURVEY_BINS; i++)
        json_array_append_new(bins, json_integer((json_int_t)survey->reflecting.by_roughness[i]));
    return json_pack("{s:I, s:I, s:I, s:o}", "pixels", (json_int_t)survey->pixels, "sky", (json_int_t)survey->sky,
                     "reflecting", (json_int_t)survey->reflecting.count, "roughness", bins);
}

/* `survey` is NULL when no pixel was read. */
static enum status print_capture(const struct arguments *a, struct glint_capture *capture,
                                 const struct channel_table *all, const struct glint_survey *survey) {
    const struct glint_frame *frame = glint_capture_frame(capture);
    if (a->json) {
        const struct depth_facts depth = depth_facts(capture);
        struct glint_error err = {0};
        json_t *parts = json_array(), *carries = survey ? carries_json(capture, &err) : NULL;
        if (survey && !carries) return json_decref(parts), command_fail(&cmd_info, &err);
        for (size_t i = 0; i < glint_capture_part_count(capture); i++)
            json_array_append_new(parts, part_json(capture, glint_capture_part(capture, i), all));
        return print_json(
            json_pack("{s:s, s:b, s:I, s:o, s:o, s:o, s:b, s:b, s:b, s:b, s:o, s:f, s:o, s:o*, s:o, s:o*, s:o*}",
                      "file", a->path, "capture", 1, "frame", (json_int_t)frame->number, "camera", camera_json(frame),
                      "depth", depth_facts_json(&depth), "parts", parts, "has_previous", frame->has_previous, "fog",
                      frame->has_fog, "atmosphere", frame->has_atmosphere, "clouds", frame->has_clouds, "jitter_px",
                      json_numbers(frame->jitter_px, 2), "metres_per_unit",
                      frame->metres_per_unit > 0 ? frame->metres_per_unit : 1.0, "notes", frame_notes_json(frame),
                      "sun", sun_json(frame), "lights", lights_json(frame), "survey",
                      survey ? survey_json(survey) : NULL, "presets", carries));
    }
    struct stat file = {0};
    stat(glint_capture_path(capture), &file);
    printf("%s: capture, %s\n", name_text(a->path), bytes_text((uint64_t)file.st_size));
    info_print_camera(frame);
    if (survey) info_print_survey(survey);
    putchar('\n');
    info_print_parts(capture);
    putchar('\n');
    info_print_channels(all);
    info_print_depth(capture);
    info_print_cubemaps(capture);
    info_print_probes(capture);
    info_print_light(capture);
    struct glint_error err = {0};
    return !survey || carries_print(capture, &err) ? STATUS_DONE : command_fail(&cmd_info, &err);
}

static json_t *parts_json(const struct glint_exr *exr, const struct channel_table *all) {
    json_t *parts = json_array();
    for (size_t i = 0; i < glint_exr_part_count(exr); i++) {
        const struct glint_exr_part_info *part = glint_exr_part(exr, i);
        json_array_append_new(parts, json_pack("{s:s, s:I, s:I, s:o}", "name", part->name, "width",
                                               (json_int_t)part->width, "height", (json_int_t)part->height, "channels",
                                               channels_json(all, part->name)));
    }
    return parts;
}

static enum status print_exr(const struct arguments *a, const struct glint_exr *exr, const struct channel_table *all) {
    size_t count = glint_exr_part_count(exr);
    if (a->json)
        return print_json(json_pack("{s:s, s:b, s:o}", "file", a->path, "capture", 0, "parts", parts_json(exr, all)));
    printf("%s: an EXR file, not a capture, %zu part%s\n\n", name_text(a->path), count, count == 1 ? "" : "s");
    info_print_channels(all);
    return STATUS_DONE;
}

/* A file without a G-buffer is listed as any EXR file; one with a G-buffer must be a valid capture. NULL: neither. */
static struct glint_exr *open_exr(const char *path, bool *is_capture, struct glint_error *err) {
    struct glint_exr *exr = glint_exr_open(path, NULL, err);
    *is_capture = false;
    for (size_t i = 0; exr && i < glint_exr_part_count(exr) && !*is_capture; i++)
        *is_capture = !strcmp(glint_exr_part(exr, i)->name, "gbuffer");
    if (*is_capture) glint_exr_close(&exr);
    return exr;
}

/* With --json, a run is described by its run.json. */
static enum status print_run(const struct arguments *a) {
    struct glint_error err = {0};
    struct glint_run *run = glint_run_open(a->path, &err);
    if (!run) return command_fail(&cmd_info, &err);
    if (a->json) printf("%s\n", glint_run_json(run));
    else {
        printf("%s: a run, %zu images\n\n", name_text(a->path), glint_run_image_count(run));
        info_print_run(run);
    }
    glint_run_close(&run);
    return STATUS_DONE;
}

/* The survey of cube maps and of the faces that rays may reach depends on the passes; the default pipeline is used. */
static bool survey_cubemaps(struct glint_replay *replay, struct glint_error *err) {
    const struct glint_plan_entry *entries;
    size_t count;
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia3", err);
    const bool ok = pipeline && glint_replay_plan(replay, pipeline, NULL, &entries, &count, err);
    glint_pipeline_destroy(&pipeline);
    return ok;
}

static enum status print_survey(const struct arguments *a, struct glint_capture *capture, struct glint_error *err) {
    const struct glint_survey *survey;
    struct glint_time time;
    char *text = NULL;
    struct glint_device *device = glint_device_create(&(struct glint_device_options){0}, err);
    struct glint_replay *replay = device ? glint_replay_create(device, err) : NULL;
    bool ok = replay && glint_replay_load(replay, capture, err) && glint_replay_survey(replay, &survey, &time, err) &&
              survey_cubemaps(replay, err);
    if (ok && a->json) ok = (text = glint_replay_survey_json(replay, err)) != NULL;
    if (text) puts(text);
    else if (ok) info_print_whole_survey(survey, &time, glint_capture_frame(capture));
    free(text);
    glint_replay_destroy(&replay);
    glint_device_destroy(&device);
    return ok ? STATUS_DONE : command_fail(&cmd_info, err);
}

static enum status survey_of(const struct arguments *a) {
    struct glint_error err = {0};
    struct pipe pipe;
    const char *path = pipe_input(&pipe, a->path, &err);
    struct glint_capture *capture = path ? glint_capture_open(path, NULL, &err) : NULL;
    enum status status = capture ? print_survey(a, capture, &err) : command_fail(&cmd_info, &err);
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    return status;
}

/* ---- Files that cannot be opened ---- */

/* A whole EXR file that is no valid capture. */
static enum status print_invalid(const struct arguments *a, const struct glint_exr *exr,
                                 const struct channel_table *all, const struct glint_error *why) {
    if (a->json) {
        print_json(json_pack("{s:s, s:b, s:s, s:o}", "file", a->path, "capture", 0, "fault", why->message, "parts",
                             parts_json(exr, all)));
    } else {
        printf("%s: not a valid capture, %zu parts\n\n", name_text(a->path), glint_exr_part_count(exr));
        info_print_channels(all);
        putchar('\n');
    }
    command_note(&cmd_info, "%s; glint validate lists every violation", why->message);
    return STATUS_CHECK;
}

static enum status print_damaged(const struct arguments *a, const char *path, const struct glint_error *why) {
    struct glint_error err = *why;
    struct damaged damaged;
    enum status status = STATUS_CHECK;
    if (!damaged_read(&damaged, path, &err)) return command_fail(&cmd_info, &err);
    if (a->json) {
        print_json(json_pack("{s:s, s:b, s:s, s:s, s:o}", "file", a->path, "capture", 0, "fault", why->message,
                             "breaks_at", damaged.fault, "parts", damaged_json(&damaged)));
        command_note(&cmd_info, "%s", why->message);
    } else {
        printf("%s: damaged, %zu part%s\n\n", name_text(a->path), damaged.count, damaged.count == 1 ? "" : "s");
        damaged_print(&damaged);
        fflush(stdout);
        status = command_fail(&cmd_info, why);
    }
    damaged_finish(&damaged);
    return status;
}

/* What --headers shows of a file that is no valid capture or no whole EXR file. */
static enum status print_broken(const struct arguments *a, const char *path, const struct glint_error *why) {
    struct glint_error err = {0};
    struct channel_table all = {0};
    struct progress progress;
    if (!path || (why->code != GLINT_ERROR_FORMAT && why->code != GLINT_ERROR_UNSUPPORTED))
        return command_fail(&cmd_info, why);
    struct glint_exr *exr = glint_exr_open(path, NULL, NULL);
    if (!exr) return print_damaged(a, path, why);
    progress_begin(&progress);
    const bool ok = channels_of_exr(&all, exr, false, progress_report, &progress, &err);
    progress_end(&progress);
    const enum status status = ok ? print_invalid(a, exr, &all, why) : command_fail(&cmd_info, &err);
    channel_table_finish(&all);
    glint_exr_close(&exr);
    return status;
}

/* A file that is damaged can still be looked into. */
static enum status fail(const struct arguments *a, const char *path, struct glint_error *err) {
    if (a->headers) return print_broken(a, path, err);
    const size_t used = strlen(err->message);
    if (path && (err->code == GLINT_ERROR_FORMAT || err->code == GLINT_ERROR_UNSUPPORTED))
        snprintf(err->message + used, sizeof err->message - used, "; --headers lists what can be read");
    return command_fail(&cmd_info, err);
}

static enum status cmd_info_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_info, argc, argv, &a);
    struct stat file;
    if (stat(a.path, &file) == 0 && S_ISDIR(file.st_mode)) return print_run(&a);
    if (a.survey) return survey_of(&a);
    struct glint_error err = {0};
    struct channel_table all = {0};
    struct glint_survey survey = {0};
    struct progress progress;
    struct glint_capture *capture = NULL;
    struct glint_exr *exr = NULL;
    struct pipe pipe;
    bool ok = false, is_capture = false;
    progress_begin(&progress);
    const char *path = pipe_input(&pipe, a.path, &err);
    if (path) exr = open_exr(path, &is_capture, &err);
    if (is_capture) {
        capture = glint_capture_open(path, NULL, &err);
        ok = capture && channels_of_capture(&all, capture, !a.headers, progress_report, &progress, &err) &&
             (a.headers || glint_survey_capture(capture, &survey, &err));
    } else {
        ok = exr && channels_of_exr(&all, exr, !a.headers, progress_report, &progress, &err);
    }
    progress_end(&progress);
    enum status status = !ok       ? fail(&a, path, &err)
                         : capture ? print_capture(&a, capture, &all, a.headers ? NULL : &survey)
                                   : print_exr(&a, exr, &all);
    channel_table_finish(&all);
    glint_capture_close(&capture);
    glint_exr_close(&exr);
    pipe_finish(&pipe);
    return status;
}

const struct command cmd_info = {
    .name = "info",
    .arguments = "F|RUN",
    .summary = "show the contents of a capture, a run or any EXR file",
    .description =
        "Prints the camera of a capture, the survey of its pixels (sky, reflecting pixels, roughness), its parts, "
        "its channels with type, encoding, unit and range, and its cube maps; then what each preset can do with it, "
        "what "
        "it lacks, and which preset that would help. Where depth marks sky or no surface, "
        "other channels of the part may contain anything, so their ranges cover surfaces only. Any other EXR file is "
        "listed with its parts.",
    .options = options,
    .targets = targets,
    .operand = "file",
    .examples = examples,
    .run = cmd_info_run,
};
