/* One scene in every encoding of depth, normals, roughness, motion and colour, in the storage formats of engines, decodes to the same
   values. The encoders here invert the formulas of FORMAT.md in double. Every bound is half a step of the storage format times the
   derivative of the decoder, plus the rounding of the float that the reader returns, and of the half for 8-bit formats that the file
   stores as half. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "encoded.h"
#include "unit.h"

enum { COUNT = FIX_W * FIX_H };
static const double NEAR = 0.1, FAR = 500;

/* ---- storage formats: the stored value, and half the step there ---- */

struct storage {
    const char *name;
    enum glint_type type;
    int bits; /* of a fixed-point format, else 0 */
    bool is_signed;
};
static const struct storage D16 = {"D16", GLINT_UNORM16, 16, false}, D24 = {"D24", GLINT_F32, 24, false},
                            D32F = {"D32F", GLINT_F32, 0, true}, R16F = {"R16F", GLINT_F16, 0, true},
                            R32F = {"R32F", GLINT_F32, 0, true}, UNORM8 = {"R8", GLINT_UNORM8, 8, false},
                            UNORM10 = {"R10G10B10A2", GLINT_F32, 10, false},
                            UNORM16 = {"R16", GLINT_UNORM16, 16, false}, SNORM8 = {"R8_SNORM", GLINT_SNORM8, 8, true},
                            SNORM16 = {"R16_SNORM", GLINT_SNORM16, 16, true};

/* The largest difference between `v` and the value in the file before decoding. */
static double half_step(const struct storage *s, double v) {
    if (s->type == GLINT_F16) return fmax(fabs(v) * ldexp(1, -11), ldexp(1, -25));
    if (s->bits == 0) return fabs(v) * ldexp(1, -24);
    const double top = s->is_signed ? ldexp(1, s->bits - 1) - 1 : ldexp(1, s->bits) - 1;
    /* The code's value is stored as half (8 bits) or float. */
    const double kept = s->bits == 8 ? ldexp(1, -11) : ldexp(1, -24);
    return 0.5 / top + fabs(v) * kept;
}

static uint16_t to_half(double v) {
    /* Binary search in the ordered positive halves, independent of the library's conversion. */
    uint16_t low = 0, high = 0x7c00;
    const double a = fabs(v);
    while (high - low > 1) {
        const uint16_t mid = (uint16_t)((low + high) / 2);
        const int e = mid >> 10;
        const double value = e ? ldexp(1024 + (mid & 1023), e - 25) : ldexp(mid & 1023, -24);
        if (value <= a) low = mid;
        else high = mid;
    }
    const int e = low >> 10, e2 = (low + 1) >> 10;
    const double below = e ? ldexp(1024 + (low & 1023), e - 25) : ldexp(low & 1023, -24);
    const double above = e2 ? ldexp(1024 + ((low + 1) & 1023), e2 - 25) : ldexp((low + 1) & 1023, -24);
    const uint16_t nearest = a - below > above - a || (a - below == above - a && (low & 1)) ? (uint16_t)(low + 1) : low;
    return (uint16_t)(nearest | (signbit(v) ? 0x8000 : 0));
}

static void store(const struct storage *s, double v, size_t i, void *out) {
    if (s->type == GLINT_F16) ((uint16_t *)out)[i] = to_half(v);
    else if (s->type == GLINT_UNORM8) ((uint8_t *)out)[i] = (uint8_t)lround(v * 255);
    else if (s->type == GLINT_SNORM8) ((int8_t *)out)[i] = (int8_t)lround(v * 127);
    else if (s->type == GLINT_UNORM16) ((uint16_t *)out)[i] = (uint16_t)lround(v * 65535);
    else if (s->type == GLINT_SNORM16) ((int16_t *)out)[i] = (int16_t)lround(v * 32767);
    else if (s->bits) ((float *)out)[i] = (float)(nearbyint(v * (ldexp(1, s->bits) - 1)) / (ldexp(1, s->bits) - 1));
    else ((float *)out)[i] = (float)v;
}

static void close_and_remove(struct glint_capture **capture, const char *path) {
    glint_capture_close(capture);
    unlink(path);
}

/* ---- depth ---- */

enum projection { FINITE, FINITE_REVERSED, INFINITE_REVERSED };

/* Rows 2 and 3 of a projection of view z, with sign `s` in front, to NDC [lo, 1]. */
static void project(double m[16], enum projection p, double s, double lo) {
    /* ndc(t) = A s + B / t; solved for the two ends. */
    const double near_ndc = p == FINITE ? lo : 1, far_ndc = p == FINITE ? 1 : lo;
    const double inv_far = p == INFINITE_REVERSED ? 0 : 1 / FAR;
    const double b = (near_ndc - far_ndc) / (1 / NEAR - inv_far);
    m[11] = b;
    m[10] = s * (far_ndc - b * inv_far);
    m[14] = s;
}

static double stored_depth(enum glint_depth_encoding e, const double m[16], bool symmetric, double t) {
    if (e == GLINT_DEPTH_VIEW_LINEAR) return t;
    if (e == GLINT_DEPTH_LOGARITHMIC) return isinf(t) ? 1 : log(t / NEAR) / log(FAR / NEAR);
    if (e == GLINT_DEPTH_LOGARITHMIC_REVERSED) return isinf(t) ? 0 : 1 - log(t / NEAR) / log(FAR / NEAR);
    if (isinf(t)) return e == GLINT_DEPTH_DEVICE ? 1 : 0;
    const double z = t * m[14], ndc = (m[10] * z + m[11]) / (m[14] * z);
    return symmetric ? (ndc + 1) / 2 : ndc;
}

static void check_depth(enum glint_depth_encoding e, enum projection p, const struct storage *s, double sign,
                        enum glint_clip_z clip_z, const char *part) {
    char path[512];
    static float out[COUNT];
    static const char *const names[] = {"depth.Z"};
    struct glint_frame frame = fixture_frame();
    const bool symmetric = clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE;
    struct glint_camera *camera = !strcmp(part, "gbuffer") ? &frame.camera : &frame.previous;
    frame.clip_z = clip_z;
    project(frame.camera.view_to_clip, FINITE, -1, symmetric ? -1 : 0);
    project(frame.previous.view_to_clip, FINITE, -1, symmetric ? -1 : 0);
    project(camera->view_to_clip, p, sign, symmetric ? -1 : 0);
    for (size_t i = 0; i < COUNT; i++)
        store(s, stored_depth(e, camera->view_to_clip, symmetric, (double)fixture.gbuffer[17 * i]), i, encoded_bits[0]);
    const struct glint_encodings encodings = {.depth = e};
    struct glint_capture *capture =
        encoded_capture(fixture_path(path, "depth.exr"), part, &encodings, names, 1, s->type, s->name, &frame);
    encoded_read(capture, part, names, 1, out);
    for (size_t i = 0; i < COUNT; i++) {
        const double t = (double)fixture.gbuffer[17 * i], unit = frame.metres_per_unit;
        if (isinf(t)) {
            assert_true(isinf(out[i]) && out[i] > 0);
            continue;
        }
        const double v = stored_depth(e, camera->view_to_clip, symmetric, t), step = half_step(s, v);
        /* The bound uses both neighbours of the stored value, because decoders are not linear over a step of a coarse format. */
        double bound = 0;
        for (int side = -1; side <= 1; side += 2) {
            const double moved = v + side * step;
            double back = moved;
            if (e == GLINT_DEPTH_LOGARITHMIC) back = NEAR * pow(FAR / NEAR, moved);
            if (e == GLINT_DEPTH_LOGARITHMIC_REVERSED) back = NEAR * pow(FAR / NEAR, 1 - moved);
            if (e == GLINT_DEPTH_DEVICE || e == GLINT_DEPTH_REVERSED || e == GLINT_DEPTH_REVERSED_INFINITE) {
                const double *m = camera->view_to_clip, ndc = symmetric ? 2 * moved - 1 : moved;
                back = m[11] / (ndc - m[10] / m[14]);
                if (back <= 0 || (e == GLINT_DEPTH_DEVICE ? moved >= 1 : moved <= 0)) back = INFINITY;
            }
            bound = fmax(bound, fabs(back - t));
        }
        /* One rounding to float, and the cancellation in double near the far plane. */
        bound = bound * 1.000001 + t * (ldexp(1, -24) + t / NEAR * 1e-15);
        if (isinf(bound)) continue;
        if (!(fabs((double)out[i] / unit - t) <= bound))
            fail_msg("%s as %s, %s, sign %g: %.9g decoded to %.9g, bound %.3g", glint_encoding_name("depth", (int)e),
                     s->name, part, sign, t, (double)out[i] / unit, bound);
    }
    close_and_remove(&capture, path);
}

static void depth(UNUSED void **state) {
    const struct storage *fixed[] = {&D16, &D24, &D32F};
    for (size_t i = 0; i < 3; i++)
        for (double sign = -1; sign <= 1; sign += 2)
            for (int z = 0; z < 2; z++) {
                const enum glint_clip_z clip_z = z ? GLINT_CLIP_Z_MINUS_ONE_TO_ONE : GLINT_CLIP_Z_ZERO_TO_ONE;
                check_depth(GLINT_DEPTH_DEVICE, FINITE, fixed[i], sign, clip_z, "gbuffer");
                check_depth(GLINT_DEPTH_REVERSED, FINITE_REVERSED, fixed[i], sign, clip_z, "gbuffer");
                check_depth(GLINT_DEPTH_REVERSED_INFINITE, INFINITE_REVERSED, fixed[i], sign, clip_z, "gbuffer");
            }
    for (size_t i = 0; i < 3; i++) {
        check_depth(GLINT_DEPTH_LOGARITHMIC, FINITE, fixed[i], -1, GLINT_CLIP_Z_ZERO_TO_ONE, "gbuffer");
        check_depth(GLINT_DEPTH_LOGARITHMIC_REVERSED, FINITE, fixed[i], -1, GLINT_CLIP_Z_ZERO_TO_ONE, "gbuffer");
    }
    check_depth(GLINT_DEPTH_VIEW_LINEAR, FINITE, &R32F, -1, GLINT_CLIP_Z_ZERO_TO_ONE, "gbuffer");
    check_depth(GLINT_DEPTH_VIEW_LINEAR, FINITE, &R16F, -1, GLINT_CLIP_Z_ZERO_TO_ONE, "gbuffer");
    /* The depth of the previous frame is decoded with the previous camera. */
    check_depth(GLINT_DEPTH_REVERSED, FINITE_REVERSED, &D32F, -1, GLINT_CLIP_Z_ZERO_TO_ONE, "previous.gbuffer");
}

/* ---- normals ---- */

static void check_normals(enum glint_normal_encoding e, enum glint_normal_space space, const struct storage *s,
                          const char *family, const char *part) {
    char path[512], names[3][32];
    const char *pointers[3];
    static float out[3 * COUNT];
    const size_t at = strcmp(family, "normal") ? 13 : 1;
    const struct glint_frame frame = fixture_frame();
    const double *m = strcmp(part, "gbuffer") ? frame.previous.world_to_view : frame.camera.world_to_view;
    for (int a = 0; a < 3; a++) {
        snprintf(names[a], sizeof names[a], "%s.%c", family, "XYZ"[a]);
        pointers[a] = names[a];
    }
    for (size_t i = 0; i < COUNT; i++) {
        const float *w = fixture.gbuffer + 17 * i + at;
        double n[3];
        for (int a = 0; a < 3; a++)
            n[a] = space == GLINT_SPACE_WORLD
                       ? (double)w[a]
                       : m[4 * a] * (double)w[0] + m[4 * a + 1] * (double)w[1] + m[4 * a + 2] * (double)w[2];
        if (e == GLINT_NORMAL_OCTAHEDRAL) {
            const double l1 = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
            double x = n[0] / l1, y = n[1] / l1;
            if (n[2] < 0) {
                const double fx = (1 - fabs(y)) * copysign(1, x), fy = (1 - fabs(x)) * copysign(1, y);
                x = fx;
                y = fy;
            }
            n[0] = (x + 1) / 2;
            n[1] = (y + 1) / 2;
        } else if (e == GLINT_NORMAL_UNORM) {
            for (int a = 0; a < 3; a++) n[a] = (n[a] + 1) / 2;
        } else if (e == GLINT_NORMAL_SPHEREMAP) {
            /* As engines write it: n.xy, made a unit, by √(1/2 - f/2); f is towards the camera, +z where the view looks along -z. */
            const double wide = hypot(n[0], n[1]), f = frame.camera.view_to_clip[14] < 0 ? n[2] : -n[2];
            for (int a = 0; a < 2; a++) n[a] = 0.5 + 0.5 * (wide > 0 ? n[a] / wide * sqrt(fmax(0.5 - 0.5 * f, 0)) : 0);
        }
        for (int a = 0; a < 3; a++) store(s, e >= GLINT_NORMAL_OCTAHEDRAL && a == 2 ? 0 : n[a], i, encoded_bits[a]);
    }
    struct glint_encodings encodings = {.normal_space = space};
    if (at == 1) encodings.normal = e;
    else encodings.vertex_normal = e;
    /* The other images are in world space then, but are not tested here. */
    struct glint_capture *capture = encoded_capture(fixture_path(path, "normal.exr"), part, &encodings, pointers,
                                                    e >= GLINT_NORMAL_OCTAHEDRAL ? 2 : 3, s->type, s->name, &frame);
    assert_true(glint_part_has_channel(glint_capture_find(capture, part), names[2]));
    encoded_read(capture, part, pointers, 3, out);
    /* Half a step in each component rotates a unit normal by at most √3 half steps (1 for signed, 2 for unorm, whose scale is 2). The
       octahedral mapping stretches angles by at most 2√3 · 2: at the centre of a face |n| = 1/√3 of its L1 norm, where the slope is 3,
       its maximum; both components have errors. */
    const double stretch = e == GLINT_NORMAL_SIGNED ? sqrt(3) : e == GLINT_NORMAL_UNORM ? 2 * sqrt(3) : 2 * 3 * sqrt(2);
    for (size_t i = 0; i < COUNT; i++) {
        double cross = 0, length = 0, bound = stretch * half_step(s, 1) + 4 * ldexp(1, -23);
        /* The error in e is at most 2√2 half steps, in any direction. With |e| = sin(θ/2), that moves θ by 2 / cos(θ/2) times as much,
           and the azimuth's part of the normal by 2 cos(θ/2); within some steps of the rim of the disc, by 2 √(2 · error). */
        if (e == GLINT_NORMAL_SPHEREMAP) {
            const float *w = fixture.gbuffer + 17 * i + at;
            const double error = 2 * sqrt(2) * half_step(s, 1) + ldexp(1, -22);
            const double z = m[8] * (double)w[0] + m[9] * (double)w[1] + m[10] * (double)w[2];
            const double half = sqrt(fmax(0.5 + 0.5 * (frame.camera.view_to_clip[14] < 0 ? z : -z), 0));
            bound = fmin(2 * error / fmax(half - sqrt(2 * error), 1e-9), 4 * sqrt(2 * error)) + 4 * ldexp(1, -23);
        }
        for (int a = 0; a < 3; a++) {
            const double d = (double)out[3 * i + (size_t)a] - (double)fixture.gbuffer[17 * i + at + (size_t)a];
            cross += d * d;
            length += (double)out[3 * i + (size_t)a] * (double)out[3 * i + (size_t)a];
        }
        assert_true(fabs(length - 1) < 1e-6);
        if (!(sqrt(cross) <= bound))
            fail_msg("%s as %s, space %d: off by %.3g, bound %.3g", glint_encoding_name("normal", (int)e), s->name,
                     (int)space, sqrt(cross), bound);
    }
    close_and_remove(&capture, path);
}

static void normals(UNUSED void **state) {
    static const char *const families[] = {"normal", "vertexNormal"};
    for (int space = 0; space < 2; space++)
        for (int f = 0; f < 2; f++) {
            const enum glint_normal_space in = space ? GLINT_SPACE_VIEW : GLINT_SPACE_WORLD;
            const struct storage *any[] = {&SNORM8, &SNORM16, &R16F, &R32F};
            const struct storage *positive[] = {&UNORM8, &UNORM10, &UNORM16, &R16F, &R32F};
            for (size_t i = 0; i < 4; i++) check_normals(GLINT_NORMAL_SIGNED, in, any[i], families[f], "gbuffer");
            for (size_t i = 0; i < 5; i++) {
                check_normals(GLINT_NORMAL_UNORM, in, positive[i], families[f], "gbuffer");
                check_normals(GLINT_NORMAL_OCTAHEDRAL, in, positive[i], families[f], "gbuffer");
                check_normals(GLINT_NORMAL_SPHEREMAP, GLINT_SPACE_VIEW, positive[i], families[f], "gbuffer");
            }
        }
    check_normals(GLINT_NORMAL_OCTAHEDRAL, GLINT_SPACE_VIEW, &UNORM16, "normal", "previous.gbuffer");
}

/* ---- roughness ---- */

static double stored_roughness(enum glint_roughness_encoding e, double r) {
    switch (e) {
    case GLINT_ROUGHNESS_PERCEPTUAL:
        return r;
    case GLINT_ROUGHNESS_ALPHA:
        return r * r;
    case GLINT_ROUGHNESS_GLOSS:
        return 1 - r;
    case GLINT_ROUGHNESS_POWER:
        return 2 / pow(r, 4) - 2;
    case GLINT_ROUGHNESS_LOG2_POWER: /* the power 2^(10 v + 1) */
        return (log2(2 / pow(r, 4) - 2) - 1) / 10;
    }
    return NAN;
}

static double back_to_roughness(enum glint_roughness_encoding e, double v) {
    switch (e) {
    case GLINT_ROUGHNESS_PERCEPTUAL:
        return v;
    case GLINT_ROUGHNESS_ALPHA:
        return sqrt(fmax(v, 0));
    case GLINT_ROUGHNESS_GLOSS:
        return 1 - v;
    case GLINT_ROUGHNESS_POWER:
        return pow(2 / (fmax(v, 0) + 2), 0.25);
    case GLINT_ROUGHNESS_LOG2_POWER:
        return pow(2 / (pow(2, 10 * v + 1) + 2), 0.25);
    }
    return NAN;
}

static void check_roughness(enum glint_roughness_encoding e, const struct storage *s) {
    char path[512];
    static float out[COUNT];
    static const char *const names[] = {"material.roughness"};
    /* The smallest roughness whose power a half can hold: below r = 0.0743 it exceeds 65504. */
    const double lowest = e == GLINT_ROUGHNESS_POWER ? 0.08 : e == GLINT_ROUGHNESS_LOG2_POWER ? 0.18 : 0;
    /* Codes in [0, 1] stand for powers from 2 to 2048, r from 0.84 to 0.177. */
    const double highest = e == GLINT_ROUGHNESS_LOG2_POWER ? 0.84 : 1;
    double r[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        r[i] = fmin(fmax((double)fixture.gbuffer[17 * i + 4], lowest), highest);
        store(s, stored_roughness(e, r[i]), i, encoded_bits[0]);
    }
    const struct glint_encodings encodings = {.roughness = e};
    const struct glint_frame frame = fixture_frame();
    struct glint_capture *capture =
        encoded_capture(fixture_path(path, "roughness.exr"), "gbuffer", &encodings, names, 1, s->type, s->name, &frame);
    encoded_read(capture, "gbuffer", names, 1, out);
    for (size_t i = 0; i < COUNT; i++) {
        const double v = stored_roughness(e, r[i]), step = half_step(s, v);
        const double bound =
            fmax(fabs(back_to_roughness(e, v + step) - r[i]), fabs(back_to_roughness(e, v - step) - r[i])) +
            3 * ldexp(1, -24); /* float square roots and the subtraction */
        if (!(fabs((double)out[i] - r[i]) <= bound))
            fail_msg("%s as %s: %.9g decoded to %.9g, bound %.3g", glint_encoding_name("roughness", (int)e), s->name,
                     r[i], (double)out[i], bound);
    }
    close_and_remove(&capture, path);
}

static void roughness(UNUSED void **state) {
    const struct storage *all[] = {&UNORM8, &UNORM16, &R16F, &R32F};
    for (size_t i = 0; i < 4; i++)
        for (int e = 0; e < 3; e++) check_roughness((enum glint_roughness_encoding)e, all[i]);
    check_roughness(GLINT_ROUGHNESS_POWER, &R16F);
    check_roughness(GLINT_ROUGHNESS_POWER, &R32F);
    for (size_t i = 0; i < 4; i++) check_roughness(GLINT_ROUGHNESS_LOG2_POWER, all[i]);
}

/* ---- materials ---- */

/* Catches: surfaces that reflect although the engine draws no reflection on them, and others that lose theirs. */
static void rough_surfaces_reflect_nothing(UNUSED void **state) {
    char path[512];
    static float out[3 * COUNT];
    static const char *const names[] = {"material.metalness", "material.roughness", "material.specular"};
    const struct glint_encodings encodings = {.roughness = GLINT_ROUGHNESS_PERCEPTUAL};
    struct glint_frame frame = fixture_frame();
    for (int on = 0; on < 2; on++) {
        frame.has_material = on;
        frame.material = (struct glint_material_model){.metal_reflectance = 4, .roughest_reflection = 0.5};
        struct glint_capture *capture = encoded_capture(fixture_path(path, "materials.exr"), "gbuffer", &encodings,
                                                        NULL, 0, GLINT_F32, NULL, &frame);
        const struct glint_material_model *read = &glint_capture_frame(capture)->material;
        assert_int_equal(glint_capture_frame(capture)->has_material, on);
        if (on) assert_true(read->metal_reflectance == 4 && read->gloss_scale == 10 && read->gloss_offset == 1);
        encoded_read(capture, "gbuffer", names, 3, out);
        size_t masked = 0, kept = 0;
        for (size_t i = 0; i < COUNT; i++) {
            const float *w = fixture.gbuffer + 17 * i;
            const bool rough = on && out[3 * i + 1] >= 0.5f;
            assert_true(out[3 * i + 1] == w[4]);
            assert_true(out[3 * i] == (rough ? 0 : w[5]) && out[3 * i + 2] == (rough ? 0 : w[6]));
            masked += rough, kept += !rough;
        }
        assert_true(kept > 100 && (masked > 100) == on);
        close_and_remove(&capture, path);
    }
}

/* ---- motion ---- */

static void check_motion(enum glint_motion_encoding e, const struct storage *s, enum glint_clip_y clip_y) {
    char path[512];
    static float out[2 * COUNT];
    static const char *const names[] = {"motion.X", "motion.Y"};
    struct glint_frame frame = fixture_frame();
    frame.clip_y = clip_y;
    /* One uv in stored units. */
    double scale[2] = {1, 1};
    if (e == GLINT_MOTION_NDC) scale[0] = 2, scale[1] = clip_y == GLINT_CLIP_Y_UP ? -2 : 2;
    if (e == GLINT_MOTION_PIXELS) scale[0] = FIX_W, scale[1] = FIX_H;
    if (e == GLINT_MOTION_PACKED16) scale[0] = scale[1] = 32767 / frame.motion_range;
    for (size_t i = 0; i < COUNT; i++)
        for (int a = 0; a < 2; a++) {
            const double v = scale[a] * (double)fixture.gbuffer[17 * i + 10 + (size_t)a];
            if (e == GLINT_MOTION_PACKED16) ((uint16_t *)encoded_bits[a])[i] = (uint16_t)lround(v + 32768);
            else store(s, v, i, encoded_bits[a]);
        }
    const struct glint_encodings encodings = {.motion = e};
    struct glint_capture *capture = encoded_capture(fixture_path(path, "motion.exr"), "gbuffer", &encodings, names, 2,
                                                    e == GLINT_MOTION_PACKED16 ? GLINT_U16 : s->type, s->name, &frame);
    encoded_read(capture, "gbuffer", names, 2, out);
    for (size_t i = 0; i < COUNT; i++)
        for (int a = 0; a < 2; a++) {
            const double uv = (double)fixture.gbuffer[17 * i + 10 + (size_t)a], v = uv * scale[a];
            const double step = e == GLINT_MOTION_PACKED16 ? 0.5 : half_step(s, v);
            const double bound = step / fabs(scale[a]) * 1.000001 + fabs(uv) * ldexp(1, -23);
            if (!(fabs((double)out[2 * i + (size_t)a] - uv) <= bound))
                fail_msg("%s as %s: %.9g decoded to %.9g, bound %.3g", glint_encoding_name("motion", (int)e), s->name,
                         uv, (double)out[2 * i + (size_t)a], bound);
        }
    close_and_remove(&capture, path);
}

static void motion(UNUSED void **state) {
    const struct storage *all[] = {&R16F, &R32F};
    for (int y = 0; y < 2; y++)
        for (size_t i = 0; i < 2; i++)
            for (int e = 0; e < 4; e++)
                check_motion((enum glint_motion_encoding)e, all[i], y ? GLINT_CLIP_Y_DOWN : GLINT_CLIP_Y_UP);
}

/* ---- colour ---- */

static double stored_color(enum glint_color_encoding e, double c, double pre_exposure) {
    if (e == GLINT_COLOR_PRE_EXPOSED) return c * pre_exposure;
    if (e == GLINT_COLOR_LINEAR) return c;
    const double a = fabs(c), v = a <= 0.0031308 ? a * 12.92 : 1.055 * pow(a, 1 / 2.4) - 0.055;
    return copysign(v, c);
}

static double back_to_color(enum glint_color_encoding e, double v, double pre_exposure) {
    if (e == GLINT_COLOR_PRE_EXPOSED) return v / pre_exposure;
    if (e == GLINT_COLOR_LINEAR) return v;
    const double a = fabs(v);
    return copysign(a <= 0.04045 ? a / 12.92 : pow((a + 0.055) / 1.055, 2.4), v);
}

static void check_color(enum glint_color_encoding e, const struct storage *s, double brightest) {
    char path[512];
    static float out[3 * COUNT];
    static const char *const names[] = {"R", "G", "B"};
    const struct glint_frame frame = fixture_frame();
    for (size_t i = 0; i < COUNT; i++)
        for (size_t c = 0; c < 3; c++)
            store(s, stored_color(e, brightest * (double)fixture.color[4 * i + c], frame.pre_exposure), i,
                  encoded_bits[c]);
    const struct glint_encodings encodings = {.color = e};
    struct glint_capture *capture =
        encoded_capture(fixture_path(path, "color.exr"), "lit", &encodings, names, 3, s->type, s->name, &frame);
    encoded_read(capture, "lit", names, 3, out);
    for (size_t i = 0; i < COUNT; i++)
        for (size_t c = 0; c < 3; c++) {
            const double linear = brightest * (double)fixture.color[4 * i + c];
            const double v = stored_color(e, linear, frame.pre_exposure), step = half_step(s, v);
            /* powf in single precision is accurate to about an ulp, and 2.4 amplifies the rounding of its argument. Both sRGB segments
               meet within 4e-8. */
            const double bound = fmax(fabs(back_to_color(e, v + step, frame.pre_exposure) - linear),
                                      fabs(back_to_color(e, v - step, frame.pre_exposure) - linear)) *
                                     1.000001 +
                                 linear * 6 * ldexp(1, -24) + (e == GLINT_COLOR_SRGB ? 4e-8 : 0);
            if (!(fabs((double)out[3 * i + c] - linear) <= bound))
                fail_msg("%s as %s: %.9g decoded to %.9g, bound %.3g", glint_encoding_name("color", (int)e), s->name,
                         linear, (double)out[3 * i + c], bound);
        }
    close_and_remove(&capture, path);
}

static void color(UNUSED void **state) {
    const struct storage *all[] = {&R16F, &R32F};
    for (size_t i = 0; i < 2; i++)
        for (int e = 0; e < 3; e++) check_color((enum glint_color_encoding)e, all[i], 30);
    check_color(GLINT_COLOR_SRGB, &UNORM8, 1);
    check_color(GLINT_COLOR_SRGB, &UNORM10, 1);
    check_color(GLINT_COLOR_LINEAR, &UNORM16, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth),     cmocka_unit_test(normals),
        cmocka_unit_test(roughness), cmocka_unit_test(rough_surfaces_reflect_nothing),
        cmocka_unit_test(motion),    cmocka_unit_test(color),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
