/* A room without a ceiling and a block in it, in closed form. */
#include "room.h"

#include <math.h>
#include <string.h>

#include "plain_capture.h"
#include "unit.h"

enum { SIZE = ROOM_SIZE, CUBE = 32 };
static const double room[2][3] = {{-3, -2.5, -7}, {4, 3.5, 1.5}}, block[2][3] = {{0.5, -2.5, -5}, {1.5, -0.5, -4}};
static const double half_view = 0.7; /* tangent of half the field of view */

struct seen {
    double distance, normal[3], color[3], roughness;
};

static void swap_axes(double v[3]) {
    const double x = v[0];
    v[0] = v[1], v[1] = x;
}

/* Where a ray enters a box from outside or leaves it from inside, and the axis that it crosses. */
static double intersect_box(const double box[2][3], const double origin[3], const double d[3], bool inside, int *axis) {
    double enter = -INFINITY, leave = INFINITY;
    int first = 0, last = 0;
    for (int k = 0; k < 3; ++k) {
        const double a = (box[0][k] - origin[k]) / d[k], b = (box[1][k] - origin[k]) / d[k];
        if (fmin(a, b) > enter) enter = fmin(a, b), first = k;
        if (fmax(a, b) < leave) leave = fmax(a, b), last = k;
    }
    *axis = inside ? last : first;
    return inside ? leave : enter > 0 && enter < leave ? enter : INFINITY;
}

/* The room has no ceiling. */
static struct seen trace_scene(const double origin[3], const double d[3]) {
    struct seen s = {0};
    int axis, of_block;
    double t = intersect_box(room, origin, d, true, &axis), behind = intersect_box(block, origin, d, false, &of_block),
           p[3], length = 0;
    const bool is_sky = axis == 1 && d[1] > 0 && t <= behind;
    if (behind < t) t = behind, axis = of_block;
    for (int k = 0; k < 3; ++k) p[k] = origin[k] + t * d[k];
    s.distance = is_sky ? INFINITY : t;
    for (int k = 0; k < 3; ++k) s.normal[k] = (k == axis) * (d[k] > 0 ? -1.0 : 1.0) + 0.15 * sin(2 * p[(k + 1) % 3]);
    for (int k = 0; k < 3; ++k) length += s.normal[k] * s.normal[k];
    for (int k = 0; k < 3; ++k) s.normal[k] /= sqrt(length);
    for (int k = 0; k < 3; ++k)
        s.color[k] =
            is_sky ? 0.3 + 0.2 * k + 0.2 * d[0] : 0.5 + 0.3 * sin((1.3 + 0.3 * k) * p[k] - 0.4 * p[(k + 2) % 3]);
    s.roughness = 0.3 + 0.28 * sin(1.1 * p[0] + 0.3) * cos(0.9 * p[2]);
    return s;
}

/* Which of the two rooms is written, and its layers; static because callbacks have no user pointer. */
static bool swapped;
static const double centers[2][3] = {{0.5, 0.3, -2.5}, {-1, -0.8, -0.5}};

static struct seen seen_from(const double origin[3], const double direction[3]) {
    double o[3], d[3];
    memcpy(o, origin, sizeof o), memcpy(d, direction, sizeof d);
    if (swapped) swap_axes(o), swap_axes(d);
    struct seen s = trace_scene(o, d);
    if (swapped) swap_axes(s.normal);
    return s;
}

static struct seen seen_by_pixel(uint32_t x, uint32_t y, double *depth_m) {
    static const double eye[3] = {0, 0, 0};
    const double d[3] = {half_view * ((2.0 * x + 1) / SIZE - 1), half_view * (1 - (2.0 * y + 1) / SIZE), -1};
    const struct seen s = seen_from(eye, d);
    *depth_m = s.distance; /* d has a depth of one metre */
    return s;
}

static void fill(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        double depth_m;
        const struct seen s = seen_by_pixel(i % SIZE, i / SIZE, &depth_m);
        values[i] = (float)depth_m;
        for (uint32_t k = 0; k < 3; ++k) {
            values[(PLAIN_NORMAL_X + k) * pixels + i] = (float)s.normal[k];
            values[(PLAIN_LIT_R + k) * pixels + i] = (float)s.color[k];
            values[(PLAIN_ALBEDO_R + k) * pixels + i] = (float)(1 - s.color[k]);
        }
        values[PLAIN_ROUGHNESS * pixels + i] = (float)s.roughness;
        values[PLAIN_METALNESS * pixels + i] = (float)(0.5 + 0.4 * s.color[1]);
    }
}

static void cube(uint32_t number, const double direction[3], float out[5]) {
    double center[3];
    memcpy(center, centers[number], sizeof center);
    if (swapped) swap_axes(center);
    const struct seen s = seen_from(center, direction);
    for (int k = 0; k < 3; ++k) out[k] = (float)s.color[k];
    out[3] = isfinite(s.distance) ? 1 : 0;
    out[4] = (float)s.distance;
}

static void sky(const double direction[3], float out[3]) {
    const double d = direction[swapped]; /* x of the first */
    for (int k = 0; k < 3; ++k) out[k] = (float)(0.3 + 0.2 * k + 0.2 * d);
}

/* A tilted sheet in front of the scene, at a fraction of its depth. */
static void sheet(uint32_t x, uint32_t y, float out[9]) {
    double depth_m, normal[3] = {0.2 * sin(0.11 * x + 0.05 * y), 0.15 * cos(0.07 * x - 0.04 * y), 1}, length = 0;
    uint32_t of_first[2] = {swapped ? SIZE - 1 - y : x, swapped ? SIZE - 1 - x : y};
    const double u = of_first[0], v = of_first[1];
    normal[0] = 0.2 * sin(0.11 * u + 0.05 * v), normal[1] = 0.15 * cos(0.07 * u - 0.04 * v);
    if (swapped) swap_axes(normal);
    for (int k = 0; k < 3; ++k) length += normal[k] * normal[k];
    const struct seen s = seen_by_pixel(x, y, &depth_m);
    for (int k = 0; k < 3; ++k)
        out[k] = (float)(0.2 + 0.5 * s.color[2 - k]), out[4 + k] = (float)(normal[k] / sqrt(length));
    out[3] = (float)(0.3 + 0.2 * sin(0.1 * u));
    out[7] = u + 2 * v > 90 && isfinite(depth_m) ? (float)((0.6 + 0.001 * u + 0.0013 * v) * depth_m) : INFINITY;
    out[8] = 0.2f;
}

void room_load(struct gpu *gpu, bool second) {
    char path[256];
    const char *name = second ? "swapped" : "room";
    struct plain plain = {.width = SIZE,
                          .height = SIZE,
                          .fov_y_degrees = 2 * atan(half_view) * 180 / 3.14159265358979323846,
                          .spoil = fill,
                          .cube_size = CUBE,
                          .cube_count = 2,
                          .cube = cube,
                          .sky = sky,
                          .water = sheet,
                          .pane = sheet,
                          .up = second ? GLINT_AXIS_X : GLINT_AXIS_Y};
    swapped = second;
    for (int i = 0; i < 2; ++i) {
        struct glint_cubemap *map = &plain.cubes[i];
        memcpy(map->center, centers[i], sizeof map->center);
        map->inner = i ? GLINT_VOLUME_SPHERE : GLINT_VOLUME_BOX;
        for (int k = 0; k < 3; ++k)
            map->box_min[k] = 0.9 * room[0][k] - centers[i][k], map->box_max[k] = 0.8 * room[1][k] - centers[i][k];
        map->sphere_center[0] = 0.2, map->sphere_center[1] = -0.3;
        map->sphere_radius = 1.5;
        if (second)
            swap_axes(map->center), swap_axes(map->box_min), swap_axes(map->box_max), swap_axes(map->sphere_center);
    }
    plain_capture(gpu_path(gpu, name, path), &plain);
    gpu_load(gpu, name);
}

void room_arrange(struct gpu *gpu, const char *const *words) {
    static const char *const always[] = {"downsample=bilinear", "downsample.jitter=false",
                                         "cubemap_trace.random_scale=false", "resolve.fog=false", NULL};
    gpu_reset(gpu);
    gpu->float_precision = gpu->all = true;
    for (const char *const *lists[] = {always, words}, *const **list = lists; list < lists + 2; ++list)
        for (const char *const *word = *list; *word; ++word) {
            const char *dot = strchr(*word, '.');
            if (dot && dot < strchr(*word, '=')) gpu_set(gpu, *word);
            else gpu_use(gpu, *word);
        }
}
