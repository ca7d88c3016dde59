/* Writes the shares known so far into the folder at intervals, so that they can be read during the computation. */
#include <stdlib.h>

#include "blame/blame.h"
#include "io/output.h"

static const double EVERY_SECONDS = 5;

static bool write_json(const struct blame *blame, struct glint_error *err) {
    char path[4096];
    json_t *json = blame_json(blame);
    char *text = json ? json_dumps(json, JSON_INDENT(1)) : NULL;
    const bool ok = (text || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) &&
                    journal_path(blame->out, "shares.json", path, err) && output_text(path, text, err);
    free(text);
    json_decref(json);
    return ok;
}

bool blame_publish(struct blame *blame, bool at_once, struct glint_error *err) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double since =
        (double)(now.tv_sec - blame->published.tv_sec) + 1e-9 * (double)(now.tv_nsec - blame->published.tv_nsec);
    if (!blame_is_known(&blame->captured[0]) || (!at_once && (!blame->out || since < EVERY_SECONDS))) return true;
    if (!blame_sum_up(blame, err)) return false;
    if (blame->out && !(write_json(blame, err) && blame_write_page(blame, err))) return false;
    clock_gettime(CLOCK_MONOTONIC, &blame->published);
    return true;
}
