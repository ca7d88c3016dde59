/* Work in equal pieces on several threads. */
#ifndef SAMPLES_PARALLEL_H
#define SAMPLES_PARALLEL_H

#include "glint/common.h"

#include <stdint.h>

/* What a whole job reports to: one callback for many stages. */
struct job {
    glint_progress progress; /* may be NULL */
    void *user;
    uint32_t threads;   /* 0: one for each core */
    double done, total; /* in the stages' own weights */
};

/* Calls piece(user, i) for each i below `count`, in any order, on the job's threads; adds `weight` to what is done.
   Fails when the callback asks to stop. */
bool parallel_for(struct job *job, const char *what, double weight, uint32_t count,
                  void (*piece)(void *user, uint32_t i), void *user, struct glint_error *err);

#endif
