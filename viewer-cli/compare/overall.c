/* The figures over all captures as tables, JSON and sections of the page. */
#include "compare/overall.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw/page/page.h"
#include "io/table.h"

static const char *const figure_names[CONTEST_FIGURES] = {"error", "frame_ms", "coverage"};

static const char *label_of(const struct contest_table *t, size_t preset) {
    return t->contest->contestants[preset].label;
}

static const struct glint_figure *mean_of(const struct contest_group *g, size_t preset, enum contest_figure figure) {
    return &g->means[preset * CONTEST_FIGURES + figure];
}

/* What the preset's figure is more than the best one's, in the same captures. */
static const struct glint_figure *beyond_best(const struct contest_table *t, const struct contest_group *g,
                                              size_t preset, enum contest_figure figure) {
    return &g->pairs[(g->best * t->contest->count + preset) * CONTEST_PAIRED + figure];
}

/* ---- In the terminal ---- */

static void number_cell(struct table *table, const char *format, double value) {
    char text[64] = "–";
    if (!isnan(value)) snprintf(text, sizeof text, format, value);
    table_cell(table, "%s", text);
}

static void print_group(struct table *table, const struct contest_table *t, const struct contest_group *g) {
    for (size_t p = 0; p < t->contest->count; p++) {
        const bool best = p == g->best && !isnan(mean_of(g, p, CONTEST_ERROR)->value);
        group_cells(table, g->of);
        table_cell(table, "%s", label_of(t, p));
        number_cell(table, "%.4f", mean_of(g, p, CONTEST_ERROR)->value);
        if (best) table_mark(table, MARK_GOOD);
        number_cell(table, "%.1f %%", 100 * mean_of(g, p, CONTEST_COVERAGE)->value);
        number_cell(table, "%.3f", mean_of(g, p, CONTEST_MS)->value);
        if (best) table_cell(table, "best");
        else difference_cell(table, beyond_best(t, g, p, CONTEST_ERROR));
    }
}

static void print_figures(const struct contest_table *t, const struct contest_overall *o) {
    static const char *const titles[] = {
        GROUP_TITLES, "<preset", ">error", ">coverage", ">ms", "<error beyond the best, 95 % interval", NULL};
    struct table *table = table_create(titles);
    for (size_t g = 0; g < o->captures.count; g++) print_group(table, t, &o->groups[g]);
    puts("\nOver all captures, and over those with each tag: means over captures, of errors over the pixels that all "
         "presets cover; and how much larger the error is than that of the preset with the least one in the same "
         "captures. Intervals: bootstrap over shots:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

/* Why a capture has no results; malloc'd. */
static char *failure_of(const struct contest_table *t, size_t capture) {
    json_t *line = contest_log_line(t->log, capture);
    const char *failure = json_string_value(json_object_get(line, "failure"));
    char *text = failure ? strdup(failure) : NULL;
    json_decref(line);
    return text;
}

static void print_row(struct table *table, const struct contest_table *t, size_t capture) {
    char *failure = failure_of(t, capture);
    table_cell(table, "%s", t->captures[capture]);
    for (size_t p = 0; p < t->contest->count; p++)
        number_cell(table, "%.4f", contest_log_figure(t->log, capture, p, CONTEST_ERROR));
    table_cell(table, "%s", failure ? without_path(failure, t->captures[capture]) : "");
    if (failure) table_mark(table, MARK_FAIL);
    free(failure);
}

/* A row for each capture, or for those without results alone. */
static void print_rows(const struct contest_table *t, const struct contest_overall *o) {
    const size_t presets = t->contest->count, first = t->rows ? 0 : t->capture_count - o->unreadable;
    const char **titles = calloc(presets + 3, sizeof *titles);
    char(*names)[LABEL_SIZE + 1] = calloc(presets + 1, sizeof *names);
    if (titles && names) {
        titles[0] = "<capture";
        for (size_t p = 0; p < presets; p++) {
            snprintf(names[p], sizeof names[p], ">%s", label_of(t, p));
            titles[1 + p] = names[p];
        }
        titles[1 + presets] = "<message";
        struct table *table = table_create(titles);
        for (size_t i = first; i < t->capture_count; i++) print_row(table, t, o->order[i]);
        puts(t->rows ? "\nErrors over the pixels that all presets cover, the largest first:\n"
                     : "\nCaptures without results:\n");
        table_print(table, stdout);
        table_destroy(&table);
    }
    free(titles);
    free(names);
}

void contest_print_overall(const struct contest_table *t, const struct contest_overall *o) {
    if (t->rows || o->unreadable) print_rows(t, o);
    print_figures(t, o);
}

/* ---- JSON ---- */

static json_t *json_of(const struct contest_table *t, const struct contest_group *g) {
    const size_t count = t->contest->count;
    json_t *presets = json_array(), *pairs = json_array();
    for (size_t p = 0; p < count; p++) {
        json_t *preset = json_pack("{s:s}", "preset", label_of(t, p));
        for (size_t f = 0; f < CONTEST_FIGURES; f++)
            json_object_set_new(preset, figure_names[f], figure_json(&g->means[p * CONTEST_FIGURES + f]));
        json_array_append_new(presets, preset);
    }
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count; b++) {
            json_t *pair = json_pack("{s:s, s:s}", "from", label_of(t, a), "to", label_of(t, b));
            for (size_t f = 0; f < CONTEST_PAIRED; f++)
                json_object_set_new(pair, figure_names[f],
                                    figure_json(&g->pairs[(a * count + b) * CONTEST_PAIRED + f]));
            json_array_append_new(pairs, pair);
        }
    json_t *json = group_json(g->of);
    json_object_set_new(json, "presets", presets);
    json_object_set_new(json, "differences", pairs);
    return json;
}

json_t *contest_overall_json(const struct contest_table *t, const struct contest_overall *o) {
    json_t *groups = json_array(), *worst = json_array();
    for (size_t g = 0; g < o->captures.count; g++) json_array_append_new(groups, json_of(t, &o->groups[g]));
    for (size_t i = 0; i < t->capture_count - o->unreadable && i < CAPTURES_SHOWN; i++)
        json_array_append_new(worst, json_pack("{s:s, s:o}", "capture", t->captures[o->order[i]], "error",
                                               json_number(contest_worst_error(t->log, o->order[i]))));
    return json_pack("{s:o, s:o, s:I}", "overall", groups, "worst", worst, "unreadable", (json_int_t)o->unreadable);
}

/* ---- The page ---- */

static void add_group(json_t *table, const struct contest_table *t, const struct contest_group *g) {
    for (size_t p = 0; p < t->contest->count; p++) {
        json_t *row = group_page_row(g->of);
        json_array_append_new(row, json_string(label_of(t, p)));
        json_array_append_new(row, figure_page_cell(mean_of(g, p, CONTEST_ERROR), 1));
        json_array_append_new(row,
                              p == g->best ? json_null() : figure_page_cell(beyond_best(t, g, p, CONTEST_ERROR), 1));
        json_array_append_new(row, figure_page_cell(mean_of(g, p, CONTEST_COVERAGE), 100));
        json_array_append_new(row, figure_page_cell(mean_of(g, p, CONTEST_MS), 1));
        json_array_append_new(row, p == g->best ? json_null() : figure_page_cell(beyond_best(t, g, p, CONTEST_MS), 1));
        page_row(table, row);
    }
}

void contest_page_figures(json_t *document, const struct contest_table *t, const struct contest_overall *o) {
    json_t *blocks = page_section(document, "All captures");
    page_text(blocks, "text",
              "Means over captures, and over those with each tag; errors are over the pixels that all presets cover. "
              "Differences are from the preset with the least error, in the same captures. The intervals contain the "
              "mean with 95 % confidence (bootstrap over shots).");
    json_t *table = group_page_table(blocks);
    page_column(table, "preset", "");
    page_column(table, "error", "0 to 1");
    page_column(table, "beyond the best", "");
    page_column(table, "coverage", "%");
    page_column(table, "frame", "ms");
    page_column(table, "beyond the best", "ms");
    for (size_t g = 0; g < o->captures.count; g++) add_group(table, t, &o->groups[g]);
}

void contest_page_rows(json_t *document, const struct contest_table *t, const struct contest_overall *o) {
    json_t *table = page_table(page_section(document, "Captures, the largest errors first"));
    page_column(table, "capture", "");
    page_column(table, "tags", "");
    for (size_t p = 0; p < t->contest->count; p++) page_column(table, label_of(t, p), "error");
    page_column(table, "message", "");
    for (size_t i = 0; i < t->capture_count; i++) {
        const size_t c = o->order[i];
        char *tags = capture_tags_text(t->log->captures, c), *failure = failure_of(t, c);
        json_t *row = json_pack("[s, s]", t->captures[c], tags ? tags : "");
        for (size_t p = 0; p < t->contest->count; p++)
            json_array_append_new(row, json_number(contest_log_figure(t->log, c, p, CONTEST_ERROR)));
        json_array_append_new(row, json_string(failure ? without_path(failure, t->captures[c]) : ""));
        page_row(table, row);
        free(tags);
        free(failure);
    }
}
