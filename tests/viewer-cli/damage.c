/* Deliberate mistakes in captures. */
#include "damage_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

/* Changes each texel of the G-buffer's channels X Y Z of a kind. */
static void each_normal(struct rewrite *r, void (*change)(const double *m, double n[3], double strength),
                        double strength) {
    float *x = damage_floats(r, "gbuffer", "normal.X"), *y = damage_floats(r, "gbuffer", "normal.Y"),
          *z = damage_floats(r, "gbuffer", "normal.Z");
    const double *m = damage_matrix(r, "glint.worldToView");
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) {
        double n[3] = {(double)x[i], (double)y[i], (double)z[i]};
        change(m, n, strength);
        x[i] = (float)n[0];
        y[i] = (float)n[1];
        z[i] = (float)n[2];
    }
}

/* ---- Normals ---- */

static void to_view(const double *m, double n[3], UNUSED double strength) {
    double v[3];
    for (int i = 0; i < 3; i++) v[i] = m[4 * i] * n[0] + m[4 * i + 1] * n[1] + m[4 * i + 2] * n[2];
    memcpy(n, v, sizeof v);
}
static void to_unorm(UNUSED const double *m, double n[3], UNUSED double strength) {
    for (int i = 0; i < 3; i++) n[i] = fmin(n[i] / 2 + 0.5, 1);
}
static void negate(UNUSED const double *m, double n[3], UNUSED double strength) {
    for (int i = 0; i < 3; i++) n[i] = -n[i];
}
static void flip_x(UNUSED const double *m, double n[3], UNUSED double strength) {
    n[0] = -n[0];
}
static void flip_y(UNUSED const double *m, double n[3], UNUSED double strength) {
    n[1] = -n[1];
}
static void flip_z(UNUSED const double *m, double n[3], UNUSED double strength) {
    n[2] = -n[2];
}
static void exchange_yz(UNUSED const double *m, double n[3], UNUSED double strength) {
    const double y = n[1];
    n[1] = n[2];
    n[2] = y;
}
static void shorten(UNUSED const double *m, double n[3], double strength) {
    for (int i = 0; i < 3; i++) n[i] *= 0.3 + 0.6 * strength;
}

#define NORMAL(name, change)                                                                                           \
    static bool name(struct rewrite *r, double strength) {                                                             \
        each_normal(r, change, strength);                                                                              \
        return true;                                                                                                   \
    }
NORMAL(normals_in_view_axes, to_view)
NORMAL(normals_unorm, to_unorm)
NORMAL(normals_negated, negate)
NORMAL(normals_x, flip_x)
NORMAL(normals_y, flip_y)
NORMAL(normals_z, flip_z)
NORMAL(normals_yz, exchange_yz)
NORMAL(normals_short, shorten)

static void to_other_view(const double *m, double n[3], double strength) {
    to_view(m, n, strength);
    n[2] = -n[2];
}
static void to_unorm_view(const double *m, double n[3], double strength) {
    to_view(m, n, strength);
    to_unorm(m, n, strength);
}
NORMAL(normals_in_other_view, to_other_view)
NORMAL(normals_unorm_in_view, to_unorm_view)
/* With half of the truth declared. */
static bool normals_of_other_hand(struct rewrite *r, double strength) {
    each_normal(r, to_other_view, strength);
    damage_set_text(r, "glint.normalSpace", "view");
    return true;
}

/* ---- Depth ---- */

static bool each_depth(struct rewrite *r,
                       double (*change)(const double *p, double x, double y, double z, double strength),
                       double strength) {
    struct rewrite_part *g = rewrite_find(r, "gbuffer");
    float *z = damage_floats(r, "gbuffer", "depth.Z");
    const double *p = damage_matrix(r, "glint.viewToClip");
    bool any = false;
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) {
        const double x = 2 * ((double)(i % g->part.width) + 0.5) / g->part.width - 1,
                     y = 1 - 2 * ((double)(i / g->part.width) + 0.5) / g->part.height;
        const float changed = (float)change(p, x, y, (double)z[i], strength);
        any = any || changed != z[i];
        z[i] = changed;
    }
    return any;
}
static double as_radial(const double *p, double x, double y, double z, UNUSED double strength) {
    const double u = (x - p[2] * p[14]) / p[0], v = (y - p[6] * p[14]) / p[5];
    return z * sqrt(u * u + v * v + 1);
}
static double as_hundreds(const double *p, double x, double y, double z, double strength) {
    (void)p, (void)x, (void)y, (void)strength;
    return z * 100;
}
static double with_far_sky(const double *p, double x, double y, double z, double strength) {
    (void)p, (void)x, (void)y;
    return isfinite(z) ? z : floor(5000 + 60000 * strength);
}
static bool depth_radial(struct rewrite *r, double strength) {
    return each_depth(r, as_radial, strength);
}
static bool depth_hundreds(struct rewrite *r, double strength) {
    return each_depth(r, as_hundreds, strength);
}
static bool depth_sky(struct rewrite *r, double strength) {
    return each_depth(r, with_far_sky, strength);
}
static double as_half(const double *p, double x, double y, double z, double strength) {
    int exponent;
    (void)p, (void)x, (void)y, (void)strength;
    frexp(z, &exponent);
    return isfinite(z) ? ldexp(nearbyint(ldexp(z, 11 - exponent)), exponent - 11) : z;
}
/* Rounded to half floats, although the engine declares another format. */
static bool depth_in_half(struct rewrite *r, double strength) {
    return each_depth(r, as_half, strength);
}
/* Depth from a buffer of few bits, decoded before capturing; 12 bits at the tests' resolution correspond to 16 at a game's. */
static double through_12_bits(const double *p, double x, double y, double z, double strength) {
    (void)x, (void)y, (void)strength;
    const double device = nearbyint(4095 * (p[10] * p[14] + p[11] / z)) / 4095;
    return isfinite(z) ? p[11] / (device - p[10] * p[14]) : z;
}
static bool depth_through_12_bits(struct rewrite *r, double strength) {
    return each_depth(r, through_12_bits, strength);
}
/* Stored as the projection computes it, but not declared. */
static bool depth_undeclared(struct rewrite *r, UNUSED double strength) {
    rewrite_remove_attribute(r, "gbuffer", "glint.depth");
    return true;
}

/* ---- Camera ---- */

static bool invert_camera(struct rewrite *r, const char *name) {
    const double *m = damage_matrix(r, name);
    double v[16] = {0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            v[4 * i + k] = m[4 * k + i];
            v[4 * i + 3] -= m[4 * k + i] * m[4 * k + 3];
        }
    v[15] = 1;
    damage_set_matrix(r, name, v);
    return true;
}
DAMAGE(camera_inverse_current, invert_camera(r, "glint.worldToView"))
DAMAGE(camera_inverse, invert_camera(r, "glint.worldToView") && invert_camera(r, "glint.previousWorldToView"))
static bool camera_mirrored(struct rewrite *r, UNUSED double strength) {
    static const char *const names[] = {"glint.worldToView", "glint.previousWorldToView"};
    for (int k = 0; k < 2; k++) {
        double v[16];
        memcpy(v, damage_matrix(r, names[k]), sizeof v);
        for (int i = 0; i < 4; i++) v[i] = -v[i];
        damage_set_matrix(r, names[k], v);
    }
    return true;
}
/* Not a mistake: a reversed depth buffer without far plane, with NDC from -1 to 1. */
static double as_infinite(const double *p, double x, double y, double z, double strength) {
    (void)p, (void)x, (void)y, (void)strength;
    return 0.1 / z;
}
static bool depth_infinite(struct rewrite *r, double strength) {
    double p[16];
    if (!each_depth(r, as_infinite, strength)) return false;
    memcpy(p, damage_matrix(r, "glint.viewToClip"), sizeof p);
    p[10] = -p[14], p[11] = 2 * 0.1;
    damage_set_matrix(r, "glint.viewToClip", p);
    damage_set_text(r, "glint.depth", "reversed_infinite");
    damage_set_text(r, "glint.clipZ", "minus_one_to_one");
    return true;
}
static bool camera_clip_y(struct rewrite *r, UNUSED double strength) {
    damage_set_text(r, "glint.clipY", "down");
    return true;
}
static bool camera_up(struct rewrite *r, double strength) {
    damage_set_text(r, "glint.up", strength < 0.5 ? "+z" : "+x");
    return true;
}
static bool previous_same(struct rewrite *r, UNUSED double strength) {
    damage_set_matrix(r, "glint.previousWorldToView", damage_matrix(r, "glint.worldToView"));
    damage_set_matrix(r, "glint.previousViewToClip", damage_matrix(r, "glint.viewToClip"));
    return true;
}
static bool previous_missing(struct rewrite *r, UNUSED double strength) {
    for (size_t i = r->count; i-- > 0;)
        if (!strncmp(r->parts[i].name, "previous.", 9)) rewrite_remove_part(r, r->parts[i].name);
    rewrite_remove_attribute(r, "gbuffer", "glint.previousWorldToView");
    rewrite_remove_attribute(r, "gbuffer", "glint.previousViewToClip");
    return true;
}

/* Every screen image with its bottom row first, and motion with y up. */
static bool bottom_first(struct rewrite *r, UNUSED double strength) {
    for (size_t i = 0; i < r->count; i++) {
        struct rewrite_part *p = &r->parts[i];
        const size_t w = p->part.width, h = p->part.height;
        if (damage_is_cube(p) || !strcmp(p->name, "sky")) continue;
        for (size_t c = 0; c < p->part.channel_count; c++) {
            const size_t line = w * (p->channels[c].stored == GLINT_STORED_HALF ? 2 : 4);
            char *bytes = p->data[c], kept[8192];
            assert_true(line <= sizeof kept);
            for (size_t y = 0; y < h / 2; y++) {
                memcpy(kept, bytes + y * line, line);
                memcpy(bytes + y * line, bytes + (h - 1 - y) * line, line);
                memcpy(bytes + (h - 1 - y) * line, kept, line);
            }
        }
    }
    float *y = damage_floats(r, "gbuffer", "motion.Y");
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) y[i] = -y[i];
    return true;
}

/* ---- Motion ---- */

/* Adds some uv, then multiplies by a factor. */
static bool each_motion(struct rewrite *r, double x_shift, double y_shift, double x_factor, double y_factor) {
    float *x = damage_floats(r, "gbuffer", "motion.X"), *y = damage_floats(r, "gbuffer", "motion.Y");
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) {
        x[i] = (float)(((double)x[i] + x_shift) * x_factor);
        y[i] = (float)(((double)y[i] + y_shift) * y_factor);
    }
    return true;
}
DAMAGE(motion_negated, each_motion(r, 0, 0, -1, -1))
DAMAGE(motion_y, each_motion(r, 0, 0, 1, -1))
DAMAGE(motion_ndc, each_motion(r, 0, 0, 2, -2))
static bool motion_pixels(struct rewrite *r, UNUSED double strength) {
    const struct rewrite_part *g = rewrite_find(r, "gbuffer");
    return each_motion(r, 0, 0, g->part.width, g->part.height);
}
DAMAGE(motion_zero, each_motion(r, 0, 0, 0, 0))

static bool motion_unjittered(struct rewrite *r, double strength) {
    const double *now = damage_matrix(r, "glint.viewToClip"), *before = damage_matrix(r, "glint.previousViewToClip");
    (void)strength; /* both look along -z, where an offset has the opposite sign */
    return each_motion(r, (before[2] - now[2]) / 2, (now[6] - before[6]) / 2, 1, 1);
}

/* Motion of an unrelated frame, except for each tenth pixel, which points the opposite way: too few to identify that. */
static bool motion_of_another(struct rewrite *r, double strength) {
    float *x = damage_floats(r, "gbuffer", "motion.X"), *y = damage_floats(r, "gbuffer", "motion.Y");
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) {
        const double turn = 7 * (double)i + 50 * strength;
        x[i] = i % 10 ? (float)(0.05 * sin(turn)) : -x[i];
        y[i] = i % 10 ? (float)(0.05 * cos(turn * 1.3)) : -y[i];
    }
    return true;
}

/* ---- Light ---- */

static const char *const rgb[3] = {"R", "G", "B"};

/* The true reflection, scaled by the reflectance of metal. */
static bool lit_specular(struct rewrite *r, double strength) {
    const float *metal = damage_floats(r, "gbuffer", "material.metalness");
    size_t metals = 0;
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) metals += metal[i] > 0.95f;
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        const float *truth = damage_floats(r, "truth.reflection.ggx", rgb[c]);
        for (size_t i = 0; i < damage_texels_of(r, "lit"); i++)
            v[i] += (float)((0.04 + 0.9 * (double)metal[i]) * (0.5 + 0.5 * strength) * (double)truth[i]);
    }
    return metals > damage_texels_of(r, "gbuffer") / 100;
}
static bool lit_srgb(struct rewrite *r, UNUSED double strength) {
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        for (size_t i = 0; i < damage_texels_of(r, "lit"); i++)
            v[i] = (float)(v[i] <= 0.0031308f ? 12.92 * (double)v[i] : 1.055 * pow((double)v[i], 1 / 2.4) - 0.055);
    }
    return true;
}
static bool lit_upside_down(struct rewrite *r, UNUSED double strength) {
    const struct rewrite_part *p = rewrite_find(r, "lit");
    const uint32_t w = p->part.width, h = p->part.height;
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        for (uint32_t y = 0; y < h / 2; y++)
            for (uint32_t x = 0; x < w; x++) {
                const float t = v[y * w + x];
                v[y * w + x] = v[(h - 1 - y) * w + x];
                v[(h - 1 - y) * w + x] = t;
            }
    }
    return true;
}
static bool lit_bgr(struct rewrite *r, UNUSED double strength) {
    float *red = damage_floats(r, "lit", "R"), *blue = damage_floats(r, "lit", "B");
    for (size_t i = 0; i < damage_texels_of(r, "lit"); i++) {
        const float t = red[i];
        red[i] = blue[i];
        blue[i] = t;
    }
    return true;
}

/* Of another place, where metals are as dark. */
static bool lit_of_another(struct rewrite *r, double strength) {
    const float *metal = damage_floats(r, "gbuffer", "material.metalness");
    for (int c = 0; c < 3; c++) {
        float *v = damage_floats(r, "lit", rgb[c]);
        for (size_t i = 0; i < damage_texels_of(r, "lit"); i++)
            v[i] = metal[i] > 0 ? 0 : (float)(20 + strength + 10 * sin(11 * (double)i + 3 * c));
    }
    return true;
}

/* ---- Damage that the data cannot reveal ---- */

static bool each_roughness(struct rewrite *r, bool invert) {
    float *v = damage_floats(r, "gbuffer", "material.roughness");
    for (size_t i = 0; i < damage_texels_of(r, "gbuffer"); i++) v[i] = invert ? 1 - v[i] : v[i] * v[i];
    return true;
}
DAMAGE(roughness_squared, each_roughness(r, false))
DAMAGE(roughness_inverted, each_roughness(r, true))
static bool metres_per_unit(struct rewrite *r, UNUSED double strength) {
    static double hundredth = 0.01;
    rewrite_attribute(r, "gbuffer", "glint.metresPerUnit")->numbers = &hundredth;
    return true;
}

const struct damage damages[] = {
    {"normal.view_space", BASE_PLAIN, normals_in_view_axes},
    {"normal.unorm", BASE_PLAIN, normals_unorm},
    {"normal.negated", BASE_PLAIN, normals_negated},
    {"normal.x", BASE_PLAIN, normals_x},
    {"normal.y", BASE_PLAIN, normals_y},
    {"normal.z", BASE_PLAIN, normals_z},
    {"normal.yz", BASE_PLAIN, normals_yz},
    {"normal.length", BASE_PLAIN, normals_short},
    {"normal.view_handedness", BASE_PLAIN, normals_in_other_view},
    {"normal.view_handedness", BASE_PLAIN, normals_of_other_hand},
    {"normal.view_space", BASE_PLAIN, normals_unorm_in_view},
    {"depth.coarse", BASE_DEVICE, depth_in_half},
    {"depth.coarse", BASE_PLAIN, depth_through_12_bits},
    {"picture.bottom_first", BASE_PLAIN, bottom_first},
    {"previous.same", BASE_PLAIN, before_same},
    {"camera.swapped", BASE_PLAIN, before_exchanged},
    {"camera.swapped", BASE_PLAIN, before_exchanged_lit},
    {"previous.unexplained", BASE_PLAIN, before_elsewhere},
    {"depth.clip_z", BASE_DEVICE, before_clip_z},
    {"depth.scale_0.01", BASE_PLAIN, before_hundreds},
    {"camera.mirrored", BASE_PLAIN, before_mirrored},
    {"motion.unexplained", BASE_PLAIN, motion_of_another},
    {"cubemap.sky_color", BASE_PLAIN, sky_colored},
    {"cubemap.sky_alpha", BASE_PLAIN, sky_solid},
    {"cubemap.sky_distance", BASE_PLAIN, sky_at_0},
    {"cubemap.center", BASE_PLAIN, center_off},
    {"cubemap.inner_volume", BASE_PLAIN, inner_full},
    {"depth.device", BASE_DEVICE, depth_undeclared},
    {"depth.reversed", BASE_REVERSED, depth_undeclared},
    {"depth.radial", BASE_PLAIN, depth_radial},
    {"depth.scale_0.01", BASE_PLAIN, depth_hundreds},
    {"depth.sky_value", BASE_PLAIN, depth_sky},
    {"camera.inverse", BASE_PLAIN, camera_inverse},
    {"camera.inverse_current", BASE_PLAIN, camera_inverse_current},
    {"camera.mirrored", BASE_PLAIN, camera_mirrored},
    {"camera.clip_y", BASE_PLAIN, camera_clip_y},
    {"camera.up", BASE_PLAIN, camera_up},
    {"previous.same", BASE_PLAIN, previous_same},
    {"previous.missing", BASE_PLAIN, previous_missing},
    {"motion.negated", BASE_PLAIN, motion_negated},
    {"motion.y", BASE_PLAIN, motion_y},
    {"motion.ndc", BASE_PLAIN, motion_ndc},
    {"motion.pixels", BASE_PLAIN, motion_pixels},
    {"motion.unjittered", BASE_PLAIN, motion_unjittered},
    {"motion.zero", BASE_PLAIN, motion_zero},
    {"cubemap.faces_order", BASE_PLAIN, faces_exchanged},
    {"cubemap.faces_order", BASE_PLAIN, faces_rotated},
    {"cubemap.faces_orientation", BASE_PLAIN, faces_mirrored},
    {"cubemap.faces_orientation", BASE_PLAIN, faces_upside_down},
    {"cubemap.axis_distance", BASE_PLAIN, distance_planar},
    {"cubemap.scale_0.01", BASE_PLAIN, distance_hundreds},
    {"cubemap.scale_100", BASE_PLAIN, distance_hundredths},
    {"cubemap.center_negated", BASE_PLAIN, center_negated},
    {"cubemap.center_0.01", BASE_PLAIN, center_hundreds},
    {"cubemap.sky_inverted", BASE_PLAIN, sky_inverted},
    {"lit.specular", BASE_PLAIN, lit_specular},
    {"lit.srgb", BASE_PLAIN, lit_srgb},
    {"lit.upside_down", BASE_PLAIN, lit_upside_down},
    {"lit.bgr", BASE_PLAIN, lit_bgr},
    {"lit.swapped", BASE_PLAIN, light_swapped},
    {"lit.previous", BASE_PLAIN, light_late},
    {"lit.scene", BASE_PLAIN, light_finished},
    {"lit.sky", BASE_PLAIN, light_without_sky},
    {"lit.srgb", BASE_PLAIN, light_srgb},
    {"lit.linear", BASE_PLAIN, light_linear},
    {"depth.swapped", BASE_PLAIN, before_depth},
    {"sky.srgb", BASE_PLAIN, sky_srgb},
    {"sky.linear", BASE_PLAIN, sky_linear},
    {"sky.pre_exposed", BASE_PLAIN, sky_pre_exposed},
    {"sky.faces_orientation", BASE_PLAIN, sky_mirrored},
    {"sky.faces_orientation", BASE_PLAIN, sky_upside_down},
    {"sky.faces_order", BASE_PLAIN, sky_exchanged},
    {NULL, BASE_PLAIN, roughness_squared},
    {NULL, BASE_PLAIN, roughness_inverted},
    {NULL, BASE_PLAIN, metres_per_unit},
    {NULL, BASE_PLAIN, depth_infinite},
    {NULL, BASE_PLAIN, cubes_tiny},
    {NULL, BASE_PLAIN, lit_of_another},
    {NULL, BASE_PLAIN, before_right},
    {NULL, BASE_REVERSED, before_right},
    {NULL, BASE_PLAIN, before_right_lit},
    {NULL, BASE_PLAIN, sky_clouds},
    {NULL, BASE_PLAIN, sky_bright},
    {NULL, BASE_PLAIN, sky_cloudy},
    {NULL, BASE_PLAIN, sky_plain_and_bright},
    {NULL, BASE_PLAIN, metals_that_emit},
    {"normal.upside_down", BASE_PLAIN, normals_upside_down},
};
const size_t damage_count = sizeof damages / sizeof *damages;
