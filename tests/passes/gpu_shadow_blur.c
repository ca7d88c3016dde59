/* shadow_blur and shadow_early against sums of their weights, and against each other. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plain_capture.h"
#include "sunlit.h"
#include "unit.h"

/* No multiple of the blocks: the last texels of an eighth take what is left. */
enum { ODD_WIDE = 157, ODD_HIGH = 115, EDGE_X = 81, EDGE_Y = 50 };
static const struct glint_sun front = {.direction = {0, 0.6, 0.8}, .irradiance = {1, 1, 1}, .angular_radius_rad = 0.05};

/* The sun shines on a quarter of the wall. */
static float corner(UNUSED const struct plain *plain, uint32_t x, uint32_t y) {
    return x >= EDGE_X && y >= EDGE_Y ? 1 : 0;
}
static struct plain wall_with(float (*mask)(const struct plain *, uint32_t, uint32_t)) {
    return (struct plain){
        .width = ODD_WIDE, .height = ODD_HIGH, .roughness = 0.5F, .fov_y_degrees = 60, .sun = &front, .sun_mask = mask};
}

static float *run(struct gpu *gpu, const char *first, const char *second, const char *third) {
    const char *const words[] = {
        "contact_trace=dda", "contact_trace.length_m=0", "shadow_blur=separable", first, second, third, NULL};
    free(sunlit_run(gpu, words));
    return gpu_floats(gpu, "shadow_soft", NULL, NULL);
}

/* The share of the weight of those texels within the radius that lie at `edge` or beyond. */
static double share_beyond(int at, int edge, int length, int radius, bool gaussian) {
    double lit = 0, all = 0;
    for (int i = -radius; i <= radius; i++) {
        if (at + i < 0 || at + i >= length) continue;
        const double x = 2.0 * i / radius, weight = gaussian ? exp(-0.5 * x * x) : abs(i) == radius ? 0.5 : 1;
        all += weight;
        if (at + i >= edge) lit += weight;
    }
    return lit / all;
}

/* Along rows and columns the edges of the light become the sums of the kernel's weights. Without contact shadows they are the sun's shadow. */
static void a_straight_edge_becomes_the_sum_of_the_weights(void **state) {
    struct gpu *gpu = *state;
    const struct plain plain = wall_with(corner);
    occlusion_load(gpu, &plain);
    for (int c = 0; c < 3; c++) {
        static const char *const radii[] = {"shadow_blur.radius=4", "shadow_blur.radius=7", "shadow_blur.radius=12"},
                                 *const kernels[] = {"shadow_blur.kernel=gaussian", "shadow_blur.kernel=box"};
        static const int radius[] = {4, 7, 12};
        float *soft = run(gpu, radii[c], kernels[c == 1], "shadow_early=gather"),
              *shadow = gpu_floats(gpu, "sun_shadow", NULL, NULL);
        assert_memory_equal(soft, shadow, ODD_WIDE * ODD_HIGH * sizeof *soft);
        size_t between = 0;
        for (int y = 0; y < ODD_HIGH; y++)
            for (int x = 0; x < ODD_WIDE; x++) {
                const double right = share_beyond(x, EDGE_X, ODD_WIDE, radius[c], c != 1) *
                                     share_beyond(y, EDGE_Y, ODD_HIGH, radius[c], c != 1);
                if (fabs((double)soft[y * ODD_WIDE + x] - right) > 1e-6)
                    fail_msg("radius %d, pixel %d,%d: %.8g, expected %.8g", radius[c], x, y,
                             (double)soft[y * ODD_WIDE + x], right);
                between += right > 0.01 && right < 0.99;
            }
        assert_true(between > 500);
        free(soft), free(shadow);
    }
}

/* A few dark spots far apart, some of them in what the last blocks take. */
static float spots(UNUSED const struct plain *plain, uint32_t x, uint32_t y) {
    return x % 53 == 48 && y % 41 == 30 ? 0.25F : 1;
}

/* What shadow_early holds, from the mask; that it changes no pixel; and that it is used: where it is all 1, nothing is blurred. */
static void pixels_that_are_lit_all_around_are_left_out(void **state) {
    struct gpu *gpu = *state;
    const struct plain plain = wall_with(spots);
    occlusion_load(gpu, &plain);
    for (int whole = 0; whole < 2;
         whole++) { /* whether the pipeline traces every pixel, so that blocks are half as wide */
        const char *resolution = whole ? "downsample=none" : "downsample=pick";
        const int block = whole ? 4 : 8;
        float *all = run(gpu, "shadow_early=none", resolution, whole ? "shadow_blur.radius=4" : "shadow_blur.radius=8");
        float *some =
            run(gpu, "shadow_early=gather", resolution, whole ? "shadow_blur.radius=4" : "shadow_blur.radius=8");
        assert_memory_equal(all, some, ODD_WIDE * ODD_HIGH * sizeof *all);
        uint32_t wide, high;
        float *early = gpu_floats(gpu, "shadow_early", &wide, &high);
        size_t lit = 0;
        for (int v = 0; v < (int)high; v++)
            for (int u = 0; u < (int)wide; u++) {
                float least = 1;
                for (int y = 0; y < ODD_HIGH; y++)
                    for (int x = 0; x < ODD_WIDE; x++) {
                        const int bx = (int)fmin(x / block, wide - 1), by = (int)fmin(y / block, high - 1);
                        if (abs(bx - u) <= 1 && abs(by - v) <= 1)
                            least = fminf(least, spots(&plain, (uint32_t)x, (uint32_t)y));
                    }
                if (early[v * (int)wide + u] != least)
                    fail_msg("texel %d,%d of %u x %u: %g, expected %g", u, v, wide, high,
                             (double)early[v * (int)wide + u], (double)least);
                lit += least == 1;
            }
        assert_true(lit > wide * high / 4 && lit < wide * high);
        free(all), free(some), free(early);
    }
}

/* On every surface the mask is even, and the blur leaves it so: nothing crosses from the box to the floor or from one of its faces to another.
   The floor at 25 m and beyond does not count: there depth_part lets half a metre pass, which the box is high. */
static float by_surface(const struct plain *plain, uint32_t x, uint32_t y) {
    double position[3], normal[3];
    if (!shapes_pixel(plain->user, plain, x, y, position, normal)) return 1;
    return normal[2] > 0.5 ? 0 : position[1] > -0.99 ? 0.25F : 1;
}
static void nothing_crosses_the_edges_of_surfaces(void **state) {
    struct gpu *gpu = *state;
    struct plain plain = sunlit_frame(&sunlit_box, &front);
    plain.sun_mask = by_surface;
    occlusion_load(gpu, &plain);
    float *soft = run(gpu, "shadow_blur.radius=8", "shadow_early=gather", NULL);
    size_t counts[2] = {0};
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        double position[3], normal[3];
        if (!shapes_pixel(&sunlit_box, &plain, i % WIDE, i / WIDE, position, normal) || position[2] < -24) continue;
        const float right = by_surface(&plain, i % WIDE, i / WIDE);
        if (fabsf(soft[i] - right) > 1e-6F)
            fail_msg("pixel %u,%u: %g, expected %g", i % WIDE, i / WIDE, (double)soft[i], (double)right);
        counts[right < 1]++;
    }
    print_message("# %zu even, %zu on the box\n", counts[0], counts[1]);
    assert_true(counts[0] > 1000 && counts[1] > 300);
    free(soft);
}

/* A contact shadow falls where the blur brings light into the mask's shadow, too. */
static float dark_rows(UNUSED const struct plain *plain, UNUSED uint32_t x, uint32_t y) {
    return y / 2 % 2 ? 0 : 1;
}
static void rays_are_traced_where_the_blur_brings_light(void **state) {
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(35, -30);
    struct plain plain = sunlit_frame(&sunlit_box, &sun);
    plain.sun_mask = dark_rows;
    occlusion_load(gpu, &plain);
    float *found[2], *mask = NULL, *soft = NULL;
    for (int skip = 0; skip < 2; skip++) {
        const char *const words[] = {"contact_trace=dda",
                                     "contact_trace.length_m=4",
                                     "shadow_blur=separable",
                                     "shadow_blur.radius=3",
                                     skip ? NULL : "contact_trace.skip=false",
                                     NULL};
        found[skip] = sunlit_run(gpu, words);
        if (skip) mask = gpu_floats(gpu, "shadow_mask", NULL, NULL), soft = gpu_floats(gpu, "shadow_soft", NULL, NULL);
    }
    size_t brought = 0;
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        double position[3], normal[3];
        const bool floor = shapes_pixel(&sunlit_box, &plain, i % WIDE, i / WIDE, position, normal) && normal[1] > 0.5;
        brought += floor && mask[i] == 0 && found[1][i] < soft[i] && soft[i] > 0.02F;
    }
    assert_memory_equal(found[0], found[1], WIDE * HIGH * sizeof(float));
    print_message("# %zu pixels in the mask's shadow have a contact shadow\n", brought);
    assert_true(brought > 50);
    free(found[0]), free(found[1]), free(mask), free(soft);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_straight_edge_becomes_the_sum_of_the_weights),
        cmocka_unit_test(pixels_that_are_lit_all_around_are_left_out),
        cmocka_unit_test(nothing_crosses_the_edges_of_surfaces),
        cmocka_unit_test(rays_are_traced_where_the_blur_brings_light),
    };
    return cmocka_run_group_tests_name("gpu_shadow_blur", tests, gpu_set_up, gpu_tear_down);
}
