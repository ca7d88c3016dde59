/* Studies of runs, as a user does them: the reference, comparisons, interrupted shots. */
#include "cli.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* The reference must be far more accurate than the presets that are measured with it. */
static void reference_is_near_the_truth_and_others_are_compared_with_it(UNUSED void **state) {
    free(glint_ok("sample", "mirror_box", "-o", in_folder("fine.exr"), "--size=96x54", "--cube-size=128",
                  "--probes=perfect", "--truth=1"));
    char *text = glint_ok("replay", in_folder("fine.exr"), "--preset=reference", "--set=pipeline.rays=1",
                          "--against=truth", "--json", "--set=downsample.jitter=false", "--set=screen_trace.length_m=0",
                          "-o", in_folder("reference"));
    json_t *json = parse_json(text);
    const json_t *run = json_array_get(json_object_get(json, "runs"), 0);
    const json_t *smooth =
        named(json_object_get(json_object_get(run, "against_truth"), "distances"), "surfaces", "mirror-like");
    assert_true(number(smooth, "rays") > 500);
    assert_true(number(smooth, "median_error") <= 0.001);
    json_decref(json);
    free(text);
    /* Also for its rays that end on screen. */
    text = glint_ok("replay", in_folder("fine.exr"), "--preset=reference", "--set=pipeline.rays=1", "--against=truth",
                    "--json", "--set=downsample.jitter=false");
    json = parse_json(text);
    run = json_array_get(json_object_get(json, "runs"), 0);
    smooth = named(json_object_get(json_object_get(run, "against_truth"), "distances"), "surfaces", "mirror-like");
    assert_true(number(smooth, "median_error") <= 0.001);
    assert_true(number(named(json_object_get(json_object_get(run, "against_truth"), "rays"), "tracer", "screen"),
                       "rays") > 100);
    json_decref(json);
    free(text);
    /* The same input gives the same bits. */
    char *folder = NULL;
    assert_true(asprintf(&folder, "--against=reference=%s", in_folder("reference")) > 0);
    text = glint_ok("replay", in_folder("fine.exr"), "--preset=reference", "--set=pipeline.rays=1", folder, "--json",
                    "--set=downsample.jitter=false", "--set=screen_trace.length_m=0", "--effect=reflection");
    json = parse_json(text);
    run = json_array_get(json_object_get(json, "runs"), 0);
    const json_t *same =
        named(json_object_get(json_object_get(json_object_get(run, "against_reference"), "image"), "surfaces"),
              "surfaces", "all");
    assert_true(number(same, "pixels") > 500 && number(same, "rmse") == 0);
    json_decref(json);
    free(text);
    free(folder);
    free(glint_ok("sample", "mirror_box", "-o", in_folder("tiny.exr"), "--size=32x18", "--cube-size=16"));
    text = glint_ok("replay", in_folder("tiny.exr"), "--against=reference");
    assert_contains(text, "against the reference");
    free(text);
    glint_fails(2, "takes no run", "replay", in_folder("fine.exr"), "--against=truth=x");
    glint_fails(1, "nowhere", "replay", in_folder("fine.exr"), "--against=reference=nowhere");
}

static void age(const char *path, struct stat *info) {
    if (stat(path, info) != 0) fail_msg("%s is not there", path);
}

static bool newer(const char *path, const struct stat *before) {
    struct stat now;
    age(path, &now);
    return now.st_mtim.tv_sec != before->st_mtim.tv_sec || now.st_mtim.tv_nsec != before->st_mtim.tv_nsec;
}

/* A preset that accumulates, in few passes. */
#define FRAMES in_folder("s.0001.exr"), in_folder("s.0002.exr"), in_folder("s.0003.exr"), PLAIN, "--use=temporal=rough"
#define SHOT FRAMES, "-o", in_folder("shot")

static void an_interrupted_shot_is_completed(UNUSED void **state) {
    struct stat first, last;
    free(glint_ok("sample", "mirror_box", "-o", in_folder("s.exr"), "--size=32x18", "--cube-size=16", "--frames=3"));
    free(glint_ok("replay", SHOT));
    free(glint_ok("replay", FRAMES, "-o", in_folder("whole")));
    age(in_folder("shot/s.0001/run.json"), &first);
    /* as if interrupted within the second frame: its files exist, but not run.json */
    assert_int_equal(unlink(in_folder("shot/s.0002/run.json")), 0);
    age(in_folder("shot/s.0003/run.json"), &last);
    char *text = glint_ok("replay", SHOT, "--json");
    json_t *json = parse_json(text);
    const json_t *runs = json_object_get(json, "runs");
    assert_true(json_is_true(json_object_get(json_array_get(runs, 0), "kept")));
    assert_null(json_object_get(json_array_get(runs, 1), "kept"));
    assert_false(newer(in_folder("shot/s.0001/run.json"), &first));
    assert_true(file_exists(in_folder("shot/s.0002/run.json")));
    /* the third frame depends on the second through history */
    assert_true(newer(in_folder("shot/s.0003/run.json"), &last));
    struct outcome same = run_program("sh", "-c", "cmp \"$0\"/*-compose.exr \"$1\"/*-compose.exr",
                                      in_folder("shot/s.0003"), in_folder("whole/s.0003"), NULL);
    assert_int_equal(same.status, 0);
    outcome_free(&same);
    json_decref(json);
    free(text);
    /* complete: nothing runs unless requested */
    text = glint_ok("replay", SHOT);
    assert_contains(text, "s.0003.exr: already complete, kept");
    free(text);
    free(glint_ok("replay", SHOT, "--no-cache"));
    assert_true(newer(in_folder("shot/s.0001/run.json"), &first));
    age(in_folder("shot/s.0001/run.json"), &first);
    /* other settings, another capture or a missing file: replayed again */
    free(glint_ok("replay", SHOT, "--set=screen_trace.steps=9"));
    assert_true(newer(in_folder("shot/s.0001/run.json"), &first));
    free(glint_ok("sample", "mirror_box", "-o", in_folder("s.0002.exr"), "--size=32x18", "--cube-size=16"));
    age(in_folder("shot/s.0001/run.json"), &first);
    age(in_folder("shot/s.0002/run.json"), &last);
    free(glint_ok("replay", SHOT, "--set=screen_trace.steps=9"));
    assert_false(newer(in_folder("shot/s.0001/run.json"), &first));
    assert_true(newer(in_folder("shot/s.0002/run.json"), &last));
    struct outcome removed = run_program("sh", "-c", "rm \"$0\"/*-compose.exr", in_folder("shot/s.0001"), NULL);
    assert_int_equal(removed.status, 0);
    outcome_free(&removed);
    free(glint_ok("replay", SHOT, "--set=screen_trace.steps=9"));
    assert_true(newer(in_folder("shot/s.0001/run.json"), &first));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_is_near_the_truth_and_others_are_compared_with_it),
        cmocka_unit_test(an_interrupted_shot_is_completed),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
