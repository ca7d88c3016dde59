#include "shapes.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static void meet_plane(int axis, double place, double highest, const double from[3], const double direction[3],
                       double *nearest, double normal[3]) {
    if (direction[axis] == 0) return;
    const double t = (place - from[axis]) / direction[axis];
    if (!(t > 1e-9 && t < *nearest) || from[1] + t * direction[1] > highest) return;
    *nearest = t;
    for (int k = 0; k < 3; k++) normal[k] = k == axis ? -copysign(1, direction[axis]) : 0;
}

static void meet_sphere(const double sphere[4], const double from[3], const double direction[3], double *nearest,
                        double normal[3]) {
    double along = 0, away2 = 0, length2 = 0;
    for (int k = 0; k < 3; k++) {
        along += (sphere[k] - from[k]) * direction[k];
        away2 += (sphere[k] - from[k]) * (sphere[k] - from[k]);
        length2 += direction[k] * direction[k];
    }
    const double inside = along * along - length2 * (away2 - sphere[3] * sphere[3]),
                 t = (along - sqrt(inside)) / length2;
    if (!(inside > 0 && t > 1e-9 && t < *nearest)) return;
    *nearest = t;
    for (int k = 0; k < 3; k++) normal[k] = (from[k] + t * direction[k] - sphere[k]) / sphere[3];
}

/* The ray is inside between the last entry and the first exit of the three pairs of planes. */
static void meet_box(const double box[6], const double from[3], const double direction[3], double *nearest,
                     double normal[3]) {
    double enters = -INFINITY, leaves = INFINITY;
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        const double one = (box[k] - from[k]) / direction[k], other = (box[3 + k] - from[k]) / direction[k];
        if (direction[k] == 0 && !(from[k] > box[k] && from[k] < box[3 + k])) return;
        if (direction[k] == 0) continue;
        if (fmin(one, other) > enters) enters = fmin(one, other), axis = k;
        leaves = fmin(leaves, fmax(one, other));
    }
    if (!(enters < leaves && enters > 1e-9 && enters < *nearest)) return;
    *nearest = enters;
    for (int k = 0; k < 3; k++) normal[k] = k == axis ? -copysign(1, direction[axis]) : 0;
}

double shapes_hit(const struct shapes *shapes, const double from[3], const double direction[3], double normal[3]) {
    double nearest = INFINITY;
    if (shapes->floor_y != 0) meet_plane(1, shapes->floor_y, INFINITY, from, direction, &nearest, normal);
    if (shapes->ceiling_y != 0) meet_plane(1, shapes->ceiling_y, INFINITY, from, direction, &nearest, normal);
    if (shapes->wall_z != 0) meet_plane(2, shapes->wall_z, shapes->wall_top, from, direction, &nearest, normal);
    if (shapes->sphere[3] > 0) meet_sphere(shapes->sphere, from, direction, &nearest, normal);
    if (shapes->box[3] > shapes->box[0]) meet_box(shapes->box, from, direction, &nearest, normal);
    return nearest;
}

double shapes_visibility(const struct shapes *shapes, const double at[3], const double normal[3], double radius,
                         int steps) {
    const double other[3] = {normal[1], normal[2], normal[0]};
    double tangent[3], bitangent[3], length = 0, ignored[3];
    for (int k = 0; k < 3; k++)
        tangent[k] = normal[(k + 1) % 3] * other[(k + 2) % 3] - normal[(k + 2) % 3] * other[(k + 1) % 3];
    for (int k = 0; k < 3; k++) length += tangent[k] * tangent[k];
    for (int k = 0; k < 3; k++) tangent[k] /= sqrt(length);
    for (int k = 0; k < 3; k++)
        bitangent[k] = normal[(k + 1) % 3] * tangent[(k + 2) % 3] - normal[(k + 2) % 3] * tangent[(k + 1) % 3];
    int visible = 0;
    for (int i = 0; i < steps; i++)
        for (int j = 0; j < steps; j++) { /* cells of equal cosine-weighted size */
            const double sine2 = (i + 0.5) / steps, phi = 2 * pi * (j + 0.5) / steps, sine = sqrt(sine2);
            double direction[3];
            for (int k = 0; k < 3; k++)
                direction[k] =
                    sine * cos(phi) * tangent[k] + sine * sin(phi) * bitangent[k] + sqrt(1 - sine2) * normal[k];
            visible += !(shapes_hit(shapes, at, direction, ignored) <= radius);
        }
    return (double)visible / steps / steps;
}

bool shapes_pixel(const struct shapes *shapes, const struct plain *plain, uint32_t x, uint32_t y, double position[3],
                  double normal[3]) {
    static const double eye[3] = {0, 0, 0};
    const double half = tan(plain->fov_y_degrees * pi / 360);
    const double direction[3] = {((x + 0.5) * 2 / plain->width - 1) * half * plain->width / plain->height,
                                 (1 - (y + 0.5) * 2 / plain->height) * half, -1};
    const double depth = shapes_hit(shapes, eye, direction, normal);
    for (int k = 0; k < 3; k++) position[k] = depth * direction[k];
    return depth < INFINITY;
}

void shapes_spoil(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; i++) {
        double position[3], normal[3] = {0, 0, 1};
        const bool hit = shapes_pixel(plain->user, plain, i % plain->width, i / plain->width, position, normal);
        values[PLAIN_DEPTH * pixels + i] = hit ? (float)-position[2] : INFINITY;
        for (uint32_t k = 0; k < 3; k++) values[(PLAIN_NORMAL_X + k) * pixels + i] = (float)normal[k];
    }
}

void shapes_spoil_some(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    shapes_spoil(plain, values);
    for (uint32_t i = 0; i < pixels; i++) {
        if (i % 7 == 0) values[PLAIN_NORMAL_X * pixels + i] = NAN;
        if (i % 11 == 0)
            for (uint32_t k = 0; k < 3; k++) values[(PLAIN_NORMAL_X + k) * pixels + i] = 0;
        if (i % 13 == 0) values[i] = i % 2 ? INFINITY : NAN;
        if (i % 17 == 0) values[i] = i % 2 ? 0 : -3;
    }
}
