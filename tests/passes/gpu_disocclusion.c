/* The mask of surfaces that the previous frame did not show, against the geometry of the picture. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { W = 32, H = 24, WALL_M = 5, OBJECT_M = 2, STEP_PX = 3, WIDE_PX = 8 };

struct shot {
    uint32_t number;
    double jitter_px[2], previous_jitter_px[2];
    bool floor, sky; /* a floor that is seen at a grazing angle; a wall that is sky */
    bool mirror;     /* everything reflects, and the light differs from frame to frame */
    bool square;     /* before the wall, STEP_PX a frame to the right */
    bool still;      /* it stands still, and jitter moves its edges */
};

static int left_of(const struct shot *shot) {
    return 4 + STEP_PX * (int)(shot->number % 100);
}
static bool on_square(const struct shot *shot, int x, int y) {
    const int top = shot->mirror ? 16 : 6; /* of a mirror: on the floor */
    const double place = x + 0.5 - shot->jitter_px[0];
    if (shot->still) return y >= top && y < top + 5 && place > 8.8 && place < 16.2;
    return shot->square && y >= top && y < top + 5 && x >= left_of(shot) && x < left_of(shot) + WIDE_PX;
}

static void paint(const struct plain *plain, float *values) {
    const struct shot *shot = plain->user;
    for (size_t i = 0; i < W * H; i++) {
        values[PLAIN_SPECULAR * W * H + i] = shot->mirror ? 0.5f : 0;
        for (size_t c = 0; c < 3; c++) values[(PLAIN_LIT_R + c) * W * H + i] += (float)(shot->number % 100);
        if (shot->sky) values[PLAIN_DEPTH * W * H + i] = INFINITY;
        if (!on_square(shot, (int)(i % W), (int)(i / W))) continue;
        values[PLAIN_DEPTH * W * H + i] = OBJECT_M;
        if (!shot->still) values[PLAIN_MOTION_X * W * H + i] -= (float)STEP_PX / W;
    }
}

/* What rays find that leave the screen. */
static void around(uint32_t number, const double direction[3], float out[5]) {
    static const float texel[5] = {7, 7, 7, 1, 6};
    (void)number, (void)direction;
    memcpy(out, texel, sizeof texel);
}

static float *mask_of(struct gpu *gpu, const struct shot *shot) {
    char path[256];
    const struct plain plain = {.width = W,
                                .height = H,
                                .fov_y_degrees = 60,
                                .frame = shot->number,
                                .floor = shot->floor,
                                .jitter_px = {shot->jitter_px[0], shot->jitter_px[1]},
                                .previous_jitter_px = {shot->previous_jitter_px[0], shot->previous_jitter_px[1]},
                                .cube_size = 8,
                                .cube_count = 1,
                                .cube = around,
                                .spoil = paint,
                                .user = shot};
    plain_capture(gpu_path(gpu, "frame", path), &plain);
    gpu_load(gpu, "frame");
    gpu_run(gpu);
    return gpu_floats(gpu, "disocclusion", NULL, NULL);
}

static void reset(struct gpu *gpu, const char *variant) {
    static const char *const others[] = {"downsample",    "screen_trace", "cubemap_active", "cubemap_select",
                                         "cubemap_trace", "resolve",      "upscale",        NULL};
    char text[64];
    gpu_reset(gpu);
    gpu_without(gpu, others);
    snprintf(text, sizeof text, "disocclusion=%s", variant);
    gpu_use(gpu, text);
    gpu_use(gpu, "taa=composed");
}

/* Of the wall exactly the columns that the square left; of the square what was off screen. Before a sky, too.
   Catches: a mask of this frame's square, tests with the wrong sign, a previous depth of the same frame. */
static void what_the_square_left_was_hidden(void **state) {
    struct gpu *gpu = *state;
    for (int sky = 0; sky < 2; sky++)
        for (int normal = 0; normal < 2; normal++) {
            struct shot shot = {.number = 100, .square = true, .sky = sky};
            reset(gpu, normal ? "normal" : "depth");
            for (int n = 0; n < 4; n++, shot.number++) {
                float *mask = mask_of(gpu, &shot);
                const struct shot before = {.number = shot.number - 1, .square = true};
                for (int i = 0; i < W * H; i++) {
                    const bool hidden = !on_square(&shot, i % W, i / W) && on_square(&before, i % W, i / W);
                    if (mask[i] != (n == 0 || hidden ? 1.0f : 0.0f))
                        fail_msg("frame %d, pixel %d,%d: %g", n, i % W, i / W, (double)mask[i]);
                }
                free(mask);
            }
        }
}

/* A plane at any angle, and a still edge, under jitter: nothing was hidden. Catches: a tolerance that is too small for the slope. */
static void a_still_picture_hides_nothing(void **state) {
    struct gpu *gpu = *state;
    struct shot shot = {.number = 200, .floor = true};
    reset(gpu, "depth");
    for (int n = 0; n < 9; n++, shot.number++) {
        memcpy(shot.previous_jitter_px, shot.jitter_px, sizeof shot.jitter_px);
        shot.jitter_px[0] = n % 3 * 0.45 - 0.45, shot.jitter_px[1] = n / 3 * 0.45 - 0.45;
        float *mask = mask_of(gpu, &shot);
        for (int i = 0; n > 0 && i < W * H; i++)
            if (mask[i] != 0) fail_msg("frame %d, pixel %d,%d: %g", n, i % W, i / W, (double)mask[i]);
        free(mask);
    }
}

/* Jitter shows the wall or the square beside its edges, and hides neither. Without the test of what moved together the wall counts as hidden. */
static void edges_of_a_still_picture_hide_nothing(void **state) {
    struct gpu *gpu = *state;
    for (int off = 0; off < 2; off++) {
        struct shot shot = {.number = 600u + 100u * (uint32_t)off, .still = true};
        int hidden = 0;
        reset(gpu, "depth");
        if (off) gpu_set(gpu, "disocclusion.together=0");
        for (int n = 0; n < 9; n++, shot.number++) {
            memcpy(shot.previous_jitter_px, shot.jitter_px, sizeof shot.jitter_px);
            shot.jitter_px[0] = n % 3 * 0.45 - 0.45, shot.jitter_px[1] = n / 3 * 0.45 - 0.45;
            float *mask = mask_of(gpu, &shot);
            for (int i = 0; n > 0 && i < W * H; i++) hidden += mask[i] > 0;
            free(mask);
        }
        assert_true(off ? hidden > 10 : hidden == 0);
    }
}

/* Whether a pixel reflects the surroundings, which are the same in every frame; a device may weigh their texels with eight bits. */
static bool is_even(const float *reflected) {
    return fabs((double)reflected[0] - 7) <= 7.0 / 256;
}

/* Of a mirror's filter: where the square was, the reflection of this frame alone. Without the test of hidden history the square's reflection remains.
   Catches: a mask that the filter does not read, or reads elsewhere. */
static void a_mirror_has_no_history_of_what_stood_before_it(void **state) {
    struct gpu *gpu = *state;
    for (int off = 0; off < 2; off++) {
        struct shot shot = {.number = 300u + 100u * (uint32_t)off, .square = true, .floor = true, .mirror = true};
        size_t hidden = 0, lit = 0, alone = 0, others = 0;
        gpu_reset(gpu);
        gpu_use(gpu, "disocclusion=depth");
        gpu_use(gpu, "temporal_sharp=clamped");
        gpu_set(gpu, "temporal_sharp.clamp_history=false");
        if (off) gpu_set(gpu, "temporal_sharp.uncovered=1.01");
        for (int n = 0; n < 3; n++, shot.number++) free(mask_of(gpu, &shot));
        float *mask = mask_of(gpu, &shot), *stable = gpu_floats(gpu, "reflection_stable", NULL, NULL),
              *now = gpu_floats(gpu, "reflection", NULL, NULL);
        for (size_t i = 0; i < W * H; i++) {
            const bool same = !memcmp(stable + 4 * i, now + 4 * i, 3 * sizeof *now);
            hidden += mask[i] == 1;
            if (is_even(now + 4 * i)) continue;
            if (mask[i] == 1) lit++, alone += same;
            else others += !same;
        }
        print_message("# %s the test: %zu of %zu hidden pixels show this frame alone, %zu others do not\n",
                      off ? "without" : "with", alone, lit, others);
        assert_true(hidden == 15 && lit > 3 && others > 100 && alone == (off ? 0 : lit));
        free(mask), free(stable), free(now);
    }
}

/* Where a still picture shows another surface in part, as jitter does at edges, a mirror keeps its history. */
static void a_still_mirror_keeps_its_history_at_edges(void **state) {
    struct gpu *gpu = *state;
    struct shot shot = {.number = 800, .still = true, .floor = true, .mirror = true};
    size_t partly = 0, alone = 0;
    gpu_reset(gpu);
    gpu_use(gpu, "disocclusion=depth");
    gpu_set(gpu, "disocclusion.together=0");
    gpu_use(gpu, "temporal_sharp=clamped");
    gpu_set(gpu, "temporal_sharp.clamp_history=false");
    for (int n = 0; n < 6; n++, shot.number++) {
        memcpy(shot.previous_jitter_px, shot.jitter_px, sizeof shot.jitter_px);
        shot.jitter_px[0] = n % 3 * 0.45 - 0.45;
        float *mask = mask_of(gpu, &shot);
        if (n < 2) { /* without a history the filter is left out */
            free(mask);
            continue;
        }
        float *stable = gpu_floats(gpu, "reflection_stable", NULL, NULL),
              *now = gpu_floats(gpu, "reflection", NULL, NULL);
        for (size_t i = 0; i < W * H; i++)
            if (mask[i] >= 0.1F && mask[i] < 1)
                partly++, alone += !memcmp(stable + 4 * i, now + 4 * i, 3 * sizeof *now);
        free(mask), free(stable), free(now);
    }
    print_message("# of %zu pixels that were hidden in part %zu show this frame alone\n", partly, alone);
    assert_true(partly > 5 && alone < partly - 3); /* what reflects the even surroundings is the same in every frame */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_the_square_left_was_hidden),
        cmocka_unit_test(a_still_picture_hides_nothing),
        cmocka_unit_test(edges_of_a_still_picture_hide_nothing),
        cmocka_unit_test(a_mirror_has_no_history_of_what_stood_before_it),
        cmocka_unit_test(a_still_mirror_keeps_its_history_at_edges),
    };
    return cmocka_run_group_tests(tests, gpu_set_up, gpu_tear_down);
}
