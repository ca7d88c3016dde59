/* The result of a comparison as tables and as JSON. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "options/args.h"
#include "diff/diff.h"
#include "options/metric_args.h"
#include "io/table.h"
#include "record.h"

enum { PLACES = 16 };

const char *const diff_words[] = {"same", "warning", "FAILS", "different size"};

/* Float channels precede integer channels. */
const char *diff_channel(const struct diff_pair *pair) {
    size_t left = pair->difference.channel;
    for (int integers = 0; integers < 2; integers++)
        for (size_t i = 0; i < pair->a->channel_count; i++) {
            size_t k = 0;
            while (k < pair->b->channel_count && strcmp(pair->a->channels[i], pair->b->channels[k]) != 0) k++;
            if (pair->a->integers[i] != integers || k == pair->b->channel_count || pair->b->integers[k] != integers)
                continue;
            if (left-- == 0) return pair->a->channels[i];
        }
    return "";
}

/* ---- JSON ---- */

static json_t *histogram_json(const struct glint_difference *d) {
    json_t *list = json_array();
    for (size_t i = 0; i < GLINT_DIFFERENCE_BINS; i++)
        if (d->histogram[i])
            json_array_append_new(list, json_pack("{s:o, s:I}", "up_to",
                                                  i == GLINT_DIFFERENCE_BINS - 1   ? json_string("not finite")
                                                  : i == GLINT_DIFFERENCE_BINS - 2 ? json_string("more")
                                                                                   : json_real(glint_difference_bin(i)),
                                                  "values", (json_int_t)d->histogram[i]));
    return list;
}

/* The first failing pixels, row by row. */
static json_t *places_json(const struct glint_difference *d) {
    json_t *list = json_array();
    for (size_t i = 0; i < d->pixels && json_array_size(list) < PLACES; i++)
        if (glint_difference_fails(d, i))
            json_array_append_new(list, json_pack("[i, i]", (int)(i % d->width), (int)(i / d->width)));
    return list;
}

/* Of R, G and B alone. */
static json_t *color_json(const struct diff_pair *pair) {
    const struct glint_difference *d = &pair->color;
    json_t *json =
        json_pack("{s:o, s:o, s:o, s:o}", "mean", json_number(d->mean), "rms", json_number(d->rms), "psnr",
                  json_number(d->psnr), "largest", isinf(d->largest) ? json_string("infinite") : json_real(d->largest));
    if (pair->color_metrics.count) json_object_set_new(json, "metrics", metrics_json(&pair->color_metrics));
    return json;
}

static json_t *pair_json(const struct diff_pair *pair) {
    const struct diff_image *image = diff_pair_image(pair);
    const struct glint_difference *d = &pair->difference;
    json_t *json = json_pack("{s:o, s:o, s:o, s:s, s:i}", "name", json_text(image->name), "slot",
                             json_text(image->slot), "unit", json_text(image->unit), "verdict",
                             pair->left_out ? "left out" : diff_words[pair->status], "status", (int)pair->status);
    if (pair->note[0]) json_object_set_new(json, "note", json_text(pair->note));
    if (!d->marks) return json;
    json_t *largest =
        json_pack("{s:o, s:i, s:i, s:o, s:o, s:o}", "by",
                  isinf(d->largest) ? json_string("infinite") : json_real(d->largest), "x", (int)d->x, "y", (int)d->y,
                  "channel", json_text(diff_channel(pair)), "a", json_number(d->a), "b", json_number(d->b));
    json_object_set_new(json, "width", json_integer(image->width));
    json_object_set_new(json, "height", json_integer(image->height));
    json_object_set_new(json, "pixels", json_integer((json_int_t)d->pixels));
    json_object_set_new(json, "differing", json_integer((json_int_t)d->differing));
    json_object_set_new(json, "failed", json_integer((json_int_t)d->failed));
    json_object_set_new(json, "warned", json_integer((json_int_t)d->warned));
    json_object_set_new(json, "mean", json_number(d->mean));
    json_object_set_new(json, "rms", json_number(d->rms));
    json_object_set_new(json, "psnr", json_number(d->psnr));
    json_object_set_new(json, "largest", largest);
    json_object_set_new(json, "places", places_json(d));
    json_object_set_new(json, "histogram", histogram_json(d));
    if (pair->metrics.count) json_object_set_new(json, "metrics", metrics_json(&pair->metrics));
    if (pair->color.marks) json_object_set_new(json, "rgb", color_json(pair));
    return json;
}

json_t *diff_json(const struct diff *diff) {
    json_t *images = json_array(), *json;
    const size_t first = diff_first(diff);
    for (size_t i = 0; i < diff->count; i++) json_array_append_new(images, pair_json(&diff->pairs[i]));
    json = json_pack("{s:o, s:o, s:i, s:o}", "a", json_text(diff->sides[0].text), "b", json_text(diff->sides[1].text),
                     "status", (int)diff->status, "images", images);
    if (first < diff->count) {
        const struct diff_image *image = diff_pair_image(&diff->pairs[first]);
        json_object_set_new(json, "first",
                            json_pack("{s:o, s:o}", "image", json_text(image->name), "slot", json_text(image->slot)));
    }
    if (diff->settings) json_object_set(json, "settings", diff->settings);
    if (diff->planned >= 0)
        json_object_set_new(json, "planned",
                            json_pack("{s:o, s:I, s:I}", "run", json_text(diff->sides[diff->planned].text),
                                      "images_left_out", (json_int_t)diff->left_out, "rays_left_out",
                                      (json_int_t)diff->rayless_count));
    return json;
}

/* ---- Text ---- */

static void print_settings(const json_t *settings) {
    static const char *const titles[] = {"<differs", "<first", "<second", NULL};
    struct table *t = table_create(titles);
    size_t i;
    json_t *row;
    json_array_foreach(settings, i, row) {
        static const char *const sides[] = {"a", "b"};
        table_cell(t, "%s", json_string_value(json_object_get(row, "what")));
        for (int k = 0; k < 2; k++) {
            char *text = record_text(json_object_get(row, sides[k]), JSON_ENCODE_ANY | JSON_REAL_PRECISION(6));
            table_cell(t, "%s", !text || !strcmp(text, "null") ? "–" : text);
            free(text);
        }
    }
    if (!table_is_empty(t)) {
        table_print(t, stdout);
        putchar('\n');
    }
    table_destroy(&t);
}

static enum mark diff_mark(enum diff_status status) {
    return status == DIFF_SAME ? MARK_GOOD : status == DIFF_WARN ? MARK_WARN : MARK_FAIL;
}

static void pair_row(struct table *t, const struct diff_pair *pair, bool runs) {
    const struct diff_image *image = diff_pair_image(pair);
    const struct glint_difference *d = &pair->difference;
    if (runs) table_cell(t, "%s", image->slot);
    table_cell(t, "%s", image->name[0] ? image->name : "–");
    table_cell(t, "%s", diff_words[pair->status]);
    table_mark(t, diff_mark(pair->status));
    if (!d->marks) {
        for (int i = 0; i < 5; i++) table_cell(t, "–");
        table_cell(t, "%s", pair->note);
        return;
    }
    table_cell(t, "%.3g %%", 100 * (double)d->differing / (double)d->pixels);
    table_cell(t, "%llu", (unsigned long long)d->failed);
    table_cell(t, "%s", number_text(d->rms));
    table_cell(t, "%s", pair->color.marks ? number_text(pair->color.rms) : "–");
    table_cell(t, "%s", number_text(d->largest));
    if (d->largest > 0)
        table_cell(t, "%u,%u %s: %s, %s%s%s", d->x, d->y, diff_channel(pair), number_text(d->a), number_text(d->b),
                   pair->note[0] ? "; " : "", pair->note);
    else table_cell(t, "%s", pair->note);
}

static void print_pairs(const struct diff *diff, bool verbose) {
    static const char *const titles[] = {"<pass", "<image",  "<",        ">pixels", ">over",
                                         ">rms",  ">of RGB", ">largest", "<at",     NULL};
    const bool runs = diff->sides[0].run || diff->sides[1].run;
    struct table *t = table_create(runs ? titles : titles + 1);
    for (size_t i = 0; i < diff->count; i++)
        if (diff->pairs[i].left_out) continue;
        else if (verbose || diff->pairs[i].status != DIFF_SAME || diff->pairs[i].difference.differing)
            pair_row(t, &diff->pairs[i], runs);
    if (!table_is_empty(t)) table_print(t, stdout);
    table_destroy(&t);
}

static void metric_row(struct table *t, const struct diff_pair *pair, const char *of,
                       const struct glint_metric_table *metrics, uint32_t chosen) {
    if (!metrics->count) return;
    table_cell(t, "%s", diff_pair_image(pair)->name);
    table_cell(t, "%s", of);
    for (size_t k = 0; k < GLINT_METRIC_COUNT; k++) {
        const double value = metrics->rows[0].of[k].value;
        if (!(chosen >> k & 1)) continue;
        if (isnan(value)) table_cell(t, "–");
        else if (isinf(value)) table_cell(t, value > 0 ? "∞" : "-∞");
        else table_cell(t, "%s", number_text(value));
    }
    table_cell(t, "%llu", (unsigned long long)metrics->rows[0].invalid);
}

/* The metrics of all images that differ. What is corrected for the noise of a truth is left out: a diff knows of none. */
static void print_metrics(const struct diff *diff, bool verbose) {
    const char *titles[4 + GLINT_METRIC_COUNT] = {"<image", "<channels"};
    char texts[GLINT_METRIC_COUNT][48];
    const uint32_t chosen =
        diff->options.metrics.metrics & ~(1u << GLINT_METRIC_CLEAN_RMSE | 1u << GLINT_METRIC_CLEAN_RELATIVE_MSE);
    size_t columns = 2;
    for (size_t k = 0; k < GLINT_METRIC_COUNT; k++) {
        snprintf(texts[k], sizeof texts[k], ">%s", glint_metric(k)->title);
        if (chosen >> k & 1) titles[columns++] = texts[k];
    }
    titles[columns] = ">NaN or infinite";
    struct table *t = table_create(titles);
    for (size_t i = 0; i < diff->count; i++) {
        const struct diff_pair *pair = &diff->pairs[i];
        if (!verbose && !pair->difference.differing) continue;
        metric_row(t, pair, pair->color_metrics.count ? "all" : "", &pair->metrics, chosen);
        metric_row(t, pair, "R G B", &pair->color_metrics, chosen);
    }
    if (!table_is_empty(t)) {
        putchar('\n');
        table_print(t, stdout);
    }
    table_destroy(&t);
}

static void print_histogram(const struct glint_difference *d) {
    printf("differences of values:");
    for (size_t i = 0; i < GLINT_DIFFERENCE_BINS; i++) {
        const double share = 100 * (double)d->histogram[i] / (double)d->values;
        if (!d->histogram[i]) continue;
        if (i == 0) printf(" none %.4g %%", share);
        else if (i == GLINT_DIFFERENCE_BINS - 1) printf(", not finite %.4g %%", share);
        else if (i == GLINT_DIFFERENCE_BINS - 2) printf(", more %.4g %%", share);
        else printf(", to %.0e %.4g %%", glint_difference_bin(i), share);
    }
    putchar('\n');
}

static void print_alone(const struct diff_pair *pair) {
    const struct glint_difference *d = &pair->difference;
    if (!d->marks) return;
    printf("mean %s, rms %s, psnr %.2f dB\n", number_text(d->mean), number_text(d->rms), d->psnr);
    if (pair->color.marks)
        printf("of R, G and B alone: mean %s, rms %s, psnr %.2f dB\n", number_text(pair->color.mean),
               number_text(pair->color.rms), pair->color.psnr);
    print_histogram(d);
    if (pair->metrics.count) metrics_print(&pair->metrics);
    if (pair->color_metrics.count) {
        puts("\nof R, G and B alone:");
        metrics_print(&pair->color_metrics);
    }
}

/* Images that only one of the runs contains, one line for each run. */
static void print_left_out(const struct diff *diff) {
    for (int k = 0; k < 2 && diff->planned >= 0; k++) {
        const char *mark = k == diff->planned ? "not computed by the plan of" : "computed only with a plan, not in";
        size_t named = 0;
        for (size_t i = 0; i < diff->count; i++) {
            const struct diff_pair *pair = &diff->pairs[i];
            if (!pair->left_out || (k ? pair->b : pair->a) || strstr(diff_pair_image(pair)->name, ".level")) continue;
            if (named++ == 0) printf("%s %s: ", mark, name_text(diff->sides[k].text));
            printf("%s%s", named > 1 ? ", " : "", name_text(diff_pair_image(pair)->name));
        }
        if (named) putchar('\n');
    }
    if (diff->rayless_count)
        printf("%s traces no ray at %zu of %zu texels, where images of rays were not compared\n",
               name_text(diff->sides[diff->planned].text), diff->rayless_count,
               (size_t)diff->rays_width * diff->rays_height);
}

void diff_print(const struct diff *diff, bool verbose) {
    static const char *const verdicts[] = {"PASS", "WARNING", "FAILURE", "FAILURE: different sizes"};
    const size_t first = diff_first(diff);
    size_t same = 0;
    if (diff->settings) print_settings(diff->settings);
    for (size_t i = 0; i < diff->count; i++) same += diff->pairs[i].status == DIFF_SAME && !diff->pairs[i].left_out;
    print_pairs(diff, verbose);
    print_left_out(diff);
    if (diff->count == 1) print_alone(&diff->pairs[0]);
    else {
        printf("%zu of %zu images%s are the same within the limits", same, diff->count - diff->left_out,
               diff->planned >= 0 ? " that both contain" : "");
        if (first < diff->count) {
            const struct diff_image *image = diff_pair_image(&diff->pairs[first]);
            printf("; the first that differs is %s%s%s", name_text(image->slot), image->slot[0] ? ": " : "",
                   name_text(image->name));
        }
        putchar('\n');
        if (diff->options.metrics.metrics) print_metrics(diff, verbose);
    }
    mark_print(diff_mark(diff->status), "%s", verdicts[diff->status]);
    putchar('\n');
}
