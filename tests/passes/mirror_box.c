#include "mirror_box.h"

#include <math.h>
#include <stdlib.h>

#include "unit.h"

const double mirror_box[3] = {8, 4, 6};

double dot3(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct camera {
    double eye[3], rows[3][3], front; /* rows of the rotation, sign of view z in front */
    double scale[2], shift[2];        /* ndc = view/depth · scale + shift */
};

static struct camera camera_of(const struct glint_frame *frame) {
    struct camera c = {.front = frame->camera.view_to_clip[14]};
    const double *v = frame->camera.world_to_view, *p = frame->camera.view_to_clip;
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) {
            c.rows[r][k] = v[4 * r + k];
            c.eye[k] -= v[4 * r + k] * v[4 * r + 3];
        }
    for (int k = 0; k < 2; ++k) {
        c.scale[k] = p[5 * k];
        c.shift[k] = p[4 * k + 2] * c.front;
    }
    return c;
}

double leave_box(const double from[3], const double direction[3], int *axis) {
    double nearest = INFINITY;
    for (int k = 0; k < 3; ++k) {
        double t = ((direction[k] > 0 ? mirror_box[k] : 0) - from[k]) / direction[k];
        if (direction[k] == 0 || t >= nearest) continue;
        nearest = t;
        *axis = k;
    }
    return nearest;
}

static struct expected expect(const struct camera *c, double u, double v) {
    struct expected e = {0};
    const double ndc[2] = {2 * u - 1, 1 - 2 * v};
    double view[3] = {(ndc[0] - c->shift[0]) / c->scale[0], (ndc[1] - c->shift[1]) / c->scale[1], c->front};
    double ray[3], point[3];
    for (int k = 0; k < 3; ++k) ray[k] = c->rows[0][k] * view[0] + c->rows[1][k] * view[1] + c->rows[2][k] * view[2];
    double length = sqrt(dot3(ray, ray));
    for (int k = 0; k < 3; ++k) ray[k] /= length;
    int axis = 0;
    double t = leave_box(c->eye, ray, &axis);
    e.on_floor = axis == 1 && ray[1] < 0;
    if (!e.on_floor) return e;
    for (int k = 0; k < 3; ++k) point[k] = c->eye[k] + t * ray[k];
    point[1] = 0;
    ray[1] = -ray[1];
    for (int k = 0; k < 3; ++k) e.start[k] = point[k];
    e.distance = leave_box(point, ray, &axis);
    double from_eye[3], seen[3];
    for (int k = 0; k < 3; ++k) {
        e.end[k] = point[k] + e.distance * ray[k];
        from_eye[k] = e.end[k] - c->eye[k];
    }
    for (int k = 0; k < 3; ++k) seen[k] = dot3(c->rows[k], from_eye);
    double depth = seen[2] * c->front;
    e.end_in_front = depth > 0;
    e.end_uv[0] = 0.5 + 0.5 * (seen[0] / depth * c->scale[0] + c->shift[0]);
    e.end_uv[1] = 0.5 - 0.5 * (seen[1] / depth * c->scale[1] + c->shift[1]);
    return e;
}

struct rays rays_of(struct gpu *gpu) {
    struct rays r = {0};
    uint32_t full_width, full_height;
    float *depth = gpu_floats(gpu, "composed", &full_width, &full_height);
    free(depth);
    uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL);
    r.travelled = gpu_floats(gpu, "travelled", &r.width, &r.height);
    r.screen_travelled = gpu_floats(gpu, "screen_travelled", NULL, NULL);
    r.finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    r.screen_end = gpu_uints(gpu, "screen_end", NULL, NULL);
    r.cubemap_end = gpu_uints(gpu, "cubemap_end", NULL, NULL);
    r.expected = calloc((size_t)r.width * r.height, sizeof *r.expected);
    assert_non_null(r.expected);
    struct camera camera = camera_of(glint_capture_frame(gpu->capture));
    for (uint32_t i = 0; i < r.width * r.height; ++i) {
        double x = 2 * (i % r.width) + (pick[i] & 1) + 0.5, y = 2 * (i / r.width) + (pick[i] >> 1 & 1) + 0.5;
        r.expected[i] = expect(&camera, x / full_width, y / full_height);
    }
    free(pick);
    return r;
}

void rays_free(struct rays *r) {
    free(r->travelled);
    free(r->screen_travelled);
    free(r->finished);
    free(r->screen_end);
    free(r->cubemap_end);
    free(r->expected);
}

double wall_light(const double p[3], int component) {
    if (component == 0) return 0.55 + 0.35 * sin(1.3 * p[0] + 0.7 * p[1]);
    if (component == 1) return 0.50 + 0.35 * sin(1.1 * p[1] + 0.9 * p[2]);
    return 0.55 + 0.35 * sin(1.2 * p[2] - 0.8 * p[0]);
}
