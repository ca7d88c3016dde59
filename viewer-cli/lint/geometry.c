/* Decodes positions, normals and motion under a reading. The formulas are those of FORMAT.md. */
#include <math.h>
#include <string.h>

#include "lint.h"

struct lint_reading lint_declared(const struct lint_data *data) {
    struct lint_reading r = {.depth = data->encodings.depth,
                             .depth_scale = 1,
                             .normal = data->encodings.normal,
                             .space = data->encodings.normal_space,
                             .normal_sign = {1, 1, 1},
                             .normal_axis = {0, 1, 2},
                             .motion = data->encodings.motion,
                             .motion_sign = {1, 1},
                             .clip_y = data->frame.clip_y,
                             .clip_z = data->frame.clip_z,
                             .view_sign = {1, 1, 1},
                             .cube_scale = 1,
                             .center_scale = 1,
                             .lit = data->lit_encoding,
                             .cube = data->cube_encoding,
                             .sky = data->sky_encoding,
                             .sky_scale = 1};
    for (int f = 0; f < 6; f++) r.face[f] = r.sky_face[f] = f;
    return r;
}

/* A rotation stored in floats is orthonormal only to 1e-7: far from the origin its transpose would misplace the eye, so it is inverted. */
static void invert(const double m[9], double out[9]) {
    double det = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out[3 * i + k] = m[3 * a + c] * m[3 * b + d] - m[3 * a + d] * m[3 * b + c];
        }
    for (int k = 0; k < 3; k++) det += m[k] * out[3 * k];
    for (int i = 0; i < 9; i++) out[i] /= det;
}

static struct lint_view view_of(const struct glint_camera *camera, const struct lint_reading *reading) {
    const double *m = camera->world_to_view, *p = camera->view_to_clip;
    struct lint_view v = {.a = p[0], .b = p[5], .c = p[2], .d = p[6], .A = p[10], .B = p[11], .s = p[14]};
    const double translation[3] = {m[3], m[7], m[11]};
    double *stored = reading->inverse_camera ? v.inverse : v.rotation;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            stored[3 * i + k] = (reading->inverse_camera ? 1 : reading->view_sign[i]) * m[4 * i + k];
    invert(stored, reading->inverse_camera ? v.rotation : v.inverse);
    /* The eye is the origin of view space; a stored inverse has it as its translation. */
    if (reading->inverse_camera) memcpy(v.position, translation, sizeof translation);
    else glint_camera_position(camera, v.position);
    return v;
}

struct lint_eyes lint_eyes_of(const struct lint_data *data, const struct lint_reading *reading) {
    const struct glint_camera *now = &data->frame.camera,
                              *before = data->frame.has_previous ? &data->frame.previous : now;
    struct lint_reading current = *reading;
    current.inverse_camera = reading->inverse_camera != reading->inverse_current;
    return (struct lint_eyes){view_of(reading->swapped_cameras ? before : now, &current),
                              view_of(reading->swapped_cameras ? now : before, reading)};
}

/* The view-space direction through a pixel position, scaled so that its z is s. */
static void view_ray(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                     double x, double y, double out[3]) {
    const double up = reading->clip_y == GLINT_CLIP_Y_UP ? 1 : -1;
    const double ndc_x = 2 * x / data->width - 1, ndc_y = up * (1 - 2 * y / data->height);
    out[0] = (ndc_x - view->c * view->s) / view->a;
    out[1] = (ndc_y - view->d * view->s) / view->b;
    out[2] = view->s;
}

/* Converts NDC z to the value in the depth buffer. */
static double stored_of(const struct lint_reading *reading, double z) {
    return reading->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? (z + 1) / 2 : z;
}

static bool decode_depth(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                         double v, double *depth) {
    const bool reversed = reading->depth == GLINT_DEPTH_REVERSED || reading->depth == GLINT_DEPTH_REVERSED_INFINITE ||
                          reading->depth == GLINT_DEPTH_LOGARITHMIC_REVERSED;
    /* the depth encoding must fit the projection: reversed or not, with or without a far plane */
    const bool projected = reading->depth == GLINT_DEPTH_DEVICE || reading->depth == GLINT_DEPTH_REVERSED ||
                           reading->depth == GLINT_DEPTH_REVERSED_INFINITE;
    if (projected && (view->B > 0) != reversed) return false;
    if (reading->depth == GLINT_DEPTH_REVERSED_INFINITE && fabs(stored_of(reading, view->A * view->s)) > 1e-5)
        return false;
    if (reading->depth == GLINT_DEPTH_VIEW_LINEAR) *depth = v * reading->depth_scale;
    else if (reversed ? v <= 0 : v >= 1) return false;
    else if (reading->depth == GLINT_DEPTH_LOGARITHMIC || reading->depth == GLINT_DEPTH_LOGARITHMIC_REVERSED) {
        const double near = data->frame.depth_near, far = data->frame.depth_far;
        if (!(near > 0 && far > near)) return false;
        *depth = near * pow(far / near, reversed ? 1 - v : v);
    } else {
        const double z = reading->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? 2 * v - 1 : v;
        *depth = view->B / (z - view->A * view->s);
    }
    return isfinite(*depth) && *depth > 0;
}

static bool depth_in(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                     const float *image, uint32_t x, uint32_t y, double *depth) {
    const double v = (double)image[(size_t)y * data->width + x];
    if (!decode_depth(data, reading, view, v, depth)) return false;
    if (reading->radial) {
        double r[3];
        view_ray(data, reading, view, x + 0.5, y + 0.5, r);
        *depth /= sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    }
    return true;
}

bool lint_depth(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                uint32_t x, uint32_t y, double *depth) {
    return depth_in(data, reading, view, reading->swapped_depth ? data->before_depth : data->depth, x, y, depth);
}

bool lint_is_sky(const struct lint_data *data, const struct lint_reading *reading, uint32_t x, uint32_t y) {
    const double v = (double)(reading->swapped_depth ? data->before_depth : data->depth)[(size_t)y * data->width + x];
    switch (reading->depth) {
    case GLINT_DEPTH_VIEW_LINEAR:
        return isinf(v) && v > 0;
    case GLINT_DEPTH_REVERSED:
    case GLINT_DEPTH_REVERSED_INFINITE:
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        return v <= 0;
    default:
        return v >= 1;
    }
}

bool lint_depth_before(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                       uint32_t x, uint32_t y, double *depth) {
    struct lint_reading own = *reading;
    if (data->before_encoding != data->encodings.depth) own.depth = data->before_encoding;
    return depth_in(data, &own, view, reading->swapped_depth ? data->depth : data->before_depth, x, y, depth);
}

double lint_depth_error(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        uint32_t x, uint32_t y, double depth) {
    const double h = (double)data->depth_half_step[(size_t)y * data->width + x];
    switch (reading->depth) {
    case GLINT_DEPTH_VIEW_LINEAR:
        return h * reading->depth_scale;
    case GLINT_DEPTH_LOGARITHMIC:
    case GLINT_DEPTH_LOGARITHMIC_REVERSED:
        return h * depth * log(data->frame.depth_far / data->frame.depth_near);
    default:
        return h * depth * depth / fabs(view->B) * (reading->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? 2 : 1);
    }
}

void lint_view_position(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        double x, double y, double depth, double out[3]) {
    view_ray(data, reading, view, x, y, out);
    for (int i = 0; i < 3; i++) out[i] *= depth;
}

static void turn_to_world(const struct lint_view *view, const double in[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = 0;
        for (int k = 0; k < 3; k++) out[i] += view->inverse[3 * i + k] * in[k];
    }
}

void lint_to_world(const struct lint_view *view, const double in[3], double out[3]) {
    turn_to_world(view, in, out);
    for (int i = 0; i < 3; i++) out[i] += view->position[i];
}

bool lint_project(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                  const double world[3], double out[2], double *depth) {
    double v[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) v[i] += view->rotation[3 * i + k] * (world[k] - view->position[k]);
    const double w = view->s * v[2], up = reading->clip_y == GLINT_CLIP_Y_UP ? 1 : -1;
    if (!(w > 1e-9)) return false;
    *depth = w;
    out[0] = ((view->a * v[0] + view->c * v[2]) / w + 1) / 2 * data->width;
    out[1] = (1 - up * (view->b * v[1] + view->d * v[2]) / w) / 2 * data->height;
    return isfinite(out[0]) && isfinite(out[1]);
}

static double sign_of(double v) {
    return v < 0 ? -1 : 1;
}

static void decode_normal(const struct lint_reading *reading, const double *v, const struct lint_view *view,
                          double n[3]) {
    const double x = v[0], y = v[1];
    switch (reading->normal) {
    case GLINT_NORMAL_SIGNED:
    case GLINT_NORMAL_UNORM:
        for (int i = 0; i < 3; i++) n[i] = reading->normal == GLINT_NORMAL_UNORM ? 2 * v[i] - 1 : v[i];
        break;
    case GLINT_NORMAL_OCTAHEDRAL:
        n[0] = 2 * x - 1;
        n[1] = 2 * y - 1;
        n[2] = 1 - fabs(n[0]) - fabs(n[1]);
        if (n[2] < 0) {
            const double p = n[0];
            n[0] = (1 - fabs(n[1])) * sign_of(p);
            n[1] = (1 - fabs(p)) * sign_of(n[1]);
        }
        break;
    case GLINT_NORMAL_VIEW_XY:
        n[0] = 2 * x - 1;
        n[1] = 2 * y - 1;
        n[2] = -view->s * sqrt(fmax(0, 1 - n[0] * n[0] - n[1] * n[1]));
        break;
    case GLINT_NORMAL_SPHEREMAP: {
        const double e[2] = {2 * x - 1, 2 * y - 1}, square = fmin(e[0] * e[0] + e[1] * e[1], 1);
        for (int i = 0; i < 2; i++) n[i] = 2 * e[i] * sqrt(1 - square);
        n[2] = -view->s * (1 - 2 * square);
        break;
    }
    }
}

/* Decodes stored values to a unit normal in world space. */
static bool normal_of(const struct lint_reading *reading, const struct lint_view *view, const double v[3],
                      double out[3]) {
    double stored[3] = {0, 0, 0}, n[3];
    decode_normal(reading, v, view, stored);
    for (int i = 0; i < 3; i++) n[i] = stored[reading->normal_axis[i]] * reading->normal_sign[i];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 1e-6) || !isfinite(length)) return false;
    for (int i = 0; i < 3; i++) n[i] /= length;
    if (reading->space == GLINT_SPACE_VIEW || reading->normal >= GLINT_NORMAL_VIEW_XY) turn_to_world(view, n, out);
    else memcpy(out, n, sizeof n);
    return true;
}

static const float *stored_normal(const struct lint_data *data, const struct lint_reading *reading, size_t pixel) {
    const size_t y = pixel / data->width, row = reading->normal_upside_down ? data->height - 1 - y : y;
    return data->normal + 3 * (row * data->width + pixel % data->width);
}

bool lint_normal(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                 size_t pixel, double out[3]) {
    const bool two = reading->normal >= GLINT_NORMAL_OCTAHEDRAL; /* without Z */
    const float *v = stored_normal(data, reading, pixel);
    return two == data->two_channels && normal_of(reading, view, (const double[]){v[0], v[1], v[2]}, out);
}

double lint_normal_rounding(const struct lint_data *data, const struct lint_reading *reading,
                            const struct lint_view *view, size_t pixel, const double normal[3]) {
    const float *v = stored_normal(data, reading, pixel);
    const double h = data->normal_half_step;
    double least = 1, n[3];
    for (int corner = 0; corner < 8; corner++) {
        const double moved[3] = {v[0] + (corner & 1 ? h : -h), v[1] + (corner & 2 ? h : -h),
                                 v[2] + (corner & 4 ? h : -h)};
        if (!normal_of(reading, view, moved, n)) return -1;
        least = lint_smaller(least, n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2]);
    }
    return least;
}

void lint_from_center(const struct lint_data *data, const struct lint_reading *reading, size_t cube,
                      const double world[3], double out[3]) {
    for (int k = 0; k < 3; k++)
        out[k] = world[k] - reading->center_scale * data->cubes[cube].map.center[k] - reading->center_offset[cube][k];
}

void lint_motion(const struct lint_data *data, const struct lint_reading *reading, size_t pixel, double out[2]) {
    const double size[2] = {data->width, data->height};
    for (int i = 0; i < 2; i++) {
        double v = (double)data->motion[2 * pixel + (size_t)i];
        if (reading->motion == GLINT_MOTION_UV) v *= size[i];
        else if (reading->motion == GLINT_MOTION_NDC)
            v *= size[i] / 2 * (i && reading->clip_y == GLINT_CLIP_Y_UP ? -1 : 1);
        else if (reading->motion == GLINT_MOTION_PACKED16) v = (v - 32768) / 32767 * data->frame.motion_range * size[i];
        out[i] = v * reading->motion_sign[i];
    }
    if (!reading->motion_unjittered || (out[0] == 0 && out[1] == 0)) return; /* 0 may mean that no motion was written */
    const double *now = data->frame.camera.view_to_clip, *before = data->frame.previous.view_to_clip;
    const double down = reading->clip_y == GLINT_CLIP_Y_UP ? -1 : 1;
    out[0] += (before[2] * before[14] - now[2] * now[14]) / 2 * size[0];
    out[1] += (before[6] * before[14] - now[6] * now[14]) / 2 * size[1] * down;
}
