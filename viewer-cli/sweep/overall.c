/* What is told of several captures: errors of points over all and over those with each tag, with intervals, and the captures from the worst. */
#include <math.h>
#include <stdlib.h>

#include "draw/page/page.h"
#include "io/table.h"
#include "journal/drawing.h"
#include "sweep/sweep.h"

/* ---- Figures ---- */

/* The point with the least mean error of those that have one on every capture. */
static size_t find_best(const struct sweep *sweep, const struct sweep_group *group) {
    size_t best = sweep->points;
    for (size_t p = 0; p < sweep->points; p++) {
        if (!sweep->sums[p].valid || isnan(group->error[p].value)) continue;
        if (best == sweep->points ||
            sweep_badness(sweep, group->error[p].value) < sweep_badness(sweep, group->error[best].value))
            best = p;
    }
    return best;
}

static bool fill(struct sweep *sweep, size_t g, double *values, struct glint_error *err) {
    struct sweep_group *group = &sweep->overall.groups[g];
    const size_t count = sweep->captures.count, points = sweep->points;
    group->error = calloc(points + 1, sizeof *group->error);
    group->beyond = calloc(points + 1, sizeof *group->beyond);
    bool ok = (group->error && group->beyond) || fail_memory(err);
    for (size_t p = 0; ok && p < points; p++) {
        for (size_t c = 0; c < count; c++) values[c] = sweep_row(sweep, c, p)->error;
        ok = capture_groups_mean(&sweep->overall.captures, g, values, &group->error[p], err);
    }
    if (ok) group->best = find_best(sweep, group);
    for (size_t p = 0; ok && p < points; p++) {
        for (size_t c = 0; c < count; c++)
            values[c] = group->best < points ? sweep_row(sweep, c, p)->error - sweep_row(sweep, c, group->best)->error
                                             : (double)NAN;
        ok = capture_groups_mean(&sweep->overall.captures, g, values, &group->beyond[p], err);
    }
    return ok;
}

/* The mean error of all points that have one. */
static double mean_error(const struct sweep *sweep, size_t capture) {
    double sum = 0;
    size_t count = 0;
    for (size_t p = 0; p < sweep->points; p++) {
        const double error = sweep_row(sweep, capture, p)->error;
        if (isnan(error)) continue;
        sum += error;
        count++;
    }
    return count ? sum / (double)count : (double)NAN;
}

static bool find_groups(struct sweep *sweep, struct glint_error *err) {
    struct sweep_overall *o = &sweep->overall;
    const size_t count = sweep->captures.count;
    bool *whole = calloc(count + 1, sizeof *whole), ok = whole || fail_memory(err);
    for (size_t c = 0; ok && c < count; c++) {
        whole[c] = !sweep_broken(sweep, c);
        o->broken += !whole[c];
    }
    ok = ok && capture_groups_find(&o->captures, &sweep->captures, whole, err);
    free(whole);
    o->groups = ok ? calloc(o->captures.count, sizeof *o->groups) : NULL;
    o->order = malloc((count + 1) * sizeof *o->order);
    return ok && ((o->groups && o->order) || fail_memory(err));
}

bool sweep_overall_find(struct sweep *sweep, struct glint_error *err) {
    struct sweep_overall *o = &sweep->overall;
    const size_t count = sweep->captures.count;
    double *values = malloc((count + 1) * sizeof *values);
    bool ok = (values || fail_memory(err)) && find_groups(sweep, err);
    for (size_t g = 0; ok && count > 1 && g < o->captures.count; g++) ok = fill(sweep, g, values, err);
    for (size_t c = 0; ok && c < count; c++) values[c] = sweep_badness(sweep, mean_error(sweep, c));
    ok = ok && capture_groups_rank(&o->captures, values, o->order, err);
    for (size_t i = 0; ok && i < count && o->shown_count < CAPTURES_SHOWN; i++) {
        const size_t c = sweep_is_large(sweep) ? o->order[i] : i;
        if (!sweep_broken(sweep, c)) o->shown[o->shown_count++] = c;
    }
    free(values);
    return ok;
}

void sweep_overall_finish(struct sweep_overall *o) {
    for (size_t g = 0; o->groups && g < o->captures.count; g++) {
        free(o->groups[g].error);
        free(o->groups[g].beyond);
    }
    free(o->groups);
    free(o->order);
    capture_groups_finish(&o->captures);
    *o = (struct sweep_overall){0};
}

static bool on_front(const struct sweep *sweep, size_t point) {
    for (size_t f = 0; f < sweep->front_count; f++)
        if (sweep->fronts[f].on[point]) return true;
    return false;
}

/* The errors of a capture by point. */
struct range {
    size_t least, largest; /* the number of points if none is known */
};
static struct range range_of(const struct sweep *sweep, size_t capture) {
    struct range range = {sweep->points, sweep->points};
    for (size_t p = 0; p < sweep->points; p++) {
        const double error = sweep_badness(sweep, sweep_row(sweep, capture, p)->error);
        if (isnan(error)) continue;
        if (range.least == sweep->points || error < sweep_badness(sweep, sweep_row(sweep, capture, range.least)->error))
            range.least = p;
        if (range.largest == sweep->points ||
            error > sweep_badness(sweep, sweep_row(sweep, capture, range.largest)->error))
            range.largest = p;
    }
    return range;
}

/* ---- In the terminal ---- */

static void print_group(struct table *table, const struct sweep *sweep, size_t g) {
    const struct capture_group *of = &sweep->overall.captures.of[g];
    const struct sweep_group *group = &sweep->overall.groups[g];
    for (size_t p = 0; p < sweep->points; p++) {
        if (!on_front(sweep, p) && p != group->best) continue;
        char *text = sweep_point_text(sweep, p);
        group_cells(table, of);
        table_cell(table, "%zu", p);
        table_cell(table, "%s", text ? text : "");
        figure_cell(table, &group->error[p]);
        if (p == group->best) table_cell(table, "best");
        else difference_cell(table, &group->beyond[p]);
        free(text);
    }
}

static void error_cells(struct table *table, const struct sweep *sweep, size_t capture, size_t point) {
    if (point < sweep->points) {
        table_cell(table, "%.4f", sweep_row(sweep, capture, point)->error);
        table_cell(table, "%zu", point);
    } else {
        table_cell(table, "–");
        table_cell(table, "–");
    }
}

static void print_row(struct table *table, const struct sweep *sweep, size_t capture) {
    const struct range range = range_of(sweep, capture);
    const double mean = mean_error(sweep, capture);
    char *failure = sweep_broken(sweep, capture) ? sweep_failure(sweep, capture, 0) : NULL;
    table_cell(table, "%s", sweep->captures.items[capture]);
    if (isnan(mean)) table_cell(table, "–");
    else table_cell(table, "%.4f", mean);
    error_cells(table, sweep, capture, range.least);
    error_cells(table, sweep, capture, range.largest);
    table_cell(table, "%s", failure ? without_path(failure, sweep->captures.items[capture]) : "");
    if (failure) table_mark(table, MARK_FAIL);
    free(failure);
}

/* A row for each capture, or for those without results alone. */
static void print_rows(const struct sweep *sweep) {
    static const char *const titles[] = {"<capture", ">mean of the points", ">least",   ">at point",
                                         ">largest", ">at point",           "<message", NULL};
    const size_t count = sweep->captures.count, first = sweep_is_large(sweep) ? 0 : count - sweep->overall.broken;
    struct table *table = table_create(titles);
    for (size_t i = first; i < count; i++) print_row(table, sweep, sweep->overall.order[i]);
    puts(sweep_is_large(sweep) ? "\nErrors of the captures, the largest mean of all points first:\n"
                               : "\nCaptures without results:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

void sweep_print_overall(const struct sweep *sweep) {
    static const char *const titles[] = {GROUP_TITLES, ">point", "<values", "<error", "<beyond the best", NULL};
    if (sweep_is_large(sweep) || sweep->overall.broken) print_rows(sweep);
    struct table *table = table_create(titles);
    for (size_t g = 0; g < sweep->overall.captures.count; g++) print_group(table, sweep, g);
    puts("\nOver all captures, and over those with each tag: mean errors of the Pareto-optimal points, and how much "
         "they "
         "differ from that of the point with the least one in the same captures. Intervals of 95 %: bootstrap over "
         "shots:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

/* ---- JSON ---- */

void sweep_overall_add(const struct sweep *sweep, size_t group, size_t point, json_t *figures) {
    const struct sweep_group *of = &sweep->overall.groups[group];
    json_t *error = json_object_get(figures, "error");
    json_object_set_new(error, "low", json_number(of->error[point].low));
    json_object_set_new(error, "high", json_number(of->error[point].high));
    json_object_set_new(figures, "beyond_best", figure_json(&of->beyond[point]));
}

json_t *sweep_worst_json(const struct sweep *sweep) {
    json_t *worst = json_array();
    for (size_t i = 0; i < sweep->captures.count - sweep->overall.broken && i < CAPTURES_SHOWN; i++) {
        const size_t c = sweep->overall.order[i];
        json_array_append_new(worst, json_pack("{s:s, s:o}", "capture", sweep->captures.items[c], "error",
                                               json_number(mean_error(sweep, c))));
    }
    return worst;
}

/* ---- The page ---- */

static void page_group(json_t *table, const struct sweep *sweep, size_t g) {
    const struct sweep_group *group = &sweep->overall.groups[g];
    for (size_t p = 0; p < sweep->points; p++) {
        if (!on_front(sweep, p) && p != group->best) continue;
        char *text = sweep_point_text(sweep, p);
        json_t *row = group_page_row(&sweep->overall.captures.of[g]);
        json_array_append_new(row, json_integer((json_int_t)p));
        json_array_append_new(row, json_string(text ? text : ""));
        json_array_append_new(row, figure_page_cell(&group->error[p], 1));
        json_array_append_new(row, p == group->best ? json_null() : figure_page_cell(&group->beyond[p], 1));
        page_row(table, row);
        free(text);
    }
}

void sweep_page_overall(const struct sweep *sweep, json_t *document) {
    json_t *blocks = page_section(document, "All captures");
    page_text(blocks, "text",
              "Mean errors of the Pareto-optimal points over captures, and over those with each tag. Differences are "
              "from the point with the least mean error, in the same captures. The intervals contain the mean with "
              "95 % confidence (bootstrap over shots).");
    json_t *table = group_page_table(blocks);
    page_column(table, "point", "");
    page_column(table, "values", "");
    page_column(table, glint_metric(sweep->metric)->title, "");
    page_column(table, "beyond the best", "");
    for (size_t g = 0; g < sweep->overall.captures.count; g++) page_group(table, sweep, g);
}

/* What the point with the least error shows on each of the worst captures, and its error; the other points are found in the charts. */
static void add_worst(const struct sweep *sweep, json_t *document) {
    const size_t best = sweep->overall.groups[0].best;
    json_t *blocks = page_section(document, "The worst captures");
    for (size_t i = 0; i < sweep->overall.shown_count; i++) {
        static const char *const names[] = {"picture", "error"};
        const size_t c = sweep->overall.shown[i];
        json_t *pictures = json_array();
        page_text(blocks, "heading", sweep->captures.items[c]);
        for (size_t k = 0; k < 2; k++) {
            char name[96], caption[100];
            sweep_picture_name(names[k], c, best, name);
            snprintf(caption, sizeof caption, "point %zu%s", best, k ? ", error" : "");
            drawing_add(pictures, sweep->out, name, caption, true);
        }
        if (json_array_size(pictures)) json_array_append_new(blocks, json_pack("{s:O}", "pictures", pictures));
        json_decref(pictures);
    }
}

static json_t *point_cell(const struct sweep *sweep, size_t point) {
    return point < sweep->points ? json_integer((json_int_t)point) : json_null();
}
static json_t *error_cell(const struct sweep *sweep, size_t capture, size_t point) {
    return point < sweep->points ? json_number(sweep_row(sweep, capture, point)->error) : json_null();
}

static void add_rows(const struct sweep *sweep, json_t *document) {
    json_t *table = page_table(page_section(document, "Captures, the largest errors first"));
    page_column(table, "capture", "");
    page_column(table, "tags", "");
    page_column(table, "mean of the points", "error");
    page_column(table, "least", "error");
    page_column(table, "at point", "");
    page_column(table, "largest", "error");
    page_column(table, "at point", "");
    page_column(table, "message", "");
    for (size_t i = 0; i < sweep->captures.count; i++) {
        const size_t c = sweep->overall.order[i];
        const char *path = sweep->captures.items[c];
        const struct range range = range_of(sweep, c);
        char *tags = capture_tags_text(&sweep->captures, c),
             *failure = sweep_broken(sweep, c) ? sweep_failure(sweep, c, 0) : NULL;
        page_row(table, json_pack("[s, s, o, o, o, o, o, s]", path, tags ? tags : "", json_number(mean_error(sweep, c)),
                                  error_cell(sweep, c, range.least), point_cell(sweep, range.least),
                                  error_cell(sweep, c, range.largest), point_cell(sweep, range.largest),
                                  failure ? without_path(failure, path) : ""));
        free(tags);
        free(failure);
    }
}

void sweep_page_captures(const struct sweep *sweep, json_t *document) {
    if (sweep_is_large(sweep)) add_worst(sweep, document);
    if (sweep_is_large(sweep) || sweep->overall.broken) add_rows(sweep, document);
}
