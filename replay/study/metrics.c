/* Errors of images and of distances, apart for mirror-like, glossy and rough surfaces. */
#include "glint/study.h"

#include <math.h>
#include <stdlib.h>

#include "metrics.h"

const char *glint_surface_name(enum glint_surface surface) {
    static const char *const names[GLINT_SURFACE_COUNT] = {"all", "mirror-like", "glossy", "rough"};
    return surface < GLINT_SURFACE_COUNT ? names[surface] : NULL;
}

enum glint_surface glint_surface_of(double roughness) {
    if (roughness <= GLINT_MIRROR_ROUGHNESS) return GLINT_SURFACE_MIRROR;
    return roughness <= GLINT_GLOSSY_ROUGHNESS ? GLINT_SURFACE_GLOSSY : GLINT_SURFACE_ROUGH;
}

void glint_pixels_finish(struct glint_pixels *pixels) {
    free(pixels->values);
    *pixels = (struct glint_pixels){0};
}

/* Sums over the values of one class. */
struct sums {
    uint64_t pixels, invalid;
    double truth, difference, square, relative, symmetric, noise, relative_noise;
};

static void add_pixel(struct sums *sums, const float *found, const float *truth, uint32_t channels, double error) {
    for (uint32_t k = 0; k < channels; k++)
        if (!isfinite(found[k])) {
            sums->invalid++;
            return;
        }
    sums->pixels++;
    for (uint32_t k = 0; k < channels; k++) {
        double t = (double)truth[k], d = (double)found[k] - t, weight = 1 / (t * t + GLINT_RELATIVE_EPSILON);
        sums->truth += t;
        sums->difference += d;
        sums->square += d * d;
        sums->relative += d * d * weight;
        sums->symmetric += fabs(d) / (fabs(d + t) + fabs(t) + GLINT_SYMMETRIC_EPSILON);
        sums->noise += t * t * error * error;
        sums->relative_noise += t * t * error * error * weight;
    }
}

static void add_sums(struct sums *to, const struct sums *from) {
    to->pixels += from->pixels;
    to->invalid += from->invalid;
    to->truth += from->truth;
    to->difference += from->difference;
    to->square += from->square;
    to->relative += from->relative;
    to->symmetric += from->symmetric;
    to->noise += from->noise;
    to->relative_noise += from->relative_noise;
}

static struct glint_image_error error_of(const struct sums *s, uint32_t channels) {
    struct glint_image_error e = {.pixels = s->pixels, .invalid = s->invalid};
    if (s->pixels == 0) return e;
    double n = (double)s->pixels * channels;
    e.truth_mean = s->truth / n;
    e.mean = s->difference / n;
    e.rmse = sqrt(s->square / n);
    e.relative_mse = s->relative / n;
    e.symmetric = s->symmetric / n;
    e.clean_rmse = sqrt(fmax(0, s->square - s->noise) / n);
    e.clean_relative_mse = fmax(0, s->relative - s->relative_noise) / n;
    e.truth_noise = sqrt(s->noise / n);
    return e;
}

bool glint_study_image(const struct glint_pixels *found, const struct glint_pixels *truth, uint32_t channels,
                       const uint8_t *surfaces, const float *truth_error, struct glint_image_errors *errors,
                       struct glint_error *err) {
    struct sums sums[GLINT_SURFACE_COUNT] = {{0}};
    *errors = (struct glint_image_errors){0};
    if (found->width != truth->width || found->height != truth->height)
        return glint_fail(err, GLINT_ERROR_USAGE, "images to compare: expected one size, found %u × %u and %u × %u",
                          found->width, found->height, truth->width, truth->height);
    if (channels == 0 || channels > found->components || channels > truth->components)
        return glint_fail(err, GLINT_ERROR_USAGE, "images to compare: expected %u channels, found %u and %u", channels,
                          found->components, truth->components);
    for (size_t i = 0; i < (size_t)found->width * found->height; i++) {
        uint8_t surface = surfaces ? surfaces[i] : GLINT_SURFACE_NONE;
        if (surfaces && (surface == GLINT_SURFACE_NONE || surface >= GLINT_SURFACE_COUNT)) continue;
        add_pixel(&sums[surface], found->values + i * found->components, truth->values + i * truth->components,
                  channels, truth_error && isfinite(truth_error[i]) ? (double)truth_error[i] : 0);
    }
    for (size_t k = 1; k < GLINT_SURFACE_COUNT; k++) {
        errors->of[k] = error_of(&sums[k], channels);
        add_sums(&sums[0], &sums[k]);
    }
    errors->of[0] = error_of(&sums[0], channels);
    return true;
}

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double distance_relative_error(double found, double truth) {
    if (!(found >= 0)) return INFINITY;
    if (isinf(found) || isinf(truth)) return isinf(found) && isinf(truth) ? 0 : INFINITY;
    return fabs(found - truth) / truth;
}

/* `values` is room for `count`; surface 0 takes all. */
static struct glint_distance_error distance_error(const float *found, const float *truth, const uint8_t *surfaces,
                                                  size_t count, uint8_t surface, double *values) {
    struct glint_distance_error e = {0};
    size_t n = 0, right = 0;
    for (size_t i = 0; i < count; i++) {
        if (!(truth[i] > 0) || surfaces[i] == GLINT_SURFACE_NONE || (surface && surfaces[i] != surface)) continue;
        values[n] = distance_relative_error((double)found[i], (double)truth[i]);
        right += values[n++] <= 0.05;
        e.invalid += !(found[i] >= 0);
    }
    e.rays = n;
    if (n == 0) return e;
    qsort(values, n, sizeof *values, by_value);
    e.right = (double)right / (double)n;
    e.median = values[n / 2];
    e.p95 = values[n * 95 / 100];
    return e;
}

bool glint_study_distances(const float *found, const float *truth, const uint8_t *surfaces, size_t count,
                           struct glint_distance_errors *errors, struct glint_error *err) {
    double *values = malloc((count + 1) * sizeof *values);
    *errors = (struct glint_distance_errors){0};
    if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "distances to compare: out of memory");
    for (uint8_t k = 0; k < GLINT_SURFACE_COUNT; k++)
        errors->of[k] = distance_error(found, truth, surfaces, count, k, values);
    free(values);
    return true;
}
