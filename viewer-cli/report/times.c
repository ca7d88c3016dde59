/* The times of the passes of runs in a report. */
#include <stdio.h>
#include <string.h>

#include "options/args.h"
#include "report/report.h"

/* Whether the times of a pass are those of a single round without warm-up. Runs that do not say so had one if they had one round. */
static bool is_cold(const json_t *pass) {
    const json_t *time = json_object_get(pass, "time_ns"), *cold = json_object_get(time, "cold");
    return cold ? json_is_true(cold) : json_integer_value(json_object_get(time, "n")) == 1;
}

static double pass_ms(const json_t *pass, const char *key) {
    return json_number_value(json_object_get(json_object_get(pass, "time_ns"), key)) / 1e6;
}

/* The pass of a run if it was timed in this category of work; else NULL. */
static const json_t *find_timed_pass(const json_t *run, const char *slot, bool cached_work) {
    const json_t *pass = report_pass(run, slot);
    bool same = json_is_true(json_object_get(pass, "cached_work")) == cached_work;
    return report_ran(pass) && same && json_is_object(json_object_get(pass, "time_ns")) ? pass : NULL;
}

/* Whether the times of a run are cold: those of its passes on the device, as work on the host has a single round. */
static bool run_is_cold(const json_t *run) {
    size_t i;
    json_t *pass;
    json_array_foreach(json_object_get(run, "passes"), i, pass) if (report_ran(pass) &&
                                                                    !json_object_get(pass, "host") &&
                                                                    json_is_object(json_object_get(pass, "time_ns")) &&
                                                                    pass_ms(pass, "max") > 0) return is_cold(pass);
    return false;
}

/* What tells a cold run's times from others wherever they appear. */
static const char *mark_of(const struct report *r, size_t run) {
    return run_is_cold(r->runs[run]) ? r->count > 1 ? " (cold)" : "cold" : "";
}

static bool any_is(const struct report *r, bool cold) {
    bool any = false;
    for (size_t i = 0; i < r->count; i++) any = any || run_is_cold(r->runs[i]) == cold;
    return any;
}

/* Cold times are not drawn beside others. */
static bool is_drawn(const struct report *r, size_t run) {
    return !run_is_cold(r->runs[run]) || !any_is(r, false);
}

/* The time, with those of the fastest and slowest round if there were several. */
static json_t *time_cell(const json_t *pass) {
    if (!pass) return json_null();
    bool several = json_integer_value(json_object_get(json_object_get(pass, "time_ns"), "n")) > 1;
    return several ? page_interval(pass_ms(pass, "median"), pass_ms(pass, "min"), pass_ms(pass, "max"))
                   : json_real(pass_ms(pass, "median"));
}

static json_t *time_point(const json_t *pass, size_t place) {
    json_t *cell = time_cell(pass),
           *point = json_pack("{s:o, s:I}", "x", json_number(pass_ms(pass, "median")), "y", (json_int_t)place);
    if (json_is_object(cell)) {
        json_object_set(point, "x_low", json_object_get(cell, "low"));
        json_object_set(point, "x_high", json_object_get(cell, "high"));
    }
    json_decref(cell);
    return point;
}

static json_t *time_series(const struct report *r, size_t run, const json_t *slots, bool cached_work) {
    json_t *points = json_array(), *slot;
    size_t i;
    json_array_foreach(slots, i, slot) {
        const json_t *pass = find_timed_pass(r->runs[run], json_string_value(slot), cached_work);
        if (pass) json_array_append_new(points, time_point(pass, i));
    }
    return json_pack("{s:o, s:s, s:o}", "name",
                     json_sprintf("%s%s", r->labels[run], run_is_cold(r->runs[run]) ? " (cold)" : ""), "kind", "bar",
                     "points", points);
}

static void add_table(const struct report *r, json_t *blocks, const json_t *slots, bool cached_work) {
    json_t *table = page_table(blocks), *slot;
    size_t i;
    page_column(table, "pass", "");
    for (size_t i = 0; i < r->count; i++) {
        char name[sizeof *r->labels + 16];
        snprintf(name, sizeof name, "%s%s", r->count > 1 ? r->labels[i] : "", mark_of(r, i));
        page_column(table, name, is_drawn(r, i) ? "|ms" : "ms");
    }
    json_array_foreach(slots, i, slot) {
        json_t *row = json_pack("[O]", slot);
        for (size_t k = 0; k < r->count; k++)
            json_array_append_new(row, time_cell(find_timed_pass(r->runs[k], json_string_value(slot), cached_work)));
        page_row(table, row);
    }
}

/* "Each frame: 12.3 ms": the sum over all passes of each run. */
static void add_sums(const struct report *r, json_t *blocks, const json_t *slots, bool cached_work) {
    char text[2048];
    size_t used = (size_t)snprintf(text, sizeof text, "%s", cached_work ? "When a cube map changes: " : "Each frame: ");
    for (size_t k = 0; k < r->count && used < sizeof text - 200; k++) {
        double sum = 0;
        size_t i;
        json_t *slot;
        json_array_foreach(slots, i, slot) {
            const json_t *pass = find_timed_pass(r->runs[k], json_string_value(slot), cached_work);
            if (pass) sum += pass_ms(pass, "median");
        }
        const char *label = r->count > 1 ? r->labels[k] : "", *mark = mark_of(r, k);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s%s%s%.3f ms", k ? "; " : "", label, mark,
                                 label[0] || mark[0] ? " " : "", sum);
    }
    snprintf(text + used, sizeof text - used, " (sum of the medians of the passes).");
    page_text(blocks, "text", text);
}

static void add_work(const struct report *r, json_t *blocks, bool cached_work) {
    json_t *slots = json_array(), *series = json_array(), *value;
    const char *slot;
    json_object_foreach(r->slots, slot, value) {
        bool any = false;
        for (size_t i = 0; i < r->count; i++) any = any || find_timed_pass(r->runs[i], slot, cached_work);
        if (any) json_array_append_new(slots, json_string(slot));
    }
    if (json_array_size(slots)) {
        add_sums(r, blocks, slots, cached_work);
        for (size_t i = 0; i < r->count; i++)
            if (is_drawn(r, i)) json_array_append_new(series, time_series(r, i, slots, cached_work));
        /* a single series has no legend to name it */
        const json_t *only =
            json_array_size(series) == 1 && r->count > 1 ? json_object_get(json_array_get(series, 0), "name") : NULL;
        page_chart(blocks,
                   json_pack("{s:o, s:{s:s, s:s, s:i}, s:{s:s, s:O}, s:O}", "title",
                             json_sprintf("%s%s%s", cached_work ? "Time when a cube map changes" : "Time of each frame",
                                          only ? ": " : "", only ? json_string_value(only) : ""),
                             "x", "name", "time", "unit", "ms", "min", 0, "y", "scale", "category", "categories", slots,
                             "series", series));
        add_table(r, blocks, slots, cached_work);
    }
    json_decref(slots);
    json_decref(series);
}

/* Says which runs' times are cold, and that they are not drawn beside others. */
static void note_cold(const struct report *r, json_t *blocks) {
    char text[1024];
    size_t used = 0;
    for (size_t i = 0; i < r->count && used < sizeof text - 400; i++)
        if (run_is_cold(r->runs[i]))
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "",
                                     r->count > 1 ? r->labels[i] : "these times");
    if (!used) return;
    snprintf(text + used, sizeof text - used,
             ": cold, from a single round without warm-up, so that they include costs of the first use%s. glint replay "
             "--repeat N measures.",
             any_is(r, false) ? "; not drawn beside the others" : "");
    page_text(blocks, "note", text);
}

/* Adds notes about times of CPU devices, one for each device. */
static void add_warnings(const struct report *r, json_t *blocks) {
    for (size_t i = 0; i < r->count; i++) {
        const json_t *device = json_object_get(r->runs[i], "device");
        bool listed = strcmp(report_text(device, "type"), "cpu") != 0;
        for (size_t k = 0; k < i && !listed; k++) listed = json_equal(device, json_object_get(r->runs[k], "device"));
        char text[600];
        snprintf(text, sizeof text, "%.200s: %.200s; times do not represent a GPU", report_text(device, "name"),
                 report_text(device, "times_are"));
        if (!listed) page_text(blocks, "note", text);
    }
}

void report_times(const struct report *r) {
    json_t *blocks = page_section(r->document, "Times");
    add_warnings(r, blocks);
    note_cold(r, blocks);
    add_work(r, blocks, false);
    add_work(r, blocks, true);
}
