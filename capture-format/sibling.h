/* Siblings: files beside a capture that hold its cube maps. */
#ifndef GLINT_SIBLING_H
#define GLINT_SIBLING_H

#include "glint/common.h"

/* Whether it names a file in the capture's own folder on every system, so that a capture cannot lead a reader elsewhere. */
bool glint_sibling_is_plain(const char *name);
/* The path of a file in the folder of `path`, to be freed; NULL if memory is exhausted. */
char *glint_sibling_path(const char *path, const char *sibling);
/* The hash of that file. */
bool glint_hash_sibling(const char *path, const char *sibling, char hex[33], struct glint_error *err);

#endif
