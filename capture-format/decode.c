/* Decodes each encoding to canonical values. FORMAT.md states the formulas and their precision. */
#include <Imath/half.h>
#include <math.h>
#include <string.h>

#include "capture_internal.h"
#include "glint/exr.h"

void glint_decode_widen(enum glint_stored stored, const uint8_t *in, size_t count, float *out) {
    if (stored == GLINT_STORED_FLOAT) {
        memcpy(out, in, count * 4);
        return;
    }
    uint16_t half[GLINT_BLOCK];
    memcpy(half, in, count * 2);
    for (size_t i = 0; i < count; i++) out[i] = imath_half_to_float(half[i]);
}

/* z_clip = A·z + B and w = s·z for view z, so a depth-buffer value d = A·s + B/t at distance t = s·z in front. */
static void decode_device(const struct glint_decoder *d, bool sky_at_zero, float *v, size_t count) {
    const double *m = d->camera->view_to_clip, unit = d->frame->metres_per_unit;
    const bool symmetric = d->frame->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE;
    const double scale = symmetric ? 2 : 1, bias = (symmetric ? -1 : 0) - m[10] * m[14], b = m[11] * unit;
    for (size_t i = 0; i < count; i++) {
        const double value = (double)v[i], t = b / (value * scale + bias);
        const bool sky = sky_at_zero ? value <= 0 : value >= 1;
        /* Beyond infinity the distance would be negative. */
        v[i] = sky || t <= 0 ? INFINITY : (float)t;
    }
}

/* Computed from the end that is stored as 0, where a float is precise; 1 minus the value would not be. */
static void decode_logarithmic(const struct glint_decoder *d, bool reversed, float *v, size_t count) {
    const double near = d->frame->depth_near, far = d->frame->depth_far, span = log(far / near);
    const double start = (reversed ? far : near) * d->frame->metres_per_unit, factor = reversed ? -span : span;
    for (size_t i = 0; i < count; i++) {
        const bool sky = reversed ? v[i] <= 0 : v[i] >= 1;
        v[i] = sky ? INFINITY : (float)(start * exp((double)v[i] * factor));
    }
}

void glint_decode_depth(const struct glint_decoder *d, float *v, size_t count) {
    switch (d->encodings.depth) {
    case GLINT_DEPTH_VIEW_LINEAR:
        glint_decode_length(d, v, count);
        break;
    case GLINT_DEPTH_DEVICE:
        decode_device(d, false, v, count);
        break;
    case GLINT_DEPTH_REVERSED:
    case GLINT_DEPTH_REVERSED_INFINITE:
        decode_device(d, true, v, count);
        break;
    case GLINT_DEPTH_LOGARITHMIC:
        decode_logarithmic(d, false, v, count);
        break;
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        decode_logarithmic(d, true, v, count);
        break;
    }
}

void glint_decode_length(const struct glint_decoder *d, float *v, size_t count) {
    const double unit = d->frame->metres_per_unit;
    if (unit == 1) return;
    for (size_t i = 0; i < count; i++) v[i] = (float)((double)v[i] * unit);
}

/* A frame without the group has its fallbacks. */
static struct glint_material_model material_of(const struct glint_decoder *d) {
    const struct glint_material_model usual = {.gloss_scale = 10, .gloss_offset = 1};
    return d->frame->has_material ? d->frame->material : usual;
}

void glint_decode_roughness(const struct glint_decoder *d, float *v, size_t count) {
    switch (d->encodings.roughness) {
    case GLINT_ROUGHNESS_PERCEPTUAL:
        break;
    case GLINT_ROUGHNESS_ALPHA:
        for (size_t i = 0; i < count; i++) v[i] = sqrtf(v[i] < 0 ? 0 : v[i]);
        break;
    case GLINT_ROUGHNESS_GLOSS:
        for (size_t i = 0; i < count; i++) v[i] = 1 - v[i];
        break;
    case GLINT_ROUGHNESS_POWER:
        for (size_t i = 0; i < count; i++) v[i] = sqrtf(sqrtf(2 / ((v[i] < 0 ? 0 : v[i]) + 2)));
        break;
    case GLINT_ROUGHNESS_LOG2_POWER:
        for (size_t i = 0; i < count; i++)
            v[i] = (float)sqrt(
                sqrt(2 / (exp2(material_of(d).gloss_scale * (double)v[i] + material_of(d).gloss_offset) + 2)));
        break;
    }
}

void glint_decode_motion(const struct glint_decoder *d, int axis, float *v, size_t count) {
    float scale = 1;
    if (d->encodings.motion == GLINT_MOTION_NDC)
        scale = axis == 1 && d->frame->clip_y == GLINT_CLIP_Y_UP ? -0.5f : 0.5f;
    if (d->encodings.motion == GLINT_MOTION_PIXELS) {
        const float size = (float)(axis == 0 ? d->width : d->height);
        for (size_t i = 0; i < count; i++) v[i] /= size;
    }
    if (scale == 1) return;
    for (size_t i = 0; i < count; i++) v[i] *= scale;
}

void glint_decode_motion_packed(const struct glint_decoder *d, int axis, const uint32_t *in, float *v, size_t count) {
    const double scale =
        (axis == 2 ? d->frame->motion_depth_range * d->frame->metres_per_unit : d->frame->motion_range) / 32767;
    for (size_t i = 0; i < count; i++) v[i] = (float)(((double)in[i] - 32768) * scale);
}

/* x to the power of 2.4. The rounding of 2.4 to float would be noticeable for x in the thousands. */
float glint_linear_of_srgb(float value) {
    const float magnitude = fabsf(value), base = (magnitude + 0.055f) / 1.055f;
    const float linear = magnitude <= 0.04045f ? magnitude / 12.92f : base * base * powf(base, 0.4f);
    return copysignf(linear, value);
}

void glint_decode_color(const struct glint_decoder *d, float *v, size_t count) {
    const double factor = 1 / d->frame->pre_exposure;
    if (d->encodings.color == GLINT_COLOR_PRE_EXPOSED && factor != 1)
        for (size_t i = 0; i < count; i++) v[i] = (float)((double)v[i] * factor);
    if (d->encodings.color == GLINT_COLOR_SRGB)
        for (size_t i = 0; i < count; i++) v[i] = glint_linear_of_srgb(v[i]);
}

/* ---- normals ---- */

static void from_octahedral(float *const n[3], size_t count) {
    for (size_t i = 0; i < count; i++) {
        const float x = 2 * n[0][i] - 1, y = 2 * n[1][i] - 1, z = 1 - fabsf(x) - fabsf(y), fold = z < 0 ? -z : 0;
        n[0][i] = x - copysignf(fold, x);
        n[1][i] = y - copysignf(fold, y);
        n[2][i] = z;
    }
}

/* The direction towards the camera is the side of view space that is behind it. */
static void from_view_xy(const struct glint_decoder *d, float *const n[3], size_t count) {
    const float side = d->camera->view_to_clip[14] < 0 ? 1 : -1;
    for (size_t i = 0; i < count; i++) {
        n[0][i] = 2 * n[0][i] - 1;
        n[1][i] = 2 * n[1][i] - 1;
        n[2][i] = side * sqrtf(fmaxf(1 - n[0][i] * n[0][i] - n[1][i] * n[1][i], 0));
    }
}

/* With half the angle θ from the direction towards the camera: |e| = sin(θ/2). Codes outside of the disc are moved to its rim. */
static void from_spheremap(const struct glint_decoder *d, float *const n[3], size_t count) {
    const float side = d->camera->view_to_clip[14] < 0 ? 1 : -1;
    for (size_t i = 0; i < count; i++) {
        const float x = 2 * n[0][i] - 1, y = 2 * n[1][i] - 1, square = fminf(x * x + y * y, 1);
        const float wide = 2 * sqrtf(1 - square);
        n[0][i] = wide * x;
        n[1][i] = wide * y;
        n[2][i] = side * (1 - 2 * square);
    }
}

static bool is_of_view(enum glint_normal_encoding encoding) {
    return encoding == GLINT_NORMAL_VIEW_XY || encoding == GLINT_NORMAL_SPHEREMAP;
}

static void to_world(const double *m, float *const n[3], size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double x = (double)n[0][i], y = (double)n[1][i], z = (double)n[2][i];
        for (int axis = 0; axis < 3; axis++) n[axis][i] = (float)(m[axis] * x + m[4 + axis] * y + m[8 + axis] * z);
    }
}

void glint_decode_normal(const struct glint_decoder *d, enum glint_normal_encoding encoding, float *const n[3],
                         float *lengths, size_t count) {
    if (encoding == GLINT_NORMAL_UNORM)
        for (int axis = 0; axis < 3; axis++)
            for (size_t i = 0; i < count; i++) n[axis][i] = 2 * n[axis][i] - 1;
    if (encoding == GLINT_NORMAL_OCTAHEDRAL) from_octahedral(n, count);
    if (encoding == GLINT_NORMAL_VIEW_XY) from_view_xy(d, n, count);
    if (encoding == GLINT_NORMAL_SPHEREMAP) from_spheremap(d, n, count);
    for (size_t i = 0; lengths && i < count; i++)
        lengths[i] = encoding == GLINT_NORMAL_OCTAHEDRAL && isfinite(n[2][i])
                         ? 1
                         : sqrtf(n[0][i] * n[0][i] + n[1][i] * n[1][i] + n[2][i] * n[2][i]);
    if (d->encodings.normal_space == GLINT_SPACE_VIEW || is_of_view(encoding))
        to_world(d->camera->world_to_view, n, count);
    for (size_t i = 0; i < count; i++) {
        const float square = n[0][i] * n[0][i] + n[1][i] * n[1][i] + n[2][i] * n[2][i];
        const float scale = square > 0 && square < INFINITY ? 1 / sqrtf(square) : 1;
        for (int axis = 0; axis < 3; axis++) n[axis][i] *= scale;
    }
}
