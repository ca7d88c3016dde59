/* Prints the result of tuning: changed parameters, the final comparison, and parameters that were not tuned. */
#include <math.h>
#include <string.h>

#include "io/table.h"
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
        table_cell(table, "%s", tune->axes[a].row && !tune->axes[a].texts ? tune->axes[a].row->unit : "");
    }
    if (table_is_empty(table)) printf("no parameter changed: no better point than the start was found\n");
    else table_print(table, stdout);
    table_destroy(&table);
}

static void print_contenders(const struct tune *tune, size_t s) {
    const struct tune_measured *measured = tune->measured + s * TUNE_CONTENDERS;
    const struct glint_metric_table *rows = &measured[TUNE_START].errors;
    char title[100];
    const char *titles[16] = {"<", NULL};
    size_t n = 1;
    snprintf(title, sizeof title, ">%s", glint_metric(tune->metric)->title);
    titles[n++] = title, titles[n++] = ">from", titles[n++] = ">to";
    titles[n++] = ">mirror-like", titles[n++] = ">glossy", titles[n++] = ">rough", titles[n++] = ">fetches/px";
    if (tune->repeat) titles[n++] = ">ms", titles[n++] = ">from", titles[n++] = ">to", titles[n++] = ">time of tuned";
    titles[n] = NULL;
    struct table *table = table_create(titles);
    for (int k = 0; k < TUNE_CONTENDERS; k++) {
        if (!tune->contenders[k]) continue;
        const struct glint_figure all = measured[k].errors.rows[0].of[tune->metric];
        if (k == TUNE_SCALED) table_cell(table, "start, scaled × %.3g", tune->subjects[s].factor);
        else table_cell(table, "%s", tune_contenders[k]);
        table_cell(table, "%.5f", all.value);
        table_cell(table, "%.5f", all.low);
        table_cell(table, "%.5f", all.high);
        for (size_t r = 1; r < 4 && r < rows->count; r++)
            table_cell(table, "%.5f", measured[k].errors.rows[r].of[tune->metric].value);
        table_cell(table, "%.2f", measured[k].fetches_px);
        if (!tune->repeat) continue;
        table_cell(table, "%.4f", measured[k].ms.value);
        table_cell(table, "%.4f", measured[k].ms.low);
        table_cell(table, "%.4f", measured[k].ms.high);
        const struct tune_median part = measured[k].part;
        if (k == TUNE_TUNED) table_cell(table, " ");
        else table_cell(table, "%.3f [%.3f %.3f]: %s", part.value, part.low, part.high, tune_part_verdict(&part));
    }
    printf("\n%s%s:\n\n", base_name(tune->subjects[s].path), tune->subjects[s].held_out ? " (held out)" : "");
    table_print(table, stdout);
    table_destroy(&table);
}

/* The interval is of the paired difference, so errors that both images share do not widen it. */
static void print_differences(const struct tune *tune, size_t s, int other, const char *name) {
    const struct glint_metric_table *table = &tune->measured[s * TUNE_CONTENDERS + TUNE_TUNED].errors;
    for (size_t r = 0; r < table->count; r++) {
        struct glint_figure d;
        if (!tune_difference(tune, s, other, TUNE_TUNED, r, &d)) continue;
        printf("  %-16s %-12s %+.5f [%+.5f %+.5f]  %s\n", r ? "" : name, r ? table->rows[r].name : "all", d.value,
               d.low, d.high, tune_verdict(&d));
    }
}

static void print_left(const struct tune *tune) {
    struct table *table = table_create((const char *const[]){"<not tuned", "<because it", NULL});
    for (size_t i = 0; i < tune->left_count; i++) {
        table_cell(table, "%s", tune->left[i].name);
        table_cell(table, "%s", tune->left[i].why);
    }
    for (size_t a = 0; a < tune->axis_count; a++) {
        if (tune->found.matters[a]) continue;
        table_cell(table, "%s", tune->axes[a].name);
        table_cell(table, "has no effect on these captures");
    }
    printf("\n");
    if (!table_is_empty(table)) table_print(table, stdout);
    table_destroy(&table);
}

void tune_print(const struct tune *tune) {
    const struct glint_device_info *device = glint_device_get_info(tune->device);
    const struct glint_search_figures *found = &tune->found.points[tune->chosen].figures;
    const double error = tune->by_error ? found->constraint : found->objective;
    const double cost = tune->by_error ? found->objective : found->constraint;
    printf("%s: %s %.5f at %.4g %s after %zu evaluations; start: %.5f at %.4g %s\n\n", tune->out,
           glint_metric(tune->metric)->title, error, cost, tune_cost_unit(tune), tune->found.count, tune->start.error,
           tune->start.cost, tune_cost_unit(tune));
    print_moved(tune);
    for (size_t s = 0; tune->confirmed && s < tune->subject_count; s++) {
        print_contenders(tune, s);
        printf("\nerror of tuned minus error of the other, with its 95 %% interval:\n");
        print_differences(tune, s, TUNE_START, "the start");
        if (tune->contenders[TUNE_SCALED]) print_differences(tune, s, TUNE_SCALED, "scaled start");
    }
    print_left(tune);
    if (tune->repeat)
        printf("times: median of %u alternating rounds on %s, with 95 %% intervals%s\n", tune->repeat, device->name,
               device->is_cpu ? " (a CPU device: times do not represent a GPU)" : "");
    printf("evaluations, references and page are in %s\n", tune->folder);
}
