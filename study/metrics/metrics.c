/* The metrics by name, and errors by class of pixel. */
#include "glint/metrics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nearest.h"

static const struct glint_metric_info metrics[GLINT_METRIC_COUNT] = {
    [GLINT_METRIC_MEAN] = {"mean_error", "mean error", "mean of found - truth", false},
    [GLINT_METRIC_RMSE] = {"rmse", "RMSE", "root of the mean squared difference", false},
    [GLINT_METRIC_RELATIVE_MSE] = {"relative_mse", "relative MSE",
                                   "mean of the squared difference over truth² + epsilon", false},
    [GLINT_METRIC_SYMMETRIC] = {"symmetric", "symmetric", "mean of |difference| over the sum of both and 0.05", false},
    [GLINT_METRIC_PSNR] = {"psnr", "PSNR dB", "peak over RMSE, in dB", true},
    [GLINT_METRIC_CLEAN_RMSE] = {"clean_rmse", "noise-free RMSE", "RMSE less what the noise of the truth adds", false},
    [GLINT_METRIC_CLEAN_RELATIVE_MSE] = {"clean_relative_mse", "noise-free relative MSE",
                                         "relative MSE without the truth's noise", false},
    [GLINT_METRIC_SSIM] = {"ssim", "SSIM", "structural similarity of the tone-mapped luminance", true},
    [GLINT_METRIC_FLIP] = {"flip", "ꟻLIP", "perceived difference when alternating, at one exposure", false},
    [GLINT_METRIC_HDR_FLIP] = {"hdr_flip", "HDR-ꟻLIP", "the largest of ꟻLIP over the exposures that show the truth",
                               false},
};

const struct glint_metric_info *glint_metric(size_t metric) {
    return metric < GLINT_METRIC_COUNT ? &metrics[metric] : NULL;
}

/* The bits of one name, 0 for none. */
static uint32_t bits_of(const char *name, size_t length) {
    if (length == 3 && !strncmp(name, "all", length)) return GLINT_METRICS_ALL;
    for (size_t i = 0; i < GLINT_METRIC_COUNT; i++)
        if (strlen(metrics[i].name) == length && !strncmp(metrics[i].name, name, length)) return 1u << i;
    return 0;
}

bool glint_metrics_parse(const char *names, uint32_t *chosen, struct glint_error *err) {
    *chosen = 0;
    for (const char *at = names;; at++) {
        size_t length = strcspn(at, ",");
        uint32_t bits = bits_of(at, length);
        if (!bits) {
            char name[64];
            snprintf(name, sizeof name, "%.*s", (int)length, at);
            struct glint_nearest near = glint_nearest_to(name);
            glint_nearest_offer(&near, "all");
            for (size_t i = 0; i < GLINT_METRIC_COUNT; i++) glint_nearest_offer(&near, metrics[i].name);
            return glint_fail(err, GLINT_ERROR_USAGE, "metric '%s'%s: expected one of %s", name,
                              glint_nearest_text(&near), near.known);
        }
        *chosen |= bits;
        at += length;
        if (!*at) return true;
    }
}

void glint_pixels_finish(struct glint_pixels *pixels) {
    free(pixels->values);
    *pixels = (struct glint_pixels){0};
}

static struct glint_image_error error_of(const struct glint_metric_row *row) {
    struct glint_image_error e = {.pixels = row->pixels, .invalid = row->invalid};
    if (row->pixels == 0) return e;
    e.truth_mean = row->truth_mean;
    e.truth_noise = row->truth_noise;
    e.mean = row->of[GLINT_METRIC_MEAN].value;
    e.rmse = row->of[GLINT_METRIC_RMSE].value;
    e.relative_mse = row->of[GLINT_METRIC_RELATIVE_MSE].value;
    e.symmetric = row->of[GLINT_METRIC_SYMMETRIC].value;
    e.clean_rmse = row->of[GLINT_METRIC_CLEAN_RMSE].value;
    e.clean_relative_mse = row->of[GLINT_METRIC_CLEAN_RELATIVE_MSE].value;
    return e;
}

bool glint_study_image(const struct glint_pixels *found, const struct glint_pixels *truth, uint32_t channels,
                       const uint8_t *labels, const float *truth_error, struct glint_image_errors *errors,
                       struct glint_error *err) {
    static const char *const names[] = {"", "R", "R G", "R G B", "R G B A"};
    struct glint_metric_table table;
    *errors = (struct glint_image_errors){0};
    if (channels == 0 || channels > 4 || channels > found->components || channels > truth->components)
        return glint_fail(err, GLINT_ERROR_USAGE, "images to compare: expected %u channels, found %u and %u", channels,
                          found->components, truth->components);
    const struct glint_classes classes = {.count = GLINT_EFFECT_CLASSES, .labels = (uint8_t *)(uintptr_t)labels};
    const struct glint_metric_options options = {.metrics = GLINT_METRICS_CHEAP & ~(1u << GLINT_METRIC_PSNR),
                                                 .found_channels = names[channels],
                                                 .truth_channels = names[channels],
                                                 .mask = labels,
                                                 .classes = &classes,
                                                 .class_sets = labels ? 1 : 0,
                                                 .truth_error = truth_error};
    if (!glint_metrics_compare(found, truth, &options, &table, err)) return false;
    for (size_t k = 0; k < table.count; k++) errors->of[k] = error_of(&table.rows[k]);
    glint_metric_table_finish(&table);
    return true;
}
