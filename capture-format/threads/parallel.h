/* Processes ranges of rows on all cores. */
#ifndef GLINT_PARALLEL_H
#define GLINT_PARALLEL_H

#include <stddef.h>

/* Calls `work` for ranges [first, last) that together cover [0, count), on all cores; returns when all are done. */
void parallel_rows(size_t count, void (*work)(void *user, size_t first, size_t last), void *user);

#endif
