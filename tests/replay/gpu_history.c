/* Shots on a device with validation: history of passes, and results that are kept between frames. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made.h"
#include "unit.h"

enum { W = FIXTURE_WIDTH, H = FIXTURE_HEIGHT, PIXEL = (H - 1) * W + 7 /* floor, not sky */ };

/* Writes a frame beside the fixture's capture and loads it. */
static struct glint_capture *load_frame(struct fixture *fixture, const struct fixture_options *frame) {
    struct glint_error err = {0};
    char path[128];
    snprintf(path, sizeof path, "%s/frame%u.exr", fixture->folder, frame->number);
    if (!fixture_write_capture(path, frame, &err)) fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture || !glint_replay_load(fixture->replay, capture, &err)) fail_msg("%s", err.message);
    return capture;
}

static void unload_frame(struct fixture *fixture, struct glint_capture *capture) {
    assert_true(glint_replay_load(fixture->replay, NULL, NULL));
    glint_capture_close(&capture);
}

struct remembered {
    float frames, valid, depth, level;
};
static struct remembered remembered(struct fixture *fixture) {
    float *sum = made_read(fixture, "sum");
    const struct remembered at = {sum[4 * PIXEL], sum[4 * PIXEL + 1], sum[4 * PIXEL + 2], sum[4 * PIXEL + 3]};
    free(sum);
    return at;
}

static float depth_now(struct fixture *fixture) {
    float *depths = made_read(fixture, "depth_now");
    const float depth = depths[PIXEL];
    free(depths);
    return depth;
}

/* Catches: history of the current frame or of two frames before, history across a cut or a gap, missing levels, and a valid flag that
   is wrong. */
static void a_shot_remembers_and_a_cut_forgets(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    static const struct {
        uint32_t number;
        bool cut;
        float frames;
    } shot[] = {{20, false, 1}, {21, false, 2}, {22, false, 3}, {23, true, 1},
                {24, false, 2}, {26, false, 1}, {26, false, 1}, {27, false, 2}};
    struct made made;
    float before = 0, level = 0;
    MADE(&made, &made_chain, &made_memory);
    for (size_t i = 0; i < sizeof shot / sizeof shot[0]; i++) {
        struct glint_capture *capture =
            load_frame(fixture, &(struct fixture_options){.number = shot[i].number, .cut = shot[i].cut});
        for (size_t r = 0; r < made_chain.row_count; r++) /* a different chain in each frame */
            if (strcmp(made_chain.rows[r].name, "factor") == 0) made.values[0][r] = 1 + (double)i / 4;
        made_run(fixture, &made, NULL);
        const struct remembered at = remembered(fixture);
        const bool valid = shot[i].frames > 1;
        assert_true(at.valid == (valid ? 1.0f : 0.0f));
        assert_true(at.frames == shot[i].frames + 0.5f); /* 0.5: without history */
        if (valid) {
            assert_true(at.depth == before);
            assert_true(at.level == level);
        } else assert_true(isinf(at.depth)); /* the fallback value of depth_now */
        assert_true(depth_now(fixture) != before);
        before = depth_now(fixture);
        float *chain = made_read(fixture, "chain.level2");
        const int x = PIXEL % W / 4, y = PIXEL / W / 4 < H / 4 ? PIXEL / W / 4 : H / 4 - 1;
        level = chain[y * (W / 4) + x];
        free(chain);
        unload_frame(fixture, capture);
        if (i == 5) before = 0; /* the same frame again */
    }
}

/* Catches: history that advances when a frame is repeated, and keys that omit history. */
static void a_frame_run_twice_has_the_same_history(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made;
    MADE(&made, &made_chain, &made_memory);
    unload_frame(fixture,
                 load_frame(fixture, &(struct fixture_options){.number = 40})); /* removes history of other tests */
    for (uint32_t number = 41; number < 44; number++) {
        struct glint_capture *capture = load_frame(fixture, &(struct fixture_options){.number = number});
        made_run(fixture, &made, NULL);
        assert_false(fixture_result(fixture, "memory")->cached);
        made_run(fixture, &made, NULL);
        assert_true(fixture_result(fixture, "memory")->cached);
        made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .repeat = 3});
        assert_true(remembered(fixture).frames == (float)(number - 40) + 0.5f);
        unload_frame(fixture, capture);
    }
}

/* Catches: history of another pipeline on the same replay, or history that another pipeline's run evicts. */
static void lineages_remember_their_own(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made[2];
    struct remembered alone[2][3];
    for (int m = 0; m < 2; m++) {
        MADE(&made[m], &made_chain, &made_memory);
        for (size_t r = 0; r < made_chain.row_count; r++)
            if (strcmp(made_chain.rows[r].name, "factor") == 0) made[m].values[0][r] = 1 + m;
    }
    unload_frame(fixture, load_frame(fixture, &(struct fixture_options){.number = 30}));
    for (int m = 0; m < 3; m++) /* each alone, then alternating */
        for (uint32_t i = 0; i < 3; i++) {
            struct glint_capture *capture =
                load_frame(fixture, &(struct fixture_options){.number = 31 + 5 * (uint32_t)m + i});
            for (uint32_t k = 0; k < 2; k++) {
                const struct glint_replay_options options = {.lineage = k, .keep_bytes = m == 2 ? i : 0};
                if (m < 2 && k != (uint32_t)m) continue;
                made_run(fixture, &made[k], &options);
                const struct remembered at = remembered(fixture);
                if (m < 2) alone[m][i] = at;
                else
                    assert_true(at.frames == alone[k][i].frames && at.valid == alone[k][i].valid &&
                                at.level == alone[k][i].level);
            }
            unload_frame(fixture, capture);
        }
    assert_true(alone[0][2].frames == 3.5f && alone[0][2].level != alone[1][2].level);
}

/* Catches: requested outputs that release images which the next frame needs, or that alias them. */
static void what_is_remembered_is_kept_though_nobody_asks_for_it(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const outputs[] = {"depth_now", NULL}, *const sum[] = {"sum", NULL};
    struct made made;
    MADE(&made, &made_chain, &made_memory);
    for (uint32_t number = 51; number < 54; number++) {
        struct glint_capture *capture = load_frame(fixture, &(struct fixture_options){.number = number});
        made_run(fixture, &made, &(struct glint_replay_options){.outputs = number == 53 ? sum : outputs, .repeat = 2});
        if (number == 53) assert_true(remembered(fixture).frames == 3.5f && remembered(fixture).level != 0);
        unload_frame(fixture, capture);
    }
}

/* Catches: a frame replayed alone, or part of it, that differs from the frame in its shot; history that is taken from the device
   although a folder was specified. */
static void a_frame_alone_has_the_bits_of_its_shot(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct made made;
    struct snapshot whole, alone;
    char folders[3][128];
    MADE(&made, &made_chain, &made_memory);
    for (uint32_t i = 0; i < 3; i++) {
        struct glint_capture *capture = load_frame(fixture, &(struct fixture_options){.number = 61 + i});
        char name[16];
        made_run(fixture, &made, NULL);
        snprintf(name, sizeof name, "shot%u", i);
        fixture_write_run(fixture, name, folders[i]);
        if (i == 2) {
            snapshot_take(&whole, fixture->replay);
            made_check_cuts(fixture, &made, (struct glint_replay_options){.history = folders[1]});
            made_run(fixture, &made, &(struct glint_replay_options){.history = folders[1]});
            assert_false(glint_replay_write(fixture->replay, folders[1], NULL, NULL, &err));
            fixture_says(&err, "expected another folder");
            err = (struct glint_error){0};
            assert_false(glint_replay_run(fixture->replay, &made.pipeline,
                                          &(struct glint_replay_options){.history = folders[0]}, NULL, NULL, &err));
            fixture_says(&err, "expected frame 62, the one before, found frame 61");
        }
        unload_frame(fixture, capture);
    }
    struct glint_capture *capture = load_frame(fixture, &(struct fixture_options){.number = 63});
    made_run(fixture, &made, NULL);
    assert_true(remembered(fixture).valid == 0); /* the previous frame was 63, too */
    made_run(fixture, &made, &(struct glint_replay_options){.history = folders[1]});
    snapshot_take(&alone, fixture->replay);
    assert_true(snapshot_compare(&alone, &whole) == whole.count);
    snapshot_free(&whole), snapshot_free(&alone);
    unload_frame(fixture, capture);
}

/* Catches: cube maps that are processed again in each frame of a shot, and changed ones that are not. */
static void cube_maps_in_a_file_of_their_own_are_worked_on_once(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char path[128];
    struct made made;
    MADE(&made, glint_pass_find("cubemap_active", "nearest"), &made_cubes, &made_chain);
    struct pipeline_pass swap = made.passes[1]; /* sorted by slot */
    made.passes[0].shader = NULL;
    made.passes[1] = made.passes[2], made.passes[2] = swap;
    for (int i = 0; i < 4; i++) {
        snprintf(path, sizeof path, "%s/cubes.exr", fixture->folder);
        if (i % 3 == 0 && !fixture_write_cubemaps(path, i, &err))
            fail_msg("%s", err.message); /* the last frame has other cube maps */
        struct glint_capture *capture =
            load_frame(fixture, &(struct fixture_options){.number = 71 + (uint32_t)i, .cubemaps = "cubes.exr"});
        made_run(fixture, &made, NULL);
        assert_int_equal(fixture_result(fixture, "cubes")->cached, i == 1 || i == 2);
        assert_true(fixture_result(fixture, "cubes")->cached_work);
        assert_false(fixture_result(fixture, "chain")->cached);
        unload_frame(fixture, capture);
    }
}

/* Catches: history that exists in a shot but not in a run folder, which contains no images of the capture. */
static void images_of_the_capture_are_not_remembered(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_row rows[16];
    struct glint_pass pass = made_memory;
    struct made made;
    memcpy(rows, made_memory.rows, made_memory.row_count * sizeof *rows);
    for (size_t r = 0; r < made_memory.row_count; r++)
        if (rows[r].kind == GLINT_ROW_HISTORY) rows[r].image = "depth_full";
    pass.rows = rows;
    MADE(&made, &made_chain, &pass);
    assert_false(glint_replay_run(fixture->replay, &made.pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "memory/made declares a history of depth_full, an image of the capture");
}

static int restore(void **state) {
    struct fixture *fixture = *state;
    struct glint_error err = {0};
    return !fixture->device || glint_replay_load(fixture->replay, fixture->capture, &err) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(a_shot_remembers_and_a_cut_forgets, restore),
        cmocka_unit_test_teardown(a_frame_run_twice_has_the_same_history, restore),
        cmocka_unit_test_teardown(lineages_remember_their_own, restore),
        cmocka_unit_test_teardown(what_is_remembered_is_kept_though_nobody_asks_for_it, restore),
        cmocka_unit_test_teardown(a_frame_alone_has_the_bits_of_its_shot, restore),
        cmocka_unit_test_teardown(cube_maps_in_a_file_of_their_own_are_worked_on_once, restore),
        cmocka_unit_test(images_of_the_capture_are_not_remembered),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
