/* A counter that threads draw from. The caller's thread works too, and alone reports progress. */
#include "parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define MAX_THREADS 64

struct shared {
    atomic_uint next;
    atomic_bool stopped;
    uint32_t count;
    void (*piece)(void *user, uint32_t i);
    void *user;
};

static bool step(struct shared *shared) {
    if (atomic_load(&shared->stopped)) return false;
    uint32_t i = atomic_fetch_add(&shared->next, 1);
    if (i >= shared->count) return false;
    shared->piece(shared->user, i);
    return true;
}

static void *run(void *user) {
    while (step(user)) {
    }
    return NULL;
}

bool parallel_for(struct job *job, const char *what, double weight, uint32_t count,
                  void (*piece)(void *user, uint32_t i), void *user, struct glint_error *err) {
    struct shared shared = {.count = count, .piece = piece, .user = user};
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    uint32_t threads = job->threads ? job->threads : cores > 0 ? (uint32_t)cores : 1;
    if (threads > MAX_THREADS) threads = MAX_THREADS;
    if (threads > count) threads = count ? count : 1;
    pthread_t others[MAX_THREADS];
    uint32_t started = 0;
    /* A thread that does not start is no fault: the work gets done by those that did. */
    while (started + 1 < threads && !pthread_create(&others[started], NULL, run, &shared)) started++;
    bool more;
    do {
        more = step(&shared);
        double part = (double)(atomic_load(&shared.next) < count ? atomic_load(&shared.next) : count);
        if (job->progress && count &&
            !job->progress(job->user, what, (job->done + weight * part / count) / job->total)) {
            atomic_store(&shared.stopped, true);
            more = false;
        }
    } while (more);
    for (uint32_t i = 0; i < started; i++) pthread_join(others[i], NULL);
    job->done += weight;
    if (atomic_load(&shared.stopped)) return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted while %s", what);
    return true;
}
