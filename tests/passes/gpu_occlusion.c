/* ao_trace, ao_blur and ao_apply against closed forms, in frames that show all that occludes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "occlusion.h"
#include "unit.h"

static const double pi = 3.14159265358979323846;
enum { WIDE = 160, HIGH = 120, WORDS = 8 };

/* ---- closed forms ---- */

/* A wall of endless height at a distance: the directions that meet it within the radius are, projected onto the unit disc, a segment of it. */
static double beside_wall(double distance, double radius) {
    const double c = distance / radius;
    return c >= 1 ? 1 : 1 - (acos(c) - c * sqrt(1 - c * c)) / pi;
}
/* A wall of a height at a distance, endlessly long: half of the disc less half of an ellipse. */
static double beside_low_wall(double distance, double height) {
    return 1 - 0.5 * (1 - distance / hypot(distance, height));
}
/* A plane opposite: the directions within the cone in which it is nearer than the radius. */
static double below_plate(double gap, double radius) {
    return gap >= radius ? 1 : pow(gap / radius, 2);
}
/* A sphere that touches the plane, which all of it is above: its solid angle's share, by the cosine to its centre. */
static double beside_sphere(double away, double radius) {
    return 1 - pow(radius, 3) / pow(hypot(away, radius), 3);
}

/* Quadrature of the same scenes; 400² cells leave 1e-3 of a border's length. */
static void closed_forms_agree_with_quadrature(UNUSED void **state) {
    static const double up[3] = {0, 1, 0};
    const struct shapes wall = {.floor_y = -1, .wall_z = -5, .wall_top = INFINITY};
    const struct shapes low = {.floor_y = -1, .wall_z = -5, .wall_top = -0.5};
    const struct shapes plates = {.floor_y = -1, .ceiling_y = 1};
    const struct shapes ball = {.floor_y = -1, .sphere = {0, -0.5, -5, 0.5}};
    for (double d = 0.05; d < 1.2; d += 0.23) {
        const double at[3] = {0, -1, -5 + d}, at_ball[3] = {0.6 * d, -1, -5 + 0.8 * d};
        assert_true(fabs(shapes_visibility(&wall, at, up, 1, 400) - beside_wall(d, 1)) < 1e-3);
        assert_true(fabs(shapes_visibility(&low, at, up, 1e9, 400) - beside_low_wall(d, 0.5)) < 1e-3);
        assert_true(fabs(shapes_visibility(&plates, at, up, 2 + d, 400) - below_plate(2, 2 + d)) < 1e-3);
        assert_true(fabs(shapes_visibility(&ball, at_ball, up, 1e9, 400) - beside_sphere(d, 0.5)) < 1e-3);
    }
    assert_true(fabs(beside_wall(1e-9, 1) - 0.5) < 1e-6);
}

/* ---- every variant against them ---- */

/* The visibility that is expected at a point of a scene; NaN where the frame does not show all that occludes. */
typedef double (*expected_at)(const double position[3], const double normal[3]);

struct errors {
    double mean, most, bias;
    int count;
};

static struct errors errors_of(struct gpu *gpu, const struct plain *plain, const char *const *words,
                               expected_at expected) {
    struct errors errors = {0};
    uint32_t width, height;
    occlusion_arrange(gpu, words);
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "occlusion", &width, &height);
    for (uint32_t i = 0; i < width * height; i++) {
        double position[3], normal[3];
        if (!shapes_pixel(plain->user, plain, i % width, i / width, position, normal)) {
            assert_true(found[i] == 1);
            continue;
        }
        const double right = expected(position, normal), error = (double)found[i] - right;
        if (isnan(right)) continue;
        assert_true(isfinite(error));
        errors.mean += fabs(error);
        errors.bias += error;
        errors.most = fmax(errors.most, fabs(error));
        errors.count++;
    }
    free(found);
    errors.mean /= errors.count;
    errors.bias /= errors.count;
    return errors;
}

#define FINE "downsample=none", "ao_apply=bilinear"
/* Enough samples that what is left is the variant's own error. */
#define FINE_HORIZON "ao_trace=horizon", "ao_trace.slices=16", "ao_trace.steps=32", "ao_trace.thickness=1e6"
#define FINE_HEMISPHERE "ao_trace=hemisphere", "ao_trace.samples=256"
#define FINE_DDA "ao_trace=dda", "ao_trace.directions=16"

struct trial {
    const char *words[WORDS + 4];
    double mean, most; /* bounds */
    const char *reason;
};

static void try_all(struct gpu *gpu, const struct plain *plain, const struct trial *trials, size_t count,
                    expected_at expected) {
    occlusion_load(gpu, plain);
    for (size_t i = 0; i < count; i++) {
        const struct errors e = errors_of(gpu, plain, trials[i].words, expected);
        print_message("# %s %s: mean error %.4f, largest %.4f, bias %+.4f of %d pixels\n", trials[i].words[2],
                      trials[i].words[3] ? trials[i].words[3] : "", e.mean, e.most, e.bias, e.count);
        assert_true(e.count > 60);
        if (!(e.mean <= trials[i].mean && e.most <= trials[i].most))
            fail_msg("%s: expected at most %g and %g: %s", trials[i].words[2], trials[i].mean, trials[i].most,
                     trials[i].reason);
    }
}
#define TRY(gpu, plain, trials, expected) try_all(gpu, plain, trials, sizeof(trials) / sizeof *(trials), expected)

static const struct shapes corner = {.floor_y = -1, .wall_z = -5, .wall_top = INFINITY};
/* On either side; not where the radius of 1 m reaches beyond the picture, and not within the texel at the edge. */
static double at_corner(const double position[3], const double normal[3]) {
    const double away = normal[1] > 0.5 ? position[2] + 5 : position[1] + 1;
    return fabs(position[0]) < 1.2 && position[1] < 1 && position[2] < -3 && away > 0.05 ? beside_wall(away, 1) : NAN;
}
static void a_corner_hides_half_of_the_directions(void **state) {
    static const struct trial trials[] = {
        {{FINE, FINE_HORIZON}, 0.01, 0.06, "32 steps to the radius: what lies between two is missed"},
        {{FINE, FINE_DDA},
         0.02,
         0.2,
         "16 directions: a deviation of 0.13 for a visibility of a half, less because they are spread"},
        {{FINE, FINE_HEMISPHERE, "ao_trace.spread=0"},
         0.04,
         0.3,
         "points on the sphere, not rays: what a ray passes through is missed"}};
    const struct plain plain = occlusion_frame(&corner, 60);
    TRY(*state, &plain, trials, at_corner);
}

static const struct shapes low_wall = {.floor_y = -1, .wall_z = -5, .wall_top = -0.5};
/* In the middle of the picture, near the wall: what of the endless wall lies beyond the picture, 3.3 m away, hides less than 0.01. */
static double at_low_wall(const double position[3], const double normal[3]) {
    const double away = position[2] + 5;
    return normal[1] > 0.5 && fabs(position[0]) < 0.5 && away > 0.05 && away < 0.6 ? beside_low_wall(away, 0.5) : NAN;
}
static void a_wall_hides_by_its_height(void **state) {
    static const struct trial trials[] = {
        {{FINE, FINE_HORIZON, "ao_trace.radius_m=4", "ao_trace.growth=3"},
         0.03,
         0.08,
         "32 steps to the radius of 4 m, and what lies beyond the picture"},
        {{FINE, FINE_DDA, "ao_trace.radius_m=4"}, 0.04, 0.2, "16 directions, and what lies beyond the picture"}};
    const struct plain plain = occlusion_frame(&low_wall, 60);
    TRY(*state, &plain, trials, at_low_wall);
}

static const struct shapes plates = {.floor_y = -1, .ceiling_y = 1};
static double at_plates(const double position[3], UNUSED const double normal[3]) {
    return fabs(position[0]) < 0.5 && position[2] < -5 && position[2] > -7 ? below_plate(2, 3) : NAN;
}
/* Everything between the lowest and the highest point of a slice is not hidden: horizons alone say so. */
static void a_plate_opposite_leaves_the_horizon_open(void **state) {
    static const struct trial trials[] = {{{FINE, FINE_DDA, "ao_trace.radius_m=3"}, 0.03, 0.15, "16 directions"},
                                          {{FINE, "ao_trace=horizon", "ao_trace.slices=16", "ao_trace.steps=64",
                                            "ao_trace.growth=1", "ao_trace.thickness=0.3", "ao_trace.radius_m=3"},
                                           0.04,
                                           0.1,
                                           "sectors of a 32nd of a side, and steps between them"}};
    const struct plain plain = occlusion_frame(&plates, 90);
    TRY(*state, &plain, trials, at_plates);
    const char *const solid[] = {FINE,
                                 "ao_trace=horizon",
                                 "ao_trace.slices=16",
                                 "ao_trace.steps=32",
                                 "ao_trace.behind=solid",
                                 "ao_trace.radius_m=3",
                                 NULL};
    const struct errors e = errors_of(*state, &plain, solid, at_plates);
    print_message("# solid: mean error %.4f\n", e.mean);
    assert_true(e.bias < -0.08);
}

static const struct shapes ball = {.floor_y = -1, .sphere = {0, -0.5, -5, 0.5}};
/* On the floor on this side of the ball. */
static double at_ball(const double position[3], const double normal[3]) {
    const double away = hypot(position[0], position[2] + 5);
    return normal[1] > 0.999 && position[1] < -0.999 && position[2] > -4.9 && away > 0.1 && away < 1.5
               ? beside_sphere(away, 0.5)
               : NAN;
}
static void a_ball_hides_the_floor_that_it_lies_on(void **state) {
    static const struct trial trials[] = {
        {{FINE, FINE_HORIZON, "ao_trace.radius_m=3", "ao_trace.growth=1", "ao_trace.thickness=0.1"},
         0.05,
         0.15,
         "objects are 0.3 m thick, which the ball is not everywhere"},
        {{FINE, FINE_DDA, "ao_trace.directions=32", "ao_trace.radius_m=3", "ao_trace.inside=false"},
         0.05,
         0.3,
         "32 directions, and hits on the side of the ball that cannot be seen"}};
    const struct plain plain = occlusion_frame(&ball, 40);
    TRY(*state, &plain, trials, at_ball);
}

/* ---- nothing occludes itself ---- */

/* A plain seen at every angle up to the horizon, from near and far away, in half floats, at both resolutions. */
static void an_open_plain_is_fully_visible(void **state) {
    static const char *const variants[] = {"ao_trace=horizon", "ao_trace=hemisphere", "ao_trace=dda"};
    struct gpu *gpu = *state;
    for (int far = 0; far < 2; far++)
        for (int v = 0; v < 3; v++)
            for (int half = 0; half < 2; half++) {
                const struct shapes plain_floor = {.floor_y = far ? -100 : -1};
                const struct plain plain = occlusion_frame(&plain_floor, 60);
                const char *const words[] = {half ? "downsample=pick" : "downsample=none",
                                             variants[v],
                                             "ao_blur=separable",
                                             "ao_apply=planes",
                                             "ao_trace.radius_in=screen",
                                             v == 2 ? "ao_trace.directions=8" : NULL,
                                             NULL};
                uint32_t width, height;
                int hidden = 0;
                double most = 0;
                occlusion_load(gpu, &plain);
                occlusion_arrange(gpu, words);
                gpu->float_precision = false;
                gpu_run(gpu);
                float *found = gpu_floats(gpu, "occlusion", &width, &height);
                for (uint32_t i = 0; i < width * height; i++) {
                    hidden += found[i] != 1;
                    most = fmax(most, 1 - (double)found[i]);
                }
                print_message("# %s, %s, %d m: %d pixels hidden, at most %g\n", variants[v], half ? "half" : "full",
                              far ? 100 : 1, hidden, most);
                if (v < 2) assert_int_equal(hidden, 0);
                else assert_true(most < 1e-3);
                free(found);
            }
}

/* A picture of odd size, whose last texels lie on its border. Of a wall nothing hides itself where it has its own vertex normals, here in the last
   row and column alone, and the leaning shading normals elsewhere see the wall. */
static void lean(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    shapes_spoil(plain, values);
    for (uint32_t i = 0; i < pixels; i++)
        values[PLAIN_NORMAL_X * pixels + i] = -0.6F, values[PLAIN_NORMAL_Z * pixels + i] = 0.8F;
}
static void at_border(const struct plain *plain, uint32_t x, uint32_t y, float out[3]) {
    out[0] = out[1] = 0;
    out[2] = x + 1 == plain->width || y + 1 == plain->height;
}
static void vertex_normals_count_at_the_border(void **state) {
    static const struct shapes wall = {.wall_z = -5, .wall_top = INFINITY};
    static const char *const words[] = {"downsample=bilinear", "ao_trace=horizon", "ao_trace.normals=vertex", NULL};
    struct gpu *gpu = *state;
    struct plain plain = occlusion_frame(&wall, 60);
    uint32_t width, height;
    plain.width = 33, plain.height = 25;
    plain.spoil = lean;
    plain.vertex_normal = at_border;
    occlusion_load(gpu, &plain);
    occlusion_arrange(gpu, words);
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "occlusion_half", &width, &height);
    assert_true(width == 17 && height == 13);
    for (uint32_t i = 0; i < width * height; i++) {
        const bool last = i % width + 1 == width || i / width + 1 == height;
        if (last || i % width > 3) assert_true((found[i] == 1) == last); /* nothing is seen left of the picture */
    }
    free(found);
}

/* ---- the picture's border ---- */

/* Left and right are alike: how far a slice reaches upward does not depend on which border is near. */
static void both_borders_are_alike(void **state) {
    static const char *const words[] = {FINE, FINE_HORIZON, NULL};
    struct gpu *gpu = *state;
    const struct plain plain = occlusion_frame(&corner, 60);
    double sum[2] = {0};
    int count = 0;
    occlusion_load(gpu, &plain);
    occlusion_arrange(gpu, words);
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "occlusion", NULL, NULL);
    for (uint32_t y = 0; y < HIGH; y++)
        for (uint32_t x = 0; x < 3; x++) {
            double at[3], normal[3];
            shapes_pixel(&corner, &plain, x, y, at, normal);
            if (normal[1] < 0.5 || at[2] + 5 > 0.5) continue;
            sum[0] += (double)found[y * WIDE + x], sum[1] += (double)found[y * WIDE + WIDE - 1 - x];
            count++;
        }
    free(found);
    print_message("# %d pixels: %.4f at the left, %.4f at the right\n", count, sum[0] / count, sum[1] / count);
    assert_true(count > 3 && fabs(sum[0] - sum[1]) < 0.02 * count && sum[1] < 0.9 * count);
}

/* ---- noise ---- */

/* The mean over many frames of one slice of two steps is that of many slices of two steps. */
static void noise_is_mean_free(void **state) {
    static const char *const patterns[] = {"ao_trace.pattern=white", "ao_trace.pattern=grid", "ao_trace.pattern=blue"};
    struct gpu *gpu = *state;
    const struct plain plain = occlusion_frame(&corner, 60);
    occlusion_load(gpu, &plain);
    for (int p = 0; p < 3; p++) {
        float *mean[2];
        for (int many = 0; many < 2; many++) {
            const char *const words[] = {"downsample=pick",
                                         "ao_trace=horizon",
                                         patterns[many ? 0 : p],
                                         many ? "ao_trace.slices=8" : "ao_trace.slices=1",
                                         "ao_trace.steps=4",
                                         many ? "pipeline.rays=16" : "pipeline.rays=64",
                                         NULL};
            occlusion_arrange(gpu, words);
            gpu_run(gpu);
            mean[many] = gpu_floats(gpu, "occlusion_half", NULL, NULL);
        }
        double bias = 0, square = 0;
        const int texels = WIDE * HIGH / 4;
        for (int i = 0; i < texels; i++) {
            const double d = (double)mean[0][i] - (double)mean[1][i];
            bias += d / texels;
            square += d * d / texels;
        }
        print_message("# %s: bias %+.5f, RMS %.5f\n", patterns[p], bias, sqrt(square));
        assert_true(fabs(bias) < 1e-3 && square < 0.02 * 0.02);
        free(mean[0]), free(mean[1]);
    }
}

/* Texels of the floor with numbers of their own differ from the mean each on its own; with one number for all they differ alike. */
static void every_texel_has_its_own_numbers(void **state) {
    static const char *const patterns[] = {"ao_trace.pattern=white", "ao_trace.pattern=grid", "ao_trace.pattern=blue"};
    struct gpu *gpu = *state;
    const struct plain plain = occlusion_frame(&corner, 60);
    occlusion_load(gpu, &plain);
    for (int p = 0; p < 3; p++) {
        const char *const words[] = {"downsample=none",   "ao_trace=horizon", patterns[p],
                                     "ao_trace.slices=1", "ao_trace.steps=4", NULL};
        occlusion_arrange(gpu, words);
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "occlusion_half", NULL, NULL);
        double across = 0;
        for (int i = WIDE * HIGH * 3 / 5; i < WIDE * HIGH - 1; i++)
            across += fabs((double)found[i + 1] - (double)found[i]);
        across /= WIDE * HIGH * 2 / 5;
        print_message("# %s: neighbours differ by %.5f\n", patterns[p], across);
        assert_true(across > 0.01);
        free(found);
    }
}

/* ---- what is not a surface ---- */

static void invalid_pixels_are_visible_and_spoil_no_others(void **state) {
    static const char *const variants[] = {"ao_trace=horizon", "ao_trace=hemisphere", "ao_trace=dda"};
    struct gpu *gpu = *state;
    struct plain plain = occlusion_frame(&corner, 60);
    plain.spoil = shapes_spoil_some;
    occlusion_load(gpu, &plain);
    for (int v = 0; v < 3; v++)
        for (int apply = 0; apply < 2; apply++) {
            const char *const words[] = {"downsample=pick",
                                         variants[v],
                                         "ao_blur=separable",
                                         apply ? "ao_apply=planes" : "ao_apply=bilinear",
                                         v == 2 ? "ao_trace.directions=8" : NULL,
                                         NULL};
            occlusion_arrange(gpu, words);
            gpu_run(gpu);
            float *found = gpu_floats(gpu, "occlusion", NULL, NULL);
            int occluded = 0;
            for (uint32_t i = 0; i < WIDE * HIGH; i++) {
                assert_true(found[i] >= 0 && found[i] <= 1);
                if (i % 7 == 0 || i % 11 == 0 || i % 13 == 0 || i % 17 == 0) assert_true(found[i] == 1);
                occluded += found[i] < 0.9F;
            }
            print_message("# %s: %d pixels occluded\n", variants[v], occluded);
            assert_true(occluded > 500);
            free(found);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms_agree_with_quadrature),
        cmocka_unit_test(a_corner_hides_half_of_the_directions),
        cmocka_unit_test(a_wall_hides_by_its_height),
        cmocka_unit_test(a_plate_opposite_leaves_the_horizon_open),
        cmocka_unit_test(a_ball_hides_the_floor_that_it_lies_on),
        cmocka_unit_test(an_open_plain_is_fully_visible),
        cmocka_unit_test(vertex_normals_count_at_the_border),
        cmocka_unit_test(both_borders_are_alike),
        cmocka_unit_test(noise_is_mean_free),
        cmocka_unit_test(every_texel_has_its_own_numbers),
        cmocka_unit_test(invalid_pixels_are_visible_and_spoil_no_others),
    };
    return cmocka_run_group_tests_name("gpu_occlusion", tests, gpu_set_up, gpu_tear_down);
}
