/* The court: what is where, and how it is seen. */
#include <math.h>
#include <string.h>

#include "court_parts.h"

static const double size[3] = {8, 4, 6}, eye[3] = {1.2, 1.7, 5.2}, target[3] = {5.2, 0.9, 1.2}; /* as usual */

static struct court_view view_of(const double of[4]) {
    struct court_view v = {.half_height = tan(of[0] / 2)};
    const double *towards = of + 1;
    double length = 0;
    memcpy(v.of, of, sizeof v.of);
    for (int k = 0; k < 3; k++) length += (towards[k] - eye[k]) * (towards[k] - eye[k]);
    for (int k = 0; k < 3; k++) v.ahead[k] = (towards[k] - eye[k]) / sqrt(length);
    const double across = hypot(v.ahead[0], v.ahead[2]);
    v.right[0] = -v.ahead[2] / across, v.right[2] = v.ahead[0] / across;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        v.up[k] = v.right[i] * v.ahead[j] - v.right[j] * v.ahead[i];
    }
    return v;
}

struct court court_of(const struct court *court) {
    struct court c = *court;
    if (!c.width) c.width = 96, c.height = 64;
    if (!c.cube_size) c.cube_size = 32;
    if (!(c.fov_y_rad > 0)) c.fov_y_rad = 1.05;
    if (!(c.near_m > 0)) c.near_m = 0.1;
    if (!(c.far_m > 0)) c.far_m = 1000;
    if (c.encodings.depth == GLINT_DEPTH_REVERSED_INFINITE) c.far_m = INFINITY;
    if (!(c.metres_per_unit > 0)) c.metres_per_unit = 1;
    if (!(c.scale > 0)) c.scale = 1;
    if (!(c.pre_exposure > 0)) c.pre_exposure = 1;
    if (!(c.light > 0)) c.light = 1;
    if (!c.frame) c.frame = 1;
    const bool aimed = c.target[0] > 0;
    for (int k = 0; k < 3; k++) {
        if (!c.axes[k]) c.axes[k] = k + 1;
        if (!aimed) c.target[k] = target[k];
    }
    const double of[4] = {c.fov_y_rad, c.target[0], c.target[1], c.target[2]};
    if (memcmp(of, c.view.of, sizeof of) != 0) c.view = view_of(of);
    return c;
}

void court_light(const struct court *court, const double p[3], double rgb[3]) {
    rgb[0] = court->light * (0.55 + 0.35 * sin(1.3 * p[0] + 0.7 * p[1]));
    rgb[1] = court->light * (0.50 + 0.35 * sin(1.1 * p[1] + 0.9 * p[2]));
    rgb[2] = court->light * (0.55 + 0.35 * sin(1.2 * p[2] - 0.8 * p[0]));
}

void court_sky(const struct court *court, const double direction[3], double rgb[3]) {
    const double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int k = 0; k < 3; k++) rgb[k] = court->light * (0.5 + 0.2 * direction[k] / length);
}

/* ---- The camera ---- */

void court_eye(const struct court *court, bool previous, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = eye[k] + (court->frame - (previous ? 2.0 : 1.0)) * court->travel_m[k];
}

void court_camera_axes(const struct court *c, double right[3], double up[3], double ahead[3]) {
    memcpy(right, c->view.right, sizeof c->view.right);
    memcpy(up, c->view.up, sizeof c->view.up);
    memcpy(ahead, c->view.ahead, sizeof c->view.ahead);
}

struct court_projection court_project(const struct court *c) {
    const double b = 1 / c->view.half_height;
    return (struct court_projection){
        {b * c->height / c->width, b},
        {c->shift[0] + 2 * c->jitter_px[0] / c->width, c->shift[1] - 2 * c->jitter_px[1] / c->height}};
}

static void look(const struct court *c, const double place_px[2], double ray[3]) {
    const struct court_projection p = court_project(c);
    double right[3], up[3], ahead[3];
    court_camera_axes(c, right, up, ahead);
    const double x = (2 * place_px[0] / c->width - 1 - p.shift[0]) / p.scale[0],
                 y = (1 - 2 * place_px[1] / c->height - p.shift[1]) / p.scale[1];
    for (int k = 0; k < 3; k++) ray[k] = ahead[k] + x * right[k] + y * up[k];
}

void court_view_ray(const struct court *court, const double place_px[2], double ray[3]) {
    const struct court c = court_of(court);
    look(&c, place_px, ray);
}

bool court_place(const struct court *c, bool previous, const double point[3], double w, double place_px[2],
                 double *depth) {
    const struct court_projection p = court_project(c);
    double axes[3][3], from[3], view[3] = {0};
    court_camera_axes(c, axes[0], axes[1], axes[2]);
    court_eye(c, previous, from);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) view[k] += axes[k][i] * (point[i] - w * from[i]);
    *depth = view[2];
    place_px[0] = c->width * (0.5 + 0.5 * (view[0] / view[2] * p.scale[0] + p.shift[0]));
    place_px[1] = c->height * (0.5 - 0.5 * (view[1] / view[2] * p.scale[1] + p.shift[1]));
    return view[2] > 0;
}

/* ---- Rays ---- */

double court_leave(const double from[3], const double direction[3], int *face) {
    double nearest = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double t = ((direction[k] > 0 ? size[k] : 0) - from[k]) / direction[k];
        if (direction[k] == 0 || t >= nearest) continue;
        nearest = t;
        *face = 2 * k + (direction[k] < 0);
    }
    return nearest;
}

enum court_surface court_surface_of(int face) {
    return face == 2 ? COURT_SKY : face == 3 ? COURT_FLOOR : COURT_WALL;
}

enum court_surface court_look(const struct court *c, const double place_px[2], double *depth, double point[3],
                              int *face) {
    double from[3], ray[3];
    court_eye(c, false, from);
    look(c, place_px, ray);
    const double t = court_leave(from, ray, face);
    const enum court_surface seen = court_surface_of(*face);
    *depth = seen == COURT_SKY ? INFINITY : t;
    for (int k = 0; k < 3; k++) point[k] = seen == COURT_SKY ? ray[k] : from[k] + t * ray[k];
    return seen;
}

enum court_surface court_seen(const struct court *court, const double place_px[2], double *depth, int *face) {
    const struct court c = court_of(court);
    double point[3];
    return court_look(&c, place_px, depth, point, face);
}

bool court_seen_at(const struct court *court, const double point[3], double place_px[2]) {
    const struct court c = court_of(court);
    double depth;
    return court_place(&c, false, point, 1, place_px, &depth);
}

static struct court_ray mirrored(const struct court *court, const double place_px[2], double depth, int axis) {
    const struct court c = court_of(court);
    struct court_ray r = {.distance = 0};
    double from[3], ray[3], length = 0;
    court_eye(&c, false, from);
    look(&c, place_px, ray);
    for (int k = 0; k < 3; k++) length += ray[k] * ray[k];
    for (int k = 0; k < 3; k++) {
        r.start[k] = from[k] + depth * ray[k];
        r.direction[k] = (k == axis ? -1 : 1) * ray[k] / sqrt(length);
    }
    r.distance = court_leave(r.start, r.direction, &r.face);
    const bool leaves = court_surface_of(r.face) == COURT_SKY;
    const double across[3] = {r.direction[0], 0, r.direction[2]};
    int wall;
    const double to_wall = leaves ? court_leave(r.start, across, &wall) : r.distance;
    for (int k = 0; k < 3; k++) {
        r.end[k] = r.start[k] + r.distance * r.direction[k];
        r.over[k] = r.start[k] + to_wall * r.direction[k];
    }
    r.in_front = court_place(&c, false, leaves ? r.direction : r.end, leaves ? 0 : 1, r.end_px, &depth);
    if (leaves) r.distance = INFINITY;
    return r;
}

struct court_ray court_mirror(const struct court *court, const double place_px[2], double depth) {
    return mirrored(court, place_px, depth, 1);
}

bool court_reflect(const struct court *court, const double place_px[2], struct court_ray *ray) {
    double depth;
    int face;
    const bool sky = court_seen(court, place_px, &depth, &face) == COURT_SKY;
    if (!sky) *ray = mirrored(court, place_px, depth, face / 2);
    return !sky;
}
