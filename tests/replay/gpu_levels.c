/* Images with levels on a device with validation: written one level at a time, read as a whole. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made.h"
#include "unit.h"

enum { W = FIXTURE_WIDTH, H = FIXTURE_HEIGHT, LEVELS = 6 /* 50 × 31 … 1 × 1 */ };

static int level_size(int size, int level) {
    return size >> level ? size >> level : 1;
}

/* The values of chain.comp in integers below 2^24, which are exact in floats. */
static void expect_chain(int out[LEVELS][H][W]) {
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) out[0][y][x] = x + W * y;
    for (int l = 1; l < LEVELS; l++)
        for (int y = 0; y < level_size(H, l); y++)
            for (int x = 0; x < level_size(W, l); x++) {
                int sum = 0;
                for (int i = 0; i < 4; i++) {
                    const int fx = 2 * x + i % 2, fy = 2 * y + i / 2;
                    const int right = level_size(W, l - 1) - 1, bottom = level_size(H, l - 1) - 1;
                    sum += out[l - 1][fy < bottom ? fy : bottom][fx < right ? fx : right];
                }
                out[l][y][x] = sum % 4093;
            }
    for (int l = LEVELS - 2; l >= 0; l--)
        for (int y = 0; y < level_size(H, l); y++)
            for (int x = 0; x < level_size(W, l); x++) {
                const int right = level_size(W, l + 1) - 1, bottom = level_size(H, l + 1) - 1;
                out[l][y][x] += out[l + 1][y / 2 < bottom ? y / 2 : bottom][x / 2 < right ? x / 2 : right];
                out[l][y][x] %= 4093;
            }
}

/* Catches: a level written to another one, levels in the wrong order or without a barrier in between, a view with too few levels, and
   sizes that are rounded up. */
static void each_level_comes_from_the_one_before(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    static int expected[LEVELS][H][W];
    struct made made;
    MADE(&made, &made_chain, &made_reader);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    expect_chain(expected);
    for (int l = 0; l < LEVELS; l++) {
        char name[32];
        snprintf(name, sizeof name, l ? "chain.level%d" : "chain", l);
        const struct glint_image *image = glint_replay_find_image(fixture->replay, name);
        assert_non_null(image);
        assert_int_equal(image->level, l);
        assert_int_equal(image->levels, LEVELS);
        assert_int_equal(image->width, level_size(W, l));
        assert_int_equal(image->height, level_size(H, l));
        float *pixels = made_read(fixture, name);
        for (int y = 0; y < level_size(H, l); y++)
            for (int x = 0; x < level_size(W, l); x++)
                if (pixels[y * level_size(W, l) + x] != (float)expected[l][y][x])
                    fail_msg("level %d, pixel %d,%d: expected %d, found %g", l, x, y, expected[l][y][x],
                             (double)pixels[y * level_size(W, l) + x]);
        free(pixels);
    }
    float *seen = made_read(fixture, "seen");
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int i = 0; i < 3; i++) {
                const int right = level_size(W, 2 * i) - 1, bottom = level_size(H, 2 * i) - 1;
                const int fx = x >> 2 * i, fy = y >> 2 * i;
                assert_true(seen[(y * W + x) * 4 + i] ==
                            (float)expected[2 * i][fy < bottom ? fy : bottom][fx < right ? fx : right]);
            }
    assert_true(seen[3] == 5); /* no pass writes cubes: the reader's fallback value */
    free(seen);
    float *beside = made_read(fixture, "beside"); /* written in every phase, the last time in phase 3, at level 0 */
    assert_true(beside[0] == 3);
    free(beside);
    assert_null(glint_replay_find_image(fixture->replay, "chain.level6"));
}

/* Catches: layers in another order than faces, a dispatch that omits layers, a view of only one cube map. */
static void cube_maps_are_written_by_layer_and_read_by_direction(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_pipeline *real = glint_pipeline_create(GLINT_TEST_PRESET, &err);
    const struct glint_pass *active = NULL;
    for (size_t i = 0; i < glint_pipeline_pass_count(real); i++)
        if (strcmp(glint_pipeline_pass(real, i)->slot, "cubemap_active") == 0) active = glint_pipeline_pass(real, i);
    struct made made;
    MADE(&made, &made_chain, active, &made_cubes, &made_reader);
    made.passes[1].shader = NULL; /* it runs on the host */
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    for (int l = 0; l < 4; l++) {
        char name[32];
        snprintf(name, sizeof name, l ? "cubes.level%d" : "cubes", l);
        const int face = FIXTURE_FACE >> l;
        const struct glint_image *image = glint_replay_find_image(fixture->replay, name);
        assert_non_null(image);
        assert_int_equal(image->height, face * 6 * FIXTURE_CUBEMAPS);
        float *pixels = made_read(fixture, name);
        for (int y = 0; y < face * 6 * FIXTURE_CUBEMAPS; y++)
            for (int x = 0; x < face; x++) assert_true(pixels[y * face + x] == (float)(y / face + 1000 * l));
        free(pixels);
    }
    assert_true(fixture_result(fixture, "cubes")->cached_work); /* it processes only cube maps */
    assert_false(fixture_result(fixture, "chain")->cached_work);
    assert_false(fixture_result(fixture, "reader")->cached_work);
    float *seen = made_read(fixture, "seen");
    assert_true(seen[3] == 1006);
    free(seen);
    made_check_cuts(fixture, &made, (struct glint_replay_options){.diagnostics = true});
    glint_pipeline_destroy(&real);
    fixture_check_messages(fixture);
}

/* Catches: levels that a run folder omits, swaps or cannot restore. */
static void every_cut_of_levels_gives_the_bits_of_the_whole(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made;
    MADE(&made, &made_chain, &made_reader);
    made_check_cuts(fixture, &made, (struct glint_replay_options){0});
    made_check_cuts(fixture, &made, (struct glint_replay_options){.float_precision = true});
}

/* Catches: levels missing in the size of aliased memory, and keys that omit levels. */
static void levels_are_kept_and_share_memory_as_images_do(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const outputs[] = {"seen", NULL};
    struct made made;
    struct snapshot whole, part;
    MADE(&made, &made_chain, &made_reader);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&whole, fixture->replay);
    made_run(fixture, &made, NULL);
    assert_true(fixture_result(fixture, "chain")->cached);
    made_run(fixture, &made, &(struct glint_replay_options){.outputs = outputs, .repeat = 2});
    snapshot_take(&part, fixture->replay);
    assert_int_equal(snapshot_compare(&part, &whole), 1);
    snapshot_free(&whole), snapshot_free(&part);
}

/* Catches: a run that accepts an incomplete or foreign set of levels. */
static void a_missing_level_is_named(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const char *const passes[] = {"reader", NULL};
    char folder[128], path[192], command[512];
    struct made made;
    MADE(&made, &made_chain, &made_reader);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    fixture_write_run(fixture, "levels", folder);
    snprintf(path, sizeof path, "%s/run.json", folder);
    snprintf(command, sizeof command, "sed -i 's/\"name\": \"chain.level3\"/\"name\": \"other\"/' %s", path);
    assert_int_equal(system(command), 0);
    assert_false(glint_replay_run(fixture->replay, &made.pipeline,
                                  &(struct glint_replay_options){.passes = passes, .inputs = folder}, NULL, NULL,
                                  &err));
    fixture_says(&err, "image chain.level3");
}

/* Catches: an engine's chain that is reduced to its finest level, or one that misses a level. */
static void an_engines_chain_replaces_a_pass(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const char *const last[] = {"reader", NULL};
    struct glint_part parts[LEVELS];
    struct glint_channel channels[LEVELS];
    char names[LEVELS][64], path[128];
    struct made made;
    MADE(&made, &made_chain, &made_reader);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    float *seen = made_read(fixture, "seen");
    for (int l = 0; l < LEVELS; l++) {
        snprintf(names[l], sizeof names[l], l ? "engine.chain.chain.level%d" : "engine.chain.chain", l);
        channels[l] = (struct glint_channel){
            .name = "Z", .type = GLINT_F32, .data = made_read(fixture, names[l] + strlen("engine.chain."))};
        parts[l] = (struct glint_part){.name = names[l],
                                       .width = (uint32_t)level_size(W, l),
                                       .height = (uint32_t)level_size(H, l),
                                       .channels = &channels[l],
                                       .channel_count = 1};
    }
    snprintf(path, sizeof path, "%s/engine.exr", fixture->folder);
    for (int missing = 0; missing < 2; missing++) {
        const struct fixture_options options = {.extra = parts, .extra_count = LEVELS - (size_t)missing};
        if (!fixture_write_capture(path, &options, &err)) fail_msg("%s", err.message);
        struct glint_capture *capture = glint_capture_open(path, NULL, &err);
        assert_non_null(capture);
        assert_true(glint_replay_load(fixture->replay, capture, &err));
        if (missing) {
            assert_false(glint_replay_run(fixture->replay, &made.pipeline,
                                          &(struct glint_replay_options){.passes = last}, NULL, NULL, &err));
            fixture_says(&err, "part engine.chain.chain.level5: expected 1 x 1, found 0 x 0");
        } else {
            made_run(fixture, &made, &(struct glint_replay_options){.passes = last});
            float *again = made_read(fixture, "seen");
            assert_memory_equal(seen, again, sizeof(float) * W * H * 4);
            free(again);
        }
        assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
        glint_capture_close(&capture);
    }
    for (int l = 0; l < LEVELS; l++) free((void *)channels[l].data);
    free(seen);
    fixture_check_messages(fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_level_comes_from_the_one_before),
        cmocka_unit_test(cube_maps_are_written_by_layer_and_read_by_direction),
        cmocka_unit_test(every_cut_of_levels_gives_the_bits_of_the_whole),
        cmocka_unit_test(levels_are_kept_and_share_memory_as_images_do),
        cmocka_unit_test(a_missing_level_is_named),
        cmocka_unit_test(an_engines_chain_replaces_a_pass),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
