/* Processes ranges of rows on all cores. */
#include "parallel.h"

#include "threads.h"

struct rows {
    void (*work)(void *user, size_t first, size_t last);
    void *user;
    size_t count, ranges;
};

static bool run_range(void *user, uint32_t worker, size_t i) {
    const struct rows *rows = user;
    (void)worker;
    rows->work(rows->user, rows->count * i / rows->ranges, rows->count * (i + 1) / rows->ranges);
    return true;
}

void parallel_rows(size_t count, void (*work)(void *user, size_t first, size_t last), void *user) {
    const uint32_t workers = glint_loop_workers(count, 0);
    struct rows rows = {work, user, count, workers};
    glint_loop(workers, workers, run_range, &rows);
}
