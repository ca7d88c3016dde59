/* Compares two images: accumulates sums over tiles of pixels for each class and computes the figures from them. */
#include "comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "parallel.h"

/* ---- Channels ---- */

/* The index of a name in a list separated by spaces, which may be longer than the number of components. */
static bool find_channel(const char *names, uint32_t components, const char *name, size_t length, uint32_t *at) {
    for (*at = 0; *at < components && *names; ++*at) {
        size_t here = strcspn(names, " ");
        if (here == length && !strncmp(names, name, length)) return true;
        names += here + strspn(names + here, " ");
    }
    return false;
}

static bool match_channels(struct comparison *c, struct glint_error *err) {
    static const char any[] = "R G B A", colours[] = "RGB";
    const char *found = c->options->found_channels ? c->options->found_channels : any;
    const char *truth = c->options->truth_channels ? c->options->truth_channels : any;
    uint32_t colours_found = 0;
    const char *name = truth;
    for (uint32_t at = 0; at < c->truth->components && *name && c->channels < MAX_CHANNELS; at++) {
        size_t length = strcspn(name, " ");
        if (find_channel(found, c->found->components, name, length, &c->found_at[c->channels])) {
            const char *colour = length == 1 ? strchr(colours, *name) : NULL;
            if (colour) c->rgb[colour - colours] = c->channels;
            colours_found += colour != NULL;
            c->truth_at[c->channels++] = at;
        }
        name += length + strspn(name + length, " ");
    }
    c->has_rgb = colours_found == 3;
    return c->channels > 0 || glint_fail(err, GLINT_ERROR_USAGE,
                                         "images to compare: '%s' and '%s' have no channel in common", found, truth);
}

/* ---- Which pixels are compared ---- */

/* Statistics of a row of pixels. */
struct row {
    uint64_t invalid_found, invalid_truth;
    uint32_t first; /* the first invalid pixel; the width if there is none */
    float peak;
};
struct scan {
    struct comparison *c;
    struct row *rows;
    bool peak; /* the peak is needed */
};

static bool are_finite(const float *values, const uint32_t *at, uint32_t count) {
    for (uint32_t k = 0; k < count; k++)
        if (!isfinite(values[at[k]])) return false;
    return true;
}

static float max_magnitude(const float *values, const uint32_t *at, uint32_t count) {
    float value = 0;
    for (uint32_t k = 0; k < count; k++) value = fabsf(values[at[k]]) > value ? fabsf(values[at[k]]) : value;
    return value;
}

static void scan_rows(void *user, size_t first, size_t last) {
    const struct scan *scan = user;
    struct comparison *c = scan->c;
    uint32_t width = c->found->width;
    for (size_t y = first; y < last; y++) {
        struct row row = {.first = width};
        for (size_t i = y * width; i < (y + 1) * width; i++) {
            const float *found = c->found->values + i * c->found->components,
                        *truth = c->truth->values + i * c->truth->components;
            c->use[i] = LEFT_OUT;
            if (c->options->mask && !c->options->mask[i]) continue;
            if (c->options->truth_error && isinf(c->options->truth_error[i])) continue;
            bool found_valid = are_finite(found, c->found_at, c->channels),
                 truth_valid = are_finite(truth, c->truth_at, c->channels);
            c->use[i] = found_valid && truth_valid ? COMPARED : INVALID;
            row.invalid_found += !found_valid;
            row.invalid_truth += !truth_valid;
            if (c->use[i] == INVALID && row.first == width) row.first = (uint32_t)(i - y * width);
            if (truth_valid && scan->peak) row.peak = fmaxf(row.peak, max_magnitude(truth, c->truth_at, c->channels));
        }
        scan->rows[y] = row;
    }
}

static bool choose_pixels(struct comparison *c, struct glint_error *err) {
    struct glint_metric_table *t = c->table;
    uint32_t width = c->found->width, height = c->found->height;
    const bool peak = c->options->peak <= 0 && has_metric(c, GLINT_METRIC_PSNR);
    struct scan scan = {c, malloc(((size_t)height + 1) * sizeof *scan.rows), peak};
    c->use = malloc((size_t)width * height + 1);
    bool ok = (scan.rows && c->use) || glint_fail(err, GLINT_ERROR_MEMORY, "images to compare: out of memory");
    if (ok) parallel_rows(height, scan_rows, &scan);
    for (uint32_t y = 0; ok && y < height; y++) {
        const struct row *row = &scan.rows[y];
        if (row->first < width && t->invalid_found + t->invalid_truth == 0) {
            t->first_x = row->first;
            t->first_y = y;
        }
        t->invalid_found += row->invalid_found;
        t->invalid_truth += row->invalid_truth;
        if (peak) t->peak = fmax(t->peak, (double)row->peak);
    }
    free(scan.rows);
    return ok;
}

/* ---- Sums ---- */

/* Sums over the channels of a compared pixel. This is the innermost loop, so it accumulates in local variables. */
static void sum_channels(const struct comparison *c, size_t i, double sums[SUM_COUNT]) {
    const float *found = c->found->values + i * c->found->components,
                *truth = c->truth->values + i * c->truth->components;
    const float error = c->options->truth_error ? c->options->truth_error[i] : 0;
    const double variance = isfinite(error) ? (double)error * (double)error : 0, epsilon = c->table->epsilon;
    const uint32_t channels = c->channels;
    double all = 0, difference = 0, square = 0, relative = 0, symmetric = 0, noise = 0, relative_noise = 0;
    for (uint32_t k = 0; k < channels; k++) {
        const double t = (double)truth[c->truth_at[k]], f = (double)found[c->found_at[k]], d = f - t;
        const double weight = 1 / (t * t + epsilon);
        all += t;
        difference += d;
        square += d * d;
        relative += d * d * weight;
        symmetric += fabs(d) / (fabs(f) + fabs(t) + GLINT_SYMMETRIC_EPSILON);
        noise += t * t * variance;
        relative_noise += t * t * variance * weight;
    }
    sums[SUM_PIXELS] = 1;
    sums[SUM_INVALID] = 0;
    sums[SUM_TRUTH] = all;
    sums[SUM_DIFFERENCE] = difference;
    sums[SUM_SQUARE] = square;
    sums[SUM_RELATIVE] = relative;
    sums[SUM_SYMMETRIC] = symmetric;
    sums[SUM_NOISE] = noise;
    sums[SUM_RELATIVE_NOISE] = relative_noise;
}

static void sum_pixel(const struct comparison *c, size_t i, double sums[SUM_COUNT]) {
    if (c->use[i] == INVALID) {
        for (int k = 0; k < SUM_COUNT; k++) sums[k] = k == SUM_INVALID;
        return;
    }
    sum_channels(c, i, sums);
    if (c->quantities == SUM_CHEAP) return;
    const bool window = c->ssim && !isnan(c->ssim[i]);
    sums[SUM_WINDOWS] = window;
    sums[SUM_SSIM] = window ? (double)c->ssim[i] : 0;
    sums[SUM_FLIP] = c->table->flip ? (double)c->table->flip[i] : 0;
    sums[SUM_HDR_FLIP] = c->table->hdr_flip ? (double)c->table->hdr_flip[i] : 0;
}

static void add_sums(const struct comparison *c, double *to, const double *from) {
    for (int k = 0; k < c->quantities; k++) to[k] += from[k];
}

static void sum_tile(const struct comparison *c, uint32_t column, uint32_t row) {
    double *all = c->sums + ((size_t)row * c->across + column) * c->table->count * SUM_COUNT, sums[SUM_COUNT];
    uint32_t width = c->found->width, height = c->found->height, left = column * c->tile;
    uint32_t right = left + c->tile < width ? left + c->tile : width;
    for (uint32_t y = row * c->tile; y < (row + 1) * c->tile && y < height; y++)
        for (size_t i = (size_t)y * width + left; i < (size_t)y * width + right; i++) {
            if (c->use[i] == LEFT_OUT) continue;
            sum_pixel(c, i, sums);
            add_sums(c, all, sums);
            double *of_set = all + SUM_COUNT;
            for (size_t s = 0; s < c->options->class_sets; s++) {
                const struct glint_classes *set = &c->options->classes[s];
                uint8_t label = set->labels[i];
                if (label && label <= set->count) add_sums(c, of_set + (size_t)(label - 1) * SUM_COUNT, sums);
                of_set += set->count * SUM_COUNT;
            }
        }
}

static void sum_tiles(void *user, size_t first, size_t last) {
    const struct comparison *c = user;
    for (size_t i = first; i < last; i++)
        for (uint32_t column = 0; column < c->across; column++) sum_tile(c, column, (uint32_t)i);
}

/* ---- Figures ---- */

static void fill_row(const struct comparison *c, size_t row) {
    struct glint_metric_row *r = &c->table->rows[row];
    double sums[SUM_COUNT] = {0};
    for (size_t tile = 0; tile < (size_t)c->across * c->down; tile++) add_sums(c, sums, sums_of(c, tile, row));
    r->pixels = (uint64_t)sums[SUM_PIXELS];
    r->invalid = (uint64_t)sums[SUM_INVALID];
    r->truth_mean = r->pixels ? sums[SUM_TRUTH] / (sums[SUM_PIXELS] * c->channels) : NAN;
    r->truth_noise = r->pixels ? sqrt(sums[SUM_NOISE] / (sums[SUM_PIXELS] * c->channels)) : NAN;
    for (int k = 0; k < GLINT_METRIC_COUNT; k++)
        r->of[k] = (struct glint_figure){figure_of(c, (enum glint_metric)k, sums), NAN, NAN};
}

static bool name_rows(struct comparison *c, struct glint_error *err) {
    const struct glint_metric_options *o = c->options;
    struct glint_metric_table *t = c->table;
    t->count = 1;
    for (size_t s = 0; s < o->class_sets; s++) t->count += o->classes[s].count;
    t->rows = calloc(t->count, sizeof *t->rows);
    if (!t->rows) return glint_fail(err, GLINT_ERROR_MEMORY, "images to compare: out of memory");
    size_t row = 0;
    t->rows[row++] = (struct glint_metric_row){.set = "all", .name = "all"};
    for (size_t s = 0; s < o->class_sets; s++)
        for (uint32_t k = 0; k < o->classes[s].count; k++)
            t->rows[row++] = (struct glint_metric_row){.set = o->classes[s].title, .name = o->classes[s].names[k]};
    return true;
}

/* About 200 tiles: enough for the bootstrap, and large against the regions of correlated errors, which scale with the picture. */
static bool make_tiles(struct comparison *c, struct glint_error *err) {
    uint32_t width = c->found->width, height = c->found->height;
    c->tile = (uint32_t)fmax(8, sqrt((double)width * height / 200));
    c->across = (width + c->tile - 1) / c->tile;
    c->down = (height + c->tile - 1) / c->tile;
    c->table->tile_px = c->tile;
    c->table->tiles = c->across * c->down;
    c->sums = calloc((size_t)c->across * c->down * c->table->count * SUM_COUNT + 1, sizeof *c->sums);
    return c->sums || glint_fail(err, GLINT_ERROR_MEMORY, "images to compare: out of memory");
}

static void take_options(struct comparison *c) {
    const struct glint_metric_options *o = c->options;
    *c->table = (struct glint_metric_table){.epsilon = o->epsilon > 0 ? o->epsilon : GLINT_RELATIVE_EPSILON,
                                            .peak = o->peak,
                                            .ppd = o->ppd > 0 ? o->ppd : GLINT_PPD,
                                            .exposure = o->exposure,
                                            .resamples = o->resamples,
                                            .seed = o->seed};
}

bool glint_metrics_compare(const struct glint_pixels *found, const struct glint_pixels *truth,
                           const struct glint_metric_options *options, struct glint_metric_table *table,
                           struct glint_error *err) {
    struct glint_metric_options o = *options;
    struct comparison c = {.found = found, .truth = truth, .options = &o, .table = table};
    if (o.metrics == 0) o.metrics = GLINT_METRICS_CHEAP;
    take_options(&c);
    if (found->width != truth->width || found->height != truth->height)
        return glint_fail(err, GLINT_ERROR_USAGE, "images to compare: expected one size, found %u × %u and %u × %u",
                          found->width, found->height, truth->width, truth->height);
    bool ok = match_channels(&c, err) && choose_pixels(&c, err) && name_rows(&c, err) && make_tiles(&c, err) &&
              map_ssim(&c, err) && map_flip(&c, err);
    c.quantities = c.ssim || table->flip || table->hdr_flip ? SUM_COUNT : SUM_CHEAP;
    if (ok) parallel_rows(c.down, sum_tiles, &c);
    for (size_t row = 0; ok && row < table->count; row++) fill_row(&c, row);
    if (ok && o.resamples) ok = find_intervals(&c, err);
    free(c.use);
    free(c.ssim);
    free(c.sums);
    if (!ok) glint_metric_table_finish(table);
    return ok;
}

void glint_metric_table_finish(struct glint_metric_table *table) {
    free(table->rows);
    free(table->flip);
    free(table->hdr_flip);
    free(table->resampled);
    *table = (struct glint_metric_table){0};
}

bool glint_metrics_valid(const struct glint_metric_table *t, const char *what, struct glint_error *err) {
    if (t->invalid_found + t->invalid_truth == 0) return true;
    return glint_fail(err, GLINT_ERROR_FORMAT,
                      "%s: NaN or infinite in %llu pixels, and in %llu of what it is compared with; the first is %u,%u",
                      what, (unsigned long long)t->invalid_found, (unsigned long long)t->invalid_truth, t->first_x,
                      t->first_y);
}
