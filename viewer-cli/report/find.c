/* Looks up values in run.json for the parts of a report. */
#include <stdio.h>
#include <string.h>

#include "report/report.h"

const json_t *report_pass(const json_t *run, const char *slot) {
    size_t i;
    json_t *pass;
    json_array_foreach(json_object_get(run, "passes"), i, pass) {
        const char *name = json_string_value(json_object_get(pass, "slot"));
        if (name && !strcmp(name, slot)) return pass;
    }
    return NULL;
}

const char *report_text(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

bool report_ran(const json_t *pass) {
    return json_is_true(json_object_get(pass, "ran"));
}

const json_t *report_find(const json_t *run, const char *key) {
    const char *dot = strchr(key, '.');
    if (!dot) return json_object_get(run, key);
    char first[32];
    snprintf(first, sizeof first, "%.*s", (int)(dot - key), key);
    return json_object_get(json_object_get(run, first), dot + 1);
}

void report_columns(json_t *table, const struct report *r, const char *unit) {
    for (size_t i = 0; i < r->count; i++) page_column(table, r->count > 1 ? r->labels[i] : "", unit);
}
