/* Encodings of depth, normals, roughness, motion and colour, rounded where the storage format is not a plain type. */
#include "encode.h"

static double rounded_to(double value, double steps) {
    return floor(value * steps + 0.5) / steps;
}

enum { D24_STEPS = (1 << 24) - 1, TEN_BIT_STEPS = 1023 };

float encode_depth(enum glint_depth_encoding encoding, const struct view *view, float depth) {
    const double *m = view->camera.view_to_clip, z = (double)depth;
    bool sky = !(depth < INFINITY);
    double logarithm = sky ? 1 : log(z / VIEW_NEAR) / log(VIEW_FAR / VIEW_NEAR);
    switch (encoding) {
    case GLINT_DEPTH_VIEW_LINEAR:
        return depth;
    case GLINT_DEPTH_DEVICE:
        return (float)(sky ? 1 : rounded_to(-m[10] + m[11] / z, D24_STEPS));
    case GLINT_DEPTH_REVERSED:
    case GLINT_DEPTH_REVERSED_INFINITE:
        return (float)(sky ? 0 : -m[10] + m[11] / z);
    case GLINT_DEPTH_LOGARITHMIC:
        return (float)rounded_to(logarithm, D24_STEPS);
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        return (float)rounded_to(1 - logarithm, D24_STEPS);
    }
    return depth;
}

struct storage storage_depth(enum glint_depth_encoding encoding) {
    static const char *const names[] = {"R32F", "D24", "D32F", "D32F", "D24", "D24"};
    return (struct storage){GLINT_F32, names[encoding]};
}

static vec3 to_view(const struct view *view, vec3 n) {
    const double *m = view->camera.world_to_view, in[3] = {(double)n.x, (double)n.y, (double)n.z};
    double out[3];
    for (int i = 0; i < 3; i++) out[i] = m[4 * i] * in[0] + m[4 * i + 1] * in[1] + m[4 * i + 2] * in[2];
    return v3((float)out[0], (float)out[1], (float)out[2]);
}

static float sign_of(float v) {
    return v < 0 ? -1.0f : 1.0f;
}

vec3 encode_normal(enum glint_normal_encoding encoding, enum glint_normal_space space, const struct view *view,
                   vec3 normal) {
    vec3 n = unit(normal);
    if (space == GLINT_SPACE_VIEW || encoding == GLINT_NORMAL_VIEW_XY || encoding == GLINT_NORMAL_SPHEREMAP)
        n = to_view(view, n);
    if (encoding == GLINT_NORMAL_VIEW_XY) {
        /* A normal that faces away, as normals near the border of the image may, is moved to the rim of the hemisphere. */
        if (n.z < 0) n = unit(v3(n.x, n.y, 0));
        return v3(0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0);
    }
    if (encoding == GLINT_NORMAL_SPHEREMAP) {
        const float flat = sqrtf(n.x * n.x + n.y * n.y), half = sqrtf(fmaxf((1 - n.z) / 2, 0)),
                    wide = flat > 0 ? half / flat : 0;
        return v3(0.5f + 0.5f * wide * n.x, 0.5f + 0.5f * wide * n.y, 0);
    }
    if (encoding == GLINT_NORMAL_UNORM) {
        vec3 u = scale(add(n, gray(1)), 0.5f);
        return v3((float)rounded_to((double)u.x, TEN_BIT_STEPS), (float)rounded_to((double)u.y, TEN_BIT_STEPS),
                  (float)rounded_to((double)u.z, TEN_BIT_STEPS));
    }
    if (encoding != GLINT_NORMAL_OCTAHEDRAL) return n;
    float sum = fabsf(n.x) + fabsf(n.y) + fabsf(n.z);
    float x = n.x / sum, y = n.y / sum;
    if (n.z < 0) {
        float folded = (1 - fabsf(y)) * sign_of(x);
        y = (1 - fabsf(x)) * sign_of(y);
        x = folded;
    }
    return v3(0.5f + 0.5f * x, 0.5f + 0.5f * y, 0);
}

struct storage storage_normal(enum glint_normal_encoding encoding) {
    static const struct storage of[] = {{GLINT_F16, "RGBA16F"},
                                        {GLINT_F32, "R10G10B10A2"},
                                        {GLINT_UNORM16, "RG16"},
                                        {GLINT_UNORM8, "RG8"},
                                        {GLINT_UNORM8, "RG8"}};
    return of[encoding];
}

float encode_roughness(enum glint_roughness_encoding encoding, float roughness) {
    double r = (double)roughness, power;
    switch (encoding) {
    case GLINT_ROUGHNESS_PERCEPTUAL:
        return roughness;
    case GLINT_ROUGHNESS_ALPHA:
        return (float)(r * r);
    case GLINT_ROUGHNESS_GLOSS:
        return 1 - roughness;
    case GLINT_ROUGHNESS_POWER:
        power = 2 / (r * r * r * r) - 2;
        return (float)fmin(power, 3e38); /* the power of a mirror is infinite */
    case GLINT_ROUGHNESS_LOG2_POWER:
        power = 2 / (r * r * r * r) - 2;
        return (float)fmin(fmax((log2(power) - 1) / 10, 0), 1); /* 8 bits, from a power of 2 to one of 2048 */
    }
    return roughness;
}

struct storage storage_roughness(enum glint_roughness_encoding encoding) {
    static const struct storage of[] = {
        {GLINT_F16, "R16F"}, {GLINT_F16, "R16F"}, {GLINT_UNORM8, "R8"}, {GLINT_F32, "R32F"}, {GLINT_UNORM8, "R8"}};
    return of[encoding];
}

void encode_motion(enum glint_motion_encoding encoding, const struct view *view, const float uv[2], float out[2]) {
    const float factors[][2] = {[GLINT_MOTION_UV] = {1, 1},
                                [GLINT_MOTION_NDC] = {2, -2},
                                [GLINT_MOTION_PIXELS] = {(float)view->width, (float)view->height},
                                [GLINT_MOTION_PACKED16] = {32767, 32767}};
    for (int i = 0; i < 2; i++) {
        out[i] = uv[i] * factors[encoding][i];
        if (encoding == GLINT_MOTION_PACKED16) out[i] = clampf(floorf(out[i] + 0.5f) + 32768, 1, 65535);
    }
}

struct storage storage_motion(enum glint_motion_encoding encoding) {
    if (encoding == GLINT_MOTION_PACKED16) return (struct storage){GLINT_U16, "RG16"};
    return (struct storage){GLINT_F16, "RG16F"};
}

float encode_motion_depth(enum glint_motion_depth_encoding encoding, float metres) {
    if (encoding != GLINT_MOTION_DEPTH_PACKED16) return metres;
    return clampf(floorf(metres / (float)MOTION_DEPTH_RANGE * 32767 + 0.5f) + 32768, 1, 65535);
}

struct storage storage_motion_depth(enum glint_motion_depth_encoding encoding) {
    if (encoding == GLINT_MOTION_DEPTH_PACKED16) return (struct storage){GLINT_U16, "R16"};
    return (struct storage){GLINT_F16, "R16F"};
}

static float srgb(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
}

vec3 encode_color(enum glint_color_encoding encoding, double pre_exposure, vec3 color) {
    if (encoding == GLINT_COLOR_PRE_EXPOSED) return scale(color, (float)pre_exposure);
    if (encoding == GLINT_COLOR_SRGB) return v3(srgb(color.x), srgb(color.y), srgb(color.z));
    return color;
}
