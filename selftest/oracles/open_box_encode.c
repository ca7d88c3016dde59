/* The box's numbers as an engine stores them, from FORMAT.md. */
#include <math.h>

#include "oracles/open_box_internal.h"

static bool is_reversed(const struct open_box *c) {
    return c->encodings.depth == GLINT_DEPTH_REVERSED || c->encodings.depth == GLINT_DEPTH_REVERSED_INFINITE;
}

/* The depth buffer in [0, 1], d = a + b / depth; near at one end and far at the other. */
static void buffer_depth(const struct open_box *c, double *a, double *b) {
    const double near = c->near_m, part = near / c->far_m; /* 0 without a far plane */
    *a = 1 / (1 - part);
    *b = -near / (1 - part);
    if (is_reversed(c)) *a = -part / (1 - part), *b = near / (1 - part);
}

void open_box_clip_depth(const struct open_box *c, double *a, double *b) {
    buffer_depth(c, a, b);
    if (c->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE) *a = 2 * *a - 1, *b = 2 * *b;
}

static double encode_depth(const struct open_box *c, double depth) {
    double a, b;
    switch (c->encodings.depth) {
    case GLINT_DEPTH_VIEW_LINEAR:
        return depth * c->scale / c->metres_per_unit;
    case GLINT_DEPTH_LOGARITHMIC:
        return depth < INFINITY ? log(depth / c->near_m) / log(c->far_m / c->near_m) : 1;
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        return depth < INFINITY ? 1 - log(depth / c->near_m) / log(c->far_m / c->near_m) : 0;
    default:
        buffer_depth(c, &a, &b);
        return depth < INFINITY ? a + b / depth : is_reversed(c) ? 0 : 1;
    }
}

float open_box_encode_depth(const struct open_box *box, double depth) {
    const struct open_box c = open_box_filled(box);
    const double value = encode_depth(&c, depth), steps = exp2(c.depth_bits) - 1;
    return (float)(c.depth_bits ? floor(value * steps + 0.5) / steps : value);
}

double open_box_decode_depth(const struct open_box *box, double stored) {
    const struct open_box c = open_box_filled(box);
    double a, b;
    switch (c.encodings.depth) {
    case GLINT_DEPTH_VIEW_LINEAR:
        return stored / c.scale * c.metres_per_unit;
    case GLINT_DEPTH_LOGARITHMIC:
        return stored < 1 ? c.near_m * pow(c.far_m / c.near_m, stored) : INFINITY;
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        return stored > 0 ? c.near_m * pow(c.far_m / c.near_m, 1 - stored) : INFINITY;
    default:
        buffer_depth(&c, &a, &b);
        return is_reversed(&c) ? stored > 0 ? b / (stored - a) : INFINITY : stored < 1 ? b / (stored - a) : INFINITY;
    }
}

double open_box_depth_step(const struct open_box *box, double depth) {
    const double stored = (double)open_box_encode_depth(box, depth);
    const double half = box->depth_bits ? 0.5 / (exp2(box->depth_bits) - 1) : fabs(stored) * exp2(-24); /* at most */
    const double here = open_box_decode_depth(box, stored);
    return fmax(fabs(open_box_decode_depth(box, stored + half) - here),
                fabs(open_box_decode_depth(box, stored - half) - here));
}

void open_box_to_engine(const struct open_box *c, const double v[3], double out[3]) {
    for (int k = 0; k < 3; k++) {
        const int axis = c->axes[k] < 0 ? -c->axes[k] : c->axes[k];
        out[axis - 1] = c->axes[k] < 0 ? -v[k] : v[k];
    }
}

void open_box_view_rows(const struct open_box *c, double rows[3][3]) {
    double axes[3][3];
    open_box_camera_axes(c, axes[0], axes[1], axes[2]);
    const double sign[3] = {c->x_left ? -1 : 1, c->y_down ? -1 : 1, c->depth_grows ? 1 : -1};
    for (int r = 0; r < 3; r++) {
        open_box_to_engine(c, axes[r], rows[r]);
        for (int k = 0; k < 3; k++) rows[r][k] *= sign[r];
    }
}

void open_box_encode_normal(const struct open_box *c, const double normal[3], double out[3]) {
    double n[3], v[3] = {0}, rows[3][3];
    const enum glint_normal_encoding encoding = c->encodings.normal;
    open_box_to_engine(c, normal, n);
    if (c->encodings.normal_space == GLINT_SPACE_VIEW || encoding == GLINT_NORMAL_VIEW_XY ||
        encoding == GLINT_NORMAL_SPHEREMAP) {
        open_box_view_rows(c, rows);
        for (int r = 0; r < 3; r++)
            for (int k = 0; k < 3; k++) v[r] += rows[r][k] * n[k];
        for (int k = 0; k < 3; k++) n[k] = v[k];
    }
    if (encoding == GLINT_NORMAL_SPHEREMAP) { /* the angle from the camera's side of view space, halved */
        const double half = acos(fmax(-1, fmin(1, (c->depth_grows ? -1 : 1) * n[2]))) / 2, flat = hypot(n[0], n[1]);
        for (int k = 0; k < 2; k++) out[k] = 0.5 + 0.5 * (flat > 0 ? sin(half) * n[k] / flat : 0);
        out[2] = 0;
        return;
    }
    const double sum = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
    for (int k = 0; k < 3; k++) out[k] = encoding == GLINT_NORMAL_SIGNED ? n[k] : 0.5 + 0.5 * n[k];
    if (encoding != GLINT_NORMAL_OCTAHEDRAL) return;
    for (int k = 0; k < 2; k++) {
        double place = n[k] / sum;
        if (n[2] < 0) place = (1 - fabs(n[1 - k]) / sum) * (n[k] < 0 ? -1 : 1);
        out[k] = 0.5 + 0.5 * place;
    }
}

double open_box_encode_roughness(const struct open_box *c, double r) {
    switch (c->encodings.roughness) {
    case GLINT_ROUGHNESS_ALPHA:
        return r * r;
    case GLINT_ROUGHNESS_GLOSS:
        return 1 - r;
    case GLINT_ROUGHNESS_POWER:
        return 2 / (r * r * r * r) - 2; /* infinite for a mirror */
    case GLINT_ROUGHNESS_LOG2_POWER:    /* power 2^(10 v + 1), as read where nothing else is said */
        return (log2(2 / (r * r * r * r) - 2) - 1) / 10;
    default:
        return r;
    }
}

void open_box_encode_color(const struct open_box *c, double rgb[3]) {
    for (int k = 0; k < 3; k++) {
        if (c->encodings.color == GLINT_COLOR_PRE_EXPOSED) rgb[k] *= c->pre_exposure;
        if (c->encodings.color == GLINT_COLOR_SRGB)
            rgb[k] = rgb[k] <= 0.0031308 ? 12.92 * rgb[k] : 1.055 * pow(rgb[k], 1 / 2.4) - 0.055;
    }
}

void open_box_encode_motion(const struct open_box *c, const double uv[2], double depth_m, double out[3]) {
    const double down = c->clip_y == GLINT_CLIP_Y_DOWN ? 2 : -2;
    const double factors[4][2] = {{1, 1}, {2, down}, {c->width, c->height}, {32767, 32767}};
    for (int k = 0; k < 2; k++) {
        out[k] = uv[k] * factors[c->encodings.motion][k];
        if (c->encodings.motion == GLINT_MOTION_PACKED16) out[k] = floor(out[k] + 0.5) + 32768;
    }
    out[2] = depth_m * c->scale / c->metres_per_unit;
    if (c->encodings.motion_depth == GLINT_MOTION_DEPTH_PACKED16) out[2] = floor(out[2] * 32767 + 0.5) + 32768;
}
