/* How far independent images agree on the same surfaces. */
#include <math.h>
#include <string.h>

#include "cube_face.h"
#include "lint.h"

const char *const lint_measure_names[] = {"normals with the depths around them", "depth with the cube maps' distances",
                                          "motion with depth and both cameras", "lit with the cube maps' colours"};

static const double SAME_DIRECTION = 0.9986; /* cosine of 3 degrees: cameras are often turned by little more */

struct tally {
    size_t agree, count;
};

static void add(struct tally *tally, bool agrees) {
    tally->count++;
    tally->agree += agrees;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The normal of the surface through a pixel and its four neighbours, towards the eye, in world axes; false where they do not lie
   on one. */
static bool facet(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                  uint32_t x, uint32_t y, double out[3]) {
    static const int steps[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    double depth[5], p[5][3], e[2][3];
    for (int i = 0; i < 5; i++) {
        const uint32_t px = x + (uint32_t)steps[i][0], py = y + (uint32_t)steps[i][1];
        if (!lint_depth(data, reading, view, px, py, &depth[i])) return false;
        double in[3];
        lint_view_position(data, reading, view, px + 0.5, py + 0.5, depth[i], in);
        lint_to_world(view, in, p[i]);
    }
    /* 1/depth is linear over a plane */
    for (int i = 1; i < 5; i += 2)
        if (fabs(depth[0] / depth[i] + depth[0] / depth[i + 1] - 2) > 2e-3) return false;
    for (int k = 0; k < 3; k++) {
        e[0][k] = p[2][k] - p[1][k];
        e[1][k] = p[4][k] - p[3][k];
    }
    out[0] = e[0][1] * e[1][2] - e[0][2] * e[1][1];
    out[1] = e[0][2] * e[1][0] - e[0][0] * e[1][2];
    out[2] = e[0][0] * e[1][1] - e[0][1] * e[1][0];
    const double length = sqrt(dot(out, out)),
                 to_eye[3] = {view->position[0] - p[0][0], view->position[1] - p[0][1], view->position[2] - p[0][2]};
    if (!(length > 0) || !isfinite(length)) return false;
    const double facing = dot(out, to_eye) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) out[k] *= facing / length;
    /* nearly edge-on, depths are too coarse to tell */
    return dot(out, to_eye) > 0.05 * sqrt(dot(to_eye, to_eye));
}

static struct tally facets(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        const uint32_t pixel = data->samples[i];
        double f[3], n[3];
        if (!facet(data, reading, &eyes.now, pixel % data->width, pixel / data->width, f)) continue;
        if (!lint_normal(data, reading, &eyes.now, pixel, n)) continue;
        add(&tally, dot(f, n) > SAME_DIRECTION);
    }
    return tally;
}

double lint_luminance(const float *c) {
    return 0.2126 * (double)c[0] + 0.7152 * (double)c[1] + 0.0722 * (double)c[2];
}

bool lint_place(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                uint32_t pixel, double world[3]) {
    const uint32_t x = pixel % data->width, y = pixel / data->width;
    double depth, in[3];
    if (!lint_depth(data, reading, view, x, y, &depth)) return false;
    lint_view_position(data, reading, view, x + 0.5, y + 0.5, depth, in);
    lint_to_world(view, in, world);
    return true;
}

bool lint_moved(const struct lint_data *data, const struct lint_reading *reading, const struct lint_eyes *eyes,
                uint32_t pixel, double out[2]) {
    double world[3], now[2], before[2];
    if (!lint_place(data, reading, &eyes->now, pixel, world) || !lint_project(data, reading, &eyes->now, world, now) ||
        !lint_project(data, reading, &eyes->before, world, before))
        return false;
    for (int k = 0; k < 2; k++) out[k] = before[k] - now[k];
    return true;
}

int lint_shows(const struct lint_reading *reading, const struct lint_cube *cube, const float *texel,
               const double direction[3]) {
    const double away = sqrt(dot(direction, direction)), slack = away * (0.02 + 3.0 / cube->size);
    if (slack >= away) return 0; /* texels so wide that whatever is nearer agrees: nothing is told by them */
    const double distance = lint_cube_distance(reading, texel, direction);
    if (fabs(distance - away) <= slack) return 1;
    return distance > away + 3 * slack ? -1 : 0;
}

int lint_sees(const struct lint_reading *reading, const struct lint_cube *cube, const double world[3],
              const float **texel) {
    double d[3], u, v;
    for (int k = 0; k < 3; k++) d[k] = world[k] - reading->center_scale * cube->center[k];
    const double away = sqrt(dot(d, d));
    if (!cube->has_distance || !(away > 0) || !isfinite(away)) return 0;
    const int face = cube_face_of(d, &u, &v);
    lint_turn(reading->turn[face], &u, &v);
    *texel = lint_texel(cube, reading->face[face], u, v);
    return lint_shows(reading, cube, *texel, d);
}

static struct tally cubemaps(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        double world[3];
        if (!lint_place(data, reading, &eyes.now, data->samples[i], world)) continue;
        for (size_t c = 0; c < data->cube_count; c++) {
            const float *texel;
            const int s = lint_sees(reading, &data->cubes[c], world, &texel);
            if (s) add(&tally, s > 0);
        }
    }
    return tally;
}

static struct tally motion(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct tally tally = {0, 0};
    if (!data->has_motion || !data->frame.has_previous) return tally;
    for (size_t i = 0; i < data->sample_count; i++) {
        double moved[2], found[2];
        if (!lint_moved(data, reading, &eyes, data->samples[i], moved)) continue;
        lint_motion(data, reading, data->samples[i], found);
        const double expected = hypot(moved[0], moved[1]);
        if (!(expected > LINT_MOVES_PX)) continue;
        const double off = hypot(found[0] - moved[0], found[1] - moved[1]);
        add(&tally, off < 0.05 + 0.1 * expected);
    }
    return tally;
}

static double linear(enum glint_color_encoding encoding, double pre_exposure, double v) {
    if (encoding == GLINT_COLOR_PRE_EXPOSED) return v / pre_exposure;
    if (encoding == GLINT_COLOR_SRGB) return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    return v;
}

static struct tally colors(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    const double exposure = data->frame.pre_exposure > 0 ? data->frame.pre_exposure : 1;
    struct tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        const uint32_t pixel = data->samples[i], x = pixel % data->width, y = pixel / data->width;
        double world[3];
        if (!lint_place(data, reading, &eyes.now, pixel, world)) continue;
        const uint32_t row = reading->lit_upside_down ? data->height - 1 - y : y;
        const float *lit = data->lit + 3 * ((size_t)row * data->width + x);
        if (!(lint_luminance(lit) > 1e-3)) continue;
        bool compared = false, agrees = false;
        for (size_t c = 0; c < data->cube_count && !agrees; c++) {
            const float *texel;
            if (lint_sees(reading, &data->cubes[c], world, &texel) != 1) continue;
            bool alike = true;
            for (int k = 0; k < 3 && alike; k++) {
                const double a = linear(reading->lit, exposure, (double)lit[reading->lit_bgr ? 2 - k : k]),
                             b = linear(reading->cube, exposure, (double)texel[k]);
                alike = fabs(a - b) <= 0.1 * (a + b) + 2e-3;
            }
            compared = true;
            agrees = alike;
        }
        if (compared) add(&tally, agrees);
    }
    return tally;
}

struct lint_agreement lint_agree(const struct lint_data *data, const struct lint_reading *reading,
                                 const struct lint_agreement *known, unsigned which) {
    static struct tally (*const take[])(const struct lint_data *, const struct lint_reading *) = {facets, cubemaps,
                                                                                                  motion, colors};
    struct lint_agreement a = known ? *known : (struct lint_agreement){{0}, {0}};
    for (int m = 0; m < LINT_MEASURES; m++) {
        if (known && !(which & (1u << m))) continue;
        const struct tally tally = take[m](data, reading);
        a.count[m] = tally.count;
        a.share[m] = tally.count ? (double)tally.agree / (double)tally.count : 0;
    }
    return a;
}
