/* Bloom by closed form: one bright pixel becomes the sum of four Gaussians, no light is lost, and what is not bright does not change. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIDE = 240, AT_X = 121, AT_Y = 118, MIPS = 4 };

struct light {
    float (*color)(uint32_t x, uint32_t y, uint32_t channel);
    float specular;
};

static void paint(const struct plain *plain, float *values) {
    const struct light *light = plain->user;
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; i++) {
        values[PLAIN_SPECULAR * pixels + i] = light->specular;
        for (uint32_t c = 0; c < 3; c++)
            values[(PLAIN_LIT_R + c) * pixels + i] =
                light->color((uint32_t)(i % plain->width), (uint32_t)(i / plain->width), c);
    }
}

static void load(struct gpu *gpu, uint32_t width, uint32_t height, const struct light *light, double exposure) {
    char path[256];
    const struct plain plain = {
        .width = width, .height = height, .fov_y_degrees = 60, .spoil = paint, .user = light, .exposure = exposure};
    plain_capture(gpu_path(gpu, "bloom", path), &plain);
    gpu_load(gpu, "bloom");
}

static void reset(struct gpu *gpu, const char *const *assignments) {
    gpu_reset(gpu);
    gpu_use(gpu, "bloom_threshold=luminance");
    gpu_use(gpu, "bloom_blur=gaussian");
    gpu_use(gpu, "bloom=combined");
    gpu->float_precision = true;
    for (; *assignments; assignments++)
        if (!strncmp(*assignments, "use ", 4)) gpu_use(gpu, *assignments + 4);
        else gpu_set(gpu, *assignments);
}
#define RESET(gpu, ...) reset(gpu, (const char *const[]){__VA_ARGS__, NULL})

/* ---- One bright pixel ---- */

static float star(uint32_t x, uint32_t y, uint32_t channel) {
    return x == AT_X && y == AT_Y ? (float[]){3000, 2000, 1000}[channel] : 0;
}

/* A Gaussian of so many texels around the texel of the star, which ends at three deviations and adds up to 1. */
static double gaussian(int from_center, double deviation) {
    const int reach = (int)ceil(3 * deviation);
    double total = 0;
    for (int i = -reach; i <= reach; i++) total += exp(-i * i / (2 * deviation * deviation));
    return abs(from_center) > reach ? 0 : exp(-from_center * from_center / (2 * deviation * deviation)) / total;
}

/* The part of the star's light that a pixel gets along one axis from a resolution whose texels are `wide` pixels: the star fills 1/wide of
   its texel, and between the centres of two texels the light is interpolated. */
static double spread_along(int pixel, int star_at, int wide, double deviation) {
    const double place = (pixel + 0.5) / wide - 0.5;
    const int texel = (int)floor(place), center = star_at / wide;
    const double part = place - texel;
    return ((1 - part) * gaussian(texel - center, deviation) + part * gaussian(texel + 1 - center, deviation)) / wide;
}

/* How much of it changes when the position moves by a rounding: Vulkan lets the quotient of pixel and width be off by 2.5 units in the last
   place, and its product with the texels by half a unit. */
static double slip_along(int pixel, int star_at, int wide, double deviation) {
    const int texel = (int)floor((pixel + 0.5) / wide - 0.5), center = star_at / wide;
    double steepest = 0;
    for (int i = texel - 1; i <= texel + 1; i++)
        steepest = fmax(steepest, fabs(gaussian(i + 1 - center, deviation) - gaussian(i - center, deviation)));
    return steepest / wide * 3 * exp2(-23) * SIDE / wide;
}

/* The rounding of floats moves each of two sums of 13 exponentials, each
   exact to 12 units in the last place by Vulkan's precision of exp(x), by 2e-6 of it, and the position between texels; a half loses up
   to 2^-10, since devices may cut it off, when each of up to five levels, both blurs and the picture are stored. */
static void expect_gaussians(struct gpu *gpu, bool halves, bool full) {
    RESET(gpu, "bloom.strength=0.5", "bloom.spread=0.75", full ? "use downsample=none" : "use downsample=pick");
    gpu->float_precision = !halves;
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "bloomed", NULL, NULL);
    const double luminance = 0.2126 * 3000 + 0.7152 * 2000 + 0.0722 * 1000;
    const int finest = full ? 1 : 2, deviation = full ? 4 : 2;
    double total = 0, worst = 0, added = 0, weight[MIPS] = {1, 0.75, 0.75 * 0.75, 0.75 * 0.75 * 0.75};
    for (int k = 0; k < MIPS; k++) total += weight[k];
    for (int i = 0; i < SIDE * SIDE; i++)
        for (uint32_t c = 0; c < 3; c++) {
            const double own = (double)star((uint32_t)i % SIDE, (uint32_t)i / SIDE, c);
            const double passed = (double)star(AT_X, AT_Y, c) * (1 - 1 / luminance);
            double expected = 0, slip = 0;
            for (int k = 0; k < MIPS; k++) {
                const double light = weight[k] / total * 0.5 * passed;
                const double across = spread_along(i % SIDE, AT_X, finest << k, deviation);
                const double down = spread_along(i / SIDE, AT_Y, finest << k, deviation);
                expected += light * across * down;
                slip += light * (across * slip_along(i / SIDE, AT_Y, finest << k, deviation) +
                                 down * slip_along(i % SIDE, AT_X, finest << k, deviation));
            }
            const double bound = halves ? 8 * exp2(-10) * expected + exp2(-12) * own + MIPS * exp2(-24)
                                        : 1e-5 * expected + slip + exp2(-24) * own + 1e-12;
            const double error = fabs((double)found[4 * (uint32_t)i + c] - own - expected);
            worst = fmax(worst, error / bound);
            if (error > bound)
                fail_msg("pixel %d, %d: %.9g, expected %.9g within %g", i % SIDE, i / SIDE,
                         (double)found[4 * (uint32_t)i + c], own + expected, bound);
            if (c == 0 && own == 0) added += (double)found[4 * i];
            if (c == 0 && own > 0) added += expected;
        }
    const double all = 0.5 * 3000 * (1 - 1 / luminance);
    print_message("# %s: at most %.3g of the bound; added %.9g of %.9g\n", halves ? "halves" : "floats", worst, added,
                  all);
    assert_true(fabs(added - all) <=
                (halves ? 8 * exp2(-10) : 1e-5) * all); /* away from the borders no light is lost */
    free(found);
}

/* Catches: a resolution that is made of the blur of another one, another deviation, a blur along one axis only, weights that do not add up
   to 1, texels looked up half a texel aside, the threshold's part that is left in. */
static void a_star_becomes_four_gaussians(void **state) {
    static const struct light light = {.color = star};
    struct gpu *gpu = *state;
    load(gpu, SIDE, SIDE, &light, 1);
    expect_gaussians(gpu, false, false);
    expect_gaussians(gpu, true, false);
}

/* Where the pipeline traces every pixel, the first resolution is that of the picture, and the blur is as wide in pixels of the picture.
   Catches: a width in texels of whatever size. */
static void the_blur_is_as_wide_at_full_resolution(void **state) {
    static const struct light light = {.color = star};
    struct gpu *gpu = *state;
    load(gpu, SIDE, SIDE, &light, 1);
    expect_gaussians(gpu, false, true);
}

/* ---- The threshold ---- */

static float flat(uint32_t x, uint32_t y, uint32_t channel) {
    (void)x, (void)y;
    return (float[]){3, 2, 0.5F}[channel];
}

/* Borders repeat, so that a picture of one colour stays one, at any size. The luminance is 2.1043, displayed twice as bright.
   Catches: borders that are dark, an exposure that is left out, levels of odd sizes whose weights do not add up to 1. */
static void a_flat_picture_stays_flat(void **state) {
    static const struct light light = {.color = flat};
    struct gpu *gpu = *state;
    const double bright = 2 * (0.2126 * 3 + 0.7152 * 2 + 0.0722 * 0.5);
    load(gpu, 37, 23, &light, 2);
    for (int whole = 0; whole < 2; whole++) {
        RESET(gpu, "bloom_threshold.threshold=3", whole ? "bloom_threshold.cut=whole" : "bloom_threshold.cut=excess");
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "bloomed", NULL, NULL);
        for (uint32_t i = 0; i < 37 * 23; i++)
            for (uint32_t c = 0; c < 3; c++) {
                const double own = (double)flat(0, 0, c), expected = own * (1 + 0.25 * (whole ? 1 : 1 - 3 / bright));
                assert_true(fabs((double)found[4 * i + c] - expected) <= 1e-5 * expected);
            }
        free(found);
    }
}

/* Bright and dark pixels, one of each kind that is not finite, and a green that is bright though its red is negative. */
static float rough(uint32_t x, uint32_t y, uint32_t channel) {
    if (x == 5 && y == 7) return channel == 1 ? NAN : 1;
    if (x == 20 && y == 3) return INFINITY;
    if (x == 30 && y == 19) return channel == 1 ? 9 : -1;
    const uint32_t hash = (x * 73856093U ^ y * 19349663U ^ channel * 83492791U) * 2654435761U;
    return (float)(hash >> 20) / 1024.0F;
}

/* Each level holds as much light as passed the threshold. Catches: rows and columns of odd sizes that are dropped or counted twice, a colour
   that is not finite in the mean. */
static void every_level_holds_all_light(void **state) {
    static const struct light light = {.color = rough};
    struct gpu *gpu = *state;
    double expected[3] = {0};
    load(gpu, 37, 23, &light, 1);
    for (uint32_t i = 0; i < 37 * 23; i++) {
        double color[3];
        for (uint32_t c = 0; c < 3; c++) color[c] = (double)rough(i % 37, i / 37, c);
        const double bright = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
        for (uint32_t c = 0; c < 3 && isfinite(bright) && bright > 1; c++)
            expected[c] += color[c] * (1 - 1 / bright) / (37 * 23);
    }
    RESET(gpu, "bloom.strength=1");
    gpu_run(gpu);
    for (int level = 0; level < MIPS; level++) {
        char name[32];
        uint32_t width, height;
        snprintf(name, sizeof name, level ? "bloom_bright.level%d" : "bloom_bright", level);
        float *found = gpu_floats(gpu, name, &width, &height);
        for (uint32_t c = 0; c < 3; c++) {
            double sum = 0;
            for (uint32_t i = 0; i < width * height; i++) sum += (double)found[4 * i + c] / (width * height);
            if (fabs(sum - expected[c]) > 1e-5 * expected[c])
                fail_msg("level %d: %.9g, expected %.9g", level, sum, expected[c]);
        }
        free(found);
    }
}

/* ---- What does not change ---- */

static void expect_unchanged(struct gpu *gpu) {
    float *before = gpu_floats(gpu, "composed", NULL, NULL), *after = gpu_floats(gpu, "bloomed", NULL, NULL);
    for (int i = 0; i < 37 * 23; i++) assert_memory_equal(before + 4 * i, after + 4 * i, 3 * sizeof *after);
    free(before), free(after);
}

/* Catches: a picture that is stored anew where nothing is added. */
static void off_is_the_same_bits(void **state) {
    static const struct light light = {.color = rough};
    struct gpu *gpu = *state;
    load(gpu, 37, 23, &light, 1);
    for (int halves = 0; halves < 2; halves++) {
        RESET(gpu, "bloom.strength=0");
        gpu->float_precision = !halves;
        gpu_run(gpu);
        assert_true(gpu_result(gpu, "bloom")->ran);
        expect_unchanged(gpu);
    }
}

/* Fog has a colour of its own, which may be brighter than the picture. */
static void fog_may_be_bright(void **state) {
    static const struct glint_fog fog = {.color = {4, 4, 4}, .density = 0.5, .scale_height = 10};
    static const struct light light = {.color = flat};
    struct gpu *gpu = *state;
    char path[256];
    const struct plain plain = {
        .width = 37, .height = 23, .fov_y_degrees = 60, .spoil = paint, .user = &light, .exposure = 1, .fog = &fog};
    plain_capture(gpu_path(gpu, "bloom", path), &plain);
    gpu_load(gpu, "bloom");
    RESET(gpu, "use fog=height", "bloom_threshold.threshold=2.2");
    gpu_run(gpu);
    float *foggy = gpu_floats(gpu, "composed_fog", NULL, NULL);
    assert_true(foggy[0] > 2.2F && gpu_result(gpu, "bloom_threshold")->ran);
    free(foggy);
}

/* The plan leaves bloom out where the brightest pixel is not over the threshold and nothing adds light, and the picture has the same bits when they
   are forced to run. Catches: a plan that knows nothing of exposure or of reflections, a pass that runs without its input. */
static void what_is_not_bright_needs_no_pass(void **state) {
    struct gpu *gpu = *state;
    static const char *const slots[] = {"bloom_threshold", "bloom_blur", "bloom", NULL};
    static const struct {
        double exposure, threshold;
        float specular;
        bool bright;
    } frames[] = {{1, 2.2, 0, false}, {1, 2.0, 0, true}, {2, 2.2, 0, true}, {2, 4.3, 0, false}, {1, 2.2, 0.5F, true}};
    for (size_t f = 0; f < sizeof frames / sizeof *frames; f++) {
        const struct light light = {flat, frames[f].specular};
        char threshold[64];
        snprintf(threshold, sizeof threshold, "bloom_threshold.threshold=%g", frames[f].threshold);
        load(gpu, 37, 23, &light, frames[f].exposure);
        RESET(gpu, threshold);
        gpu_run(gpu);
        for (size_t s = 0; s < 3; s++)
            if (gpu_result(gpu, slots[s])->ran != frames[f].bright) fail_msg("frame %zu: %s", f, slots[s]);
        if (frames[f].bright) continue;
        struct glint_error err = {0};
        const struct glint_replay_options options = {.force = slots, .float_precision = true};
        if (!glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
        assert_true(gpu_result(gpu, "bloom_threshold")->ran && gpu_result(gpu, "bloom")->ran);
        expect_unchanged(gpu);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_star_becomes_four_gaussians),
        cmocka_unit_test(the_blur_is_as_wide_at_full_resolution),
        cmocka_unit_test(a_flat_picture_stays_flat),
        cmocka_unit_test(every_level_holds_all_light),
        cmocka_unit_test(off_is_the_same_bits),
        cmocka_unit_test(fog_may_be_bright),
        cmocka_unit_test(what_is_not_bright_needs_no_pass),
    };
    return cmocka_run_group_tests(tests, gpu_set_up, gpu_tear_down);
}
