/* The page of a sweep: the Pareto fronts as charts, whose points show their values and pictures, and as tables. */
#include <math.h>
#include <stdlib.h>

#include "draw/page/page.h"
#include "journal/drawing.h"
#include "sweep/sweep.h"

static void add_picture(const struct sweep *sweep, json_t *pictures, const char *name, const char *caption) {
    drawing_add(pictures, sweep->out, name, caption, sweep_is_large(sweep));
}

static json_t *pictures_of(const struct sweep *sweep, size_t p) {
    json_t *pictures = json_array();
    for (size_t i = 0; i < sweep->overall.shown_count; i++) {
        const size_t c = sweep->overall.shown[i];
        char name[96], caption[200];
        sweep_picture_name("picture", c, p, name);
        snprintf(caption, sizeof caption, "%.100s", base_name(sweep->captures.items[c]));
        add_picture(sweep, pictures, name, caption);
        sweep_picture_name("error", c, p, name);
        snprintf(caption, sizeof caption, "%.100s, error", base_name(sweep->captures.items[c]));
        add_picture(sweep, pictures, name, caption);
    }
    return pictures;
}

static void add_value(json_t *values, const char *name, json_t *cell, const char *unit) {
    json_array_append_new(values, json_pack("[s, o, s]", name, cell, unit));
}

/* Values of a point on the page: settings, errors by class, costs. */
static json_t *values_of(const struct sweep *sweep, size_t p) {
    const struct sweep_point *s = &sweep->sums[p];
    json_t *values = json_array();
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++) {
        const char *value = glint_space_value(sweep->space, p, a);
        add_value(values, glint_space_axis(sweep->space, a), value[0] ? json_string(value) : json_null(), "");
    }
    for (size_t i = 0; i < sweep->overall.shown_count; i++) {
        const size_t c = sweep->overall.shown[i];
        struct sweep_lines lines = sweep_read(sweep, c, p);
        for (size_t k = 0; sweep_class(sweep, k); k++) {
            char name[200];
            const double error = sweep_error(lines.look, glint_target_name(answer_args_kind(&sweep->against)),
                                             sweep_class(sweep, k), sweep->metric);
            if (!isfinite(error)) continue;
            snprintf(name, sizeof name, "%.60s, %s: %.60s", base_name(sweep->captures.items[c]), sweep_class(sweep, k),
                     glint_metric(sweep->metric)->title);
            add_value(values, name, json_number(error), "");
        }
        sweep_release(sweep, &lines);
    }
    if (sweep->rounds) {
        add_value(values, "GPU time", page_interval(s->frame_ms.mean, s->low_ms, s->high_ms), "ms");
        add_value(values, "work on cube maps", json_number(s->cubemaps_ms.mean), "ms");
    }
    add_value(values, "steps", json_number(s->steps_px.mean), "per pixel");
    add_value(values, "fetches", json_number(s->fetches_px.mean), "per pixel");
    return values;
}

static json_t *chart_point(const struct sweep *sweep, const struct sweep_front *front, size_t p, bool whole) {
    const struct sweep_point *s = &sweep->sums[p];
    const struct sweep_sum cost = front->time ? s->frame_ms : s->fetches_px;
    char name[32];
    snprintf(name, sizeof name, "point %zu", p);
    json_t *point = json_pack("{s:o, s:o, s:s}", "x", json_number(front->worst ? cost.worst : cost.mean), "y",
                              json_number(front->worst ? s->error.worst : s->error.mean), "name", name);
    if (front->time && !front->worst && s->high_ms > s->low_ms) {
        json_object_set_new(point, "x_low", json_number(s->low_ms));
        json_object_set_new(point, "x_high", json_number(s->high_ms));
    }
    if (!whole) return point;
    json_object_set_new(point, "values", values_of(sweep, p));
    json_object_set_new(point, "pictures", pictures_of(sweep, p));
    return point;
}

static json_t *chart_of(const struct sweep *sweep, const struct sweep_front *front, bool whole) {
    json_t *best = json_array(), *others = json_array();
    double lowest = INFINITY, highest = 0;
    for (size_t i = 0; i < front->count; i++)
        json_array_append_new(best, chart_point(sweep, front, front->points[i], whole));
    for (size_t p = 0; p < sweep->points; p++) {
        const struct sweep_sum cost = front->time ? sweep->sums[p].frame_ms : sweep->sums[p].fetches_px;
        if (!sweep->sums[p].valid || !isfinite(cost.mean)) continue;
        lowest = fmin(lowest, cost.mean);
        highest = fmax(highest, cost.mean);
        if (!front->on[p]) json_array_append_new(others, chart_point(sweep, front, p, whole));
    }
    char title[200];
    snprintf(title, sizeof title, "%s against %s", glint_metric(sweep->metric)->title, front->title);
    return json_pack("{s:s, s:{s:s, s:s, s:s}, s:{s:s, s:s}, s:[{s:s, s:s, s:b, s:o}, {s:s, s:s, s:o}]}", "title",
                     title, "x", "name", front->time ? "GPU time" : "texture fetches", "unit",
                     front->time ? "ms" : "per pixel", "scale", highest > 20 * lowest && lowest > 0 ? "log" : "linear",
                     "y", "name", glint_metric(sweep->metric)->title, "unit", "", "series", "name", "all points",
                     "kind", "scatter", "muted", true, "points", others, "name", "Pareto-optimal", "kind", "front",
                     "points", best);
}

static void add_table(const struct sweep *sweep, const struct sweep_front *front, json_t *blocks) {
    json_t *table = page_table(blocks);
    page_column(table, "point", "");
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++)
        page_column(table, glint_space_axis(sweep->space, a), "");
    page_column(table, glint_metric(sweep->metric)->title, "");
    if (sweep->rounds) page_column(table, "GPU time", "ms");
    page_column(table, "fetches", "per pixel");
    for (size_t i = 0; i < front->count; i++) {
        const size_t p = front->points[i];
        const struct sweep_point *s = &sweep->sums[p];
        json_t *row = json_array();
        json_array_append_new(row, json_integer((json_int_t)p));
        for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++) {
            const char *value = glint_space_value(sweep->space, p, a);
            char *end;
            const double number = strtod(value, &end);
            json_array_append_new(row, !value[0] ? json_null() : *end ? json_string(value) : json_number(number));
        }
        json_array_append_new(row, json_number(front->worst ? s->error.worst : s->error.mean));
        if (sweep->rounds)
            json_array_append_new(row, front->worst ? json_number(s->frame_ms.worst)
                                                    : page_interval(s->frame_ms.mean, s->low_ms, s->high_ms));
        json_array_append_new(row, json_number(front->worst ? s->fetches_px.worst : s->fetches_px.mean));
        page_row(table, row);
    }
}

/* Pictures of the difference between neighbouring points of the front. */
static void add_changes(const struct sweep *sweep, const struct sweep_front *front, json_t *blocks) {
    json_t *pictures = json_array();
    for (size_t i = 0; i + 1 < front->count; i++)
        for (size_t k = 0; k < sweep->overall.shown_count; k++) {
            const size_t c = sweep->overall.shown[k];
            char name[96], caption[400];
            char *to = sweep_point_text(sweep, front->points[i + 1]);
            sweep_change_name(c, front->points[i], front->points[i + 1], name);
            snprintf(caption, sizeof caption, "%.60s: from point %zu to %zu (%.250s)",
                     base_name(sweep->captures.items[c]), front->points[i], front->points[i + 1], to ? to : "");
            add_picture(sweep, pictures, name, caption);
            free(to);
        }
    if (json_array_size(pictures)) {
        page_text(blocks, "text", "Difference between neighbouring points, |a − b| / (a + b):");
        json_array_append_new(blocks, json_pack("{s:O}", "pictures", pictures));
    }
    json_decref(pictures);
}

static void add_facts(const struct sweep *sweep, json_t *document) {
    const struct glint_device_info *device = glint_device_get_info(sweep->device);
    char text[400];
    snprintf(text, sizeof text, "%zu", sweep->captures.count);
    if (sweep_is_large(sweep)) page_fact(document, "captures", text);
    for (size_t c = 0; c < sweep->captures.count && !sweep_is_large(sweep); c++)
        page_fact(document, "capture", sweep->captures.items[c]);
    page_fact(document, "preset", glint_pipeline_name(sweep->base));
    page_fact(document, "errors against", sweep->against.truth ? "the truth in the capture" : "the reference");
    page_fact(document, "device", device->name);
    snprintf(text, sizeof text, "median of %u alternating rounds%s%s", sweep->rounds,
             sweep->whole ? ", all passes of each point" : ", shared passes timed once a round",
             device->is_cpu ? "; a CPU device: times do not represent a GPU" : "");
    if (sweep->rounds) page_fact(document, "times", text);
}

static bool write_charts(const struct sweep *sweep, struct page_charts *charts, struct glint_error *err) {
    bool ok = true;
    for (size_t f = 0; ok && f < sweep->front_count; f++) {
        char path[4096], name[64];
        snprintf(name, sizeof name, "front-%s.svg", sweep->fronts[f].name);
        json_t *chart = chart_of(sweep, &sweep->fronts[f], false);
        ok = chart ? sweep_path(sweep, name, path, err) && page_chart_write(charts, path, chart, err)
                   : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        json_decref(chart);
    }
    return ok;
}

bool sweep_write_page(const struct sweep *sweep, struct glint_error *err) {
    char title[300], path[4096];
    struct page_charts charts = {0};
    size_t length = 0;
    for (size_t a = 0; a < glint_space_axis_count(sweep->space) && length < sizeof title; a++)
        length += (size_t)snprintf(title + length, sizeof title - length, "%s%s", a ? ", " : "Sweep of ",
                                   glint_space_axis(sweep->space, a));
    json_t *document = page_create(title);
    if (!document) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    add_facts(sweep, document);
    bool ok = sweep_add_curve(sweep, &charts, document, err);
    for (size_t f = 0; f < sweep->front_count; f++) {
        const struct sweep_front *front = &sweep->fronts[f];
        snprintf(title, sizeof title, "By %s", front->title);
        json_t *blocks = page_section(document, title);
        page_chart(blocks, chart_of(sweep, front, true));
        add_table(sweep, front, blocks);
        add_changes(sweep, front, blocks);
    }
    if (sweep->captures.count > 1) sweep_page_overall(sweep, document);
    sweep_page_captures(sweep, document);
    ok = ok && sweep_path(sweep, "index.html", path, err) && page_store(sweep->out, document, err) &&
         page_write(path, document, sweep->out, err) && write_charts(sweep, &charts, err);
    page_charts_finish(&charts);
    json_decref(document);
    return ok;
}
