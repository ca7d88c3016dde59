/* Runs that are given up between two passes: the replay stays as good as a new one, for the same frame and for the next ones of a shot. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "unit.h"

enum { PLENTY = 64 << 20, PIPELINES = 6, OPTIONS = 5 };

/* Presets and assignments; the first two share most of their work. */
static const char *const pipelines[PIPELINES][4] = {{"mafia3"},
                                                    {"mafia3", "upscale=bilinear", "cubemap_trace.steps_hq=7"},
                                                    {"kf2", "screen_trace=dda"},
                                                    {"gtav"},
                                                    {"mafia_de"},
                                                    {"mafia3", "pipeline.rays=2"}};

static struct glint_pipeline *make_pipeline(size_t i) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create(pipelines[i][0], &err);
    if (!pipeline) fail_msg("%s", err.message);
    for (size_t k = 1; k < 4 && pipelines[i][k]; k++) {
        const char *one = pipelines[i][k], *dot = strchr(one, '.');
        if (!(dot && dot < strchr(one, '=') ? glint_pipeline_set : glint_pipeline_use)(pipeline, one, &err))
            fail_msg("%s", err.message);
    }
    return pipeline;
}

static const char *const few[] = {"composed", "depth_half", NULL}, *const half[] = {"depth_half", NULL};
static const struct glint_replay_options all_options[OPTIONS] = {{.keep_bytes = PLENTY},
                                                                 {.diagnostics = true, .keep_bytes = PLENTY},
                                                                 {.outputs = few},
                                                                 {.keep_bytes = 0},
                                                                 {.outputs = half, .repeat = 2}};

static uint32_t random_below(uint32_t *state, uint32_t end) {
    *state = *state * 1664525 + 1013904223;
    return (*state >> 8) % end;
}

/* Stops at the call of this number. */
struct stop {
    uint32_t at, calls;
};

static bool stop_at(void *user, const char *what, double done) {
    struct stop *stop = user;
    (void)what, (void)done;
    return stop->calls++ < stop->at;
}

static void run_whole(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                      const struct glint_replay_options *options) {
    struct glint_error err = {0};
    struct stop never = {UINT32_MAX, 0};
    if (!glint_replay_run(replay, pipeline, options, stop_at, &never, &err)) fail_msg("%s", err.message);
}

/* Begins a run and gives it up at its `at`-th report; false if it was complete before. */
static bool run_partly(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                       const struct glint_replay_options *options, uint32_t at) {
    struct glint_error err = {0};
    struct stop stop = {at, 0};
    size_t count;
    if (glint_replay_run(replay, pipeline, options, stop_at, &stop, &err)) return false;
    if (err.code != GLINT_ERROR_INTERRUPTED) fail_msg("%s", err.message);
    assert_int_equal(glint_replay_image_count(replay), 0);
    glint_replay_results(replay, &count);
    assert_int_equal(count, 0);
    return true;
}

static void *read_image(struct glint_replay *replay, const struct glint_image *image, size_t *bytes) {
    static const enum glint_type types[] = {
        [GLINT_FORMAT_R8UI] = GLINT_U8,   [GLINT_FORMAT_R32UI] = GLINT_U32,   [GLINT_FORMAT_R16F] = GLINT_F16,
        [GLINT_FORMAT_RG16F] = GLINT_F16, [GLINT_FORMAT_RGBA16F] = GLINT_F16, [GLINT_FORMAT_R32F] = GLINT_F32,
        [GLINT_FORMAT_RG32F] = GLINT_F32, [GLINT_FORMAT_RGBA32F] = GLINT_F32};
    struct glint_error err = {0};
    const enum glint_type type = types[image->format];
    *bytes = (size_t)image->width * image->height * image->components *
             (type == GLINT_U8    ? 1
              : type == GLINT_F16 ? 2
                                  : 4);
    void *data = malloc(*bytes + 1);
    if (!data || !glint_replay_read_image(replay, image, type, data, &err)) fail_msg("%s", err.message);
    return data;
}

/* All images of the last run of two replays have the same bits; returns how many. */
static size_t expect_same(struct glint_replay *found, struct glint_replay *expected) {
    const size_t count = glint_replay_image_count(expected);
    assert_int_equal(glint_replay_image_count(found), count);
    for (size_t i = 0; i < count; i++) {
        const struct glint_image *from = glint_replay_image(expected, i),
                                 *to = glint_replay_find_image(found, from->name);
        size_t bytes[2];
        if (!to) fail_msg("no image %s", from->name);
        void *a = read_image(expected, from, &bytes[0]), *b = read_image(found, to, &bytes[1]);
        assert_int_equal(bytes[0], bytes[1]);
        if (memcmp(a, b, bytes[0])) fail_msg("image %s differs", from->name);
        free(a);
        free(b);
    }
    return count;
}

static struct glint_replay *loaded(struct fixture *fixture, struct glint_capture *capture) {
    struct glint_error err = {0};
    struct glint_replay *replay = glint_replay_create(fixture->device, &err);
    if (!replay || (capture && !glint_replay_load(replay, capture, &err))) fail_msg("%s", err.message);
    return replay;
}

/* Catches: images that a run which was given up has half overwritten, and that count as up to date; memory that images share, taken for an image's own;
   layouts and barriers of commands that were recorded and never executed. */
static void what_follows_a_run_that_was_given_up_is_as_new(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_pipeline *made[PIPELINES];
    struct glint_replay *replay = loaded(fixture, fixture->capture), *fresh[PIPELINES][OPTIONS] = {{NULL}};
    uint32_t seed = 1, stopped = 0;
    size_t images = 0;
    for (size_t i = 0; i < PIPELINES; i++) made[i] = make_pipeline(i);
    for (int turn = 0; turn < 40; turn++) {
        for (uint32_t times = 1 + random_below(&seed, 2); times > 0; times--)
            stopped += run_partly(replay, made[random_below(&seed, PIPELINES)],
                                  &all_options[random_below(&seed, OPTIONS)], random_below(&seed, 24));
        const uint32_t p = random_below(&seed, PIPELINES), o = random_below(&seed, OPTIONS);
        if (!fresh[p][o]) {
            fresh[p][o] = loaded(fixture, fixture->capture);
            run_whole(fresh[p][o], made[p], &all_options[o]);
        }
        run_whole(replay, made[p], &all_options[o]);
        images += expect_same(replay, fresh[p][o]);
    }
    print_message("# %u runs were given up, %zu images compared\n", stopped, images);
    assert_true(stopped > 20 && images > 500);
    for (size_t i = 0; i < PIPELINES; i++) {
        for (size_t k = 0; k < OPTIONS; k++)
            if (fresh[i][k]) glint_replay_destroy(&fresh[i][k]);
        glint_pipeline_destroy(&made[i]);
    }
    glint_replay_destroy(&replay);
    fixture_check_messages(fixture);
}

/* ---- Shots ---- */

static struct glint_capture *frame_capture(struct fixture *fixture, uint32_t number, bool cut) {
    struct glint_error err = {0};
    char path[128];
    snprintf(path, sizeof path, "%s/interrupted%u.exr", fixture->folder, number);
    if (!fixture_write_capture(path, &(struct fixture_options){.number = number, .cut = cut}, &err))
        fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

static bool ran(struct glint_replay *replay, const char *slot) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t i = 0; i < count; i++)
        if (!strcmp(results[i].pass->slot, slot)) return results[i].ran;
    return false;
}

/* One pipeline is the shot's, in lineage 1; others come in between, in lineages of their own, complete or not, and so do runs of the shot's lineage
   that are given up before its own one. `keep`: memory for them. */
static void play_shot(struct fixture *fixture, size_t shot, uint64_t keep, uint32_t *seed) {
    enum { FRAMES = 5 };
    struct glint_error err = {0};
    struct glint_pipeline *made[PIPELINES];
    struct glint_replay *replay = loaded(fixture, NULL), *alone = loaded(fixture, NULL);
    bool remembered = false;
    for (size_t i = 0; i < PIPELINES; i++) made[i] = make_pipeline(i);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        struct glint_capture *captures[2] = {frame_capture(fixture, 30 + frame, frame == 3), NULL};
        captures[1] = frame_capture(fixture, 30 + frame, frame == 3);
        if (!glint_replay_load(replay, captures[0], &err) || !glint_replay_load(alone, captures[1], &err))
            fail_msg("%s", err.message);
        const struct glint_replay_options own = {.lineage = 1, .keep_bytes = keep, .diagnostics = frame % 2};
        for (int after = 0; after < 2; after++) {
            for (uint32_t times = random_below(seed, 3); times > 0; times--) {
                const uint32_t other = random_below(seed, PIPELINES), lineage = random_below(seed, 2) ? 2 + other : 1;
                const struct glint_replay_options theirs = {
                    .lineage = after && lineage == 1 ? 9 : lineage, .keep_bytes = keep, .diagnostics = times % 2};
                if (random_below(seed, 3) == 0 && theirs.lineage != 1) run_whole(replay, made[other], &theirs);
                else run_partly(replay, made[other], &theirs, random_below(seed, 20));
            }
            if (after) continue;
            if (random_below(seed, 2)) { /* given up after a complete run of the same lineage: it has to run again */
                run_whole(replay, made[shot], &own);
                run_partly(replay, made[random_below(seed, PIPELINES)], &own, random_below(seed, 20));
            }
            run_whole(replay, made[shot], &own);
            run_whole(alone, made[shot], &(struct glint_replay_options){.diagnostics = frame % 2});
            expect_same(replay, alone);
            remembered |= ran(replay, "temporal");
            run_whole(replay, made[shot], &own); /* once more: its history is still that of the frame before */
            expect_same(replay, alone);
        }
        glint_replay_load(replay, NULL, NULL);
        glint_replay_load(alone, NULL, NULL);
        glint_capture_close(&captures[0]);
        glint_capture_close(&captures[1]);
    }
    print_message("# %s%s: the pass temporal ran: %d\n", pipelines[shot][0], pipelines[shot][1] ? ", changed" : "",
                  remembered);
    assert_true(remembered || !strcmp(pipelines[shot][0], "kf2") || !strcmp(pipelines[shot][0], "gtav"));
    for (size_t i = 0; i < PIPELINES; i++) glint_pipeline_destroy(&made[i]);
    glint_replay_destroy(&replay);
    glint_replay_destroy(&alone);
}

/* Catches: history of another pipeline, or of a run that was given up; history that a run in between takes or ends. */
static void history_is_that_of_the_lineage(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    uint32_t seed = 7;
    for (size_t shot = 0; shot < PIPELINES; shot += 2)
        for (uint64_t keep = 0; keep <= PLENTY; keep += PLENTY) play_shot(fixture, shot, keep, &seed);
    fixture_check_messages(fixture);
}

/* A run of the same lineage that is given up after the frame's own one leaves the next frame without history, and not with parts of two. */
static void a_frame_given_up_last_is_no_history(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_pipeline *mafia = make_pipeline(0), *other = make_pipeline(1);
    for (uint32_t at = 0; at < 20; at += 3) {
        struct glint_replay *replay = loaded(fixture, NULL), *fresh = loaded(fixture, NULL);
        struct glint_capture *before = frame_capture(fixture, 50, false), *next = frame_capture(fixture, 51, false);
        struct glint_capture *again = frame_capture(fixture, 51, false);
        assert_true(glint_replay_load(replay, before, &err));
        run_whole(replay, mafia, NULL);
        const bool stopped = run_partly(replay, other, NULL, at);
        assert_true(glint_replay_load(replay, next, &err) && glint_replay_load(fresh, again, &err));
        run_whole(replay, mafia, NULL);
        run_whole(fresh, mafia, NULL);
        if (stopped) expect_same(replay, fresh);
        glint_replay_destroy(&replay);
        glint_replay_destroy(&fresh);
        glint_capture_close(&before);
        glint_capture_close(&next);
        glint_capture_close(&again);
    }
    glint_pipeline_destroy(&mafia);
    glint_pipeline_destroy(&other);
    fixture_check_messages(fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_follows_a_run_that_was_given_up_is_as_new),
        cmocka_unit_test(history_is_that_of_the_lineage),
        cmocka_unit_test(a_frame_given_up_last_is_no_history),
    };
    return cmocka_run_group_tests_name("interrupted", tests, fixture_setup_device, fixture_teardown);
}
