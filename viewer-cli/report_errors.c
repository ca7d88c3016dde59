/* How far runs are from a better answer, kept beside them and told in a report. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "against.h"
#include "report.h"
#include "text_file.h"

static bool errors_path(char path[4096], const char *folder, struct glint_error *err) {
    return snprintf(path, 4096, "%s/errors.json", folder) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

bool report_keep_errors(const char *folder, const struct comparison *compared, struct glint_error *err) {
    char path[4096];
    if (!errors_path(path, folder, err)) return false;
    if (!compared)
        return unlink(path) == 0 || errno == ENOENT || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    json_t *json = json_object();
    against_json(compared, json);
    char *text = json_dumps(json, JSON_INDENT(1));
    bool ok = text ? text_file_write(path, text, err) : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    free(text);
    json_decref(json);
    return ok;
}

/* ---- Told ---- */

static const struct part {
    const char *key, *title, *series;
} parts[] = {
    {"against_truth", "The reflection, before it is composed, against the truth of the capture.", "truth"},
    {"against_reference", "The same against the reference, which has the same data: the error of the algorithms.",
     "reference"},
    {"missing_information", "The reference against the truth: what the capture's data lack.", "missing information"},
};

/* Columns of a table and members of errors.json. */
struct column {
    const char *name, *key, *unit;
    double scale;
};
static const struct column error_columns[] = {
    {"surfaces", "surfaces", "", 1},
    {"pixels", "pixels", "", 1},
    {"mean", "truth_mean", "radiance", 1},
    {"mean error", "mean_error", "radiance", 1},
    {"RMSE", "rmse", "radiance", 1},
    {"relative MSE", "relative_mse", "", 1},
    {"symmetric", "symmetric", "0 to 1", 1},
    {"its noise", "truth_noise", "radiance", 1},
    {"RMSE without", "clean_rmse", "radiance", 1},
    {"NaN or infinite", "invalid", "pixels", 1},
    {NULL, NULL, NULL, 0},
};
static const struct column ray_columns[] = {
    {"tracer", "tracer", "", 1},
    {"ended by", "reason", "", 1},
    {"rays", "rays", "", 1},
    {"share", "share", "|%", 100},
    {"within 5 %", "right", "%", 100},
    {"median error", "median_error", "%", 100},
    {"95th error", "p95_error", "%", 100},
    {"radiance error", "radiance_error", "0 to 1", 1},
    {NULL, NULL, NULL, 0},
};

static json_t *cell_of(const json_t *row, const struct column *column) {
    json_t *value = json_object_get(row, column->key);
    if (json_is_number(value) && column->scale != 1) return json_real(json_number_value(value) * column->scale);
    return value ? json_incref(value) : json_null();
}

static const json_t *rows_of(const json_t *errors, const char *part, const char *list) {
    const json_t *of = json_object_get(errors, part);
    return strcmp(list, "rays") == 0 ? json_object_get(of, list) : json_object_get(json_object_get(of, "image"), list);
}

/* The rows of every run, each with its run's name if there are several. */
static void add_table(const struct report *r, json_t *const *errors, const char *part, const char *list,
                      const struct column *columns, json_t *blocks, const char *title) {
    size_t rows = 0, i;
    json_t *row;
    for (size_t k = 0; k < r->count; k++) rows += json_array_size(rows_of(errors[k], part, list));
    if (rows == 0) return;
    page_text(blocks, "text", title);
    json_t *table = page_table(blocks);
    if (r->count > 1) page_column(table, "run", "");
    for (const struct column *c = columns; c->name; c++) page_column(table, c->name, c->unit);
    for (size_t k = 0; k < r->count; k++) json_array_foreach(rows_of(errors[k], part, list), i, row) {
            json_t *cells = r->count > 1 ? json_pack("[s]", r->labels[k]) : json_array();
            for (const struct column *c = columns; c->name; c++) json_array_append_new(cells, cell_of(row, c));
            page_row(table, cells);
        }
}

/* One run's errors of one part, surfaces in the order of `categories`. */
static json_t *error_points(const json_t *errors, const char *part, const json_t *categories) {
    json_t *points = json_array(), *row, *category;
    size_t i, k;
    json_array_foreach(rows_of(errors, part, "surfaces"), i, row)
        json_array_foreach(categories, k, category) if (json_equal(category, json_object_get(row, "surfaces")))
            json_array_append_new(points,
                                  json_pack("{s:O, s:I}", "x", json_object_get(row, "clean_rmse"), "y", (json_int_t)k));
    return points;
}

static void add_chart(const struct report *r, json_t *const *errors, json_t *blocks) {
    json_t *series = json_array(), *categories = json_pack("[s, s, s, s]", "all", "mirror-like", "glossy", "rough");
    for (size_t k = 0; k < r->count; k++)
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
            json_t *points = error_points(errors[k], parts[p].key, categories);
            if (json_array_size(points))
                json_array_append_new(series, json_pack("{s:s, s:o, s:O}", "kind", "bar", "name",
                                                        json_sprintf("%s%s%s", r->count > 1 ? r->labels[k] : "",
                                                                     r->count > 1 ? ": " : "", parts[p].series),
                                                        "points", points));
            json_decref(points);
        }
    page_chart(blocks, json_pack("{s:s, s:{s:s, s:s, s:i}, s:{s:s, s:o}, s:I, s:o}", "title",
                                 "Error without the noise of truth and reference", "x", "name", "RMSE", "unit",
                                 "radiance", "min", 0, "y", "scale", "category", "categories", categories, "height",
                                 (json_int_t)(120 + 14 * 4 * json_array_size(series)), "series", series));
}

void report_errors(const struct report *r) {
    json_t **errors = calloc(r->count, sizeof *errors);
    bool any = false;
    for (size_t k = 0; errors && k < r->count; k++) {
        char path[4096];
        if (errors_path(path, r->folders[k], NULL)) errors[k] = json_load_file(path, 0, NULL);
        any = any || errors[k];
    }
    if (any) {
        json_t *blocks = page_section(r->document, "Error");
        add_chart(r, errors, blocks);
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
            add_table(r, errors, parts[p].key, "surfaces", error_columns, blocks, parts[p].title);
        add_table(r, errors, "against_truth", "rays", ray_columns, blocks,
                  "Why rays of mirror-like surfaces ended, and how far they are from the truth's.");
    }
    for (size_t k = 0; errors && k < r->count; k++) json_decref(errors[k]);
    free(errors);
}
