/* Classes of pixels, compared with the geometry of the fixture's G-buffer. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fixture.h"
#include "glint/study.h"
#include "unit.h"

enum { W = FIXTURE_WIDTH, H = FIXTURE_HEIGHT };

/* The index of the class in `names`: the first whose limit is not exceeded. */
static unsigned bin(double value, double a, double b, double c) {
    return value <= a ? 1 : value <= b ? 2 : value <= c ? 3 : 4;
}

/* The camera is 1.5 m above the floor and 6 m in front of the wall: the cosine is the height or 6 m over the distance. Everything is
   scaled by `scale` in this frame. */
static void check_room(const struct fixture *fixture, uint32_t number, double scale, const unsigned *distances) {
    struct glint_classes sets[GLINT_CAPTURE_CLASSES];
    struct glint_error err = {0};
    size_t count = 0, seen[GLINT_CAPTURE_CLASSES][8] = {{0}};
    char path[128];
    snprintf(path, sizeof path, "%s/room.exr", fixture->folder);
    assert_true(fixture_write_capture(path, &(struct fixture_options){.number = number}, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture || !glint_study_classes(capture, glint_effect_find("reflection"), sets, &count, &err))
        fail_msg("%s", err.message);
    assert_int_equal(count, GLINT_CLASSES_HIT); /* there is no truth.mirror */
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const double dx = ((x + 0.5) / W * 2 - 1) * 0.9, dy = (1 - (y + 0.5) / H * 2) * 0.55;
            const bool on_floor = dy < 0 && -1.5 / dy < 6, sky = !on_floor && 1.5 + 6 * dy > 3;
            const double distance = (on_floor ? -1.5 / dy : 6) * sqrt(1 + dx * dx + dy * dy);
            const double roughness = (double)(float)(0.02 + 0.5 * x / W);
            const bool reflects = !sky && (on_floor || x % 11 == 0);
            const unsigned surface = roughness <= 0.1 ? 1 : roughness <= 0.5 ? 2 : 3;
            const unsigned angle = bin((on_floor ? 1.5 : 6) / distance, 0.1, 0.25, 0.5);
            const size_t i = (size_t)y * W + (size_t)x;
            assert_int_equal(sets[GLINT_CLASSES_EFFECT].labels[i], reflects ? surface : 0);
            assert_int_equal(sets[GLINT_CLASSES_ANGLE].labels[i], reflects ? angle : 0);
            assert_int_equal(sets[GLINT_CLASSES_DISTANCE].labels[i], reflects ? bin(scale * distance, 3, 10, 30) : 0);
            for (size_t k = 0; k < count; k++) seen[k][sets[k].labels[i]]++;
        }
    for (size_t k = 2; k <= 4; k++) assert_true(seen[GLINT_CLASSES_ANGLE][k] > 0);
    for (size_t k = 0; k < 2; k++) assert_true(seen[GLINT_CLASSES_DISTANCE][distances[k]] > 0);
    for (size_t k = 0; k < count; k++) glint_classes_finish(&sets[k]);
    glint_capture_close(&capture);
}

static void angles_and_distances_are_those_of_the_room(void **state) {
    check_room(*state, 15, 2, (const unsigned[]){2, 3});
    check_room(*state, 47, 6, (const unsigned[]){3, 4});
}

static void hits_are_binned_and_know_the_sky(void **state) {
    const struct fixture *fixture = *state;
    static float mirror[H][W][2];
    static const float distances[] = {0, 0.5F, 1, 1.5F, 4, 10, 17, INFINITY};
    static const uint8_t expected[] = {0, 1, 1, 2, 2, 3, 4, 5};
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) mirror[y][x][0] = distances[x % 8];
    const struct glint_channel channels[] = {{"distance.Z", GLINT_F32, &mirror[0][0][0], 2 * sizeof(float), 0, NULL},
                                             {"visible", GLINT_F32, &mirror[0][0][1], 2 * sizeof(float), 0, NULL}};
    const struct glint_part part = {
        .name = "truth.mirror", .width = W, .height = H, .channels = channels, .channel_count = 2};
    struct glint_classes sets[GLINT_CAPTURE_CLASSES];
    struct glint_error err = {0};
    size_t count = 0, compared = 0;
    char path[128];
    snprintf(path, sizeof path, "%s/mirror.exr", fixture->folder);
    if (!fixture_write_capture(path, &(struct fixture_options){.extra = &part, .extra_count = 1}, &err))
        fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture || !glint_study_classes(capture, glint_effect_find("reflection"), sets, &count, &err))
        fail_msg("%s", err.message);
    assert_int_equal(count, GLINT_CAPTURE_CLASSES);
    for (size_t i = 0; i < (size_t)W * H; i++) {
        if (!sets[GLINT_CLASSES_EFFECT].labels[i]) continue;
        assert_int_equal(sets[GLINT_CLASSES_HIT].labels[i], expected[i % W % 8]);
        compared++;
    }
    assert_true(compared > 8 * 8);
    for (size_t k = 0; k < count; k++) glint_classes_finish(&sets[k]);
    glint_capture_close(&capture);
}

/* A truth that is known in the left half only. */
static void pixels_of_which_the_truth_knows_nothing_are_not_compared(void **state) {
    const struct fixture *fixture = *state;
    static float truth[H][W][5];
    static const char *const names[] = {"R", "G", "B", "weight", "error"};
    struct glint_channel channels[5];
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W / 2; x++)
            for (int c = 0; c < 5; c++) truth[y][x][c] = c < 3 ? 2 : 0.25F;
    for (int c = 0; c < 5; c++)
        channels[c] = (struct glint_channel){names[c], GLINT_F32, &truth[0][0][c], sizeof truth[0][0], 0, NULL};
    for (size_t count = 4; count <= 5; count++) { /* with errors and without */
        const struct glint_part part = {
            .name = "truth.reflection.ggx", .width = W, .height = H, .channels = channels, .channel_count = count};
        struct glint_pixels answer;
        struct glint_image_errors errors;
        struct glint_error err = {0};
        float *error = NULL;
        char path[128];
        snprintf(path, sizeof path, "%s/half.exr", fixture->folder);
        if (!fixture_write_capture(path, &(struct fixture_options){.extra = &part, .extra_count = 1}, &err))
            fail_msg("%s", err.message);
        struct glint_capture *capture = glint_capture_open(path, NULL, &err);
        if (!capture ||
            !glint_study_truth(capture, glint_effect_find("reflection"), fixture->pipeline, &answer, &error, &err))
            fail_msg("%s", err.message);
        static float three[H * W * 3];
        for (size_t i = 0; i < sizeof three / sizeof *three; i++) three[i] = 3;
        const struct glint_pixels found = {W, H, 3, three};
        assert_true(glint_study_image(&found, &answer, 3, NULL, error, &errors, &err));
        assert_int_equal(errors.of[0].pixels, H * (W / 2));
        assert_true(errors.of[0].mean == 1); /* 3 where the truth is unknown */
        free(error);
        glint_pixels_finish(&answer);
        glint_capture_close(&capture);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(angles_and_distances_are_those_of_the_room),
        cmocka_unit_test(hits_are_binned_and_know_the_sky),
        cmocka_unit_test(pixels_of_which_the_truth_knows_nothing_are_not_compared),
    };
    return cmocka_run_group_tests(tests, fixture_setup_host, fixture_teardown);
}
