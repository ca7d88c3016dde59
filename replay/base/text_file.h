/* Whole text files. */
#ifndef GLINT_REPLAY_TEXT_FILE_H
#define GLINT_REPLAY_TEXT_FILE_H

#include <stddef.h>

#include "glint/common.h"

/* A whole text file of at most `limit` bytes, NUL-terminated. The caller frees it. */
char *file_text(const char *path, size_t limit, struct glint_error *err);

/* The same where the user named only the folder, or where another file names it: links are followed, but a pipe or a device is no file. */
char *file_text_found(const char *path, size_t limit, struct glint_error *err);

#endif
