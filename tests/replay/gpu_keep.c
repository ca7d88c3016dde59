/* Alternating pipelines on one replay: each finds its own images again, and only what changed runs. */
#include <stdio.h>
#include <string.h>

#include "fixture.h"
#include "session.h"
#include "unit.h"

enum { PLENTY = 64 << 20 };

/* The fixture's pipeline with assignments: "slot=variant", or "slot.parameter=value". */
static struct glint_pipeline *changed_pipeline(const struct fixture *fixture, const char *const *assignments) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_copy(fixture->pipeline, &err);
    assert_non_null(pipeline);
    for (; assignments && *assignments; assignments++) {
        const char *dot = strchr(*assignments, '.');
        bool ok = dot && dot < strchr(*assignments, '=') ? glint_pipeline_set(pipeline, *assignments, &err)
                                                         : glint_pipeline_use(pipeline, *assignments, &err);
        if (!ok) fail_msg("%s", err.message);
    }
    return pipeline;
}

static struct glint_replay *loaded(struct fixture *fixture) {
    struct glint_error err = {0};
    struct glint_replay *replay = glint_replay_create(fixture->device, &err);
    if (!replay || !glint_replay_load(replay, fixture->capture, &err)) fail_msg("%s", err.message);
    return replay;
}

static void run_pipeline(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                         const struct glint_replay_options *options) {
    struct glint_error err = {0};
    if (!glint_replay_run(replay, pipeline, options, NULL, NULL, &err)) fail_msg("%s", err.message);
}

/* The executed slots in order, each followed by a blank. */
static const char *executed_slots(struct glint_replay *replay) {
    static char text[512];
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    text[0] = 0;
    for (size_t i = 0; i < count; i++)
        if (results[i].ran && !results[i].cached && !results[i].pass->host) {
            strcat(text, results[i].pass->slot);
            strcat(text, " ");
        }
    return text;
}

/* The bits equal those of a replay without images of other pipelines; `fresh` runs everything. */
static void check_fresh(struct glint_replay *fresh, struct glint_replay *replay,
                        const struct glint_pipeline *pipeline) {
    struct snapshot found, expected;
    run_pipeline(fresh, pipeline, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&expected, fresh);
    snapshot_take(&found, replay);
    assert_int_equal(found.count, expected.count);
    assert_true(snapshot_compare(&found, &expected) > 10);
    snapshot_free(&expected), snapshot_free(&found);
}

static uint64_t spare_bytes(const struct glint_replay *replay) {
    uint64_t bytes = 0;
    for (const struct pooled *image = replay->pool.images; image; image = image->next)
        bytes += image->used ? 0 : pooled_bytes(image);
    return bytes;
}

static const char late[] = "screen_trace cubemap_select cubemap_trace resolve upscale compose ";

/* Catches: images of another variant that are reused, images that another pipeline evicts, captures that are read again, and passes
   that run again although nothing changed. */
static void pipelines_that_take_turns_find_their_own(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    static const char *const other[] = {"screen_trace=dda", "cubemap_trace=box", "blur=plus", NULL};
    struct glint_pipeline *a = changed_pipeline(fixture, NULL), *b = changed_pipeline(fixture, other);
    struct glint_replay *fresh_a = loaded(fixture), *fresh_b = loaded(fixture);
    for (uint64_t keep = 0; keep <= PLENTY; keep += PLENTY) {
        const struct glint_replay_options options = {.keep_bytes = keep};
        struct glint_replay *replay = loaded(fixture);
        run_pipeline(replay, a, &options);
        check_fresh(fresh_a, replay, a);
        run_pipeline(replay, b, &options);
        const char *expected = "screen_trace cubemap_select cubemap_trace resolve blur upscale compose ";
        assert_string_equal(executed_slots(replay), expected);
        check_fresh(fresh_b, replay, b);
        const double seconds = glint_replay_seconds(replay, "read");
        for (int turn = 0; turn < 2; turn++) {
            run_pipeline(replay, a, &options);
            assert_string_equal(executed_slots(replay), keep ? "" : late);
            check_fresh(fresh_a, replay, a);
            run_pipeline(replay, b, &options);
            assert_string_equal(executed_slots(replay), keep ? "" : expected);
            check_fresh(fresh_b, replay, b);
        }
        if (keep) assert_true(glint_replay_seconds(replay, "read") == seconds);
        else assert_int_equal(spare_bytes(replay), 0);
        glint_replay_destroy(&replay);
    }
    glint_replay_destroy(&fresh_a);
    glint_replay_destroy(&fresh_b);
    glint_pipeline_destroy(&a);
    glint_pipeline_destroy(&b);
    fixture_check_messages(fixture);
}

/* Catches: memory that grows with every pipeline, and images that are reused with stale contents. */
static void what_is_kept_stays_within_its_limit(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_replay *fresh = loaded(fixture);
    for (uint64_t keep = 1; keep < 200000; keep *= 20) {
        struct glint_replay *replay = loaded(fixture);
        for (int i = 0; i < 12; i++) {
            char set[64];
            snprintf(set, sizeof set, "screen_trace.length_m=%d", 4 + i % 7);
            const char *const one[] = {set, i % 3 ? "upscale=bilinear" : "upscale=best_match", NULL};
            struct glint_pipeline *pipeline = changed_pipeline(fixture, one);
            run_pipeline(replay, pipeline, &(struct glint_replay_options){.keep_bytes = keep});
            assert_true(spare_bytes(replay) <= keep);
            if (i % 4 == 3) check_fresh(fresh, replay, pipeline);
            glint_pipeline_destroy(&pipeline);
        }
        glint_replay_destroy(&replay);
    }
    glint_replay_destroy(&fresh);
    fixture_check_messages(fixture);
}

/* Catches: a round that times passes of the previous round, or the same pass twice; keys that do not distinguish passes. */
static void a_round_runs_each_work_once(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    static const char *const other[] = {"upscale=best_match", NULL};
    struct glint_pipeline *a = changed_pipeline(fixture, NULL), *b = changed_pipeline(fixture, other);
    struct glint_replay *replay = loaded(fixture), *fresh_a = loaded(fixture);
    for (uint32_t round = 1; round < 4; round++) {
        const struct glint_replay_options options = {.keep_bytes = PLENTY, .round = round, .repeat = 1};
        uint64_t shared = 0;
        size_t count;
        run_pipeline(replay, a, &options);
        char all[128];
        snprintf(all, sizeof all, "downsample %s", late);
        assert_string_equal(executed_slots(replay), all);
        const struct glint_pass_result *results = glint_replay_results(replay, &count);
        for (size_t i = 0; i < count; i++)
            if (!strcmp(results[i].pass->slot, "resolve")) shared = results[i].key;
        assert_true(shared != 0);
        run_pipeline(replay, b, &options);
        assert_string_equal(executed_slots(replay), "upscale compose ");
        results = glint_replay_results(replay, &count);
        for (size_t i = 0; i < count; i++) {
            if (!strcmp(results[i].pass->slot, "resolve")) assert_true(results[i].key == shared);
            if (!strcmp(results[i].pass->slot, "compose")) assert_true(results[i].key && results[i].key != shared);
            assert_int_equal(results[i].time.n, results[i].pass->host || !results[i].cached);
        }
        run_pipeline(replay, a, &options);
        assert_string_equal(executed_slots(replay), "");
        check_fresh(fresh_a, replay, a);
    }
    glint_replay_destroy(&replay);
    glint_replay_destroy(&fresh_a);
    glint_pipeline_destroy(&a);
    glint_pipeline_destroy(&b);
    fixture_check_messages(fixture);
}

/* Catches: diagnostics that run the whole pipeline although they change no image that exists. */
static void diagnostics_run_the_tracers_alone(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_replay *replay = loaded(fixture), *fresh = loaded(fixture);
    run_pipeline(replay, fixture->pipeline, NULL);
    run_pipeline(replay, fixture->pipeline, &(struct glint_replay_options){.diagnostics = true});
    assert_string_equal(executed_slots(replay), "screen_trace cubemap_trace ");
    assert_non_null(glint_replay_find_image(replay, "screen_fetches"));
    run_pipeline(replay, fixture->pipeline, NULL);
    assert_string_equal(executed_slots(replay), "");
    assert_null(glint_replay_find_image(replay, "screen_fetches"));
    check_fresh(fresh, replay, fixture->pipeline);
    glint_replay_destroy(&fresh);
    glint_replay_destroy(&replay);
    fixture_check_messages(fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pipelines_that_take_turns_find_their_own),
        cmocka_unit_test(what_is_kept_stays_within_its_limit),
        cmocka_unit_test(a_round_runs_each_work_once),
        cmocka_unit_test(diagnostics_run_the_tracers_alone),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
