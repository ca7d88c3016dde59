/* compose/brdf: what does not reflect stays as it was. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gpu.h"
#include "plain_capture.h"

static void load_matte(struct gpu *gpu) {
    gpu_sample(gpu, "matte", "matte", &(struct glint_sample_options){.width = 160, .height = 90, .cube_size = 32});
    gpu_reset(gpu);
}

/* Every pass runs, and still not a bit changes. */
static void matte_stays_lit(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    load_matte(gpu);
    gpu->all = gpu->float_precision = true;
    gpu_run(gpu);
    uint32_t width, height;
    float *composed = gpu_floats(gpu, "composed", &width, &height);
    float *lit = malloc((size_t)width * height * 3 * sizeof *lit);
    assert_non_null(lit);
    const struct glint_part_info *part = glint_capture_find(gpu->capture, "lit");
    assert_non_null(part);
    assert_true(
        glint_capture_read(gpu->capture, part, (const char *const[]){"R", "G", "B"}, 3, GLINT_F32, lit, 0, &err));
    float brightest = 0;
    for (size_t i = 0; i < (size_t)width * height; ++i)
        for (size_t k = 0; k < 3; ++k) {
            assert_true(composed[4 * i + k] == lit[3 * i + k]);
            if (lit[3 * i + k] > brightest) brightest = lit[3 * i + k];
        }
    assert_true(brightest > 0.1f);
    free(composed);
    free(lit);
}

/* The reflections that it would have had were really there. */
static void matte_was_traced(void **state) {
    struct gpu *gpu = *state;
    load_matte(gpu);
    gpu->all = true;
    gpu_run(gpu);
    uint32_t width, height;
    float *reflection = gpu_floats(gpu, "reflection", &width, &height);
    size_t bright = 0;
    for (size_t i = 0; i < (size_t)width * height; ++i) bright += reflection[4 * i] > 0.01f;
    assert_true(bright * 4 > (size_t)width * height);
    free(reflection);
}

/* A mirror of specular 0.5 reflects 0.04 where nothing rises, at every angle; from there to all of it in proportion. */
static void materials_say_how_reflectance_rises(void **state) {
    struct gpu *gpu = *state;
    enum { W = 64, H = 48 };
    static const float rises[] = {0, 0.5f, 1};
    float *composed[4], *reflection = NULL;
    for (int i = 0; i < 4; ++i) {
        char path[256], name[16];
        const struct plain plain = {
            .width = W, .height = H, .fov_y_degrees = 60, .floor = true, .fresnel = i < 3 ? &rises[i] : NULL};
        snprintf(name, sizeof name, "rise%d", i);
        plain_capture(gpu_path(gpu, name, path), &plain);
        gpu_load(gpu, name);
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_run(gpu);
        composed[i] = gpu_floats(gpu, "composed", NULL, NULL);
        if (i == 0) reflection = gpu_floats(gpu, "reflection", NULL, NULL);
    }
    gpu_set(gpu, "compose.intensity=0");
    gpu_run(gpu);
    float *lit = gpu_floats(gpu, "composed", NULL, NULL);
    size_t rose = 0, reflecting = 0;
    for (size_t i = 0; i < (size_t)W * H; ++i) {
        double none = (double)composed[0][4 * i] - (double)lit[4 * i],
               half = (double)composed[1][4 * i] - (double)lit[4 * i];
        double all = (double)composed[2][4 * i] - (double)lit[4 * i];
        assert_true(composed[3][4 * i] == composed[2][4 * i]);
        if (!(reflection[4 * i] > 0)) continue;
        reflecting++;
        /* differences of floats below 2 */
        assert_true(fabs(none - 0.04 * (double)reflection[4 * i]) < 1e-6);
        assert_true(fabs(half - 0.5 * (none + all)) < 1e-6);
        rose += all > 1.5 * none;
    }
    print_message("# %zu pixels reflect, %zu of them half as much again by rising\n", reflecting, rose);
    assert_true(reflecting > 500 && rose > 100);
    for (int i = 0; i < 4; ++i) free(composed[i]);
    free(lit), free(reflection);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(matte_stays_lit), cmocka_unit_test(matte_was_traced),
                                       cmocka_unit_test(materials_say_how_reflectance_rises)};
    return cmocka_run_group_tests_name("gpu_compose_brdf", tests, gpu_set_up, gpu_tear_down);
}
