/* The results of a sweep as printed tables, JSON and CSV. */
#include <math.h>
#include <stdlib.h>

#include "sweep/sweep.h"
#include "io/table.h"
#include "options/capture_set.h"

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
    printf("\npage with charts, tables and pictures: %s/index.html\n", name_text(sweep->out));
}

static json_t *time_json(const struct sweep *sweep, const struct sweep_row *row, const char *key) {
    double low, high, median = sweep_time(sweep, row, key, &low, &high);
    return json_pack("{s:o, s:o, s:o}", "min", json_number(low), "median", json_number(median), "max",
                     json_number(high));
}

/* Median over the rounds of each pass. */
static json_t *passes_json(const struct sweep *sweep, const struct sweep_row *row) {
    json_t *passes = json_object(), *value;
    const char *slot;
    json_object_foreach(json_object_get(row->rounds[0], "passes"), slot, value) {
        struct sweep_row of_pass = {.rounds = calloc(sweep->rounds + 1, sizeof(json_t *))};
        double low, high;
        for (uint32_t r = 0; of_pass.rounds && r < sweep->rounds; r++)
            of_pass.rounds[r] = json_object_get(row->rounds[r], "passes");
        if (of_pass.rounds)
            json_object_set_new(passes, slot, json_number(sweep_time(sweep, &of_pass, slot, &low, &high)));
        free(of_pass.rounds);
    }
    return passes;
}

static json_t *row_json(const struct sweep *sweep, size_t c, size_t p) {
    const struct sweep_row *row = sweep_row(sweep, c, p);
    json_t *json = row->look ? json_copy(row->look) : json_object();
    json_object_del(json, "point");
    if (sweep->rounds && row->rounds[0]) {
        json_object_set_new(json, "frame_ms", time_json(sweep, row, "frame_ms"));
        json_object_set_new(json, "cubemaps_ms", time_json(sweep, row, "cubemaps_ms"));
        json_object_set_new(json, "passes_ms", passes_json(sweep, row));
    }
    return json;
}

static json_t *sum_json(struct sweep_sum sum) {
    return json_pack("{s:o, s:o}", "mean", json_number(sum.mean), "worst", json_number(sum.worst));
}

/* {TAG: figures of the captures that have it} */
static json_t *tags_json(const struct sweep *sweep, size_t p) {
    json_t *all = capture_set_all_tags(&sweep->captures), *json = json_object(), *tag;
    size_t i;
    json_array_foreach(all, i, tag) {
        const char *name = json_string_value(tag);
        const size_t count = sweep_count(sweep, name);
        const struct sweep_point sum = sweep_sum(sweep, p, name);
        json_t *figures = json_pack("{s:I}", "captures", (json_int_t)count);
        if (count) {
            json_object_set_new(figures, "error", sum_json(sum.error));
            json_object_set_new(figures, "frame_ms", sum_json(sum.frame_ms));
            json_object_set_new(figures, "fetches_px", sum_json(sum.fetches_px));
        }
        json_object_set_new(json, name, figures);
    }
    json_decref(all);
    return json;
}

static json_t *point_json(const struct sweep *sweep, size_t p) {
    const struct sweep_point *s = &sweep->sums[p];
    json_t *values = json_object(), *captures = json_array(), *fronts = json_array();
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++) {
        const char *value = glint_space_value(sweep->space, p, a);
        json_object_set_new(values, glint_space_axis(sweep->space, a), value[0] ? json_string(value) : json_null());
    }
    for (size_t c = 0; c < sweep->captures.count; c++) json_array_append_new(captures, row_json(sweep, c, p));
    for (size_t f = 0; f < sweep->front_count; f++)
        if (sweep->fronts[f].on[p]) json_array_append_new(fronts, json_string(sweep->fronts[f].name));
    json_t *json = json_pack("{s:I, s:o, s:b, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "point", (json_int_t)p, "values",
                             values, "valid", s->valid, "front", fronts, "error", sum_json(s->error), "frame_ms",
                             sum_json(s->frame_ms), "cubemaps_ms", sum_json(s->cubemaps_ms), "steps_px",
                             sum_json(s->steps_px), "fetches_px", sum_json(s->fetches_px), "captures", captures);
    if (sweep->captures.set) json_object_set_new(json, "tags", tags_json(sweep, p));
    return json;
}

/* Wall-clock time of the results, over all calls. */
static json_t *seconds_json(const struct sweep *sweep) {
    static const char *const keys[] = {"run_seconds", "metric_seconds", "picture_seconds"};
    double sums[3] = {0};
    for (size_t i = 0; i < sweep->captures.count * sweep->points; i++)
        for (int k = 0; k < 3; k++) {
            const double value = sweep_figure(&sweep->rows[i], keys[k]);
            sums[k] += isfinite(value) ? value : 0;
        }
    return json_pack("{s:f, s:f, s:f}", "looks", sums[0], "metrics", sums[1], "pictures", sums[2]);
}

json_t *sweep_json(const struct sweep *sweep) {
    json_t *points = json_array(), *fronts = json_array(), *axes = json_array(), *captures = json_array();
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++)
        json_array_append_new(axes, json_string(glint_space_axis(sweep->space, a)));
    for (size_t c = 0; c < sweep->captures.count; c++)
        json_array_append_new(captures, json_string(sweep->captures.items[c]));
    for (size_t p = 0; p < sweep->points; p++) json_array_append_new(points, point_json(sweep, p));
    for (size_t f = 0; f < sweep->front_count; f++) {
        json_t *on = json_array();
        for (size_t i = 0; i < sweep->fronts[f].count; i++)
            json_array_append_new(on, json_integer((json_int_t)sweep->fronts[f].points[i]));
        json_array_append_new(fronts, json_pack("{s:s, s:s, s:o}", "name", sweep->fronts[f].name, "against",
                                                sweep->fronts[f].title, "points", on));
    }
    const size_t knee = sweep_knee(sweep);
    return json_pack("{s:i, s:O, s:s, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o}", "format", 1, "sweep", sweep->definition,
                     "effect", sweep->against.effect->name, "metric", glint_metric(sweep->metric)->name, "answer",
                     sweep->against.truth ? "truth" : "reference", "captures", captures, "axes", axes, "fronts", fronts,
                     "points", points, "knee", knee < sweep->points ? json_integer((json_int_t)knee) : json_null(),
                     "seconds", seconds_json(sweep));
}

static void put_number(FILE *out, double value) {
    fputc(',', out);
    if (isfinite(value)) fprintf(out, "%.7g", value);
}

static void put_titles(FILE *out, const struct sweep *sweep) {
    fputs("capture,point", out);
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++) {
        fputc(',', out);
        csv_text(out, glint_space_axis(sweep->space, a));
    }
    for (int k = 0; k < GLINT_TARGET_COUNT; k++)
        for (size_t i = 0; sweep_class(sweep, i); i++)
            for (size_t m = 0; m < GLINT_METRIC_COUNT; m++)
                if (sweep->metrics >> m & 1)
                    fprintf(out, ",%s %s %s", glint_target_name((enum glint_target)k), sweep_class(sweep, i),
                            glint_metric(m)->name);
    fputs(",invalid,steps per ray,fetches per ray,steps per pixel,fetches per pixel,frame ms,frame ms lowest,"
          "frame ms highest,cube maps ms",
          out);
    for (size_t f = 0; f < sweep->front_count; f++) fprintf(out, ",front %s", sweep->fronts[f].name);
    fputs(",failed\n", out);
}

static void put_row(FILE *out, const struct sweep *sweep, size_t c, size_t p) {
    static const char *const figures[] = {"invalid", "steps", "fetches", "steps_px", "fetches_px"};
    const struct sweep_row *row = sweep_row(sweep, c, p);
    double low, high, other[2];
    csv_text(out, sweep->captures.items[c]);
    fprintf(out, ",%zu", p);
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++)
        fprintf(out, ",%s", glint_space_value(sweep->space, p, a));
    for (int k = 0; k < GLINT_TARGET_COUNT; k++)
        for (size_t i = 0; sweep_class(sweep, i); i++)
            for (size_t m = 0; m < GLINT_METRIC_COUNT; m++)
                if (sweep->metrics >> m & 1)
                    put_number(out, sweep_error(row, glint_target_name((enum glint_target)k), sweep_class(sweep, i),
                                                (enum glint_metric)m));
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) put_number(out, sweep_figure(row, figures[i]));
    put_number(out, sweep_time(sweep, row, "frame_ms", &low, &high));
    put_number(out, low);
    put_number(out, high);
    put_number(out, sweep_time(sweep, row, "cubemaps_ms", &other[0], &other[1]));
    for (size_t f = 0; f < sweep->front_count; f++) fprintf(out, ",%d", sweep->fronts[f].on[p]);
    const char *failed = json_string_value(json_object_get(row->look, "failed"));
    fputc(',', out);
    if (failed) csv_text(out, failed);
    fputc('\n', out);
}

char *sweep_csv(const struct sweep *sweep) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    put_titles(out, sweep);
    for (size_t c = 0; c < sweep->captures.count; c++)
        for (size_t p = 0; p < sweep->points; p++) put_row(out, sweep, c, p);
    const bool failed = ferror(out);
    if (fclose(out) == 0 && !failed) return text;
    free(text);
    return NULL;
}
