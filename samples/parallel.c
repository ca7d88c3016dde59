/* Distributes the pieces of a stage over all threads; only the calling thread reports progress. */
#include "parallel.h"

#include "threads.h"

#include <stdatomic.h>

struct stage {
    struct job *job;
    const char *what;
    double weight;
    uint32_t count;
    void (*piece)(void *user, uint32_t i);
    void *user;
    atomic_uint done;
};

static bool step(void *user, uint32_t worker, size_t i) {
    struct stage *stage = user;
    const struct job *job = stage->job;
    stage->piece(stage->user, (uint32_t)i);
    const double part = (double)(atomic_fetch_add(&stage->done, 1) + 1) / stage->count;
    return worker || !job->progress ||
           job->progress(job->user, stage->what, (job->done + stage->weight * part) / job->total);
}

bool parallel_for(struct job *job, const char *what, double weight, uint32_t count,
                  void (*piece)(void *user, uint32_t i), void *user, struct glint_error *err) {
    struct stage stage = {job, what, weight, count, piece, user, 0};
    const bool done = glint_loop(count, glint_loop_workers(count, job->threads), step, &stage);
    job->done += weight;
    /* the last pieces may have been completed by other threads */
    if (done && (!job->progress || job->progress(job->user, what, job->done / job->total))) return true;
    return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted while %s", what);
}
