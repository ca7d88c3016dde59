/* The final comparison over all captures and over those with each tag, and which captures are the worst. */
#include "tune/overall.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw/page/page.h"

enum quantity { START, TUNED, SCALED, COST_START, COST_TUNED, LESS_START, LESS_SCALED, QUANTITIES };
static const char *const names[QUANTITIES] = {
    "start", "tuned", "scaled", "start_cost", "tuned_cost", "tuned_less_start", "tuned_less_scaled"};

struct tune_overall {
    struct capture_groups groups;
    struct glint_figure (*means)[QUANTITIES]; /* of each group */
    size_t *order; /* the subjects: the largest error of the tuned preset first, held-out ones last */
};

static double error_of(const struct tune *tune, size_t s, int contender) {
    const struct glint_metric_table *errors = &tune->measured[s * TUNE_CONTENDERS + (size_t)contender].errors;
    return tune->contenders[contender] && errors->count ? errors->rows[0].of[tune->metric].value : (double)NAN;
}

static double cost_of(const struct tune *tune, size_t s, int contender) {
    const struct tune_measured *measured = &tune->measured[s * TUNE_CONTENDERS + (size_t)contender];
    return tune->subjects[s].broken ? (double)NAN : tune->fetches ? measured->fetches_px : measured->ms.value;
}

static double quantity_of(const struct tune *tune, size_t s, enum quantity q) {
    switch (q) {
    case COST_START:
        return cost_of(tune, s, TUNE_START);
    case COST_TUNED:
        return cost_of(tune, s, TUNE_TUNED);
    case LESS_START:
        return error_of(tune, s, TUNE_TUNED) - error_of(tune, s, TUNE_START);
    case LESS_SCALED:
        return error_of(tune, s, TUNE_TUNED) - error_of(tune, s, TUNE_SCALED);
    default:
        return error_of(tune, s, q == START ? TUNE_START : q == TUNED ? TUNE_TUNED : TUNE_SCALED);
    }
}

static bool find_means(struct tune *tune, double *values, struct glint_error *err) {
    struct tune_overall *o = tune->overall;
    bool ok = true;
    for (size_t g = 0; g < o->groups.count; g++)
        for (int q = 0; ok && q < QUANTITIES; q++) {
            for (size_t s = 0; s < tune->captures.count; s++) values[s] = quantity_of(tune, s, (enum quantity)q);
            ok = capture_groups_mean(&o->groups, g, values, &o->means[g][q], err);
        }
    for (size_t s = 0; s < tune->captures.count; s++) values[s] = quantity_of(tune, s, TUNED);
    for (size_t s = tune->captures.count; s < tune->subject_count; s++) o->order[s] = s;
    return ok && capture_groups_rank(&o->groups, values, o->order, err);
}

bool tune_sum_up(struct tune *tune, struct glint_error *err) {
    struct tune_overall *o = tune->overall = calloc(1, sizeof *o);
    bool *counts = calloc(tune->captures.count + 1, sizeof *counts);
    double *values = calloc(tune->captures.count + 1, sizeof *values);
    bool ok = (o && counts && values) || fail_memory(err);
    for (size_t s = 0; ok && s < tune->captures.count; s++) counts[s] = !tune->subjects[s].broken;
    ok = ok && capture_groups_find(&o->groups, &tune->captures, counts, err);
    if (ok) {
        o->means = calloc(o->groups.count + 1, sizeof *o->means);
        o->order = calloc(tune->subject_count + 1, sizeof *o->order);
        ok = ((o->means && o->order) || fail_memory(err)) && find_means(tune, values, err);
    }
    free(values);
    free(counts);
    return ok;
}

void tune_overall_finish(struct tune *tune) {
    if (!tune->overall) return;
    capture_groups_finish(&tune->overall->groups);
    free(tune->overall->means);
    free(tune->overall->order);
    free(tune->overall);
    tune->overall = NULL;
}

size_t tune_ranked(const struct tune *tune, size_t place) {
    return tune->overall->order[place];
}

bool tune_is_shown(const struct tune *tune, size_t place) {
    return place < CAPTURES_SHOWN && !tune->subjects[tune_ranked(tune, place)].broken;
}

static bool is_rowed(const struct tune *tune, size_t place) {
    return tune->subject_count > CAPTURES_SHOWN || tune->subjects[tune_ranked(tune, place)].broken;
}

static bool has_rows(const struct tune *tune) {
    bool any = false;
    for (size_t i = 0; i < tune->subject_count; i++) any |= is_rowed(tune, i);
    return any;
}

/* Of the figures over captures those that say something: of the scaled start only with one. */
static bool is_told(const struct tune *tune, int q) {
    return tune->contenders[TUNE_SCALED] || (q != SCALED && q != LESS_SCALED);
}

static void cost_title(const struct tune *tune, const char *whose, const char *before, char title[64]) {
    snprintf(title, 64, "%s%s of %s", before, tune->fetches ? "fetches/px" : "ms", whose);
}

/* ---- In the terminal ---- */

static void print_groups(const struct tune *tune) {
    const struct tune_overall *o = tune->overall;
    char costs[2][64];
    cost_title(tune, "start", ">", costs[0]);
    cost_title(tune, "tuned", ">", costs[1]);
    const char *titles[QUANTITIES + 4] = {GROUP_TITLES};
    const char *const all[QUANTITIES] = {
        ">error of start",       ">of tuned", ">of scaled start", costs[0], costs[1], ">tuned − start [95 %]",
        ">tuned − scaled [95 %]"};
    size_t n = 3;
    for (int q = 0; q < QUANTITIES; q++)
        if (is_told(tune, q)) titles[n++] = all[q];
    struct table *table = table_create(titles);
    for (size_t g = 0; g < o->groups.count; g++) {
        group_cells(table, &o->groups.of[g]);
        for (int q = 0; q < QUANTITIES; q++) {
            if (!is_told(tune, q)) continue;
            if (q >= LESS_START) difference_cell(table, &o->means[g][q]);
            else if (isnan(o->means[g][q].value)) table_cell(table, "–");
            else table_cell(table, "%.4f", o->means[g][q].value);
        }
    }
    puts("\nThe captures that were tuned on, and those with each tag: means over captures, and how much more the tuned "
         "preset errs in the same captures. Intervals: bootstrap over shots:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

static void number_cell(struct table *table, double value) {
    if (isnan(value)) table_cell(table, "–");
    else table_cell(table, "%.5f", value);
}

static void print_rows(const struct tune *tune) {
    struct table *table =
        table_create((const char *const[]){"<capture", "<", ">error of start", ">of tuned", "<message", NULL});
    for (size_t i = 0; i < tune->subject_count; i++) {
        const size_t s = tune_ranked(tune, i);
        const struct tune_subject *subject = &tune->subjects[s];
        if (!is_rowed(tune, i)) continue;
        table_cell(table, "%s", subject->path);
        table_cell(table, "%s", subject->held_out ? "held out" : "");
        number_cell(table, error_of(tune, s, TUNE_START));
        number_cell(table, error_of(tune, s, TUNE_TUNED));
        table_cell(table, "%s", subject->broken ? without_path(subject->broken, subject->path) : "");
        if (subject->broken) table_mark(table, MARK_FAIL);
    }
    puts(tune->subject_count > CAPTURES_SHOWN ? "\nCaptures, the largest error of the tuned preset first:\n"
                                              : "\nCaptures that are left out:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

void tune_print_overall(const struct tune *tune) {
    if (has_rows(tune)) print_rows(tune);
    if (tune->captures.count > 1) print_groups(tune);
}

/* ---- JSON and page ---- */

json_t *tune_overall_json(const struct tune *tune) {
    json_t *list = json_array();
    for (size_t g = 0; tune->overall && g < tune->overall->groups.count; g++) {
        json_t *json = group_json(&tune->overall->groups.of[g]);
        for (int q = 0; q < QUANTITIES; q++)
            json_object_set_new(json, names[q],
                                is_told(tune, q) ? figure_json(&tune->overall->means[g][q]) : json_null());
        json_array_append_new(list, json);
    }
    return list;
}

static void add_groups(const struct tune *tune, json_t *document) {
    const struct tune_overall *o = tune->overall;
    static const char *const titles[QUANTITIES] = {"start",         "tuned",         "scaled start",  "cost of start",
                                                   "cost of tuned", "tuned − start", "tuned − scaled"};
    json_t *blocks = page_section(document, "All captures");
    page_text(
        blocks, "text",
        "Means over the captures that were tuned on, and over those with each tag; and how much more the tuned preset "
        "errs than the "
        "others in the same captures. The intervals contain the mean with 95 % confidence (bootstrap over shots).");
    json_t *table = group_page_table(blocks);
    for (int q = 0; q < QUANTITIES; q++)
        if (is_told(tune, q))
            page_column(table, titles[q],
                        q == COST_START || q == COST_TUNED ? tune_cost_unit(tune) : glint_metric(tune->metric)->title);
    for (size_t g = 0; g < o->groups.count; g++) {
        json_t *row = group_page_row(&o->groups.of[g]);
        for (int q = 0; q < QUANTITIES; q++)
            if (is_told(tune, q)) json_array_append_new(row, figure_page_cell(&o->means[g][q], 1));
        page_row(table, row);
    }
}

static void add_rows(const struct tune *tune, json_t *document) {
    json_t *table = page_table(page_section(document, "Captures, the largest errors first"));
    page_column(table, "capture", ""), page_column(table, "", ""), page_column(table, "tags", "");
    page_column(table, "start", glint_metric(tune->metric)->title);
    page_column(table, "tuned", glint_metric(tune->metric)->title);
    page_column(table, "message", "");
    for (size_t i = 0; i < tune->subject_count; i++) {
        const size_t s = tune_ranked(tune, i);
        const struct tune_subject *subject = &tune->subjects[s];
        if (!is_rowed(tune, i)) continue;
        char *tags = subject->held_out ? NULL : capture_tags_text(&tune->captures, s);
        page_row(table,
                 json_pack("[s, s, s, o, o, s]", subject->path, subject->held_out ? "held out" : "", tags ? tags : "",
                           json_number(error_of(tune, s, TUNE_START)), json_number(error_of(tune, s, TUNE_TUNED)),
                           subject->broken ? without_path(subject->broken, subject->path) : ""));
        free(tags);
    }
}

void tune_page_overall(const struct tune *tune, json_t *document) {
    if (tune->captures.count > 1) add_groups(tune, document);
    if (has_rows(tune)) add_rows(tune, document);
}
