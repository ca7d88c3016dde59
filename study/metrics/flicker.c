/* How much a picture changes from one frame to the next, beside what it must change. */
#include <math.h>

#include "glint/metrics.h"

/* The channels that are compared: those of colour, or the only one. */
static uint32_t channels_of(const struct glint_pixels *pixels) {
    return pixels->components < 3 ? 1 : 3;
}

static bool is_finite(const struct glint_pixels *pixels, size_t i) {
    bool finite = true;
    for (uint32_t k = 0; k < channels_of(pixels); k++)
        finite &= isfinite(pixels->values[i * pixels->components + k]) != 0;
    return finite;
}

/* Sums of squares over pixels and channels. */
struct sums {
    double picture, truth, difference, noise;
};

static void add_pixel(struct sums *sums, const struct glint_pixels found[2], const struct glint_pixels *truth,
                      const float *const *error, size_t i) {
    for (uint32_t k = 0; k < channels_of(&found[0]); k++) {
        double change[2] = {0, 0};
        for (int frame = 0; frame < 2; frame++) {
            const double sign = frame ? 1 : -1;
            change[0] += sign * (double)found[frame].values[i * found[frame].components + k];
            if (!truth) continue;
            const double value = (double)truth[frame].values[i * truth[frame].components + k];
            const double noise = error && error[frame] ? value * (double)error[frame][i] : 0;
            change[1] += sign * value;
            sums->noise += noise * noise;
        }
        sums->picture += change[0] * change[0];
        sums->truth += change[1] * change[1];
        sums->difference += (change[0] - change[1]) * (change[0] - change[1]);
    }
}

static bool is_compared(const struct glint_pixels found[2], const struct glint_pixels *truth, const float *const *error,
                        const uint8_t *const *mask, size_t i) {
    bool compared = true;
    for (int frame = 0; frame < 2; frame++) {
        compared &= !mask || !mask[frame] || mask[frame][i];
        compared &= !error || !error[frame] || isfinite(error[frame][i]);
        compared &= is_finite(&found[frame], i) && (!truth || is_finite(&truth[frame], i));
    }
    return compared;
}

bool glint_study_flicker(const struct glint_pixels found[2], const struct glint_pixels *truth,
                         const float *const *truth_error, const uint8_t *const *mask, struct glint_flicker *flicker,
                         struct glint_error *err) {
    const struct glint_pixels *first = &found[0];
    struct sums sums = {0};
    *flicker = (struct glint_flicker){0};
    for (int frame = 0; frame < 2; frame++) {
        const struct glint_pixels *of[2] = {&found[frame], truth ? &truth[frame] : first};
        for (int k = 0; k < 2; k++)
            if (of[k]->width != first->width || of[k]->height != first->height ||
                channels_of(of[k]) != channels_of(first))
                return glint_fail(err, GLINT_ERROR_USAGE,
                                  "expected images of %u x %u with %u channels, found %u x %u with %u", first->width,
                                  first->height, channels_of(first), of[k]->width, of[k]->height, of[k]->components);
    }
    for (size_t i = 0; i < (size_t)first->width * first->height; i++) {
        if (!is_compared(found, truth, truth_error, mask, i)) continue;
        add_pixel(&sums, found, truth, truth_error, i);
        flicker->pixels++;
    }
    const double values = channels_of(first) * (double)flicker->pixels;
    flicker->picture = sqrt(sums.picture / values);
    flicker->truth = truth ? sqrt(sums.truth / values) : (double)NAN;
    flicker->beside = truth ? sqrt(sums.difference / values) : (double)NAN;
    flicker->clean = truth ? sqrt(fmax(0, sums.difference - sums.noise) / values) : (double)NAN;
    return true;
}
