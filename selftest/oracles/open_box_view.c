/* The box: what is where, and how it is seen. */
#include <math.h>
#include <string.h>

#include "oracles/open_box_internal.h"

static const double size[3] = {8, 4, 6}, eye[3] = {1.2, 1.7, 5.2}, target[3] = {5.2, 0.9, 1.2}; /* as usual */

static struct open_box_view view_of(const double of[4]) {
    struct open_box_view v = {.half_height = tan(of[0] / 2)};
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

struct open_box open_box_filled(const struct open_box *box) {
    struct open_box c = *box;
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

void open_box_light(const struct open_box *box, const double p[3], double rgb[3]) {
    rgb[0] = box->light * (0.55 + 0.35 * sin(1.3 * p[0] + 0.7 * p[1]));
    rgb[1] = box->light * (0.50 + 0.35 * sin(1.1 * p[1] + 0.9 * p[2]));
    rgb[2] = box->light * (0.55 + 0.35 * sin(1.2 * p[2] - 0.8 * p[0]));
}

void open_box_sky(const struct open_box *box, const double direction[3], double rgb[3]) {
    const double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int k = 0; k < 3; k++) rgb[k] = box->light * (0.5 + 0.2 * direction[k] / length);
}

/* ---- The camera ---- */

void open_box_eye(const struct open_box *box, bool previous, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = eye[k] + (box->frame - (previous ? 2.0 : 1.0)) * box->travel_m[k];
}

void open_box_camera_axes(const struct open_box *c, double right[3], double up[3], double ahead[3]) {
    memcpy(right, c->view.right, sizeof c->view.right);
    memcpy(up, c->view.up, sizeof c->view.up);
    memcpy(ahead, c->view.ahead, sizeof c->view.ahead);
}

struct open_box_projection open_box_project(const struct open_box *c) {
    const double b = 1 / c->view.half_height;
    return (struct open_box_projection){
        {b * c->height / c->width, b},
        {c->shift[0] + 2 * c->jitter_px[0] / c->width, c->shift[1] - 2 * c->jitter_px[1] / c->height}};
}

static void view_ray(const struct open_box *c, const double place_px[2], double ray[3]) {
    const struct open_box_projection p = open_box_project(c);
    double right[3], up[3], ahead[3];
    open_box_camera_axes(c, right, up, ahead);
    const double x = (2 * place_px[0] / c->width - 1 - p.shift[0]) / p.scale[0],
                 y = (1 - 2 * place_px[1] / c->height - p.shift[1]) / p.scale[1];
    for (int k = 0; k < 3; k++) ray[k] = ahead[k] + x * right[k] + y * up[k];
}

void open_box_view_ray(const struct open_box *box, const double place_px[2], double ray[3]) {
    const struct open_box c = open_box_filled(box);
    view_ray(&c, place_px, ray);
}

bool open_box_project_point(const struct open_box *c, bool previous, const double point[3], double w,
                            double place_px[2], double *depth) {
    const struct open_box_projection p = open_box_project(c);
    double axes[3][3], from[3], view[3] = {0};
    open_box_camera_axes(c, axes[0], axes[1], axes[2]);
    open_box_eye(c, previous, from);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) view[k] += axes[k][i] * (point[i] - w * from[i]);
    *depth = view[2];
    place_px[0] = c->width * (0.5 + 0.5 * (view[0] / view[2] * p.scale[0] + p.shift[0]));
    place_px[1] = c->height * (0.5 - 0.5 * (view[1] / view[2] * p.scale[1] + p.shift[1]));
    return view[2] > 0;
}

/* ---- Rays ---- */

double open_box_exit(const double from[3], const double direction[3], int *face) {
    double nearest = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double t = ((direction[k] > 0 ? size[k] : 0) - from[k]) / direction[k];
        if (direction[k] == 0 || t >= nearest) continue;
        nearest = t;
        *face = 2 * k + (direction[k] < 0);
    }
    return nearest;
}

enum open_box_surface open_box_surface_of(int face) {
    return face == 2 ? OPEN_BOX_SKY : face == 3 ? OPEN_BOX_FLOOR : OPEN_BOX_WALL;
}

enum open_box_surface open_box_view_hit(const struct open_box *c, const double place_px[2], double *depth,
                                        double point[3], int *face) {
    double from[3], ray[3];
    open_box_eye(c, false, from);
    view_ray(c, place_px, ray);
    const double t = open_box_exit(from, ray, face);
    const enum open_box_surface seen = open_box_surface_of(*face);
    *depth = seen == OPEN_BOX_SKY ? INFINITY : t;
    for (int k = 0; k < 3; k++) point[k] = seen == OPEN_BOX_SKY ? ray[k] : from[k] + t * ray[k];
    return seen;
}

enum open_box_surface open_box_seen(const struct open_box *box, const double place_px[2], double *depth, int *face) {
    const struct open_box c = open_box_filled(box);
    double point[3];
    return open_box_view_hit(&c, place_px, depth, point, face);
}

bool open_box_seen_at(const struct open_box *box, const double point[3], double place_px[2]) {
    const struct open_box c = open_box_filled(box);
    double depth;
    return open_box_project_point(&c, false, point, 1, place_px, &depth);
}

static struct open_box_ray mirrored(const struct open_box *box, const double place_px[2], double depth, int axis) {
    const struct open_box c = open_box_filled(box);
    struct open_box_ray r = {.distance = 0};
    double from[3], ray[3], length = 0;
    open_box_eye(&c, false, from);
    view_ray(&c, place_px, ray);
    for (int k = 0; k < 3; k++) length += ray[k] * ray[k];
    for (int k = 0; k < 3; k++) {
        r.start[k] = from[k] + depth * ray[k];
        r.direction[k] = (k == axis ? -1 : 1) * ray[k] / sqrt(length);
    }
    r.distance = open_box_exit(r.start, r.direction, &r.face);
    const bool leaves = open_box_surface_of(r.face) == OPEN_BOX_SKY;
    const double across[3] = {r.direction[0], 0, r.direction[2]};
    int wall;
    const double to_wall = leaves ? open_box_exit(r.start, across, &wall) : r.distance;
    for (int k = 0; k < 3; k++) {
        r.end[k] = r.start[k] + r.distance * r.direction[k];
        r.over[k] = r.start[k] + to_wall * r.direction[k];
    }
    r.in_front = open_box_project_point(&c, false, leaves ? r.direction : r.end, leaves ? 0 : 1, r.end_px, &depth);
    if (leaves) r.distance = INFINITY;
    return r;
}

struct open_box_ray open_box_mirror(const struct open_box *box, const double place_px[2], double depth) {
    return mirrored(box, place_px, depth, 1);
}

bool open_box_reflect(const struct open_box *box, const double place_px[2], struct open_box_ray *ray) {
    double depth;
    int face;
    const bool sky = open_box_seen(box, place_px, &depth, &face) == OPEN_BOX_SKY;
    if (!sky) *ray = mirrored(box, place_px, depth, face / 2);
    return !sky;
}
