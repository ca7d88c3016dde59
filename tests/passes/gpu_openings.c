/* Rays of cubemap_trace/exact through openings: a room with a window in one wall and a door in another, a second room with its own
   window behind the door, a house opposite and the sky outside; one cube map in each of the three. Everything is made of boxes, whose
   closed form also determines which points a cube map sees. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "end_reason_names.h"
#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 96, CUBE = 128, MAPS = 3, PLACES = 60, NO_PLACE = 255 };
static const double half_view = 1; /* tangent of half the field of view */
static const double sky_light = 4, wall_light = 0.1;

/* The camera at the origin looks along -z. First room: -3 < x < 2, second room: 2.3 < x < 6, both -1.5 < y < 1.5, -6 < z < 1. */
static const double boxes[][2][3] = {
    {{-20, -1.8, -20}, {20, -1.5, 20}},   {{-3.3, 1.5, -6.3}, {6.3, 1.8, 1.3}}, /* ground and roof */
    {{-3.3, -1.5, -6.3}, {6.3, 1.5, -6}}, {{6, -1.5, -6}, {6.3, 1.5, 1.3}},     /* walls without an opening */
    {{-3.3, -1.5, -6}, {-3, 1.5, -4.5}},  {{-3.3, -1.5, -2}, {-3, 1.5, 1.3}},   /* beside the window, */
    {{-3.3, -1.5, -4.5}, {-3, -0.5, -2}}, {{-3.3, 1, -4.5}, {-3, 1.5, -2}},     /* below and above it */
    {{2, -1.5, -6}, {2.3, 1.5, -4}},      {{2, -1.5, -2.8}, {2.3, 1.5, 1}},     /* beside the door, */
    {{2, 0.6, -4}, {2.3, 1.5, -2.8}},                                           /* above it */
    {{-3, -1.5, 1}, {3, 1.5, 1.3}},       {{5, -1.5, 1}, {6, 1.5, 1.3}},        /* beside the second window, */
    {{3, -1.5, 1}, {5, -0.5, 1.3}},       {{3, 1, 1}, {5, 1.5, 1.3}},           /* below and above it */
    {{-14, -1.5, -8}, {-10, 1, -3}},                                            /* the house opposite */
    {{-3.3, -0.5, -4.5}, {-3, 1, -2}},    {{2, -1.5, -4}, {2.3, 0.6, -2.8}},
    {{3, -0.5, 1}, {5, 1, 1.3}}, /* covers of window, door and second window */
};
enum { OPENINGS = 3 };
static const double centers[MAPS][3] = {{-0.5, 0.2, -2.5}, {4.2, 0.2, -2}, {-6.5, 0.4, -2.5}};

/* Whether the openings are closed, and the first cube map of the capture; static because callbacks have no user pointer. */
static bool closed;
static uint32_t first_map;

/* The distance at which a ray enters a box; +inf: never. */
static double distance_to_box(const double origin[3], const double d[3], int *axis) {
    double nearest = INFINITY;
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes - (closed ? 0 : OPENINGS); ++i) {
        double enter = 0, leave = INFINITY;
        int across = 0;
        for (int k = 0; k < 3; ++k) {
            const double a = (boxes[i][0][k] - origin[k]) / d[k], b = (boxes[i][1][k] - origin[k]) / d[k];
            if (fmin(a, b) > enter) enter = fmin(a, b), across = k;
            leave = fmin(leave, fmax(a, b));
        }
        if (enter <= 0 || enter >= leave || enter >= nearest) continue;
        nearest = enter;
        if (axis) *axis = across;
    }
    return nearest;
}

static void cube(uint32_t number, const double d[3], float out[5]) {
    const double distance = distance_to_box(centers[first_map + number], d, NULL);
    out[0] = out[1] = out[2] = (float)(isinf(distance) ? 0 : wall_light);
    out[3] = isinf(distance) ? 0.0F : 1.0F;
    out[4] = (float)distance;
}

static void sky(UNUSED const double d[3], float out[3]) {
    out[0] = out[1] = out[2] = (float)sky_light;
}

/* The surface of a pixel, and its mirror ray. */
struct ray {
    double depth_m, normal[3], start[3], d[3];
};
static struct ray ray_of(uint32_t x, uint32_t y) {
    struct ray ray = {0};
    const double eye[3] = {0, 0, 0};
    double d[3] = {half_view * ((2.0 * x + 1) / SIZE - 1), half_view * (1 - (2.0 * y + 1) / SIZE), -1};
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + 1);
    int axis = 0;
    ray.depth_m = distance_to_box(eye, d, &axis);
    ray.normal[axis] = d[axis] > 0 ? -1 : 1;
    for (int k = 0; k < 3; ++k) {
        ray.start[k] = ray.depth_m * d[k];
        ray.d[k] = (k == axis ? -d[k] : d[k]) / length;
    }
    return ray;
}

static void fill(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const struct ray ray = ray_of(i % SIZE, i / SIZE);
        values[i] = (float)ray.depth_m;
        for (uint32_t k = 0; k < 3; ++k) {
            values[(PLAIN_NORMAL_X + k) * pixels + i] = (float)ray.normal[k];
            values[(PLAIN_LIT_R + k) * pixels + i] = (float)(isinf(ray.depth_m) ? sky_light : wall_light);
        }
    }
}

static void capture(struct gpu *gpu, uint32_t first, uint32_t count) {
    char path[256];
    struct plain plain = {.width = SIZE,
                          .height = SIZE,
                          .fov_y_degrees = 2 * atan(half_view) * 180 / 3.14159265358979323846,
                          .spoil = fill,
                          .cube_size = CUBE,
                          .cube_count = count,
                          .cube = cube,
                          .sky = sky};
    first_map = first;
    for (uint32_t i = 0; i < plain.cube_count; ++i) {
        memcpy(plain.cubes[i].center, centers[first + i], sizeof centers[0]);
        plain.cubes[i].outdoor = first + i == 2;
    }
    const char *name = closed ? "closed" : "openings";
    plain_capture(gpu_path(gpu, name, path), &plain);
    gpu_load(gpu, name);
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, "cubemap_trace=exact");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_set(gpu, "screen_trace.length_m=0");
}

/* Whether a cube map sees a point and has nothing nearer beside it, where texels of both would decide. */
static bool sees_point(int map, const double at[3]) {
    const double beside = 2.0 / CUBE; /* a texel of a face, which is two wide */
    for (int i = 0; i < 7; ++i) {
        double way[3], distance = 0;
        for (int k = 0; k < 3; ++k) way[k] = at[k] - centers[map][k], distance += way[k] * way[k];
        if (i > 0) way[(i - 1) / 2] += (i % 2 ? beside : -beside) * sqrt(distance);
        if (distance_to_box(centers[map], way, NULL) < (i > 0 ? 0.95 : 1 - 1e-6)) return false;
    }
    return true;
}

/* Whether every point of the ray up to its end is visible from some cube map; for the sky up to a great distance. */
static bool seen_all_the_way(const struct ray *ray, double end_m) {
    for (int i = 0; i <= PLACES; ++i) {
        double at[3], part = i / (double)PLACES;
        const double t = isinf(end_m) ? 1000 * part * part * part : part * end_m;
        bool any = false;
        for (int k = 0; k < 3; ++k) at[k] = ray->start[k] + t * ray->d[k];
        for (int map = 0; map < MAPS && !any; ++map) any = sees_point(map, at);
        if (!any) return false;
    }
    return true;
}

struct count {
    size_t rays, right;
};
static void print_count(const char *what, struct count c) {
    print_message("# %-64s %5zu of %5zu (%.2f %%)\n", what, c.right, c.rays, 100 * (double)c.right / (double)c.rays);
}
static void add(struct count *c, bool right) {
    c->rays++;
    c->right += right;
}

static void rays_end_where_a_cube_map_sees_them(void **state) {
    struct gpu *gpu = *state;
    closed = false;
    capture(gpu, 0, MAPS);
    gpu_run(gpu);
    float *travelled = gpu_floats(gpu, "travelled", NULL, NULL),
          *light = gpu_floats(gpu, "reflection_half", NULL, NULL);
    uint32_t *place = gpu_uints(gpu, "cubemap_index", NULL, NULL);
    struct count met = {0}, in_sky = {0}, sky_hidden = {0}, walls = {0}, through = {0}, endless = {0};
    for (uint32_t i = 0; i < SIZE * SIZE; ++i) {
        const struct ray ray = ray_of(i % SIZE, i / SIZE);
        if (isinf(ray.depth_m)) continue;
        const double end_m = distance_to_box(ray.start, ray.d, NULL), found_m = (double)travelled[i];
        const bool seen = seen_all_the_way(&ray, end_m);
        const bool bright = (double)light[4 * i] > 0.5 * sky_light;
        if (isinf(end_m)) add(seen ? &in_sky : &sky_hidden, bright && isinf(found_m));
        else {
            if (seen) add(&met, fabs(found_m / end_m - 1) < 0.02);
            add(&walls, !bright);
            add(&through, found_m < 1.05 * end_m);
        }
        if (isinf(found_m)) {
            const bool none = place[i] == NO_PLACE;
            add(&endless, none || (place[i] < MAPS && isinf(distance_to_box(centers[place[i]], ray.d, NULL))));
        }
    }
    print_count("surfaces, seen all the way: met within 2 %", met);
    print_count("sky, seen all the way: found", in_sky);
    print_count("sky, partly hidden from all cube maps: found", sky_hidden);
    print_count("surfaces, whatever is seen: not taken for the sky", walls);
    print_count("surfaces, whatever is seen: not gone through", through);
    print_count("rays without an end: no cube map shows a surface there", endless);
    /* The others are within two texels of an edge: fewer than one in fifty of the 128 texels of a face. */
    assert_true(met.rays > 8000 && met.right * 50 > met.rays * 49);
    assert_true(in_sky.rays > 200 && in_sky.right * 50 > in_sky.rays * 49);
    assert_true(walls.right * 500 > walls.rays * 499 && through.right * 100 > through.rays * 99);
    /* They pass behind the house, or what is beside a window, in front of the sky, and mostly end in the sky. */
    assert_true(sky_hidden.rays > 50 && sky_hidden.right * 3 > sky_hidden.rays * 2);
    assert_true(endless.rays > 200 && endless.right == endless.rays);
    free(travelled);
    free(light);
    free(place);
}

/* With closed openings only the second room has a cube map: the first room is unknown, and rays that continued through the wall between
   them would become visible again behind it. */
static void no_ray_comes_through_a_wall(void **state) {
    struct gpu *gpu = *state;
    closed = true;
    capture(gpu, 1, 1);
    gpu_run(gpu);
    uint32_t *end = gpu_uints(gpu, "cubemap_end", NULL, NULL);
    struct count in_shadow = {0};
    for (uint32_t i = 0; i < SIZE * SIZE; ++i) add(&in_shadow, end[i] == END_shadow_region);
    print_count("rays of a closed room without a cube map: none is seen", in_shadow);
    assert_int_equal(in_shadow.right, in_shadow.rays);
    free(end);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(rays_end_where_a_cube_map_sees_them),
                                       cmocka_unit_test(no_ray_comes_through_a_wall)};
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, gpu_set_up, gpu_tear_down);
}
