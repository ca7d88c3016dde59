/* A parallel loop over indices. */
#ifndef GLINT_THREADS_H
#define GLINT_THREADS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Called for each index once, indices handed out in ascending order. `worker` < the number of workers. False stops the
   loop: indices not yet handed out are not run. */
typedef bool (*glint_loop_fn)(void *user, uint32_t worker, size_t index);

#define GLINT_MAX_WORKERS 64
/* The number of workers of a loop over `count` indices; `threads` 0 means one for each core. */
uint32_t glint_loop_workers(size_t count, uint32_t threads);
/* Runs on the calling thread and workers - 1 others, or fewer if threads cannot be created. True if no call failed. */
bool glint_loop(size_t count, uint32_t workers, glint_loop_fn fn, void *user);

#endif
