/* Files inside a folder that may come from anybody, such as a run: ordinary files of a bounded size, or none. What the user names himself may be a
   link or a pipe, and is not opened with these functions. */
#ifndef GLINT_INSIDE_H
#define GLINT_INSIDE_H

#include "glint/common.h"
#include "system.h"

/* Opens an ordinary file of at most `most` bytes. What is a symbolic link, which may lead anywhere, a device or a pipe is refused. */
bool inside_open(glint_file *file, const char *path, uint64_t most, uint64_t *bytes, struct glint_error *err);
/* Its contents, without a NUL byte and NUL-terminated. The caller frees them. */
char *inside_text(const char *path, size_t most, struct glint_error *err);

/* Whether a JSON text has no more than two million values, each of which takes up to 250 bytes when it is parsed: a text of a few megabytes
   could otherwise take gigabytes. */
bool inside_json_fits(const char *path, const char *text, size_t length, struct glint_error *err);

/* The path, without links, of a file that a document in this folder names; NULL where it lies outside the folder or is not there. The caller
   frees it. */
char *inside_path(const char *folder, const char *name, struct glint_error *err);
/* The same for the folder of the file that names it. */
char *inside_beside(const char *file, const char *name, struct glint_error *err);

#endif
