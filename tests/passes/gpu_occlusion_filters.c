/* ao_blur, ao_apply, ao_bounds and the switches of ao_trace: what is mixed with what, and what need not be worked on. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "occlusion.h"
#include "shapes.h"
#include "unit.h"

enum { WIDE = 160, HIGH = 120 };

/* Bars of a wall at 2 m before one at 5 m, sixteen pixels wide each. */
static bool is_near(uint32_t x) {
    return x / 16 % 2;
}
static void bars(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < plain->width * plain->height; i++) values[i] = is_near(i % plain->width) ? 2 : 5;
}
static void load_bars(struct gpu *gpu) {
    occlusion_load(
        gpu, &(struct plain){.width = WIDE, .height = HIGH, .roughness = 0.5F, .fov_y_degrees = 60, .spoil = bars});
}

/* ---- ao_blur ---- */

/* A radius of 2 weighs 4 x 4 texels alike. Surfaces are kept apart, unless both tests are off. */
static void the_blur_averages_a_surface_and_no_other(void **state) {
    struct gpu *gpu = *state;
    load_bars(gpu);
    for (int mixed = 0; mixed < 2; mixed++) {
        const char *const words[] = {"downsample=pick", "ao_trace=horizon", "ao_blur=separable",
                                     mixed ? "ao_blur.depth_part=10" : NULL, NULL};
        int leaked = 0, whole = 0;
        uint32_t width, height;
        occlusion_arrange(gpu, words);
        gpu_shader(gpu, "ao_trace", "occlusion_pattern.comp");
        gpu_run(gpu);
        float *blurred = gpu_floats(gpu, "occlusion_blurred", &width, &height);
        for (uint32_t y = 2; y < height - 2; y++)
            for (uint32_t x = 2; x < width - 2; x++) {
                const float value = blurred[y * width + x];
                if (!is_near(2 * x)) leaked += value > 0;
                else if (x % 8 >= 2 && x % 8 < 6) { /* two texels from either edge of its bar */
                    if (!(fabs((double)value - 7.5 / 16) <= 8 * 0x1p-24)) fail_msg("%u, %u: %.9g", x, y, (double)value);
                    whole++;
                }
            }
        assert_true(whole > 500 && (leaked > 500) == mixed);
        free(blurred);
    }
}

/* Neither a radius of 0 nor a uniform picture changes anything. */
static void a_blur_of_nothing_changes_nothing(void **state) {
    struct gpu *gpu = *state;
    static const struct shapes floor_alone = {.floor_y = -1};
    const struct plain plain = occlusion_frame(&floor_alone, 60);
    for (int uniform = 0; uniform < 2; uniform++) {
        static const char *const words[2][5] = {
            {"downsample=pick", "ao_trace=horizon", "ao_blur=separable", "ao_blur.radius=0", NULL},
            {"downsample=pick", "ao_trace=horizon", "ao_blur=separable", "ao_blur.kernel=gaussian", NULL}};
        uint32_t width, height;
        if (uniform) occlusion_load(gpu, &plain);
        else load_bars(gpu);
        occlusion_arrange(gpu, words[uniform]);
        if (!uniform) gpu_shader(gpu, "ao_trace", "occlusion_pattern.comp");
        gpu_run(gpu);
        float *before = gpu_floats(gpu, "occlusion_half", &width, &height),
              *after = gpu_floats(gpu, "occlusion_blurred", NULL, NULL);
        assert_memory_equal(before, after, width * height * sizeof *before);
        free(before), free(after);
    }
}

/* ---- ao_apply ---- */

static float *applied(struct gpu *gpu, const char *variant, const char *setting) {
    const char *const words[] = {"downsample=pick", "ao_trace=horizon", variant, setting, NULL};
    load_bars(gpu);
    occlusion_arrange(gpu, words);
    gpu_shader(gpu, "ao_trace", "occlusion_pattern.comp");
    gpu_run(gpu);
    return gpu_floats(gpu, "occlusion", NULL, NULL);
}

static void a_pixel_takes_texels_of_its_own_plane(void **state) {
    for (int blind = 0; blind < 2; blind++) {
        float *found = applied(*state, blind ? "ao_apply=bilinear" : "ao_apply=planes", NULL);
        int leaked = 0;
        for (uint32_t i = 0; i < WIDE * HIGH; i++)
            leaked += !is_near(i % WIDE) && found[i] > 1e-3F; /* texels of other surfaces have a weight of 1e-4 */
        print_message("# %s: %d pixels of the far wall with light of the near one\n", blind ? "bilinear" : "planes",
                      leaked);
        assert_true(blind ? leaked > HIGH : leaked == 0);
        free(found);
    }
}

/* A depth_part of 10 is no test, however far apart planes are. */
static void far_bars(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < plain->width * plain->height; i++) values[i] = is_near(i % plain->width) ? 0.25F : 50;
}
static void a_part_of_ten_is_no_test(void **state) {
    static const char *const ways[][2] = {{"ao_apply=planes", "ao_apply.depth_part=10"}, {"ao_apply=bilinear", NULL}};
    struct gpu *gpu = *state;
    float *found[2];
    occlusion_load(
        gpu, &(struct plain){.width = WIDE, .height = HIGH, .roughness = 0.5F, .fov_y_degrees = 60, .spoil = far_bars});
    for (int w = 0; w < 2; w++) {
        const char *const words[] = {"downsample=pick", "ao_trace=horizon", ways[w][0], ways[w][1], NULL};
        occlusion_arrange(gpu, words);
        gpu_shader(gpu, "ao_trace", "occlusion_pattern.comp");
        gpu_run(gpu);
        found[w] = gpu_floats(gpu, "occlusion", NULL, NULL);
    }
    for (uint32_t i = 0; i < WIDE * HIGH; i++) assert_true(fabsf(found[0][i] - found[1][i]) < 1e-5F);
    free(found[0]), free(found[1]);
}

static void intensity_and_power_are_neutral_at_one(void **state) {
    float *plain = applied(*state, "ao_apply=planes", NULL);
    float *half = applied(*state, "ao_apply=planes", "ao_apply.intensity=0.5");
    float *none = applied(*state, "ao_apply=planes", "ao_apply.intensity=0");
    float *square = applied(*state, "ao_apply=planes", "ao_apply.power=2");
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        assert_true(none[i] == 1);
        assert_true(fabs((double)half[i] - (1 - 0.5 * (1 - (double)plain[i]))) < 1e-6);
        assert_true(fabs((double)square[i] - pow((double)plain[i], 2)) <
                    2e-6); /* pow is exp and log: 16 ULP (Vulkan) */
    }
    free(plain), free(half), free(none), free(square);
}

/* ---- what need not be worked on ---- */

/* The boxes of ao_bounds skip texels, and change no bit: in a room's corner, by a ball, and on a slope. */
static void skipped_texels_would_have_been_visible(void **state) {
    static const struct shapes scenes[] = {{.floor_y = -1, .wall_z = -5, .wall_top = INFINITY},
                                           {.floor_y = -1, .sphere = {0, -0.5, -5, 0.5}},
                                           {.floor_y = -1, .ceiling_y = 1}};
    static const char *const variants[] = {"ao_trace=horizon", "ao_trace=hemisphere"};
    struct gpu *gpu = *state;
    for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++)
        for (int v = 0; v < 2; v++) {
            const struct plain plain = occlusion_frame(&scenes[s], 60);
            float *found[2];
            double fetches[2] = {0};
            uint32_t width, height;
            occlusion_load(gpu, &plain);
            for (int all = 0; all < 2; all++) {
                const char *const words[] = {"downsample=pick", "ao_bounds=boxes", variants[v],
                                             all ? "ao_trace.cull=false" : NULL, NULL};
                occlusion_arrange(gpu, words);
                gpu_run(gpu);
                found[all] = gpu_floats(gpu, "occlusion_half", &width, &height);
                uint32_t *counted = gpu_uints(gpu, "occlusion_fetches", NULL, NULL);
                for (uint32_t i = 0; i < width * height; i++) fetches[all] += counted[i];
                free(counted);
            }
            print_message("# scene %zu, %s: %.1f fetches a texel, %.1f without the boxes\n", s, variants[v],
                          fetches[0] / width / height, fetches[1] / width / height);
            assert_memory_equal(found[0], found[1], width * height * sizeof **found);
            /* points of the hemisphere may be hidden by anything in front of them */
            assert_true(v == 1 || s == 2 || fetches[0] < 0.8 * fetches[1]);
            free(found[0]), free(found[1]);
        }
}

/* The same in a world that is turned by an eighth about x, whose floor falls away from the viewer's side. */
static const double eighth = 0.70710678118654752;
static void turn_world(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    float *y = values + PLAIN_NORMAL_Y * pixels, *z = values + PLAIN_NORMAL_Z * pixels;
    shapes_spoil(plain, values);
    for (uint32_t i = 0; i < pixels; i++) {
        const double was_y = (double)y[i], was_z = (double)z[i];
        y[i] = (float)(eighth * (was_y + was_z)), z[i] = (float)(eighth * (was_z - was_y));
    }
}
static void skipped_texels_are_the_same_in_a_turned_world(void **state) {
    static const struct shapes scene = {.floor_y = -1, .sphere = {0, -0.5, -5, 0.5}};
    static const double to_view[16] = {1, 0, 0, 0, 0, eighth, -eighth, 0, 0, eighth, eighth, 0, 0, 0, 0, 1};
    struct gpu *gpu = *state;
    struct plain plain = occlusion_frame(&scene, 60);
    float *found[2];
    int hidden = 0;
    plain.spoil = turn_world;
    plain.world_to_view = to_view;
    occlusion_load(gpu, &plain);
    for (int all = 0; all < 2; all++) {
        const char *const words[] = {"downsample=pick", "ao_bounds=boxes", "ao_trace=horizon",
                                     all ? "ao_trace.cull=false" : NULL, NULL};
        occlusion_arrange(gpu, words);
        gpu_run(gpu);
        found[all] = gpu_floats(gpu, "occlusion_half", NULL, NULL);
    }
    for (uint32_t i = 0; i < WIDE * HIGH / 4; i++) hidden += found[1][i] < 0.9F;
    assert_memory_equal(found[0], found[1], WIDE * HIGH / 4 * sizeof **found);
    assert_true(hidden > 30);
    free(found[0]), free(found[1]);
}

/* ---- switches ---- */

/* Each setting changes the occlusion of a ball on a floor before a wall. */
static void every_switch_has_an_effect(void **state) {
    static const struct {
        const char *base, *settings[12];
    } ways[] = {
        {"ao_trace=horizon",
         {"ao_trace.radius_in=screen", "ao_trace.radius_m=0.3", "ao_trace.pattern=none", "ao_trace.pattern=blue",
          "ao_trace.shuffle=false", "ao_trace.averaged=ratio", "ao_trace.averaged=visible", "ao_trace.behind=solid",
          "ao_trace.growth=1", "ao_trace.thickness=0.05", "ao_trace.bias=0.5", "ao_trace.lift=0.3"}},
        {"ao_trace=horizon", {"ao_trace.slices=3", "ao_trace.steps=3"}},
        {"ao_trace.behind=decay", {"ao_trace.decay=0.9", "ao_trace.fade=0.5"}},
        {"ao_trace=hemisphere",
         {"ao_trace.samples=8", "ao_trace.range=none", "ao_trace.range=hard", "ao_trace.spread=0.3",
          "ao_trace.thickness=0.1", "ao_trace.radius_part=0.3"}},
        {"ao_trace=dda",
         {"ao_trace.directions=8", "ao_trace.cells=2", "ao_trace.pass_behind=false", "ao_trace.inside=false",
          "ao_trace.thickness=0.1", "ao_trace.thickness_m=1e6", "ao_trace.solid=0"}},
    };
    static const struct shapes scene = {.floor_y = -1, .wall_z = -6, .wall_top = 1, .sphere = {0, -0.4, -3, 0.5}};
    struct gpu *gpu = *state;
    const struct plain plain = occlusion_frame(&scene, 50);
    occlusion_load(gpu, &plain);
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
        float *base = NULL;
        for (int s = -1; s < 12 && (s < 0 || ways[w].settings[s]); s++) {
            const char *const first = strchr(ways[w].base, '.') ? "ao_trace=horizon" : ways[w].base;
            const char *const words[] = {"downsample=pick", first,
                                         first == ways[w].base ? "ao_trace.radius_m=1" : ways[w].base,
                                         s >= 0 ? ways[w].settings[s] : NULL, NULL};
            uint32_t width, height;
            occlusion_arrange(gpu, words);
            if (s >= 0 && !strcmp(ways[w].settings[s], "ao_trace.radius_part=0.3"))
                gpu_set(gpu, "ao_trace.radius_in=screen");
            gpu_run(gpu);
            float *found = gpu_floats(gpu, "occlusion_half", &width, &height);
            if (s < 0) {
                base = found;
                continue;
            }
            if (!memcmp(base, found, width * height * sizeof *base))
                fail_msg("%s changes nothing", ways[w].settings[s]);
            free(found);
        }
        free(base);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_blur_averages_a_surface_and_no_other),
        cmocka_unit_test(a_blur_of_nothing_changes_nothing),
        cmocka_unit_test(a_pixel_takes_texels_of_its_own_plane),
        cmocka_unit_test(a_part_of_ten_is_no_test),
        cmocka_unit_test(intensity_and_power_are_neutral_at_one),
        cmocka_unit_test(skipped_texels_would_have_been_visible),
        cmocka_unit_test(skipped_texels_are_the_same_in_a_turned_world),
        cmocka_unit_test(every_switch_has_an_effect),
    };
    return cmocka_run_group_tests_name("gpu_occlusion_filters", tests, gpu_set_up, gpu_tear_down);
}
