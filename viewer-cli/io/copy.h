/* Copies of files in folders that may come from anybody. */
#ifndef GLINT_VIEWER_COPY_H
#define GLINT_VIEWER_COPY_H

#include <stdint.h>

#include "glint/common.h"

/* Copies an ordinary file of at most `most` bytes to a name that is not there yet; it is on the disk when this returns. What is a link, a device
   or a pipe is refused. */
bool copy_plain(const char *from, const char *to, uint64_t most, struct glint_error *err);

#endif
