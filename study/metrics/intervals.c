/* Confidence intervals: bootstrap over tiles of pixels, since errors of neighbours are correlated, and percentiles of the resampled figures
   (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapters 8 and 13). */
#include "comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/sort.h"
#include "random.h"
#include "threads.h"

static const double TAIL = 0.025; /* on either side of a 95 % interval */

/* A tile that contains pixels of a row of the table. */
struct entry {
    size_t tile, row;
};

struct bootstrap {
    const struct comparison *c;
    struct entry *entries;
    size_t count, tiles, rows;
    double *values;  /* [row][metric][resample] */
    double *sums;    /* [worker][row][quantity] */
    uint32_t *drawn; /* [worker][tile] */
};

/* How often each of `count` things is drawn. A resample has a stream of its own, whichever thread it runs on. */
static void draw(uint32_t seed, size_t index, size_t count, uint32_t *drawn) {
    uint64_t state = (uint64_t)seed << 32 | index;
    state = next_random(&state);
    memset(drawn, 0, count * sizeof *drawn);
    for (size_t i = 0; i < count; i++) drawn[(next_random(&state) >> 32) * count >> 32]++;
}

static bool evaluate_resample(void *user, uint32_t worker, size_t index) {
    const struct bootstrap *b = user;
    uint32_t *drawn = b->drawn + worker * b->tiles;
    double *sums = b->sums + worker * b->rows * SUM_COUNT;
    draw(b->c->options->seed, index, b->tiles, drawn);
    memset(sums, 0, b->rows * SUM_COUNT * sizeof *sums);
    for (size_t i = 0; i < b->count; i++) {
        const struct entry *e = &b->entries[i];
        const double *from = sums_of(b->c, e->tile, e->row), times = drawn[e->tile];
        double *to = sums + e->row * SUM_COUNT;
        if (times > 0)
            for (int k = 0; k < b->c->quantities; k++) to[k] += times * from[k];
    }
    for (size_t row = 0; row < b->rows; row++)
        for (size_t k = 0; k < GLINT_METRIC_COUNT; k++)
            b->values[(row * GLINT_METRIC_COUNT + k) * b->c->options->resamples + index] =
                figure_of(b->c, (enum glint_metric)k, sums + row * SUM_COUNT);
    return true;
}

/* The bounds of the interval from `values`, which are reordered. A resample that drew none of a class's tiles has no value for it. */
static void set_interval(struct glint_figure *figure, double *values, size_t resamples) {
    size_t n = 0;
    for (size_t i = 0; i < resamples; i++)
        if (!isnan(values[i])) values[n++] = values[i];
    if (n == 0 || isnan(figure->value)) return;
    glint_sort_doubles(values, n);
    figure->low = values[(size_t)(TAIL * (double)n)];
    figure->high = values[n - 1 - (size_t)(TAIL * (double)n)];
}

static void list_entries(struct bootstrap *b, uint32_t *tiles_of_row) {
    for (size_t tile = 0; tile < b->tiles; tile++)
        for (size_t row = 0; row < b->rows; row++)
            if (sums_of(b->c, tile, row)[SUM_PIXELS] > 0) {
                b->entries[b->count++] = (struct entry){tile, row};
                tiles_of_row[row]++;
            }
}

bool find_intervals(struct comparison *c, struct glint_error *err) {
    const size_t resamples = c->options->resamples;
    struct bootstrap b = {.c = c, .tiles = (size_t)c->across * c->down, .rows = c->table->count};
    const uint32_t workers = glint_loop_workers(resamples, 0);
    b.entries = malloc(b.tiles * b.rows * sizeof *b.entries);
    b.values = malloc(b.rows * GLINT_METRIC_COUNT * resamples * sizeof *b.values);
    b.sums = malloc(workers * b.rows * SUM_COUNT * sizeof *b.sums);
    b.drawn = malloc(workers * b.tiles * sizeof *b.drawn);
    uint32_t *tiles_of_row = calloc(b.rows, sizeof *tiles_of_row);
    double *sorted = malloc(resamples * sizeof *sorted);
    bool ok = (b.entries && b.values && b.sums && b.drawn && tiles_of_row && sorted) ||
              glint_fail(err, GLINT_ERROR_MEMORY, "confidence intervals: out of memory");
    if (ok) {
        list_entries(&b, tiles_of_row);
        glint_loop(resamples, workers, evaluate_resample, &b);
    }
    /* A single tile cannot say how much tiles differ. */
    for (size_t row = 0; ok && row < b.rows; row++)
        for (size_t k = 0; tiles_of_row[row] > 1 && k < GLINT_METRIC_COUNT; k++) {
            memcpy(sorted, b.values + (row * GLINT_METRIC_COUNT + k) * resamples, resamples * sizeof *sorted);
            set_interval(&c->table->rows[row].of[k], sorted, resamples);
        }
    if (ok && c->options->keep_resampled) {
        c->table->resampled = b.values;
        b.values = NULL;
    }
    free(sorted);
    free(b.entries);
    free(b.values);
    free(b.sums);
    free(b.drawn);
    free(tiles_of_row);
    return ok;
}

bool glint_metrics_difference(const struct glint_metric_table *a, const struct glint_metric_table *b, size_t row,
                              enum glint_metric metric, struct glint_figure *difference, struct glint_error *err) {
    const size_t n = a->resamples, first = (row * GLINT_METRIC_COUNT + metric) * n;
    *difference = (struct glint_figure){NAN, NAN, NAN};
    if (!a->resampled || !b->resampled || a->count != b->count || row >= a->count || b->resamples != n ||
        a->seed != b->seed || a->tiles != b->tiles || a->tile_px != b->tile_px)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "difference of two comparisons: expected the same size, classes, resamples and seed, kept");
    double *values = malloc(n * sizeof *values);
    if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "difference of two comparisons: out of memory");
    difference->value = b->rows[row].of[metric].value - a->rows[row].of[metric].value;
    for (size_t i = 0; i < n; i++) values[i] = b->resampled[first + i] - a->resampled[first + i];
    if (!isnan(a->rows[row].of[metric].low) && !isnan(b->rows[row].of[metric].low)) set_interval(difference, values, n);
    free(values);
    return true;
}

/* ---- Means of values in clusters ---- */

struct cluster {
    double sum, count; /* of its known values */
};

/* Sums the known values of each cluster; those without any are left out. Returns how many remain. */
static size_t sum_clusters(const struct glint_clustered *c, struct cluster *sums) {
    size_t filled = 0;
    memset(sums, 0, c->cluster_count * sizeof *sums);
    for (size_t i = 0; i < c->count; i++) {
        if (isnan(c->values[i])) continue;
        sums[c->clusters[i]].sum += c->values[i];
        sums[c->clusters[i]].count++;
    }
    for (size_t i = 0; i < c->cluster_count; i++)
        if (sums[i].count > 0) sums[filled++] = sums[i];
    return filled;
}

static double mean_of_drawn(const struct cluster *sums, const uint32_t *drawn, size_t count) {
    struct cluster all = {0};
    for (size_t i = 0; i < count; i++) {
        const double times = drawn ? drawn[i] : 1;
        all.sum += times * sums[i].sum;
        all.count += times * sums[i].count;
    }
    return all.count > 0 ? all.sum / all.count : NAN;
}

bool glint_clustered_mean(const struct glint_clustered *c, struct glint_figure *mean, struct glint_error *err) {
    struct cluster *sums = malloc((c->cluster_count + 1) * sizeof *sums);
    uint32_t *drawn = malloc((c->cluster_count + 1) * sizeof *drawn);
    double *values = malloc((c->resamples + 1) * sizeof *values);
    const bool ok =
        (sums && drawn && values) || glint_fail(err, GLINT_ERROR_MEMORY, "confidence intervals: out of memory");
    *mean = (struct glint_figure){NAN, NAN, NAN};
    if (ok) {
        const size_t filled = sum_clusters(c, sums);
        mean->value = mean_of_drawn(sums, NULL, filled);
        for (size_t r = 0; filled > 1 && r < c->resamples; r++) {
            draw(c->seed, r, filled, drawn);
            values[r] = mean_of_drawn(sums, drawn, filled);
        }
        if (filled > 1) set_interval(mean, values, c->resamples);
    }
    free(sums);
    free(drawn);
    free(values);
    return ok;
}
