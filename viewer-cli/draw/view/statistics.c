/* Computes statistics and histograms of each channel. */
#include "draw/view/statistics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/args.h"
#include "glint/sort.h"
#include "io/table.h"

enum { BAR_COLUMNS = 40 };

/* The sorted finite values of a channel, and the numbers of all others. */
struct channel {
    const char *name;
    float *sorted;
    size_t count, nan, above, below, zero; /* above, below: +inf, -inf */
    double sum, sum2;
};

static bool gather(struct channel *c, const struct source *s, uint32_t k, struct glint_error *err) {
    const size_t texels = (size_t)s->width * s->height;
    *c = (struct channel){.name = s->channels[k], .sorted = malloc((texels + 1) * sizeof(float))};
    if (!c->sorted) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < texels; i++) {
        const float v = s->texels[i * s->components + k];
        c->nan += isnan(v) != 0;
        c->above += isinf(v) && v > 0;
        c->below += isinf(v) && v < 0;
        c->zero += v == 0;
        if (!isfinite(v)) continue;
        c->sorted[c->count++] = v;
        c->sum += (double)v;
        c->sum2 += (double)v * (double)v;
    }
    glint_sort_floats(c->sorted, c->count);
    return true;
}

/* The value below which this fraction of the finite values lies. */
static double percentile(const struct channel *c, double share) {
    return c->count ? (double)c->sorted[(size_t)((double)(c->count - 1) * share + 0.5)] : (double)NAN;
}

static double mean_of(const struct channel *c) {
    return c->count ? c->sum / (double)c->count : (double)NAN;
}

static double deviation_of(const struct channel *c) {
    const double mean = mean_of(c);
    return c->count ? sqrt(fmax(0, c->sum2 / (double)c->count - mean * mean)) : (double)NAN;
}

static const struct {
    const char *name;
    double share;
} points[] = {{"min", 0}, {"1 %", 0.01}, {"median", 0.5}, {"99 %", 0.99}, {"max", 1}};
enum { POINTS = sizeof points / sizeof *points };

static void table_row(struct table *table, const struct channel *c) {
    table_cell(table, "%s", c->name);
    for (int i = 0; i < POINTS; i++) table_cell(table, "%s", number_text(percentile(c, points[i].share)));
    table_cell(table, "%s", number_text(mean_of(c)));
    table_cell(table, "%s", number_text(deviation_of(c)));
    table_cell(table, "%zu", c->zero);
    table_cell(table, "%zu", c->above + c->below);
    table_cell(table, "%zu", c->nan);
}

/* ---- Histograms ---- */

struct histogram {
    double low, high;
    bool logarithmic;
    uint32_t bins;
    size_t *counts, under, over;
};

static double edge(const struct histogram *h, uint32_t i) {
    const double t = (double)i / h->bins;
    return h->logarithmic ? h->low * pow(h->high / h->low, t) : h->low + (h->high - h->low) * t;
}

static void choose_range(struct histogram *h, const struct channel *c, const struct falsecolor_options *range) {
    const float *first = c->sorted, *end = c->sorted + c->count;
    while (range->scale == SCALE_LOG && first < end && *first <= 0) first++;
    h->low = range->range_given ? range->low : first < end ? (double)*first : 0;
    h->high = range->range_given ? range->high : first < end ? (double)end[-1] : 1;
    if (!(h->low < h->high)) h->high = h->low + fmax(fabs(h->low), 1);
    h->logarithmic = range->scale == SCALE_LOG;
}

static bool fill_histogram(struct histogram *h, const struct channel *c, const struct statistics_options *options,
                           struct glint_error *err) {
    *h = (struct histogram){.bins = options->bins, .counts = calloc(options->bins, sizeof *h->counts)};
    if (!h->counts) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    choose_range(h, c, &options->range);
    if (h->logarithmic && !(h->low > 0)) {
        free(h->counts);
        return glint_fail(err, GLINT_ERROR_USAGE, "a logarithmic scale needs a positive range");
    }
    uint32_t bin = 0; /* values and edges are both sorted */
    for (size_t i = 0; i < c->count; i++) {
        const double v = (double)c->sorted[i];
        h->under += v < h->low;
        h->over += v > h->high;
        if (v < h->low || v > h->high) continue;
        while (bin + 1 < h->bins && v >= edge(h, bin + 1)) bin++;
        h->counts[bin]++;
    }
    return true;
}

/* A bar in steps of an eighth of a column. */
static void bar_text(double share, char text[4 * BAR_COLUMNS]) {
    static const char *const eighths[] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
    const int length = (int)lround(share * BAR_COLUMNS * 8);
    *text = '\0';
    for (int i = 0; i < length / 8; i++) strcat(text, "█");
    strcat(text, share > 0 && length == 0 ? eighths[1] : eighths[length % 8]);
}

static bool print_histogram(const struct channel *c, const struct histogram *h) {
    static const char *const titles[] = {">from", ">to", ">texels", ">%", "<relative to the largest bin", NULL};
    struct table *table = table_create(titles);
    size_t most = 1;
    for (uint32_t i = 0; i < h->bins; i++) most = h->counts[i] > most ? h->counts[i] : most;
    for (uint32_t i = 0; i < h->bins; i++) {
        char bar[4 * BAR_COLUMNS];
        bar_text((double)h->counts[i] / (double)most, bar);
        table_cell(table, "%s", number_text(edge(h, i)));
        table_cell(table, "%s", number_text(edge(h, i + 1)));
        table_cell(table, "%zu", h->counts[i]);
        table_cell(table, "%.2f", 100 * (double)h->counts[i] / (double)(c->count ? c->count : 1));
        table_cell(table, "%s", bar);
    }
    printf("\n%s: %zu finite values, %zu below and %zu above the range\n", name_text(c->name), c->count, h->under,
           h->over);
    const bool ok = table_print(table, stdout);
    table_destroy(&table);
    return ok;
}

/* ---- JSON ---- */

static json_t *histogram_json(const struct histogram *h) {
    json_t *counts = json_array();
    for (uint32_t i = 0; i < h->bins; i++) json_array_append_new(counts, json_integer((json_int_t)h->counts[i]));
    return json_pack("{sf sf ss sI sI so}", "low", h->low, "high", h->high, "scale", h->logarithmic ? "log" : "linear",
                     "below", (json_int_t)h->under, "above", (json_int_t)h->over, "counts", counts);
}

static json_t *channel_json(const struct channel *c, const struct histogram *h) {
    return json_pack("{ss so so so so so so so sI sI sI sI sI so*}", "channel", c->name, "min",
                     json_number(percentile(c, 0)), "p1", json_number(percentile(c, 0.01)), "median",
                     json_number(percentile(c, 0.5)), "p99", json_number(percentile(c, 0.99)), "max",
                     json_number(percentile(c, 1)), "mean", json_number(mean_of(c)), "deviation",
                     json_number(deviation_of(c)), "finite", (json_int_t)c->count, "zero", (json_int_t)c->zero, "nan",
                     (json_int_t)c->nan, "infinite", (json_int_t)c->above, "minus_infinite", (json_int_t)c->below,
                     "histogram", h ? histogram_json(h) : NULL);
}

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

json_t *statistics_json(const struct source *s, struct glint_error *err) {
    json_t *rows = json_array();
    bool ok = true;
    for (uint32_t k = 0; ok && k < s->components; k++) {
        struct channel channel;
        ok = gather(&channel, s, k, err);
        if (ok) json_array_append_new(rows, channel_json(&channel, NULL));
        free(channel.sorted);
    }
    if (ok) return rows;
    json_decref(rows);
    return NULL;
}

static bool print_all(const struct source *s, const struct channel *channels, const struct histogram *histograms,
                      const struct statistics_options *options, struct glint_error *err) {
    static const char *const titles[] = {"<channel", ">min",       ">1 %",  ">median",   ">99 %", ">max",
                                         ">mean",    ">deviation", ">zero", ">infinite", ">NaN",  NULL};
    struct table *table = table_create(titles);
    json_t *rows = json_array();
    bool ok = true;
    for (uint32_t k = 0; k < s->components; k++) {
        table_row(table, &channels[k]);
        json_array_append_new(rows, channel_json(&channels[k], options->histogram ? &histograms[k] : NULL));
    }
    if (options->json) {
        ok = print_json(json_pack("{ss ss si si so}", "image", s->title, "unit", s->unit, "width", (int)s->width,
                                  "height", (int)s->height, "channels", rows)) == STATUS_DONE;
    } else {
        json_decref(rows);
        printf("%s: %u × %u%s%s\n", name_text(s->title), s->width, s->height, *s->unit ? ", " : "", name_text(s->unit));
        if (options->table) ok = table_print(table, stdout);
        for (uint32_t k = 0; ok && options->histogram && k < s->components; k++)
            ok = print_histogram(&channels[k], &histograms[k]);
    }
    table_destroy(&table);
    return ok || no_memory(err);
}

bool statistics_print(const struct source *source, const struct statistics_options *options, struct glint_error *err) {
    struct channel channels[4] = {{0}};
    struct histogram histograms[4] = {{0}};
    bool ok = true;
    for (uint32_t k = 0; ok && k < source->components; k++)
        ok = gather(&channels[k], source, k, err) &&
             (!options->histogram || fill_histogram(&histograms[k], &channels[k], options, err));
    ok = ok && print_all(source, channels, histograms, options, err);
    for (int k = 0; k < 4; k++) {
        free(channels[k].sorted);
        free(histograms[k].counts);
    }
    return ok;
}
