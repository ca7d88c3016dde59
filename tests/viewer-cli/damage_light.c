/* Mistakes in lit, scene and the sky. */
#include "damage_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

static const char *const rgb[3] = {"R", "G", "B"};

/* Sky must be seen, or it shows nothing. */
static bool has_sky(struct rewrite *r) {
    const float *z = damage_floats(r, "gbuffer", "depth.Z");
    size_t sky = 0;
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) sky += isinf(z[i]) != 0;
    return sky > 600;
}

/* Only the sky shows how colours are encoded. Last: pixels are found by the parts' places in the file. */
static bool sky_alone(struct rewrite *r) {
    const bool seen = has_sky(r);
    remove_cubes(r);
    return seen;
}

static void each_color(struct rewrite *r, const char *part, double (*change)(double v, double by), double by) {
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, part, rgb[c]);
        for (size_t i = 0; i < damage_texels_of(r, part); i++) v[i] = (float)change((double)v[i], by);
    }
}
static double to_srgb(double v, UNUSED double by) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}
static double times(double v, double by) {
    return v * by;
}
static double constant(UNUSED double v, double by) {
    return by;
}

/* ---- Light ---- */

bool light_swapped(struct rewrite *r, UNUSED double strength) {
    for (int c = 0; c < 3; c++) damage_swap(r, "lit", "previous.lit", rgb[c]);
    return true;
}

static void copy_colors(struct rewrite *r, const char *to, const char *from) {
    for (int c = 0; c < 3; c++)
        memcpy(damage_floats(r, to, rgb[c]), damage_floats(r, from, rgb[c]), damage_texels_of(r, to) * sizeof(float));
}
bool light_late(struct rewrite *r, UNUSED double strength) {
    copy_colors(r, "lit", "previous.lit");
    return true;
}
bool light_without_sky(struct rewrite *r, UNUSED double strength) {
    const float *z = damage_floats(r, "gbuffer", "depth.Z");
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        for (size_t i = 0; i < damage_texels_of(r, "lit"); i++)
            if (isinf(z[i])) v[i] = 0;
    }
    return has_sky(r);
}
bool light_finished(struct rewrite *r, UNUSED double strength) {
    copy_colors(r, "lit", "scene");
    return true;
}

bool light_srgb(struct rewrite *r, double strength) {
    each_color(r, "lit", to_srgb, strength);
    return sky_alone(r);
}
bool light_linear(struct rewrite *r, UNUSED double strength) {
    damage_set_text_of(r, "lit", "glint.color", "srgb");
    return sky_alone(r);
}

/* ---- Sky ---- */

bool sky_srgb(struct rewrite *r, double strength) {
    each_color(r, "sky", to_srgb, strength);
    return has_sky(r);
}
bool sky_linear(struct rewrite *r, UNUSED double strength) {
    damage_set_text_of(r, "sky", "glint.color", "srgb");
    return has_sky(r);
}
bool sky_pre_exposed(struct rewrite *r, double strength) {
    static double exposure;
    exposure = strength < 0.5 ? 0.1 + strength / 2 : 2 + 3 * strength;
    rewrite_attribute(r, "gbuffer", "glint.preExposure")->numbers = &exposure;
    each_color(r, "sky", times, exposure);
    return has_sky(r);
}

/* Clouds in the sky and in its cube map, for a clear sky looks the same when it is mirrored. */
static double clouds(const double d[3]) {
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return 1.5 + sin((9 * d[0] + 4 * d[1] + 6 * d[2]) / length);
}

static void paint_cube(struct rewrite *r) {
    const uint32_t n = rewrite_find(r, "sky")->part.width;
    for (uint32_t i = 0; i < 6 * n * n; i++) {
        const double s = 2 * (i % n + 0.5) / n - 1, t = 2 * (i / n % n + 0.5) / n - 1;
        const double d[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
        for (int c = 0; c < 3; c++) damage_floats(r, "sky", rgb[c])[i] *= (float)clouds(d[i / (n * n)]);
    }
}

static void paint_lit(struct rewrite *r) {
    const uint32_t w = rewrite_find(r, "lit")->part.width, h = rewrite_find(r, "lit")->part.height;
    const double *m = damage_matrix(r, "glint.worldToView"), *p = damage_matrix(r, "glint.viewToClip");
    const float *z = damage_floats(r, "gbuffer", "depth.Z");
    for (uint32_t i = 0; i < w * h; i++) {
        const double v[3] = {(2 * (i % w + 0.5) / w - 1 - p[2] * p[14]) / p[0],
                             (1 - 2 * (i / w + 0.5) / h - p[6] * p[14]) / p[5], p[14]};
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = m[k] * v[0] + m[4 + k] * v[1] + m[8 + k] * v[2];
        for (int c = 0; isinf(z[i]) && c < 3; c++) damage_floats(r, "lit", rgb[c])[i] *= (float)clouds(d);
    }
}

static bool sky_faces(struct rewrite *r, const int from[6], int turn) {
    paint_cube(r);
    paint_lit(r);
    for (int c = 0; c < 3; c++) damage_turn_faces(r, "sky", rgb[c], from, turn);
    return has_sky(r);
}
static const int in_order[6] = {0, 1, 2, 3, 4, 5};
DAMAGE(sky_mirrored, sky_faces(r, in_order, 1))
DAMAGE(sky_upside_down, sky_faces(r, in_order, 2))
/* With another up axis. */
DAMAGE(sky_exchanged, sky_faces(r, (const int[6]){2, 3, 4, 5, 0, 1}, 0))

void damage_by_normal_map(struct rewrite *r, double sign) {
    float *n[3] = {damage_floats(r, "gbuffer", "normal.X"), damage_floats(r, "gbuffer", "normal.Y"),
                   damage_floats(r, "gbuffer", "normal.Z")};
    const uint32_t width = rewrite_find(r, "gbuffer")->part.width;
    for (uint32_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) {
        const double x = i % width, y = i / width;
        double m[3] = {sign * (double)n[0][i], (double)n[1][i], (double)n[2][i]}, length = 0;
        if (i % 3) m[0] += 0.3 * sin(1.7 * x + y), m[1] += 0.3 * cos(x - 1.3 * y), m[2] += 0.3 * sin(y);
        for (int k = 0; k < 3; k++) length += m[k] * m[k];
        for (int k = 0; k < 3; k++) n[k][i] = (float)(m[k] / sqrt(length));
    }
}

bool normals_upside_down(struct rewrite *r, double strength) {
    const struct rewrite_part *p = rewrite_find(r, "gbuffer");
    const uint32_t w = p->part.width, h = p->part.height;
    (void)strength;
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "gbuffer", (const char *[]){"normal.X", "normal.Y", "normal.Z"}[c]);
        for (uint32_t i = 0; i < w * (h / 2); i++) {
            const uint32_t other = (h - 1 - i / w) * w + i % w;
            const float t = v[i];
            v[i] = v[other];
            v[other] = t;
        }
    }
    return true;
}

/* ---- Not mistakes ---- */

/* Metals that emit light of the colour of their material. */
bool metals_that_emit(struct rewrite *r, double strength) {
    const float *metal = damage_floats(r, "gbuffer", "material.metalness");
    size_t metals = 0;
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        const float *albedo = damage_floats(r, "gbuffer", (const char *[]){"albedo.R", "albedo.G", "albedo.B"}[c]);
        for (size_t i = 0; i < damage_texels_of(r, "lit"); i++)
            if (metal[i] > 0.95f) v[i] += (float)(0.2 + 2 * strength) * albedo[i];
    }
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) metals += metal[i] > 0.95f;
    return metals > damage_texels_of(r, "gbuffer") / 100;
}

DAMAGE(sky_clouds, sky_faces(r, in_order, 0))

bool sky_bright(struct rewrite *r, double strength) {
    each_color(r, "sky", times, 0.3 + 3 * strength);
    return sky_alone(r);
}

/* Clouds that the sky cube map does not have, over half of the sky. */
bool sky_cloudy(struct rewrite *r, double strength) {
    const float *z = damage_floats(r, "gbuffer", "depth.Z");
    const uint32_t width = rewrite_find(r, "lit")->part.width;
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        for (uint32_t i = 0; i < damage_texels_of(r, "lit"); i++)
            if (isinf(z[i]) && sin(i % width * 0.21 + 9 * strength) + sin(i / width * 0.37) > 0)
                v[i] = v[i] * 0.4f + 0.3f * (1 + (float)strength);
    }
    return sky_alone(r);
}

/* A sky of one colour, which is drawn darker than its cube map; by chance as the sRGB curve would make it. */
bool sky_plain_and_bright(struct rewrite *r, double strength) {
    const double color = 0.05 + 0.6 * strength;
    const float *z = damage_floats(r, "gbuffer", "depth.Z");
    each_color(r, "sky", constant, to_srgb(color, 0));
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        for (size_t i = 0; i < damage_texels_of(r, "lit"); i++)
            if (isinf(z[i])) v[i] = (float)color;
    }
    return sky_alone(r);
}
