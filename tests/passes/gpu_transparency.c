/* Glass over the picture on the scene glasshouse, against what its path tracer says the camera sees: both faces of a pane by
   Fresnel's formulas, the mirror ray followed to its end. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gpu.h"

enum { WIDTH = 240, HEIGHT = 136 };

static void load(struct gpu *gpu, const char *scene) {
    gpu_sample(gpu, scene, scene,
               &(struct glint_sample_options){
                   .width = WIDTH, .height = HEIGHT, .cube_size = 64, .light_samples = 8, .unjittered = true});
    gpu_reset(gpu);
    gpu_use(gpu, "transparency=trace");
    gpu_set(gpu, "compose.intensity=0"); /* the truth has what the panes reflect, nothing else */
}

/* Mean of |seen - true| / (seen + true + 0.05) over the pixels of the panes, or the largest beside them. */
static double error_of(struct gpu *gpu, const float *opacity, const float *scene, bool beside) {
    double sum = 0, worst = 0;
    size_t count = 0;
    float *finished = gpu_floats(gpu, "finished", NULL, NULL);
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i)
        for (size_t c = 0; c < 3; ++c) {
            double a = (double)finished[4 * i + c], b = (double)scene[3 * i + c], apart = fabs(a - b) / (a + b + 0.05);
            if (opacity[i] > 0) sum += apart, ++count;
            else worst = fmax(worst, apart);
        }
    free(finished);
    assert_true(count > WIDTH * HEIGHT / 4);
    return beside ? worst : sum / (double)count;
}

static void every_part_of_it_brings_the_picture_nearer(void **state) {
    struct gpu *gpu = *state;
    static const char *const off[] = {NULL, "transparency.length_m=0", "transparency.cubemap_steps=0",
                                      "transparency.fresnel=false", "transparency.intensity=0"};
    double errors[5];
    load(gpu, "glasshouse");
    float *opacity = gpu_part(gpu, "transparent", (const char *[]){"A"}, 1),
          *scene = gpu_part(gpu, "scene", (const char *[]){"R", "G", "B"}, 3);
    for (int i = 0; i < 5; ++i) {
        load(gpu, "glasshouse");
        if (off[i]) gpu_set(gpu, off[i]);
        gpu_run(gpu);
        errors[i] = error_of(gpu, opacity, scene, false);
        print_message("# %-28s %.4f\n", off[i] ? off[i] : "all", errors[i]);
        if (i) assert_true(errors[i] > errors[0]);
        /* Nothing is laid over what no pane covers; both were rounded to half floats. */
        assert_true(error_of(gpu, opacity, scene, true) < 1e-3);
    }
    /* Half of the error is the reflection of what no buffer shows; the other half goes. */
    assert_true(errors[4] > 1.5 * errors[0]);
    free(opacity), free(scene);
}

static void a_frame_without_glass_leaves_it_out(void **state) {
    struct gpu *gpu = *state;
    size_t count = 0;
    bool found = false;
    load(gpu, "matte");
    gpu_run(gpu);
    const struct glint_pass_result *results = glint_replay_results(gpu->replay, &count);
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(results[i].pass->slot, "transparency")) continue;
        found = true;
        assert_false(results[i].ran);
    }
    assert_true(found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_of_it_brings_the_picture_nearer),
        cmocka_unit_test(a_frame_without_glass_leaves_it_out),
    };
    return cmocka_run_group_tests_name("gpu_transparency", tests, gpu_set_up, gpu_tear_down);
}
