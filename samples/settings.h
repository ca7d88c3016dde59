/* What a frame's bytes depend on, as one text; frames that have it already need not be rendered again. */
#ifndef SAMPLES_SETTINGS_H
#define SAMPLES_SETTINGS_H

#include "scene.h"

/* Hash of version, scene and options: 32 hexadecimal digits and a NUL. The number of frames and of threads and the
   place of the output are left out. */
bool settings_hash(const struct scene *scene, const struct glint_sample_options *options, char hex[33],
                   struct glint_error *err);

/* True when `path` is a capture whose part `part` says that it was made with `settings`. */
bool settings_kept(const char *path, const char *part, const char *settings);

/* Of a file's bytes, in the same form; false when it cannot be read. */
bool settings_file_hash(const char *path, char hex[33]);

#endif
