/* The options of commands that run pipelines. */
#include "options/pipeline_args.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/cache.h"
#include "glint/capture.h"
#include "command.h"
#include "io/console.h"
#include "options/pass_names.h"

void pipeline_args_finish(struct pipeline_args *args) {
    list_free(&args->use);
    list_free(&args->set);
    list_free(&args->shader);
    list_free(&args->passes);
    list_free(&args->outputs);
    list_free(&args->skip);
    list_free(&args->force);
}

static bool check_slots(const struct list *slots, struct glint_error *err) {
    for (size_t i = 0; i < slots->count; i++)
        if (!glint_slot_check(slots->items[i], err)) return false;
    return true;
}

typedef bool (*assign)(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err);

static bool assign_all(struct glint_pipeline *pipeline, const struct list *list, assign set, struct glint_error *err) {
    for (size_t i = 0; i < list->count; i++)
        if (!set(pipeline, list->items[i], err)) return false;
    return true;
}

bool pipeline_args_apply(const struct pipeline_args *args, struct glint_pipeline *pipeline, struct glint_error *err) {
    return assign_all(pipeline, &args->use, glint_pipeline_use, err) &&
           (!args->without_fog || pipeline_fog_off(pipeline, err)) &&
           assign_all(pipeline, &args->set, glint_pipeline_set, err) &&
           assign_all(pipeline, &args->shader, glint_pipeline_shader, err);
}

struct glint_pipeline *pipeline_args_create(const struct pipeline_args *args, struct glint_error *err) {
    for (size_t i = 0; i < args->outputs.count; i++)
        if (!check_image(args->outputs.items[i], err)) return NULL;
    if (!check_slots(&args->passes, err) || !check_slots(&args->skip, err) || !check_slots(&args->force, err))
        return NULL;
    struct glint_pipeline *pipeline = glint_pipeline_create(args->preset ? args->preset : "mafia3", err);
    if (pipeline && !pipeline_args_apply(args, pipeline, err)) glint_pipeline_destroy(&pipeline);
    return pipeline;
}

struct glint_device *pipeline_args_device(const struct pipeline_args *args, struct glint_error *err) {
    return glint_device_create(
        &(struct glint_device_options){.select = args->device, .dispatch_limit_s = args->limit_s}, err);
}

struct glint_replay_options pipeline_args_options(const struct pipeline_args *args) {
    struct glint_replay_options options = args->replay;
    options.passes = list_or_null(&args->passes);
    options.outputs = list_or_null(&args->outputs);
    options.skip = list_or_null(&args->skip);
    options.force = list_or_null(&args->force);
    return options;
}

char *pipeline_args_cache(const char *asked) {
    const char *named = asked ? asked : getenv("GLINT_CACHE");
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    char *folder = NULL;
    int length = 0;
    if (named && strcmp(named, "none") == 0) return NULL;
    if (named && named[0]) length = asprintf(&folder, "%s", named);
    else if (base && base[0] == '/') length = asprintf(&folder, "%s/glint", base);
    else if (home && home[0] == '/') length = asprintf(&folder, "%s/.cache/glint", home);
    if (length <= 0) return NULL;
    const char *refusal = glint_cache_refusal(folder);
    if (!refusal) return folder;
    fprintf(stderr, "glint: no cache is used: %s: %s\n", name_text(folder), refusal);
    free(folder);
    return NULL;
}

/* ---- Fog ---- */

bool pipeline_fog_off(struct glint_pipeline *pipeline, struct glint_error *err) {
    return glint_pipeline_set(pipeline, "pipeline.fog=false", err);
}

bool pipeline_fog(const struct glint_pipeline *pipeline) {
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        const struct glint_row *row = glint_pass_parameter(pass, "fog");
        if (row && glint_pipeline_value(pipeline, pass, row) != 0) return true;
    }
    return false;
}

static bool has_fog(const char *path) {
    struct glint_capture *capture = strcmp(path, "-") != 0 ? glint_capture_open(path, NULL, NULL) : NULL;
    const bool fog = capture && glint_capture_frame(capture)->has_fog;
    glint_capture_close(&capture);
    return fog;
}

const char *captures_fogged(const struct list *captures) {
    const char *unread = NULL;
    for (size_t i = 0; i < captures->count; i++)
        if (has_fog(captures->items[i])) return captures->items[i];
        else if (!strcmp(captures->items[i], "-")) unread = captures->items[i];
    return unread;
}

void pipeline_note_fog(const struct command *command, const struct glint_pipeline *pipeline, const char *fogged) {
    if (!fogged || !strcmp(fogged, "-")) return;
    if (pipeline_fog(pipeline))
        command_note(command, "%s: its fog is applied, and what it is compared with has none", fogged);
    else
        command_note(
            command,
            "%s: its fog is left out, as what it is compared with has none; --set pipeline.fog=true applies it",
            fogged);
}
