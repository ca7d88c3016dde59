/* Writes the shares known so far into the folder at intervals, so that they can be read during the computation. */
#include <math.h>
#include <stdlib.h>

#include "blame/blame.h"
#include "io/output.h"
#include "record.h"

/* The interval, at least; longer where writing takes more than a twentieth of it. */
static const double EVERY_SECONDS = 5, EVERY_WRITES = 20;

static bool write_json(const struct blame *blame, struct glint_error *err) {
    char path[4096];
    json_t *json = blame_json(blame);
    char *text = json ? record_text(json, JSON_INDENT(1)) : NULL;
    const bool ok = (text || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) &&
                    journal_path(blame->out, "shares.json", path, err) && output_text(path, text, err);
    free(text);
    json_decref(json);
    return ok;
}

static double seconds_between(const struct timespec *from, const struct timespec *to) {
    return (double)(to->tv_sec - from->tv_sec) + 1e-9 * (double)(to->tv_nsec - from->tv_nsec);
}

bool blame_publish(struct blame *blame, bool at_once, struct glint_error *err) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double since = seconds_between(&blame->published, &now);
    if (!blame_is_known(&blame->captured[0])) return true;
    if (!at_once && (!blame->out || since < fmax(EVERY_SECONDS, EVERY_WRITES * blame->publish_seconds))) return true;
    if (!blame_sum_up(blame, err)) return false;
    if (blame->out && !(write_json(blame, err) && blame_write_page(blame, err))) return false;
    clock_gettime(CLOCK_MONOTONIC, &blame->published);
    blame->publish_seconds = seconds_between(&now, &blame->published);
    return true;
}
