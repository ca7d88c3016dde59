/* Describes run folders: pictures, times, plan, parameters, device. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/args.h"
#include "glint/replay.h"
#include "report/report.h"

/* ---- Reading ---- */

/* The slots of all runs in the order of their first appearance, as keys of an object. */
static json_t *collect_slots(const struct report *r) {
    json_t *slots = json_object(), *pass;
    size_t k;
    for (size_t i = 0; i < r->count; i++)
        json_array_foreach(json_object_get(r->runs[i], "passes"), k, pass)
            json_object_set_new(slots, report_text(pass, "slot"), json_true());
    return slots;
}

/* Labels runs by the last component of their path, or by the whole path where labels would be equal. */
static void label_runs(struct report *r) {
    for (size_t i = 0; i < r->count; i++) {
        const char *path = r->folders[i];
        size_t length = strlen(path);
        while (length > 1 && path[length - 1] == '/') length--;
        const char *name = path + length;
        while (name > path && name[-1] != '/') name--;
        snprintf(r->labels[i], sizeof r->labels[i], "%.*s", (int)(path + length - name), name);
    }
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < i; k++)
            if (!strcmp(r->labels[i], r->labels[k]))
                snprintf(r->labels[i], sizeof r->labels[i], "%.80s", r->folders[i]);
}

static bool read_runs(struct report *r, struct glint_error *err) {
    r->runs = calloc(r->count, sizeof *r->runs);
    r->labels = calloc(r->count, sizeof *r->labels);
    if (!r->runs || !r->labels) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < r->count; i++) {
        struct glint_run *run = glint_run_open(r->folders[i], err);
        r->runs[i] = run ? json_loads(glint_run_json(run), 0, NULL) : NULL;
        glint_run_close(&run);
        if (!r->runs[i]) return false;
    }
    label_runs(r);
    return true;
}

/* ---- Facts ---- */

/* Facts from run.json; "a.b" is the member b of a. */
static const struct fact {
    const char *name, *key, *unit;
} facts[] = {
    {"capture", "capture.path", ""},
    {"capture's digest (XXH3)", "capture.xxh3_128", ""},
    {"frame", "frame", ""},
    {"preset", "preset", ""},
    {"rays a pixel", "rays", ""},
    {"resolution", "resolution.full", ""},
    {"images", "precision", ""},
    {"device", "device.name", ""},
    {"driver", "device.driver_version", ""},
    {"times", "device.times_are", ""},
    {"memory at its peak", "peak_memory_bytes", "bytes"},
    {"written by glint", "tool.version", ""},
    {"warnings", "warnings", ""},
};

/* "960 × 540" for [960, 540]; lists of texts are joined. */
static json_t *fact_json(const json_t *run, const struct fact *fact) {
    const json_t *value = report_find(run, fact->key);
    char text[512] = "";
    if (json_is_array(value)) {
        for (size_t i = 0; i < json_array_size(value); i++) {
            const json_t *item = json_array_get(value, i);
            size_t used = strlen(text);
            if (json_is_integer(item))
                snprintf(text + used, sizeof text - used, "%s%lld", i ? " \u00d7 " : "",
                         (long long)json_integer_value(item));
            else if (json_is_string(item))
                snprintf(text + used, sizeof text - used, "%s%.200s", i ? "; " : "", json_string_value(item));
        }
        return text[0] ? json_string(text) : NULL;
    }
    if (!value || json_is_null(value)) return NULL;
    if (!fact->unit[0]) return json_incref((json_t *)value);
    return json_sprintf("%.1f MiB", json_number_value(value) / 1048576);
}

static void add_facts(const struct report *r) {
    json_t *table = r->count > 1 ? page_table(page_section(r->document, "Runs")) : NULL;
    page_column(table, "", "");
    report_columns(table, r, "");
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++) {
        json_t *row = json_pack("[s]", facts[i].name);
        bool any = false;
        for (size_t k = 0; k < r->count; k++) {
            json_t *value = fact_json(r->runs[k], &facts[i]);
            any = any || value;
            json_array_append_new(row, value ? value : json_null());
        }
        if (any)
            json_array_append(r->count > 1 ? json_object_get(table, "rows") : json_object_get(r->document, "facts"),
                              row);
        json_decref(row);
    }
}

/* ---- Plan, parameters ---- */

static json_t *plan_cell(const json_t *pass) {
    if (!pass) return json_null();
    if (!report_ran(pass)) return json_sprintf("not run: %s", report_text(pass, "reason"));
    bool cached = json_is_true(json_object_get(pass, "cached"));
    return json_sprintf("%s%s: %s", report_text(pass, "variant"), cached ? " (unchanged, not run again)" : "",
                        report_text(pass, "reason"));
}

static void add_plan(const struct report *r) {
    json_t *table = page_table(page_section(r->document, "Plan")), *value;
    const char *slot;
    page_column(table, "slot", "");
    report_columns(table, r, "");
    json_object_foreach(r->slots, slot, value) {
        json_t *row = json_pack("[s]", slot);
        for (size_t i = 0; i < r->count; i++) json_array_append_new(row, plan_cell(report_pass(r->runs[i], slot)));
        page_row(table, row);
    }
}

/* Adds a row, unless only differing values are requested and these are equal. */
static void add_values(json_t *table, const char *slot, const char *name, json_t *const *values, size_t count,
                       bool differing) {
    bool differs = false;
    json_t *row = json_pack("[s, s]", slot, name);
    for (size_t i = 0; i < count; i++) {
        differs = differs || (values[i] ? !json_equal(values[i], values[0]) : values[0] != NULL);
        json_array_append(row, values[i] ? values[i] : json_null());
    }
    if (differs || !differing) page_row(table, row);
    else json_decref(row);
}

/* Adds the parameters of a slot of all runs, each once. Only the variant of a slot and parameters of all runs can differ. */
static void add_slot(const struct report *r, json_t *table, const char *slot, json_t **values, bool differing) {
    json_t *names = json_object(), *value;
    const char *name;
    for (size_t i = 0; i < r->count; i++) {
        const json_t *pass = report_pass(r->runs[i], slot);
        json_object_update_missing(names, json_object_get(pass, "parameters"));
        values[i] = report_ran(pass) ? json_object_get(pass, "variant") : NULL;
    }
    if (differing) add_values(table, slot, "", values, r->count, true);
    json_object_foreach(names, name, value) {
        bool all = true;
        for (size_t i = 0; i < r->count; i++) {
            values[i] = json_object_get(json_object_get(report_pass(r->runs[i], slot), "parameters"), name);
            all = all && values[i];
        }
        if (all || !differing) add_values(table, slot, name, values, r->count, differing);
    }
    json_decref(names);
}

static void add_parameters(const struct report *r, bool differing) {
    json_t *table = page_table(page_section(r->document, differing ? "Parameters that differ" : "Parameters")), *value;
    const char *slot;
    page_column(table, "slot", "");
    page_column(table, "parameter", "");
    report_columns(table, r, "");
    json_t **values = calloc(r->count, sizeof *values);
    if (values) json_object_foreach(r->slots, slot, value) add_slot(r, table, slot, values, differing);
    free(values);
}

json_t *report_runs(const char *const *folders, size_t count, const char *const *images, struct glint_error *err) {
    struct report r = {.folders = folders, .count = count};
    bool ok = read_runs(&r, err);
    if (ok) {
        r.slots = collect_slots(&r);
        char title[256];
        if (count == 1) snprintf(title, sizeof title, "%.100s, %.100s", r.labels[0], report_text(r.runs[0], "preset"));
        else
            snprintf(title, sizeof title, "%zu runs: %.90s, %.90s%s", count, r.labels[0], r.labels[1],
                     count > 2 ? ", \u2026" : "");
        r.document = page_create(title);
        add_facts(&r);
        if (count > 1) add_parameters(&r, true);
        ok = report_pictures(&r, images, err);
        report_reference(&r);
        report_errors(&r);
        report_times(&r);
        add_plan(&r);
        add_parameters(&r, false);
        json_decref(r.slots);
    }
    for (size_t i = 0; r.runs && i < count; i++) json_decref(r.runs[i]);
    free(r.runs);
    free(r.labels);
    if (ok) return r.document;
    json_decref(r.document);
    return NULL;
}
