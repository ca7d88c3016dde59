/* Camera positions, and repair of rotations that engines store as floats. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "attributes.h"

/* Each step multiplies the residual by the rotation's error e. Rule `matrices` allows 1e-3, so six steps exceed double precision. */
void glint_camera_position(const struct glint_camera *camera, double position[3]) {
    const double *m = camera->world_to_view;
    memset(position, 0, 3 * sizeof *position);
    for (int step = 0; step < 6; step++) {
        double view[3];
        for (int i = 0; i < 3; i++)
            view[i] = m[4 * i] * position[0] + m[4 * i + 1] * position[1] + m[4 * i + 2] * position[2] + m[4 * i + 3];
        for (int i = 0; i < 3; i++) position[i] -= m[i] * view[0] + m[4 + i] * view[1] + m[8 + i] * view[2];
    }
}

static void multiply(const double left[16], const double right[16], double out[16]) {
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            out[4 * i + j] = 0;
            for (int k = 0; k < 4; k++) out[4 * i + j] += left[4 * i + k] * right[4 * k + j];
        }
}

static void transpose(double m[16]) {
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            const double above = m[4 * j + i];
            m[4 * j + i] = m[4 * i + j];
            m[4 * i + j] = above;
        }
}

void glint_camera_standard(const struct glint_camera *camera, enum glint_clip_y clip_y, double world_to_camera[16],
                           double world_to_ndc[16]) {
    const double *clip = camera->view_to_clip, y_up = clip_y == GLINT_CLIP_Y_DOWN ? -1 : 1;
    /* w of clip space is the depth, and the signs of x and y say which way the picture's axes run in view space. */
    const double axes[16] = {[0] = copysign(1, clip[0]), [5] = y_up * copysign(1, clip[5]), [10] = clip[14], [15] = 1};
    const double window[16] = {0.5, 0, 0, 0.5, 0, -y_up / 2, 0, 0.5, 0, 0, 1, 0, 0, 0, 0, 1};
    double to_clip[16];
    multiply(axes, camera->world_to_view, world_to_camera);
    transpose(world_to_camera);
    multiply(clip, camera->world_to_view, to_clip);
    multiply(window, to_clip, world_to_ndc);
    transpose(world_to_ndc);
}

/* R·Rᵀ, and its largest difference from the identity. */
static double product_with_transpose(const double *m, double out[3][3]) {
    double largest = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            out[i][j] = m[4 * i] * m[4 * j] + m[4 * i + 1] * m[4 * j + 1] + m[4 * i + 2] * m[4 * j + 2];
            largest = fmax(largest, fabs(out[i][j] - (i == j)));
        }
    return largest;
}

/* The iteration R ← (3 I - R·Rᵀ)·R / 2 converges quadratically to the nearest rotation (that of the polar decomposition). */
static void towards_rotation(double *m, double product[3][3]) {
    double rows[3][3] = {{0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) rows[i][j] += ((i == k ? 3 : 0) - product[i][k]) / 2 * m[4 * k + j];
    for (int i = 0; i < 3; i++) memcpy(m + 4 * i, rows[i], sizeof rows[i]);
}

void glint_camera_make_rigid(struct glint_camera *camera) {
    /* The error of a rotation computed in double, which moves nothing by more than a micrometre at 1,000 km. */
    static const double precise = 1e-12;
    double product[3][3], position[3], *m = camera->world_to_view;
    const double error = product_with_transpose(m, product);
    if (error <= precise) return;
    camera->rotation_error = error;
    glint_camera_position(camera, position);
    for (int step = 0; step < 3; step++) {
        towards_rotation(m, product);
        product_with_transpose(m, product);
    }
    for (int i = 0; i < 3; i++)
        m[4 * i + 3] = -(m[4 * i] * position[0] + m[4 * i + 1] * position[1] + m[4 * i + 2] * position[2]);
}

/* The distance by which the camera moves if an engine transposes the matrix instead of inverting it, or vice versa. */
static double doubt_m(const struct glint_camera *camera, double metres, double *away_m) {
    double p[3];
    glint_camera_position(camera, p);
    *away_m = metres * hypot(hypot(p[0], p[1]), p[2]);
    return camera->rotation_error * *away_m;
}

size_t glint_frame_notes(const struct glint_frame *frame, char notes[GLINT_NOTES][GLINT_NOTE_LENGTH]) {
    static const double significant_m = 1e-4; /* the resolution of a 24-bit depth buffer at about 20 m */
    static const char *const names[] = {"glint.worldToView", "glint.previousWorldToView"};
    const struct glint_camera *const cameras[] = {&frame->camera, frame->has_previous ? &frame->previous : NULL};
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    size_t count = 0;
    for (int i = 0; i < 2; i++) {
        double away_m, off_m = cameras[i] ? doubt_m(cameras[i], metres, &away_m) : 0;
        if (!(off_m >= significant_m)) continue;
        snprintf(
            notes[count++], GLINT_NOTE_LENGTH,
            "gbuffer: %s: expected a rotation in double precision, found one that is orthonormal to %.2g; %.4g km from "
            "the origin that is %.2g mm. The camera is placed where the matrix gives 0, which is correct if the "
            "translation was computed from the rotation as stored",
            names[i], cameras[i]->rotation_error, away_m / 1000, 1000 * off_m);
    }
    return count;
}
