/* Computes amplification, and in which pass it starts, from the changes of all seeds. */
#include "measuring.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/sort.h"
#include "no_memory.h"

/* Whether a texel is compared: it must cover a judged pixel, unless the image is not per_pixel. */
static bool is_compared(const struct measuring *m, const struct glint_stability_image *image, uint32_t x, uint32_t y) {
    if (!image->per_pixel) return true;
    const struct footprint f = footprint_of(m->out, image, x, y);
    for (uint32_t v = f.y0; v < f.y1; v++)
        for (uint32_t u = f.x0; u < f.x1; u++)
            if (m->labels[(size_t)v * m->out->width + u]) return true;
    return false;
}

/* ---- Changes of the inputs ---- */

static void normalise_changes(const struct measuring *m) {
    for (size_t i = 0; i < m->out->image_count; i++) {
        const struct glint_stability_image *image = &m->out->images[i];
        for (size_t k = 0; image->change && k < (size_t)image->width * image->height; k++) {
            const uint32_t alike = m->out->seeds - image->flips[k];
            image->change[k] = alike ? sqrtf(image->change[k] / (float)alike) : 0;
        }
    }
}

/* Root mean square change of each input over the frame. */
static void find_means(struct measuring *m) {
    for (size_t i = 0; i < m->out->image_count; i++) {
        const struct glint_stability_image *image = &m->out->images[i];
        double sum = 0, count = 0;
        for (uint32_t y = 0; !image->pass && y < image->height; y++)
            for (uint32_t x = 0; x < image->width; x++) {
                const double change = (double)image->change[(size_t)y * image->width + x];
                if (!is_compared(m, image, x, y)) continue;
                sum += change * change;
                count++;
            }
        if (!image->pass) m->input_mean[m->tracked[i].input] = count > 0 ? sqrt(sum / count) : 0;
    }
}

/* Mean square change of an input over the pixels of a texel. */
static double input_change(const struct measuring *m, const struct tracked *input,
                           const struct glint_stability_image *image, uint32_t x, uint32_t y) {
    const double mean = m->input_mean[input->input],
                 least = GLINT_STABILITY_LEAST * GLINT_STABILITY_LEAST * mean * mean;
    if (!input->out->per_pixel || !image->per_pixel) return mean * mean;
    const struct footprint f = footprint_of(m->out, image, x, y);
    double sum = 0, count = 0;
    for (uint32_t v = f.y0; v < f.y1; v++)
        for (uint32_t u = f.x0; u < f.x1; u++, count++) {
            const double change = (double)input->out->change[(size_t)v * m->out->width + u];
            sum += change * change;
        }
    return fmax(count > 0 ? sum / count : 0, least);
}

static bool find_amplification(const struct measuring *m, const struct tracked *t, struct glint_error *err) {
    struct glint_stability_image *image = t->out;
    if (!image->pass || !image->change) return true;
    image->amplification = calloc((size_t)image->width * image->height, sizeof *image->amplification);
    if (!image->amplification) return no_memory(err, "stability");
    for (uint32_t y = 0; y < image->height; y++)
        for (uint32_t x = 0; x < image->width; x++) {
            const size_t at = (size_t)y * image->width + x;
            double square = 0;
            if (image->change[at] == 0) continue;
            for (size_t i = 0; i < m->out->image_count && !m->out->images[i].pass; i++)
                if (t->inputs >> m->tracked[i].input & 1) square += input_change(m, &m->tracked[i], image, x, y);
            image->amplification[at] = square > 0 ? image->change[at] / (float)sqrt(square) : INFINITY;
        }
    return true;
}

/* ---- Figures ---- */

/* Sorts the values. */
static struct glint_stability_summary summary_of(float *values, size_t count, double bound) {
    struct glint_stability_summary s = {.compared = count};
    glint_sort_floats(values, count);
    for (size_t i = 0; i < count; i++) s.above += (double)values[i] > bound;
    if (!count) return s;
    s.median = (double)values[(count - 1) / 2];
    s.p99 = (double)values[(size_t)((double)(count - 1) * 0.99 + 0.5)];
    s.largest = (double)values[count - 1];
    return s;
}

static void note_worst(struct glint_stability_image *image, const float *base, uint32_t x, uint32_t y) {
    const size_t at = (size_t)y * image->width + x;
    struct glint_stability_pixel pixel = {x, y, (double)image->amplification[at], (double)image->change[at], {0}};
    size_t place = image->worst_count;
    while (place > 0 && image->worst[place - 1].amplification < pixel.amplification) place--;
    if (place == GLINT_STABILITY_WORST || pixel.amplification == 0) return;
    memcpy(pixel.before, base + at * image->components, image->components * sizeof *base);
    if (image->worst_count < GLINT_STABILITY_WORST) image->worst_count++;
    memmove(&image->worst[place + 1], &image->worst[place], (image->worst_count - 1 - place) * sizeof *image->worst);
    image->worst[place] = pixel;
}

static bool sum_image(const struct measuring *m, const struct tracked *t, struct glint_error *err) {
    struct glint_stability_image *image = t->out;
    const float *shown = image->pass ? image->amplification : image->change;
    float *values = malloc((size_t)image->width * image->height * sizeof *values);
    size_t count = 0;
    double flips = 0;
    if (!values) return no_memory(err, "stability");
    for (uint32_t y = 0; y < image->height; y++)
        for (uint32_t x = 0; x < image->width; x++) {
            const size_t at = (size_t)y * image->width + x;
            if (!is_compared(m, image, x, y)) continue;
            values[count++] = shown ? shown[at] : 0;
            image->flipped += image->flips[at] > 0;
            flips += image->flips[at];
            if (image->amplification) note_worst(image, (const float *)t->base, x, y);
        }
    image->summary = summary_of(values, count, m->out->bound);
    image->flip_share = count ? flips / m->out->seeds / (double)count : 0;
    free(values);
    return true;
}

/* ---- Passes ---- */

struct pass_sums {
    float *amplification; /* for each pixel the largest of the pass's images */
    uint8_t *flips;       /* for each pixel: bit 0: a decision flips; bit 1: an end reason flips */
};

static void add_image(const struct measuring *m, const struct glint_stability_image *image, struct pass_sums *sums) {
    const uint8_t flip = is_end_reason(image->row) ? 3 : 1;
    for (uint32_t y = 0; y < image->height; y++)
        for (uint32_t x = 0; x < image->width; x++) {
            const size_t at = (size_t)y * image->width + x;
            const struct footprint f = footprint_of(m->out, image, x, y);
            for (uint32_t v = f.y0; v < f.y1; v++)
                for (uint32_t u = f.x0; u < f.x1; u++) {
                    const size_t pixel = (size_t)v * m->out->width + u;
                    if (image->discrete) sums->flips[pixel] |= image->flips[at] ? flip : 0;
                    else if (image->amplification[at] > sums->amplification[pixel])
                        sums->amplification[pixel] = image->amplification[at];
                }
        }
}

static void count_pass(const struct measuring *m, struct glint_stability_pass *pass, struct pass_sums *sums) {
    struct glint_stability *s = m->out;
    const size_t pixels = (size_t)s->width * s->height;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!m->labels[i]) continue;
        pass->flipped += sums->flips[i] & 1;
        pass->ends += sums->flips[i] >> 1;
        if (sums->flips[i] && !s->flip_start[i]) s->flip_start[i] = (uint32_t)pass->place, pass->flip_starts++;
        if ((double)sums->amplification[i] > s->bound && !s->start[i])
            s->start[i] = (uint32_t)pass->place, pass->starts++;
        sums->amplification[count++] = sums->amplification[i];
    }
    pass->summary = summary_of(sums->amplification, count, s->bound);
}

static bool sum_pass(const struct measuring *m, const struct glint_pass *of, size_t place, struct glint_error *err) {
    struct glint_stability *s = m->out;
    const size_t pixels = (size_t)s->width * s->height;
    bool any = false;
    for (size_t i = 0; i < s->image_count; i++) any |= s->images[i].pass == of && s->images[i].per_pixel;
    if (!any) return true;
    struct pass_sums sums = {calloc(pixels, sizeof *sums.amplification), calloc(pixels, 1)};
    const bool ok = (sums.amplification && sums.flips) || no_memory(err, "stability");
    for (size_t i = 0; ok && i < s->image_count; i++)
        if (s->images[i].pass == of && s->images[i].per_pixel) add_image(m, &s->images[i], &sums);
    struct glint_stability_pass *pass = &s->passes[s->pass_count++];
    *pass = (struct glint_stability_pass){.pass = of, .place = place};
    if (ok) memcpy(s->amplification, sums.amplification, pixels * sizeof *s->amplification);
    if (ok) count_pass(m, pass, &sums);
    free(sums.amplification);
    free(sums.flips);
    return ok;
}

bool stability_sum_up(struct measuring *m, struct glint_error *err) {
    struct glint_stability *s = m->out;
    const size_t pixels = (size_t)s->width * s->height;
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(m->replay, &count);
    s->passes = calloc(count + 1, sizeof *s->passes);
    s->start = calloc(pixels, sizeof *s->start);
    s->flip_start = calloc(pixels, sizeof *s->flip_start);
    s->amplification = calloc(pixels, sizeof *s->amplification);
    bool ok = (s->passes && s->start && s->flip_start && s->amplification) || no_memory(err, "stability");
    if (ok) normalise_changes(m);
    if (ok) find_means(m);
    for (size_t i = 0; ok && i < s->image_count; i++)
        ok = find_amplification(m, &m->tracked[i], err) && sum_image(m, &m->tracked[i], err);
    for (size_t p = 0; ok && p < count; p++)
        if (results[p].ran && !results[p].pass->host) ok = sum_pass(m, results[p].pass, p + 1, err);
    return ok;
}
