/* Private folders below $TMPDIR (or /tmp) for what the program itself reads again. */
#ifndef GLINT_VIEWER_TEMPORARY_H
#define GLINT_VIEWER_TEMPORARY_H

#include "glint/common.h"

struct temporary {
    char path[240]; /* TMPDIR/glint-WHAT.XXXXXX; "": none */
    int lock;
};
/* Also removes the folders of the same kind of processes that were killed. */
bool temporary_make(struct temporary *temporary, const char *what, struct glint_error *err);
/* With all that is in it. A zeroed one is allowed. */
void temporary_remove(struct temporary *temporary);

/* Removes a folder with all that is in it; links are not followed. */
void temporary_remove_folder(const char *folder);

#endif
