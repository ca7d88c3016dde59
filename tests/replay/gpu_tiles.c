/* Lists of tiles cover everything that the image, a kernel or the next frame reads; wrong lists are detected. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pair.h"
#include "plain_capture.h"
#include "unit.h"

enum { FACE = 16, TILED_WIDTH = 75, TILED_HEIGHT = 53, TILED_FRAMES = 3, SHIFT = 6 /* SHIFT: pixels per frame */ };

/* Patches of 8 x 8 pixels of every material, different in every frame, and sky; reflections move from tile to tile. */
static void paint_tiles(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    static const float roughness[] = {0.5f, 0, 0.09f, 0.6f, 0.3f, 0.5f};
    for (size_t i = 0; i < pixels; i++) {
        const size_t x = i % plain->width / 8, y = i / plain->width / 8;
        const size_t drawn = (x * 5 + y * 7 + plain->frame * 3) * (x + 11 * (y / 2) + 1) / 3 % 9;
        const size_t patch = y / 2 == plain->frame % 3 ? 0 : drawn; /* sixteen rows without any reflection */
        if (patch == 8) values[PLAIN_DEPTH * pixels + i] = INFINITY;
        values[PLAIN_ROUGHNESS * pixels + i] = patch < 6 ? roughness[patch] : 0;
        values[PLAIN_METALNESS * pixels + i] = 0;
        values[PLAIN_SPECULAR * pixels + i] = patch == 0 || patch > 5 ? 0.0f : 0.5f;
        values[PLAIN_MOTION_X * pixels + i] = (float)SHIFT / (float)plain->width;
        values[PLAIN_MOTION_Y * pixels + i] = (float)SHIFT / (float)plain->height;
    }
}

static struct glint_capture *tiled(const struct fixture *fixture, uint32_t number) {
    struct glint_error err = {0};
    char path[256];
    const struct plain plain = {.width = TILED_WIDTH,
                                .height = TILED_HEIGHT,
                                .fov_y_degrees = 60,
                                .floor = true,
                                .frame = number,
                                .spoil = paint_tiles,
                                .cube_size = FACE,
                                .cube_count = 1,
                                .cube = pair_cube};
    snprintf(path, sizeof path, "%s/tiled.exr", fixture->folder);
    pair_check(plain_write(path, &plain, &err), &err);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    pair_check(capture != NULL, &err);
    return capture;
}

/* Sums up the differences in all frames of the shot; *worked: the fraction of texels in tiles that passes processed. */
static size_t differences_of_tiles(struct pair *pair, double *worked) {
    size_t differ = 0, left_out = 0, passes;
    for (uint32_t frame = 1; frame <= TILED_FRAMES; frame++) {
        struct glint_capture *capture = tiled(pair->fixture, frame);
        differ += pair_differences(pair, capture, &left_out);
        const struct glint_pass_result *results = glint_replay_results(pair->planned, &passes);
        json_t *all = json_object_get(pair->planned->results.record, "passes");
        for (size_t p = 0; p < passes && frame == TILED_FRAMES; p++) {
            if (strcmp(results[p].pass->slot, "resolve") != 0) continue;
            json_t *work = json_object_get(json_array_get(all, p), "work");
            *worked = (double)json_integer_value(json_object_get(work, "texels")) /
                      (double)json_integer_value(json_object_get(work, "of"));
        }
        pair_check(glint_replay_load(pair->planned, NULL, NULL) && glint_replay_load(pair->whole, NULL, NULL), NULL);
        glint_capture_close(&capture);
    }
    return differ;
}

/* Catches: missing tiles that a kernel or the next frame's history reads, tiles of the wrong class, and texels that neither part of the
   list writes. */
static void tiles_leave_nothing_out(void **state) {
    struct pair *pair = pair_of(state);
    static const char *const presets[] = {"mafia3", "mafia_de", "mafia3_shipped"};
    for (size_t p = 0; p < sizeof presets / sizeof *presets; p++) {
        double worked = 0;
        pair_use(pair, presets[p]);
        if (differences_of_tiles(pair, &worked) > 0) fail_msg("%s differs", presets[p]);
        assert_true(worked > 0.2 && worked < 0.8);
    }
    fixture_check_messages(pair->fixture);
}

/* Catches: a comparison that accepts every list. */
static void a_wrong_list_is_found(void **state) {
    struct pair *pair = pair_of(state);
    static const struct {
        const char *name, *right, *wrong;
    } lists[] = {
        {"tiles are half as wide", "if (found != 0u)", "if (found != 0u && texel.x % 16u < 8u)"},
        {"smooth are rough", "roughness <= uintBitsToFloat", "roughness > uintBitsToFloat"},
        {"nothing is rough", "!smooth_one || roughness >= 0.999 *", "roughness >= 99.0 +"},
        {"what is not shown", "if (!shown ||", "if (shown ||"},
        {"the order of kinds", "ROUGH_ALONE = 0u, ROUGH_AND_SMOOTH = 1u", "ROUGH_ALONE = 1u, ROUGH_AND_SMOOTH = 0u"},
        {"a range without its last tile", "range.y - range.x;", "max(range.y - range.x, 1u) - 1u;"},
        {"tiles elsewhere", "uvec4(tile.x |", "uvec4(tile.x + 1u |"},
    };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        double worked;
        pair_use(pair, "mafia3");
        pair_spoil(pair, "classify_tiles", "shown", lists[i].right, lists[i].wrong);
        if (differences_of_tiles(pair, &worked) == 0) fail_msg("a wrong list changes nothing: %s", lists[i].name);
    }
    fixture_check_messages(pair->fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_leave_nothing_out),
        cmocka_unit_test(a_wrong_list_is_found),
    };
    return cmocka_run_group_tests(tests, pair_set_up, pair_tear_down);
}
