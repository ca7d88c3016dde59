/* The files that commands write: what a name may be, and files that are complete or not there at all. */
#ifndef GLINT_VIEWER_OUTPUT_H
#define GLINT_VIEWER_OUTPUT_H

#include <stdio.h>

#include "complete.h"
#include "glint/common.h"

/* What a file contains. A command that chooses by the name's suffix has several bits. */
enum output_kind {
    OUTPUT_PNG = 1,
    OUTPUT_SVG = 2,
    OUTPUT_HTML = 4,
    OUTPUT_JSON = 8,
    OUTPUT_EXR = 16,
};

/* Whether the name has the suffix of this kind, whatever the case of its letters. */
bool output_is(const char *path, enum output_kind kind);
/* Whether a file of one of these kinds may get this name: its suffix is that of its contents, and a file that is already there is of the
   same kind, unless `overwrite`. "-" and what is no regular file (a pipe, /dev/null) may always be written to. */
bool output_check(const char *path, unsigned kinds, bool overwrite, struct glint_error *err);

/* A file that is being written under a temporary name. "-" is stdout, and what is no regular file is written to directly. */
struct output {
    const char *path;
    bool direct;
    struct complete_file complete; /* unless direct or stdout */
    FILE *file;
};
/* A stream of a copy of the descriptor; NULL with errno. */
FILE *output_stream(int descriptor, const char *mode);
bool output_open(struct output *output, const char *path, struct glint_error *err);
/* Gives the file its name. If `ok` is false, or if something could not be written, it is removed, and what had the name before stays; `err` is
   then set, unless `ok` was false. */
bool output_close(struct output *output, bool ok, struct glint_error *err);

/* Writes a text, complete or not at all. */
bool output_text(const char *path, const char *text, struct glint_error *err);

#endif
