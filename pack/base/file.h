/* Whole files in memory, within limits. */
#ifndef GLINT_PACK_FILE_H
#define GLINT_PACK_FILE_H

#include <stdint.h>

#include "glint/common.h"

struct bytes {
    uint8_t *data; /* malloc'd, with a NUL behind it */
    size_t size;
};

/* Reads a regular file of at most `most` bytes. Pipes and devices, which may never end, are refused. */
bool file_read(const char *path, uint64_t most, struct bytes *bytes, struct glint_error *err);
/* `name` relative to the folder of the file `beside`; malloc'd, NULL when out of memory. */
char *file_beside(const char *beside, const char *name);
/* Whether both paths name one file. */
bool file_same(const char *a, const char *b);
/* Whether both are ordinary files, and no links, that hold the same bytes. */
bool file_equal(const char *a, const char *b);
/* Copies an ordinary file, and no link; it appears under `to` only when it is complete. */
bool file_copy(const char *from, const char *to, struct glint_error *err);
/* Writes NAME.tmp-XXXXXXXX, then renames it. */
bool file_write(const char *path, const void *data, size_t size, struct glint_error *err);

#endif
