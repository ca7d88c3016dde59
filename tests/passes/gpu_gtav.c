/* The preset gtav_display: what it makes of a yard and of a lake, with a plan and without one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "unit.h"

enum { WIDTH = 96, HEIGHT = 54, PIXELS = WIDTH * HEIGHT };

static void load(struct gpu *gpu, const char *scene) {
    struct glint_error err = {0};
    gpu_sample(gpu, scene, scene,
               &(struct glint_sample_options){.width = WIDTH,
                                              .height = HEIGHT,
                                              .cube_size = 32,
                                              .planar_width = 48,
                                              .planar_height = 27,
                                              .cascades = 4,
                                              .also = GLINT_ALSO_SHADOW | GLINT_ALSO_STIPPLE | GLINT_ALSO_CAUSTICS |
                                                      (strcmp(scene, "meadow") ? 0 : GLINT_ALSO_SKY)});
    glint_pipeline_destroy(&gpu->pipeline);
    gpu->pipeline = glint_pipeline_create("gtav_display", &err);
    if (!gpu->pipeline) fail_msg("%s", err.message);
}

static void the_plan_changes_no_bit(void **state) {
    static const char *const scenes[] = {"courtyard", "lake", "meadow"}, *const images[] = {"occlusion", "shadow_soft",
                                                                                            "composed", "exposed",
                                                                                            "graded"};
    struct gpu *gpu = *state;
    for (int s = 0; s < 3; s++) {
        float *planned[5];
        load(gpu, scenes[s]);
        gpu->all = false;
        gpu_run(gpu);
        for (int k = 0; k < 5; k++) planned[k] = gpu_floats(gpu, images[k], NULL, NULL);
        assert_true(gpu_result(gpu, "water")->ran == (s == 1) && gpu_result(gpu, "refraction_map")->ran == (s == 1));
        assert_true(gpu_result(gpu, "ao_trace")->ran && gpu_result(gpu, "shadow_blur")->ran &&
                    gpu_result(gpu, "grade")->ran);
        assert_true(gpu_result(gpu, "sky_compose")->ran ==
                    (s == 2)); /* without a plan it asks water that is not there */
        assert_true(!gpu_result(gpu, "fog")->ran && !gpu_result(gpu, "sss_blur")->ran &&
                    !gpu_result(gpu, "unstipple")->ran);
        gpu->all = true;
        gpu_run(gpu);
        for (int k = 0; k < 5; k++) {
            float *all = gpu_floats(gpu, images[k], NULL, NULL);
            assert_memory_equal(planned[k], all, sizeof(float) * PIXELS * (k < 2 ? 1 : 4));
            free(planned[k]), free(all);
        }
    }
}

/* Reinhard's curve gets 1 for 11.2 and is encoded; the sky of the yard is in the picture, and shadows are. */
static void the_picture_is_one_for_a_display(void **state) {
    struct gpu *gpu = *state;
    float least = 1, most = 0;
    load(gpu, "courtyard");
    gpu_run(gpu);
    float *graded = gpu_floats(gpu, "graded", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        for (uint32_t c = 0; c < 3; c++) assert_true(graded[4 * i + c] >= 0 && graded[4 * i + c] <= 1);
        least = fminf(least, graded[4 * i + 1]), most = fmaxf(most, graded[4 * i + 1]);
    }
    print_message("# green from %.3f to %.3f\n", (double)least, (double)most);
    assert_true(least < 0.2F && most > 0.6F);
    free(graded);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_plan_changes_no_bit),
                                       cmocka_unit_test(the_picture_is_one_for_a_display)};
    return cmocka_run_group_tests_name("gpu_gtav", tests, gpu_set_up, gpu_tear_down);
}
