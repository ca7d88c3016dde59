/* compose/brdf: what does not reflect stays as it was. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gpu.h"

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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(matte_stays_lit), cmocka_unit_test(matte_was_traced)};
    return cmocka_run_group_tests_name("gpu_compose_brdf", tests, gpu_set_up, gpu_tear_down);
}
