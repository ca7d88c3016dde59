/* Sums up what is found in many captures. */
#include "lint/survey.h"

#include <stdlib.h>
#include <string.h>

#include "io/table.h"
#include "options/args.h"
#include "record.h"

enum { ID_SIZE = 48 };
static const char *const likelihoods[LINT_LIKELIHOODS] = {"certain", "likely", "possible"};

static struct lint_survey_row *add_row(struct lint_survey *survey, const char *path, struct glint_error *err) {
    struct lint_survey_row *more = realloc(survey->rows, (survey->count + 1) * sizeof *more);
    if (!more) {
        fail_memory(err);
        return NULL;
    }
    survey->rows = more;
    more[survey->count] = (struct lint_survey_row){.path = path};
    return &more[survey->count++];
}

json_t *lint_survey_line(const struct lint_findings *findings) {
    json_t *list = json_array();
    for (size_t i = 0; i < findings->count; i++)
        record_append(
            &list, json_pack("{s:s, s:s}", "id", findings->items[i].id, "likelihood", findings->items[i].likelihood));
    return json_pack("{s:o}", "findings", list);
}

json_t *lint_survey_failure(const char *failure) {
    return json_pack("{s:o}", "failure", json_text(failure));
}

static int likelihood_of(const json_t *finding) {
    const char *text = json_string_value(json_object_get(finding, "likelihood"));
    int k = 0;
    while (k < LINT_LIKELIHOODS && (!text || strcmp(text, likelihoods[k]) != 0)) k++;
    return k;
}

static bool take_findings(struct lint_survey_row *row, json_t *findings) {
    const json_t *finding;
    size_t i;
    if (!json_is_array(findings) || json_array_size(findings) > LINT_FINDINGS) return false;
    json_array_foreach(findings, i, finding) {
        const char *id = json_string_value(json_object_get(finding, "id"));
        const int likelihood = likelihood_of(finding);
        if (!id || strlen(id) >= ID_SIZE || likelihood == LINT_LIKELIHOODS) return false;
        row->found[likelihood]++;
    }
    row->findings = json_incref(findings);
    return true;
}

bool lint_survey_add(struct lint_survey *survey, const char *path, const json_t *line, struct glint_error *err) {
    const char *failure = json_string_value(json_object_get(line, "failure"));
    struct lint_survey_row *row = add_row(survey, path, err);
    if (!row) return false;
    if (failure) return (row->failure = strdup(failure)) != NULL || fail_memory(err);
    return take_findings(row, json_object_get(line, "findings"));
}

/* Rows that are as bad as each other keep the order of the paths. */
static int compare_rows(const void *one, const void *two) {
    const struct lint_survey_row *a = one, *b = two;
    if (!a->failure != !b->failure) return a->failure ? -1 : 1;
    for (int k = 0; k < LINT_LIKELIHOODS; k++)
        if (a->found[k] != b->found[k]) return a->found[k] > b->found[k] ? -1 : 1;
    return strcmp(a->path, b->path);
}

void lint_survey_sort(struct lint_survey *survey) {
    if (survey->count) qsort(survey->rows, survey->count, sizeof *survey->rows, compare_rows);
}

bool lint_survey_is_clean(const struct lint_survey *survey) {
    for (size_t i = 0; i < survey->count; i++)
        if (survey->rows[i].failure || json_array_size(survey->rows[i].findings)) return false;
    return true;
}

/* ---- How many captures have a finding ---- */

struct seen {
    struct lint_known known;
    size_t captures, certain; /* that have it; for which it is certain */
};

static int compare_seen(const void *one, const void *two) {
    const struct seen *a = one, *b = two;
    if (a->captures != b->captures) return a->captures > b->captures ? -1 : 1;
    return strcmp(a->known.id, b->known.id);
}

static struct seen seen_of(const struct lint_survey *survey, const struct lint_known *known) {
    struct seen seen = {.known = *known};
    for (size_t r = 0; r < survey->count; r++) {
        bool has = false, certain = false;
        const json_t *finding;
        size_t i;
        json_array_foreach(survey->rows[r].findings, i, finding) {
            if (strcmp(json_string_value(json_object_get(finding, "id")), known->id) != 0) continue;
            has = true;
            certain |= !strcmp(json_string_value(json_object_get(finding, "likelihood")), likelihoods[LINT_CERTAIN]);
        }
        seen.captures += has;
        seen.certain += certain;
    }
    return seen;
}

/* The findings that any capture has, those of most captures first; malloc'd, *count of them. */
static struct seen *find_seen(const struct lint_survey *survey, size_t *count) {
    struct lint_known known;
    size_t all = 0;
    *count = 0;
    while (lint_known(all, &known)) all++;
    struct seen *seen = malloc((all + 1) * sizeof *seen);
    for (size_t i = 0; seen && lint_known(i, &known); i++) {
        seen[*count] = seen_of(survey, &known);
        *count += seen[*count].captures > 0;
    }
    if (seen && *count) qsort(seen, *count, sizeof *seen, compare_seen);
    return seen;
}

/* ---- Output ---- */

static size_t count_failed(const struct lint_survey *survey) {
    size_t failed = 0;
    for (size_t i = 0; i < survey->count; i++) failed += survey->rows[i].failure != NULL;
    return failed;
}

static size_t count_found(const struct lint_survey *survey) {
    size_t found = 0;
    for (size_t i = 0; i < survey->count; i++) found += json_array_size(survey->rows[i].findings) > 0;
    return found;
}

json_t *lint_survey_json(const struct lint_survey *survey) {
    json_t *captures = json_array(), *findings = json_array();
    size_t count;
    struct seen *seen = find_seen(survey, &count);
    for (size_t r = 0; r < survey->count; r++) {
        const struct lint_survey_row *row = &survey->rows[r];
        json_t *item = json_pack("{s:o}", "capture", json_text(row->path));
        if (row->failure) json_object_set_new(item, "error", json_text(row->failure));
        for (int k = 0; k < LINT_LIKELIHOODS && !row->failure; k++)
            json_object_set_new(item, likelihoods[k], json_integer((json_int_t)row->found[k]));
        if (!row->failure) json_object_set(item, "findings", row->findings);
        json_array_append_new(captures, item);
    }
    for (size_t i = 0; i < count; i++)
        json_array_append_new(findings, json_pack("{s:s, s:s, s:I, s:I}", "id", seen[i].known.id, "what",
                                                  seen[i].known.what, "captures", (json_int_t)seen[i].captures,
                                                  "certain", (json_int_t)seen[i].certain));
    free(seen);
    return json_pack("{s:o, s:o, s:{s:I, s:I, s:I}}", "captures", captures, "findings", findings, "summary", "captures",
                     (json_int_t)survey->count, "with_findings", (json_int_t)count_found(survey), "unreadable",
                     (json_int_t)count_failed(survey));
}

/* "depth.reversed, normal.space", or why the capture cannot be read. */
static void cell_of_findings(struct table *table, const struct lint_survey_row *row) {
    char text[LINT_FINDINGS * (ID_SIZE + 2)] = "";
    const json_t *finding;
    size_t i, length = 0;
    json_array_foreach(row->findings, i, finding) length += (size_t)snprintf(
        text + length, sizeof text - length, "%s%s", i ? ", " : "", json_string_value(json_object_get(finding, "id")));
    table_cell(table, "%s", row->failure ? without_path(row->failure, row->path) : text);
    if (row->failure) table_mark(table, MARK_FAIL);
}

static void print_rows(const struct lint_survey *survey) {
    static const char *const titles[] = {"<capture", ">certain", ">likely", ">possible", "<findings", NULL};
    static const enum mark marks[LINT_LIKELIHOODS] = {MARK_FAIL, MARK_WARN, MARK_WARN};
    struct table *table = table_create(titles);
    for (size_t r = 0; r < survey->count; r++) {
        const struct lint_survey_row *row = &survey->rows[r];
        table_cell(table, "%s", row->path);
        for (int k = 0; k < LINT_LIKELIHOODS; k++) {
            if (row->failure) table_cell(table, "–");
            else table_cell(table, "%zu", row->found[k]);
            if (row->found[k]) table_mark(table, marks[k]);
        }
        cell_of_findings(table, row);
    }
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_seen(const struct lint_survey *survey) {
    static const char *const titles[] = {"<finding", ">captures", ">certain", "<meaning", NULL};
    size_t count;
    struct seen *seen = find_seen(survey, &count);
    struct table *table = table_create(titles);
    for (size_t i = 0; i < count; i++) {
        table_cell(table, "%s", seen[i].known.id);
        table_cell(table, "%zu", seen[i].captures);
        table_cell(table, "%zu", seen[i].certain);
        table_cell(table, "%s", seen[i].known.what);
    }
    if (count) putchar('\n');
    table_print(table, stdout);
    table_destroy(&table);
    free(seen);
}

void lint_survey_print(const struct lint_survey *survey) {
    const size_t failed = count_failed(survey), found = count_found(survey);
    print_rows(survey);
    print_seen(survey);
    putchar('\n');
    mark_print(failed || found ? MARK_FAIL : MARK_GOOD, "%zu capture%s: %zu with findings, %zu without, %zu unreadable",
               survey->count, survey->count == 1 ? "" : "s", found, survey->count - found - failed, failed);
    putchar('\n');
}

void lint_survey_finish(struct lint_survey *survey) {
    for (size_t i = 0; i < survey->count; i++) {
        json_decref(survey->rows[i].findings);
        free(survey->rows[i].failure);
    }
    free(survey->rows);
    *survey = (struct lint_survey){0};
}
