/* Work on ranges of rows, spread over the processor's cores. */
#include "parallel.h"

#include <pthread.h>
#include <stdbool.h>
#include <unistd.h>

struct range {
    void (*work)(void *user, size_t first, size_t last);
    void *user;
    size_t first, last;
};

static void *run(void *argument) {
    const struct range *range = argument;
    range->work(range->user, range->first, range->last);
    return NULL;
}

void parallel_rows(size_t count, void (*work)(void *user, size_t first, size_t last), void *user) {
    enum { THREADS_MAX = 16 };
    struct range ranges[THREADS_MAX];
    pthread_t threads[THREADS_MAX];
    bool started[THREADS_MAX] = {false};
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    size_t n = cores < 1 ? 1 : cores > THREADS_MAX ? THREADS_MAX : (size_t)cores;
    for (size_t i = 0; i < n; i++) {
        ranges[i] = (struct range){work, user, count * i / n, count * (i + 1) / n};
        if (i + 1 < n) started[i] = pthread_create(&threads[i], NULL, run, &ranges[i]) == 0;
        if (!started[i]) run(&ranges[i]); /* the last part, and what no thread could be had for */
    }
    for (size_t i = 0; i < n; i++)
        if (started[i]) pthread_join(threads[i], NULL);
}
