/* A parallel loop over indices. */
#include "threads.h"

#include <stdatomic.h>

#include "system.h"

struct loop {
    size_t count;
    glint_loop_fn fn;
    void *user;
    atomic_size_t next;
    atomic_bool failed;
};

struct worker {
    struct loop *loop;
    uint32_t index;
    struct glint_thread thread;
};

static void run_worker(void *user) {
    struct worker *worker = user;
    struct loop *loop = worker->loop;
    while (!atomic_load(&loop->failed)) {
        const size_t i = atomic_fetch_add(&loop->next, 1);
        if (i >= loop->count) break;
        if (!loop->fn(loop->user, worker->index, i)) atomic_store(&loop->failed, true);
    }
}

uint32_t glint_loop_workers(size_t count, uint32_t threads) {
    uint32_t workers = threads ? threads : glint_cores();
    if (workers > GLINT_MAX_WORKERS) workers = GLINT_MAX_WORKERS;
    if (count < workers) workers = count ? (uint32_t)count : 1;
    return workers;
}

bool glint_loop(size_t count, uint32_t workers, glint_loop_fn fn, void *user) {
    struct loop loop = {.count = count, .fn = fn, .user = user};
    struct worker all[GLINT_MAX_WORKERS];
    uint32_t started = 1;
    for (; started < workers && started < GLINT_MAX_WORKERS; started++) {
        all[started] = (struct worker){.loop = &loop, .index = started};
        if (!glint_thread_start(&all[started].thread, run_worker, &all[started])) break;
    }
    all[0] = (struct worker){.loop = &loop};
    run_worker(&all[0]);
    for (uint32_t i = 1; i < started; i++) glint_thread_join(&all[i].thread);
    return !atomic_load(&loop.failed);
}
