/* run.json without files. It is made when the run ends, since the caller owns the pipeline and the options. */
#include "session.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "record.h"

static json_t *parameter_record(const struct glint_row *row, double value) {
    if (row->choices) return json_string(row->choices[(size_t)value]);
    if (row->type == GLINT_VALUE_BOOL) return json_boolean(value != 0);
    return row->type == GLINT_VALUE_FLOAT ? json_real(value) : json_integer((json_int_t)value);
}

static json_t *work_record(const struct run *run, size_t p) {
    return json_pack("{sIsI}", "texels",
                     (json_int_t)(run->steps[p].texels * pass_rays(run->graph, &run->graph->passes[p])), "of",
                     (json_int_t)run->plan->whole[p].texels);
}

/* null also for a path that is not UTF-8. */
static json_t *text_or_null(const char *text) {
    json_error_t fault;
    json_t *string = text ? json_pack_ex(&fault, 0, "s", text) : NULL;
    return string || (text && json_error_code(&fault) != json_error_invalid_utf8) ? string : json_null();
}

static json_t *pass_record(const struct results *results, const struct run *run, size_t p) {
    const struct graph_pass *pass = &run->graph->passes[p];
    const struct glint_pass_result *result = &results->passes[p];
    json_t *parameters = json_object();
    for (size_t r = 0; r < pass->pass->row_count; r++)
        if (glint_row_is_parameter(&pass->pass->rows[r]))
            record_set(&parameters, pass->pass->rows[r].name,
                       parameter_record(&pass->pass->rows[r], pass->entry->values[r]));
    const uint64_t rays = pass_rays(run->graph, pass);
    const char *from = pass->entry->shader ? pass->entry->shader : run->steps[p].spirv.from;
    const bool host = pass->pass->host;
    json_t *dispatches = host ? NULL : json_integer((json_int_t)(run->steps[p].dispatch_count * rays));
    json_t *work = host ? NULL : work_record(run, p), *shader = from ? text_or_null(from) : NULL;
    const bool whole = (host || (dispatches && work)) && (!from || shader);
    json_t *record =
        json_pack("{ss ss sb so sb so* so* so* so* so* so s[] so}", "slot", pass->pass->slot, "variant",
                  pass->pass->variant, "ran", pass->runs, "reason", text_or_null(result->reason), "cached",
                  result->cached, "cached_work", pass->cached_work ? json_true() : NULL, "dispatches", dispatches,
                  "work", work, "host", host ? json_true() : NULL, "shader", json_is_null(shader) ? NULL : shader,
                  "parameters", parameters, "images", "time_ns", time_record(&result->time));
    return record_if(whole, record);
}

static json_t *device_record(const struct glint_device_info *info) {
    return json_pack("{ssssssssss}", "name", info->name, "type", info->type, "driver", info->driver, "driver_version",
                     info->driver_version, "times_are", info->is_cpu ? "CPU times of a software device" : "GPU times");
}

static bool makes_diagnostics(const struct run *run) {
    for (size_t i = 0; i < run->graph->image_count; i++)
        if (run->graph->images[i].row->kind == GLINT_ROW_DIAGNOSTIC && run->graph->images[i].source == SOURCE_MADE)
            return true;
    return false;
}

/* Whether the image is of a role that takes the place of what is missing: nothing is lost without it, but what it replaces. */
static bool takes_place(const struct glint_absence *absence, const struct glint_row *row) {
    return absence->other && !strncmp(row->role, absence->other, strlen(absence->other));
}

/* What the capture does not have and what that costs; images of which nothing is known hold their fallback value. */
static void warn_of_missing(const struct glint_replay *replay, const struct run *run, json_t **list) {
    size_t count;
    const struct glint_absence *all = glint_absences(&count);
    for (size_t i = 0; i < replay->missing_count; i++) {
        const struct glint_absence *missing = replay->missing[i];
        record_append(list, json_sprintf("no %s%s%s: %s", missing->role, missing->channels[0] ? ":" : "",
                                         missing->channels, missing->cost));
    }
    for (size_t i = 0; i < run->graph->image_count; i++) {
        const struct graph_image *image = &run->graph->images[i];
        if (image->source != SOURCE_FALLBACK || image->row->kind != GLINT_ROW_CAPTURE) continue;
        bool known = false;
        for (size_t k = 0; k < count; k++)
            known |= glint_absence_concerns(&all[k], image->row) || takes_place(&all[k], image->row);
        if (!known)
            record_append(list, json_sprintf("the capture has no %s: %s holds its fallback value, %g", image->row->role,
                                             image->name, image->row->fallback));
    }
}

/* null also where what is inserted is not UTF-8. */
GLINT_PRINTF(1, 2)
static json_t *sentence(const char *format, ...) {
    char text[4096];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return text_or_null(text);
}

/* Warns if the run folder of the inputs is a run of another capture. */
static void warn_of_inputs(const struct run *run, json_t **list) {
    char hash[33];
    json_t *inputs = json_loads(glint_run_json(run->plan->inputs), 0, NULL);
    const char *theirs = json_string_value(json_object_get(json_object_get(inputs, "capture"), "xxh3_128"));
    if (!inputs) *list = record_if(false, *list);
    else if (!theirs || !glint_capture_hash(run->source->capture, hash, NULL) || strcmp(theirs, hash) != 0)
        record_append(list, sentence("%s was made from another capture", run->options->inputs));
    json_decref(inputs);
}

static json_t *warnings_record(const struct glint_replay *replay, const struct run *run) {
    json_t *list = json_array();
    warn_of_missing(replay, run, &list);
    if (run->options->diagnostics && !makes_diagnostics(run))
        record_append(&list, json_string("diagnostics were requested, but no pass that runs writes any"));
    if (run->plan->inputs) warn_of_inputs(run, &list);
    const struct glint_frame *frame = glint_capture_frame(run->source->capture);
    if (run->sizes->history && !frame->has_previous)
        record_append(&list, json_string("the capture has no previous camera: the camera is assumed not to move"));
    char notes[GLINT_NOTES][GLINT_NOTE_LENGTH];
    for (size_t i = 0, count = glint_frame_notes(frame, notes); i < count; i++)
        record_append(&list, json_string(notes[i]));
    const char *last = NULL;
    uint32_t messages = glint_device_messages(run->engine->device, &last);
    if (messages) record_append(&list, sentence("%u validation messages, the last: %s", messages, last));
    return list;
}

/* The values of images whose unit is the end reason. */
static json_t *end_reasons_record(void) {
    json_t *list = json_array();
#define REASON(name, text) record_append(&list, json_pack("{ssss}", "name", #name, "text", text));
#include "shared/end_reasons.h"
#undef REASON
    return list;
}

static json_t *matrix_record(const double matrix[16]) {
    json_t *list = json_array();
    for (int i = 0; i < 16; i++) record_append(&list, json_real(matrix[i]));
    return list;
}

static json_t *faces_record(const struct glint_cube_faces *faces) {
    return json_pack("{s[II]s[II]}", "uploaded", (json_int_t)faces->uploaded, (json_int_t)faces->uploaded_of,
                     "filtered", (json_int_t)faces->filtered, (json_int_t)faces->filtered_of);
}

json_t *run_record(const struct glint_replay *replay, const struct run *run) {
    const struct glint_replay_options *options = run->options;
    const struct glint_frame *frame = glint_capture_frame(run->source->capture);
    const uint32_t *full = run->sizes->full, *half = run->sizes->half;
    const bool surveyed = replay->planner.survey.done && !options->all;
    json_t *passes = json_array();
    for (size_t p = 0; p < run->graph->pass_count; p++) record_append(&passes, pass_record(&replay->results, run, p));
    return json_pack(
        "{si s{ssss} so sI s{so so ss} sI sI so s{s[ii]s[ii]} ss sb so so sI so sb so so so so}", "format", 1, "tool",
        "name", "glint", "version", GLINT_VERSION, "device", device_record(&run->gpu->info), "frame",
        (json_int_t)frame->number, "camera", "world_to_view", matrix_record(frame->camera.world_to_view),
        "view_to_clip", matrix_record(frame->camera.view_to_clip), "clip_y",
        frame->clip_y == GLINT_CLIP_Y_DOWN ? "down" : "up", "rays",
        (json_int_t)glint_pipeline_rays(run->plan->pipeline), "first_ray", (json_int_t)run->plan->pipeline->first_ray,
        "preset", text_or_null(run->plan->pipeline->name), "resolution", "full", (int)full[0], (int)full[1], "half",
        (int)half[0], (int)half[1], "precision", options->float_precision ? "float" : "half", "diagnostics",
        options->diagnostics, "inputs", text_or_null(options->inputs), "history", text_or_null(options->history),
        "active_cubemaps", (json_int_t)run->sizes->active, "cube_faces", faces_record(&run->plan->faces), "all",
        options->all, "survey", surveyed ? survey_record(&replay->planner.survey, frame) : json_null(), "passes",
        passes, "end_reasons", end_reasons_record(), "warnings", warnings_record(replay, run));
}
