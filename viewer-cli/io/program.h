/* Other programs, run without a shell. */
#ifndef GLINT_VIEWER_PROGRAM_H
#define GLINT_VIEWER_PROGRAM_H

#include "glint/common.h"

/* Runs words[0], which is looked for in $PATH, with these words, NULL-terminated, in a folder, and waits for it. Returns what it printed to stdout, at most
   PROGRAM_MOST bytes, malloc'd. NULL with an error that has what it printed to stderr, if it could not be run, or did not end with 0. */
enum { PROGRAM_MOST = 1 << 26 };
char *program_run(const char *const *words, const char *folder, struct glint_error *err);

#endif
