/* Content hashes: XXH3-128 over a file's bytes, as 32 hexadecimal digits. */
#ifndef GLINT_HASH_H
#define GLINT_HASH_H

#include "glint/common.h"
#include "system.h"

/* Hashes the whole file through an open one. `path` is for error messages. */
bool glint_hash_file(glint_file file, const char *path, char hex[33], struct glint_error *err);

#endif
