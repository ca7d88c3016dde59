/* Right-handed view space with the view along -Z; NDC +1 is at the top; jitter is part of view_to_clip. */
#include "view.h"

#include "noise.h"

struct axes {
    double right[3], up[3], forward[3];
};

static void crossed(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalised(double v[3]) {
    double l = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] /= l;
}

static struct axes axes_of_view(const double eye[3], const double target[3]) {
    struct axes axes;
    for (int i = 0; i < 3; i++) axes.forward[i] = target[i] - eye[i];
    normalised(axes.forward);
    /* If the view is vertical, the world's up does not determine that of the image. */
    const double up[3] = {0, 1, 0}, ahead[3] = {0, 0, -1};
    crossed(axes.forward, fabs(axes.forward[1]) > 0.9999 ? ahead : up, axes.right);
    normalised(axes.right);
    crossed(axes.right, axes.forward, axes.up);
    return axes;
}

static void projection(struct view *view, enum glint_depth_encoding depth, double fov_y_rad) {
    double *m = view->camera.view_to_clip, n = VIEW_NEAR, f = VIEW_FAR;
    double b = 1 / tan(fov_y_rad / 2), a = b * view->height / view->width;
    m[0] = a;
    m[2] = -2 * view->jitter_px[0] / view->width;
    m[5] = b;
    m[6] = 2 * view->jitter_px[1] / view->height;
    m[14] = -1;
    switch (depth) {
    case GLINT_DEPTH_DEVICE:
        m[10] = -f / (f - n);
        m[11] = -n * f / (f - n);
        break;
    case GLINT_DEPTH_REVERSED:
        m[10] = n / (f - n);
        m[11] = n * f / (f - n);
        break;
    default:
        m[11] = n; /* reversed, with an infinite far plane */
    }
}

struct view view_through(const struct scene *scene, const struct glint_sample_options *options, uint32_t width,
                         uint32_t height, int64_t number, uint32_t place) {
    struct view view = {.width = width, .height = height};
    double time = (double)number - 1, target[3];
    const vec3 starts[2] = {scene->eye, scene->target}, steps[2] = {scene->eye_step, scene->target_step};
    for (int i = 0; i < 2; i++) {
        const float start[3] = {starts[i].x, starts[i].y, starts[i].z}, step[3] = {steps[i].x, steps[i].y, steps[i].z};
        const double *given = i ? options->target : options->eye;
        for (int k = 0; k < 3; k++) {
            double moves = options->travel_given ? options->travel[k] : options->camera_given ? 0 : (double)step[k];
            (i ? target : view.eye)[k] = (options->camera_given ? given[k] : (double)start[k]) + time * moves;
        }
    }
    struct axes axes = axes_of_view(view.eye, target);
    double *m = view.camera.world_to_view;
    for (int k = 0; k < 3; k++) {
        m[k] = axes.right[k];
        m[4 + k] = axes.up[k];
        m[8 + k] = -axes.forward[k];
    }
    for (int row = 0; row < 3; row++)
        m[4 * row + 3] = -(m[4 * row] * view.eye[0] + m[4 * row + 1] * view.eye[1] + m[4 * row + 2] * view.eye[2]);
    m[15] = 1;
    if (place < VIEW_PLACES) {
        view.jitter_px[0] = radical_inverse(place, 2) - 0.5;
        view.jitter_px[1] = radical_inverse(place, 3) - 0.5;
    }
    double fov = options->fov_y_rad > 0 ? options->fov_y_rad : (double)scene->fov_y_rad;
    projection(&view, options->encodings.depth, fov);
    view.pixel_rad = (float)(2 * tan(fov / 2) / height);
    return view;
}

struct view view_at(const struct scene *scene, const struct glint_sample_options *options, uint32_t width,
                    uint32_t height, int64_t number) {
    uint32_t place = options->unjittered ? VIEW_PLACES : (uint32_t)(number & (VIEW_PLACES - 1));
    return view_through(scene, options, width, height, number, place);
}

vec3 view_ray(const struct view *view, uint32_t x, uint32_t y) {
    return view_ray_at(view, x + 0.5, y + 0.5);
}

vec3 view_ray_at(const struct view *view, double x, double y) {
    const double *p = view->camera.view_to_clip, *m = view->camera.world_to_view;
    double px = ((2 * x / view->width - 1) + p[2]) / p[0];
    double py = ((1 - 2 * y / view->height) + p[6]) / p[5];
    return v3((float)(m[0] * px + m[4] * py - m[8]), (float)(m[1] * px + m[5] * py - m[9]),
              (float)(m[2] * px + m[6] * py - m[10]));
}

vec3 view_eye(const struct view *view) {
    return v3((float)view->eye[0], (float)view->eye[1], (float)view->eye[2]);
}

double view_depth(const struct view *view, vec3 point) {
    const double *m = view->camera.world_to_view + 8;
    return -(m[0] * (double)point.x + m[1] * (double)point.y + m[2] * (double)point.z + m[3]);
}

bool view_project(const struct view *view, vec3 point, double w, double uv[2]) {
    const double *p = view->camera.view_to_clip, *m = view->camera.world_to_view;
    double in[4] = {(double)point.x, (double)point.y, (double)point.z, w}, v[3] = {0};
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 4; k++) v[row] += m[4 * row + k] * in[k];
    uv[0] = uv[1] = 0;
    if (!(v[2] < 0)) return false;
    uv[0] = 0.5 + 0.5 * (p[0] * v[0] + p[2] * v[2]) / -v[2];
    uv[1] = 0.5 - 0.5 * (p[5] * v[1] + p[6] * v[2]) / -v[2];
    return true;
}
