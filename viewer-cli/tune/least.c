/* Explains why no point meets the limit: the best point, and its most expensive passes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tune/tune.h"

struct part {
    const struct glint_pass *pass;
    double ms;
};
struct parts {
    struct part *items;
    size_t count;
};

static int longest_first(const void *a, const void *b) {
    const double x = ((const struct part *)a)->ms, y = ((const struct part *)b)->ms;
    return (x < y) - (x > y);
}

static bool add_part(struct parts *parts, const struct glint_pass *pass, double ms, struct glint_error *err) {
    for (size_t i = 0; i < parts->count; i++)
        if (parts->items[i].pass == pass) {
            parts->items[i].ms += ms;
            return true;
        }
    struct part *larger = realloc(parts->items, (parts->count + 1) * sizeof *larger);
    if (!larger) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    parts->items = larger;
    parts->items[parts->count++] = (struct part){pass, ms};
    return true;
}

/* Mean times of the counted passes over rounds and captures. */
static bool measure_passes(struct tune *tune, const struct glint_pipeline *pipeline, struct parts *parts,
                           struct glint_error *err) {
    bool ok = true;
    const double rounds = (double)tune_live(tune) * tune->rounds;
    for (size_t s = 0; ok && s < tune->captures.count; s++) {
        if (tune->subjects[s].broken) continue;
        ok = tune_load_subject(tune, s, 0, err);
        for (uint32_t r = 0; ok && r < tune->rounds; r++) {
            struct glint_cost cost;
            glint_judge_next_round(tune->subjects[s].judge);
            ok = tune_cost(tune, &tune->subjects[s], pipeline, true, &cost, err);
            for (size_t i = 0; ok && i < cost.pass_count; i++)
                if (!cost.passes[i].cached_work && tune_slot_counts(tune, cost.passes[i].pass->slot))
                    ok = add_part(parts, cost.passes[i].pass, (double)cost.passes[i].ns * 1e-6 / rounds, err);
            if (ok) glint_cost_finish(&cost);
        }
    }
    if (parts->count) qsort(parts->items, parts->count, sizeof *parts->items, longest_first);
    return ok;
}

static bool is_tried(const struct tune *tune, const struct glint_pass *pass) {
    for (size_t a = 0; a < tune->axis_count; a++)
        for (uint32_t c = 0; !strcmp(tune->axes[a].name, pass->slot) && c < tune->axes[a].axis.choices; c++)
            if (!strcmp(tune->axes[a].texts[c], pass->variant)) return true;
    return false;
}

/* "; its most expensive passes: upscale/best_match takes 24 % (not tried: bilinear)" */
static void describe_expensive_passes(const struct tune *tune, const struct parts *parts, char *text, size_t size) {
    enum { MOST = 5 };
    size_t count;
    const struct glint_pass *passes = glint_passes(&count);
    int length = snprintf(text, size, "; its most expensive passes: ");
    double whole = 0;
    for (size_t i = 0; i < parts->count; i++) whole += parts->items[i].ms;
    for (size_t i = 0; i < parts->count && i < MOST && length < (int)size; i++) {
        const struct glint_pass *pass = parts->items[i].pass;
        const char *between = " (not tried: ";
        length += snprintf(text + length, size - (size_t)length, "%s%s/%s takes %.0f %%", i ? ", " : "", pass->slot,
                           pass->variant, 100 * parts->items[i].ms / whole);
        for (size_t p = 0; p < count && length < (int)size; p++)
            if (!strcmp(passes[p].slot, pass->slot) && &passes[p] != pass && !is_tried(tune, &passes[p])) {
                length += snprintf(text + length, size - (size_t)length, "%s%s", between, passes[p].variant);
                between = ", ";
            }
        if (between[1] != '(' && length < (int)size) length += snprintf(text + length, size - (size_t)length, ")");
    }
}

bool tune_fail_least(struct tune *tune, struct glint_error *err) {
    const struct glint_search_point *least = &tune->found.points[tune->found.lowest];
    struct parts parts = {0};
    char text[700] = "";
    if (!tune->fetches && !tune->by_error) {
        struct glint_pipeline *pipeline = tune_pipeline(tune, least->values, err);
        const bool ok = pipeline && measure_passes(tune, pipeline, &parts, err);
        if (ok) describe_expensive_passes(tune, &parts, text, sizeof text);
        if (pipeline) glint_pipeline_destroy(&pipeline);
        free(parts.items);
        if (!ok) return false;
    }
    return glint_fail(
        err, GLINT_ERROR_UNSUPPORTED,
        "no point meets %s limit of %.4g %s: the best of %zu points has %.4g, with %s of %.4g%s; no preset was written",
        tune->by_error ? "an error" : "a cost", tune->within,
        tune->by_error ? glint_metric(tune->metric)->title : tune_cost_unit(tune), tune->found.count,
        least->figures.constraint, tune->by_error ? "a cost" : "an error", least->figures.objective, text);
}
