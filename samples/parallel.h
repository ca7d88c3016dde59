/* Processes equal pieces of work on several threads. */
#ifndef SAMPLES_PARALLEL_H
#define SAMPLES_PARALLEL_H

#include "glint/common.h"

#include <stdint.h>

/* A job with several stages and one progress callback. */
struct job {
    glint_progress progress; /* may be NULL */
    void *user;
    uint32_t threads;   /* 0: one per core */
    double done, total; /* in the weights of the stages */
};

/* Calls piece(user, i) for each i below `count`, in any order, on the job's threads, and adds `weight` to the progress. Fails if the
   callback requests to stop. */
bool parallel_for(struct job *job, const char *what, double weight, uint32_t count,
                  void (*piece)(void *user, uint32_t i), void *user, struct glint_error *err);

#endif
