/* The foreground occludes the world for the camera, and changes nothing else. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

enum { W = 96, H = 54 };

static const struct glint_sample_options base = {
    .width = W, .height = H, .cube_size = 16, .light_samples = 4, .truth_samples = 1, .unjittered = true};

static bool *foreground_of(struct glint_capture *capture) {
    static const char *const id[1] = {"stencil.id"};
    struct glint_error err = {0};
    uint32_t *ids = calloc(W * H, sizeof *ids);
    bool *found = calloc(W * H, sizeof *found);
    assert_true(ids && found);
    assert_true(glint_capture_read(capture, glint_capture_find(capture, "gbuffer"), id, 1, GLINT_U32, ids, 0, &err));
    for (size_t i = 0; i < W * H; i++) found[i] = (ids[i] & STENCIL_FOREGROUND) != 0;
    free(ids);
    return found;
}

static void test_the_world_stays_as_it_was(void **state) {
    struct glint_sample_options with = base;
    with.foreground = true;
    write_sample("street", in_folder(state, "with.exr"), &with);
    write_sample("street", in_folder(state, "without.exr"), &base);
    struct glint_capture *files[2] = {open_capture(in_folder(state, "with.exr")),
                                      open_capture(in_folder(state, "without.exr"))};
    float *gbuffer[2], *truth[2], *map[2];
    bool *front[2];
    for (int k = 0; k < 2; k++) {
        front[k] = foreground_of(files[k]);
        gbuffer[k] =
            read_part(files[k], "gbuffer", "depth.Z normal.X normal.Y normal.Z material.roughness", NULL, NULL);
        truth[k] = read_part(files[k], "truth.mirror", "distance.Z visible", NULL, NULL);
        map[k] = read_part(files[k], "cubemap.000", "R G B distance.Z", NULL, NULL);
    }
    size_t before = 0, hidden = 0;
    for (size_t i = 0; i < W * H; i++) {
        const float *a = gbuffer[0] + 5 * i, *b = gbuffer[1] + 5 * i;
        assert_false(front[1][i]);
        if (front[0][i]) {
            before++;
            assert_true(a[0] < 1.5f && a[0] < b[0]);
            continue;
        }
        assert_memory_equal(a, b, 5 * sizeof *a);
        assert_true(truth[0][2 * i] == truth[1][2 * i]);
        assert_true(truth[0][2 * i + 1] <= truth[1][2 * i + 1]);
        hidden += truth[0][2 * i + 1] < truth[1][2 * i + 1];
    }
    assert_true(before > W * H / 30 && before < W * H / 4);
    assert_true(hidden > 5); /* the ends of mirror rays behind the gun */
    assert_memory_equal(map[0], map[1], 16 * 96 * 4 * sizeof(float));
    for (int k = 0; k < 2; k++) {
        bool declared = false;
        const struct glint_frame *frame = glint_capture_frame(files[k]);
        for (size_t i = 0; i < frame->class_count; i++) declared |= !strcmp(frame->classes[i].name, "foreground");
        assert_true(declared == (k == 0));
        free(front[k]), free(gbuffer[k]), free(truth[k]), free(map[k]);
        glint_capture_close(&files[k]);
    }
}

/* It moves with the camera, so that it is static on screen. */
static void test_it_moves_with_the_camera(void **state) {
    struct glint_sample_options o = base;
    o.foreground = o.travel_given = true;
    o.travel[0] = 0.4;
    o.travel[2] = -0.3;
    o.first_frame = 3;
    o.truth_samples = 0;
    write_sample("room", in_folder(state, "moving.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "moving.exr"));
    float *motion = read_part(capture, "gbuffer", "motion.X motion.Y", NULL, NULL);
    bool *front = foreground_of(capture);
    size_t before = 0, moving = 0;
    for (size_t i = 0; i < W * H; i++) {
        double way = hypot((double)motion[2 * i], (double)motion[2 * i + 1]);
        before += front[i];
        moving += !front[i] && way > 0.01;
        /* positions are floats of a few metres, seen from 0.3 m */
        if (front[i]) assert_true(way < 1e-4);
    }
    assert_true(before > W * H / 30 && moving > W * H / 4);
    free(motion), free(front);
    glint_capture_close(&capture);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_world_stays_as_it_was),
                                       cmocka_unit_test(test_it_moves_with_the_camera)};
    return cmocka_run_group_tests_name("test_samples_foreground", tests, folder_make, folder_remove);
}
