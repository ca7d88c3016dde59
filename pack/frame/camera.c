/* Cameras: matrices in any order, or a position and a field of view. */
#include "camera.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- The order of the numbers ---- */

static void transpose(double m[16]) {
    for (int r = 0; r < 4; r++)
        for (int c = r + 1; c < 4; c++) {
            const double kept = m[4 * r + c];
            m[4 * r + c] = m[4 * c + r];
            m[4 * c + r] = kept;
        }
}

/* Whether the matrix, as row-major numbers, is a perspective for column vectors; `plain`: and its w is the depth. */
static bool is_perspective(const double m[16], bool plain) {
    return (!plain || fabs(m[14]) == 1) && m[12] == 0 && m[13] == 0 && m[14] != 0 && m[15] == 0 && m[1] == 0 &&
           m[3] == 0 && m[4] == 0 && m[7] == 0 && m[8] == 0 && m[9] == 0;
}

/* Which of column and row vectors the projection shows; column when it is no help. */
static bool shows_rows(const double listed[16], bool column_major, bool *certain) {
    double straight[16], turned[16];
    memcpy(straight, listed, sizeof straight);
    memcpy(turned, listed, sizeof turned);
    transpose(turned);
    const double *as_columns = column_major ? turned : straight, *as_rows = column_major ? straight : turned;
    bool columns = is_perspective(as_columns, true), rows = is_perspective(as_rows, true);
    if (!columns && !rows) {
        columns = is_perspective(as_columns, false);
        rows = is_perspective(as_rows, false);
    }
    *certain = columns != rows;
    return rows && !columns;
}

bool matrix_order_read(const struct node *frame, struct matrix_order *order, struct glint_error *err) {
    const char *layout = node_text(frame, "layout"), *vectors = node_text(frame, "vectors");
    const struct node layout_node = node_child(frame, "layout"), vectors_node = node_child(frame, "vectors"),
                      clip = node_child(frame, "view_to_clip");
    double listed[16];
    bool certain = false;
    order->is_column_major = layout && !strcmp(layout, "column_major");
    order->is_row_vectors = vectors && !strcmp(vectors, "row");
    if (node_numbers(frame, "view_to_clip", listed)) {
        const bool rows = shows_rows(listed, order->is_column_major, &certain);
        if (!layout) node_note(&layout_node, GLINT_PACK_DEFAULT, "not said; row_major");
        if (!vectors) {
            order->is_row_vectors = rows;
            node_note(&vectors_node, GLINT_PACK_DEFAULT, "not said; %s%s", rows ? "row" : "column",
                      certain ? ", as view_to_clip shows, whose last row or column is 0 0 ±1 0" : "");
        } else if (certain && rows != order->is_row_vectors)
            return node_fail(&clip, err, GLINT_ERROR_FORMAT,
                             "the matrix is transposed: with layout %s its ±1 stands where vectors \"%s\" has it, and "
                             "vectors is \"%s\"",
                             order->is_column_major ? "column_major" : "row_major", rows ? "row" : "column", vectors);
    }
    order->is_transposed = order->is_column_major != order->is_row_vectors;
    return true;
}

bool matrix_read(const struct node *frame, const struct node *node, const char *key, double out[16],
                 struct glint_error *err) {
    struct matrix_order order = {.is_transposed = false};
    if (!matrix_order_read(frame, &order, err)) return false;
    node_numbers(node, key, out);
    if (order.is_transposed) transpose(out);
    return true;
}

/* ---- Matrices ---- */

static bool check_rotation(const struct node *node, const double m[16], struct glint_error *err) {
    if (m[3] == 0 && m[7] == 0 && m[11] == 0 && (m[12] != 0 || m[13] != 0 || m[14] != 0))
        return node_fail(node, err, GLINT_ERROR_FORMAT,
                         "the translation stands in the last row: the matrix is transposed against layout and vectors");
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected the last row 0 0 0 1, found %g %g %g %g", m[12],
                         m[13], m[14], m[15]);
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            const double dot = m[4 * i] * m[4 * j] + m[4 * i + 1] * m[4 * j + 1] + m[4 * i + 2] * m[4 * j + 2];
            if (i == j && !(fabs(dot - 1) <= 1e-3))
                return node_fail(
                    node, err, GLINT_ERROR_FORMAT,
                    "expected a rotation without scale, found row %d of length %g; metres_per_unit converts "
                    "lengths",
                    i, sqrt(dot));
            if (i != j && !(fabs(dot) <= 1e-3))
                return node_fail(node, err, GLINT_ERROR_FORMAT,
                                 "expected a rotation, found rows %d and %d with the product %g", i, j, dot);
        }
    return true;
}

static void invert_rigid(double m[16]) {
    const double from[3] = {m[3], m[7], m[11]};
    transpose(m);
    m[12] = m[13] = m[14] = 0;
    for (int r = 0; r < 3; r++) m[4 * r + 3] = -(m[4 * r] * from[0] + m[4 * r + 1] * from[1] + m[4 * r + 2] * from[2]);
}

static bool check_projection(const struct node *node, double m[16], struct glint_error *err) {
    static const int zeros[] = {1, 3, 4, 7, 8, 9, 12, 13, 15};
    const double w = fabs(m[14]);
    if (m[14] == 0 && m[15] != 0)
        return node_fail(node, err, GLINT_ERROR_UNSUPPORTED,
                         "expected a perspective projection, found an orthographic one (row 3 is %g %g %g %g)", m[12],
                         m[13], m[14], m[15]);
    if (w != 1 && w > 0) {
        node_note(node, GLINT_PACK_FOUND, "divided by %.9g, so that w is the depth", w);
        for (int i = 0; i < 16; i++) m[i] /= w;
    }
    for (size_t i = 0; i < sizeof zeros / sizeof *zeros; i++)
        if (!(fabs(m[zeros[i]]) <= 1e-9))
            return node_fail(node, err, GLINT_ERROR_FORMAT,
                             "expected rows (a 0 c 0) (0 b d 0) (0 0 A B) (0 0 ±1 0), found %g in row %d column %d",
                             m[zeros[i]], zeros[i] / 4, zeros[i] % 4);
    if (fabs(m[14]) != 1 || m[0] == 0 || m[5] == 0 || m[11] == 0)
        return node_fail(
            node, err, GLINT_ERROR_FORMAT,
            "expected rows (a 0 c 0) (0 b d 0) (0 0 A B) (0 0 ±1 0), found a = %g, b = %g, B = %g, ±1 = %g", m[0], m[5],
            m[11], m[14]);
    return true;
}

/* ---- Without matrices ---- */

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalize(double v[3]) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] /= length;
    return length > 0 && isfinite(length);
}

static bool look_at(const struct node *frame, const struct node *node, bool left, double out[16],
                    struct glint_error *err) {
    const char *axis = node_text(frame, "up");
    double position[3], target[3], up[3] = {0}, forward[3], right[3], top[3];
    node_numbers(node, "position", position);
    node_numbers(node, "target", target);
    up[axis ? axis[1] - 'x' : 1] = axis && axis[0] == '-' ? -1 : 1;
    node_numbers(node, "up", up);
    for (int i = 0; i < 3; i++) forward[i] = target[i] - position[i];
    if (!normalize(forward))
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected a target apart from the position");
    if (left) cross(up, forward, right);
    else cross(forward, up, right);
    if (!normalize(right)) return node_fail(node, err, GLINT_ERROR_FORMAT, "expected up apart from the view direction");
    if (left) cross(forward, right, top);
    else cross(right, forward, top);
    const double z = left ? 1 : -1;
    const double rows[16] = {right[0],       right[1],       right[2],       0, top[0], top[1], top[2], 0,
                             z * forward[0], z * forward[1], z * forward[2], 0, 0,      0,      0,      1};
    memcpy(out, rows, sizeof rows);
    for (int r = 0; r < 3; r++)
        out[4 * r + 3] = -(rows[4 * r] * position[0] + rows[4 * r + 1] * position[1] + rows[4 * r + 2] * position[2]);
    return true;
}

static bool project(const struct node *frame, const struct node *node, bool left, double aspect, double out[16],
                    struct glint_error *err) {
    const char *clip_z = node_text(frame, "clip_z"), *clip_y = node_text(frame, "clip_y");
    const bool vertical = node_has(node, "fov_y"), infinite = !node_has(node, "far"),
               reversed = node_bool(node, "reversed", false);
    const double degrees = node_number(node, vertical ? "fov_y" : "fov_x", 0), near = node_number(node, "near", 0),
                 far = node_number(node, "far", 0), shape = node_number(node, "aspect", aspect);
    if (vertical == node_has(node, "fov_x"))
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected fov_y or fov_x, found %s",
                         vertical ? "both" : "none");
    if (!(degrees > 0 && degrees < 180) || !(near > 0) || !(infinite || far > near) || !(shape > 0))
        return node_fail(node, err, GLINT_ERROR_FORMAT,
                         "expected 0 < fov < 180, 0 < near < far and an aspect above 0, found %g, %g, %g, %g", degrees,
                         near, far, shape);
    const double t = 1 / tan(degrees * (3.14159265358979323846 / 360)), sign = left ? 1 : -1;
    /* z in [0, 1] at the distance t: C + D / t */
    double c = infinite ? 1 : far / (far - near), d = -c * near;
    if (reversed) c = 1 - c, d = -d;
    if (clip_z && !strcmp(clip_z, "minus_one_to_one")) c = 2 * c - 1, d = 2 * d;
    memset(out, 0, 16 * sizeof *out);
    out[0] = vertical ? t / shape : t;
    out[5] = (vertical ? t : t * shape) * (clip_y && !strcmp(clip_y, "down") ? -1 : 1);
    out[10] = c * sign;
    out[11] = d;
    out[14] = sign;
    return true;
}

/* ---- One camera ---- */

bool view_read(const struct node *node, const char *prefix, const struct matrix_order *order, double out[16],
               bool *found, struct glint_error *err) {
    char world[64], view[64];
    snprintf(world, sizeof world, "%sview_to_world", prefix);
    snprintf(view, sizeof view, "%sworld_to_view", prefix);
    const bool inverse = node_has(node, world);
    const struct node used = node_child(node, inverse ? world : view);
    if (inverse && node_has(node, view))
        return node_fail(&used, err, GLINT_ERROR_FORMAT, "expected %s or %s, found both", view, world);
    *found = node_numbers(node, used.key, out);
    if (!*found) return true;
    if (order->is_transposed) transpose(out);
    if (!check_rotation(&used, out, err)) return false;
    if (inverse) invert_rigid(out);
    return true;
}

static bool read_without_matrices(const struct node *frame, const struct node *node, uint32_t width, uint32_t height,
                                  struct glint_camera *camera, struct glint_error *err) {
    const char *hand = node_text(node, "handedness"), *world = node_text(frame, "handedness");
    const bool left = hand ? !strcmp(hand, "left") : world && !strcmp(world, "left");
    const double aspect = height ? (double)width / height : 1;
    return look_at(frame, node, left, camera->world_to_view, err) &&
           project(frame, node, left, aspect, camera->view_to_clip, err);
}

bool camera_read(const struct node *frame, const struct node *node, const char *prefix,
                 const struct matrix_order *order, uint32_t width, uint32_t height, struct glint_camera *camera,
                 struct glint_error *err) {
    char name[64], clip[64];
    bool has_view = false;
    snprintf(name, sizeof name, "%scamera", prefix);
    snprintf(clip, sizeof clip, "%sview_to_clip", prefix);
    const struct node without = node_child(node, name), projection = node_child(node, clip);
    if (!view_read(node, prefix, order, camera->world_to_view, &has_view, err)) return false;
    if (without.value && (has_view || projection.value))
        return node_fail(&without, err, GLINT_ERROR_FORMAT, "expected %s or matrices, found both", name);
    if (without.value) return read_without_matrices(frame, &without, width, height, camera, err);
    if (!has_view || !node_numbers(node, clip, camera->view_to_clip))
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected %sworld_to_view and %s, or a camera, found no %s",
                         prefix, clip, has_view ? clip : "world_to_view");
    if (order->is_transposed) transpose(camera->view_to_clip);
    return check_projection(&projection, camera->view_to_clip, err);
}

/* ---- What a projection is ---- */

struct projection projection_of(const double m[16], enum glint_clip_z clip_z) {
    const bool symmetric = clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE;
    /* depth in [0, 1] at the distance t: far + slope / t */
    const double far = symmetric ? (m[10] * m[14] + 1) / 2 : m[10] * m[14], slope = symmetric ? m[11] / 2 : m[11];
    struct projection p = {.is_reversed = slope > 0};
    const double zero = -slope / far, one = slope / (1 - far);
    p.is_infinite = fabs(p.is_reversed ? far : 1 - far) <= 1e-5;
    p.near = p.is_reversed ? one : zero;
    p.far = p.is_infinite ? (double)INFINITY : p.is_reversed ? zero : one;
    return p;
}

enum glint_depth_encoding projection_encoding(const struct projection *projection) {
    return !projection->is_reversed  ? GLINT_DEPTH_DEVICE
           : projection->is_infinite ? GLINT_DEPTH_REVERSED_INFINITE
                                     : GLINT_DEPTH_REVERSED;
}
