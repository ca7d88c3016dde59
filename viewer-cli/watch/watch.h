/* glint replay --watch: replays a capture whenever its preset or shaders change, and compares with the first version. */
#ifndef GLINT_VIEWER_WATCH_H
#define GLINT_VIEWER_WATCH_H

#include "options/pipeline_args.h"

/* ---- Watched files: files.c ---- */

struct watch_files {
    char **files, **folders; /* folders: the shaders and presets in them */
    size_t file_count, folder_count;
    uint64_t state;
};
/* The preset's file, the users' shaders with what lies beside them (which they may include), and the folders of $GLINT_PASSES
   and $GLINT_PRESETS. */
bool watch_files_init(struct watch_files *files, const struct pipeline_args *args, struct glint_error *err);
void watch_files_finish(struct watch_files *files);
/* Waits until a file changes, appears or disappears, and then until nothing changes any more. False after Ctrl-C. */
bool watch_files_wait(struct watch_files *files);

/* ---- Versions: run.c ---- */

struct watch {
    const struct command *command;
    const struct pipeline_args *args;
    const char *capture, *out, *cache;
    struct glint_device *device;
};
/* OUT holds the newest version that ran, OUT/first the first, OUT/watch.html both, and says why a newer one does not run. Ends
   with Ctrl-C. */
enum status watch_run(const struct watch *watch);

#endif
