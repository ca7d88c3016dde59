/* Dual paraboloids of a cube map whose colour is the direction. The position of a direction is derived from optics: the paraboloid's
   normal bisects the angle between the direction and the axis. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "glint/probe.h"
#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 64 };
/* The disc's radius relative to half the width of the map: the rim is at the centres of the outermost texels. */
static const double disc = 1 - 1.0 / SIZE;

static void colored_by_direction(UNUSED uint32_t number, const double direction[3], float out[5]) {
    for (int k = 0; k < 3; ++k) out[k] = (float)(0.5 + 0.5 * direction[k]);
    out[3] = 1;
    out[4] = 5;
}

/* A colour that must not leak through closed maps. */
static void dark(UNUSED const double direction[3], float out[3]) {
    out[0] = out[1] = out[2] = 0;
}

static void load_directions(struct gpu *gpu) {
    char path[256];
    const struct plain plain = {.width = 16,
                                .height = 8,
                                .fov_y_degrees = 60,
                                .floor = true,
                                .color_only = true,
                                .cube_size = SIZE,
                                .cube_count = 2,
                                .cube = colored_by_direction,
                                .sky = dark};
    plain_capture(gpu_path(gpu, "directions", path), &plain);
    gpu_load(gpu, "directions");
    gpu_reset(gpu);
    gpu_use(gpu, "cubemap_convert=dual_paraboloid");
    gpu_use(gpu, "cubemap_trace=dual_paraboloid");
    gpu_set(gpu, "screen_trace.length_m=0");
}

/* Up is +Y; the map's x is +X, its y is -Z. */
static double place_of(const double d[3], double place[2]) {
    const double local[3] = {d[0], -d[2], fabs(d[1])}; /* the lower hemisphere is the mirror image of the upper one */
    place[0] = disc * local[0] / (local[2] + 1);       /* the normal (x, y, 1) is along d + axis */
    place[1] = disc * local[1] / (local[2] + 1);
    return sqrt(place[0] * place[0] + place[1] * place[1]);
}

/* Bilinear, clamped at the border. */
static void lookup(const float *layer, int size, const double place[2], double out[3]) {
    double x = fmin(fmax((place[0] + 1) / 2 * size - 0.5, 0), size - 1),
           y = fmin(fmax((place[1] + 1) / 2 * size - 0.5, 0), size - 1);
    int x0 = (int)x, y0 = (int)y, x1 = x0 + 1 < size ? x0 + 1 : x0, y1 = y0 + 1 < size ? y0 + 1 : y0;
    for (int k = 0; k < 3; ++k) {
        double low = (double)layer[4 * (y0 * size + x0) + k] * (1 - (x - x0)) +
                     (double)layer[4 * (y0 * size + x1) + k] * (x - x0);
        double high = (double)layer[4 * (y1 * size + x0) + k] * (1 - (x - x0)) +
                      (double)layer[4 * (y1 * size + x1) + k] * (x - x0);
        out[k] = low * (1 - (y - y0)) + high * (y - y0);
    }
}

static double angle_between(const double a[3], const double b[3]) {
    double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    return atan2(sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* Directions evenly distributed over the sphere. */
static void direction_of(int i, int count, double d[3]) {
    double y = 1 - 2 * (i + 0.5) / count, r = sqrt(1 - y * y), turn = 2.399963229728653 * i;
    d[0] = r * cos(turn), d[1] = y, d[2] = r * sin(turn);
}

static void directions_come_back(void **state) {
    struct gpu *gpu = *state;
    load_directions(gpu);
    gpu_run(gpu);
    uint32_t width, height;
    float *map = gpu_floats(gpu, "paraboloids", &width, &height);
    assert_int_equal(width, SIZE);
    assert_int_equal(height, 4 * SIZE); /* two hemispheres of two cube maps */
    enum { COUNT = 20000 };
    static double errors[2][COUNT]; /* near the poles, near the rim */
    size_t counts[2] = {0, 0};
    for (int i = 0; i < COUNT; ++i) {
        double d[3], place[2], color[3], back[3];
        direction_of(i, COUNT, d);
        double r = place_of(d, place);
        lookup(map + 4 * SIZE * SIZE * (d[1] < 0), SIZE, place, color);
        for (int k = 0; k < 3; ++k) back[k] = 2 * color[k] - 1;
        size_t zone = r > tan(0.25 * acos(-1) / 2); /* 45 degrees from the axis */
        errors[zone][counts[zone]++] = angle_between(d, back);
    }
    for (int zone = 0; zone < 2; ++zone) {
        double median = quantile(errors[zone], counts[zone], 0.5), worst = errors[zone][counts[zone] - 1];
        print_message("# %s: %zu directions, off by %.5f rad in the median, at most %.5f; a face's texel spans %.5f\n",
                      zone ? "rim" : "pole", counts[zone], median, worst, 2.0 / SIZE);
        assert_true(counts[zone] > 2000);
        /* Colours are half floats between 0 and 1, rounded in the capture and in the map: 2^-12 each time, twice that as a component of
           the direction, in two components. */
        assert_true(median <= 1e-3 && worst <= 2e-3);
    }
    free(map);
}

/* The number of texels whose centre is between two angles from the axis, per steradian. */
static double density(double from, double to) {
    size_t count = 0;
    for (int i = 0; i < SIZE * SIZE; ++i) {
        double x = 2 * (i % SIZE + 0.5) / SIZE - 1, y = 2 * (i / SIZE + 0.5) / SIZE - 1,
               turned = 2 * atan(sqrt(x * x + y * y) / disc);
        count += turned >= from && turned < to;
    }
    return (double)count / (2 * acos(-1) * (cos(from) - cos(to)));
}

/* The article claims that the projection preserves details at the top and the bottom, at the expense of the sides. */
static void the_rim_has_more_texels_than_the_pole(UNUSED void **state) {
    const double degree = acos(-1) / 180;
    double pole = density(0, 20 * degree), rim = density(70 * degree, 90 * degree);
    double face = SIZE * SIZE / 4.0; /* at the centre of a cube map's face */
    print_message("# texels a steradian: %.0f around the pole, %.0f at the rim, %.0f in the middle of a face\n", pole,
                  rim, face);
    /* (N - 1)²/16 · 1/cos²(10°) and (N - 1)²/4 · (1 - tan²(35°))/(2 cos 70°), with the error of counting whole texels */
    assert_true(fabs(pole / (disc * disc * face / 4) - 1.031) < 0.05);
    assert_true(fabs(rim / (disc * disc * face) - 0.745) < 0.05);
}

/* At the equator both hemispheres show the same directions; a level without texels beyond the rim mixes in black. */
static void filled_levels_meet_at_the_rim(void **state) {
    struct gpu *gpu = *state;
    double apart[2] = {0, 0}, dark[2] = {0, 0};
    for (int fill = 0; fill < 2; ++fill) {
        load_directions(gpu);
        gpu_set(gpu, fill ? "cubemap_convert.fill=true" : "cubemap_convert.fill=false");
        gpu_run(gpu);
        for (int level = 0, size = SIZE; level < 5; ++level, size /= 2) {
            char name[32];
            snprintf(name, sizeof name, level ? "paraboloids.level%d" : "paraboloids", level);
            float *map = gpu_floats(gpu, name, NULL, NULL);
            for (int i = 0; i < 360; ++i) {
                double turn = i * acos(-1) / 180, d[3] = {cos(turn), 0, sin(turn)}, place[2], upper[3], lower[3];
                place_of(d, place);
                lookup(map, size, place, upper);
                lookup(map + 4 * size * size, size, place, lower);
                for (int k = 0; k < 3; ++k) {
                    if (k != 1) apart[fill] = fmax(apart[fill], fabs(upper[k] - lower[k]));
                }
                double expected = 0.5 + 0.5 * d[0];
                dark[fill] = fmax(dark[fill], expected - upper[0]);
            }
            free(map);
        }
    }
    print_message(
        "# at the rim, five levels: hemispheres %.4f apart, at most %.3f too dark; without fill %.4f and %.3f\n",
        apart[1], dark[1], apart[0], dark[0]);
    /* By symmetry about the equator they differ only by half floats. */
    assert_true(apart[1] <= 2e-3);
    /* A texel of the fifth level covers an eighth of the disc's radius on either side of the rim, and a bilinear lookup there reaches
       one such texel: sin of its angle, less than 1 - cos(0.5 rad). */
    assert_true(dark[1] <= 0.13 && dark[0] > 2 * dark[1]);
}

/* A texel of a coarser level is the mean of four, weighted by solid angle: 4/(1 + r²)² times the area, at a distance r from the centre
   in radii of the disc. */
static void levels_are_means_by_solid_angle(void **state) {
    struct gpu *gpu = *state;
    for (int by_angle = 0; by_angle < 2; ++by_angle) {
        load_directions(gpu);
        gpu->float_precision = true;
        gpu_set(gpu, by_angle ? "cubemap_convert.solid_angle=true" : "cubemap_convert.solid_angle=false");
        gpu_run(gpu);
        float *fine = gpu_floats(gpu, "paraboloids", NULL, NULL);
        double worst = 0;
        for (int level = 1, size = SIZE / 2; level < 6; ++level, size /= 2) {
            char name[32];
            snprintf(name, sizeof name, "paraboloids.level%d", level);
            float *coarse = gpu_floats(gpu, name, NULL, NULL);
            for (int i = 0; i < 4 * size * size; ++i) {
                double sum[4] = {0}, total = 0;
                for (int c = 0; c < 4; ++c) {
                    const int x = 2 * (i % size) + c % 2, y = 2 * (i / size) + c / 2;
                    const double u = ((x + 0.5) / size - 1) / disc, v = ((y % (2 * size) + 0.5) / size - 1) / disc;
                    const double weight = by_angle ? 4 / pow(1 + u * u + v * v, 2) : 1;
                    for (int k = 0; k < 4; ++k) sum[k] += weight * (double)fine[4 * (y * 2 * size + x) + k];
                    total += weight;
                }
                for (int k = 0; k < 4; ++k) worst = fmax(worst, fabs((double)coarse[4 * i + k] - sum[k] / total));
            }
            free(fine);
            fine = coarse;
        }
        free(fine);
        print_message("# %s: worst difference %.2g\n", by_angle ? "by solid angle" : "by area", worst);
        assert_true(worst < 1e-6); /* sums of four floats below 1 */
    }
}

static void rays_see_the_direction_they_go_in(void **state) {
    struct gpu *gpu = *state;
    load_directions(gpu);
    gpu_run(gpu);
    uint32_t width, height;
    float *color = gpu_floats(gpu, "reflection_half", &width, &height),
          *travelled = gpu_floats(gpu, "travelled", NULL, NULL);
    uint32_t *place = gpu_uints(gpu, "cubemap_index", NULL, NULL);
    gpu_use(gpu, "cubemap_trace=lookup");
    gpu_use(gpu, "cubemap_convert=none");
    gpu_run(gpu);
    float *cube = gpu_floats(gpu, "reflection_half", NULL, NULL);
    size_t rays = 0;
    for (uint32_t i = 0; i < width * height; ++i) {
        if (place[i] > 1) continue;
        rays++;
        assert_true(isinf(travelled[i]));
        for (int k = 0; k < 3; ++k) assert_true(fabsf(color[4 * i + (uint32_t)k] - cube[4 * i + (uint32_t)k]) <= 2e-3f);
    }
    assert_true(rays > width * height / 4);
    free(color), free(travelled), free(place), free(cube);
}

/* The rays of a wall 5 m away, which go back past the camera, end on a ball of 5 m around a centre beside it. */
enum { WIDE = 32, HIGH = 24, CONES = 192 };
static const double ball[3] = {2, 1, -1.5};
static void load_ball(struct gpu *gpu) {
    static const char *const words[] = {"downsample.jitter=true",   "downsample.share=0",
                                        "downsample.cone_factor=1", "downsample.horizon=false",
                                        "screen_trace.length_m=0",  "resolve.texel_scale=0.5"};
    char path[256];
    struct plain plain = {.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.3F,
                          .fov_y_degrees = 60,
                          .cube_size = SIZE,
                          .cube_count = 1,
                          .cube = colored_by_direction};
    for (int k = 0; k < 3; ++k) plain.cubes[0].center[k] = ball[k];
    plain_capture(gpu_path(gpu, "ball", path), &plain);
    gpu_load(gpu, "ball");
    gpu_reset(gpu);
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, "cubemap_convert=dual_paraboloid");
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i) gpu_set(gpu, words[i]);
}

/* A cone of this angle at the end of a ray is `travelled` times its tangent wide. From the centre that is an angle with the tangent `spread` times
   the cone's; a texel at the height h above the equator spans 2 (1 + h) / SIZE, and a level's are half of the cone. */
static double level_at(double cone, uint32_t i, double travelled_m, const float *normal, double *spread) {
    const double focal = 1 / tan(acos(-1) / 6);
    const double x = (2 * (i % WIDE + 0.5) / WIDE - 1) / focal * WIDE / HIGH,
                 y = (1 - 2 * (i / WIDE + 0.5) / HIGH) / focal;
    const double along = travelled_m / sqrt(x * x + y * y + 1),
                 n[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
    const double turn = 2 * (x * n[0] + y * n[1] - n[2]) / (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const double at[3] = {5 * x + along * (x - turn * n[0]) - ball[0], 5 * y + along * (y - turn * n[1]) - ball[1],
                          along * (-1 - turn * n[2]) - 5 - ball[2]};
    const double from_center_m = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
    *spread = travelled_m / from_center_m;
    const double texels = tan(cone) * *spread * SIZE / 2 / (0.5 * (1 + fabs(at[1]) / from_center_m));
    return log2(fmin(fmax(texels, 1), SIZE));
}

/* Catches: a cone that is as wide at the centre as at the surface, a ratio of distances the wrong way, levels that ignore the height. */
static void a_level_is_as_wide_as_the_cone_where_the_ray_ends(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    static uint32_t pixels[CONES][2];
    size_t count = 0, near = 0, far = 0;
    double worst = 0;
    for (uint32_t i = 0; i < CONES; ++i) pixels[i][0] = i * 4 % WIDE, pixels[i][1] = i * 4 / WIDE;
    load_ball(gpu);
    const struct glint_replay_options options = {.all = true,
                                                 .float_precision = true,
                                                 .diagnostics = true,
                                                 .probes = (const uint32_t(*)[2])pixels,
                                                 .probe_count = CONES};
    if (!glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
    float *cone = gpu_floats(gpu, "cone_half", NULL, NULL), *travelled_m = gpu_floats(gpu, "travelled", NULL, NULL);
    float *normal = gpu_floats(gpu, "normal_jittered", NULL, NULL);
    for (uint32_t k = 0; k < CONES; ++k) {
        struct glint_probe_trace trace;
        const uint32_t i = pixels[k][1] * WIDE + pixels[k][0];
        if (!glint_replay_probe(gpu->replay, k, &trace, &err)) fail_msg("%s", err.message);
        for (size_t r = 0; r < trace.count; ++r) {
            if (!glint_probe_is(&trace.records[r], "color") || !(travelled_m[i] < 1e30F)) continue;
            double spread;
            const double level = level_at((double)cone[i], i, (double)travelled_m[i], normal + 4 * i, &spread);
            worst = fmax(worst, fabs((double)glint_probe_value(&trace.records[r], "level") - level));
            count++, near += spread<0.8, far += spread> 1.25;
        }
        free(trace.records);
    }
    print_message("# %zu cones, %zu of them short, %zu long; levels are off by %.2g\n", count, near, far, worst);
    assert_true(count > 100 && near > 10 && far > 10);
    assert_true(worst < 1e-5); /* ten operations of 2^-24 each, in levels up to 6 */
    free(cone), free(travelled_m), free(normal);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_come_back),
        cmocka_unit_test(the_rim_has_more_texels_than_the_pole),
        cmocka_unit_test(filled_levels_meet_at_the_rim),
        cmocka_unit_test(levels_are_means_by_solid_angle),
        cmocka_unit_test(rays_see_the_direction_they_go_in),
        cmocka_unit_test(a_level_is_as_wide_as_the_cone_where_the_ray_ends),
    };
    return cmocka_run_group_tests_name("gpu_paraboloid", tests, gpu_set_up, gpu_tear_down);
}
