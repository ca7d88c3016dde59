/* A G-buffer as in the GTA V article, with reversed logarithmic depth and glossiness, is traced like the canonical one: passes read
   linear depth in metres, downsampled, and march in inverse depth. */
#include <math.h>
#include <stdlib.h>

#include "gpu.h"
#include "unit.h"

static void reversed_logarithmic_depth_is_marched_as_linear_depth_is(void **state) {
    struct gpu *gpu = *state;
    float *depth[2], *normal[2], *travelled[2];
    uint32_t *finished[2], width = 0, height = 0;
    for (int i = 0; i < 2; ++i) {
        struct glint_sample_options o = {.width = 192, .height = 108, .cube_size = 16, .light_samples = 4};
        if (i)
            o.encodings = (struct glint_encodings){.depth = GLINT_DEPTH_LOGARITHMIC_REVERSED,

                                                   .roughness = GLINT_ROUGHNESS_GLOSS};
        gpu_sample(gpu, "room", i ? "logarithmic" : "linear", &o);
        gpu_reset(gpu);
        gpu_set(gpu, "downsample.jitter=false");
        gpu_run(gpu);
        depth[i] = gpu_floats(gpu, "depth_half", &width, &height);
        normal[i] = gpu_floats(gpu, "normal_jittered", NULL, NULL);
        travelled[i] = gpu_floats(gpu, "screen_travelled", NULL, NULL);
        finished[i] = gpu_uints(gpu, "screen_finished", NULL, NULL);
    }
    assert_int_equal(width, 96);
    assert_int_equal(height, 54);
    size_t rays = 0, flips = 0, apart = 0, hits = 0;
    double deepest = 0;
    for (size_t i = 0; i < (size_t)width * height; ++i) {
        if (isinf(depth[0][i]) || isinf(depth[1][i])) {
            assert_true(depth[0][i] == depth[1][i]);
            continue;
        }
        deepest = fmax(deepest, fabs((double)depth[1][i] / (double)depth[0][i] - 1));
        assert_true(fabsf(normal[1][4 * i + 3] - normal[0][4 * i + 3]) <= 1 / 255.0f);
        rays++;
        flips += finished[0][i] != finished[1][i];
        if (!finished[0][i] || !finished[1][i] || !(travelled[0][i] < 3e38f)) continue;
        hits++;
        apart += fabsf(travelled[1][i] - travelled[0][i]) > 0.05f * travelled[0][i];
    }
    print_message("# depth apart by %.2g at most; %zu rays, %zu flips, %zu hits, %zu of them apart by 5 %%\n", deepest,
                  rays, flips, hits, apart);
    assert_true(rays > 3000 && hits > 500);
    /* ln(4000 / 0.1) = 10.6 times half a step of D24, 3e-8, and as much for the float that stores it */
    assert_true(deepest <= 1.3e-6);
    assert_true(flips * 200 <= rays && apart * 200 <= hits);
    for (int i = 0; i < 2; ++i) free(depth[i]), free(normal[i]), free(travelled[i]), free(finished[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(reversed_logarithmic_depth_is_marched_as_linear_depth_is)};
    return cmocka_run_group_tests_name("gpu_encodings", tests, gpu_set_up, gpu_tear_down);
}
