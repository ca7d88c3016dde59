/* Compares the texels of a perturbed run with those of the unperturbed one. */
#include "measuring.h"

#include <math.h>
#include <string.h>

#include "parallel.h"

static const double HALF_LARGEST = 65504;

static bool is_relative(const char *unit) {
    return !strcmp(unit, "m") || !strcmp(unit, "1/m") || !strcmp(unit, "radiance");
}

/* The number of components whose change is relative to their magnitude; alpha is a fraction, so that its change is absolute. */
static uint32_t relative_components(const struct tracked *t) {
    const bool alpha = t->out->components == 4 && !strcmp(t->out->row->unit, "radiance");
    return !is_relative(t->out->row->unit) ? 0 : alpha ? 3 : t->out->components;
}

static double magnitude(const float *v, uint32_t components) {
    double square = 0;
    for (uint32_t k = 0; k < components; k++) square += (double)v[k] * (double)v[k];
    return sqrt(square);
}

void texels_begin(struct tracked *t) {
    struct glint_stability_image *image = t->out;
    const size_t texels = (size_t)image->width * image->height;
    const uint32_t components = image->components, of_scale = relative_components(t);
    const bool lengths = image->row->unit[strlen(image->row->unit) - 1] == 'm';
    const float *base = (const float *)t->base;
    double sum = 0, count = 0;
    for (size_t i = 0; i < texels; i++) {
        const double size = magnitude(base + i * components, of_scale);
        if (isfinite(size) && size > 0) sum += size, count++;
        for (uint32_t k = 0; k < components; k++) {
            const double v = fabs((double)base[i * components + k]);
            image->invalid += isnan(v) || (isinf(v) && !lengths);
            image->overflowing += v > HALF_LARGEST && isfinite(v);
            if (!isfinite(v) || v <= image->peak) continue;
            image->peak = v;
            image->peak_x = (uint32_t)(i % image->width);
            image->peak_y = (uint32_t)(i / image->width);
            image->peak_component = k;
        }
    }
    t->least_scale = of_scale && count > 0 ? 0.01 * sum / count : 1;
}

/* Square of the relative change; -1 if a value becomes infinite or NaN, or was so before. */
static double change_of(const struct tracked *t, const float *before, const float *after) {
    const uint32_t of_scale = relative_components(t);
    const double scale = fmax(magnitude(before, of_scale), t->least_scale);
    double square = 0;
    for (uint32_t k = 0; k < t->out->components; k++) {
        if (before[k] == after[k] || (isnan(before[k]) && isnan(after[k]))) continue;
        const double by = (double)after[k] - (double)before[k];
        if (!isfinite(by)) return -1;
        square += by * by / (k < of_scale ? scale * scale : 1);
    }
    return square;
}

/* ---- Decisions ---- */

void texels_decided(const struct measuring *m, struct tracked *t, const uint32_t *values) {
    const struct glint_stability *s = m->out;
    for (uint32_t y = 0; y < t->out->height; y++)
        for (uint32_t x = 0; x < t->out->width; x++) {
            const size_t i = (size_t)y * t->out->width + x;
            if (values[i] == t->base[i]) continue;
            t->out->flips[i]++;
            const struct footprint f = footprint_of(s, t->out, x, y);
            for (uint32_t v = f.y0; v < f.y1; v++)
                for (uint32_t u = f.x0; u < f.x1; u++) m->decided[0][(size_t)v * s->width + u] |= 1u << t->decision;
        }
}

/* Spreads masks along a line of `count` pixels that are `step` apart. */
static void spread_line(uint32_t *to, const uint32_t *from, uint32_t count, size_t step) {
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t first = i < REACH_PX ? 0 : i - REACH_PX, last = i + REACH_PX < count ? i + REACH_PX : count - 1;
        uint32_t bits = 0;
        for (uint32_t j = first; j <= last; j++) bits |= from[j * step];
        to[i * step] = bits;
    }
}

struct spreading {
    const struct measuring *m;
    bool down;
};
static void spread_lines(void *user, size_t first, size_t last) {
    const struct spreading *spreading = user;
    const struct glint_stability *s = spreading->m->out;
    uint32_t *const *decided = spreading->m->decided;
    for (size_t i = first; i < last; i++)
        if (spreading->down) spread_line(decided[1] + i, decided[2] + i, s->height, s->width);
        else spread_line(decided[2] + i * s->width, decided[0] + i * s->width, s->width, 1);
}

void texels_spread(const struct measuring *m) {
    parallel_rows(m->out->height, spread_lines, &(struct spreading){m, false});
    parallel_rows(m->out->width, spread_lines, &(struct spreading){m, true});
}

static bool has_flipped(const struct measuring *m, const struct tracked *t, uint32_t x, uint32_t y) {
    const struct footprint f = footprint_of(m->out, t->out, x, y);
    const uint32_t *decided = m->decided[t->reaches];
    for (uint32_t v = f.y0; v < f.y1; v++)
        for (uint32_t u = f.x0; u < f.x1; u++)
            if (decided[(size_t)v * m->out->width + u] & t->decisions) return true;
    return false;
}

/* ---- Changes ---- */

struct changing {
    const struct measuring *m;
    const struct tracked *t;
    const float *values;
};

/* `change` is a sum of squares until stability_sum_up. */
static void change_rows(void *user, size_t first, size_t last) {
    const struct changing *c = user;
    const struct tracked *t = c->t;
    const struct glint_stability_image *image = t->out;
    const float *base = (const float *)t->base;
    for (size_t y = first; y < last; y++)
        for (size_t x = 0; x < image->width; x++) {
            const size_t i = y * image->width + x;
            const double square = change_of(t, base + i * image->components, c->values + i * image->components);
            if (square < 0 || (t->decisions && image->per_pixel && has_flipped(c->m, t, (uint32_t)x, (uint32_t)y)))
                image->flips[i]++;
            else image->change[i] += (float)square;
        }
}

void texels_changed(const struct measuring *m, struct tracked *t, const uint32_t *values) {
    struct changing changing = {m, t, (const float *)values};
    parallel_rows(t->out->height, change_rows, &changing);
}
