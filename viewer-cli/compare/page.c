/* Comparison of presets as a page: error against time, errors by class, why rays ended, pictures. */
#include <math.h>
#include <string.h>

#include "compare/overall.h"
#include "draw/page/page.h"

static const char *label_of(const struct contest_table *t, size_t preset) {
    return t->contest->contestants[preset].label;
}

/* The error where a preset gives a result; null without one. [0] is all pixels. */
static json_t *error_json(const struct showing *s, size_t label) {
    const struct glint_image_error *e = &s->own.of[label];
    return s->ran && s->compared && e->pixels ? json_number(e->symmetric) : json_null();
}

static json_t *share_json(const struct showing *s, size_t label) {
    uint64_t all = s->ran ? s->judged[label] : 0;
    return all ? json_real(100 * (double)s->given[label] / (double)all) : json_null();
}

static json_t *time_json(const struct contest_time *time) {
    return time->n ? page_interval(time->median, time->min, time->max) : json_null();
}

/* ---- Pictures ---- */

static const char *row_title(const struct contest_pictures *pictures, size_t row) {
    static const char *const titles[CONTEST_ROWS] = {NULL, "Its error, 0 (dark) to 1 (bright); grey: not compared",
                                                     "Image"};
    return titles[row] ? titles[row] : pictures->effect->title;
}

/* A capture's pictures by column, the truth's first, without their values. */
static json_t *by_column(const struct contest_pictures *pictures) {
    json_t *columns = json_array(), *row, *shown;
    size_t r, i;
    for (i = 0; i < pictures->columns; i++) json_array_append_new(columns, json_array());
    json_array_foreach(pictures->rows, r, row) json_array_foreach(row, i, shown) {
        const size_t column = (size_t)json_integer_value(json_object_get(shown, "column"));
        json_t *caption =
            json_sprintf("%s: %s", json_string_value(json_object_get(shown, "caption")), row_title(pictures, r));
        json_array_append_new(json_array_get(columns, column),
                              json_pack("{s:O, s:o, s:O*}", "file", json_object_get(shown, "file"), "caption", caption,
                                        "beside", json_object_get(shown, "beside")));
    }
    return columns;
}

/* What is in the columns from the left: the truth was drawn last. */
static void add_stages(const struct contest_pictures *pictures, json_t *blocks) {
    json_t *row, *shown;
    size_t r, i;
    json_array_foreach(pictures->rows, r, row) {
        if (!json_array_size(row)) continue;
        page_text(blocks, "heading", row_title(pictures, r));
        json_t *stage = page_stage(blocks, row_title(pictures, r));
        for (size_t column = 0; column < pictures->columns; column++)
            json_array_foreach(row, i, shown) if ((size_t)json_integer_value(json_object_get(shown, "column")) ==
                                                  column) json_array_append(stage, shown);
    }
}

/* ---- Charts and tables of one capture ---- */

static json_t *values_of(const struct glint_effect *effect, const struct showing *s) {
    json_t *values = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++)
        json_array_append_new(values,
                              json_pack("[o, o, s]", json_sprintf("error, %s", glint_effect_class_name(effect, k)),
                                        error_json(s, k), ""));
    json_array_append_new(values, json_pack("[s, o, s]", "coverage", share_json(s, 0), "%"));
    json_array_append_new(values, json_pack("[s, o, s]", "steps", json_number(s->steps_px), "per pixel"));
    json_array_append_new(values, json_pack("[s, o, s]", "fetches", json_number(s->fetches_px), "per pixel"));
    json_array_append_new(values, json_pack("[s, o, s]", "when a cube map changes", time_json(&s->cubemaps), "ms"));
    return values;
}

static void add_times(const struct contest_table *t, size_t capture, const json_t *pictures, json_t *blocks) {
    json_t *series = json_array();
    for (size_t p = 0; p < t->contest->count; p++) {
        const struct showing *s = contest_showing(t, capture, p);
        if (!s->ran || !s->compared || s->frame.n == 0) continue;
        json_array_append_new(series,
                              json_pack("{s:s, s:s, s:[{s:f, s:f, s:f, s:o, s:s, s:o, s:O}]}", "kind", "scatter",
                                        "name", label_of(t, p), "points", "x", s->frame.median, "x_low", s->frame.min,
                                        "x_high", s->frame.max, "y", error_json(s, 0), "name", label_of(t, p), "values",
                                        values_of(t->contest->effect, s), "pictures", json_array_get(pictures, p + 1)));
    }
    if (json_array_size(series))
        page_chart(blocks, json_pack("{s:s, s:{s:s, s:s, s:i}, s:{s:s, s:s, s:i}, s:O}", "title", "Error against time",
                                     "x", "name", "time of a frame", "unit", "ms", "min", 0, "y", "name",
                                     "symmetric error", "unit", "0 to 1", "min", 0, "series", series));
    json_decref(series);
}

static void add_surfaces(const struct contest_table *t, size_t capture, json_t *blocks) {
    bool compared = false;
    for (size_t p = 0; p < t->contest->count; p++) compared = compared || contest_showing(t, capture, p)->compared;
    if (!compared) return;
    const size_t classes = glint_effect_class_count(t->contest->effect);
    json_t *series = json_array(), *names = json_array();
    for (size_t k = 0; k <= classes; k++)
        json_array_append_new(names, json_string(glint_effect_class_name(t->contest->effect, k)));
    for (size_t p = 0; p < t->contest->count; p++) {
        json_t *points = json_array();
        for (size_t k = 0; k <= classes; k++)
            json_array_append_new(points, json_pack("[o, i]", error_json(contest_showing(t, capture, p), k), (int)k));
        json_array_append_new(series,
                              json_pack("{s:s, s:s, s:o}", "kind", "bar", "name", label_of(t, p), "points", points));
    }
    page_chart(blocks,
               json_pack("{s:s, s:{s:s, s:s, s:i}, s:{s:s, s:o}, s:I, s:o}", "title", "Error by class", "x", "name",
                         "symmetric error", "unit", "0 to 1", "min", 0, "y", "scale", "category", "categories", names,
                         "height", (json_int_t)(120 + 4 * (10 + 13 * t->contest->count)), "series", series));
}

static void add_table(const struct contest_table *t, size_t capture, json_t *blocks) {
    json_t *table = page_table(blocks);
    page_column(table, "preset", "");
    page_column(table, "coverage", "%");
    const size_t classes = glint_effect_class_count(t->contest->effect);
    for (size_t k = 1; k <= classes + 1; k++)
        page_column(table, glint_effect_class_name(t->contest->effect, k % (classes + 1)), "error");
    page_column(table, "steps", "per pixel");
    page_column(table, "fetches", "per pixel");
    page_column(table, "frame", "ms");
    page_column(table, "cube maps", "ms");
    page_column(table, "notes", "");
    for (size_t p = 0; p < t->contest->count; p++) {
        const struct showing *s = contest_showing(t, capture, p);
        json_t *row = json_pack("[s, o]", label_of(t, p), share_json(s, 0));
        for (size_t k = 1; k <= classes + 1; k++) json_array_append_new(row, error_json(s, k % (classes + 1)));
        json_array_append_new(row, s->steps_px > 0 ? json_number(s->steps_px) : json_null());
        json_array_append_new(row, s->fetches_px > 0 ? json_number(s->fetches_px) : json_null());
        json_array_append_new(row, time_json(&s->frame));
        json_array_append_new(row, time_json(&s->cubemaps));
        json_array_append_new(row, json_string(s->failure[0] ? s->failure : s->notes ? s->notes : ""));
        page_row(table, row);
    }
}

/* Adds a preset's share of a reason to that reason's bars. */
static void add_end(json_t *reasons, const struct glint_end_row *row, size_t preset) {
    char name[200];
    snprintf(name, sizeof name, "%s: %s", row->tracer, row->text);
    if (!json_object_get(reasons, name)) json_object_set_new(reasons, name, json_array());
    json_array_append_new(json_object_get(reasons, name), json_pack("[f, I]", 100 * row->share, (json_int_t)preset));
}

static void add_ends(const struct contest_table *t, size_t capture, json_t *blocks) {
    json_t *reasons = json_object(), *presets = json_array(), *series = json_array(), *points;
    const char *name;
    for (size_t p = 0; p < t->contest->count; p++) {
        const struct showing *s = contest_showing(t, capture, p);
        json_array_append_new(presets, json_string(label_of(t, p)));
        for (size_t i = 0; s->ran && i < s->ends.count; i++) add_end(reasons, &s->ends.rows[i], p);
    }
    json_object_foreach(reasons, name, points) json_array_append_new(
        series, json_pack("{s:s, s:s, s:s, s:O}", "kind", "bar", "stack", "ends", "name", name, "points", points));
    if (json_array_size(series))
        page_chart(blocks, json_pack("{s:s, s:{s:s, s:s, s:i, s:i}, s:{s:s, s:O}, s:I, s:O}", "title",
                                     "End reasons of rays", "x", "name", "share of all rays", "unit", "%", "min", 0,
                                     "max", 100, "y", "scale", "category", "categories", presets, "height",
                                     (json_int_t)(190 + 30 * t->contest->count), "series", series));
    json_decref(reasons);
    json_decref(presets);
    json_decref(series);
}

/* Charts, table and pictures of a capture. */
static void add_details(json_t *blocks, const struct contest_table *t, const struct contest_pictures *pictures) {
    const size_t capture = pictures->capture;
    json_t *columns = by_column(pictures);
    add_times(t, capture, columns, blocks);
    add_surfaces(t, capture, blocks);
    add_table(t, capture, blocks);
    add_ends(t, capture, blocks);
    add_stages(pictures, blocks);
    json_decref(columns);
}

/* One of the worst: its pictures, and the rest when it is asked for. */
static void add_worst(json_t *blocks, const struct contest_table *t, const struct contest_pictures *pictures) {
    json_t *shown = json_array(), *columns = by_column(pictures), *column;
    size_t i;
    json_array_foreach(columns, i, column) {
        json_t *first = json_array_get(column, 0);
        if (!first) continue;
        json_array_append(shown, first);
    }
    page_text(blocks, "heading", t->captures[pictures->capture]);
    json_array_append_new(blocks, json_pack("{s:O}", "pictures", shown));
    add_details(page_fold(blocks, "Charts, table, all pictures"), t, pictures);
    json_decref(columns);
    json_decref(shown);
}

static void add_captures(json_t *document, const struct contest_table *t, const struct contest_pictures *pictures) {
    json_t *worst = NULL;
    if (t->rows) worst = page_section(document, "The worst captures");
    for (size_t k = 0; k < CAPTURES_SHOWN; k++) {
        const char *path = t->captures[pictures[k].capture];
        if (!pictures[k].drawn) continue;
        if (t->rows) add_worst(worst, t, &pictures[k]);
        else add_details(page_section(document, base_name(path)), t, &pictures[k]);
    }
}

bool contest_write_page(const char *folder, const struct contest_table *t, const struct contest_overall *overall,
                        const struct contest_pictures *pictures, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(t->contest->device);
    char path[4096], text[400];
    if (snprintf(path, sizeof path, "%s/index.html", folder) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    json_t *document = page_create("Comparison of presets");
    snprintf(text, sizeof text, "median of %u alternating rounds%s", t->contest->rounds,
             device->is_cpu ? "; a CPU device: times do not represent a GPU" : "");
    page_fact(document, "effect", t->contest->effect->title);
    page_fact(document, "device", device->name);
    page_fact(document, "times", text);
    page_fact(document, "errors",
              "mean of |found \u2212 truth| / (found + truth), 0 to 1, over the pixels for which the preset finds "
              "one");
    bool ok = document || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok && overall) contest_page_figures(document, t, overall);
    if (ok) add_captures(document, t, pictures);
    if (ok && overall && (t->rows || overall->unreadable)) contest_page_rows(document, t, overall);
    ok = ok && page_store(folder, document, err) && page_write(path, document, folder, err);
    json_decref(document);
    return ok;
}
