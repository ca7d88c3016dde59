/* An interrupted shot is completed; existing frames with the same settings are not rendered again. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct glint_sample_options options(void) {
    return (struct glint_sample_options){.width = 16, .height = 12, .cube_size = 8, .light_samples = 2, .frames = 3};
}

/* Files are written to a temporary file first: a new file has another inode or a later time. */
static struct stat status_of(void **state, const char *name) {
    struct stat status;
    assert_int_equal(stat(in_folder(state, name), &status), 0);
    return status;
}

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_ino == b->st_ino && a->st_mtim.tv_sec == b->st_mtim.tv_sec && a->st_mtim.tv_nsec == b->st_mtim.tv_nsec;
}

/* FNV-1a */
static uint64_t hash_of(void **state, const char *name) {
    uint64_t hash = 14695981039346656037U;
    FILE *file = fopen(in_folder(state, name), "rb");
    assert_non_null(file);
    for (int c; (c = fgetc(file)) != EOF;) hash = (hash ^ (uint64_t)c) * 1099511628211U;
    fclose(file);
    return hash;
}

static const char *const files[4] = {"s.cubemaps.exr", "s.0001.exr", "s.0002.exr", "s.0003.exr"};

static void test_missing_frames_are_made(void **state) {
    struct glint_sample_options o = options();
    struct stat before[4];
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) before[i] = status_of(state, files[i]);
    uint64_t whole = hash_of(state, "s.0002.exr");
    assert_int_equal(unlink(in_folder(state, "s.0002.exr")), 0);
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) {
        struct stat after = status_of(state, files[i]);
        assert_int_equal(same_file(&before[i], &after), i != 2);
    }
    assert_true(whole == hash_of(state, "s.0002.exr")); /* as if it had not been interrupted */
}

static void test_a_damaged_frame_is_made_again(void **state) {
    struct glint_sample_options o = options();
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    uint64_t whole = hash_of(state, "s.0003.exr");
    struct stat status = status_of(state, "s.0003.exr");
    assert_int_equal(truncate(in_folder(state, "s.0003.exr"), status.st_size / 2), 0);
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    assert_true(whole == hash_of(state, "s.0003.exr"));
}

static void test_other_settings_make_all_of_it_again(void **state) {
    struct glint_sample_options o = options();
    struct stat before[4];
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) before[i] = status_of(state, files[i]);
    o.encodings.roughness = GLINT_ROUGHNESS_ALPHA;
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) {
        struct stat after = status_of(state, files[i]);
        assert_false(same_file(&before[i], &after));
    }
}

/* Frames depend on their cube maps. */
static void test_lost_cube_maps_come_back(void **state) {
    struct glint_sample_options o = options();
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    uint64_t whole = hash_of(state, files[0]);
    struct stat before = status_of(state, files[1]);
    assert_int_equal(unlink(in_folder(state, files[0])), 0);
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    assert_true(whole == hash_of(state, files[0]));
    struct stat after = status_of(state, files[1]);
    assert_true(same_file(&before, &after)); /* the cube maps are the same, so the frames are still valid */
}

/* Options of a shot with an explicit camera. */
static struct glint_sample_options given_camera(void) {
    struct glint_sample_options o = options();
    o.camera_given = true;
    const double eye[3] = {4, 2, 5}, target[3] = {4.5, 0, 2};
    memcpy(o.eye, eye, sizeof eye);
    memcpy(o.target, target, sizeof target);
    return o;
}

static void test_a_given_camera_stands_still_or_travels(void **state) {
    for (int i = 0; i < 3; i++) { /* the last one: without jitter */
        struct glint_sample_options o = given_camera();
        const double travel[3] = {0.5, -0.25, 0.125};
        o.travel_given = i == 1;
        o.unjittered = i == 2;
        memcpy(o.travel, travel, sizeof travel);
        write_sample("mirror_box", in_folder(state, "s.exr"), &o);
        for (int n = 0; n < 3; n++) {
            struct glint_capture *capture = open_capture(in_folder(state, files[n + 1]));
            const struct glint_frame *frame = glint_capture_frame(capture);
            double eye[3];
            camera_eye(&frame->camera, eye);
            for (int k = 0; k < 3; k++) assert_true(fabs(eye[k] - o.eye[k] - (i == 1 ? n * travel[k] : 0)) < 1e-12);
            assert_int_equal(frame->jitter_px[0] == 0 && frame->jitter_px[1] == 0, i == 2);
            bool same =
                !memcmp(frame->camera.view_to_clip, frame->previous.view_to_clip, sizeof frame->camera.view_to_clip);
            assert_int_equal(same, i == 2);
            glint_capture_close(&capture);
        }
    }
}

/* The truth of pixels is the mean of the truths in sixteen frames of a static camera. */
static void test_truth_of_pixels_is_the_mean_over_the_jitter(void **state) {
    enum { FRAMES = 16, PIXELS = 16 * 12 };
    struct glint_sample_options o = given_camera();
    double mean[3 * PIXELS] = {0};
    bool mirror[PIXELS];
    memset(mirror, 1, sizeof mirror);
    o.truth_samples = 1;
    o.frames = FRAMES;
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int n = 1; n <= FRAMES; n++) {
        char name[32];
        snprintf(name, sizeof name, "s.%04d.exr", n);
        struct glint_capture *capture = open_capture(in_folder(state, name));
        float *truth = read_part(capture, "truth.reflection.ggx", "R G B", NULL, NULL),
              *roughness = read_part(capture, "gbuffer", "material.roughness", NULL, NULL);
        for (int i = 0; i < PIXELS; i++) mirror[i] = mirror[i] && roughness[i] == 0;
        for (int i = 0; i < 3 * PIXELS; i++) mean[i] += (double)truth[i] / FRAMES;
        free(truth), free(roughness);
        glint_capture_close(&capture);
    }
    o.truth_of_pixels = true;
    o.frames = 1;
    write_sample("mirror_box", in_folder(state, "one.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "one.exr"));
    float *found = read_part(capture, "truth.reflection.ggx", "R G B", NULL, NULL);
    int compared = 0, apart = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (!mirror[i]) continue;
        compared++;
        for (int k = 0; k < 3; k++)
            assert_true(fabs((double)found[3 * i + k] - mean[3 * i + k]) < 1e-3); /* half floats */
    }
    o.truth_of_pixels = false;
    write_sample("mirror_box", in_folder(state, "one.exr"), &o);
    glint_capture_close(&capture);
    capture = open_capture(in_folder(state, "one.exr"));
    float *sample = read_part(capture, "truth.reflection.ggx", "R G B", NULL, NULL);
    for (int i = 0; i < PIXELS; i++) apart += mirror[i] && fabs((double)sample[3 * i] - mean[3 * i]) > 1e-3;
    print_message("# %d pixels, of which one sample is not the mean in %d\n", compared, apart);
    assert_true(compared > 30 && apart > compared / 4);
    free(found), free(sample);
    glint_capture_close(&capture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_missing_frames_are_made, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_a_damaged_frame_is_made_again, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_other_settings_make_all_of_it_again, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_a_given_camera_stands_still_or_travels, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_truth_of_pixels_is_the_mean_over_the_jitter, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_lost_cube_maps_come_back, folder_make, folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
