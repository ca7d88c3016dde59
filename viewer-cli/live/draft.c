/* Drafts: captures at half the width and height, for a first look while the whole frame is replayed. */
#include <stdio.h>
#include <unistd.h>

#include "glint/edit.h"
#include "live/live.h"

static bool make_draft(const struct live_frame *frame, const char *path, struct glint_error *err) {
    struct glint_edit *edit = glint_edit_open(frame->path, NULL, NULL, NULL, err);
    const bool ok = edit && glint_edit_reduce(edit, 2, err) && glint_edit_write(edit, path, err);
    if (edit) glint_edit_close(&edit);
    return ok;
}

bool draft_path(const struct live *live, size_t number, char *path, size_t size) {
    return snprintf(path, size, "%s/draft-%zu.exr", live->temporary.path, number) < (int)size;
}

bool live_draft(struct live *live, size_t number, char *path, size_t size, struct glint_error *err) {
    struct live_frame *frame = &live->frames[number];
    if (!draft_path(live, number, path, size))
        return glint_fail(err, GLINT_ERROR_IO, "%s: path too long", live->temporary.path);
    if (frame->has_draft && access(path, R_OK) == 0) return true; /* folders for temporary files are cleaned at times */
    if (!live_progress(live, "draft capture", 0)) return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
    return frame->has_draft = make_draft(frame, path, err);
}
