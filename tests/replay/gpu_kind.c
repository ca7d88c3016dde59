/* Levels that are written in one dispatch on a GPU and in one each on a CPU (DISPATCH_CHAIN) have the same bits. */
#include <stdio.h>
#include <stdlib.h>

#include "device.h"
#include "fixture.h"
#include "unit.h"

/* One device is treated as what it is, the other one as what it is not. */
struct kinds {
    struct fixture *fixture;
    struct glint_device *device;
    struct glint_replay *replay;
};

static void check(bool ok, const struct glint_error *err) {
    if (!ok) fail_msg("%s", err->message);
}

static int set_up(void **state) {
    static struct kinds kinds;
    void *fixture = NULL;
    struct glint_error err = {0};
    if (fixture_setup_device(&fixture) != 0) return -1;
    kinds.fixture = fixture;
    *state = &kinds;
    if (!kinds.fixture->device) return 0;
    kinds.device =
        glint_device_create(&(struct glint_device_options){.validation = !getenv("GLINT_TEST_UNCHECKED")}, &err);
    if (!kinds.device) return -1;
    kinds.device->gpu.info.is_cpu = !kinds.device->gpu.info.is_cpu;
    kinds.replay = glint_replay_create(kinds.device, &err);
    return kinds.replay ? 0 : -1;
}

static int tear_down(void **state) {
    struct kinds *kinds = *state;
    void *fixture = kinds->fixture;
    glint_replay_destroy(&kinds->replay);
    if (kinds->device) glint_device_destroy(&kinds->device);
    return fixture_teardown(&fixture);
}

static void take(struct glint_replay *replay, struct glint_capture *capture, const struct glint_pipeline *pipeline,
                 struct snapshot *images) {
    static const char *const outputs[] = {"hiz", "depth_slopes", NULL};
    struct glint_error err = {0};
    check(glint_replay_load(replay, capture, &err) &&
              glint_replay_run(replay, pipeline, &(struct glint_replay_options){.outputs = outputs}, NULL, NULL, &err),
          &err);
    snapshot_take(images, replay);
}

static void compare(struct kinds *kinds, struct glint_capture *capture, const char *downsample) {
    struct glint_error err = {0};
    struct snapshot real = {0}, other = {0};
    const char *last;
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia3", &err);
    check(pipeline && glint_pipeline_use(pipeline, "screen_trace=hiz", &err) &&
              glint_pipeline_use(pipeline, downsample, &err),
          &err);
    take(kinds->fixture->replay, capture, pipeline, &real);
    take(kinds->replay, capture, pipeline, &other);
    assert_int_equal(real.count, other.count);
    assert_true(snapshot_compare(&other, &real) == real.count && real.count >= 2);
    snapshot_free(&real), snapshot_free(&other);
    glint_pipeline_destroy(&pipeline);
    fixture_check_messages(kinds->fixture);
    if (glint_device_messages(kinds->device, &last) > 0) fail_msg("%s", last);
}

/* At 50 × 31 the last tile has 18 × 31 of 16 × 16 cells, and the sixth level has a dispatch of its own; at half of it, 25 × 16, rounded up, a tile
   has 25 × 16. Catches: cells of the last tile left out or taken from outside, a third child forgotten. */
static void both_kinds_give_the_same_bits(void **state) {
    struct kinds *kinds = *state;
    void *fixture = kinds->fixture;
    fixture_need_device(&fixture);
    compare(kinds, kinds->fixture->capture, "downsample=none");
    compare(kinds, kinds->fixture->capture, "downsample=pick");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(both_kinds_give_the_same_bits)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
