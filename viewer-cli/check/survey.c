/* Sums up the comparisons of many runs with their baselines. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/check.h"
#include "io/table.h"
#include "options/args.h"

enum { STATUSES = DIFF_FILE + 1 };
static const char *const words[STATUSES] = {"same", "warning", "fails", "different size", "unreadable"};

/* The figures of a diff's images. */
static bool describe(struct check_row *row, const json_t *json) {
    const json_t *first = json_object_get(json, "first"), *image;
    const char *slot = json_string_value(json_object_get(first, "slot")),
               *name = json_string_value(json_object_get(first, "image"));
    size_t i;
    row->images = json_array_size(json_object_get(json, "images"));
    json_array_foreach(json_object_get(json, "images"), i, image) row->differing +=
        json_integer_value(json_object_get(image, "status")) != DIFF_SAME;
    return !slot || !name || asprintf(&row->first, "%s: %s", slot, name) >= 0;
}

bool check_survey_add(struct check_survey *survey, const struct check_pair *pair, const json_t *json,
                      struct glint_error *err) {
    const json_int_t status = json_integer_value(json_object_get(json, "status"));
    const char *note = json_string_value(json_object_get(json, "note")),
               *error = json_string_value(json_object_get(json, "error"));
    if (!json_is_integer(json_object_get(json, "status")) || status < 0 || status >= STATUSES) return false;
    struct check_row *more = realloc(survey->rows, (survey->count + 1) * sizeof *more);
    if (!more) return fail_memory(err);
    survey->rows = more;
    struct check_row *row = &more[survey->count++];
    const bool approved = json_object_get(json, "approved") != NULL;
    *row = (struct check_row){.pair = pair, .status = approved ? DIFF_SAME : (enum diff_status)status};
    if ((note || error) && !(row->message = strdup(error ? error : note))) return fail_memory(err);
    return describe(row, json) || fail_memory(err);
}

/* Rows that are as bad as each other keep the order of their names. */
static int compare_rows(const void *one, const void *two) {
    const struct check_row *a = one, *b = two;
    if (a->status != b->status) return a->status > b->status ? -1 : 1;
    if (a->differing != b->differing) return a->differing > b->differing ? -1 : 1;
    return strcmp(a->pair->run, b->pair->run);
}

void check_survey_sort(struct check_survey *survey) {
    if (survey->count) qsort(survey->rows, survey->count, sizeof *survey->rows, compare_rows);
}

static size_t count_of(const struct check_survey *survey, size_t status) {
    size_t count = 0;
    for (size_t i = 0; i < survey->count; i++) count += survey->rows[i].status == status;
    return count;
}

static const char *message_of(const struct check_row *row) {
    if (!row->message) return row->first ? row->first : "";
    return without_path(without_path(row->message, row->pair->run), row->pair->baseline);
}

void check_survey_print(const struct check_survey *survey) {
    static const char *const titles[] = {"<run", "<", ">images that differ", ">of", "<first that differs", NULL};
    static const enum mark marks[STATUSES] = {MARK_GOOD, MARK_WARN, MARK_FAIL, MARK_FAIL, MARK_FAIL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < survey->count; i++) {
        const struct check_row *row = &survey->rows[i];
        table_cell(table, "%s", row->pair->run);
        table_cell(table, "%s", words[row->status]);
        table_mark(table, marks[row->status]);
        for (int k = 0; k < 2; k++)
            if (row->images) table_cell(table, "%zu", k ? row->images : row->differing);
            else table_cell(table, "–");
        table_cell(table, "%s", message_of(row));
    }
    putchar('\n');
    table_print(table, stdout);
    table_destroy(&table);
    printf("\n%zu runs:", survey->count);
    const char *between = " ";
    for (size_t k = 0; k < STATUSES; k++) {
        if (!count_of(survey, k)) continue;
        printf("%s%zu %s", between, count_of(survey, k), words[k]);
        between = ", ";
    }
    putchar('\n');
}

static json_t *row_json(const struct check_row *row) {
    json_t *json = json_pack("{s:o, s:o, s:i, s:I, s:I}", "a", json_text(row->pair->baseline), "b",
                             json_text(row->pair->run), "status", (int)row->status, "differing",
                             (json_int_t)row->differing, "images", (json_int_t)row->images);
    if (row->first) json_object_set_new(json, "first", json_text(row->first));
    if (row->message) json_object_set_new(json, "message", json_text(row->message));
    return json;
}

json_t *check_survey_json(const struct check_survey *survey) {
    json_t *summary = json_object(), *rows = json_array();
    for (size_t k = 0; k < STATUSES; k++)
        json_object_set_new(summary, words[k], json_integer((json_int_t)count_of(survey, k)));
    for (size_t i = 0; i < survey->count; i++) json_array_append_new(rows, row_json(&survey->rows[i]));
    return json_pack("{s:o, s:o}", "summary", summary, "worst", rows);
}

void check_survey_finish(struct check_survey *survey) {
    for (size_t i = 0; i < survey->count; i++) {
        free(survey->rows[i].first);
        free(survey->rows[i].message);
    }
    free(survey->rows);
    *survey = (struct check_survey){0};
}
