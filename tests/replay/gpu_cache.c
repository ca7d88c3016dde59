/* Results for cube maps that one process stores for the next, here one replay for another. */
#include <stdio.h>
#include <stdlib.h>
#include <dirent.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

/* Begins with an empty state, as in a new process. */
static void reset_replay(struct fixture *fixture, struct glint_capture *capture) {
    struct glint_error err = {0};
    glint_replay_destroy(&fixture->replay);
    fixture->replay = glint_replay_create(fixture->device, &err);
    assert_non_null(fixture->replay);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
}

static bool executed(struct fixture *fixture, const char *slot) {
    const struct glint_pass_result *result = fixture_result(fixture, slot);
    assert_true(result->ran && result->cached_work);
    return !result->cached;
}

/* A run as in a new process, whose images are in `*snapshot`. */
static void run_in_new_process(struct fixture *fixture, struct glint_capture *capture,
                               struct glint_replay_options options, const char *name, struct snapshot *snapshot) {
    char folder[128];
    reset_replay(fixture, capture);
    fixture_run(fixture, &options);
    fixture_check_messages(fixture);
    if (name) fixture_write_run(fixture, name, folder);
    snapshot_take(snapshot, fixture->replay);
}

static bool same_file(const struct fixture *fixture, const char *a, const char *b, const char *file) {
    char command[512];
    snprintf(command, sizeof command, "cmp -s '%s/%s/'*-%s.exr '%s/%s/'*-%s.exr", fixture->folder, a, file,
             fixture->folder, b, file);
    return system(command) == 0;
}

static void add_chain(struct fixture *fixture) {
    struct glint_error err = {0};
    assert_true(glint_pipeline_use(fixture->pipeline, "cubemap_mips=prefilter", &err));
    assert_true(glint_pipeline_use(fixture->pipeline, "sky_mips=prefilter", &err));
}

/* Catches: bits lost in the file, a pass that runs nevertheless, or a different file of the run. */
static void the_next_process_finds_the_work_done(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct snapshot first, second;
    char cache[160];
    snprintf(cache, sizeof cache, "%s/found", fixture->folder);
    const struct glint_replay_options options = {.cache = cache};
    add_chain(fixture);
    run_in_new_process(fixture, fixture->capture, options, "one", &first);
    assert_true(executed(fixture, "cubemap_mips") && executed(fixture, "sky_mips"));
    run_in_new_process(fixture, fixture->capture, options, "two", &second);
    assert_false(executed(fixture, "cubemap_mips") || executed(fixture, "sky_mips"));
    assert_int_equal(snapshot_compare(&second, &first), first.count);
    assert_true(same_file(fixture, "one", "two", "cubemap_mips") && same_file(fixture, "one", "two", "compose"));
    snapshot_free(&second);
    const char *const outputs[] = {"composed", NULL}; /* images that are not requested are restored, too */
    struct glint_replay_options few = options;
    few.outputs = outputs;
    run_in_new_process(fixture, fixture->capture, few, NULL, &second);
    assert_false(executed(fixture, "cubemap_mips"));
    assert_int_equal(snapshot_compare(&second, &first), 1);
    snapshot_free(&second);
    few = options;
    few.no_cache = true;
    run_in_new_process(fixture, fixture->capture, few, NULL, &second);
    assert_true(executed(fixture, "cubemap_mips"));
    snapshot_free(&second);
    snapshot_free(&first);
}

/* Catches: keys that omit a parameter or the contents of the capture. */
static void other_work_is_not_found(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct snapshot first, second;
    char cache[160], path[160];
    snprintf(cache, sizeof cache, "%s/other", fixture->folder);
    snprintf(path, sizeof path, "%s/other.exr", fixture->folder);
    const struct glint_replay_options options = {.cache = cache};
    add_chain(fixture);
    run_in_new_process(fixture, fixture->capture, options, "one", &first);
    assert_true(glint_pipeline_set(fixture->pipeline, "cubemap_mips.reach=2", &err));
    run_in_new_process(fixture, fixture->capture, options, NULL, &second);
    assert_true(executed(fixture, "cubemap_mips"));
    assert_false(executed(fixture, "sky_mips"));
    snapshot_free(&second);
    assert_true(glint_pipeline_set(fixture->pipeline, "cubemap_mips.reach=3", &err));
    assert_true(fixture_write_capture(path, &(struct fixture_options){.number = 8}, &err)); /* contains its cube maps */
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    run_in_new_process(fixture, capture, options, NULL, &second);
    assert_true(executed(fixture, "cubemap_mips"));
    snapshot_free(&second);
    snapshot_free(&first);
    reset_replay(fixture, fixture->capture);
    glint_capture_close(&capture);
}

/* Catches: images restored from a damaged file, and a damaged file that is not replaced. */
static void damaged_files_are_made_again(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct snapshot first, second;
    char cache[160], path[512];
    snprintf(cache, sizeof cache, "%s/damaged", fixture->folder);
    const struct glint_replay_options options = {.cache = cache};
    add_chain(fixture);
    run_in_new_process(fixture, fixture->capture, options, "one", &first);
    DIR *entries = opendir(cache);
    assert_non_null(entries);
    for (struct dirent *entry; (entry = readdir(entries));) {
        if (entry->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", cache, entry->d_name);
        assert_int_equal(truncate(path, 700), 0);
    }
    closedir(entries);
    run_in_new_process(fixture, fixture->capture, options, "two", &second);
    assert_true(executed(fixture, "cubemap_mips"));
    assert_int_equal(snapshot_compare(&second, &first), first.count);
    snapshot_free(&second);
    run_in_new_process(fixture, fixture->capture, options, NULL, &second);
    assert_false(executed(fixture, "cubemap_mips"));
    snapshot_free(&second);
    snapshot_free(&first);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_next_process_finds_the_work_done),
        cmocka_unit_test(other_work_is_not_found),
        cmocka_unit_test(damaged_files_are_made_again),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
