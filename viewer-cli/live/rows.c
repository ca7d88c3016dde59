/* Work on the rows of a picture, by several threads beside each other. */
#include "live/rows.h"

#include <pthread.h>
#include <stdbool.h>
#include <unistd.h>

enum { PARTS_MAX = 16, LEAST_ROWS = 16 };

struct part {
    void (*work)(void *user, uint32_t first, uint32_t end);
    void *user;
    uint32_t first, end;
    bool threaded;
    pthread_t thread;
};

static void *run_part(void *user) {
    const struct part *part = user;
    part->work(part->user, part->first, part->end);
    return NULL;
}

void rows_share(uint32_t rows, void (*work)(void *user, uint32_t first, uint32_t end), void *user) {
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    struct part parts[PARTS_MAX];
    uint32_t count = rows / LEAST_ROWS;
    if (count > PARTS_MAX) count = PARTS_MAX;
    if (processors > 0 && count > (uint32_t)processors) count = (uint32_t)processors;
    if (count < 1) count = 1;
    for (uint32_t i = 0; i < count; i++) {
        parts[i] = (struct part){.work = work,
                                 .user = user,
                                 .first = (uint32_t)((uint64_t)rows * i / count),
                                 .end = (uint32_t)((uint64_t)rows * (i + 1) / count)};
        /* The last part, and what gets no thread, is done here. */
        parts[i].threaded = i + 1 < count && pthread_create(&parts[i].thread, NULL, run_part, &parts[i]) == 0;
        if (!parts[i].threaded) run_part(&parts[i]);
    }
    for (uint32_t i = 0; i < count; i++)
        if (parts[i].threaded) pthread_join(parts[i].thread, NULL);
}
