/* Builds, stores and loads the documents of pages. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/args.h"
#include "draw/page/page.h"
#include "io/output.h"
#include "journal/journal.h"
#include "record.h"

/* File names may not be UTF-8, but JSON must be. */
static json_t *text_json(const char *text) {
    json_t *json = json_string(text ? text : "");
    char *copy = json ? NULL : strdup(text);
    for (char *c = copy; c && *c; c++)
        if ((unsigned char)*c >= 0x80) *c = '?';
    if (copy) json = json_string(copy);
    free(copy);
    return json;
}

json_t *page_create(const char *title) {
    json_t *document = json_pack("{s:i, s:o, s:[], s:[]}", "format", 1, "title", text_json(title), "facts", "sections");
    page_fact(document, "tool", "glint " GLINT_VERSION);
    return document;
}

void page_fact(json_t *document, const char *name, const char *value) {
    json_array_append_new(json_object_get(document, "facts"), json_pack("[oo]", text_json(name), text_json(value)));
}

json_t *page_section(json_t *document, const char *title) {
    json_t *blocks = json_array(), *section = json_pack("{s:o, s:o}", "title", text_json(title), "blocks", blocks);
    return json_array_append_new(json_object_get(document, "sections"), section) == 0 ? blocks : NULL;
}

json_t *page_fold(json_t *blocks, const char *title) {
    json_t *folded = json_array(), *fold = json_pack("{s:o, s:o}", "title", text_json(title), "blocks", folded);
    return json_array_append_new(blocks, json_pack("{s:o}", "fold", fold)) == 0 ? folded : NULL;
}

void page_text(json_t *blocks, const char *kind, const char *text) {
    json_array_append_new(blocks, json_pack("{s:o}", kind, text_json(text)));
}

void page_chart(json_t *blocks, json_t *chart) {
    json_array_append_new(blocks, json_pack("{s:o}", "chart", chart));
}

json_t *page_table(json_t *blocks) {
    json_t *table = json_pack("{s:[], s:[]}", "columns", "rows");
    return json_array_append_new(blocks, json_pack("{s:o}", "table", table)) == 0 ? table : NULL;
}

void page_column(json_t *table, const char *name, const char *unit) {
    bool bar = unit[0] == '|';
    json_array_append_new(json_object_get(table, "columns"), json_pack("{s:o, s:o, s:b}", "name", text_json(name),
                                                                       "unit", text_json(unit + bar), "bar", (int)bar));
}

void page_row(json_t *table, json_t *row) {
    json_array_append_new(json_object_get(table, "rows"), row);
}

json_t *page_number(double value) {
    if (isfinite(value)) return json_real(value);
    return json_string(isnan(value) ? "not a number" : value > 0 ? "infinite" : "minus infinite");
}

json_t *page_interval(double value, double low, double high) {
    return json_pack("{s:o, s:o, s:o}", "value", json_number(value), "low", json_number(low), "high",
                     json_number(high));
}

static bool page_json(char path[4096], const char *folder, struct glint_error *err) {
    return snprintf(path, 4096, "%s/page.json", folder) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

bool page_store(const char *folder, const json_t *document, struct glint_error *err) {
    char path[4096], *text = record_text(document, JSON_INDENT(1));
    bool ok = text ? page_json(path, folder, err) && output_text(path, text, err)
                   : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    free(text);
    return ok;
}

json_t *page_load(const char *folder, struct glint_error *err) {
    char path[4096];
    if (!page_json(path, folder, err)) return NULL;
    json_t *document = json_inside(path, err);
    if (!document || json_integer_value(json_object_get(document, "format")) == 1) return document;
    glint_fail(err, GLINT_ERROR_FORMAT, "%s: format: expected 1, the only version that this program supports", path);
    json_decref(document);
    return NULL;
}
