/* What there is to choose from: answers /api/v1/registry. */
#include <string.h>

#include "draw/view/falsecolor.h"
#include "draw/view/ocio.h"
#include "live/answers.h"
#include "options/args.h"
#include "options/pass_json.h"

static json_t *captures_json(const struct live *live, struct glint_error *err) {
    json_t *list = json_array();
    for (size_t i = 0; i < live->count; i++) {
        const struct live_frame *frame = &live->frames[i];
        json_t *truths = json_array();
        size_t count;
        const struct glint_effect *effects = glint_effects(&count);
        struct glint_capture *capture = glint_capture_open(frame->path, NULL, err);
        if (!capture) return json_decref(truths), json_decref(list), NULL;
        for (size_t e = 0; e < count; e++) {
            bool has = false;
            for (size_t p = 0; !effects[e].no_truth && p < glint_capture_part_count(capture); p++)
                has |= !strncmp(glint_capture_part(capture, p)->name, effects[e].truth, strlen(effects[e].truth));
            if (has) json_array_append_new(truths, json_string(effects[e].name));
        }
        glint_capture_close(&capture);
        json_array_append_new(
            list, json_pack("{s:s, s:s, s:I, s:b, s:[II], s:[II], s:o}", "name", base_name(frame->path), "path",
                            frame->path, "frame", (json_int_t)frame->number, "cut", frame->cut, "size",
                            (json_int_t)frame->width, (json_int_t)frame->height, "draft",
                            ((json_int_t)frame->width + 1) / 2, ((json_int_t)frame->height + 1) / 2, "truth", truths));
    }
    return list;
}

static json_t *metrics_json_list(void) {
    json_t *list = json_array();
    const struct glint_metric_info *info;
    for (size_t k = 0; (info = glint_metric(k)); k++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:b}", "name", info->name, "title", info->title, "help",
                                              info->what, "higher_is_better", info->higher_is_better));
    return list;
}

struct views {
    json_t *displays;
    const char *display, *view; /* texts of `displays` */
};
static void add_view(void *user, const char *display, const char *view, bool preferred) {
    struct views *views = user;
    const size_t count = json_array_size(views->displays);
    json_t *last = count ? json_array_get(views->displays, count - 1) : NULL;
    const char *name = json_string_value(json_object_get(last, "name"));
    if (!name || strcmp(name, display) != 0) {
        last = json_pack("{s:s, s:[]}", "name", display, "views");
        json_array_append_new(views->displays, last);
    }
    json_t *text = json_string(view);
    json_array_append_new(json_object_get(last, "views"), text);
    if (!preferred) return;
    views->display = json_string_value(json_object_get(last, "name"));
    views->view = json_string_value(text);
}

static json_t *pipeline_parameters(void) {
    return json_pack("[{s:s, s:s, s:s, s:s, s:s, s:i, s:i, s:i}]", "name", "pipeline.rays", "type", "int", "unit",
                     "rays a pixel", "source", "glint", "help",
                     "Rays that are traced for each texel; the images that they accumulate become the mean", "default",
                     1, "lowest", 1, "highest", 1024);
}

static json_t *presets_json(const struct live *live) {
    json_t *list = json_array();
    for (size_t i = 0; live->presets[i]; i++)
        json_array_append_new(list, json_pack("{s:s, s:s}", "name", live->presets[i], "title", live->presets[i]));
    return list;
}

json_t *live_registry(const struct live *live, struct glint_error *err) {
    size_t pass_count, effect_count;
    const struct glint_pass *passes = glint_passes(&pass_count);
    const struct glint_effect *effects = glint_effects(&effect_count);
    const struct glint_device_info *device = glint_device_get_info(live->device);
    struct views views = {.displays = json_array()};
    json_t *pass_list = json_array(), *effect_list = json_array(), *kinds = json_array();
    for (size_t i = 0; i < pass_count; i++) json_array_append_new(pass_list, pass_json(&passes[i]));
    for (size_t i = 0; i < effect_count; i++) json_array_append_new(effect_list, effect_json(&effects[i]));
    for (size_t i = 0; kind_names[i]; i++) json_array_append_new(kinds, json_string(kind_names[i]));
    json_t *start = ocio_list(NULL, add_view, &views, err) ? state_of_arguments(live->args, err) : NULL;
    json_t *registry =
        json_pack("{s:i, s:s, s:{s:s, s:s, s:s, s:b}, s:o, s:o, s:o, s:o, s:o, s:o, s:s, s:o, s:s?, s:s?, s:o, s:s?, "
                  "s:o*, s:b, s:i}",
                  "version", 1, "tool", GLINT_VERSION, "device", "name", device->name, "type", device->type, "driver",
                  device->driver_version, "cpu", device->is_cpu, "captures", captures_json(live, err), "presets",
                  presets_json(live), "effects", effect_list, "passes", pass_list, "pipeline", pipeline_parameters(),
                  "metrics", metrics_json_list(), "metric", glint_metric(GLINT_METRIC_RMSE)->name, "kinds", kinds,
                  "display", views.display, "view", views.view, "displays", views.displays, "reference",
                  live->reference, "start", start, "out", live->out != NULL, "rounds", 5);
    if (registry && start) return registry;
    json_decref(registry);
    if (!err->message[0]) fail_memory(err);
    return NULL;
}

void live_answer_registry(void *user, const struct http_request *request, struct http_answer *answer) {
    const struct live *live = user;
    (void)request;
    answer_json(answer, json_incref(live->registry));
}
