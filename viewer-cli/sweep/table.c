/* The results of a sweep as printed tables. */
#include <math.h>
#include <stdlib.h>

#include "sweep/sweep.h"
#include "io/table.h"

static void value_or_dash_cell(struct table *table, double value) {
    if (isfinite(value)) table_cell(table, "%s", number_text(value));
    else table_cell(table, "–");
}

/* The table's columns: the point, its values, error and costs; the worst capture's beside the mean of several. */
enum { OTHER_COLUMNS = 16 };
static void list_titles(const struct sweep *sweep, const char **titles, char (*names)[300]) {
    const size_t axes = glint_space_axis_count(sweep->space);
    const bool several = sweep->captures.count > 1;
    size_t n = 0;
    titles[n++] = ">point";
    for (size_t a = 0; a <= axes; a++) {
        snprintf(names[a], sizeof names[a], ">%s",
                 a < axes ? glint_space_axis(sweep->space, a) : glint_metric(sweep->metric)->title);
        titles[n++] = names[a];
    }
    if (several) titles[n++] = ">worst";
    if (sweep->rounds) titles[n++] = ">ms", titles[n++] = ">lowest", titles[n++] = ">highest";
    if (sweep->rounds && several) titles[n++] = ">worst";
    titles[n++] = ">steps/px";
    titles[n++] = ">fetches/px";
    if (several) titles[n++] = ">worst";
    titles[n] = NULL;
}

static void print_point(struct table *table, const struct sweep *sweep, size_t p) {
    const struct sweep_point *s = &sweep->sums[p];
    const bool several = sweep->captures.count > 1;
    table_cell(table, "%zu", p);
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++) {
        const char *value = glint_space_value(sweep->space, p, a);
        table_cell(table, "%s", value[0] ? value : "–");
    }
    value_or_dash_cell(table, s->error.mean);
    if (several) value_or_dash_cell(table, s->error.worst);
    if (sweep->rounds)
        value_or_dash_cell(table, s->frame_ms.mean), value_or_dash_cell(table, s->low_ms),
            value_or_dash_cell(table, s->high_ms);
    if (sweep->rounds && several) value_or_dash_cell(table, s->frame_ms.worst);
    value_or_dash_cell(table, s->steps_px.mean);
    value_or_dash_cell(table, s->fetches_px.mean);
    if (several) value_or_dash_cell(table, s->fetches_px.worst);
}

static void print_front(const struct sweep *sweep, const struct sweep_front *front) {
    const size_t axes = glint_space_axis_count(sweep->space);
    const char **titles = calloc(axes + OTHER_COLUMNS, sizeof *titles);
    char(*names)[300] = calloc(axes + 1, sizeof *names);
    if (titles && names) {
        list_titles(sweep, titles, names);
        struct table *table = table_create(titles);
        for (size_t i = 0; i < front->count; i++) print_point(table, sweep, front->points[i]);
        printf("%s against %s: %zu of %zu points are Pareto-optimal:\n\n", glint_metric(sweep->metric)->title,
               front->title, front->count, sweep->points);
        table_print(table, stdout);
        table_destroy(&table);
        putchar('\n');
    }
    free(names);
    free(titles);
}

void sweep_print(const struct sweep *sweep) {
    const struct glint_device_info *device = glint_device_get_info(sweep->device);
    for (size_t f = 0; f < sweep->front_count; f++) print_front(sweep, &sweep->fronts[f]);
    const size_t knee = sweep_knee(sweep);
    if (knee < sweep->points) {
        printf("knee: %s=%s, beyond which larger values reduce the error less\n", glint_space_axis(sweep->space, 0),
               glint_space_value(sweep->space, knee, 0));
    }
    printf("errors of the %s, against the %s", sweep->against.effect->noun,
           sweep->against.truth ? "truth in the capture" : "reference");
    if (sweep->captures.count > 1) {
        const size_t counted = sweep_count(sweep, NULL);
        if (counted == sweep->captures.count) printf(", mean of %zu captures", counted);
        else printf(", mean of %zu of %zu captures", counted, sweep->captures.count);
    }
    if (sweep->rounds)
        printf("; times: median of %u alternating rounds on %s%s", sweep->rounds, device->name,
               device->is_cpu ? " (a CPU device: times do not represent a GPU)" : "");
    if (sweep->captures.count > 1) {
        putchar('\n');
        sweep_print_overall(sweep);
    }
    printf("\npage with charts, tables and pictures: %s/index.html\n", name_text(sweep->out));
}
