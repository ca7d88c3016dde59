/* Invalid pixels in the G-buffer: every pass terminates, and only nearby pixels are affected. */
#include <math.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDTH = 192, HEIGHT = 128, APART = 16 };

static const struct {
    enum plain_channel channel;
    float value;
} bad[] = {
    {PLAIN_DEPTH, NAN},      {PLAIN_DEPTH, -3},           {PLAIN_DEPTH, 0},       {PLAIN_DEPTH, 1e-30f},
    {PLAIN_DEPTH, 3e38f},    {PLAIN_DEPTH, INFINITY},     {PLAIN_NORMAL_Y, NAN},  {PLAIN_NORMAL_Y, INFINITY},
    {PLAIN_NORMAL_Y, 0},     {PLAIN_NORMAL_X, 1e20f},     {PLAIN_ROUGHNESS, NAN}, {PLAIN_ROUGHNESS, -1},
    {PLAIN_ROUGHNESS, 1e9f}, {PLAIN_ROUGHNESS, INFINITY},
};
enum { BAD = sizeof bad / sizeof bad[0] };

/* Two rows on the floor, which covers the lower third; each bad value at a different position in its 2x2 block. */
static void place(size_t i, uint32_t *x, uint32_t *y) {
    *x = (uint32_t)(APART + APART * (i % 7) + i % 2);
    *y = (uint32_t)(HEIGHT - 28 + APART * (i / 7) + i / 2 % 2);
}

static void spoil(const struct plain *plain, float *values) {
    for (size_t i = 0; i < BAD; ++i) {
        uint32_t x, y;
        place(i, &x, &y);
        values[((size_t)bad[i].channel * plain->height + y) * plain->width + x] = bad[i].value;
    }
}

static bool near_a_bad_one(uint32_t x, uint32_t y) {
    for (size_t i = 0; i < BAD; ++i) {
        uint32_t bx, by;
        place(i, &bx, &by);
        if (abs((int)x - (int)bx) <= 4 && abs((int)y - (int)by) <= 4) return true;
    }
    return false;
}

static float *composed(struct gpu *gpu, bool spoiled, float roughness) {
    char path[256];
    const char *name = spoiled ? "spoiled" : "clean";
    plain_capture(gpu_path(gpu, name, path), &(struct plain){.width = WIDTH,
                                                             .height = HEIGHT,
                                                             .roughness = roughness,
                                                             .fov_y_degrees = 60,
                                                             .floor = true,
                                                             .spoil = spoiled ? spoil : NULL});
    gpu_load(gpu, name);
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_run(gpu);
    return gpu_floats(gpu, "composed", NULL, NULL);
}

static void bad_pixels_stay_alone(void **state) {
    struct gpu *gpu = *state;
    for (int rough = 0; rough < 2; ++rough) {
        float *clean = composed(gpu, false, rough ? 0.4f : 0), *spoiled = composed(gpu, true, rough ? 0.4f : 0);
        size_t changed = 0, reflecting = 0;
        for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
            bool same = true;
            for (uint32_t k = 0; k < 3; ++k) {
                assert_true(isfinite(spoiled[4 * i + k]));
                same &= spoiled[4 * i + k] == clean[4 * i + k];
            }
            reflecting += i / WIDTH > HEIGHT - 30 && clean[4 * i + 2] > 1.001f; /* lit is 1 there */
            changed += !same && !near_a_bad_one(i % WIDTH, i / WIDTH);
        }
        assert_true(reflecting > 1000);
        /* Farther away only rays that hit a bad pixel may change; on a floor that does not reflect itself there are none. */
        if (rough == 0) assert_int_equal(changed, 0);
        free(clean);
        free(spoiled);
    }
}

/* The ends of the floor's rays have a closed form: from depth d at 1 m below the camera, the wall at 5 m is hit after (5 - d)/d times
   the length of the primary ray, 1 m above the floor times that ratio. */
static void a_floor_sees_the_wall(void **state) {
    struct gpu *gpu = *state;
    free(composed(gpu, false, 0));
    uint32_t width, height, hits = 0;
    float *travelled = gpu_floats(gpu, "screen_travelled", &width, &height),
          *depth = gpu_floats(gpu, "depth_half", NULL, NULL);
    uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL), *end = gpu_uints(gpu, "screen_end", NULL, NULL);
    const double focal = 1 / tan(30 * 3.14159265358979323846 / 180);
    for (uint32_t i = 0; i < width * height; ++i) {
        double x = (2 * ((2 * (i % width) + (pick[i] & 1) + 0.5) / WIDTH) - 1) / focal * WIDTH / HEIGHT;
        double y = (2 * ((2 * (i / width) + (pick[i] >> 1) + 0.5) / HEIGHT) - 1) / focal;
        if (!(y * 5 > 1) || end[i] != 1) continue;
        double d = 1 / y, expected = (5 - d) * sqrt(1 + x * x + y * y);
        ++hits;
        /* The trace is exact on planes such as floor and wall; the remaining error is the rounding of 1/z, 2^-24 · 5 m, divided by its
           change along the ray. */
        if (!(fabs((double)travelled[i] - expected) <= 1e-4 * expected + 1e-4))
            fail_msg("%u,%u depth %g: %g, expected %g", i % width, i / width, (double)depth[i], (double)travelled[i],
                     expected);
    }
    assert_true(hits > 500);
    free(travelled), free(depth), free(pick), free(end);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bad_pixels_stay_alone),
                                       cmocka_unit_test(a_floor_sees_the_wall)};
    return cmocka_run_group_tests_name("gpu_garbage", tests, gpu_set_up, gpu_tear_down);
}
