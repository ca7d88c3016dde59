/* glint replay --watch: a capture replayed again whenever its preset or shaders change, beside the first version. */
#ifndef GLINT_VIEWER_WATCH_H
#define GLINT_VIEWER_WATCH_H

#include "options/pipeline_args.h"

/* ---- Files that are waited for: files.c ---- */

struct watch_files {
    char **files, **folders; /* folders: the shaders and presets in them */
    size_t file_count, folder_count;
    uint64_t state;
};
/* The preset's file, the users' shaders with what lies beside them (which they may include), and the folders of $GLINT_PASSES
   and $GLINT_PRESETS. */
bool watch_files_init(struct watch_files *files, const struct pipeline_args *args, struct glint_error *err);
void watch_files_finish(struct watch_files *files);
/* Until one of them changes, is there anew or is gone, and nothing changes any more; false after Ctrl-C. */
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
