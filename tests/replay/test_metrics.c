/* Metrics of images and distances compared with sums by hand, and with errors that are added. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/study.h"
#include "uniform.h"
#include "unit.h"

enum { NONE = GLINT_CLASS_NONE, MIRROR = GLINT_CLASS_FIRST, GLOSSY, ROUGH };

static void assert_near(double found, double expected, double tolerance) {
    if (!(fabs(found - expected) <= tolerance)) fail_msg("%.17g is not %.17g ± %g", found, expected, tolerance);
}

static void figures_are_those_of_a_sum_by_hand(UNUSED void **state) {
    float found[] = {1, 2, 9, 0, 1, 9, 5, 5, 9, 7, 7, 9}, truth[] = {1, 1, 0, 2, 3, 3, 9, 9};
    const uint8_t surfaces[] = {MIRROR, MIRROR, GLOSSY, NONE};
    const struct glint_pixels f = {2, 2, 3, found}, t = {2, 2, 2, truth};
    struct glint_image_errors e;
    struct glint_error err = {0};
    assert_true(glint_study_image(&f, &t, 2, surfaces, NULL, &e, &err));
    /* differences 0, 1, 0, -1 of truths 1, 1, 0, 2; and 2, 2 of 3, 3; sums of integers in double are exact */
    assert_int_equal(e.of[MIRROR].pixels, 2);
    assert_near(e.of[MIRROR].truth_mean, 1, 0);
    assert_near(e.of[MIRROR].mean, 0, 0);
    assert_near(e.of[MIRROR].rmse, sqrt(0.5), 1e-15);
    assert_near(e.of[MIRROR].relative_mse, (1 / 1.01 + 1 / 4.01) / 4, 1e-15);
    assert_near(e.of[MIRROR].symmetric, (1 / 3.05 + 1 / 3.05) / 4, 1e-15);
    assert_near(e.of[GLOSSY].mean, 2, 0);
    assert_near(e.of[GLOSSY].rmse, 2, 1e-15);
    assert_int_equal(e.of[0].pixels, 3);
    assert_near(e.of[0].rmse, sqrt((2.0 + 8) / 6), 1e-15);
    assert_int_equal(e.of[ROUGH].pixels, 0);
    assert_true(glint_study_image(&f, &t, 2, NULL, NULL, &e, &err));
    assert_int_equal(e.of[0].pixels, 4);
}

static void what_is_no_number_is_counted_and_spoils_nothing(UNUSED void **state) {
    float found[] = {NAN, 1, INFINITY, 1}, truth[] = {1, 1, 1, 1};
    const uint8_t surfaces[] = {MIRROR, MIRROR, GLOSSY, GLOSSY};
    const struct glint_pixels f = {4, 1, 1, found}, t = {4, 1, 1, truth};
    struct glint_image_errors e;
    struct glint_error err = {0};
    assert_true(glint_study_image(&f, &t, 1, surfaces, NULL, &e, &err));
    assert_int_equal(e.of[0].invalid, 2);
    assert_int_equal(e.of[MIRROR].invalid, 1);
    assert_int_equal(e.of[0].pixels, 2);
    assert_near(e.of[0].rmse, 0, 0);
}

static void images_of_two_sizes_are_refused(UNUSED void **state) {
    float values[4] = {0};
    const struct glint_pixels a = {2, 2, 1, values}, b = {4, 1, 1, values};
    struct glint_image_errors e;
    struct glint_error err = {0};
    assert_false(glint_study_image(&a, &b, 1, NULL, NULL, &e, &err));
    assert_non_null(strstr(err.message, "2 × 2 and 4 × 1"));
    assert_false(glint_study_image(&a, &a, 2, NULL, NULL, &e, &err));
}

/* The image has a constant error and the truth has known noise: after subtracting the noise, the constant remains. */
static void the_truths_noise_is_taken_off(UNUSED void **state) {
    enum { SIZE = 512 };
    const double off = 0.05, noise = 0.2;
    struct glint_pixels f = {SIZE, SIZE, 1, malloc(sizeof(float) * SIZE * SIZE)};
    struct glint_pixels t = {SIZE, SIZE, 1, malloc(sizeof(float) * SIZE * SIZE)};
    float *error = malloc(sizeof(float) * SIZE * SIZE);
    uint64_t seed = 1;
    assert_true(f.values && t.values && error);
    for (size_t i = 0; i < SIZE * SIZE; i++) {
        double real = 0.5 + uniform(&seed);
        /* the variance of a sum of uniform numbers is their count over 12 */
        double normal = -6;
        for (int k = 0; k < 12; k++) normal += uniform(&seed);
        f.values[i] = (float)(real + off);
        t.values[i] = (float)(real * (1 + noise * normal));
        error[i] = (float)noise;
    }
    struct glint_image_errors e;
    struct glint_error err = {0};
    assert_true(glint_study_image(&f, &t, 1, NULL, error, &e, &err));
    /* E[t²σ²] is 1 + σ² of the noise, because the noisy truth replaces the real one: 4 % of 0.0433; the rest is the deviation of
       262,144 samples, 0.3 % */
    assert_near(e.of[0].truth_noise, noise * sqrt(1.0833 * 1.04), 0.003);
    assert_near(e.of[0].rmse, sqrt(off * off + noise * noise * 1.0833), 0.003);
    assert_near(e.of[0].clean_rmse, sqrt(off * off - 0.04 * noise * noise * 1.0833), 0.01);
    glint_pixels_finish(&f);
    glint_pixels_finish(&t);
    free(error);
}

static void distances_know_the_sky(UNUSED void **state) {
    const float found[] = {1, 1.04f, 2, INFINITY, INFINITY, 3, NAN, -1},
                truth[] = {1, 1, 1, INFINITY, 1, INFINITY, 1, 1};
    const uint8_t surfaces[] = {MIRROR, MIRROR, MIRROR, GLOSSY, GLOSSY, GLOSSY, MIRROR, NONE};
    struct glint_distance_errors e;
    struct glint_error err = {0};
    assert_true(glint_study_distances(found, truth, surfaces, 8, &e, &err));
    assert_int_equal(e.of[0].rays, 7);
    assert_int_equal(e.of[MIRROR].rays, 4);
    assert_int_equal(e.of[MIRROR].invalid, 1);
    assert_near(e.of[MIRROR].right, 0.5, 0);
    assert_near(e.of[MIRROR].median, 1, 0); /* of 0, 0.04, 1, ∞ the upper middle one */
    assert_true(isinf(e.of[MIRROR].p95));
    assert_near(e.of[GLOSSY].right, 1.0 / 3, 1e-15);
    assert_int_equal(e.of[ROUGH].rays, 0);
}

static void flicker_is_change_that_the_truth_does_not_make(UNUSED void **state) {
    /* Pixels: a constant error; a change that the truth makes too; one that it does not; one that is masked; one without a truth. */
    float before[] = {5, 5, 5, 1, 1, 1, 2, 2, 2, 0, 0, 0, 9, 9, 9},
          after[] = {5, 5, 5, 4, 4, 4, 3, 2, 2, 8, 8, 8, 0, 0, 0};
    float was[] = {1, 1, 1, 1, 1, 1, 2, 2, 2, 0, 0, 0, 9, 9, 9}, is[] = {1, 1, 1, 4, 4, 4, 2, 2, 2, 0, 0, 0, 9, 9, 9};
    const struct glint_pixels found[2] = {{5, 1, 3, before}, {5, 1, 3, after}},
                              truth[2] = {{5, 1, 3, was}, {5, 1, 3, is}};
    const uint8_t mask[] = {1, 1, 1, 0, 1}, *const masks[2] = {mask, NULL};
    const float first[] = {0, 0, 0.25F, 0, INFINITY}, *const errors[2] = {first, NULL};
    struct glint_flicker f;
    struct glint_error err = {0};
    assert_true(glint_study_flicker(found, truth, errors, masks, &f, &err));
    assert_int_equal(f.pixels, 3); /* nine values */
    assert_near(f.picture, sqrt((3 * 9 + 1) / 9.0), 1e-15);
    assert_near(f.truth, sqrt(3 * 9 / 9.0), 1e-15);
    assert_near(f.beside, sqrt(1 / 9.0), 1e-15);
    assert_near(f.clean, sqrt((1 - 3 * 0.25) / 9.0), 1e-15); /* a quarter of 2 in each of three channels */
    assert_true(glint_study_flicker(found, NULL, NULL, masks, &f, &err));
    assert_int_equal(f.pixels, 4);
    assert_near(f.picture, sqrt((3 * 9 + 1 + 3 * 81) / 12.0), 1e-15);
    assert_true(isnan(f.beside) && isnan(f.truth) && isnan(f.clean));
    const struct glint_pixels other[2] = {{5, 1, 3, before}, {4, 1, 3, after}};
    assert_false(glint_study_flicker(other, NULL, NULL, NULL, &f, &err));
    assert_non_null(strstr(err.message, "expected images of 5 x 1"));
}

static void classes_meet_at_their_thresholds(UNUSED void **state) {
    const struct glint_effect *effect = glint_effect_find("reflection");
    assert_non_null(effect);
    assert_int_equal(glint_effect_class_count(effect), 3);
    assert_int_equal(glint_effect_class_of(effect, 0), MIRROR);
    assert_int_equal(glint_effect_class_of(effect, 0.1), MIRROR);
    assert_int_equal(glint_effect_class_of(effect, 0.1001), GLOSSY);
    assert_int_equal(glint_effect_class_of(effect, 0.5), GLOSSY);
    assert_int_equal(glint_effect_class_of(effect, 0.5001), ROUGH);
    assert_int_equal(glint_effect_class_of(effect, NAN), ROUGH);
    assert_string_equal(glint_effect_class_name(effect, GLINT_CLASS_FIRST), "mirror-like");
    assert_string_equal(glint_effect_class_name(effect, 0), "all");
}

/* Millions of equal differences: sums in double lose at most 6e6 · 2^-53 of their value, those in float a hundredth. */
static void a_full_picture_keeps_its_digits(UNUSED void **state) {
    enum { PIXELS = 1920 * 1080 };
    struct glint_pixels f = {1920, 1080, 4, malloc(4 * PIXELS * sizeof(float))},
                        t = {1920, 1080, 4, malloc(4 * PIXELS * sizeof(float))};
    uint8_t *surfaces = malloc(PIXELS);
    struct glint_image_errors e;
    struct glint_error err = {0};
    assert_true(f.values && t.values && surfaces);
    for (size_t i = 0; i < 4 * PIXELS; i++) f.values[i] = 0.3F, t.values[i] = 0.1F;
    for (size_t i = 0; i < PIXELS; i++) surfaces[i] = (uint8_t)(i % GLINT_CLASS_COUNT);
    assert_true(glint_study_image(&f, &t, 4, surfaces, NULL, &e, &err));
    const double apart = (double)0.3F - (double)0.1F;
    assert_int_equal(e.of[0].pixels, PIXELS - PIXELS / GLINT_CLASS_COUNT);
    for (int k = 0; k < GLINT_CLASS_COUNT; k++) {
        assert_near(e.of[k].mean, apart, 1e-9);
        assert_near(e.of[k].rmse, apart, 1e-9);
    }
    glint_pixels_finish(&f);
    glint_pixels_finish(&t);
    free(surfaces);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_are_those_of_a_sum_by_hand),
        cmocka_unit_test(what_is_no_number_is_counted_and_spoils_nothing),
        cmocka_unit_test(images_of_two_sizes_are_refused),
        cmocka_unit_test(the_truths_noise_is_taken_off),
        cmocka_unit_test(distances_know_the_sky),
        cmocka_unit_test(flicker_is_change_that_the_truth_does_not_make),
        cmocka_unit_test(classes_meet_at_their_thresholds),
        cmocka_unit_test(a_full_picture_keeps_its_digits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
