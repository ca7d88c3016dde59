/* Files that are complete or not there at all: they are written under a temporary name beside their own, which they get at the end. Every file of
   glint that has a name before a user sees it is written by these functions. */
#ifndef GLINT_COMPLETE_H
#define GLINT_COMPLETE_H

#include "glint/common.h"
#include "system.h"

struct complete_file {
    const char *path; /* the caller's, who may choose another name in the same folder before complete_close */
    char *temporary;  /* PATH.tmp-XXXXXXXX */
    glint_file file;
};

/* Also removes temporary files of the same path that a process left which was killed. */
bool complete_open(struct complete_file *complete, const char *path, struct glint_error *err);
/* The same; nobody else may read the file. */
bool complete_open_secret(struct complete_file *complete, const char *path, struct glint_error *err);
/* Gives the file its name. If it is `durable`, or replaces another file, its contents are on the disk before it gets the name, and the name is when
   this returns: so after a loss of power the old file is there or the new one, whole. If `ok` is false, or if anything fails, it is removed, and
   what had the name before stays; `err` is then set, unless `ok` was false. */
bool complete_close(struct complete_file *complete, bool ok, bool durable, struct glint_error *err);

/* A new temporary name of the path, to be freed; NULL without memory. */
char *complete_temporary(const char *path);
/* Renames a file that somebody else has written, in the order of complete_close. */
bool complete_rename(const char *from, const char *to, struct glint_error *err);

#endif
