/* Replays each version of a watched preset or shader. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "diff/diff.h"
#include "io/console.h"
#include "command.h"
#include "io/progress.h"
#include "draw/view/sheet.h"
#include "watch/watch.h"

struct session {
    const struct watch *watch;
    struct glint_replay *replay;
    struct watch_files files;
    struct progress progress;
    char first[4096], page[4096];
    unsigned number, shown; /* the newest version, and the newest that ran; 0: none */
};

/* ---- Reporting a version ---- */

static void now_text(char text[16]) {
    const time_t now = time(NULL);
    struct tm local;
    strftime(text, 16, "%H:%M:%S", localtime_r(&now, &local));
}

static void say(const struct session *s, const struct diff *diff) {
    const struct glint_pass_result *results;
    size_t count = 0, again = 0, differing = 0;
    char at[16];
    results = glint_replay_results(s->replay, &count);
    for (size_t i = 0; i < count; i++) again += results[i].ran && !results[i].cached && !results[i].pass->host;
    for (size_t i = 0; i < diff->count; i++) differing += diff->pairs[i].status != DIFF_SAME;
    now_text(at);
    printf("version %u, %s: %zu passes ran; ", s->number, at, again);
    const size_t first = diff_first(diff);
    if (first == diff->count) puts("equal to the first version");
    else {
        const struct diff_image *image = diff_pair_image(&diff->pairs[first]);
        printf("%zu of %zu images differ from the first version, the first of them %s: %s\n", differing, diff->count,
               image->slot, image->name);
    }
    fflush(stdout);
}

/* Shows the newest version that ran beside the first one. `fault`: why a newer one fails, or NULL. Without `refresh`
   this is the final page, which Ctrl-C does not interrupt. */
static bool show_run(struct session *s, const char *fault, bool refresh, struct glint_error *err) {
    const char *const paths[2] = {s->first, s->watch->out};
    struct diff diff = {.options = {.limits = glint_difference_limits(), .heat = true}};
    char title[300], lead[2200], at[16];
    now_text(at);
    snprintf(title, sizeof title, "%.250s, watched", sheet_name(s->watch->capture));
    if (fault)
        snprintf(lead, sizeof lead, "Version %u, %s, failed; this is version %u.\n%.2000s", s->number, at, s->shown,
                 fault);
    else snprintf(lead, sizeof lead, "Version %u, %s, compared with the first.", s->shown, at);
    const struct diff_page page = {.title = title, .lead = lead, .kind = fault ? "code" : "text", .refresh = refresh};
    const bool ok = diff_sides_open(diff.sides, paths, err) &&
                    diff_compare(&diff, refresh ? progress_report : NULL, &s->progress, err) &&
                    diff_write_page(s->page, &diff, &page, err);
    progress_end(&s->progress);
    if (ok && !fault && refresh) say(s, &diff);
    diff_finish(&diff);
    return ok;
}

/* ---- Running ---- */

static bool write_run(struct session *s, const char *folder, struct glint_error *err) {
    return glint_replay_write(s->replay, folder, progress_report, &s->progress, err);
}

static bool run_version(struct session *s, struct glint_error *err) {
    struct glint_replay_options options = pipeline_args_options(s->watch->args);
    options.cache = s->watch->cache;
    struct glint_pipeline *pipeline = pipeline_args_create(s->watch->args, err);
    const bool ok = pipeline && glint_replay_run(s->replay, pipeline, &options, progress_report, &s->progress, err) &&
                    (s->shown || write_run(s, s->first, err)) && write_run(s, s->watch->out, err);
    glint_pipeline_destroy(&pipeline);
    progress_end(&s->progress);
    return ok;
}

/* False after Ctrl-C or an error that ends the watch. If a version fails, the watch waits for the next change. */
static bool next_version(struct session *s, struct glint_error *err) {
    struct glint_error fault = {0};
    s->number++;
    if (run_version(s, &fault)) {
        s->shown = s->number;
        return show_run(s, NULL, true, err);
    }
    if (fault.code == GLINT_ERROR_INTERRUPTED || fault.code == GLINT_ERROR_MEMORY)
        return glint_fail(err, fault.code, "%s", fault.message);
    command_note(s->watch->command, "version %u failed: %s", s->number, fault.message);
    return !s->shown || show_run(s, fault.message, true, err);
}

static bool interrupted(void *user) {
    (void)user;
    return progress_interrupted();
}

static bool watch_all(struct session *s, struct glint_error *err) {
    bool ok = next_version(s, err);
    if (ok) printf("watching for changes; open %s; stop with Ctrl-C\n", name_text(s->page));
    fflush(stdout);
    while (ok && watch_files_wait(&s->files, interrupted, NULL)) ok = next_version(s, err);
    if (!ok && err->code == GLINT_ERROR_INTERRUPTED) ok = true;
    return ok && (!s->shown || show_run(s, NULL, false, err));
}

enum status watch_run(const struct watch *watch) {
    struct session *s = calloc(1, sizeof *s);
    struct glint_error err = {0};
    struct glint_capture *capture = NULL;
    bool ok = s || glint_fail(&err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) {
        s->watch = watch;
        ok = (snprintf(s->first, sizeof s->first, "%s/first", watch->out) < (int)sizeof s->first &&
              snprintf(s->page, sizeof s->page, "%s/watch.html", watch->out) < (int)sizeof s->page) ||
             glint_fail(&err, GLINT_ERROR_USAGE, "%s: path too long", watch->out);
        progress_begin(&s->progress);
        ok = ok && watch_files_init(&s->files, watch->args, &err) &&
             (s->replay = glint_replay_create(watch->device, &err)) &&
             (capture = glint_capture_open(watch->capture, NULL, &err)) &&
             glint_replay_load(s->replay, capture, &err) && watch_all(s, &err);
        progress_end(&s->progress);
        if (s->replay) glint_replay_load(s->replay, NULL, NULL);
        glint_replay_destroy(&s->replay);
        watch_files_finish(&s->files);
    }
    glint_capture_close(&capture);
    free(s);
    return ok ? STATUS_DONE : command_fail(watch->command, &err);
}
