/* Everything that the bytes of a frame depend on as one text, so that frames with this text need not be rendered again. */
#ifndef SAMPLES_SETTINGS_H
#define SAMPLES_SETTINGS_H

#include "scene.h"

/* Hash of version, scene and options: 32 hexadecimal digits and a NUL. It does not depend on the number of frames and threads or the
   output path. */
bool settings_hash(const struct scene *scene, const struct glint_sample_options *options, char hex[33],
                   struct glint_error *err);

/* Whether `path` is a capture whose part `part` was made with `settings`. */
bool settings_kept(const char *path, const char *part, const char *settings);

/* The hash of a file's contents in the same form; false if it cannot be read. */
bool settings_file_hash(const char *path, char hex[33]);

#endif
