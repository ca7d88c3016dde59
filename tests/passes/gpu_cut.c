/* A cut leaves no trace of the view before it: through the whole of mafia3, the frame after it has the bits that it has as
   the first one of all. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gpu.h"

static const char *const images[] = {"reflection_temporal", "temporal_age",      "reflection",
                                     "reflection_sharp",    "reflection_stable", "composed"};
enum { IMAGES = sizeof images / sizeof *images, CUT_AT = 4 };

struct picture {
    float *values[IMAGES];
    size_t bytes[IMAGES];
};

static void take(struct gpu *gpu, struct picture *picture) {
    for (int i = 0; i < IMAGES; ++i) {
        uint32_t width, height;
        picture->values[i] = gpu_floats(gpu, images[i], &width, &height);
        const struct glint_image *image = glint_replay_find_image(gpu->replay, images[i]);
        picture->bytes[i] = (size_t)width * height * image->components * sizeof(float);
    }
}

static int differing(const struct picture *a, const struct picture *b) {
    int count = 0;
    for (int i = 0; i < IMAGES; ++i)
        count += a->bytes[i] != b->bytes[i] || memcmp(a->values[i], b->values[i], a->bytes[i]) != 0;
    return count;
}

static void drop(struct picture *picture) {
    for (int i = 0; i < IMAGES; ++i) free(picture->values[i]);
}

/* A frame that follows three from another place of the same room; alone, nothing precedes it. */
static void follow(struct gpu *gpu, bool cut, bool alone, struct picture *picture) {
    static const double eye[3] = {4, 1.5, 0.5}, target[3] = {4.4, 1.1, -4};
    struct glint_sample_options o = {.width = 96, .height = 54, .cube_size = 16, .light_samples = 4};
    struct glint_error err = {0};
    assert_true(glint_replay_load(gpu->replay, NULL, &err));
    glint_replay_destroy(&gpu->replay);
    gpu->replay = glint_replay_create(gpu->device, &err);
    assert_non_null(gpu->replay);
    for (uint32_t n = 1; n < CUT_AT && !alone; ++n) {
        char name[32];
        snprintf(name, sizeof name, "room%u.exr", n);
        o.first_frame = n;
        gpu_sample(gpu, "room", name, &o);
        gpu_run(gpu);
    }
    o.first_frame = CUT_AT;
    o.cut = cut;
    o.camera_given = true;
    memcpy(o.eye, eye, sizeof eye);
    memcpy(o.target, target, sizeof target);
    gpu_sample(gpu, "room", cut ? "cut.exr" : "uncut.exr", &o);
    gpu_run(gpu);
    take(gpu, picture);
}

static void a_cut_leaves_no_trace(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    struct picture in_shot, alone;
    glint_pipeline_destroy(&gpu->pipeline);
    gpu->pipeline = glint_pipeline_create("mafia3", &err);
    assert_non_null(gpu->pipeline);
    follow(gpu, true, false, &in_shot);
    follow(gpu, true, true, &alone);
    assert_int_equal(differing(&in_shot, &alone), 0);
    drop(&in_shot), drop(&alone);
    /* Without it, those frames are still there. */
    follow(gpu, false, false, &in_shot);
    follow(gpu, false, true, &alone);
    assert_int_equal(differing(&in_shot, &alone), IMAGES);
    drop(&in_shot), drop(&alone);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_cut_leaves_no_trace)};
    return cmocka_run_group_tests_name("gpu_cut", tests, gpu_set_up, gpu_tear_down);
}
