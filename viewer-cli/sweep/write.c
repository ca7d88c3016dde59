/* The results of a sweep as JSON and CSV, row by row: its rows are in the journal, not in memory. */
#include <math.h>
#include <stdlib.h>

#include "sweep/sweep.h"
#include "io/table.h"
#include "options/capture_set.h"

/* ---- JSON ---- */

static json_t *time_json(double median, double low, double high) {
    return json_pack("{s:o, s:o, s:o}", "min", json_number(low), "median", json_number(median), "max",
                     json_number(high));
}

static json_t *cost_of(const struct sweep *sweep, size_t c, size_t p, enum sweep_cost cost) {
    double low, high, median = sweep_time(sweep, c, p, cost, &low, &high);
    return time_json(median, low, high);
}

/* Median over the rounds of each pass. */
static json_t *passes_json(const struct sweep *sweep, const struct sweep_lines *lines) {
    json_t *passes = json_object(), *value;
    double *ms = calloc(sweep->rounds + 1, sizeof *ms), low, high;
    const char *slot;
    json_object_foreach(json_object_get(lines->rounds[0], "passes"), slot, value) {
        size_t count = 0;
        for (uint32_t r = 0; ms && r < sweep->rounds; r++) {
            const double found = sweep_number(json_object_get(lines->rounds[r], "passes"), slot);
            if (isfinite(found)) ms[count++] = found;
        }
        if (ms) json_object_set_new(passes, slot, json_number(sweep_median(ms, count, &low, &high)));
    }
    free(ms);
    return passes;
}

static json_t *row_json(const struct sweep *sweep, size_t c, size_t p) {
    struct sweep_lines lines = sweep_read(sweep, c, p);
    json_t *json = lines.look ? json_incref(lines.look) : json_object();
    json_object_del(json, "point");
    if (lines.rounds && sweep->rounds && lines.rounds[0]) {
        json_object_set_new(json, "frame_ms", cost_of(sweep, c, p, SWEEP_FRAME));
        json_object_set_new(json, "cubemaps_ms", cost_of(sweep, c, p, SWEEP_CUBEMAPS));
        json_object_set_new(json, "passes_ms", passes_json(sweep, &lines));
    }
    sweep_release(sweep, &lines);
    return json;
}

static json_t *sum_json(struct sweep_sum sum) {
    return json_pack("{s:o, s:o}", "mean", json_number(sum.mean), "worst", json_number(sum.worst));
}

/* {TAG: figures of the captures that have it} */
static json_t *tags_json(const struct sweep *sweep, size_t p) {
    const struct capture_groups *groups = &sweep->overall.captures;
    json_t *json = json_object();
    for (size_t g = 1; g < groups->count; g++) {
        const char *name = groups->of[g].tag;
        const size_t count = sweep_count(sweep, name);
        const struct sweep_point sum = sweep_sum(sweep, p, name);
        json_t *figures =
            json_pack("{s:I, s:I}", "captures", (json_int_t)count, "shots", (json_int_t)groups->of[g].shots);
        if (count) {
            json_object_set_new(figures, "error", sum_json(sum.error));
            sweep_overall_add(sweep, g, p, figures);
            json_object_set_new(figures, "frame_ms", sum_json(sum.frame_ms));
            json_object_set_new(figures, "fetches_px", sum_json(sum.fetches_px));
        }
        json_object_set_new(json, name, figures);
    }
    return json;
}

/* All but the rows. */
static json_t *point_json(const struct sweep *sweep, size_t p) {
    const struct sweep_point *s = &sweep->sums[p];
    json_t *values = json_object(), *fronts = json_array();
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++) {
        const char *value = glint_space_value(sweep->space, p, a);
        json_object_set_new(values, glint_space_axis(sweep->space, a), value[0] ? json_string(value) : json_null());
    }
    for (size_t f = 0; f < sweep->front_count; f++)
        if (sweep->fronts[f].on[p]) json_array_append_new(fronts, json_string(sweep->fronts[f].name));
    json_t *json = json_pack("{s:I, s:o, s:b, s:o, s:o, s:o, s:o, s:o, s:o, s:[]}", "point", (json_int_t)p, "values",
                             values, "valid", s->valid, "front", fronts, "error", sum_json(s->error), "frame_ms",
                             sum_json(s->frame_ms), "cubemaps_ms", sum_json(s->cubemaps_ms), "steps_px",
                             sum_json(s->steps_px), "fetches_px", sum_json(s->fetches_px), "captures");
    if (sweep->captures.count > 1) sweep_overall_add(sweep, 0, p, json);
    if (sweep->captures.set) json_object_set_new(json, "tags", tags_json(sweep, p));
    return json;
}

struct point_rows {
    const struct sweep *sweep;
    size_t point;
};

static void put_row_json(FILE *out, void *user, size_t capture, size_t indent, size_t spaces) {
    const struct point_rows *rows = user;
    json_put(out, row_json(rows->sweep, capture, rows->point), indent, spaces);
}

static void put_point(FILE *out, void *user, size_t point, size_t indent, size_t spaces) {
    const struct sweep *sweep = *(const struct sweep *const *)user;
    struct point_rows rows = {sweep, point};
    json_put_list(out, point_json(sweep, point), "captures", sweep->captures.count, put_row_json, &rows, indent,
                  spaces);
}

static json_t *fronts_json(const struct sweep *sweep) {
    json_t *fronts = json_array();
    for (size_t f = 0; f < sweep->front_count; f++) {
        json_t *on = json_array();
        for (size_t i = 0; i < sweep->fronts[f].count; i++)
            json_array_append_new(on, json_integer((json_int_t)sweep->fronts[f].points[i]));
        json_array_append_new(fronts, json_pack("{s:s, s:s, s:o}", "name", sweep->fronts[f].name, "against",
                                                sweep->fronts[f].title, "points", on));
    }
    return fronts;
}

void sweep_write_json(FILE *out, const struct sweep *sweep, size_t indent) {
    json_t *axes = json_array(), *captures = json_array();
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++)
        json_array_append_new(axes, json_string(glint_space_axis(sweep->space, a)));
    for (size_t c = 0; c < sweep->captures.count; c++)
        json_array_append_new(captures, json_string(sweep->captures.items[c]));
    const size_t knee = sweep_knee(sweep);
    const double *seconds = sweep->seconds;
    json_t *json = json_pack("{s:i, s:O, s:s, s:s, s:s, s:o, s:o, s:o, s:[], s:o, s:{s:f, s:f, s:f}}", "format", 1,
                             "sweep", sweep->definition, "effect", sweep->against.effect->name, "metric",
                             glint_metric(sweep->metric)->name, "answer", sweep->against.truth ? "truth" : "reference",
                             "captures", captures, "axes", axes, "fronts", fronts_json(sweep), "points", "knee",
                             knee < sweep->points ? json_integer((json_int_t)knee) : json_null(), "seconds", "looks",
                             seconds[0], "metrics", seconds[1], "pictures", seconds[2]);
    if (sweep->captures.count > 1)
        json_object_update_new(json, json_pack("{s:o, s:I}", "worst", sweep_worst_json(sweep), "broken",
                                               (json_int_t)sweep->overall.broken));
    json_put_list(out, json, "points", sweep->points, put_point, (void *)&sweep, indent, 0);
}

/* ---- CSV ---- */

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
    struct sweep_lines lines = sweep_read(sweep, c, p);
    double low, high, other[2];
    csv_text(out, sweep->captures.items[c]);
    fprintf(out, ",%zu", p);
    for (size_t a = 0; a < glint_space_axis_count(sweep->space); a++)
        fprintf(out, ",%s", glint_space_value(sweep->space, p, a));
    for (int k = 0; k < GLINT_TARGET_COUNT; k++)
        for (size_t i = 0; sweep_class(sweep, i); i++)
            for (size_t m = 0; m < GLINT_METRIC_COUNT; m++)
                if (sweep->metrics >> m & 1)
                    put_number(out, sweep_error(lines.look, glint_target_name((enum glint_target)k),
                                                sweep_class(sweep, i), (enum glint_metric)m));
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) put_number(out, sweep_number(lines.look, figures[i]));
    put_number(out, sweep_time(sweep, c, p, SWEEP_FRAME, &low, &high));
    put_number(out, low);
    put_number(out, high);
    put_number(out, sweep_time(sweep, c, p, SWEEP_CUBEMAPS, &other[0], &other[1]));
    for (size_t f = 0; f < sweep->front_count; f++) fprintf(out, ",%d", sweep->fronts[f].on[p]);
    const char *failed = json_string_value(json_object_get(lines.look, "failed"));
    fputc(',', out);
    if (failed) csv_text(out, failed);
    fputc('\n', out);
    sweep_release(sweep, &lines);
}

void sweep_write_csv(FILE *out, const struct sweep *sweep) {
    put_titles(out, sweep);
    for (size_t c = 0; c < sweep->captures.count; c++)
        for (size_t p = 0; p < sweep->points; p++) put_row(out, sweep, c, p);
}
