/* sss_mask and sss_blur against the integral of the profile of skin. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "occlusion.h"
#include "plain_capture.h"
#include "unit.h"

/* The wall at 5 m, of which the picture shows 40 × 30 mm: a pixel is 0.25 mm wide. */
enum { WIDE = 160, HIGH = 120, MIDDLE = WIDE / 2 };
static const double mm_per_px = 0.25;

static void light(float *values, uint32_t pixel, float r, float g, float b) {
    values[PLAIN_LIT_R * WIDE * HIGH + pixel] = r;
    values[PLAIN_LIT_G * WIDE * HIGH + pixel] = g;
    values[PLAIN_LIT_B * WIDE * HIGH + pixel] = b;
}
static void lit_right(UNUSED const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < WIDE * HIGH; i++)
        light(values, i, i % WIDE >= MIDDLE, 2 * (i % WIDE >= MIDDLE), 3 * (i % WIDE >= MIDDLE));
}
static void lit_below(UNUSED const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < WIDE * HIGH; i++)
        light(values, i, i / WIDE >= HIGH / 2, 2 * (i / WIDE >= HIGH / 2), 3 * (i / WIDE >= HIGH / 2));
}
static void lit_in_the_middle(UNUSED const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < WIDE * HIGH; i++) light(values, i, 0, 0, 0);
    light(values, HIGH / 2 * WIDE + MIDDLE, 1000, 2000, 3000);
}
/* The right half lies a decimetre behind the left one. */
static void lit_behind(const struct plain *plain, float *values) {
    lit_right(plain, values);
    for (uint32_t i = 0; i < WIDE * HIGH; i++)
        if (i % WIDE >= MIDDLE) values[PLAIN_DEPTH * WIDE * HIGH + i] += 0.1F;
}

/* Stripes of 2 mm. */
static float stripe(uint32_t pixel) {
    return pixel / 8 % 2 ? 1.0F : 0.0F;
}
static void striped(UNUSED const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < WIDE * HIGH; i++) light(values, i, stripe(i), 2 * stripe(i), 3 * stripe(i));
}

static float strength[WIDE * HIGH];
static struct glint_channel mask_channel = {.name = "strength", .type = GLINT_F32, .data = strength};
static const struct glint_part mask_part = {
    .name = "skin", .width = WIDE, .height = HIGH, .channels = &mask_channel, .channel_count = 1};

/* The mask and the curvature. */
static float bent[WIDE * HIGH];
static const struct glint_channel curvature_channel = {.name = "curvature", .type = GLINT_F32, .data = bent};
static const struct glint_part both_parts[] = {
    {.name = "skin", .width = WIDE, .height = HIGH, .channels = &mask_channel, .channel_count = 1},
    {.name = "curvature", .width = WIDE, .height = HIGH, .channels = &curvature_channel, .channel_count = 1}};

static struct plain face(void (*spoil)(const struct plain *, float *), bool mask) {
    for (int i = 0; i < WIDE * HIGH; i++) strength[i] = 1;
    return (struct plain){.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.5F,
                          .fov_y_degrees = 2 * atan(HIGH / 2 * mm_per_px / 5000) * 180 / M_PI,
                          .spoil = spoil,
                          .part = mask ? &mask_part : NULL};
}

static struct plain curved(float per_m) {
    struct plain plain = face(lit_right, true);
    for (int i = 0; i < WIDE * HIGH; i++) bent[i] = per_m;
    plain.part = both_parts;
    plain.part_count = 2;
    return plain;
}

static float *run(struct gpu *gpu, const struct plain *plain, const char *reach, const char *more) {
    const char *const words[] = {"sss_mask=classes", "sss_blur=separable", reach, more, NULL};
    occlusion_load(gpu, plain);
    occlusion_arrange(gpu, words);
    gpu_run(gpu);
    return gpu_floats(gpu, "lit_scattered", NULL, NULL);
}

/* d'Eon, Luebke and Enderton 2007: variances in mm², shares of red, green and blue. */
static const double variances[] = {0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41},
                    shares[3][6] = {{0.233, 0.1, 0.118, 0.113, 0.358, 0.078},
                                    {0.455, 0.336, 0.198, 0.007, 0.004, 0},
                                    {0.649, 0.344, 0, 0.007, 0, 0}};
/* The light at a place beside a straight edge, in mm on its lit side: the profile's Gaussians integrated over a half-plane. */
static double beside_an_edge(int color, double mm) {
    double sum = 0;
    for (int i = 0; i < 6; i++) sum += shares[color][i] * 0.5 * (1 + erf(mm / sqrt(2 * variances[i])));
    return sum;
}

/* A sample stands for the distances around it. Which side of the edge it lies on is wrong for at most the sample over the edge: its share of the
   light, and half a pixel of rounding at each side, bound the error. Samples of a reach of 32 are at most 0.5 mm apart within 8.2 mm. */
static void check_edge(const float *found, bool down, double wide) {
    double worst[3] = {0};
    for (int i = 0; i < WIDE * HIGH; i++) {
        const int at = down ? i / WIDE : i % WIDE, length = down ? HIGH : WIDE;
        const double mm = (at + 0.5 - length / 2) * mm_per_px;
        if (i % WIDE < 36 || i % WIDE >= WIDE - 36 || i / WIDE < 36 || i / WIDE >= HIGH - 36)
            continue; /* the widest Gaussian ends inside */
        for (int c = 0; c < 3; c++) {
            const double right = (c + 1) * beside_an_edge(c, mm / wide),
                         step = 0.5 * 0.25 + 0.5 * wide * fmin(0.5, 0.07 + 0.25 * sqrt(fabs(mm) / wide / 8.2));
            const double more = beside_an_edge(c, (mm + step) / wide), less = beside_an_edge(c, (mm - step) / wide);
            const double bound = (c + 1) * (more - less) / 2 + 1e-4;
            const double off = fabs((double)found[4 * i + c] - right);
            if (off > bound)
                fail_msg("colour %d, %g mm: %g, expected %g within %g", c, mm, (double)found[4 * i + c], right, bound);
            worst[c] = fmax(worst[c], off / (c + 1));
        }
    }
    print_message("# width %g: worst difference: red %.4f, green %.4f, blue %.4f\n", wide, worst[0], worst[1],
                  worst[2]);
}
static void a_straight_edge_is_the_integral_of_the_profile(void **state) {
    struct gpu *gpu = *state;
    for (int down = 0; down < 2; down++) {
        const struct plain plain = face(down ? lit_below : lit_right, true);
        float *found = run(gpu, &plain, "sss_blur.reach=32", NULL);
        check_edge(found, down, 1);
        free(found);
    }
}

/* Half the width where it is flat, all of it from a radius of 10 mm on, and halfway between at one of 20 mm: the profile at that width. */
static void curvature_widens_the_profile(void **state) {
    static const float per_m[] = {0, 50, 100, 4000, NAN};
    static const double wide[] = {0.5, 0.75, 1, 1, 0.5};
    static const char *const off[] = {"sss_mask.curvature=false", "sss_mask.flat_part=1"};
    struct gpu *gpu = *state;
    struct plain plain = face(lit_right, true);
    float *without = run(gpu, &plain, "sss_blur.reach=32", NULL);
    for (int k = 0; k < 5; k++) {
        plain = curved(per_m[k]);
        float *found = run(gpu, &plain, "sss_blur.reach=32", NULL);
        check_edge(found, false, wide[k]);
        assert_true(!memcmp(found, without, 4 * WIDE * HIGH * sizeof *found) == (wide[k] == 1));
        free(found);
    }
    for (int k = 0; k < 2; k++) {
        plain = curved(50);
        float *found = run(gpu, &plain, "sss_blur.reach=32", off[k]);
        assert_memory_equal(found, without, 4 * WIDE * HIGH * sizeof *found);
        free(found);
    }
    plain = curved(0);
    float *narrow = run(gpu, &plain, "sss_blur.reach=32", "sss_mask.flat_part=0");
    for (int i = 0; i < WIDE * HIGH; i++) assert_true(narrow[4 * i] == (i % WIDE >= MIDDLE));
    plain = curved(25);
    float *other = run(gpu, &plain, "sss_blur.reach=32", "sss_mask.bent_mm=20");
    check_edge(other, false, 0.75);
    free(without), free(narrow), free(other);
}

static void no_light_is_lost(void **state) {
    struct gpu *gpu = *state;
    const struct plain plain = face(lit_in_the_middle, true);
    float *found = run(gpu, &plain, "sss_blur.reach=12", NULL);
    double sum[3] = {0};
    size_t spread = 0;
    for (int i = 0; i < WIDE * HIGH; i++) {
        for (int c = 0; c < 3; c++) sum[c] += (double)found[4 * i + c];
        spread += found[4 * i] > 0;
    }
    for (int c = 0; c < 3; c++) assert_true(fabs(sum[c] / (1000 * (c + 1)) - 1) < 1e-4);
    assert_true(spread > 300 && found[4 * (HIGH / 2 * WIDE + MIDDLE)] < 500);
    free(found);
}

/* Only what is skin changes, and takes light of skin alone; with no strength or width nothing does. */
static void nothing_outside_the_mask_changes(void **state) {
    struct gpu *gpu = *state;
    struct plain plain = face(striped, false);
    plain.foreground = true; /* the right half */
    plain.class_name = "skin";
    float *by_class = run(gpu, &plain, "sss_blur.reach=12", NULL);
    plain = face(lit_right, true);
    for (int i = 0; i < WIDE * HIGH; i++) strength[i] = i % WIDE < MIDDLE - 8 ? 0 : i % WIDE < MIDDLE + 8 ? 1 : NAN;
    float *by_mask = run(gpu, &plain, "sss_blur.reach=12", NULL);
    plain = face(lit_behind, true);
    float *behind = run(gpu, &plain, "sss_blur.reach=12", NULL);
    plain = face(lit_right, true);
    float *weak = run(gpu, &plain, "sss_blur.reach=12", "sss_blur.strength=0"),
          *narrow = run(gpu, &plain, "sss_blur.reach=12", "sss_blur.width=0"),
          *unmasked = run(gpu, &plain, "sss_blur.reach=12", "sss_mask.mask=false");
    size_t changed = 0, of_class = 0;
    for (int i = 0; i < WIDE * HIGH; i++) {
        assert_true(i % WIDE >= MIDDLE || by_class[4 * i] == stripe((uint32_t)i));
        of_class += by_class[4 * i] != stripe((uint32_t)i);
        for (int c = 0; c < 3; c++) {
            const float own = (float)((c + 1) * (i % WIDE >= MIDDLE));
            const bool band = i % WIDE >= MIDDLE - 8 && i % WIDE < MIDDLE + 8;
            assert_true(behind[4 * i + c] == own && weak[4 * i + c] == own);
            assert_true(narrow[4 * i + c] == own && unmasked[4 * i + c] == own && (band || by_mask[4 * i + c] == own));
            changed += by_mask[4 * i + c] != own;
        }
    }
    assert_true(changed > 1000 && of_class > 5000);
    free(by_class), free(by_mask), free(behind), free(weak), free(narrow), free(unmasked);
}

/* The picture has it where nothing reflects. */
static void matt(const struct plain *plain, float *values) {
    lit_right(plain, values);
    for (uint32_t i = 0; i < WIDE * HIGH; i++)
        values[PLAIN_SPECULAR * WIDE * HIGH + i] = values[PLAIN_METALNESS * WIDE * HIGH + i] = 0;
}
static void the_picture_has_the_scattered_light(void **state) {
    static const char *const others[] = {
        "screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    struct gpu *gpu = *state;
    const struct plain plain = face(matt, true);
    occlusion_load(gpu, &plain);
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_without(gpu, others);
    gpu_use(gpu, "sss_mask=classes");
    gpu_use(gpu, "sss_blur=separable");
    gpu_run(gpu);
    float *light = gpu_floats(gpu, "lit_scattered", NULL, NULL), *picture = gpu_floats(gpu, "composed", NULL, NULL);
    assert_memory_equal(light, picture, 4 * WIDE * HIGH * sizeof *light);
    assert_true(picture[4 * (HIGH / 2 * WIDE + MIDDLE - 1)] > 0.2F);
    free(picture);
    gpu_set(gpu, "compose.scatter=false");
    gpu_run(gpu);
    picture = gpu_floats(gpu, "composed", NULL, NULL);
    for (uint32_t i = 0; i < WIDE * HIGH; i++) assert_true(picture[4 * i] == (i % WIDE >= MIDDLE));
    free(light), free(picture);
}

/* Half a row of the sky shows none. */
static void sky_above(const struct plain *plain, float *values) {
    matt(plain, values);
    for (int i = 0; i < MIDDLE; i++) values[PLAIN_DEPTH * WIDE * HIGH + i] = INFINITY;
}

static void sky_to_the_right(const struct plain *plain, float *values) {
    matt(plain, values);
    for (int i = 0; i < WIDE * HIGH; i++)
        if (i % WIDE >= MIDDLE) values[PLAIN_DEPTH * WIDE * HIGH + i] = INFINITY;
}

/* A mask and a class that no pixel shows leave the passes out, and the reason says how many do. */
static void passes_run_where_there_is_skin(void **state) {
    static const char *const others[] = {
        "screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    static const char *const reasons[] = {"0 of 19200 pixels show skin",    "160 of 19200 pixels show skin",
                                          "80 of 19200 pixels show skin",   "0 of 19200 pixels show skin",
                                          "9600 of 19200 pixels show skin", "no mask and no stencil class of skin"};
    struct gpu *gpu = *state;
    for (int k = 0; k < 6; k++) {
        struct plain plain = face(k == 2 ? sky_above : k == 3 ? sky_to_the_right : matt, k < 3);
        plain.foreground = k == 3 || k == 4; /* the right half is of the class, which is sky first */
        plain.class_name = "skin";
        for (int i = 0; i < WIDE * HIGH; i++) strength[i] = k && i < WIDE ? 0.5F : i % 2 ? 0 : NAN;
        occlusion_load(gpu, &plain);
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_without(gpu, others);
        gpu_use(gpu, "sss_mask=classes");
        gpu_use(gpu, "sss_blur=separable");
        gpu_run(gpu);
        const struct glint_pass_result *mask = gpu_result(gpu, "sss_mask"), *blur = gpu_result(gpu, "sss_blur");
        assert_memory_equal(mask->reason, reasons[k], strlen(reasons[k]));
        assert_true(mask->ran == (k == 1 || k == 2 || k == 4) && blur->ran == mask->ran);
        if (mask->ran) continue;
        float *lit = gpu_floats(gpu, "composed", NULL, NULL);
        for (int i = 0; i < WIDE * HIGH; i++) assert_true(lit[4 * i] == (i % WIDE >= MIDDLE));
        free(lit);
    }
}

/* A class without a pixel: that its passes are left out changes no bit of the picture. */
static void skipped_passes_change_no_bit(void **state) {
    struct gpu *gpu = *state;
    struct plain plain = face(sky_to_the_right, false);
    float *pictures[2];
    plain.foreground = true;
    plain.class_name = "skin";
    for (int all = 0; all < 2; all++) {
        occlusion_load(gpu, &plain);
        gpu_reset(gpu);
        gpu->all = all;
        gpu_use(gpu, "sss_mask=classes");
        gpu_use(gpu, "sss_blur=separable");
        gpu_run(gpu);
        assert_true(gpu_result(gpu, "sss_blur")->ran == all);
        pictures[all] = gpu_floats(gpu, "composed", NULL, NULL);
    }
    assert_memory_equal(pictures[0], pictures[1], 4 * WIDE * HIGH * sizeof **pictures);
    free(pictures[0]), free(pictures[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_straight_edge_is_the_integral_of_the_profile),
        cmocka_unit_test(curvature_widens_the_profile),
        cmocka_unit_test(no_light_is_lost),
        cmocka_unit_test(nothing_outside_the_mask_changes),
        cmocka_unit_test(the_picture_has_the_scattered_light),
        cmocka_unit_test(passes_run_where_there_is_skin),
        cmocka_unit_test(skipped_passes_change_no_bit),
    };
    return cmocka_run_group_tests_name("gpu_skin", tests, gpu_set_up, gpu_tear_down);
}
