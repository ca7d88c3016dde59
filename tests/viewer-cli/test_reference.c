/* glint reference, as a user runs it, and comparisons with stored references. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *reference_option(const char *which, const char *folder) {
    char *option = NULL;
    assert_true(asprintf(&option, "--against=%s=%s", which, in_folder(folder)) > 0);
    return option;
}

static json_t *first_run(const char *text, json_t **whole) {
    *whole = parse_json(text);
    return json_array_get(json_object_get(*whole, "runs"), 0);
}

static double rmse(const json_t *run, const char *answer, const char *which) {
    const json_t *rows = json_object_get(json_object_get(json_object_get(run, answer), "image"), "surfaces");
    return number(named(rows, "surfaces", "all"), which);
}

static void it_is_kept_and_goes_on(UNUSED void **state) {
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("room.exr"), "--size=32x18", "--cube-size=16",
                  "--truth=16"));
    char *text = glint_ok("reference", in_folder("room.exr"), "-o", in_folder("kept"), "--rays=16", "--json");
    json_t *json = parse_json(text);
    assert_true(number(json, "rays") == 16);
    const double few = number(named(json_object_get(json, "noise"), "surfaces", "all"), "error");
    assert_true(few > 0);
    assert_null(json_object_get(json, "sensitivity"));
    const json_t *missing = named(json_object_get(json, "missing_information"), "surfaces", "all");
    assert_true(number(missing, "clean_rmse") < number(missing, "rmse"));
    json_decref(json);
    free(text);
    text = glint_ok("reference", in_folder("room.exr"), "-o", in_folder("kept"), "--rays=20", "--sensitivity=16");
    assert_contains(text, "32 rays per pixel");
    assert_contains(text, "screen_trace.thickness ");
    assert_contains(text, "missing information");
    assert_contains(text, "\nrough ");
    free(text);
    text = glint_ok("reference", in_folder("room.exr"), "-o", in_folder("kept"), "--noise=0.9", "--json");
    json = parse_json(text);
    assert_true(number(json, "rays") == 32); /* the noise is below the limit already */
    assert_true(number(json_object_get(json, "sensitivity"), "rays") == 16);
    json_decref(json);
    free(text);
    free(glint_ok("view", in_folder("kept"), "-o", in_folder("kept.png")));
    const struct pixels picture = read_png(in_folder("kept.png"));
    assert_true(picture.width == 32 && picture.height == 18);
    free(picture.rgb);
}

/* Also without a terminal. */
static void progress_is_printed_on_request(UNUSED void **state) {
    struct outcome silent = glint("reference", in_folder("room.exr"), "--rays=16", NULL),
                   progress = glint("reference", in_folder("room.exr"), "--rays=16", "--progress", NULL);
    assert_int_equal(silent.status, 0);
    assert_int_equal(progress.status, 0);
    assert_null(strstr(silent.err, "rays: 0.0 %")); /* a slow machine prints later ones */
    assert_contains(progress.err, "0 of 16 rays: 0.0 %");
    outcome_free(&silent);
    outcome_free(&progress);
}

/* Compared with itself there is no error; against both gives the same figures as against each. */
static void runs_are_compared_with_it(UNUSED void **state) {
    json_t *whole[3];
    char *option = reference_option("reference", "kept"), *both = reference_option("both", "kept");
    char *texts[3] = {
        glint_ok("replay", in_folder("room.exr"), option, "--json"),
        glint_ok("replay", in_folder("room.exr"), "--against=truth", "--json"),
        glint_ok("replay", in_folder("room.exr"), both, "--json"),
    };
    const json_t *reference = first_run(texts[0], &whole[0]), *truth = first_run(texts[1], &whole[1]),
                 *run = first_run(texts[2], &whole[2]);
    assert_true(rmse(run, "against_reference", "rmse") == rmse(reference, "against_reference", "rmse"));
    assert_true(rmse(run, "against_truth", "rmse") == rmse(truth, "against_truth", "rmse"));
    assert_true(rmse(run, "missing_information", "rmse") < rmse(run, "against_truth", "rmse"));
    /* the noise of the reference is known and subtracted */
    assert_true(rmse(run, "against_reference", "truth_noise") > 0);
    assert_true(rmse(run, "against_reference", "clean_rmse") < rmse(run, "against_reference", "rmse"));
    assert_null(json_object_get(reference, "missing_information"));
    char *text = glint_ok("replay", in_folder("room.exr"), both);
    assert_contains(text, "missing information");
    free(text);
    for (int i = 0; i < 3; i++) {
        json_decref(whole[i]);
        free(texts[i]);
    }
    free(option);
    free(both);
}

static void another_captures_reference_is_told(UNUSED void **state) {
    json_t *whole;
    char *option = reference_option("reference", "kept");
    char *text = glint_ok("replay", in_folder("room.exr"), option);
    assert_null(strstr(text, "another capture"));
    free(text);
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("next.exr"), "--size=32x18", "--cube-size=16",
                  "--first-frame=2"));
    text = glint_ok("replay", in_folder("next.exr"), option);
    assert_contains(text, "another capture");
    free(text);
    text = glint_ok("replay", in_folder("next.exr"), option, "--json");
    const json_t *run = first_run(text, &whole);
    assert_true(json_is_true(json_object_get(json_object_get(run, "against_reference"), "other_capture")));
    json_decref(whole);
    free(text);
    free(option);
}

static void what_cannot_be_is_said(UNUSED void **state) {
    free(glint_ok("sample", "matte", "--light=4", "-o", in_folder("matte.exr"), "--size=32x18", "--cube-size=16"));
    free(glint_ok("replay", in_folder("room.exr"), "-o", in_folder("run")));
    glint_fails(1, "nothing in it reflects", "reference", in_folder("matte.exr"));
    glint_fails(1, "No such file", "reference", in_folder("absent.exr"));
    glint_fails(2, "screen_trace.values.thickness is 0.01 there and 0.02 here", "reference", in_folder("room.exr"),
                "-o", in_folder("kept"), "--set=screen_trace.thickness=0.02");
    glint_fails(2, "a run that is not a reference", "reference", in_folder("room.exr"), "-o", in_folder("run"));
    glint_fails(2, "between 0 and 1", "reference", in_folder("room.exr"), "--noise=1");
    glint_fails(2, "expected a whole number", "reference", in_folder("room.exr"), "--rays=0");
    glint_fails(2, "one capture", "reference", in_folder("room.exr"), in_folder("matte.exr"));
    glint_fails(2, "unknown preset", "reference", in_folder("room.exr"), "--like=nobody");
    free(glint_ok("reference", in_folder("room.exr"), "-o", in_folder("run"), "--rays=16", "--overwrite", "--like=kf2",
                  "--set=resolve.fog=false"));
}

/* Catches: an option that does not reach the reference. */
static void the_cache_serves_other_commands(UNUSED void **state) {
    char *cache = NULL;
    assert_true(asprintf(&cache, "--cache=%s", in_folder("cache")) > 0);
    free(glint_ok("reference", in_folder("room.exr"), "--like", GLINT_TEST_PRESET, "--rays=16", "-o", in_folder("like"),
                  cache));
    free(glint_ok("sweep", in_folder("room.exr"), PLAIN, "--rays=16", "--repeat=0", "--no-pictures", "-o",
                  in_folder("swept"), cache, "--vary=screen_trace.steps=4"));
    free(glint_ok("tune", in_folder("room.exr"), PLAIN, "--rays=16", "--repeat=0", "-o", in_folder("tuned.json"), cache,
                  "--budget-fetches=100%", "--tries=1", "--vary=cubemap_trace.secant"));
    const double seconds = reference_seconds("like");
    assert_true(seconds > 0);
    assert_true(reference_seconds("swept/reflection-*") == seconds);
    assert_true(reference_seconds("tuned.tune/reflection-*") == seconds);
    free(cache);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_kept_and_goes_on),    cmocka_unit_test(progress_is_printed_on_request),
        cmocka_unit_test(runs_are_compared_with_it), cmocka_unit_test(another_captures_reference_is_told),
        cmocka_unit_test(what_cannot_be_is_said),    cmocka_unit_test(the_cache_serves_other_commands),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
