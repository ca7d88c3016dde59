/* What the worker does with the device: opens it, loads frames with the history that they need, and replays states. */
#include <stdio.h>
#include <string.h>

#include "live/live.h"
#include "options/args.h"

/* ---- The device ---- */

static void unload(struct live *live) {
    if (live->replay) glint_replay_load(live->replay, NULL, NULL);
    glint_capture_close(&live->capture);
    live->ran = live->before = 0;
}

void live_close(struct live *live) {
    unload(live);
    live_close_judge(live);
    if (live->replay) glint_replay_destroy(&live->replay);
    if (live->device) glint_device_destroy(&live->device);
}

bool live_open_device(struct live *live, struct glint_error *err) {
    if (!live->device && !(live->device = pipeline_args_device(live->args, err))) return false;
    return live->replay || (live->replay = glint_replay_create(live->device, err));
}

struct glint_replay_options live_options(const struct live *live, const struct state *state) {
    const uint64_t most = (uint64_t)4 << 30, quarter = glint_device_get_info(live->device)->memory_bytes / 4;
    struct glint_replay_options options = live->args->replay;
    options.skip = state->skip[0] ? state->skip : NULL;
    options.force = state->force[0] ? state->force : NULL;
    options.captured = true;
    options.keep_bytes = quarter < most ? quarter : most;
    options.cache = live->cache;
    return options;
}

/* ---- Frames ---- */

static bool open_frame(struct live *live, size_t frame, bool draft, struct glint_error *err) {
    char path[512];
    unload(live);
    if (draft && !live_draft(live, frame, path, sizeof path, err)) return false;
    if (!(live->capture = glint_capture_open(draft ? path : live->frames[frame].path, NULL, err))) return false;
    if (!glint_replay_load(live->replay, live->capture, err)) {
        glint_capture_close(&live->capture);
        return false;
    }
    live->loaded = frame;
    live->loaded_draft = draft;
    return true;
}

/* Loads the next frame, whose history are the images of the one before. */
static bool follow_frame(struct live *live, size_t frame, bool draft, struct glint_error *err) {
    struct glint_capture *before = live->capture;
    char path[512];
    if (draft && !live_draft(live, frame, path, sizeof path, err)) return false;
    live->before = live->ran;
    live->ran = 0;
    live->capture = glint_capture_open(draft ? path : live->frames[frame].path, NULL, err);
    const bool ok = live->capture && glint_replay_load(live->replay, live->capture, err);
    if (!ok) {
        glint_replay_load(live->replay, NULL, NULL);
        glint_capture_close(&live->capture);
        live->before = 0;
    }
    glint_capture_close(&before);
    live->loaded = frame;
    live->loaded_draft = draft;
    return ok;
}

bool live_ran(struct live *live, const struct state *state, bool ok, struct glint_error *err) {
    live->ran = ok ? state->key : 0;
    if (ok || err->code == GLINT_ERROR_INTERRUPTED) return ok;
    /* The images on the device are gone, the history, too; and after a fault of the device itself nothing on it can be used. */
    if (err->code == GLINT_ERROR_DEVICE || err->code == GLINT_ERROR_MEMORY) live_close(live);
    else unload(live);
    return false;
}

static bool run_loaded(struct live *live, const struct state *state, bool quick, struct glint_error *err) {
    struct glint_replay_options options = live_options(live, state);
    options.quick = quick;
    return live_ran(live, state, glint_replay_run(live->replay, state->pipeline, &options, live_progress, live, err),
                    err);
}

bool live_load(struct live *live, const struct state *state, bool draft, struct glint_error *err) {
    const size_t first = state_first_frame(live, state), frame = state->capture;
    if (!live_open_device(live, err)) return false;
    const bool same = live->capture && live->loaded_draft == draft;
    if (same && live->loaded == frame && (first == frame || live->before == state->key)) return true;
    if (first < frame && same && live->loaded == frame - 1 && live->ran == state->key &&
        (first == frame - 1 || live->before == state->key))
        return follow_frame(live, frame, draft, err);
    if (!open_frame(live, first, draft, err)) return false;
    for (size_t i = first + 1; i <= frame; i++)
        if (!run_loaded(live, state, false, err) || !follow_frame(live, i, draft, err)) return false;
    return true;
}

/* An error in a draft's file is one of the capture that it was made of. */
static bool name_capture(const struct live *live, size_t frame, struct glint_error *err) {
    char path[512], message[sizeof err->message];
    draft_path(live, frame, path, sizeof path);
    const size_t length = strlen(path);
    if (strncmp(err->message, path, length) != 0) return false;
    snprintf(message, sizeof message, "%.400s, draft%.600s", live->frames[frame].path, err->message + length);
    memcpy(err->message, message, sizeof message);
    return false;
}

bool live_replay(struct live *live, const struct state *state, bool draft, bool quick, struct glint_error *err) {
    if (!live_load(live, state, draft, err) || !run_loaded(live, state, quick, err))
        return draft && name_capture(live, state->capture, err);
    /* The history of the next frame is that of a plain run. */
    if (quick) live->ran = 0;
    return true;
}
