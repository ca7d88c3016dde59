/* A sweep of one parameter: error and cost against its values, and the knee of the error. */
#include <math.h>
#include <stdlib.h>

#include "draw/page/page.h"
#include "sweep/sweep.h"

/* The values of the axis, from the lowest, at which the error is known. */
struct curve {
    size_t *points, count;
    double *x, *y; /* value, error */
    bool log;      /* the knee is looked for over the logarithm of the values */
};

static void curve_finish(struct curve *curve) {
    free(curve->points);
    free(curve->x);
    free(curve->y);
}

static double value_of(const struct sweep *sweep, size_t point) {
    const char *text = glint_space_value(sweep->space, point, 0);
    char *end;
    const double value = strtod(text, &end);
    return *text && !*end ? value : NAN;
}

/* Inserts the points in the order of their values. False, with an empty curve, where the sweep has none: several axes, names as values. */
static bool curve_begin(struct curve *curve, const struct sweep *sweep) {
    *curve = (struct curve){.points = calloc(sweep->points + 1, sizeof *curve->points),
                            .x = calloc(sweep->points + 1, sizeof *curve->x),
                            .y = calloc(sweep->points + 1, sizeof *curve->y),
                            .log = true};
    const bool one = glint_space_axis_count(sweep->space) == 1 && curve->points && curve->x && curve->y;
    for (size_t p = 0; one && p < sweep->points; p++) {
        const double x = value_of(sweep, p), y = sweep->sums[p].error.mean;
        size_t at = curve->count;
        if (!isfinite(x)) return curve->count = 0, false;
        if (!sweep->sums[p].valid || !isfinite(y)) continue;
        for (; at && curve->x[at - 1] > x; at--) {
            curve->x[at] = curve->x[at - 1];
            curve->y[at] = curve->y[at - 1];
            curve->points[at] = curve->points[at - 1];
        }
        curve->x[at] = x;
        curve->y[at] = y;
        curve->points[at] = p;
        curve->count++;
        curve->log = curve->log && x > 0;
    }
    return curve->count > 2;
}

/* ---- The knee ---- */

/* The closest curve that never rises: neighbours that do are replaced by their mean (pool adjacent violators). */
static void make_falling(double *y, size_t count, size_t *weights) {
    size_t blocks = 0;
    for (size_t i = 0; i < count; i++) {
        double mean = y[i];
        size_t weight = 1;
        for (; blocks && y[blocks - 1] < mean; blocks--) {
            mean = (mean * (double)weight + y[blocks - 1] * (double)weights[blocks - 1]) /
                   (double)(weight + weights[blocks - 1]);
            weight += weights[blocks - 1];
        }
        y[blocks] = mean;
        weights[blocks++] = weight;
    }
    for (size_t i = count; blocks--;)
        for (size_t k = 0; k < weights[blocks]; k++) y[--i] = y[blocks];
}

/* Whether it is a local maximum of the distance above the diagonal, followed by a drop larger than the mean distance between points
   before the curve is as far above it again. */
static bool is_knee(const double *above, size_t count, size_t i) {
    const double enough = above[i] - 1 / (double)(count - 1);
    if (!(above[i] > 0 && above[i - 1] <= above[i] && above[i] > above[i + 1])) return false;
    for (size_t k = i + 1; k < count && (k == count - 1 || above[k] < above[i]); k++)
        if (above[k] < enough) return true;
    return false;
}

/* Satopaa et al., Finding a "Kneedle" in a Haystack, 2011, with S = 1, as docs/sweep.md has it: of errors that fall from the first value to
   the last. The index of the last knee; count if there is none. */
static size_t find_knee(const double *x, const double *y, size_t count, bool logarithmic) {
    double *fit = calloc(count + 1, sizeof *fit), *above = calloc(count + 1, sizeof *above);
    size_t *weights = calloc(count + 1, sizeof *weights), found = count;
    const double first = logarithmic ? log(x[0]) : x[0], last = logarithmic ? log(x[count - 1]) : x[count - 1];
    for (size_t i = 0; fit && i < count; i++) fit[i] = y[i];
    if (fit && weights) make_falling(fit, count, weights);
    if (fit && weights && above && fit[0] > fit[count - 1]) {
        for (size_t i = 0; i < count; i++)
            above[i] = (fit[0] - fit[i]) / (fit[0] - fit[count - 1]) -
                       ((logarithmic ? log(x[i]) : x[i]) - first) / (last - first);
        for (size_t i = 1; i + 1 < count; i++)
            if (is_knee(above, count, i)) found = i;
    }
    free(fit);
    free(above);
    free(weights);
    return found;
}

/* Where a higher figure is better, it is turned round. */
static size_t knee_of(const struct sweep *sweep, const struct curve *curve) {
    const double sign = glint_metric(sweep->metric)->higher_is_better ? -1 : 1;
    double *y = calloc(curve->count + 1, sizeof *y);
    size_t found = curve->count;
    for (size_t i = 0; y && i < curve->count; i++) y[i] = sign * curve->y[i];
    if (y) found = find_knee(curve->x, y, curve->count, curve->log);
    free(y);
    return found;
}

size_t sweep_knee(const struct sweep *sweep) {
    struct curve curve;
    const size_t knee = curve_begin(&curve, sweep) ? knee_of(sweep, &curve) : curve.count,
                 point = knee < curve.count ? curve.points[knee] : sweep->points;
    curve_finish(&curve);
    return point;
}

/* ---- Charts ---- */

enum what { ERROR, TIME, FETCHES };

static double figure_of(const struct sweep *sweep, size_t point, enum what what) {
    const struct sweep_point *s = &sweep->sums[point];
    return what == ERROR ? s->error.mean : what == TIME ? s->frame_ms.mean : s->fetches_px.mean;
}

static json_t *chart_of(const struct sweep *sweep, const struct curve *curve, size_t knee, enum what what) {
    static const char *const names[] = {NULL, "GPU time", "texture fetches"}, *const units[] = {"", "ms", "per pixel"};
    const char *name = what == ERROR ? glint_metric(sweep->metric)->title : names[what],
               *axis = glint_space_axis(sweep->space, 0);
    const bool wide = curve->log && curve->x[curve->count - 1] > 8 * curve->x[0];
    json_t *points = json_array(), *marks = json_array();
    char title[400], label[100];
    for (size_t i = 0; i < curve->count; i++) {
        const struct sweep_point *s = &sweep->sums[curve->points[i]];
        char text[100];
        snprintf(text, sizeof text, "point %zu", curve->points[i]);
        json_t *point = json_pack("{s:o, s:o, s:s}", "x", json_number(curve->x[i]), "y",
                                  json_number(figure_of(sweep, curve->points[i], what)), "name", text);
        if (what == TIME && s->high_ms > s->low_ms) {
            json_object_set_new(point, "low", json_number(s->low_ms));
            json_object_set_new(point, "high", json_number(s->high_ms));
        }
        json_array_append_new(points, point);
    }
    if (knee < curve->count) {
        snprintf(label, sizeof label, "knee, %.80s", glint_space_value(sweep->space, curve->points[knee], 0));
        json_array_append_new(marks,
                              json_pack("{s:o, s:o, s:s}", "x", json_number(curve->x[knee]), "y",
                                        json_number(figure_of(sweep, curve->points[knee], what)), "label", label));
    }
    snprintf(title, sizeof title, "%.100s against %.250s", name, axis);
    return json_pack("{s:s, s:{s:s, s:s, s:s}, s:{s:s, s:s, s:i}, s:[{s:s, s:s, s:o}], s:o}", "title", title, "x",
                     "name", axis, "unit", "", "scale", wide ? "log" : "linear", "y", "name", name, "unit", units[what],
                     "min", 0, "series", "name", name, "kind", "line", "points", points, "marks", marks);
}

static void add_words(const struct sweep *sweep, const struct curve *curve, size_t knee, json_t *blocks) {
    const double sign = glint_metric(sweep->metric)->higher_is_better ? -1 : 1;
    const bool falls = sign * curve->y[0] > sign * curve->y[curve->count - 1];
    char text[700];
    if (knee < curve->count)
        snprintf(text, sizeof text,
                 "Knee at %.200s: larger values reduce the error less than those up to there. It is where the curve is "
                 "farthest from the line between its ends (Kneedle, S = 1), over %s of the values.",
                 glint_space_value(sweep->space, curve->points[knee], 0), curve->log ? "the logarithm" : "the range");
    else
        snprintf(text, sizeof text, "No knee: the error %s.",
                 falls ? "falls at no value clearly faster than after it" : "does not fall with the value");
    page_text(blocks, "text", text);
}

bool sweep_add_curve(const struct sweep *sweep, struct page_charts *charts, json_t *document, struct glint_error *err) {
    static const char *const files[] = {"parameter-error.svg", "parameter-time.svg", "parameter-fetches.svg"};
    struct curve curve;
    bool ok = true;
    if (curve_begin(&curve, sweep)) {
        const size_t knee = knee_of(sweep, &curve);
        char title[300], path[4096];
        snprintf(title, sizeof title, "By %.250s", glint_space_axis(sweep->space, 0));
        json_t *blocks = page_section(document, title);
        for (enum what what = ERROR; ok && what <= FETCHES; what++) {
            if (what == TIME && !sweep->rounds) continue;
            json_t *chart = chart_of(sweep, &curve, knee, what);
            ok = chart ? sweep_path(sweep, files[what], path, err) && page_chart_write(charts, path, chart, err)
                       : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
            page_chart(blocks, chart);
        }
        add_words(sweep, &curve, knee, blocks);
    }
    curve_finish(&curve);
    return ok;
}
