/* Lists from run.json as tables. */
#include "report/report.h"

const json_t *report_interval(const json_t *row, const char *key) {
    return json_object_get(json_object_get(row, "interval"), key);
}

static json_t *cell_of(const json_t *row, const struct report_column *column) {
    const json_t *value = report_find(row, column->key),
                 *interval = column->interval ? report_interval(row, column->key) : NULL;
    if (json_is_number(value) && interval)
        return page_interval(json_number_value(value), json_number_value(json_array_get(interval, 0)),
                             json_number_value(json_array_get(interval, 1)));
    if (json_is_number(value) && column->scale != 1) return json_real(json_number_value(value) * column->scale);
    return value ? json_incref((json_t *)value) : json_null();
}

void report_table(const struct report *r, const json_t *const *lists, const struct report_column *columns,
                  json_t *blocks, const char *title) {
    size_t rows = 0, i;
    json_t *row;
    for (size_t k = 0; k < r->count; k++) rows += json_array_size(lists[k]);
    if (rows == 0) return;
    page_text(blocks, "text", title);
    json_t *table = page_table(blocks);
    if (r->count > 1) page_column(table, "run", "");
    for (const struct report_column *c = columns; c->name; c++) page_column(table, c->name, c->unit);
    for (size_t k = 0; k < r->count; k++) json_array_foreach(lists[k], i, row) {
            json_t *cells = r->count > 1 ? json_pack("[s]", r->labels[k]) : json_array();
            for (const struct report_column *c = columns; c->name; c++) json_array_append_new(cells, cell_of(row, c));
            page_row(table, cells);
        }
}
