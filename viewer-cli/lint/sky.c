/* Compares sky pixels of lit with the sky cube map in their directions. This needs no depth and no second frame, and shows how colours
   are encoded and how the faces are stored. */
#include <math.h>
#include <stdlib.h>

#include "capture/cube_face.h"
#include "glint/sort.h"
#include "lint.h"

/* Edges of surfaces may be blended with the sky: all neighbours must be sky, too. */
static bool is_open_sky(const struct lint_data *data, const struct lint_reading *reading, uint32_t pixel) {
    const uint32_t x = pixel % data->width, y = pixel / data->width;
    if (!lint_is_sky(data, reading, x, y)) return false;
    for (int k = 0; k < 9; k++)
        if (!lint_is_sky(data, reading, x + (uint32_t)(k % 3) - 1, y + (uint32_t)(k / 3) - 1)) return false;
    return true;
}

/* A sky pixel: its colour in lit, linear, and where the sky cube map has this direction. */
struct sample {
    double color[3], u, v;
    int face;
};

static bool sample_of(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                      uint32_t pixel, struct sample *s) {
    double at[3], to[3];
    if (!is_open_sky(data, reading, pixel)) return false;
    lint_view_position(data, reading, view, pixel % data->width + 0.5, pixel / data->width + 0.5, 1, at);
    lint_to_world(view, at, to);
    for (int k = 0; k < 3; k++) to[k] -= view->position[k];
    s->face = cube_face_of(to, &s->u, &s->v);
    const float *lit = lint_lit(data, reading, pixel);
    for (int k = 0; k < 3; k++) s->color[k] = lint_linear(data, reading->lit, lit[reading->lit_bgr ? 2 - k : k]);
    return true;
}

/* Calls f for up to LINT_SAMPLES sky pixels. Sky may be a small part of the picture, so more pixels are tried. */
static void each_sample(const struct lint_data *data, const struct lint_reading *reading,
                        void (*f)(void *user, const struct lint_data *data, const struct lint_reading *reading,
                                  const struct sample *s),
                        void *user) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    const size_t pixels = (size_t)data->width * data->height;
    const uint32_t tries = (uint32_t)(pixels < 16 * LINT_SAMPLES ? pixels : 16 * LINT_SAMPLES);
    size_t found = 0;
    if (!data->sky.texels || !data->sample_count) return;
    for (uint32_t i = 0; i < tries && found < LINT_SAMPLES; i++) {
        struct sample s;
        if (!sample_of(data, reading, &eyes.now, lint_lattice(data, i), &s)) continue;
        f(user, data, reading, &s);
        found++;
    }
}

/* Whether the colour is between those of the texel and its eight neighbours, which filtering may have mixed, give or take 10 %. */
static bool shows(const struct lint_data *data, const struct lint_reading *reading, const struct sample *s, int face,
                  int turn) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {0, 0, 0}, u = s->u, v = s->v;
    lint_turn(turn, &u, &v);
    for (int i = 0; i < 9; i++) {
        const float *texel = lint_texel(&data->sky, face, u + (i % 3 - 1) / (double)data->sky.size,
                                        v + (i / 3 - 1) / (double)data->sky.size);
        for (int k = 0; k < 3; k++) {
            const double c = lint_linear(data, reading->sky, texel[k]) * reading->sky_scale;
            low[k] = fmin(low[k], c);
            high[k] = fmax(high[k], c);
        }
    }
    for (int k = 0; k < 3; k++) {
        const double c = s->color[k];
        if (c < low[k] - 0.05 * (c + low[k]) - 2e-3 || c > high[k] + 0.05 * (c + high[k]) + 2e-3) return false;
    }
    return true;
}

static void count_sample(void *user, const struct lint_data *data, const struct lint_reading *reading,
                         const struct sample *s) {
    lint_count(user, shows(data, reading, s, reading->sky_face[s->face], reading->sky_turn[s->face]));
}

struct lint_tally lint_sky(const struct lint_data *data, const struct lint_reading *reading) {
    struct lint_tally tally = {0, 0};
    each_sample(data, reading, count_sample, &tally);
    return tally;
}

static void count_black(void *user, const struct lint_data *data, const struct lint_reading *reading,
                        const struct sample *s) {
    double u = s->u, v = s->v;
    lint_turn(reading->sky_turn[s->face], &u, &v);
    const float *texel = lint_texel(&data->sky, reading->sky_face[s->face], u, v);
    if (lint_luminance(texel) > 0) lint_count(user, s->color[0] == 0 && s->color[1] == 0 && s->color[2] == 0);
}

struct lint_tally lint_black_sky(const struct lint_data *data, const struct lint_reading *reading) {
    struct lint_tally tally = {0, 0};
    each_sample(data, reading, count_black, &tally);
    return tally;
}

struct ratios {
    double values[LINT_SAMPLES];
    size_t count;
};

static void add_ratio(void *user, const struct lint_data *data, const struct lint_reading *reading,
                      const struct sample *s) {
    struct ratios *ratios = user;
    double u = s->u, v = s->v, sums[2] = {0, 0};
    lint_turn(reading->sky_turn[s->face], &u, &v);
    const float *texel = lint_texel(&data->sky, reading->sky_face[s->face], u, v);
    for (int k = 0; k < 3; k++) {
        sums[0] += s->color[k];
        sums[1] += lint_linear(data, reading->sky, texel[k]) * reading->sky_scale;
    }
    if (sums[0] > 0 && sums[1] > 0) ratios->values[ratios->count++] = sums[0] / sums[1];
}

double lint_sky_scale(const struct lint_data *data, const struct lint_reading *reading) {
    struct ratios *ratios = calloc(1, sizeof *ratios);
    if (!ratios) return 1;
    each_sample(data, reading, add_ratio, ratios);
    glint_sort_doubles(ratios->values, ratios->count);
    const double middle = ratios->count ? ratios->values[ratios->count / 2] : 1;
    free(ratios);
    return middle;
}

static void vote(void *user, const struct lint_data *data, const struct lint_reading *reading, const struct sample *s) {
    struct lint_votes *votes = user;
    for (int stored = 0; stored < 6; stored++)
        for (int turn = 0; turn < LINT_TURNS; turn++)
            if (shows(data, reading, s, stored, turn)) votes->agree[s->face][stored][turn]++;
            else votes->beyond[s->face][stored][turn]++;
}

void lint_sky_votes(const struct lint_data *data, const struct lint_reading *reading, struct lint_votes *votes) {
    each_sample(data, reading, vote, votes);
}
