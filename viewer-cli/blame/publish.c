/* Writes the shares known so far into the folder at intervals, so that they can be read during the computation. */
#include <math.h>

#include "blame/blame.h"
#include "io/output.h"

/* The interval, at least; longer where writing takes more than a twentieth of it. */
static const double EVERY_SECONDS = 5, EVERY_WRITES = 20;

static bool write_json(const struct blame *blame, struct glint_error *err) {
    char path[4096];
    struct output output;
    if (!journal_path(blame->out, "shares.json", path, err) || !output_open(&output, path, err)) return false;
    blame_write_json(output.file, blame, 1);
    return output_close(&output, true, err);
}

static double seconds_between(const struct timespec *from, const struct timespec *to) {
    return (double)(to->tv_sec - from->tv_sec) + 1e-9 * (double)(to->tv_nsec - from->tv_nsec);
}

static bool any_known(const struct blame *blame) {
    size_t c = 0;
    while (c < blame->captures.count && !blame_is_known(&blame->of[c].sum)) c++;
    return c < blame->captures.count;
}

bool blame_publish(struct blame *blame, bool at_once, struct glint_error *err) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double since = seconds_between(&blame->published, &now);
    if (blame->shard.count || !any_known(blame)) return true;
    if (!at_once && (!blame->out || since < fmax(EVERY_SECONDS, EVERY_WRITES * blame->publish_seconds))) return true;
    if (!blame_sum_up(blame, err)) return false;
    if (blame->out && !(write_json(blame, err) && blame_write_page(blame, err))) return false;
    clock_gettime(CLOCK_MONOTONIC, &blame->published);
    blame->publish_seconds = seconds_between(&now, &blame->published);
    return true;
}
