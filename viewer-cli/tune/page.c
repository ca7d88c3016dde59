/* The page of glint tune: all points, the path of the best, changed parameters, and the final comparison. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw/page/page.h"
#include "tune/overall.h"
#include "tune/tune.h"

static void values_of(const struct tune *tune, const double *values, json_t *list) {
    for (size_t a = 0; a < tune->axis_count; a++) {
        char text[TUNE_TEXT], from[TUNE_TEXT];
        tune_value_text(&tune->axes[a], values[a], text);
        tune_value_text(&tune->axes[a], tune->axes[a].axis.start, from);
        if (strcmp(text, from) != 0) json_array_append_new(list, json_pack("[s, s, s]", tune->axes[a].name, text, ""));
    }
}

static json_t *chart_point(const struct tune *tune, size_t p, bool whole) {
    const struct glint_search_point *point = &tune->found.points[p];
    char name[32];
    snprintf(name, sizeof name, "point %zu", p + 1);
    json_t *json = json_pack(
        "{s:o, s:o, s:s}", "x", json_number(tune->by_error ? point->figures.objective : point->figures.constraint), "y",
        json_number(tune->by_error ? point->figures.constraint : point->figures.objective), "name", name);
    json_t *values = json_array();
    if (whole) values_of(tune, point->values, values);
    if (whole) json_object_set(json, "values", values);
    json_decref(values);
    return json;
}

static bool point_is_known(const struct tune *tune, size_t p) {
    const struct glint_search_figures *figures = &tune->found.points[p].figures;
    return isfinite(figures->objective) && isfinite(figures->constraint);
}

/* Chart of all points, the successive best points joined by a line, the start, and the scaled start. */
static json_t *chart(const struct tune *tune, bool whole) {
    json_t *all = json_array(), *path = json_array(), *chosen = json_array(), *scaled = json_array(),
           *marks = json_array();
    size_t best = 0;
    char title[200], limit[100];
    for (size_t p = 0; p < tune->found.count; p++) {
        if (!point_is_known(tune, p)) continue;
        json_array_append_new(all, chart_point(tune, p, whole));
        if (p && !glint_search_better(&tune->found.points[p].figures, &tune->found.points[best].figures, tune->within))
            continue;
        best = p;
        json_array_append_new(path, chart_point(tune, p, whole));
    }
    json_array_append_new(chosen, chart_point(tune, tune->chosen, whole));
    if (tune->contenders[TUNE_SCALED])
        json_array_append_new(scaled, json_pack("{s:f, s:f, s:s}", "x", tune->scaled.cost, "y", tune->scaled.error,
                                                "name", "scaled start"));
    snprintf(limit, sizeof limit, "the limit, %.4g", tune->within);
    json_array_append_new(marks, json_pack("{s:f, s:s}", tune->by_error ? "y" : "x", tune->within, "label", limit));
    json_array_append_new(
        marks, json_pack("{s:f, s:f, s:s}", "x", tune->start.cost, "y", tune->start.error, "label", "start"));
    snprintf(title, sizeof title, "%s against %s", glint_metric(tune->metric)->title,
             tune->fetches ? "texture fetches" : "GPU time");
    return json_pack(
        "{s:s, s:{s:s, s:s}, s:{s:s, s:s}, s:[{s:s, s:s, s:b, s:o}, {s:s, s:s, s:o}, {s:s, s:s, s:o}, {s:s, "
        "s:s, s:o}], s:o}",
        "title", title, "x", "name", tune->fetches ? "texture fetches" : "GPU time", "unit",
        tune->fetches ? "per pixel" : "ms", "y", "name", glint_metric(tune->metric)->title, "unit", "", "series",
        "name", "evaluated", "kind", "scatter", "muted", true, "points", all, "name", "best so far", "kind", "line",
        "points", path, "name", "chosen", "kind", "scatter", "points", chosen, "name", "scaled start", "kind",
        "scatter", "points", scaled, "marks", marks);
}

static void add_moved(const struct tune *tune, json_t *document) {
    json_t *table = page_table(page_section(document, "Changed parameters"));
    const double *values = tune->found.points[tune->chosen].values;
    page_column(table, "parameter", ""), page_column(table, "from", ""), page_column(table, "to", "");
    page_column(table, "unit", ""), page_column(table, "what it does", "");
    for (size_t a = 0; a < tune->axis_count; a++) {
        const struct tune_axis *axis = &tune->axes[a];
        char from[TUNE_TEXT], to[TUNE_TEXT];
        tune_value_text(axis, axis->axis.start, from);
        tune_value_text(axis, values[a], to);
        if (strcmp(from, to) != 0)
            page_row(table,
                     json_pack("[s, s, s, s, s]", axis->name, from, to,
                               axis->row && !axis->texts ? axis->row->unit : "", axis->row ? axis->row->help : ""));
    }
}

static void add_contenders(const struct tune *tune, size_t s, json_t *document) {
    char title[200];
    snprintf(title, sizeof title, "%.150s%s", base_name(tune->subjects[s].path),
             tune->subjects[s].held_out ? ", held out" : "");
    json_t *blocks = page_section(document, title), *table = page_table(blocks);
    const struct tune_measured *measured = tune->measured + s * TUNE_CONTENDERS;
    const struct glint_metric_table *rows = &measured[TUNE_START].errors;
    page_column(table, "", "");
    for (size_t r = 0; r < rows->count; r++)
        page_column(table, r ? rows->rows[r].name : glint_metric(tune->metric)->title, "");
    page_column(table, "fetches", "per pixel");
    if (tune->repeat) page_column(table, "GPU time", "ms"), page_column(table, "time of tuned", "relative");
    for (int k = 0; k < TUNE_CONTENDERS; k++) {
        if (!tune->contenders[k]) continue;
        json_t *row = json_array();
        char name[64];
        snprintf(name, sizeof name, "start, scaled × %.3g", tune->subjects[s].factor);
        json_array_append_new(row, json_string(k == TUNE_SCALED ? name : tune_contenders[k]));
        for (size_t r = 0; r < rows->count; r++) {
            const struct glint_figure figure = measured[k].errors.rows[r].of[tune->metric];
            json_array_append_new(row, measured[k].errors.rows[r].pixels
                                           ? page_interval(figure.value, figure.low, figure.high)
                                           : json_null());
        }
        json_array_append_new(row, json_number(measured[k].fetches_px));
        const struct tune_median ms = measured[k].ms, part = measured[k].part;
        if (tune->repeat) json_array_append_new(row, page_interval(ms.value, ms.low, ms.high));
        if (tune->repeat) json_array_append_new(row, page_interval(part.value, part.low, part.high));
        page_row(table, row);
    }
    page_text(blocks, "text",
              "Error of tuned minus error of the other, with its 95 % interval (the same image tiles are resampled in "
              "both):");
    table = page_table(blocks);
    page_column(table, "against", "");
    for (size_t r = 0; r < rows->count; r++) page_column(table, rows->rows[r].name, "");
    for (int k = 0; k < TUNE_CONTENDERS; k++) {
        if (k == TUNE_TUNED || !tune->contenders[k]) continue;
        json_t *row = json_pack("[s]", tune_contenders[k]);
        for (size_t r = 0; r < rows->count; r++) {
            struct glint_figure d;
            json_array_append_new(row, tune_difference(tune, s, k, TUNE_TUNED, r, &d)
                                           ? page_interval(d.value, d.low, d.high)
                                           : json_null());
        }
        page_row(table, row);
    }
}

static void add_left(const struct tune *tune, json_t *document) {
    json_t *table = page_table(page_section(document, "Parameters that were not tuned"));
    page_column(table, "parameter", ""), page_column(table, "it", "");
    for (size_t i = 0; i < tune->left_count; i++)
        page_row(table, json_pack("[s, s]", tune->left[i].name, tune->left[i].why));
    for (size_t a = 0; a < tune->axis_count; a++)
        if (!tune->found.matters[a]) page_row(table, json_pack("[s, s]", tune->axes[a].name, TUNE_NO_EFFECT));
}

static void add_facts(const struct tune *tune, json_t *document) {
    const struct glint_device_info *device = glint_device_get_info(tune->device);
    char text[200];
    for (size_t s = 0; s < tune->captures.count; s++) page_fact(document, "tuned on", tune->captures.items[s]);
    for (size_t s = 0; s < tune->held_out.count; s++) page_fact(document, "held out", tune->held_out.items[s]);
    page_fact(document, "start", glint_pipeline_name(tune->base));
    page_fact(document, "preset", tune->out);
    page_fact(document, "errors against", tune->against.truth ? "the truth in the captures" : "the reference");
    if (tune->captures.count > 1) page_fact(document, "over captures", tune->worst ? "the worst" : "the mean");
    page_fact(document, "device", device->name);
    snprintf(text, sizeof text, "%zu points, seed %u", tune->found.count, tune->seed);
    page_fact(document, "search", text);
    page_fact(document, "command", tune->command_line);
}

bool tune_write_page(const struct tune *tune, struct glint_error *err) {
    char title[300], html[4096], svg[4096], name[200];
    struct page_charts charts = {0};
    const char *base = base_name(tune->out);
    const int length = (int)(strlen(base) - strlen(".json"));
    snprintf(title, sizeof title, "%.100s, tuned to %.4g %s at most", glint_pipeline_name(tune->base), tune->within,
             tune->by_error ? glint_metric(tune->metric)->title : tune_cost_unit(tune));
    json_t *document = page_create(title);
    if (!document) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    add_facts(tune, document);
    page_chart(page_section(document, "All evaluated points"), chart(tune, true));
    add_moved(tune, document);
    if (tune->overall) tune_page_overall(tune, document);
    for (size_t i = 0; tune->overall && i < tune->subject_count; i++)
        if (tune_is_shown(tune, i)) add_contenders(tune, tune_ranked(tune, i), document);
    add_left(tune, document);
    json_t *plain = chart(tune, false);
    snprintf(name, sizeof name, "%.*s.html", length, base);
    bool ok = journal_path(tune->folder, name, html, err);
    snprintf(name, sizeof name, "%.*s.svg", length, base);
    ok = ok && journal_path(tune->folder, name, svg, err) && page_store(tune->folder, document, err) &&
         page_write(html, document, NULL, err) && page_chart_write(&charts, svg, plain, err);
    page_charts_finish(&charts);
    json_decref(plain);
    json_decref(document);
    return ok;
}
