/* Histories: temporal/rough at half, temporal_sharp/clamped at full resolution. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gpu.h"
#include "plain_capture.h"

enum { SIZE = 128, HALF = SIZE / 2, PIXELS = HALF * HALF };
static const double variance = 1 / 3.0; /* of the stand-in's noise, even in [0, 2) */

static void run_frame(struct gpu *gpu, struct plain plain) {
    char path[256], name[32];
    snprintf(name, sizeof name, "frame%u", plain.frame);
    plain.width = plain.height = SIZE;
    plain.fov_y_degrees = 60;
    plain_capture(gpu_path(gpu, name, path), &plain);
    gpu_load(gpu, name);
    gpu_run(gpu);
}

static void frame(struct gpu *gpu, uint32_t number, float roughness, bool cut) {
    run_frame(gpu, (struct plain){.roughness = roughness, .frame = number, .cut = cut});
}

static void start(struct gpu *gpu, const char *scale) {
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_shader(gpu, "resolve", "stand_in.comp");
    gpu_set(gpu, scale);
    gpu_use(gpu, "temporal=rough");
}

static double variance_of(struct gpu *gpu, const char *image) {
    float *color = gpu_floats(gpu, image, NULL, NULL);
    double sum = 0;
    for (int i = 0; i < PIXELS; ++i)
        for (int k = 0; k < 3; ++k) sum += pow((double)color[4 * i + k] - 1, 2);
    free(color);
    return sum / (3 * PIXELS);
}

/* Each of n frames weighs 1/n up to 16, then the new one 1/16: v' = (1 - w)² v + w² of one frame's. */
static void noise_falls_by_the_root_of_the_frames_to_its_floor(void **state) {
    struct gpu *gpu = *state;
    start(gpu, "resolve.texel_scale=1");
    gpu_set(gpu, "temporal.extra=false");
    double expected = 1;
    for (uint32_t n = 1; n <= 40; ++n) {
        frame(gpu, n, 0.5f, false);
        double weight = 1.0 / (n < 16 ? n : 16);
        expected = n == 1 ? 1 : (1 - weight) * (1 - weight) * expected + weight * weight;
        double found = variance_of(gpu, "reflection_temporal") / variance;
        /* 12,288 independent values: a relative standard deviation of 1.3 % (of normal ones), four of them. */
        if (!(fabs(found / expected - 1) < 0.052))
            fail_msg("frame %u: %.4f of one frame's, expected %.4f", n, found, expected);
        if (n == 1 || n == 4 || n == 16 || n == 24 || n == 40)
            print_message("# frame %u: noise %.3f of one frame's, floor %.3f\n", n, sqrt(found), sqrt(1 / 31.0));
    }
    /* A cut, and a gap in the numbers, leave nothing of it. */
    for (uint32_t number = 41; number <= 46; number += 5) {
        frame(gpu, number, 0.5f, number == 41);
        float *now = gpu_floats(gpu, "reflection_half", NULL, NULL),
              *mean = gpu_floats(gpu, "reflection_temporal", NULL, NULL);
        for (int i = 0; i < 4 * PIXELS; ++i) assert_true(now[i] == mean[i]);
        free(now), free(mean);
    }
}

/* A jittered camera that stands still has its history on its own texels: resampled, noise would fall faster, and the picture
   would be blurred. With motion vectors, which hold the jitter, and by the cameras alone. */
static void jitter_resamples_no_history(void **state) {
    static const double places[4][2] = {{0, -0.17}, {-0.25, 0.17}, {0.25, -0.39}, {-0.375, -0.06}};
    struct gpu *gpu = *state;
    for (int motion = 0; motion < 2; ++motion) {
        start(gpu, "resolve.texel_scale=1");
        gpu_set(gpu, "temporal.extra=false");
        gpu_set(gpu, motion ? "temporal.motion=true" : "temporal.motion=false");
        for (uint32_t n = 1; n <= 4; ++n) {
            struct plain plain = {.roughness = 0.5f, .frame = n, .cut = n == 1};
            for (int k = 0; k < 2; ++k) {
                plain.jitter_px[k] = places[n - 1][k];
                plain.previous_jitter_px[k] = places[n > 1 ? n - 2 : 0][k];
            }
            run_frame(gpu, plain);
        }
        double found = variance_of(gpu, "reflection_temporal") / variance;
        print_message("# jittered, %s: variance after four frames %.4f of one frame's\n", motion ? "motion" : "cameras",
                      found);
        assert_true(fabs(4 * found - 1) < 0.052); /* as above */
    }
}

static void no_history_is_one_frame(void **state) {
    struct gpu *gpu = *state;
    start(gpu, "resolve.texel_scale=1");
    gpu_set(gpu, "temporal.history=0");
    gpu_set(gpu, "temporal.extra=false");
    for (uint32_t n = 1; n <= 2; ++n) frame(gpu, n, 0.5f, false);
    assert_true(fabs(variance_of(gpu, "reflection_temporal") / variance - 1) < 0.052);
}

static void expect_finite(struct gpu *gpu, const char *image) {
    uint32_t width, height;
    float *color = gpu_floats(gpu, image, &width, &height);
    for (uint32_t i = 0; i < 4 * width * height; ++i) assert_true(isfinite(color[i]) && color[i] <= 2);
    free(color);
}

static void bad_colours_leave_no_trace(void **state) {
    struct gpu *gpu = *state;
    start(gpu, "resolve.texel_scale=2");
    gpu_use(gpu, "temporal_sharp=clamped");
    for (uint32_t n = 1; n <= 8; ++n) { /* smooth, then rough */
        frame(gpu, n, n < 5 ? 0 : 0.5f, false);
        expect_finite(gpu, n < 5 ? "reflection_stable" : "reflection_temporal");
    }
}

/* Where the history is held: mean and deviation of nine neighbours; the window opens with roughness. */
static void smooth_history_is_held_within_the_neighbours(void **state) {
    static const float roughness[] = {0, 0.05f, 0.08f, 0.1f, 0.08f};
    struct gpu *gpu = *state;
    for (int r = 0; r < 5; ++r) {
        start(gpu, "resolve.texel_scale=1");
        gpu_use(gpu, "temporal=none");
        gpu_use(gpu, "temporal_sharp=clamped");
        gpu_set(gpu, "downsample.jitter=false");
        if (r == 4) gpu_set(gpu, "temporal_sharp.sharp_roughness=0.05"); /* rougher ones pass through */
        frame(gpu, 1, roughness[r], false);
        float *past = gpu_floats(gpu, "reflection_stable", NULL, NULL);
        frame(gpu, 2, roughness[r], false);
        float *now = gpu_floats(gpu, "reflection", NULL, NULL),
              *found = gpu_floats(gpu, "reflection_stable", NULL, NULL);
        double worst = 0, open = 1 - (double)roughness[r] / (r == 4 ? 0.05 : 0.1);
        int held = 0;
        for (int i = 0; i < SIZE * SIZE; ++i) {
            int x = i % SIZE, y = i / SIZE;
            double sum = 0, squares = 0, before = (double)past[4 * i];
            for (int k = 0; k < 9; ++k) {
                int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
                nx = nx < 0 ? 0 : nx >= SIZE ? SIZE - 1 : nx, ny = ny < 0 ? 0 : ny >= SIZE ? SIZE - 1 : ny;
                double c = (double)now[4 * (ny * SIZE + nx)];
                sum += c / 9, squares += c * c / 9;
            }
            double window = open > 1e-6 ? sqrt(fmax(squares - sum * sum, 0)) / open : INFINITY;
            double clamped = fmin(fmax(before, sum - window), sum + window);
            held += clamped != before;
            double expected = open < -1e-6 ? (double)now[4 * i] : (15 * clamped + (double)now[4 * i]) / 16;
            worst = fmax(worst, fabs((double)found[4 * i] - expected));
        }
        print_message("# roughness %.2f: %d of %d held, worst error %.3g\n", (double)roughness[r], held, SIZE * SIZE,
                      worst);
        assert_true(worst <
                    1e-3); /* squares of values below 2 lose 5e-7, the root of that where all neighbours are alike */
        assert_true(open > 1e-6 ? held > 100 : held == 0);
        free(past), free(now), free(found);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_falls_by_the_root_of_the_frames_to_its_floor),
        cmocka_unit_test(jitter_resamples_no_history),
        cmocka_unit_test(no_history_is_one_frame),
        cmocka_unit_test(bad_colours_leave_no_trace),
        cmocka_unit_test(smooth_history_is_held_within_the_neighbours),
    };
    return cmocka_run_group_tests_name("gpu_temporal", tests, gpu_set_up, gpu_tear_down);
}
