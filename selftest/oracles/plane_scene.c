/* A picture full of edges. All is made in view space; the camera is turned against the world. */
#include "oracles/plane_scene.h"

#include <math.h>

#include "oracles/noise.h"

static const double degrees = 70;

const double plane_scene_eye[3] = {3.108, -0.356, -0.06};

/* A rotation about all axes, then a place that is no round number. */
static const double *turned_camera(void) {
    static const double rows[16] = {0.48, 0.64, -0.6, -1.3, -0.8, 0.6, 0, 2.7, 0.36, 0.48, 0.8, -0.9, 0, 0, 0, 1};
    return rows;
}

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalised(const double v[3], double out[3]) {
    const double length = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++) out[k] = v[k] / length;
}

/* The point at depth 1 that a pixel sees. */
static void view_of(const struct plain *plain, uint32_t i, double view[3]) {
    const double slope = tan(degrees * 3.14159265358979323846 / 360) / (0.5 * plain->height);
    view[0] = ((double)(i % plain->width) + 0.5 - 0.5 * plain->width - plain->jitter_px[0]) * slope;
    view[1] = -((double)(i / plain->width) + 0.5 - 0.5 * plain->height - plain->jitter_px[1]) * slope;
    view[2] = -1;
}

struct surface {
    double depth_m, normal[3];
};

/* The plane n·p = d where it is in front and nearer than what was there. */
static void put_surface(struct surface *s, const double view[3], const double normal[3], double d) {
    const double depth_m = d / dot(normal, view);
    if (!(depth_m > 0.2) || depth_m >= s->depth_m) return;
    s->depth_m = depth_m;
    for (int k = 0; k < 3; k++) s->normal[k] = dot(normal, view) < 0 ? normal[k] : -normal[k];
}

/* Boards that stand about, each a piece of a plane within a rectangle of the picture. */
static void put_boards(struct surface *s, const struct plane_scene *scene, const double part[2], const double view[3]) {
    for (uint32_t b = 0; b < 14; b++) {
        double n[6], place[2], half[2], normal[3], to[3];
        for (uint32_t k = 0; k < 6; k++) n[k] = noise(scene->seed + b, k);
        for (int k = 0; k < 2; k++) {
            place[k] = n[k];
            half[k] = 0.02 + 0.13 * n[2 + k];
        }
        if (fabs(part[0] - place[0]) > half[0] || fabs(part[1] - place[1]) > half[1]) continue;
        const double tilted[3] = {1.6 * (n[4] - 0.5), 1.6 * (n[5] - 0.5), 1};
        normalised(tilted, normal);
        to[0] = 2.4 * (place[0] - 0.5), to[1] = -1.4 * (place[1] - 0.5), to[2] = -1;
        put_surface(s, view, normal, (2 + 7 * noise(scene->seed + b, 6)) * dot(normal, to));
    }
}

static struct surface surface_of(const struct plain *plain, const struct plane_scene *scene, uint32_t i,
                                 const double view[3]) {
    static const double wall[3] = {-0.28, 0, 0.96}, floor[3] = {0, 1, 0}, side[3] = {-1, 0, 0}, facing[3] = {0, 0, 1};
    const uint32_t x = i % plain->width, y = i / plain->width;
    const double part[2] = {(x + 0.5) / plain->width, (y + 0.5) / plain->height};
    struct surface s = {.depth_m = INFINITY, .normal = {0, 0, 1}};
    if (scene->flat_m[0] > 0) {
        const double part_of = noise(scene->seed + 300, i);
        s.depth_m = scene->flat_m[0] * pow(scene->flat_m[1] / scene->flat_m[0], part_of);
        return s;
    }
    put_surface(&s, view, floor, -1.1);
    put_surface(&s, view, side, -4);
    if (part[1] > 0.3 || part[0] < 0.4) put_surface(&s, view, wall, -11); /* above it, to the right: sky */
    if (scene->rails) { /* at places in the world: which pixels they fill is the camera's affair */
        for (int k = 0; k < 5; k++) {
            const double at = -2 + 0.9 * k,
                         half = 0.5 * tan(degrees * 3.14159265358979323846 / 360) / (0.5 * plain->height);
            if (fabs(view[0] - at / 3) <= half) put_surface(&s, view, facing, -3);
            if (k < 2 && fabs(view[1] - (at + 1) / 4) <= half) put_surface(&s, view, facing, -4);
        }
    } else if (scene->stipples) {
        const bool checks = (x ^ y) & 1, columns = x & 1, rows = y % 3 == 0;
        if (part[0] < 0.33 ? checks : part[0] < 0.66 ? columns : rows)
            put_surface(&s, view, facing, part[1] < 0.5 ? -3 : -2);
    } else {
        put_boards(&s, scene, part, view);
    }
    return s;
}

/* A direction into which the viewer's ray can be reflected. */
static void wanted_ray(const struct plane_scene *scene, uint32_t i, const double view[3], double ray[3]) {
    double random[3], unit[3];
    for (uint32_t k = 0; k < 3; k++) random[k] = 2 * noise(scene->seed + 100, 3 * i + k) - 1;
    normalised(view, unit);
    for (int k = 0; k < 3; k++) ray[k] = random[k];
    if (scene->rays == RAYS_AXES) {
        for (uint32_t k = 0; k < 3; k++) ray[k] = k == i % 3 ? (i / 3 % 2 ? 1 : -1) : 0;
    } else if (scene->rays == RAYS_PARALLEL) {
        ray[2] = 0;
    } else if (scene->rays == RAYS_BACK) {
        for (int k = 0; k < 3; k++) ray[k] = -unit[k];
    } else if (scene->rays == RAYS_CORNERS) {
        const double *camera = turned_camera(), beside = i % 4 ? pow(10, -2.0 - 2 * (double)(i % 4)) : 0;
        double world[3] = {0};
        uint32_t ways = 1 + (uint32_t)(26 * noise(scene->seed + 400, i)); /* of 27 without the one that is none */
        if (ways >= 14) ways++;
        for (uint32_t k = 0; k < 3; k++, ways /= 3) world[k] = (double)(ways % 3) - 1 + beside * random[k];
        if (world[0] == 0 && world[1] == 0 && world[2] == 0) world[0] = 1;
        for (int r = 0; r < 3; r++) ray[r] = dot(camera + 4 * r, world);
    } else if (scene->rays == RAYS_NEAR) { /* to a place beside the camera */
        for (int k = 0; k < 3; k++) ray[k] = 0.3 * random[k] - 3 * unit[k];
    }
    normalised(ray, ray);
}

static void normal_for(const struct plane_scene *scene, uint32_t i, const double view[3], double normal[3]) {
    double ray[3], unit[3], across[3];
    if (scene->rays == RAYS_MIRROR) return;
    wanted_ray(scene, i, view, ray);
    normalised(view, unit);
    if (scene->rays != RAYS_ON && scene->rays != RAYS_GRAZING) {
        for (int k = 0; k < 3; k++) normal[k] = ray[k] - unit[k];
        normalised(normal, normal);
        return;
    }
    const double along = dot(ray, unit), cosine = scene->rays == RAYS_ON ? 0 : pow(10, -1.0 - (double)(i % 7));
    for (int k = 0; k < 3; k++) across[k] = ray[k] - along * unit[k];
    normalised(across, across);
    for (int k = 0; k < 3; k++) normal[k] = sqrt(1 - cosine * cosine) * across[k] - cosine * unit[k];
}

static void fill_surfaces(const struct plain *plain, float *values) {
    const struct plane_scene *scene = plain->user;
    const size_t pixels = (size_t)plain->width * plain->height;
    const double *camera = plain->world_to_view;
    for (uint32_t i = 0; i < pixels; i++) {
        double view[3];
        view_of(plain, i, view);
        struct surface s = surface_of(plain, scene, i, view);
        normal_for(scene, i, view, s.normal);
        values[PLAIN_DEPTH * pixels + i] = (float)s.depth_m;
        values[PLAIN_ROUGHNESS * pixels + i] = (float)scene->roughness;
        for (int k = 0; k < 3; k++) {
            const double column[3] = {camera[k], camera[4 + k], camera[8 + k]};
            values[(size_t)(PLAIN_NORMAL_X + k) * pixels + i] = (float)dot(column, s.normal);
            values[(size_t)(PLAIN_LIT_R + k) * pixels + i] = (float)noise(scene->seed + 200, 3 * i + (uint32_t)k);
        }
    }
}

struct plain plane_scene_capture(const struct plane_scene *scene, uint32_t width, uint32_t height) {
    return (struct plain){.width = width,
                          .height = height,
                          .fov_y_degrees = degrees,
                          .world_to_view = turned_camera(),
                          .spoil = fill_surfaces,
                          .user = scene};
}
