/* Prints the result of tuning: changed parameters, the final comparison, and parameters that were not tuned. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/table.h"
#include "tune/overall.h"
#include "tune/tune.h"

const char *tune_cost_unit(const struct tune *tune) {
    return tune->fetches ? "fetches/px" : "ms";
}

static void print_moved(const struct tune *tune) {
    const double *values = tune->found.points[tune->chosen].values;
    struct table *table = table_create((const char *const[]){"<changed", ">from", ">to", "<unit", NULL});
    for (size_t a = 0; a < tune->axis_count; a++) {
        char from[TUNE_TEXT], to[TUNE_TEXT];
        tune_value_text(&tune->axes[a], tune->axes[a].axis.start, from);
        tune_value_text(&tune->axes[a], values[a], to);
        if (!strcmp(from, to)) continue;
        table_cell(table, "%s", tune->axes[a].name);
        table_cell(table, "%s", from);
        table_cell(table, "%s", to);
        const char *unit = tune->axes[a].row && !tune->axes[a].texts ? tune->axes[a].row->unit : "";
        table_cell(table, "%s", strcmp(unit, "1") ? unit : "");
    }
    if (table_is_empty(table)) printf("no parameter changed: no better point than the start was found\n");
    else table_print(table, stdout);
    table_destroy(&table);
}

static void number_cell(struct table *table, const char *format, double value) {
    char text[32];
    snprintf(text, sizeof text, format, value);
    table_cell(table, "%s", isfinite(value) ? text : "–");
}

/* "0.894 [0.783, 1.004]" */
static void interval_cell(struct table *table, int digits, double value, double low, double high) {
    if (isfinite(value)) table_cell(table, "%.*f [%.*f, %.*f]", digits, value, digits, low, digits, high);
    else table_cell(table, "–");
}

static void print_contenders(const struct tune *tune, size_t s) {
    const struct tune_measured *measured = tune->measured + s * TUNE_CONTENDERS;
    const struct glint_metric_table *rows = &measured[TUNE_START].errors;
    char title[100];
    /* the classes of the effect's own partition, which is the first */
    const size_t last = glint_effect_class_count(tune->against.effect), most = rows->count ? rows->count - 1 : 0,
                 classes = last < most ? last : most;
    const char *titles[8 + GLINT_EFFECT_CLASSES] = {"<preset", NULL};
    char names[GLINT_EFFECT_CLASSES][64];
    size_t n = 1;
    snprintf(title, sizeof title, ">%s [95 %%]", glint_metric(tune->metric)->title);
    titles[n++] = title;
    for (size_t r = 1; r <= classes; r++) {
        snprintf(names[r - 1], sizeof names[r - 1], ">%s", rows->rows[r].name);
        if (rows->rows[r].pixels) titles[n++] = names[r - 1];
    }
    titles[n++] = ">fetches/px";
    if (tune->repeat) titles[n++] = ">ms [95 %]", titles[n++] = ">tuned / this [95 %]", titles[n++] = "<tuned is";
    titles[n] = NULL;
    struct table *table = table_create(titles);
    for (int k = 0; k < TUNE_CONTENDERS; k++) {
        if (!tune->contenders[k]) continue;
        const struct glint_figure all = measured[k].errors.rows[0].of[tune->metric];
        if (k == TUNE_SCALED) table_cell(table, "start, scaled × %.3g", tune->subjects[s].factor);
        else table_cell(table, "%s", tune_contenders[k]);
        interval_cell(table, 5, all.value, all.low, all.high);
        for (size_t r = 1; r <= classes; r++)
            if (rows->rows[r].pixels) number_cell(table, "%.5f", measured[k].errors.rows[r].of[tune->metric].value);
        number_cell(table, "%.2f", measured[k].fetches_px);
        if (!tune->repeat) continue;
        const struct tune_median ms = measured[k].ms, part = measured[k].part;
        const bool less = part.high<1, more = part.low> 1;
        interval_cell(table, 3, ms.value, ms.low, ms.high);
        interval_cell(table, 3, k == TUNE_TUNED ? NAN : part.value, part.low, part.high);
        table_cell(table, "%s", k == TUNE_TUNED ? "" : less ? "faster" : more ? "slower" : "equal");
        table_mark(table, k == TUNE_TUNED ? MARK_NONE : less ? MARK_GOOD : more ? MARK_FAIL : MARK_NONE);
    }
    printf("\n%s%s:\n\n", name_text(base_name(tune->subjects[s].path)),
           tune->subjects[s].held_out ? " (held out)" : "");
    table_print(table, stdout);
    table_destroy(&table);
}

/* The interval is of the paired difference, so errors that both images share do not widen it. */
static void add_differences(const struct tune *tune, size_t s, int other, const char *name, struct table *table) {
    const struct glint_metric_table *rows = &tune->measured[s * TUNE_CONTENDERS + TUNE_TUNED].errors;
    for (size_t r = 0; r < rows->count; r++) {
        struct glint_figure d;
        if (!tune_difference(tune, s, other, TUNE_TUNED, r, &d)) continue;
        const char *verdict = tune_verdict(&d);
        table_cell(table, "%s", name);
        table_cell(table, "%s", r ? rows->rows[r].name : "all");
        table_cell(table, "%+.5f [%+.5f, %+.5f]", d.value, d.low, d.high);
        table_cell(table, "%s", verdict);
        table_mark(table, !strcmp(verdict, "less") ? MARK_GOOD : !strcmp(verdict, "more") ? MARK_FAIL : MARK_NONE);
    }
}

static void print_differences(const struct tune *tune, size_t s) {
    static const char *const titles[] = {"<than", "<surfaces", ">difference [95 %]", "<tuned has", NULL};
    struct table *table = table_create(titles);
    add_differences(tune, s, TUNE_START, "start", table);
    if (tune->contenders[TUNE_SCALED]) add_differences(tune, s, TUNE_SCALED, "scaled start", table);
    puts("\nError of tuned minus that of the other; equal where the interval contains 0:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

/* Adds a parameter to its slot's: "cocoon: size, reach; cubemap_mips: join". */
static void add_name(FILE *out, const char *name, char slot[64]) {
    const size_t length = strcspn(name, ".");
    const bool same = strlen(slot) == length && !strncmp(slot, name, length);
    if (same) fprintf(out, ", %s", name + length + (name[length] == '.'));
    else fprintf(out, "%s%.*s: %s", *slot ? "; " : "", (int)length, name, name + length + (name[length] == '.'));
    snprintf(slot, 64, "%.*s", (int)length, name);
}

/* A row of the parameters from `first` on that are left alone for the same reason. */
static void add_left(const struct tune_left *left, size_t count, size_t first, struct table *table) {
    char *names = NULL, slot[64] = "";
    size_t size = 0, parameters = 0;
    for (size_t i = 0; i < first; i++)
        if (!strcmp(left[i].why, left[first].why)) return;
    FILE *out = open_memstream(&names, &size);
    if (!out) return;
    for (size_t i = first; i < count; i++)
        if (!strcmp(left[i].why, left[first].why)) add_name(out, left[i].name, slot), parameters++;
    fclose(out);
    table_cell(table, "%s", left[first].why);
    table_cell(table, "%zu", parameters);
    table_cell(table, "%s", names ? names : "");
    free(names);
}

/* One row for each reason. */
static void print_left(const struct tune *tune) {
    struct table *table = table_create((const char *const[]){"<not tuned, because it", ">", "<parameters", NULL});
    const size_t most = tune->left_count + tune->axis_count;
    struct tune_left *left = calloc(most + 1, sizeof *left);
    size_t count = tune->left_count;
    if (left && count) memcpy(left, tune->left, count * sizeof *left);
    for (size_t a = 0; left && a < tune->axis_count; a++) {
        if (tune->found.matters[a]) continue;
        snprintf(left[count].name, sizeof left->name, "%s", tune->axes[a].name);
        snprintf(left[count++].why, sizeof left->why, "%s", TUNE_NO_EFFECT);
    }
    for (size_t i = 0; left && i < count; i++) add_left(left, count, i, table);
    putchar('\n');
    if (!table_is_empty(table)) table_print(table, stdout);
    table_destroy(&table);
    free(left);
}

/* "-2.1 %" */
static void percent_text(double to, double from, char text[24]) {
    if (from > 0) snprintf(text, 24, "%+.0f %%", 100 * (to / from - 1));
    else snprintf(text, 24, "–");
}

static void print_summary(const struct tune *tune) {
    const struct glint_search_figures *found = &tune->found.points[tune->chosen].figures;
    const double error = tune->by_error ? found->constraint : found->objective;
    const double cost = tune->by_error ? found->objective : found->constraint;
    char cheaper[24], worse[24];
    percent_text(cost, tune->start.cost, cheaper);
    percent_text(error, tune->start.error, worse);
    const bool better = tune->by_error ? cost < tune->start.cost : error < tune->start.error;
    const enum mark mark = better ? MARK_GOOD : MARK_WARN;
    mark_print(mark, "%s: cost %s, error %s", name_text(tune->out), cheaper, worse);
    printf(" after %zu evaluations\n", tune->found.count);
    printf("  from %.4g to %.4g %s, %s from %.5f to %.5f\n\n", tune->start.cost, cost, tune_cost_unit(tune),
           glint_metric(tune->metric)->title, tune->start.error, error);
}

void tune_print(const struct tune *tune) {
    const struct glint_device_info *device = glint_device_get_info(tune->device);
    print_summary(tune);
    print_moved(tune);
    for (size_t i = 0; tune->overall && i < tune->subject_count; i++) {
        if (!tune_is_shown(tune, i)) continue;
        print_contenders(tune, tune_ranked(tune, i));
        print_differences(tune, tune_ranked(tune, i));
    }
    if (tune->overall) tune_print_overall(tune);
    print_left(tune);
    if (tune->repeat)
        printf("times: median of %u alternating rounds on %s, with 95 %% intervals%s\n", tune->repeat, device->name,
               device->is_cpu ? " (a CPU device: times do not represent a GPU)" : "");
    printf("evaluations, references and page are in %s\n", name_text(tune->folder));
}
