/* SSIM: Wang, Bovik, Sheikh, Simoncelli, Image quality assessment: from error visibility to structural ssim_at, 2004. */
#include "comparison.h"

#include <math.h>
#include <stdlib.h>

#include "filter.h"
#include "parallel.h"
#include "tone.h"

/* Section III.C: an 11 × 11 Gaussian gaussian_window of 1.5 pixels, K1 and K2, of images whose values reach from 0 to L. */
static const double SIGMA = 1.5, K1 = 0.01, K2 = 0.03, L = 1;
enum { RADIUS = 5, MEAN_X = 0, MEAN_Y, MEAN_XX, MEAN_YY, MEAN_XY, MEANS };

struct ssim {
    const struct comparison *c;
    float *displayed[MEANS], *means[MEANS], *map;
};

static float srgb_encoded(float x) {
    return x <= 0.0031308F ? 12.92F * x : 1.055F * powf(x, 1 / 2.4F) - 0.055F;
}

/* The value of a pixel on a display: exposed, tone mapped, sRGB-encoded. */
static float displayed(const struct comparison *c, bool truth, size_t pixel) {
    const float exposed = exp2f((float)c->options->exposure);
    float rgb[3];
    if (!c->has_rgb) {
        const struct glint_pixels *image = truth ? c->truth : c->found;
        const uint32_t at = truth ? c->truth_at[0] : c->found_at[0];
        return c->use[pixel] == COMPARED
                   ? srgb_encoded(tone_map(exposed * image->values[pixel * image->components + at]))
                   : 0;
    }
    read_rgb(c, truth, pixel, rgb);
    for (int k = 0; k < 3; k++) rgb[k] = tone_map(exposed * rgb[k]);
    return srgb_encoded(luminance(rgb));
}

static void show_rows(void *user, size_t first, size_t last) {
    const struct ssim *s = user;
    const uint32_t width = s->c->found->width;
    for (size_t i = first * width; i < last * width; i++) {
        const float x = displayed(s->c, false, i), y = displayed(s->c, true, i);
        const float values[MEANS] = {x, y, x * x, y * y, x * y};
        for (int k = 0; k < MEANS; k++) s->displayed[k][i] = values[k];
    }
}

/* Equation 13, from means, variances and covariance. */
static float ssim_at(const struct ssim *s, size_t i) {
    const double c1 = (K1 * L) * (K1 * L), c2 = (K2 * L) * (K2 * L);
    const double x = (double)s->means[MEAN_X][i], y = (double)s->means[MEAN_Y][i];
    const double xx = (double)s->means[MEAN_XX][i] - x * x, yy = (double)s->means[MEAN_YY][i] - y * y,
                 xy = (double)s->means[MEAN_XY][i] - x * y;
    return (float)((2 * x * y + c1) * (2 * xy + c2) / ((x * x + y * y + c1) * (xx + yy + c2)));
}

static void compare_rows(void *user, size_t first, size_t last) {
    const struct ssim *s = user;
    const uint32_t width = s->c->found->width, height = s->c->found->height;
    for (size_t y = first; y < last; y++)
        for (size_t x = 0; x < width; x++) {
            bool whole = x >= RADIUS && y >= RADIUS && x + RADIUS < width && y + RADIUS < height;
            s->map[y * width + x] = whole ? ssim_at(s, y * width + x) : NAN;
        }
}

static struct kernel gaussian_window(void) {
    struct kernel kernel = {.radius = RADIUS};
    double sum = 0, taps[2 * RADIUS + 1];
    for (int k = -RADIUS; k <= RADIUS; k++) sum += taps[k + RADIUS] = exp(-k * k / (2 * SIGMA * SIGMA));
    for (int k = 0; k <= 2 * RADIUS; k++) kernel.taps[k] = (float)(taps[k] / sum);
    return kernel;
}

bool map_ssim(struct comparison *c, struct glint_error *err) {
    if (!has_metric(c, GLINT_METRIC_SSIM) || (!c->has_rgb && c->channels != 1)) return true;
    const uint32_t width = c->found->width, height = c->found->height;
    const size_t pixels = (size_t)width * height;
    struct ssim s = {.c = c};
    float *planes = malloc((MEANS * 2 + 2) * pixels * sizeof *planes), *scratch = planes;
    if (!planes) return glint_fail(err, GLINT_ERROR_MEMORY, "SSIM: out of memory");
    for (size_t k = 0; k < MEANS; k++) {
        s.displayed[k] = planes + (1 + k) * pixels;
        s.means[k] = planes + (1 + MEANS + k) * pixels;
    }
    s.map = malloc(pixels * sizeof *s.map);
    parallel_rows(height, show_rows, &s);
    const struct kernel kernel = gaussian_window();
    for (int k = 0; k < MEANS; k++) filter_plane(s.displayed[k], scratch, s.means[k], width, height, &kernel, &kernel);
    if (s.map) parallel_rows(height, compare_rows, &s);
    free(planes);
    c->ssim = s.map;
    return s.map || glint_fail(err, GLINT_ERROR_MEMORY, "SSIM: out of memory");
}
