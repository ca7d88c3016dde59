/* What leaves the page: preset files, pages of two runs, run folders. Answers /api/v1/preset, report and write. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "live/answers.h"
#include "options/args.h"
#include "options/preset_json.h"
#include "record.h"
#include "report/report.h"

/* A plain name for a file or folder: letters, digits and .-_ between them. */
static bool check_name(const char *name, struct glint_error *err) {
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    return (name && name[0] && name[0] != '.' && strlen(name) <= 100 && !name[strspn(name, allowed)]) ||
           glint_fail(err, GLINT_ERROR_USAGE,
                      "name: expected up to 100 letters, digits and .-_ that do not begin with a dot, found \"%.60s\"",
                      name ? name : "");
}

enum { DIGITS = 15 }; /* numbers as people write them: .08, not .080000000000000002 */

void live_answer_preset(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct state state;
    struct glint_error err = {0};
    const char *name = answer_text(request, "name");
    if (!answer_state(live, request, "state", &state, answer)) return;
    char title[200];
    snprintf(title, sizeof title, "%.100s, changed in glint live", glint_pipeline_name(state.pipeline));
    json_t *json = check_name(name, &err) ? preset_json(state.pipeline, name, title) : NULL;
    char *text = json ? record_text(json, JSON_INDENT(4) | JSON_REAL_PRECISION(DIGITS)) : NULL;
    if (json && !text) fail_memory(&err);
    answer_with(answer, text != NULL, text ? json_pack("{s:s, s:s}", "name", name, "preset", text) : NULL, &err);
    free(text);
    json_decref(json);
    state_finish(&state);
}

/* ---- Run folders ---- */

/* Writes the run of the loaded frame. */
static bool write_loaded(struct live *live, const char *folder, struct glint_error *err) {
    return glint_replay_write(live->replay, folder, live_progress, live, err);
}

/* FOLDER, or as glint replay has it with several captures, FOLDER/NAME; malloc'd. */
static char *folder_of(const struct live *live, const struct state *state, const char *folder, size_t frame) {
    char *path = NULL;
    const char *base = base_name(live->frames[frame].path);
    size_t length = strlen(base);
    if (length > 4 && !strcmp(base + length - 4, ".exr")) length -= 4;
    const bool shot = state_first_frame(live, state) != state->capture;
    const int done = shot ? asprintf(&path, "%s/%.*s", folder, (int)length, base) : asprintf(&path, "%s", folder);
    return done < 0 ? NULL : path;
}

static bool write_state(struct live *live, const struct state *state, const char *folder, struct glint_error *err) {
    char *path = folder_of(live, state, folder, state->capture);
    const bool ok =
        path ? live_replay(live, state, false, false, err) && write_loaded(live, path, err) : fail_memory(err);
    free(path);
    return ok;
}

struct writing {
    struct state state;
    const char *folder;
};

static bool work_write(struct live *live, void *user, struct glint_error *err) {
    struct writing *w = user;
    struct stat info;
    const bool shot = state_first_frame(live, &w->state) != w->state.capture;
    if (lstat(w->folder, &info) == 0 && !glint_run_is_unfinished(w->folder, shot))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: exists; expected the name of a new folder", w->folder);
    if (!glint_make_folder(live->out, err)) return false;
    const bool ok = write_state(live, &w->state, w->folder, err);
    if (!ok) rmdir(w->folder); /* which holds the folder of the frame, and would keep the name from being used again */
    return ok;
}

void live_answer_write(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct writing w;
    struct glint_error err = {0};
    const char *name = answer_text(request, "name");
    char *folder = NULL, *command = NULL;
    if (!answer_state(live, request, "state", &w.state, answer)) return;
    bool ok = live->out || glint_fail(&err, GLINT_ERROR_USAGE,
                                      "runs are written below the folder of -o alone, which "
                                      "was not given");
    ok = ok && check_name(name, &err);
    if (ok && asprintf(&folder, "%s/%s", live->out, name) < 0) ok = fail_memory(&err), folder = NULL;
    w.folder = folder;
    ok = ok && live_do(live, 0, answer_text(request, "client"), work_write, &w, &err);
    if (ok && !(command = state_command(live, &w.state, folder))) ok = fail_memory(&err);
    answer_with(answer, ok, ok ? json_pack("{s:s, s:s}", "folder", folder, "command", command) : NULL, &err);
    free(folder);
    free(command);
    state_finish(&w.state);
}

/* ---- Pages of two runs ---- */

struct reporting {
    struct state sides[2];
    void *page;
    size_t bytes;
};

static bool read_page(const char *path, struct reporting *r, struct glint_error *err) {
    FILE *file = fopen(path, "rb");
    long end = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (end > 0 && (r->page = malloc((size_t)end))) {
        rewind(file);
        r->bytes = fread(r->page, 1, (size_t)end, file);
    }
    if (file) fclose(file);
    return r->bytes == (size_t)end || glint_fail(err, GLINT_ERROR_IO, "%s: cannot be read", path);
}

static bool write_page(struct live *live, struct reporting *r, const char *folder, struct glint_error *err) {
    char paths[2][4096], page[4096];
    json_t *document = NULL;
    bool ok = true;
    for (int k = 0; ok && k < 2; k++) {
        const struct state *state = &r->sides[k];
        snprintf(paths[k], sizeof paths[k], "%.4000s/%c", folder, k ? 'B' : 'A');
        ok = live_replay(live, state, false, false, err) && write_loaded(live, paths[k], err);
    }
    const char *const runs[2] = {paths[0], paths[1]};
    snprintf(page, sizeof page, "%.4000s/page.html", folder);
    ok = ok && (document = report_runs(runs, 2, NULL, err)) && page_write(page, document, folder, err) &&
         read_page(page, r, err);
    json_decref(document);
    return ok;
}

static bool work_report(struct live *live, void *user, struct glint_error *err) {
    char folder[4096];
    snprintf(folder, sizeof folder, "%.4000s/report-XXXXXX", live->temporary.path);
    if (!mkdtemp(folder)) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", folder, strerror(errno));
    const bool ok = write_page(live, user, folder, err);
    temporary_remove_folder(folder);
    return ok;
}

void live_answer_report(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct reporting r = {.page = NULL};
    struct glint_error err = {0};
    if (!answer_state(live, request, "a", &r.sides[0], answer)) return;
    if (answer_state(live, request, "b", &r.sides[1], answer)) {
        if (live_do(live, 0, answer_text(request, "client"), work_report, &r, &err))
            *answer = (struct http_answer){
                .type = "text/html; charset=utf-8", .data = r.page, .size = r.bytes, .download = "glint-report.html"};
        else free(r.page), http_error(answer, &err);
        state_finish(&r.sides[1]);
    }
    state_finish(&r.sides[0]);
}
