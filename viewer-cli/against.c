/* --against truth: how far traced rays are from what a path tracer found. */
#include <math.h>

#include "against.h"
#include "command.h"
#include "args.h"
#include "table.h"

static void percent(struct table *table, double part) {
    if (isfinite(part)) table_cell(table, "%.2f", 100 * part);
    else table_cell(table, "∞");
}

void against_print(const struct glint_trace_table *rays) {
    static const char *const titles[] = {
        "<tracer",         "<ended by",     ">rays",           ">share %", ">within 5 % of truth",
        ">median error %", ">95th error %", ">radiance error", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < rays->count; i++) {
        const struct glint_trace_row *r = &rays->rows[i];
        table_cell(table, "%s", r->tracer);
        table_cell(table, "%s", r->text);
        table_cell(table, "%zu", r->rays);
        table_cell(table, "%.1f", 100 * r->share);
        table_cell(table, "%.1f", 100 * r->right);
        percent(table, r->median_error);
        percent(table, r->p95_error);
        if (isfinite(r->radiance_error)) table_cell(table, "%.4f", r->radiance_error);
        else table_cell(table, "-");
    }
    printf("\nrays of surfaces up to roughness %g, travelled distance against the truth's mirror ray:\n",
           AGAINST_ROUGHNESS);
    table_print(table, stdout);
    table_destroy(&table);
}

json_t *against_json(const struct glint_trace_table *table) {
    json_t *rows = json_array();
    for (size_t i = 0; i < table->count; i++) {
        const struct glint_trace_row *r = &table->rows[i];
        json_array_append_new(rows, json_pack("{s:s, s:s, s:I, s:o, s:o, s:o, s:o, s:o}", "tracer", r->tracer, "reason",
                                              r->reason, "rays", (json_int_t)r->rays, "share", json_number(r->share),
                                              "right", json_number(r->right), "median_error",
                                              json_number(r->median_error), "p95_error", json_number(r->p95_error),
                                              "radiance_error", json_number(r->radiance_error)));
    }
    return json_pack("{s:f, s:o}", "max_roughness", AGAINST_ROUGHNESS, "rays", rows);
}
