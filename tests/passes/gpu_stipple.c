/* unstipple on a checkerboard of two surfaces in a rectangle, against its closed form, and where there is nothing to smooth. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDE = 48, HIGH = 32, PIXELS = WIDE * HIGH, LEFT = 11, RIGHT = 37, TOP = 5, BOTTOM = 26 };

/* The stippled surface and what is behind it: halves, whose mean is one, too. */
static const double front[3] = {0.75, 2.5, 0.125}, behind[3] = {0.25, 1, 6.5};

static bool inside(uint32_t x, uint32_t y) {
    return x >= LEFT && x < RIGHT && y >= TOP && y < BOTTOM;
}
static bool shows_front(uint32_t x, uint32_t y) {
    return inside(x, y) && (x + y) % 2 == 0;
}
static void spoil_checkerboard(const struct plain *plain, float *values) {
    (void)plain;
    for (uint32_t i = 0; i < PIXELS; i++)
        values[PLAIN_SPECULAR * PIXELS + i] = 0; /* nothing reflects: composed is lit */
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t k = 0; k < 3; k++) {
            float *lit = &values[(PLAIN_LIT_R + k) * PIXELS + i];
            *lit = (float)(i * 2654435761U % 1021 + 40 * k) / 512; /* other places: all kinds of values */
            if (inside(i % WIDE, i / WIDE)) *lit = (float)(shows_front(i % WIDE, i / WIDE) ? front : behind)[k];
        }
}

enum mask { MASK_NONE, MASK_EMPTY, MASK_DRAWN, MASK_FULL };
static void load(struct gpu *gpu, enum mask mask) {
    static const char *const slots[] = {"downsample",    "screen_trace", "cubemap_active", "cubemap_select",
                                        "cubemap_trace", "resolve",      "upscale",        NULL};
    char path[256];
    static float drawn[PIXELS];
    for (uint32_t i = 0; i < PIXELS; i++)
        drawn[i] = mask == MASK_FULL || (mask == MASK_DRAWN && shows_front(i % WIDE, i / WIDE));
    const struct glint_channel channel = {.name = "drawn", .type = GLINT_F32, .data = drawn};
    const struct glint_part part = {
        .name = "stipple", .width = WIDE, .height = HIGH, .channels = &channel, .channel_count = 1};
    const struct plain plain = {.width = WIDE,
                                .height = HIGH,
                                .roughness = 0.5F,
                                .fov_y_degrees = 60,
                                .spoil = spoil_checkerboard,
                                .part = mask ? &part : NULL};
    plain_capture(gpu_path(gpu, "stipple", path), &plain);
    gpu_load(gpu, "stipple");
    gpu_reset(gpu);
    gpu_without(gpu, slots);
    gpu_use(gpu, "unstipple=neighbours");
}

/* What a pixel shows, by hand: half its own colour and half the mean of those beside it. */
static double expected(const float *lit, uint32_t x, uint32_t y, uint32_t k, bool drawn, bool gaps) {
    const double own = (double)lit[4 * (y * WIDE + x) + k];
    if (!inside(x, y) || !(shows_front(x, y) ? drawn : gaps)) return own;
    if (x > LEFT && x + 1 < RIGHT) return 0.5 * (front[k] + behind[k]);
    if (!shows_front(x, y)) return own; /* at the rim: only one neighbour shows the stippled surface */
    const uint32_t beside = y * WIDE + (x == LEFT ? x - 1 : x + 1);
    return 0.5 * own + 0.25 * (behind[k] + (double)lit[4 * beside + k]);
}

static void a_checkerboard_becomes_its_mean(void **state) {
    struct gpu *gpu = *state;
    load(gpu, MASK_DRAWN);
    for (int off = 0; off < 4; off++) {
        gpu_set(gpu, off & 1 ? "unstipple.drawn=false" : "unstipple.drawn=true");
        gpu_set(gpu, off & 2 ? "unstipple.gaps=false" : "unstipple.gaps=true");
        gpu_run(gpu);
        float *lit = gpu_floats(gpu, "composed", NULL, NULL), *found = gpu_floats(gpu, "unstippled", NULL, NULL);
        uint32_t kept = 0;
        for (uint32_t i = 0; i < 4 * PIXELS; i++) {
            const uint32_t x = i / 4 % WIDE, y = i / 4 / WIDE, k = i % 4;
            if (k == 3) {
                assert_true(found[i] == 1);
                continue;
            }
            const double right = expected(lit, x, y, k, !(off & 1), !(off & 2));
            const bool own = right == (double)lit[i];
            kept += own;
            /* Mixed values are rounded to half once, by less than a step, since devices may cut off what is too fine. */
            if (own ? found[i] != lit[i] : !(fabs((double)found[i] - right) <= ldexp(right, -10)))
                fail_msg("pixel %u,%u channel %u: %.9g, expected %.9g", x, y, k, (double)found[i], right);
        }
        assert_true(off == 3 ? kept == 3 * PIXELS : kept < 3 * PIXELS - 700);
        free(lit);
        free(found);
    }
}

static void without_stippled_pixels_there_is_no_pass(void **state) {
    static const char *const reasons[] = {"no mask of stippled pixels", "0 of 1536 pixels show a stippled surface"};
    struct gpu *gpu = *state;
    for (int mask = MASK_NONE; mask <= MASK_FULL; mask++) {
        load(gpu, (enum mask)mask);
        gpu_run(gpu);
        const struct glint_pass_result *unstipple = gpu_result(gpu, "unstipple");
        assert_int_equal(unstipple->ran, mask >= MASK_DRAWN);
        if (mask < MASK_DRAWN) assert_string_equal(unstipple->reason, reasons[mask]);
    }
    /* A surface that leaves no pixel out has nothing to be mixed with. */
    float *lit = gpu_floats(gpu, "composed", NULL, NULL), *found = gpu_floats(gpu, "unstippled", NULL, NULL);
    assert_memory_equal(lit, found, 4 * PIXELS * sizeof *lit);
    free(lit);
    free(found);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_checkerboard_becomes_its_mean),
                                       cmocka_unit_test(without_stippled_pixels_there_is_no_pass)};
    return cmocka_run_group_tests_name("gpu_stipple", tests, gpu_set_up, gpu_tear_down);
}
