/* Noise of reference runs, and their dependence on assumptions. */
#include <stdio.h>
#include <stdlib.h>

#include "report/report.h"

static const struct report_column noise_columns[] = {
    {"surfaces", "surfaces", "", 1, false},    {"pixels", "pixels", "", 1, false},
    {"mean", "mean", "radiance", 1, false},    {"standard error", "error", "radiance", 1, false},
    {"relative", "relative", "%", 100, false}, {0},
};
static const struct report_column change_columns[] = {
    {"slot", "slot", "", 1, false},
    {"parameter", "parameter", "", 1, false},
    {"value", "value", "", 1, false},
    {"tried", "tried", "", 1, false},
    {"mean change", "all.mean", "radiance", 1, false},
    {"RMSE", "all.rmse", "radiance", 1, false},
    {"its noise", "all.noise", "radiance", 1, false},
    {"relative", "all.relative", "|%", 100, false},
    {"not traced", "reason", "", 1, false},
    {0},
};

/* Copies the change that a parameter causes on all surfaces to the member "all" of its row. */
static void copy_changes(const json_t *rows) {
    size_t i;
    json_t *row;
    json_array_foreach(rows, i, row) {
        json_t *all = json_array_get(json_object_get(row, "change"), 0);
        if (all) json_object_set(row, "all", all);
    }
}

static void add_rays(const struct report *r, json_t *blocks) {
    for (size_t k = 0; k < r->count; k++) {
        const json_t *reference = json_object_get(r->runs[k], "reference");
        char text[300];
        if (!reference) continue;
        snprintf(text, sizeof text,
                 "%s%s%lld rays per pixel, traced in %.0f s. The noise is the difference between the two halves "
                 "of the rays, which use independent random numbers.",
                 r->count > 1 ? r->labels[k] : "", r->count > 1 ? ": " : "",
                 (long long)json_integer_value(json_object_get(reference, "rays")),
                 json_number_value(json_object_get(reference, "seconds")));
        page_text(blocks, "text", text);
    }
}

void report_reference(const struct report *r) {
    const json_t **noise = calloc(r->count, sizeof *noise), **changes = calloc(r->count, sizeof *changes);
    bool any = false;
    for (size_t k = 0; noise && changes && k < r->count; k++) {
        const json_t *reference = json_object_get(r->runs[k], "reference");
        any = any || reference;
        noise[k] = json_object_get(reference, "noise");
        changes[k] = report_find(reference, "sensitivity.rows");
        copy_changes(changes[k]);
    }
    if (any) {
        json_t *blocks = page_section(r->document, "Reference");
        add_rays(r, blocks);
        report_table(r, noise, noise_columns, blocks, "Remaining noise:");
        report_table(r, changes, change_columns, blocks, "Influence of the assumptions, halved and doubled:");
    }
    free(noise);
    free(changes);
}
