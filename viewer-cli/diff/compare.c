/* Compares the values of each pair of images. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "diff/diff.h"

/* The channels that both images have, integer or float. A channel that only one of them has fails. */
static size_t common_channels(struct diff_pair *pair, bool integers, const char *names[DIFF_CHANNELS]) {
    size_t count = 0;
    for (int side = 0; side < 2; side++) {
        const struct diff_image *own = side ? pair->b : pair->a, *other = side ? pair->a : pair->b;
        for (size_t i = 0; i < own->channel_count; i++) {
            size_t k = 0;
            if (own->integers[i] != integers) continue;
            while (k < other->channel_count && strcmp(own->channels[i], other->channels[k]) != 0) k++;
            if (k < other->channel_count && other->integers[k] == integers) {
                if (side == 0) names[count++] = own->channels[i];
                continue;
            }
            if (own->captured || other->captured) continue; /* what a part holds besides is no image's fault */
            pair->status = DIFF_FAIL;
            snprintf(pair->note, sizeof pair->note, "channel %.100s: %s has %s", own->channels[i],
                     side ? "the first" : "the second", k < other->channel_count ? "another type" : "none");
        }
    }
    return count;
}

static void add_heat(const struct diff_pair *pair, const void *a, const void *b, bool integers, size_t count) {
    for (size_t i = 0; i < pair->difference.pixels * count; i++) {
        const double x = integers ? ((const uint32_t *)a)[i] : (double)((const float *)a)[i],
                     y = integers ? ((const uint32_t *)b)[i] : (double)((const float *)b)[i];
        const float by = x == y || (isnan(x) && isnan(y)) ? 0 : (float)fabs(x - y);
        float *heat = &pair->heat[i / count];
        if (!(by <= *heat)) *heat = isnan(by) ? INFINITY : by;
    }
}

/* metrics.h handles up to four float channels, so the first four are used. */
static bool add_metrics(const struct diff *diff, struct glint_metric_table *metrics, const struct diff_image *image,
                        float *a, float *b, const char *const *names, size_t count, struct glint_error *err) {
    char channels[512] = "";
    struct glint_metric_options options = diff->options.metrics;
    for (size_t k = 0; k < count; k++) {
        const size_t used = strlen(channels);
        snprintf(channels + used, sizeof channels - used, "%s%s", used ? " " : "", names[k]);
    }
    const struct glint_pixels found = {image->width, image->height, (uint32_t)count, a},
                              truth = {image->width, image->height, (uint32_t)count, b};
    options.found_channels = options.truth_channels = channels;
    if (count < 3) options.metrics &= ~(1u << GLINT_METRIC_FLIP | 1u << GLINT_METRIC_HDR_FLIP);
    return glint_metrics_compare(&found, &truth, &options, metrics, err);
}

static const char *const rgba[] = {"R", "G", "B", "A"};

/* Where R, G, B and A are among the channels: their places. */
static bool find_rgba(const char *const *names, size_t count, size_t at[4]) {
    for (int k = 0; k < 4; k++) {
        at[k] = 0;
        while (at[k] < count && strcmp(names[at[k]], rgba[k]) != 0) at[k]++;
        if (at[k] == count) return false;
    }
    return true;
}

static float *colors_of(const float *values, size_t pixels, size_t count, const size_t at[3]) {
    float *colors = malloc(3 * pixels * sizeof *colors + 1);
    for (size_t i = 0; colors && i < 3 * pixels; i++) colors[i] = values[i / 3 * count + at[i % 3]];
    return colors;
}

static bool compare_colors(struct diff *diff, struct diff_pair *pair, const float *a, const float *b,
                           const char *const *names, size_t count, struct glint_error *err) {
    size_t at[4];
    if (!find_rgba(names, count, at)) return true;
    float *of[2] = {colors_of(a, pair->difference.pixels, count, at), colors_of(b, pair->difference.pixels, count, at)};
    bool ok = (of[0] && of[1]) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    ok = ok && glint_difference_begin(&pair->color, pair->a->width, pair->a->height, err);
    if (ok) glint_difference_add(&pair->color, of[0], of[1], false, 3, 0, &diff->options.limits);
    if (ok) glint_difference_end(&pair->color, &diff->options.limits); /* the verdict is that of all channels */
    if (ok && diff->options.metrics.metrics)
        ok = add_metrics(diff, &pair->color_metrics, pair->a, of[0], of[1], rgba, 3, err);
    free(of[0]);
    free(of[1]);
    return ok;
}

static bool compare_kind(struct diff *diff, struct diff_pair *pair, bool integers, size_t *channels,
                         struct glint_error *err) {
    const char *names[DIFF_CHANNELS];
    const size_t count = common_channels(pair, integers, names), values = pair->difference.pixels * count;
    if (!count) return true;
    uint32_t *a = malloc(values * sizeof *a), *b = malloc(values * sizeof *b);
    bool ok = (a && b) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    ok = ok && diff_side_read(&diff->sides[0], pair->a, names, count, integers, a, err) &&
         diff_side_read(&diff->sides[1], pair->b, names, count, integers, b, err);
    if (ok) diff_planned_skip(diff, pair, count, a, b);
    if (ok) glint_difference_add(&pair->difference, a, b, integers, (uint32_t)count, *channels, &diff->options.limits);
    if (ok && pair->heat) add_heat(pair, a, b, integers, count);
    if (ok && !integers && diff->options.metrics.metrics)
        ok = add_metrics(diff, &pair->metrics, pair->a, (float *)a, (float *)b, names, count, err);
    if (ok && !integers) ok = compare_colors(diff, pair, (float *)a, (float *)b, names, count, err);
    *channels += count;
    free(a);
    free(b);
    return ok;
}

/* Each axis of both images becomes that of the smaller one, where the other is averaged. */
static void resample_pair(struct diff *diff, struct diff_pair *pair) {
    const uint32_t width = pair->a->width < pair->b->width ? pair->a->width : pair->b->width,
                   height = pair->a->height < pair->b->height ? pair->a->height : pair->b->height;
    struct diff_image *images[2] = {&diff->sides[0].images[pair->a - diff->sides[0].images],
                                    &diff->sides[1].images[pair->b - diff->sides[1].images]};
    for (int k = 0; k < 2; k++) images[k]->width = width, images[k]->height = height;
    const size_t used = strlen(pair->note);
    snprintf(pair->note + used, sizeof pair->note - used, ", compared at %u x %u: means of the areas that texels cover",
             width, height);
}

static bool compare_pair(struct diff *diff, struct diff_pair *pair, struct glint_error *err) {
    size_t channels = 0;
    if (!pair->a || !pair->b) {
        pair->left_out = diff_is_planned_out(diff, pair);
        diff->left_out += pair->left_out;
        pair->status = pair->left_out ? DIFF_SAME : DIFF_FAIL;
        snprintf(pair->note, sizeof pair->note, "%s does not contain this image", pair->a ? "the second" : "the first");
        return true;
    }
    if (pair->a->width != pair->b->width || pair->a->height != pair->b->height) {
        const char *hint = diff->options.resample ? "" : "; --resample compares them";
        snprintf(pair->note, sizeof pair->note, "%u x %u and %u x %u%s", pair->a->width, pair->a->height,
                 pair->b->width, pair->b->height, hint);
        if (!diff->options.resample) return pair->status = DIFF_SIZE, true;
        resample_pair(diff, pair);
    }
    if (!glint_difference_begin(&pair->difference, pair->a->width, pair->a->height, err)) return false;
    if (diff->options.heat && !(pair->heat = calloc(pair->difference.pixels, sizeof *pair->heat)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (!compare_kind(diff, pair, false, &channels, err) || !compare_kind(diff, pair, true, &channels, err))
        return false;
    if (!channels && !pair->status) {
        pair->status = DIFF_FAIL;
        snprintf(pair->note, sizeof pair->note, "the two have no channel in common");
    }
    const enum diff_status found = (enum diff_status)glint_difference_end(&pair->difference, &diff->options.limits);
    if (found > pair->status) pair->status = found;
    return true;
}

static bool has_fog(const json_t *run) {
    json_t *pass;
    size_t i;
    json_array_foreach(json_object_get(run, "passes"), i,
                       pass) if (json_is_true(json_object_get(json_object_get(pass, "parameters"), "fog"))) return true;
    return false;
}

/* The truth has no fog, which is no error of a run that has. */
static void note_fog(const struct diff *diff, struct diff_pair *pair) {
    for (int k = 0; k < 2; k++) {
        const struct diff_side *side = &diff->sides[k];
        const struct diff_image *image = k ? pair->b : pair->a;
        if (!image || !image->captured || strncmp(image->name, "truth.", 6) != 0 ||
            !glint_capture_frame(side->capture)->has_fog || !has_fog(diff->sides[1 - k].json))
            continue;
        const size_t used = strlen(pair->note);
        snprintf(pair->note + used, sizeof pair->note - used, "%sthe truth has no fog, the run has", used ? "; " : "");
    }
}

bool diff_compare(struct diff *diff, glint_progress progress, void *user, struct glint_error *err) {
    if (!diff_pair_up(diff, err) || !diff_planned_begin(diff, err)) return false;
    if (diff->sides[0].json && diff->sides[1].json)
        diff->settings = diff_settings(diff->sides[0].json, diff->sides[1].json);
    for (size_t i = 0; i < diff->count; i++) {
        struct diff_pair *pair = &diff->pairs[i];
        if (progress && !progress(user, diff_pair_image(pair)->name, (double)i / (double)diff->count))
            return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
        if (!compare_pair(diff, pair, err)) return false;
        note_fog(diff, pair);
        if (pair->status > diff->status) diff->status = pair->status;
    }
    return true;
}
