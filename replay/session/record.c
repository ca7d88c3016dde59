/* run.json without files. It is made when the run ends, since the caller owns the pipeline and the options. */
#include "session.h"

#include <string.h>

static json_t *parameter_record(const struct glint_row *row, double value) {
    if (row->choices) return json_string(row->choices[(size_t)value]);
    if (row->type == GLINT_VALUE_BOOL) return json_boolean(value != 0);
    return row->type == GLINT_VALUE_FLOAT ? json_real(value) : json_integer((json_int_t)value);
}

/* The items of lists are counted when the record is written. */
static json_t *work_record(const struct run *run, size_t p) {
    const struct step *step = &run->steps[p];
    const uint64_t rays = pass_rays(run->graph, &run->graph->passes[p]);
    json_t *work =
        json_pack("{sIsI}", "texels", (json_int_t)(step->texels * rays), "of", (json_int_t)run->plan->whole[p].texels);
    for (size_t d = 0; d < step->dispatch_count; d++) {
        if (!step->dispatches[d].list || step->dispatches[d].tiles != ALL_TILES) continue;
        if (!json_object_get(work, "lists")) json_object_set_new(work, "lists", json_object());
        json_object_set_new(json_object_get(work, "lists"), step->dispatches[d].list->image.name, json_null());
    }
    return work;
}

static json_t *pass_record(const struct results *results, const struct run *run, size_t p) {
    const struct graph_pass *pass = &run->graph->passes[p];
    const struct glint_pass_result *result = &results->passes[p];
    json_t *object = json_object(), *parameters = json_object();
    for (size_t r = 0; r < pass->pass->row_count; r++)
        if (glint_row_is_parameter(&pass->pass->rows[r]))
            json_object_set_new(parameters, pass->pass->rows[r].name,
                                parameter_record(&pass->pass->rows[r], pass->entry->values[r]));
    json_object_set_new(object, "slot", json_string(pass->pass->slot));
    json_object_set_new(object, "variant", json_string(pass->pass->variant));
    json_object_set_new(object, "ran", json_boolean(pass->runs));
    json_object_set_new(object, "reason", json_string(result->reason));
    json_object_set_new(object, "cached", json_boolean(result->cached));
    if (pass->cached_work) json_object_set_new(object, "cached_work", json_true());
    if (!pass->pass->host) {
        const uint64_t rays = pass_rays(run->graph, pass);
        json_object_set_new(object, "dispatches", json_integer((json_int_t)(run->steps[p].dispatch_count * rays)));
        json_object_set_new(object, "work", work_record(run, p));
    }
    if (pass->pass->host) json_object_set_new(object, "host", json_true());
    const char *shader = pass->entry->shader ? pass->entry->shader : run->steps[p].spirv.from;
    if (shader) json_object_set_new(object, "shader", json_string(shader));
    json_object_set_new(object, "parameters", parameters);
    json_object_set_new(object, "images", json_array());
    json_object_set_new(object, "time_ns", time_record(&result->time));
    return object;
}

static json_t *device_record(const struct glint_device_info *info) {
    return json_pack("{ssssssssss}", "name", info->name, "type", info->type, "driver", info->driver, "driver_version",
                     info->driver_version, "times_are", info->is_cpu ? "CPU times of a software device" : "GPU times");
}

/* Whether the run folder of the inputs is a run of this capture. */
static bool inputs_match(const struct run *run) {
    char hash[33];
    json_t *inputs = json_loads(glint_run_json(run->plan->inputs), 0, NULL);
    const char *theirs = json_string_value(json_object_get(json_object_get(inputs, "capture"), "xxh3_128"));
    bool match = theirs && glint_capture_hash(run->source->capture, hash, NULL) && strcmp(theirs, hash) == 0;
    json_decref(inputs);
    return match;
}

static json_int_t history_number(const struct glint_run *history) {
    json_t *root = json_loads(glint_run_json(history), 0, NULL);
    const json_int_t number = json_integer_value(json_object_get(root, "frame"));
    json_decref(root);
    return number;
}

static bool makes_diagnostics(const struct run *run) {
    for (size_t i = 0; i < run->graph->image_count; i++)
        if (run->graph->images[i].row->kind == GLINT_ROW_DIAGNOSTIC && run->graph->images[i].source == SOURCE_MADE)
            return true;
    return false;
}

static json_t *warnings_record(const struct run *run) {
    json_t *list = json_array();
    for (size_t i = 0; i < run->graph->image_count; i++) {
        const struct graph_image *image = &run->graph->images[i];
        if (image->source == SOURCE_FALLBACK && image->row->kind == GLINT_ROW_CAPTURE)
            json_array_append_new(list, json_sprintf("the capture has no %s: %s holds its fallback value, %g",
                                                     image->row->role, image->name, image->row->fallback));
    }
    if (run->options->diagnostics && !makes_diagnostics(run))
        json_array_append_new(list, json_string("diagnostics were asked for, but no pass that runs makes any"));
    if (run->plan->inputs && !inputs_match(run))
        json_array_append_new(list, json_sprintf("%s was made from another capture", run->options->inputs));
    const struct glint_frame *frame = glint_capture_frame(run->source->capture);
    if (run->plan->history && history_number(run->plan->history) + 1 != (json_int_t)frame->number)
        json_array_append_new(list, json_sprintf("%s holds frame %lld, but this is frame %u", run->options->history,
                                                 (long long)history_number(run->plan->history), frame->number));
    if (run->sizes->history && !frame->has_previous)
        json_array_append_new(
            list, json_string("the capture has no camera of the previous frame: the camera counts as still"));
    char notes[GLINT_NOTES][GLINT_NOTE_LENGTH];
    for (size_t i = 0, count = glint_frame_notes(frame, notes); i < count; i++)
        json_array_append_new(list, json_string(notes[i]));
    const char *last = NULL;
    uint32_t messages = glint_device_messages(run->engine->device, &last);
    if (messages) json_array_append_new(list, json_sprintf("%u validation messages, the last: %s", messages, last));
    return list;
}

static json_t *faces_record(const struct glint_cube_faces *faces) {
    return json_pack("{s[II]s[II]}", "uploaded", (json_int_t)faces->uploaded, (json_int_t)faces->uploaded_of,
                     "filtered", (json_int_t)faces->filtered, (json_int_t)faces->filtered_of);
}

json_t *run_record(const struct glint_replay *replay, const struct run *run) {
    const struct glint_replay_options *options = run->options;
    const struct glint_frame *frame = glint_capture_frame(run->source->capture);
    json_t *root = json_object(), *passes = json_array();
    json_object_set_new(root, "format", json_integer(1));
    json_object_set_new(root, "tool", json_pack("{ssss}", "name", "glint", "version", GLINT_VERSION));
    json_object_set_new(root, "device", device_record(&run->gpu->info));
    json_object_set_new(root, "frame", json_integer((json_int_t)frame->number));
    json_object_set_new(root, "rays", json_integer((json_int_t)glint_pipeline_rays(run->plan->pipeline)));
    json_object_set_new(root, "first_ray", json_integer((json_int_t)run->plan->pipeline->first_ray));
    json_object_set_new(root, "preset", json_string(run->plan->pipeline->name));
    json_object_set_new(root, "resolution",
                        json_pack("{s[ii]s[ii]}", "full", (int)run->sizes->full[0], (int)run->sizes->full[1], "half",
                                  (int)run->sizes->half[0], (int)run->sizes->half[1]));
    json_object_set_new(root, "precision", json_string(options->float_precision ? "float" : "half"));
    json_object_set_new(root, "diagnostics", json_boolean(options->diagnostics));
    json_object_set_new(root, "inputs", options->inputs ? json_string(options->inputs) : json_null());
    json_object_set_new(root, "history", options->history ? json_string(options->history) : json_null());
    json_object_set_new(root, "active_cubemaps", json_integer((json_int_t)run->sizes->active));
    json_object_set_new(root, "cube_faces", faces_record(&run->plan->faces));
    json_object_set_new(root, "all", json_boolean(options->all));
    json_object_set_new(root, "survey",
                        replay->planner.survey.done && !options->all ? survey_record(&replay->planner.survey, frame)
                                                                     : json_null());
    for (size_t p = 0; p < run->graph->pass_count; p++)
        json_array_append_new(passes, pass_record(&replay->results, run, p));
    json_object_set_new(root, "passes", passes);
    json_object_set_new(root, "warnings", warnings_record(run));
    return root;
}
