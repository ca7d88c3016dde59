/* light on scenes with many lamps: masks and rectangles bit for bit, and how near it is to its truth. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "occlusion.h"
#include "unit.h"

enum { WIDE = 96, HIGH = 54, PIXELS = WIDE * HIGH };

static uint64_t zero_bits(const uint32_t *mask, size_t count, uint32_t lamps) {
    uint64_t zeros = 0;
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < lamps && k < 32; k++) zeros += !(mask[i] >> k & 1);
    return zeros;
}
/* What masks and rectangles leave out is exactly 0, so that they change no bit. Three lamps cover few pixels, others many. */
static void masks_and_rectangles_change_no_bit(void **state) {
    static const char *const scenes[] = {"alley", "desert_night", "street"};
    static const char *const words[][4] = {
        {"light_mask=stencil", NULL},
        {"light_mask=stencil", "light_mask.share=0", "light.quads=false", NULL},
        {"light_mask=stencil", "light_mask.share=2", NULL},
        {"light_mask=stencil", "light.mask=false", NULL},
        {"light_mask=none", "light.quads=false", NULL},
        {"light_mask=stencil", "light_mask.share=0", "light.taps=1", NULL},
    };
    struct gpu *gpu = *state;
    for (int s = 0; s < 3; s++) {
        const struct glint_sample_options options = {
            .width = WIDE, .height = HIGH, .cube_size = 4, .light_samples = 4, .also = GLINT_ALSO_LAMPS};
        float *first = NULL;
        uint64_t zeros[2] = {0, 0};
        gpu_sample(gpu, scenes[s], scenes[s], &options);
        const uint32_t lamps = glint_capture_frame(gpu->capture)->light_count;
        for (size_t w = 0; w < sizeof words / sizeof *words; w++) {
            const char *all[8] = {"light=lambert"};
            for (size_t k = 0; words[w][k]; k++) all[k + 1] = words[w][k];
            occlusion_arrange(gpu, all);
            gpu->all = w == 5;
            gpu_run(gpu);
            gpu->all = false;
            float *found = gpu_floats(gpu, "light", NULL, NULL);
            if (w < 2) {
                uint32_t *mask = gpu_uints(gpu, "light_mask", NULL, NULL);
                zeros[w] = zero_bits(mask, PIXELS, lamps);
                free(mask);
            }
            if (first) assert_memory_equal(first, found, 4 * PIXELS * sizeof *first);
            if (first) free(found);
            else first = found;
        }
        double sum = 0;
        for (size_t i = 0; i < 4 * PIXELS; i++) sum += i % 4 == 3 ? 0 : (double)first[i];
        print_message("# %s: %u lamps, %.1f %% of the bits of all masks are 0, %.1f %% of those of large lights\n",
                      scenes[s], lamps, 100.0 * (double)zeros[1] / ((double)PIXELS * lamps),
                      100.0 * (double)zeros[0] / ((double)PIXELS * lamps));
        assert_true(sum > 10 && zeros[1] > 0 && zeros[0] <= zeros[1]);
        free(first);
    }
}

/* Lamps before, beside and behind the camera, and surfaces anywhere: rectangles and masks hold all that they reach, also at the rims of balls and
   cones. */
static uint32_t state_of_draws;
static double draw(double low, double high) {
    state_of_draws = state_of_draws * 1664525u + 1013904223u;
    return low + (high - low) * (state_of_draws >> 8) / 16777216.0;
}
static void scatter(UNUSED const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < PIXELS; i++) {
        const double up = draw(-1, 1), turn = draw(0, 2 * M_PI), side = sqrt(1 - up * up);
        values[PLAIN_DEPTH * PIXELS + i] = (float)draw(0.2, 8);
        values[PLAIN_NORMAL_X * PIXELS + i] = (float)(side * cos(turn));
        values[PLAIN_NORMAL_Y * PIXELS + i] = (float)up;
        values[PLAIN_NORMAL_Z * PIXELS + i] = (float)(side * sin(turn));
    }
}
static struct glint_light any_lamp(void) {
    struct glint_light light = {
        .position = {draw(-5, 5), draw(-4, 4), draw(-8, 3)}, .intensity = {1, 1, 1}, .range = draw(0.3, 4)};
    light.has_cone = draw(0, 1) < 0.8;
    const double up = draw(-1, 1), turn = draw(0, 2 * M_PI), side = sqrt(1 - up * up);
    light.cone = (struct glint_cone){.axis = {side * cos(turn), up, side * sin(turn)},
                                     .outer_rad = draw(0.1, draw(0, 1) < 0.6 ? 0.8 : 2)};
    return light;
}
static void rectangles_hold_all_that_lamps_reach(void **state) {
    static const char *const words[][3] = {{"light_mask=none", "light.quads=false", NULL},
                                           {"light_mask=none", "light.quads=true", NULL},
                                           {"light_mask=stencil", "light_mask.share=0", NULL}};
    struct gpu *gpu = *state;
    size_t lit = 0;
    for (int round = 0; round < 8; round++) {
        struct glint_light lamps[24];
        float *found[3];
        for (int k = 0; k < 24; k++) lamps[k] = any_lamp();
        const struct plain plain = {.width = WIDE,
                                    .height = HIGH,
                                    .roughness = 0.5F,
                                    .fov_y_degrees = 70,
                                    .jitter_px = {0.3, -0.2},
                                    .spoil = scatter,
                                    .lights = lamps,
                                    .light_count = 24};
        occlusion_load(gpu, &plain);
        for (int w = 0; w < 3; w++) {
            const char *const all[] = {"light=lambert", "light.range_law=cut", "light.cone_law=cut",
                                       words[w][0],     words[w][1],           NULL};
            occlusion_arrange(gpu, all);
            gpu_run(gpu);
            found[w] = gpu_floats(gpu, "light", NULL, NULL);
        }
        for (int w = 1; w < 3; w++) assert_memory_equal(found[0], found[w], 4 * PIXELS * sizeof *found[0]);
        for (int i = 0; i < PIXELS; i++) lit += found[0][4 * i] > 0;
        for (int w = 0; w < 3; w++) free(found[w]);
    }
    print_message("# %zu of %d pixels lit\n", lit, 8 * PIXELS);
    assert_true(lit > 5000);
}

/* Shadow maps bring the light of spot lights nearer to the truth, whose shadows are soft. */
static void light_is_near_its_truth(void **state) {
    static const char *const scenes[] = {"alley", "street", "desert_night"}, *const rgb[] = {"R", "G", "B"};
    struct gpu *gpu = *state;
    for (int s = 0; s < 3; s++) {
        const struct glint_sample_options options = {.width = WIDE,
                                                     .height = HIGH,
                                                     .cube_size = 4,
                                                     .light_samples = 4,
                                                     .truth_samples = 32,
                                                     .truths = GLINT_TRUTH_LAMPS,
                                                     .also = GLINT_ALSO_LAMPS};
        char name[64];
        double error[2];
        snprintf(name, sizeof name, "%s_truth", scenes[s]);
        gpu_sample(gpu, scenes[s], name, &options);
        float *truth = gpu_part(gpu, "truth.lamps", rgb, 3);
        for (int off = 0; off < 2; off++) {
            const char *const words[] = {"light_mask=stencil", "light=lambert",
                                         off ? "light.shadows=false" : "light.shadows=true", NULL};
            occlusion_arrange(gpu, words);
            gpu_run(gpu);
            float *found = gpu_floats(gpu, "light", NULL, NULL);
            double difference = 0, sum = 0;
            for (size_t i = 0; i < PIXELS; i++)
                for (size_t c = 0; c < 3; c++) {
                    difference += fabs((double)found[4 * i + c] - (double)truth[3 * i + c]);
                    sum += (double)truth[3 * i + c];
                }
            error[off] = difference / sum;
            free(found);
        }
        print_message("# %s: mean difference %.4f of the light with shadows, %.4f without\n", scenes[s], error[0],
                      error[1]);
        assert_true(s == 2 ? error[0] == error[1] : error[0] < error[1]);
        free(truth);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(masks_and_rectangles_change_no_bit),
                                       cmocka_unit_test(rectangles_hold_all_that_lamps_reach),
                                       cmocka_unit_test(light_is_near_its_truth)};
    return cmocka_run_group_tests_name("gpu_lit_scenes", tests, gpu_set_up, gpu_tear_down);
}
