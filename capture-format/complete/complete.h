/* Files that are complete or not there at all: they are written under a temporary name beside their own, which they get at the end. */
#ifndef GLINT_COMPLETE_H
#define GLINT_COMPLETE_H

#include "glint/common.h"
#include "system.h"

struct complete_file {
    const char *path; /* the caller's */
    char *temporary;  /* PATH.tmp-PID */
    glint_file file;
};

bool complete_open(struct complete_file *complete, const char *path, struct glint_error *err);
/* Gives the file its name, if durable once its contents are on the disk. If `ok` is false, or if anything fails, it is removed, and what had the
   name before stays; `err` is then set, unless `ok` was false. */
bool complete_close(struct complete_file *complete, bool ok, bool durable, struct glint_error *err);

#endif
