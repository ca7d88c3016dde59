/* Comparisons by class and channel, non-finite values, and intervals, compared with closed forms and simulated truth. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/metrics.h"
#include "uniform.h"
#include "unit.h"

static void assert_near(double found, double expected, double tolerance) {
    if (!(fabs(found - expected) <= tolerance)) fail_msg("%.17g is not %.17g ± %g", found, expected, tolerance);
}

static struct glint_metric_table compared(const struct glint_pixels *found, const struct glint_pixels *truth,
                                          const struct glint_metric_options *options) {
    struct glint_metric_table table;
    struct glint_error err = {0};
    if (!glint_metrics_compare(found, truth, options, &table, &err)) fail_msg("%s", err.message);
    return table;
}

static void each_set_of_classes_divides_all_pixels(UNUSED void **state) {
    float found[] = {1, 2, 3, 4}, truth[] = {0, 0, 0, 0};
    uint8_t side[] = {1, 2, 1, 2}, height[] = {1, 1, 0, 3};
    const struct glint_pixels f = {2, 2, 1, found}, t = {2, 2, 1, truth};
    const struct glint_classes sets[] = {{"side", {"left", "right"}, 2, side},
                                         {"height", {"top", "middle", "bottom"}, 3, height}};
    struct glint_metric_table table =
        compared(&f, &t, &(struct glint_metric_options){.classes = sets, .class_sets = 2});
    const struct {
        const char *set, *name;
        uint64_t pixels;
        double mean;
    } expected[] = {{"all", "all", 4, 2.5},    {"side", "left", 2, 2},       {"side", "right", 2, 3},
                    {"height", "top", 2, 1.5}, {"height", "middle", 0, NAN}, {"height", "bottom", 1, 4}};
    assert_int_equal(table.count, 6);
    for (size_t i = 0; i < 6; i++) {
        assert_string_equal(table.rows[i].set, expected[i].set);
        assert_string_equal(table.rows[i].name, expected[i].name);
        assert_int_equal(table.rows[i].pixels, expected[i].pixels);
        if (expected[i].pixels) assert_near(table.rows[i].of[GLINT_METRIC_MEAN].value, expected[i].mean, 0);
        else assert_true(isnan(table.rows[i].of[GLINT_METRIC_MEAN].value));
    }
    glint_metric_table_finish(&table);
    uint64_t cross[3 * 4];
    glint_classes_cross(&sets[0], &sets[1], 4, NULL, cross);
    assert_int_equal(cross[1 * 4 + 1], 1);
    assert_int_equal(cross[1 * 4 + 0], 1);
    assert_int_equal(cross[2 * 4 + 3], 1);
    assert_int_equal(cross[2 * 4 + 2], 0);
    glint_classes_cross(&sets[0], &sets[1], 4, (const uint8_t[]){0, 1, 0, 0}, cross);
    assert_int_equal(cross[2 * 4 + 1], 1);
    assert_int_equal(cross[1 * 4 + 1], 0);
}

static void channels_meet_by_their_names(UNUSED void **state) {
    float found[] = {1, 2, 3, 9}, truth[] = {3, 2, 1};
    const struct glint_pixels f = {1, 1, 4, found}, t = {1, 1, 3, truth};
    struct glint_metric_options o = {.found_channels = "B G R A", .truth_channels = "R G B"};
    struct glint_metric_table table = compared(&f, &t, &o);
    assert_near(table.rows[0].of[GLINT_METRIC_RMSE].value, 0, 0);
    assert_near(table.rows[0].truth_mean, 2, 0);
    glint_metric_table_finish(&table);
    o.found_channels = "X G Z A"; /* only G is common */
    table = compared(&f, &t, &o);
    assert_near(table.rows[0].truth_mean, 2, 0);
    glint_metric_table_finish(&table);
    struct glint_error err = {0};
    o.found_channels = "X Y Z";
    assert_false(glint_metrics_compare(&f, &t, &o, &table, &err));
    assert_non_null(strstr(err.message, "'X Y Z' and 'R G B'"));
}

static void invalid_pixels_are_counted_in_both_and_named(UNUSED void **state) {
    float found[12] = {0}, truth[12] = {0};
    const struct glint_pixels f = {4, 3, 1, found}, t = {4, 3, 1, truth};
    uint8_t mask[12] = {0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    struct glint_metric_options o = {.mask = mask, .metrics = GLINT_METRICS_ALL};
    struct glint_error err = {0};
    found[0] = NAN; /* excluded */
    struct glint_metric_table table = compared(&f, &t, &o);
    assert_true(glint_metrics_valid(&table, "x", &err));
    assert_int_equal(table.rows[0].pixels, 11);
    glint_metric_table_finish(&table);
    truth[7] = -INFINITY;
    found[10] = found[7] = NAN;
    table = compared(&f, &t, &o);
    assert_int_equal(table.invalid_found, 2);
    assert_int_equal(table.invalid_truth, 1);
    assert_int_equal(table.rows[0].invalid, 2);
    assert_int_equal(table.rows[0].pixels, 9);
    assert_false(glint_metrics_valid(&table, "run", &err));
    assert_non_null(strstr(err.message,
                           "run: NaN or infinite in 2 pixels, and in 1 of what it is compared with; the first is 3,1"));
    for (int k = 0; k < GLINT_METRIC_COUNT; k++)
        assert_false(table.rows[0].of[k].value > 1e-6 && isfinite(table.rows[0].of[k].value) &&
                     !glint_metric((size_t)k)->higher_is_better);
    glint_metric_table_finish(&table);
}

/* The displayed value of a grey radiance, by the formulas of docs/metrics.md. */
static double displayed(double x) {
    x *= 0.6;
    double y = fmin(1, (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14));
    return y <= 0.0031308 ? 12.92 * y : 1.055 * pow(y, 1 / 2.4) - 0.055;
}

static void flat_images_have_closed_forms(UNUSED void **state) {
    enum { SIZE = 13, PIXELS = SIZE * SIZE };
    float found[3 * PIXELS], truth[3 * PIXELS];
    const struct glint_pixels f = {SIZE, SIZE, 3, found}, t = {SIZE, SIZE, 3, truth};
    for (int i = 0; i < 3 * PIXELS; i++) {
        found[i] = 0.25F;
        truth[i] = 0.5F;
    }
    struct glint_metric_options o = {.metrics = GLINT_METRICS_ALL};
    struct glint_metric_table table = compared(&f, &t, &o);
    const struct glint_figure *of = table.rows[0].of;
    double a = displayed(0.25), b = displayed(0.5);
    assert_near(table.peak, 0.5, 0);
    assert_near(of[GLINT_METRIC_PSNR].value, 20 * log10(2), 1e-12);
    assert_near(of[GLINT_METRIC_RELATIVE_MSE].value, 0.0625 / 0.26, 1e-12);
    /* only the rounding of float remains in the variance: 1e-7 next to C2 of 9e-4 */
    assert_near(of[GLINT_METRIC_SSIM].value, (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 3e-4);
    glint_metric_table_finish(&table);
    o.exposure = 1;
    o.peak = 1;
    o.epsilon = 0.0625;
    table = compared(&f, &t, &o);
    of = table.rows[0].of;
    a = displayed(0.5), b = displayed(1);
    assert_near(of[GLINT_METRIC_PSNR].value, 20 * log10(4), 1e-12);
    assert_near(of[GLINT_METRIC_RELATIVE_MSE].value, 0.2, 1e-12);
    assert_near(of[GLINT_METRIC_SSIM].value, (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 3e-4);
    glint_metric_table_finish(&table);
    table = compared(&t, &t, &o);
    of = table.rows[0].of;
    assert_true(of[GLINT_METRIC_PSNR].value == INFINITY);
    assert_near(of[GLINT_METRIC_SSIM].value, 1, 1e-6);
    glint_metric_table_finish(&table);
    /* no window fits into ten pixels */
    const struct glint_pixels small = {10, 13, 3, truth};
    table = compared(&small, &small, &o);
    assert_true(isnan(table.rows[0].of[GLINT_METRIC_SSIM].value));
    glint_metric_table_finish(&table);
}

/* Errors are equal within patches, as those of wrong reflections are: intervals for independent pixels would be a quarter as wide as
   required, and contain the mean four times in ten. */
static void intervals_hold_the_mean_as_often_as_they_say(UNUSED void **state) {
    enum { SIZE = 192, PATCH = 4, IMAGES = 300 };
    static float found[SIZE * SIZE], truth[SIZE * SIZE];
    const struct glint_pixels f = {SIZE, SIZE, 1, found}, t = {SIZE, SIZE, 1, truth};
    const struct glint_metric_options o = {.resamples = 200, .seed = 7, .metrics = 1u << GLINT_METRIC_MEAN};
    uint64_t random = 3;
    int held = 0;
    for (int n = 0; n < IMAGES; n++) {
        for (int y = 0; y < SIZE; y += PATCH)
            for (int x = 0; x < SIZE; x += PATCH) {
                float error = (float)(uniform(&random) * uniform(&random)); /* skewed; its mean is 1/4 */
                for (int k = 0; k < PATCH * PATCH; k++) found[(y + k / PATCH) * SIZE + x + k % PATCH] = error;
            }
        struct glint_metric_table table = compared(&f, &t, &o);
        const struct glint_figure *mean = &table.rows[0].of[GLINT_METRIC_MEAN];
        assert_true(mean->low < mean->value && mean->value < mean->high);
        held += mean->low <= 0.25 && 0.25 <= mean->high;
        glint_metric_table_finish(&table);
    }
    print_message("# 95 %% intervals held the mean in %.1f %%\n", 100.0 * held / IMAGES);
    /* Tiles of 13 pixels cut patches and see 0.83 of the variance: 92.5 %, with a deviation of 1.5 % for 300 samples. */
    assert_in_range(held, IMAGES * 88 / 100, IMAGES * 97 / 100);
}

static void the_same_seed_gives_the_same_interval(UNUSED void **state) {
    enum { SIZE = 64 };
    static float found[SIZE * SIZE], truth[SIZE * SIZE];
    const struct glint_pixels f = {SIZE, SIZE, 1, found}, t = {SIZE, SIZE, 1, truth};
    uint64_t random = 5;
    for (int i = 0; i < SIZE * SIZE; i++) found[i] = (float)uniform(&random);
    struct glint_metric_options o = {.resamples = GLINT_RESAMPLES, .seed = 1};
    struct glint_metric_table a = compared(&f, &t, &o), b = compared(&f, &t, &o);
    assert_memory_equal(&a.rows[0].of[GLINT_METRIC_RMSE], &b.rows[0].of[GLINT_METRIC_RMSE],
                        sizeof(struct glint_figure));
    o.seed = 2;
    glint_metric_table_finish(&b);
    b = compared(&f, &t, &o);
    assert_true(a.rows[0].of[GLINT_METRIC_RMSE].low != b.rows[0].of[GLINT_METRIC_RMSE].low);
    glint_metric_table_finish(&a);
    glint_metric_table_finish(&b);
}

/* Two images have equal errors except for a difference of 0.02: both intervals overlap, while that of the difference is narrow and
   contains it. */
static void a_difference_is_surer_than_its_parts(UNUSED void **state) {
    enum { SIZE = 128 };
    static float first[SIZE * SIZE], second[SIZE * SIZE], truth[SIZE * SIZE];
    const struct glint_pixels f = {SIZE, SIZE, 1, first}, s = {SIZE, SIZE, 1, second}, t = {SIZE, SIZE, 1, truth};
    struct glint_metric_options o = {.resamples = GLINT_RESAMPLES, .seed = 1, .keep_resampled = true};
    uint64_t random = 9;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            const int i = y * SIZE + x;
            first[i] = x % 4 || y % 4 ? first[(y / 4 * 4) * SIZE + x / 4 * 4] : (float)uniform(&random);
            second[i] = first[i] + 0.02F + 0.01F * (float)(uniform(&random) - 0.5);
        }
    struct glint_metric_table a = compared(&f, &t, &o), b = compared(&s, &t, &o);
    struct glint_figure difference;
    struct glint_error err = {0};
    const struct glint_figure *p = &a.rows[0].of[GLINT_METRIC_MEAN], *q = &b.rows[0].of[GLINT_METRIC_MEAN];
    assert_true(p->high > q->low);
    assert_true(glint_metrics_difference(&a, &b, 0, GLINT_METRIC_MEAN, &difference, &err));
    assert_true(difference.low <= 0.02 && 0.02 <= difference.high);
    assert_near(difference.value, q->value - p->value, 0);
    assert_true(difference.high - difference.low < 0.1 * (p->high - p->low));
    assert_true(glint_metrics_difference(&a, &b, 0, GLINT_METRIC_RMSE, &difference, &err));
    assert_true(difference.low > 0);
    glint_metric_table_finish(&b);
    o.seed = 2;
    b = compared(&s, &t, &o);
    assert_false(glint_metrics_difference(&a, &b, 0, GLINT_METRIC_MEAN, &difference, &err));
    glint_metric_table_finish(&a);
    glint_metric_table_finish(&b);
}

/* The interval of a mean is that of the normal distribution; values that only repeat each other in their clusters do not narrow it. */
static void intervals_of_means_are_those_of_clusters(UNUSED void **state) {
    enum { CLUSTERS = 200, REPEATED = 4, VALUES = CLUSTERS * REPEATED };
    static double values[VALUES];
    static size_t clusters[VALUES];
    double sum = 0, squares = 0;
    uint64_t random = 5;
    for (size_t i = 0; i < VALUES; i++) {
        clusters[i] = i % CLUSTERS;
        values[i] = i < CLUSTERS ? uniform(&random) : values[i % CLUSTERS];
        sum += values[i];
        squares += values[i] * values[i];
    }
    const double mean = sum / VALUES, half = 1.96 * sqrt((squares / VALUES - mean * mean) / CLUSTERS);
    struct glint_clustered c = {values, clusters, VALUES, CLUSTERS, 2000, 1};
    struct glint_figure found, once;
    struct glint_error err = {0};
    assert_true(glint_clustered_mean(&c, &found, &err));
    assert_near(found.value, mean, 1e-12);
    assert_near(found.high - found.low, 2 * half, 0.2 * half);
    assert_true(found.low < mean && mean < found.high);
    c.count = CLUSTERS;
    assert_true(glint_clustered_mean(&c, &once, &err));
    assert_near(once.low, found.low, 1e-12);
    assert_near(once.high, found.high, 1e-12);
    for (size_t i = 1; i < CLUSTERS; i++) values[i] = NAN; /* one is known */
    assert_true(glint_clustered_mean(&c, &found, &err));
    assert_true(found.value == values[0] && isnan(found.low) && isnan(found.high));
    values[0] = NAN;
    assert_true(glint_clustered_mean(&c, &found, &err));
    assert_true(isnan(found.value));
}

/* Excluded pixels are black for metrics with neighbourhoods, whatever their values are. */
static void what_is_left_out_leaks_into_no_neighbour(UNUSED void **state) {
    enum { SIZE = 24, PIXELS = SIZE * SIZE };
    static float found[3 * PIXELS], truth[3 * PIXELS], black_found[3 * PIXELS], black_truth[3 * PIXELS];
    static uint8_t mask[PIXELS];
    uint64_t random = 11;
    for (int i = 0; i < PIXELS; i++) {
        mask[i] = i % SIZE >= 9;
        for (int k = 0; k < 3; k++) {
            black_found[3 * i + k] = mask[i] ? (float)uniform(&random) : 0;
            black_truth[3 * i + k] = mask[i] ? (float)uniform(&random) : 0;
            found[3 * i + k] = mask[i] ? black_found[3 * i + k] : NAN;
            truth[3 * i + k] = mask[i] ? black_truth[3 * i + k] : 1e9F;
        }
    }
    const struct glint_pixels f = {SIZE, SIZE, 3, found}, t = {SIZE, SIZE, 3, truth};
    const struct glint_pixels bf = {SIZE, SIZE, 3, black_found}, bt = {SIZE, SIZE, 3, black_truth};
    const struct glint_classes kept = {"kept", {"kept"}, 1, mask};
    const struct glint_metric_options o = {.metrics = GLINT_METRICS_ALL, .mask = mask, .ppd = 30};
    struct glint_metric_options all = {.metrics = GLINT_METRICS_ALL, .ppd = 30, .classes = &kept, .class_sets = 1};
    struct glint_metric_table a = compared(&f, &t, &o);
    all.start_exposure = a.start_exposure;
    all.stop_exposure = a.stop_exposure;
    struct glint_metric_table b = compared(&bf, &bt, &all);
    assert_int_equal(a.rows[0].pixels, SIZE * (SIZE - 9));
    for (int k = 0; k < GLINT_METRIC_COUNT; k++) assert_near(a.rows[0].of[k].value, b.rows[1].of[k].value, 1e-12);
    for (int i = 0; i < PIXELS; i++)
        if (!mask[i]) assert_true(a.flip[i] == 0 && a.hdr_flip[i] == 0);
    glint_metric_table_finish(&a);
    glint_metric_table_finish(&b);
}

static void metrics_have_names(UNUSED void **state) {
    uint32_t chosen = 0;
    struct glint_error err = {0};
    assert_true(glint_metrics_parse("rmse,hdr_flip", &chosen, &err));
    assert_int_equal(chosen, 1u << GLINT_METRIC_RMSE | 1u << GLINT_METRIC_HDR_FLIP);
    assert_true(glint_metrics_parse("all", &chosen, &err));
    assert_int_equal(chosen, GLINT_METRICS_ALL);
    assert_false(glint_metrics_parse("rmse,", &chosen, &err));
    assert_false(glint_metrics_parse("rms", &chosen, &err));
    assert_non_null(strstr(err.message, "'rms'"));
    assert_non_null(strstr(err.message, "relative_mse"));
    assert_null(glint_metric(GLINT_METRIC_COUNT));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_set_of_classes_divides_all_pixels),
        cmocka_unit_test(channels_meet_by_their_names),
        cmocka_unit_test(invalid_pixels_are_counted_in_both_and_named),
        cmocka_unit_test(flat_images_have_closed_forms),
        cmocka_unit_test(intervals_hold_the_mean_as_often_as_they_say),
        cmocka_unit_test(the_same_seed_gives_the_same_interval),
        cmocka_unit_test(a_difference_is_surer_than_its_parts),
        cmocka_unit_test(intervals_of_means_are_those_of_clusters),
        cmocka_unit_test(what_is_left_out_leaks_into_no_neighbour),
        cmocka_unit_test(metrics_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
