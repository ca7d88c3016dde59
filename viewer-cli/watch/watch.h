/* glint replay --watch: replays a capture whenever its preset or shaders change, and compares the result with the first version. */
#ifndef GLINT_VIEWER_WATCH_H
#define GLINT_VIEWER_WATCH_H

#include "options/pipeline_args.h"

/* ---- Watched files: files.c ---- */

struct watch_files {
    char **files, **folders; /* folders whose shaders and presets are watched */
    size_t file_count, folder_count;
    uint64_t state;
};
/* Watches the preset's file, the users' shaders and the files beside them (which they may include), and the folders
   $GLINT_PASSES and $GLINT_PRESETS. */
bool watch_files_init(struct watch_files *files, const struct pipeline_args *args, struct glint_error *err);
void watch_files_finish(struct watch_files *files);
/* Waits until a file changes, appears or disappears, and then until changes cease. False after Ctrl-C. */
bool watch_files_wait(struct watch_files *files, bool (*ended)(void *user), void *user);

/* ---- Versions: run.c ---- */

struct watch {
    const struct command *command;
    const struct pipeline_args *args;
    const char *capture, *out, *cache;
    struct glint_device *device;
};
/* OUT holds the newest version that ran, OUT/first the first one; OUT/watch.html compares them and states why a newer
   version fails. Ends with Ctrl-C. */
enum status watch_run(const struct watch *watch);

#endif
