/* The errors of runs against truth and reference, stored in run folders and shown in reports. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "journal/journal.h"
#include "record.h"
#include "replay/against.h"
#include "report/report.h"
#include "io/output.h"

static bool errors_path(char path[4096], const char *folder, struct glint_error *err) {
    return snprintf(path, 4096, "%s/errors.json", folder) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

bool report_keep_errors(const char *folder, const struct comparison *compared, size_t count, struct glint_error *err) {
    char path[4096];
    if (!errors_path(path, folder, err)) return false;
    if (!count)
        return unlink(path) == 0 || errno == ENOENT || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    json_t *json = json_object();
    for (size_t c = 0; c < count; c++) against_json(&compared[c], json);
    char *text = record_text(json, JSON_INDENT(1));
    bool ok = text ? output_text(path, text, err) : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    free(text);
    json_decref(json);
    return ok;
}

/* ---- Tables and charts ---- */

static const struct part {
    const char *key, *title, *series;
} parts[] = {
    {"against_truth", "The result, against the truth in the capture.", "truth"},
    {"against_reference", "The same against the reference, which uses the same data: the error of the algorithms.",
     "reference"},
    {"missing_information", "Reference against the truth: error due to information that the capture does not contain.",
     "missing information"},
};

static const struct report_column error_columns[] = {
    {"surfaces", "surfaces", "", 1, false},
    {"pixels", "pixels", "", 1, false},
    {"mean error", "mean_error", "radiance", 1, false},
    {"RMSE", "rmse", "radiance", 1, false},
    {"without noise", "clean_rmse", "radiance", 1, true},
    {"relative MSE", "relative_mse", "", 1, false},
    {"without noise", "clean_relative_mse", "", 1, false},
    {"symmetric", "symmetric", "0 to 1", 1, true},
    {"PSNR", "psnr", "dB", 1, false},
    {"SSIM", "ssim", "", 1, false},
    {"FLIP", "flip", "0 to 1", 1, true},
    {"NaN or infinite", "invalid", "pixels", 1, false},
    {0},
};
static const struct report_column class_columns[] = {
    {"by", "set", "", 1, false},
    {"class", "class", "", 1, false},
    {"pixels", "pixels", "", 1, false},
    {"noise-free RMSE", "clean_rmse", "radiance", 1, true},
    {"symmetric", "symmetric", "0 to 1", 1, true},
    {"FLIP", "flip", "0 to 1", 1, true},
    {0},
};
static const struct report_column ray_columns[] = {
    {"tracer", "tracer", "", 1, false},
    {"ended by", "reason", "", 1, false},
    {"rays", "rays", "", 1, false},
    {"share", "share", "|%", 100, false},
    {"truth on screen", "truth.screen", "rays", 1, false},
    {"off screen", "truth.elsewhere", "rays", 1, false},
    {"sky", "truth.sky", "rays", 1, false},
    {"within 5 %", "right", "%", 100, false},
    {"median error", "median_error", "%", 100, false},
    {"95th error", "p95_error", "%", 100, false},
    {"radiance error", "radiance_error", "0 to 1", 1, false},
    {0},
};

static const json_t *rows_of(const json_t *errors, const char *part, const char *list) {
    const json_t *of = json_object_get(errors, part);
    return strcmp(list, "rays") == 0 ? json_object_get(of, list) : json_object_get(json_object_get(of, "image"), list);
}

static void add_table(const struct report *r, json_t *const *errors, const char *part, const char *list,
                      const struct report_column *columns, json_t *blocks, const char *title) {
    const json_t **rows = calloc(r->count, sizeof *rows);
    for (size_t k = 0; rows && k < r->count; k++) rows[k] = rows_of(errors[k], part, list);
    if (rows) report_table(r, rows, columns, blocks, title);
    free(rows);
}

/* The error of a row with its interval, as a point of a chart. */
static json_t *error_point(const json_t *row, const char *key, size_t place) {
    json_t *point = json_pack("{s:O?, s:I}", "x", json_object_get(row, key), "y", (json_int_t)place);
    const json_t *interval = report_interval(row, key);
    if (interval) json_object_set(point, "x_low", json_array_get(interval, 0));
    if (interval) json_object_set(point, "x_high", json_array_get(interval, 1));
    return point;
}

/* Rows of one run as points of horizontal bars; their categories are the rows' `name`. */
static json_t *error_points(const json_t *rows, const char *name, const char *key, const json_t *categories) {
    json_t *points = json_array(), *row, *category;
    size_t i, k;
    json_array_foreach(rows, i, row)
        json_array_foreach(categories, k, category) if (json_equal(category, json_object_get(row, name)))
            json_array_append_new(points, error_point(row, key, k));
    return points;
}

/* Adds the points of one run and part as a series, unless there are none. */
static void add_series(const struct report *r, size_t run, const char *what, json_t *points, json_t *series) {
    const char *label = r->count > 1 ? r->labels[run] : "", *between = label[0] && what[0] ? ": " : "";
    if (json_array_size(points))
        json_array_append_new(series, json_pack("{s:s, s:o, s:O}", "kind", "bar", "name",
                                                json_sprintf("%s%s%s", label, between, what), "points", points));
    json_decref(points);
}

/* Adds a bar chart. Takes ownership of `categories` and the series. */
static void add_chart(json_t *blocks, const char *title, const char *name, const char *unit, json_t *categories,
                      json_t *series) {
    size_t height = 120 + json_array_size(categories) * (10 + 13 * json_array_size(series));
    page_chart(blocks, json_pack("{s:s, s:{s:s, s:s, s:i}, s:{s:s, s:o}, s:I, s:o}", "title", title, "x", "name", name,
                                 "unit", unit, "min", 0, "y", "scale", "category", "categories", categories, "height",
                                 (json_int_t)height, "series", series));
}

static void add_surfaces(const struct report *r, const struct glint_effect *effect, json_t *const *errors,
                         json_t *blocks) {
    json_t *series = json_array(), *categories = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++)
        json_array_append_new(categories, json_string(glint_effect_class_name(effect, k)));
    for (size_t k = 0; k < r->count; k++)
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
            add_series(r, k, parts[p].series,
                       error_points(rows_of(errors[k], parts[p].key, "surfaces"), "surfaces", "clean_rmse", categories),
                       series);
    add_chart(blocks, "Error without the noise of truth and reference", "RMSE", "radiance", categories, series);
}

/* Adds missing categories to `categories`, and to each row its category: "hit: sky", as several sets use the same names. */
static void name_classes(const json_t *rows, json_t *categories) {
    json_t *row, *known;
    size_t i, n;
    json_array_foreach(rows, i, row) {
        json_t *name = json_sprintf("%s: %s", report_text(row, "set"), report_text(row, "class"));
        bool listed = false;
        json_array_foreach(categories, n, known) listed = listed || json_equal(known, name);
        if (!listed) json_array_append(categories, name);
        json_object_set_new(row, "category", name);
    }
}

/* Classes of pixels of the first part that has them. */
static void add_classes(const struct report *r, json_t *const *errors, json_t *blocks) {
    const char *part = NULL;
    for (size_t p = sizeof parts / sizeof *parts; p-- > 0;)
        for (size_t k = 0; k < r->count; k++)
            if (json_array_size(rows_of(errors[k], parts[p].key, "classes"))) part = parts[p].key;
    if (!part) return;
    json_t *categories = json_array(), *series = json_array();
    for (size_t k = 0; k < r->count; k++) {
        const json_t *rows = rows_of(errors[k], part, "classes");
        name_classes(rows, categories);
        add_series(r, k, "", error_points(rows, "category", "symmetric", categories), series);
    }
    page_text(blocks, "text", "Error by classes of pixels.");
    add_chart(blocks, "Symmetric error of classes of pixels", "mean of |found \u2212 true| / (|found| + |true|)", "",
              categories, series);
    add_table(r, errors, part, "classes", class_columns, blocks, "The same as a table, with other metrics:");
}

/* Notes on how the figures were computed. */
static void add_terms(const struct report *r, json_t *const *errors, json_t *blocks) {
    for (size_t k = 0; k < r->count; k++)
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
            const json_t *image = report_find(json_object_get(errors[k], parts[p].key), "image");
            const json_t *intervals = json_object_get(image, "intervals");
            char text[400];
            if (!intervals) continue;
            snprintf(text, sizeof text,
                     "Intervals hold %.0f %% of %lld resamples of tiles of %lld pixels a side. PSNR is below a peak of "
                     "%.4g; "
                     "FLIP sees %.1f pixels a degree.",
                     100 * json_number_value(json_object_get(intervals, "confidence")),
                     (long long)json_integer_value(json_object_get(intervals, "resamples")),
                     (long long)json_integer_value(json_object_get(intervals, "tile_px")),
                     json_number_value(json_object_get(image, "peak")),
                     json_number_value(json_object_get(image, "ppd")));
            page_text(blocks, "text", text);
            return;
        }
}

/* The errors of one effect in what report_keep_errors stored of a run; NULL: it was not compared. */
static json_t *errors_of(json_t *stored, const struct glint_effect *effect) {
    json_t *effects = json_object_get(stored, "effects");
    if (effects) return json_object_get(effects, effect->name);
    return strcmp(report_text(stored, "effect"), effect->name) == 0 ? stored : NULL;
}

static void add_effect(const struct report *r, const struct glint_effect *effect, json_t *const *errors) {
    char title[120];
    snprintf(title, sizeof title, "Error of the %.100s", effect->noun);
    json_t *blocks = page_section(r->document, title);
    add_surfaces(r, effect, errors, blocks);
    add_terms(r, errors, blocks);
    for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
        add_table(r, errors, parts[p].key, "surfaces", error_columns, blocks, parts[p].title);
    add_classes(r, errors, blocks);
    add_table(r, errors, "against_truth", "rays", ray_columns, blocks,
              "End reasons of rays of mirror-like surfaces, and their distance from the true hit points.");
}

void report_errors(const struct report *r) {
    size_t count;
    const struct glint_effect *effects = glint_effects(&count);
    json_t **stored = calloc(r->count, sizeof *stored), **errors = calloc(r->count, sizeof *errors);
    for (size_t k = 0; stored && k < r->count; k++) {
        char path[4096];
        if (errors_path(path, r->folders[k], NULL)) stored[k] = json_inside(path, NULL);
    }
    for (size_t e = 0; stored && errors && e < count; e++) {
        bool any = false;
        for (size_t k = 0; k < r->count; k++) any |= (errors[k] = errors_of(stored[k], &effects[e])) != NULL;
        if (any) add_effect(r, &effects[e], errors);
    }
    for (size_t k = 0; stored && k < r->count; k++) json_decref(stored[k]);
    free(stored);
    free(errors);
}
