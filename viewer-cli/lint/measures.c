/* How well independent images match on the same surfaces. */
#include <math.h>
#include <string.h>

#include "capture/cube_face.h"
#include "lint.h"

const char *const lint_measure_names[] = {"normals with the depth buffer",
                                          "depth with cube-map distances",
                                          "motion with the reprojection",
                                          "lit with cube-map colours",
                                          "the previous frame with the reprojection",
                                          "lit with the reprojected previous.lit",
                                          "sky pixels of lit with the sky cube map"};

static const double SAME_DIRECTION =
    0.9986; /* cosine of 3 degrees: many cameras are rotated by little more against the world */

void lint_count(struct lint_tally *tally, bool agrees) {
    tally->count++;
    tally->agree += agrees;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool lint_same_direction(const double a[3], const double b[3]) {
    return dot(a, b) > SAME_DIRECTION;
}

/* The normal of the two vectors between opposite neighbours, towards the eye. Returns the cosine to the eye, 0 when there is no normal. */
static double facet_normal(const double e[2][3], const double to_eye[3], double out[3]) {
    out[0] = e[0][1] * e[1][2] - e[0][2] * e[1][1];
    out[1] = e[0][2] * e[1][0] - e[0][0] * e[1][2];
    out[2] = e[0][0] * e[1][1] - e[0][1] * e[1][0];
    const double length = sqrt(dot(out, out));
    if (!(length > 0) || !isfinite(length)) return 0;
    const double facing = dot(out, to_eye) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) out[k] *= facing / length;
    return dot(out, to_eye) / sqrt(dot(to_eye, to_eye));
}

/* The cosine of the angle by which rounding may have rotated a facet: the neighbours are moved along their view rays by their
   rounding errors, opposite neighbours in opposite directions. */
static double facet_rounding(double p[5][3], const double error[5], const double to_eye[3], const double eye[3],
                             const double depth[5], const double normal[3]) {
    double least = 1;
    for (int corner = 0; corner < 4; corner++) {
        double e[2][3], n[3];
        for (int axis = 0; axis < 2; axis++)
            for (int k = 0; k < 3; k++) {
                const int i = 2 * axis + 1, way = corner & (1 << axis) ? 1 : -1;
                e[axis][k] = p[i + 1][k] - p[i][k] +
                             way * ((p[i][k] - eye[k]) * error[i] / depth[i] +
                                    (p[i + 1][k] - eye[k]) * error[i + 1] / depth[i + 1]);
            }
        if (!(facet_normal((const double(*)[3])e, to_eye, n) > 0)) return -1;
        least = lint_smaller(least, dot(n, normal));
    }
    return least;
}

enum lint_facet lint_facet_of(const struct lint_data *data, const struct lint_reading *reading,
                              const struct lint_view *view, uint32_t pixel, double out[3]) {
    static const int steps[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    double depth[5], error[5], p[5][3], e[2][3], to_eye[3];
    for (int i = 0; i < 5; i++) {
        const uint32_t px = pixel % data->width + (uint32_t)steps[i][0],
                       py = pixel / data->width + (uint32_t)steps[i][1];
        if (!lint_depth(data, reading, view, px, py, &depth[i])) return LINT_NO_FACET;
        error[i] = lint_depth_error(data, reading, view, px, py, depth[i]);
        double in[3];
        lint_view_position(data, reading, view, px + 0.5, py + 0.5, depth[i], in);
        lint_to_world(view, in, p[i]);
    }
    /* 1/depth is linear on a plane, apart from rounding */
    for (int i = 1; i < 5; i += 2) {
        const double rounding = 2 * error[0] / depth[0] + error[i] / depth[i] + error[i + 1] / depth[i + 1];
        if (fabs(depth[0] / depth[i] + depth[0] / depth[i + 1] - 2) > 2e-3 + rounding) return LINT_NO_FACET;
    }
    for (int k = 0; k < 3; k++) {
        e[0][k] = p[2][k] - p[1][k];
        e[1][k] = p[4][k] - p[3][k];
        to_eye[k] = view->position[k] - p[0][k];
    }
    /* at grazing angles, a pixel covers too much of the surface for a usable normal */
    if (!(facet_normal((const double(*)[3])e, to_eye, out) > 0.05)) return LINT_NO_FACET;
    return facet_rounding(p, error, to_eye, view->position, depth, out) > SAME_DIRECTION ? LINT_FACET
                                                                                         : LINT_UNSURE_FACET;
}

/* Each face of a cube has four by four. */
static unsigned char direction_of(const double normal[3]) {
    double u, v;
    const int face = cube_face_of(normal, &u, &v);
    return (unsigned char)(16 * face + 4 * (int)fmin(4 * v, 3) + (int)fmin(4 * u, 3));
}

/* Samples whose facet may be rotated beyond the tolerance by rounding of depth alone are not compared. The tolerance of a normal grows
   by the angle that its own rounding may cause, which is large for 8-bit X and Y at grazing angles (FORMAT.md, Precision); beyond 15
   degrees a match would prove nothing. */
static struct lint_tally compare_facets(const struct lint_data *data, const struct lint_reading *reading,
                                        struct lint_facing facing[LINT_SAMPLES]) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct lint_tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        const uint32_t pixel = data->samples[i];
        double f[3], n[3];
        facing[i] = (struct lint_facing){0, 0};
        if (lint_facet_of(data, reading, &eyes.now, pixel, f) != LINT_FACET) continue;
        if (!lint_normal(data, reading, &eyes.now, pixel, n)) continue;
        const double rounding = acos(lint_normal_rounding(data, reading, &eyes.now, pixel, n));
        if (!(rounding < 0.26)) continue;
        const bool agrees = dot(f, n) > cos(acos(SAME_DIRECTION) + rounding);
        lint_count(&tally, agrees);
        facing[i] = (struct lint_facing){direction_of(f), agrees ? 1 : -1};
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
    double world[3], now[2], before[2], depth;
    if (!lint_place(data, reading, &eyes->now, pixel, world) ||
        !lint_project(data, reading, &eyes->now, world, now, &depth) ||
        !lint_project(data, reading, &eyes->before, world, before, &depth))
        return false;
    for (int k = 0; k < 2; k++) out[k] = before[k] - now[k];
    return true;
}

int lint_sees(const struct lint_data *data, const struct lint_reading *reading, size_t c, const double world[3],
              const float **texel) {
    const struct lint_cube *cube = &data->cubes[c];
    double d[3], u, v;
    lint_from_center(data, reading, c, world, d);
    const double away = sqrt(dot(d, d));
    if (!cube->has_distance || !(away > 0) || !isfinite(away)) return 0;
    const int face = cube_face_of(d, &u, &v);
    lint_turn(reading->turn[face], &u, &v);
    *texel = lint_texel(cube, reading->face[face], u, v);
    return lint_shows(reading, cube, *texel, d, away);
}

static struct lint_tally compare_cubemaps(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct lint_tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        double world[3];
        if (!lint_place(data, reading, &eyes.now, data->samples[i], world)) continue;
        for (size_t c = 0; c < data->cube_count; c++) {
            const float *texel;
            const int s = lint_sees(data, reading, c, world, &texel);
            if (s) lint_count(&tally, s > 0);
        }
    }
    return tally;
}

static struct lint_tally compare_motion(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct lint_tally tally = {0, 0};
    if (!data->has_motion || !data->frame.has_previous) return tally;
    for (size_t i = 0; i < data->sample_count; i++) {
        double moved[2], found[2];
        if (!lint_moved(data, reading, &eyes, data->samples[i], moved)) continue;
        lint_motion(data, reading, data->samples[i], found);
        const double expected = hypot(moved[0], moved[1]);
        if (!(expected > LINT_MOVES_PX)) continue;
        const double off = hypot(found[0] - moved[0], found[1] - moved[1]);
        lint_count(&tally, off < 0.05 + 0.1 * expected);
    }
    return tally;
}

double lint_linear(const struct lint_data *data, enum glint_color_encoding encoding, float value) {
    const double v = (double)value;
    if (encoding == GLINT_COLOR_PRE_EXPOSED) return v / (data->frame.pre_exposure > 0 ? data->frame.pre_exposure : 1);
    if (encoding == GLINT_COLOR_SRGB) return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    return v;
}

const float *lint_lit(const struct lint_data *data, const struct lint_reading *reading, uint32_t pixel) {
    const uint32_t x = pixel % data->width, y = pixel / data->width,
                   row = reading->lit_upside_down ? data->height - 1 - y : y;
    return (reading->swapped_lit ? data->before_lit : data->lit) + 3 * ((size_t)row * data->width + x);
}

static struct lint_tally compare_colors(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct lint_tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        const uint32_t pixel = data->samples[i];
        double world[3];
        if (!lint_place(data, reading, &eyes.now, pixel, world)) continue;
        const float *lit = lint_lit(data, reading, pixel);
        if (!(lint_luminance(lit) > 1e-3)) continue;
        bool compared = false, agrees = false;
        for (size_t c = 0; c < data->cube_count && !agrees; c++) {
            const float *texel;
            if (lint_sees(data, reading, c, world, &texel) != 1) continue;
            bool alike = true;
            for (int k = 0; k < 3 && alike; k++) {
                const double a = lint_linear(data, reading->lit, lit[reading->lit_bgr ? 2 - k : k]),
                             b = lint_linear(data, reading->cube, texel[k]);
                alike = fabs(a - b) <= 0.1 * (a + b) + 2e-3;
            }
            compared = true;
            agrees = alike;
        }
        if (compared) lint_count(&tally, agrees);
    }
    return tally;
}

void lint_measure(const struct lint_data *data, const struct lint_reading *reading, enum lint_measure m,
                  struct lint_agreement *a) {
    static struct lint_tally (*const take[])(const struct lint_data *, const struct lint_reading *) = {
        NULL, compare_cubemaps, compare_motion, compare_colors, lint_before, lint_light, lint_sky};
    const struct lint_tally tally =
        m == LINT_FACETS ? compare_facets(data, reading, a->facing) : take[m](data, reading);
    a->count[m] = tally.count;
    a->share[m] = tally.count ? (double)tally.agree / (double)tally.count : 0;
}

struct lint_agreement lint_agree(const struct lint_data *data, const struct lint_reading *reading,
                                 const struct lint_agreement *known, unsigned which) {
    struct lint_agreement a = {{0}, {0}, {{0, 0}}};
    if (known) a = *known;
    for (int m = 0; m < LINT_MEASURES; m++)
        if (!known || which & (1u << m)) lint_measure(data, reading, (enum lint_measure)m, &a);
    return a;
}
