/* Begins and ends glint live: its captures, its private folder, its threads. */
#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "glint/exr.h"
#include "live/live.h"
#include "options/args.h"

/* The file beside the captures of a shot that holds the cube maps which they share: a pattern for all files of a folder names it, too. */
static bool holds_cubemaps_alone(const char *path) {
    struct glint_exr *exr = glint_exr_open(path, NULL, NULL);
    bool alone = exr && glint_exr_part_count(exr) > 0;
    for (size_t i = 0; alone && i < glint_exr_part_count(exr); i++)
        alone = !strncmp(glint_exr_part(exr, i)->name, "cubemap.", strlen("cubemap."));
    if (exr) glint_exr_close(&exr);
    return alone;
}

static bool check_text(const char *text, struct glint_error *err) {
    json_t *json = text ? json_string(text) : json_null();
    if (!json) return glint_fail(err, GLINT_ERROR_USAGE, "%s: names that are not UTF-8 cannot be told in JSON", text);
    json_decref(json);
    return true;
}

static bool check_list(const struct list *list, struct glint_error *err) {
    for (size_t i = 0; i < list->count; i++)
        if (!check_text(list->items[i], err)) return false;
    return true;
}

/* Answers repeat what the command line says. */
static bool check_texts(const struct live *live, struct glint_error *err) {
    const struct pipeline_args *args = live->args;
    return check_list(live->captures, err) && check_text(live->out, err) && check_text(live->reference, err) &&
           check_text(args->preset, err) && check_text(args->device, err) && check_list(&args->use, err) &&
           check_list(&args->set, err) && check_list(&args->shader, err);
}

static bool read_frame(struct live_frame *frame, const char *path, struct glint_error *err) {
    struct glint_capture *capture = glint_capture_open(path, NULL, err);
    const struct glint_part_info *gbuffer = capture ? glint_capture_find(capture, "gbuffer") : NULL;
    if (capture && !gbuffer) glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing", path);
    if (gbuffer)
        *frame = (struct live_frame){.path = path,
                                     .number = glint_capture_frame(capture)->number,
                                     .cut = glint_capture_frame(capture)->cut,
                                     .width = gbuffer->width,
                                     .height = gbuffer->height};
    glint_capture_close(&capture);
    return gbuffer != NULL;
}

static bool read_frames(struct live *live, struct glint_error *err) {
    const struct list *captures = live->captures;
    if (!(live->frames = calloc(captures->count, sizeof *live->frames))) return fail_memory(err);
    for (size_t i = 0; i < captures->count; i++) {
        if (captures->count > 1 && holds_cubemaps_alone(captures->items[i]))
            command_note(live->command, "%s: cube maps that captures share; left out", captures->items[i]);
        else if (!read_frame(&live->frames[live->count++], captures->items[i], err)) return false;
    }
    return live->count || glint_fail(err, GLINT_ERROR_USAGE, "expected a capture, found files of cube maps alone");
}

/* The preset of the command line first, then the built-in ones. */
static bool list_presets(struct live *live, struct glint_error *err) {
    const char *own = live->args->preset ? live->args->preset : "mafia3";
    size_t count = 0, built_in = 0;
    while (glint_preset(built_in)) built_in++;
    if (!(live->presets = calloc(built_in + 2, sizeof *live->presets))) return fail_memory(err);
    live->presets[count++] = own;
    for (size_t i = 0; i < built_in; i++)
        if (strcmp(glint_preset(i), own) != 0) live->presets[count++] = glint_preset(i);
    return true;
}

static bool make_folder(struct live *live, struct glint_error *err) {
    const char *where = getenv("TMPDIR");
    if (asprintf(&live->folder, "%s/glint-live-XXXXXX", where && where[0] ? where : "/tmp") < 0) {
        live->folder = NULL;
        return fail_memory(err);
    }
    if (mkdtemp(live->folder)) return true;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", live->folder, strerror(errno));
    free(live->folder);
    live->folder = NULL;
    return false;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

void live_remove_folder(const char *folder) {
    if (rmdir(folder) != 0) nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS); /* nftw needs memory */
}

static bool is_ending(void *user) {
    struct live *live = user;
    pthread_mutex_lock(&live->lock);
    const bool ending = live->stopping;
    pthread_mutex_unlock(&live->lock);
    return ending;
}

/* Tells pages when a file of a shader or preset has changed. */
static void *watch(void *user) {
    struct live *live = user;
    while (watch_files_wait(&live->files, is_ending, live)) {
        pthread_mutex_lock(&live->lock);
        live->generation++;
        pthread_mutex_unlock(&live->lock);
        live_say(live, json_pack("{s:s}", "event", "changed"));
    }
    return NULL;
}

static bool start_thread(pthread_t *thread, void *(*work)(void *), struct live *live, struct glint_error *err) {
    const int failed = pthread_create(thread, NULL, work, live);
    return !failed || glint_fail(err, GLINT_ERROR_MEMORY, "cannot start a thread: %s", strerror(failed));
}

bool live_begin(struct live *live, struct glint_error *err) {
    struct state state = {0};
    pthread_mutex_init(&live->lock, NULL);
    pthread_mutex_init(&live->converting, NULL);
    pthread_cond_init(&live->wake, NULL);
    pthread_cond_init(&live->changed, NULL);
    if (!check_texts(live, err) || !read_frames(live, err) || !list_presets(live, err) || !make_folder(live, err) ||
        !(live->times = json_object()) || !(live->device = pipeline_args_device(live->args, err)) ||
        !(live->registry = live_registry(live, err)))
        return false;
    /* What the command line says is checked before there is an address. */
    const bool ok = state_read(&state, live, json_object_get(live->registry, "start"), err) &&
                    json_object_set(live->registry, "start", state.json) == 0;
    state_finish(&state);
    return ok && watch_files_init(&live->files, live->args, err) &&
           start_thread(&live->worker, live_worker, live, err) && (live->working = true) &&
           start_thread(&live->watcher, watch, live, err) && (live->watching = true);
}

/* Only names that the configuration has get a place, so that there are few. */
const struct ocio_conversion *live_conversion(struct live *live, const struct ocio_options *options,
                                              struct glint_error *err) {
    const char *display = options->display ? options->display : "", *view = options->view ? options->view : "";
    size_t i = 0;
    pthread_mutex_lock(&live->converting);
    struct conversion *at = live->conversions;
    while (i < CONVERSIONS && at[i].ready && (strcmp(at[i].display, display) != 0 || strcmp(at[i].view, view) != 0))
        i++;
    if (i == CONVERSIONS) glint_fail(err, GLINT_ERROR_LIMIT, "more than %d views were asked for", CONVERSIONS);
    else if (!at[i].ready && (at[i].ready = ocio_prepare(options, err))) {
        snprintf(at[i].display, sizeof at[i].display, "%s", display);
        snprintf(at[i].view, sizeof at[i].view, "%s", view);
    }
    const struct ocio_conversion *ready = i < CONVERSIONS ? at[i].ready : NULL;
    pthread_mutex_unlock(&live->converting);
    return ready;
}

void live_stop(struct live *live) {
    pthread_mutex_lock(&live->lock);
    live->stopping = true;
    pthread_cond_broadcast(&live->wake);
    pthread_cond_broadcast(&live->changed);
    pthread_mutex_unlock(&live->lock);
}

void live_end(struct live *live) {
    live_stop(live);
    if (live->working) pthread_join(live->worker, NULL);
    else live_close(live);
    if (live->watching) pthread_join(live->watcher, NULL);
    watch_files_finish(&live->files);
    runs_finish(&live->runs);
    if (live->folder) live_remove_folder(live->folder);
    free(live->folder);
    free(live->frames);
    free(live->presets);
    json_decref(live->registry);
    json_decref(live->times);
    for (size_t i = 0; i < CONVERSIONS; i++) ocio_release(&live->conversions[i].ready);
    pthread_mutex_destroy(&live->lock);
    pthread_mutex_destroy(&live->converting);
    pthread_cond_destroy(&live->wake);
    pthread_cond_destroy(&live->changed);
}
