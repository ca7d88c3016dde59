/* hiz/nearest, screen_trace/hiz and screen_trace/dda compared with depth_traversal.c in double precision, with each other at odd sizes
   and depth encodings, and with closed forms for special rays. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "end_reason_names.h"
#include "gpu.h"
#include "plain_capture.h"
#include "depth_traversal.h"
#include "unit.h"

struct traced {
    uint32_t width, height;
    float *travelled;
    uint32_t *finished, *end, *fetches, *steps;
};

/* Traces screen rays only, for every pixel. */
static void load_screen_trace(struct gpu *gpu, const char *variant) {
    static const char *const without[] = {
        "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", "compose", NULL};
    char text[64];
    gpu_reset(gpu);
    gpu_without(gpu, without);
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_use(gpu, "hiz=nearest");
    snprintf(text, sizeof text, "screen_trace=%s", variant);
    gpu_use(gpu, text);
    gpu->all = true;
}

static struct traced trace_screen(struct gpu *gpu) {
    struct traced t = {0};
    gpu_run(gpu);
    t.travelled = gpu_floats(gpu, "screen_travelled", &t.width, &t.height);
    t.finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    t.end = gpu_uints(gpu, "screen_end", NULL, NULL);
    t.fetches = gpu_uints(gpu, "screen_fetches", NULL, NULL);
    t.steps = gpu_uints(gpu, "screen_steps", NULL, NULL);
    return t;
}

static void traced_free(struct traced *t) {
    free(t->travelled);
    free(t->finished);
    free(t->end);
    free(t->fetches);
    free(t->steps);
}

/* Rays that end in the sky are not hits. */
static bool is_hit(const struct traced *t, size_t i) {
    return t->finished[i] != 0 && t->travelled[i] < 3e38f;
}

/* Agreement of pairs of rays. flips: one hits, the other misses. */
struct agreement {
    size_t rays, hits, flips, far, lost, invented;
};

static void count(struct agreement *a, bool hit, bool expected, double pixels) {
    ++a->rays;
    a->hits += expected;
    a->flips += hit != expected;
    a->lost += expected && !hit;
    a->invented += hit && !expected;
    a->far += hit && expected && !(pixels <= 1.5);
}

static void print_and_check(const struct agreement *a, const char *what) {
    print_message("# %s: %zu rays, %zu hits; %zu flips (%zu lost, %zu invented), %zu ends more than 1.5 pixels off\n",
                  what, a->rays, a->hits, a->flips, a->lost, a->invented, a->far);
    assert_true(a->hits * 10 > a->rays);
    /* Where a ray grazes a silhouette or its own surface, rounding decides, and the two may differ. */
    assert_true(1000 * a->flips <= 5 * a->rays);
    assert_true(1000 * a->far <= 5 * a->hits);
}

/* The depth buffer that rays are traced in. */
struct paths {
    float *depth_m, *normal;
    struct depth_grid grid;
};

static struct paths paths_of(struct gpu *gpu, const struct traced *t) {
    struct paths p = {gpu_floats(gpu, "depth_half", NULL, NULL), gpu_floats(gpu, "normal_half", NULL, NULL), {0}};
    depth_grid_init(&p.grid, glint_capture_frame(gpu->capture), t->width, t->height, p.depth_m, p.normal);
    return p;
}

static void paths_free(struct paths *p) {
    free(p->depth_m);
    free(p->normal);
}

static bool path(const struct paths *p, size_t i, struct depth_ray *ray) {
    return depth_ray_init(ray, &p->grid, (uint32_t)(i % p->grid.width), (uint32_t)(i / p->grid.width));
}

static double apart(const struct paths *paths, size_t i, double a, double b) {
    struct depth_ray ray;
    double p[2], q[2], depth;
    if (!path(paths, i, &ray) || !depth_ray_project(&paths->grid, &ray, a, p, &depth) ||
        !depth_ray_project(&paths->grid, &ray, b, q, &depth))
        return INFINITY;
    return hypot(p[0] - q[0], p[1] - q[1]);
}

static double pixels_apart(const struct paths *paths, size_t i, const struct traced *a, const struct traced *b) {
    return apart(paths, i, (double)a->travelled[i], (double)b->travelled[i]);
}

static void against_the_walk(struct gpu *gpu, const char *scene) {
    static const char *const variants[2] = {"dda", "hiz"};
    char what[64];
    gpu_sample(gpu, scene, scene, &(struct glint_sample_options){.width = 320, .height = 180, .cube_size = 8});
    for (int v = 0; v < 2; ++v) {
        struct agreement a = {0};
        load_screen_trace(gpu, variants[v]);
        struct traced t = trace_screen(gpu);
        struct paths paths = paths_of(gpu, &t);
        for (size_t i = 0; i < (size_t)t.width * t.height; ++i) {
            struct depth_ray ray;
            const bool has_ray = path(&paths, i, &ray);
            assert_int_equal(has_ray, t.end[i] != END_not_traced);
            if (!has_ray) continue;
            double distance;
            bool expected = traversal_hit(&paths.grid, &ray, &traversal_rules_default, &distance);
            count(&a, is_hit(&t, i), expected, apart(&paths, i, (double)t.travelled[i], distance));
        }
        snprintf(what, sizeof what, "%s on %s", variants[v], scene);
        print_and_check(&a, what);
        traced_free(&t);
        paths_free(&paths);
    }
}

static void on_mirror_box_as_in_double(void **state) {
    against_the_walk(*state, "mirror_box");
}
static void on_street_as_in_double(void **state) {
    against_the_walk(*state, "street");
}
static void on_room_as_in_double(void **state) {
    against_the_walk(*state, "room");
}

/* Rays of both variants. They use the same arithmetic, so that only ties between two texels may differ. */
static void hiz_as_dda(struct gpu *gpu, const char *what) {
    struct agreement a = {0};
    load_screen_trace(gpu, "dda");
    struct traced expected = trace_screen(gpu);
    load_screen_trace(gpu, "hiz");
    gpu_set(gpu, "screen_trace.cells=65536"); /* compares paths, not limits */
    gpu_set(gpu, "screen_trace.cells_lq=65536");
    struct traced t = trace_screen(gpu);
    double fetches = 0, texels = 0;
    struct paths paths = paths_of(gpu, &t);
    for (size_t i = 0; i < (size_t)t.width * t.height; ++i) {
        if (t.end[i] == END_not_traced) continue;
        count(&a, is_hit(&t, i), is_hit(&expected, i), pixels_apart(&paths, i, &t, &expected));
        if (expected.steps[i] < 64) continue;
        fetches += t.fetches[i];
        texels += expected.steps[i];
    }
    print_message("# %s, %u x %u: %zu rays, %zu hits, hiz lost %zu, invented %zu, moved %zu; rays over 64 texels: %.3f "
                  "of the fetches\n",
                  what, t.width, t.height, a.rays, a.hits, a.lost, a.invented, a.far,
                  texels > 0 ? fetches / texels : 0);
    assert_true(10000 * (a.flips + a.far) <= a.rays);
    if (t.width > 600) assert_true(2 * fetches <= texels); /* far fewer for larger images, see tools/traces.py */
    paths_free(&paths);
    traced_free(&expected);
    traced_free(&t);
}

static void at_odd_sizes_as_texel_by_texel(void **state) {
    struct gpu *gpu = *state;
    static const uint32_t sizes[][2] = {{641, 359}, {7, 3}, {1, 1}, {33, 2}, {130, 65}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        char name[32];
        snprintf(name, sizeof name, "odd%zu", i);
        gpu_sample(gpu, "street", name,
                   &(struct glint_sample_options){.width = sizes[i][0], .height = sizes[i][1], .cube_size = 8});
        hiz_as_dda(gpu, "street");
    }
}

static void at_1919_by_1079_as_texel_by_texel(void **state) {
    gpu_sample(*state, "street", "large",
               &(struct glint_sample_options){.width = 1919, .height = 1079, .cube_size = 8});
    hiz_as_dda(*state, "street");
}

/* Every cell of a level contains the minimum and maximum of all texels of level 0 within it, including incomplete cells. */
static void parents_cover_all_children(void **state) {
    struct gpu *gpu = *state;
    gpu_sample(gpu, "street", "odd4", &(struct glint_sample_options){.width = 130, .height = 65, .cube_size = 8});
    load_screen_trace(gpu, "hiz");
    gpu_run(gpu);
    uint32_t width, height, size[2];
    float *texels = gpu_floats(gpu, "hiz", &width, &height), *depth_m = gpu_floats(gpu, "depth_half", NULL, NULL);
    for (uint32_t i = 0; i < width * height; ++i)
        assert_true(depth_m[i] == INFINITY ? texels[2 * i] == -1 && texels[2 * i + 1] == 0
                                           : texels[2 * i] * depth_m[i] > 1 && texels[2 * i] * depth_m[i] <= 2.01f &&
                                                 texels[2 * i + 1] * depth_m[i] <= 1.0000002f);
    for (uint32_t level = 1; level <= 6; ++level) { /* 2 × 1 is the last level whose size is rounded down everywhere */
        char name[32];
        snprintf(name, sizeof name, "hiz.level%u", level);
        float *cells = gpu_floats(gpu, name, &size[0], &size[1]);
        assert_int_equal(size[0], width >> level);
        assert_int_equal(size[1], height >> level);
        for (uint32_t c = 0; c < size[0] * size[1]; ++c) {
            float nearest = -1, farthest = INFINITY;
            for (uint32_t i = 0; i < width * height; ++i) {
                uint32_t x = i % width >> level, y = i / width >> level;
                x = x < size[0] ? x : size[0] - 1;
                y = y < size[1] ? y : size[1] - 1;
                if (y * size[0] + x != c) continue;
                nearest = fmaxf(nearest, texels[2 * i]);
                farthest = fminf(farthest, texels[2 * i + 1]);
            }
            assert_true(cells[2 * c] == nearest && cells[2 * c + 1] == farthest);
        }
        free(cells);
    }
    free(texels);
    free(depth_m);
}

static void reversed_depth_gives_the_same_hits(void **state) {
    struct gpu *gpu = *state;
    static const enum glint_depth_encoding encodings[2] = {GLINT_DEPTH_DEVICE, GLINT_DEPTH_REVERSED};
    struct traced t[2];
    struct agreement a = {0};
    for (int i = 0; i < 2; ++i) {
        struct glint_sample_options options = {.width = 320, .height = 180, .cube_size = 8};
        options.encodings.depth = encodings[i];
        gpu_sample(gpu, "street", i ? "reversed" : "device", &options);
        load_screen_trace(gpu, "hiz");
        t[i] = trace_screen(gpu);
    }
    struct paths paths = paths_of(gpu, &t[1]);
    for (size_t i = 0; i < (size_t)t[0].width * t[0].height; ++i)
        if (t[0].end[i] != END_not_traced)
            count(&a, is_hit(&t[0], i), is_hit(&t[1], i), pixels_apart(&paths, i, &t[0], &t[1]));
    print_and_check(&a, "device against reversed depth");
    paths_free(&paths);
    traced_free(&t[0]);
    traced_free(&t[1]);
}

/* ---- Special rays. The camera looks along -z from the origin at the wall z = -5 m; pixels are square. ---- */

enum { WIDE = 65, HIGH = 37 }; /* odd, so that the centre of a pixel is on the optical axis */
static const double degrees = 60, wall_m = 5;

static double slope_of(double x, double size) { /* metres sideways per metre of depth, at the centre of a pixel */
    return (2 * (x + 0.5) - size) / HIGH * tan(degrees * 3.14159265358979323846 / 360);
}

static float *plane_of(const struct plain *plain, float *values, enum plain_channel channel) {
    return values + (size_t)channel * plain->width * plain->height;
}

/* The central pixel is isolated at 3 m, and its normal reflects its ray along (x, y, z). */
static const double start_m = 3;
static double ray[3];
static void turn_the_middle(const struct plain *plain, float *values) {
    const size_t middle = (size_t)(HIGH / 2) * WIDE + WIDE / 2;
    plane_of(plain, values, PLAIN_DEPTH)[middle] = (float)start_m;
    double normal[3] = {ray[0], ray[1], ray[2] + 1},
           length = 0; /* halfway between the ray and the direction to the viewer */
    for (int k = 0; k < 3; ++k) length += normal[k] * normal[k];
    for (int k = 0; k < 3; ++k)
        plane_of(plain, values, PLAIN_NORMAL_X + (enum plain_channel)k)[middle] = (float)(normal[k] / sqrt(length));
}

/* The same with the planes x = 1 m and x = -1 m (vertical: y = ±0.7 m) in front of the wall. */
static bool vertical;
static void side_walls(const struct plain *plain, float *values) {
    const double side = vertical ? 0.7 : 1;
    for (uint32_t i = 0; i < WIDE * HIGH; ++i) {
        double slope = vertical ? -slope_of(i / WIDE, HIGH) : slope_of(i % WIDE, WIDE);
        if (fabs(slope) * wall_m <= side) continue;
        plane_of(plain, values, PLAIN_DEPTH)[i] = (float)(side / fabs(slope));
        for (int k = 0; k < 3; ++k) plane_of(plain, values, PLAIN_NORMAL_X + (enum plain_channel)k)[i] = 0;
        plane_of(plain, values, vertical ? PLAIN_NORMAL_Y : PLAIN_NORMAL_X)[i] = slope > 0 ? -1 : 1;
    }
    turn_the_middle(plain, values);
}

static const char *const walkers[2] = {"dda", "hiz"};

/* Traces the ray of the central pixel. */
static struct traced middle_ray(struct gpu *gpu, const char *variant, double x, double y, double z, bool walls) {
    char path[256];
    ray[0] = x, ray[1] = y, ray[2] = z;
    struct plain plain = {
        .width = WIDE, .height = HIGH, .fov_y_degrees = degrees, .spoil = walls ? side_walls : turn_the_middle};
    plain_capture(gpu_path(gpu, "special", path), &plain);
    gpu_load(gpu, "special");
    load_screen_trace(gpu, variant);
    gpu->float_precision = true;
    struct traced t = trace_screen(gpu);
    const size_t middle = (size_t)(HIGH / 2) * WIDE + WIDE / 2;
    t.travelled[0] = t.travelled[middle], t.end[0] = t.end[middle], t.finished[0] = t.finished[middle];
    return t;
}

static void along_the_axes_and_parallel_to_the_screen(void **state) {
    static const double directions[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (int v = 0; v < 2; ++v)
        for (int d = 0; d < 4; ++d) {
            vertical = d >= 2;
            struct traced t = middle_ray(*state, walkers[v], directions[d][0], directions[d][1], 0, true);
            print_message("# %s along (%g, %g, 0): end %u at %.7f m\n", walkers[v], directions[d][0], directions[d][1],
                          t.end[0], (double)t.travelled[0]);
            assert_int_equal(t.end[0], END_hit);
            /* 1/z is linear on the side wall, and the bias does not move a hit: only rounding remains. */
            assert_true(fabs((double)t.travelled[0] - (vertical ? 0.7 : 1)) < 1e-4);
            traced_free(&t);
        }
}

static void towards_the_camera_nothing_is_hit(void **state) {
    for (int v = 0; v < 2; ++v) {
        struct traced t = middle_ray(*state, walkers[v], 0, 0, 1, false);
        assert_int_equal(t.finished[0], 0);
        assert_int_equal(t.end[0], END_faced_viewer);
        assert_true(fabs((double)t.travelled[0] - (start_m - 0.1)) < 1e-3); /* up to the near plane */
        traced_free(&t);
    }
}

static void past_the_camera_it_ends_at_the_near_plane(void **state) {
    for (int v = 0; v < 2; ++v) {
        /* A tenth of the image's slope: it is still on screen at the near plane after 2.9 m. */
        const double x = 0.01, length = sqrt(1 + x * x);
        struct traced t = middle_ray(*state, walkers[v], x / length, 0, 1 / length, false);
        assert_int_equal(t.end[0], END_faced_viewer);
        assert_true(fabs((double)t.travelled[0] - (start_m - 0.1) * length) < 0.01);
        traced_free(&t);
    }
}

/* Every ray of a mirror floor hits the wall at the position of the closed form. */
static void from_the_floor_to_the_wall(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    struct plain plain = {.width = 161, .height = 121, .fov_y_degrees = degrees, .floor = true};
    plain_capture(gpu_path(gpu, "floor", path), &plain);
    gpu_load(gpu, "floor");
    for (int v = 0; v < 2; ++v) {
        size_t floor = 0, seen = 0, hits = 0, wrong = 0;
        load_screen_trace(gpu, walkers[v]);
        gpu->float_precision = true;
        struct traced t = trace_screen(gpu);
        float *normal = gpu_floats(gpu, "normal_half", NULL, NULL);
        for (uint32_t i = 0; i < t.width * t.height; ++i) {
            if (normal[4 * i + 1] < 0.5f) continue;
            const double half = tan(degrees * 3.14159265358979323846 / 360) / 121;
            const double down = (2 * (i / 161) + 1 - 121.0) * half, side = (2 * (i % 161) + 1 - 161.0) * half;
            const double depth = 1 / down, step = sqrt(1 + down * down + side * side);
            const double distance = (wall_m - depth) * step; /* by metres of depth, with the height mirrored */
            const double height = -1 + down * (wall_m - depth);
            const double x = side * wall_m / (wall_m * half), y = height / (wall_m * half);
            ++floor;
            if (fabs(x) > 160 || fabs(y) > 120 || height < -1 + 0.01 * wall_m)
                continue; /* off screen, or next to its start */
            ++seen;
            hits += is_hit(&t, i);
            wrong += !(fabs((double)t.travelled[i] - distance) <= 1e-3 * distance);
        }
        print_message("# %s: %zu rays on the floor, %zu see the wall, %zu hits, %zu wrong\n", walkers[v], floor, seen,
                      hits, wrong);
        assert_true(seen > 1000 && hits == seen && wrong == 0);
        traced_free(&t);
        free(normal);
    }
}

/* Below the middle a floor that reflects every pixel to the row as far above it, a quarter of a pixel to the left of its centre, so that a ray stays
   in its column. Above it the left half is a wall, the right one the sky. */
static void wall_beside_the_sky(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < WIDE * HIGH; ++i) {
        const double across = slope_of(i % WIDE, WIDE), down = slope_of(i / WIDE, HIGH);
        if (i % WIDE >= WIDE / 2) plane_of(plain, values, PLAIN_DEPTH)[i] = INFINITY;
        if (!(down > 0)) continue;
        const double to[3] = {slope_of(i % WIDE - 0.25, WIDE), down, -1}, from[3] = {across, -down, -1};
        const double far = hypot(hypot(to[0], down), 1), near = hypot(hypot(across, down), 1);
        double normal[3], square = 0;
        for (int k = 0; k < 3; ++k) normal[k] = to[k] / far - from[k] / near, square += normal[k] * normal[k];
        plane_of(plain, values, PLAIN_DEPTH)[i] = (float)(1 / down);
        for (int k = 0; k < 3; ++k)
            plane_of(plain, values, PLAIN_NORMAL_X + (enum plain_channel)k)[i] = (float)(normal[k] / sqrt(square));
    }
}

static void a_ray_ends_in_the_sky_of_its_vanishing_point(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    struct plain plain = {.width = WIDE, .height = HIGH, .fov_y_degrees = degrees, .spoil = wall_beside_the_sky};
    plain_capture(gpu_path(gpu, "vanishing", path), &plain);
    gpu_load(gpu, "vanishing");
    for (int v = 0; v < 2; ++v) {
        load_screen_trace(gpu, walkers[v]);
        struct traced t = trace_screen(gpu);
        for (uint32_t i = (HIGH / 2 + 1) * WIDE; i < HIGH * WIDE; ++i)
            assert_true((t.end[i] == END_sky) == (i % WIDE >= WIDE / 2));
        traced_free(&t);
    }
}

/* ---- linear_binary ---- */

static double median_error(struct gpu *gpu, const char *setting, size_t *hits) {
    load_screen_trace(gpu, "linear_binary");
    gpu_set(gpu, setting);
    struct traced t = trace_screen(gpu);
    struct paths paths = paths_of(gpu, &t);
    double *errors = malloc((size_t)t.width * t.height * sizeof *errors);
    assert_non_null(errors);
    *hits = 0;
    for (size_t i = 0; i < (size_t)t.width * t.height; ++i) {
        struct depth_ray ray;
        double distance;
        if (!is_hit(&t, i) || !path(&paths, i, &ray)) continue;
        if (traversal_hit(&paths.grid, &ray, &traversal_rules_default, &distance))
            errors[(*hits)++] = fabs((double)t.travelled[i] - distance) / distance;
    }
    double median = quantile(errors, *hits, 0.5);
    free(errors);
    paths_free(&paths);
    traced_free(&t);
    return median;
}

static void bisections_bring_a_hit_to_its_texel(void **state) {
    struct gpu *gpu = *state;
    size_t hits[2];
    gpu_sample(gpu, "mirror_box", "mirror_box",
               &(struct glint_sample_options){.width = 320, .height = 180, .cube_size = 8});
    double with = median_error(gpu, "screen_trace.refinements=6", &hits[0]),
           without = median_error(gpu, "screen_trace.refinements=0", &hits[1]);
    print_message("# median error %.3f %% with 6 bisections, %.3f %% without, of %zu and %zu hits\n", 100 * with,
                  100 * without, hits[0], hits[1]);
    assert_int_equal(hits[0], hits[1]);
    /* A step is at most 0.02 of the image; 6 bisections leave a 64th of it, and a texel is a 320th. */
    assert_true(hits[0] > 5000 && 4 * with < without && with < 0.02);
}

static void with_infinite_thickness_all_is_solid(void **state) {
    struct gpu *gpu = *state;
    size_t behind[2] = {0, 0}, hits[2] = {0, 0};
    gpu_sample(gpu, "street", "street", &(struct glint_sample_options){.width = 320, .height = 180, .cube_size = 8});
    for (int i = 0; i < 2; ++i) {
        load_screen_trace(gpu, "hiz");
        gpu_set(gpu, "screen_trace.pass_behind=false");
        if (i) gpu_set(gpu, "screen_trace.thickness_m=1e6");
        struct traced t = trace_screen(gpu);
        for (size_t k = 0; k < (size_t)t.width * t.height; ++k) {
            behind[i] += t.end[k] == END_behind;
            hits[i] += is_hit(&t, k);
        }
        traced_free(&t);
    }
    print_message("# went behind: %zu rays, %zu with infinite thickness; hits %zu, %zu\n", behind[0], behind[1],
                  hits[0], hits[1]);
    assert_true(behind[0] > 1000 && behind[1] == 0);
    assert_int_equal(hits[1], hits[0] + behind[0]); /* anything behind a surface is a hit there */
}

int main(int argc, UNUSED char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_mirror_box_as_in_double),
        cmocka_unit_test(on_street_as_in_double),
        cmocka_unit_test(on_room_as_in_double),
        cmocka_unit_test(at_odd_sizes_as_texel_by_texel),
        cmocka_unit_test(parents_cover_all_children),
        cmocka_unit_test(reversed_depth_gives_the_same_hits),
        cmocka_unit_test(along_the_axes_and_parallel_to_the_screen),
        cmocka_unit_test(towards_the_camera_nothing_is_hit),
        cmocka_unit_test(past_the_camera_it_ends_at_the_near_plane),
        cmocka_unit_test(from_the_floor_to_the_wall),
        cmocka_unit_test(a_ray_ends_in_the_sky_of_its_vanishing_point),
        cmocka_unit_test(bisections_bring_a_hit_to_its_texel),
        cmocka_unit_test(with_infinite_thickness_all_is_solid),
    };
    const struct CMUnitTest large[] = {cmocka_unit_test(at_1919_by_1079_as_texel_by_texel)};
    return argc > 1 ? cmocka_run_group_tests_name("gpu_screen_trace, long", large, gpu_set_up, gpu_tear_down)
                    : cmocka_run_group_tests_name("gpu_screen_trace", tests, gpu_set_up, gpu_tear_down);
}
