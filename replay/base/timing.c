/* Clocks, statistics of times and progress reports. */
#include "timing.h"

#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

double glint_now_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static int compare_ns(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

struct glint_time glint_time_statistics(uint64_t *ns, size_t count) {
    if (!count) return (struct glint_time){0};
    qsort(ns, count, sizeof *ns, compare_ns);
    uint64_t low = ns[(count - 1) / 2], high = ns[count / 2];
    return (struct glint_time){
        .n = (uint32_t)count, .min_ns = ns[0], .median_ns = low + (high - low) / 2, .max_ns = ns[count - 1]};
}

uint64_t peak_memory_bytes(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}

bool glint_report_progress(glint_progress progress, void *user, const char *what, double done,
                           struct glint_error *err) {
    return !progress || progress(user, what, done) ||
           glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted at %s", what);
}

bool glint_report_part(void *user, const char *what, double done) {
    const struct glint_progress_part *part = user;
    return !part->progress ||
           part->progress(part->user, part->text[0] ? part->text : what, part->done + part->share * done);
}
