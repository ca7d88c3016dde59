/* glint sweep, as a user runs it. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const json_t *point(const json_t *swept, size_t i) {
    return json_array_get(json_object_get(swept, "points"), i);
}

static const char *value(const json_t *point, const char *axis) {
    return json_string_value(json_object_get(json_object_get(point, "values"), axis));
}

static double error_of(const json_t *row, const char *answer, const char *class, const char *metric) {
    const json_t *errors = json_object_get(json_object_get(row, "errors"), answer);
    return number(json_object_get(errors, class), metric);
}

static const json_t *row_of(const json_t *point, size_t capture) {
    return json_array_get(json_object_get(point, "captures"), capture);
}

/* Checks the marks of a front against the definition, with the figures of the same file. */
static void check_front(const json_t *swept, const char *name, const char *cost, const char *sum) {
    const size_t count = json_array_size(json_object_get(swept, "points"));
    size_t on = 0;
    for (size_t i = 0; i < count; i++) {
        bool beaten = false, marked = false;
        size_t k;
        const json_t *front, *a = point(swept, i);
        const double x = number(json_object_get(a, cost), sum), y = number(json_object_get(a, "error"), sum);
        json_array_foreach(json_object_get(a, "front"), k, front) marked |= !strcmp(json_string_value(front), name);
        for (size_t j = 0; j < count; j++) {
            const json_t *b = point(swept, j);
            const double u = number(json_object_get(b, cost), sum), v = number(json_object_get(b, "error"), sum);
            beaten |= u <= x && v <= y && (u < x || v < y || j < i);
        }
        assert_int_equal(marked, !beaten);
        on += marked;
    }
    assert_true(on > 0);
    const json_t *listed = json_object_get(named(json_object_get(swept, "fronts"), "name", name), "points");
    assert_int_equal(json_array_size(listed), on);
    for (size_t i = 1; i < on; i++) {
        const json_t *a = point(swept, (size_t)json_integer_value(json_array_get(listed, i - 1))),
                     *b = point(swept, (size_t)json_integer_value(json_array_get(listed, i)));
        assert_true(number(json_object_get(a, cost), sum) < number(json_object_get(b, cost), sum));
        assert_true(number(json_object_get(a, "error"), sum) > number(json_object_get(b, "error"), sum));
    }
}

/* Catches: points with wrong values, errors of another image, and passes that run although nothing changed. */
static void points_are_the_pipelines_they_name(UNUSED void **state) {
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("room.exr"), "--size=64x36", "--cube-size=16",
                  "--truth=1"));
    free(glint_ok("reference", in_folder("room.exr"), "-o", in_folder("reference"), "--rays=16"));
    char *text = glint_ok("sweep", in_folder("room.exr"), "-o", in_folder("grid"), PLAIN, "--repeat=2", "--reference",
                          in_folder("reference"), "--vary=upscale.depth_weight=0,100", "--use=upscale=best_match",
                          "--vary=screen_trace.steps=4..16:log");
    assert_contains(text, "RMSE against GPU time");
    assert_contains(text, "RMSE against fetches per pixel");
    free(text);
    json_t *swept = load_json("grid/points.json");
    assert_int_equal(json_array_size(json_object_get(swept, "points")), 6);
    for (size_t i = 0; i < 6; i++) { /* late passes vary fastest */
        const json_t *row = row_of(point(swept, i), 0), *ran = json_object_get(row, "executed");
        static const char *const steps[] = {"4", "8", "16"}, *const weights[] = {"0", "100"};
        assert_string_equal(value(point(swept, i), "screen_trace.steps"), steps[i / 2]);
        assert_string_equal(value(point(swept, i), "upscale.depth_weight"), weights[i % 2]);
        if (i % 2) assert_string_equal(json_string_value(json_array_get(ran, 0)), "upscale");
        else if (i) assert_string_equal(json_string_value(json_array_get(ran, 0)), "screen_trace");
        assert_true(number(json_object_get(row, "passes_ms"), "downsample") > 0);
        assert_true(number(json_object_get(row, "frame_ms"), "median") > 0);
    }
    assert_true(number(row_of(point(swept, 0), 0), "fetches_px") < number(row_of(point(swept, 4), 0), "fetches_px"));
    text = glint_ok("replay", in_folder("room.exr"), PLAIN, "--use=upscale=best_match", "--set=screen_trace.steps=8",
                    "--set=upscale.depth_weight=100", "--json", "--against", "truth");
    json_t *replayed = parse_json(text);
    free(text);
    const json_t *run = json_array_get(json_object_get(replayed, "runs"), 0);
    const json_t *surfaces =
        json_object_get(json_object_get(json_object_get(run, "against_truth"), "image"), "surfaces");
    static const char *const classes[] = {"all", "mirror-like", "glossy", "rough"};
    for (size_t i = 0; i < 4; i++)
        assert_true(fabs(number(named(surfaces, "surfaces", classes[i]), "rmse") -
                         error_of(row_of(point(swept, 3), 0), "truth", classes[i], "rmse")) < 1e-9);
    check_front(swept, "time", "frame_ms", "mean");
    check_front(swept, "fetches", "fetches_px", "mean");
    assert_true(file_exists(in_folder("grid/index.html")) && file_exists(in_folder("grid/front-time.svg")));
    assert_true(file_exists(in_folder("grid/front-fetches.svg")) && file_exists(in_folder("grid/page.json")));
    const json_t *listed = json_object_get(named(json_object_get(swept, "fronts"), "name", "fetches"), "points");
    char name[96];
    for (size_t i = 0; i < json_array_size(listed); i++) {
        const int at = (int)json_integer_value(json_array_get(listed, i));
        snprintf(name, sizeof name, "grid/pictures/error-0-%04d.png", at);
        struct pixels picture = read_png(in_folder(name));
        assert_true(picture.width == 448 && picture.height > 252); /* 7 times, and a legend */
        free(picture.rgb);
        if (i == 0) continue;
        snprintf(name, sizeof name, "grid/pictures/change-0-%04d-%04d.png",
                 (int)json_integer_value(json_array_get(listed, i - 1)), at);
        assert_true(file_exists(in_folder(name)));
    }
    json_decref(replayed);
    json_decref(swept);
}

/* Compares the results of two sweeps, except times. */
static void assert_same_findings(const char *a, const char *b) {
    json_t *one = load_json(a), *other = load_json(b);
    const size_t count = json_array_size(json_object_get(one, "points"));
    assert_int_equal(json_array_size(json_object_get(other, "points")), count);
    for (size_t i = 0; i < count; i++) {
        static const char *const keys[] = {"errors", "invalid", "rays", "steps_px", "fetches_px"};
        assert_true(json_equal(json_object_get(point(one, i), "values"), json_object_get(point(other, i), "values")));
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
            const json_t *found = json_object_get(row_of(point(one, i), 0), keys[k]);
            assert_non_null(found);
            assert_true(json_equal(found, json_object_get(row_of(point(other, i), 0), keys[k])));
        }
        assert_true(number(json_object_get(row_of(point(one, i), 0), "frame_ms"), "median") > 0);
    }
    json_decref(one);
    json_decref(other);
}

/* Killed with half a line at the end of the log: the same command resumes and gives the same results as an uninterrupted one. */
static void a_killed_sweep_goes_on(UNUSED void **state) {
    char command[1024];
    static const char arguments[] =
        "--repeat=2 --reference=truth --no-pictures --sample=lhs:6 --seed=3 --vary=screen_trace.thickness=0.01..0.1 "
        "--vary=cubemap_trace.steps_hq+cubemap_trace.steps_lq=4..64:log";
    snprintf(command, sizeof command,
             "cd %s && \"$GLINT\" sweep room.exr -o killed -p %s %s & pid=$!; "
             "until [ \"$(cat %s/killed/log.jsonl 2>/dev/null | wc -l)\" -ge 10 ]; do kill -0 $pid || exit 9; sleep "
             "0.1; done; kill -9 $pid; wait $pid",
             in_folder(""), GLINT_TEST_PRESET, arguments, in_folder(""));
    struct outcome killed = run_program("sh", "-c", command, NULL);
    assert_int_equal(killed.status, 128 + 9);
    outcome_free(&killed);
    assert_true(count_lines("killed/log.jsonl") >= 10);
    assert_false(file_exists(in_folder("killed/points.json")));
    FILE *log = fopen(in_folder("killed/log.jsonl"), "ab");
    assert_non_null(log);
    fputs("{\"errors\":{\"reference\":{\"all\":{\"pix", log);
    fclose(log);
    for (int i = 0; i < 2; i++) {
        snprintf(command, sizeof command, "cd %s && \"$GLINT\" sweep room.exr -o %s -p %s %s", in_folder(""),
                 i ? "whole" : "killed", GLINT_TEST_PRESET, arguments);
        free(checked(run_program("sh", "-c", command, NULL), 0, __FILE__, __LINE__));
    }
    assert_int_equal(count_lines("killed/log.jsonl"), 6 * (1 + 2));
    assert_int_equal(count_lines("whole/log.jsonl"), 6 * (1 + 2));
    assert_same_findings("killed/points.json", "whole/points.json");
}

static void several_captures_have_a_mean_and_a_worst_case(UNUSED void **state) {
    free(glint_ok("sample", "street", "--light=4", "-o", in_folder("street.exr"), "--size=64x36", "--cube-size=16"));
    free(glint_ok("sweep", in_folder("room.exr"), in_folder("street.exr"), "-o", in_folder("two"), PLAIN, "--rays=16",
                  "--repeat=0", "--vary=screen_trace=linear,dda", "--vary=screen_trace.steps=4,64", "--no-pictures",
                  "--metric=symmetric"));
    json_t *swept = load_json("two/points.json");
    assert_int_equal(json_array_size(json_object_get(swept, "points")), 3); /* dda has no steps */
    for (size_t i = 0; i < 3; i++) {
        const double a = error_of(row_of(point(swept, i), 0), "reference", "all", "symmetric"),
                     b = error_of(row_of(point(swept, i), 1), "reference", "all", "symmetric");
        const json_t *error = json_object_get(point(swept, i), "error");
        assert_true(fabs(number(error, "mean") - (a + b) / 2) < 1e-12 && number(error, "worst") == fmax(a, b));
        assert_true(json_is_null(json_object_get(json_object_get(point(swept, i), "frame_ms"), "mean")));
    }
    check_front(swept, "fetches", "fetches_px", "mean");
    check_front(swept, "fetches_worst", "fetches_px", "worst");
    assert_int_equal(json_array_size(json_object_get(swept, "fronts")), 2);
    json_decref(swept);
    struct outcome csv = run_program("wc", "-l", in_folder("two/points.csv"), NULL);
    assert_int_equal(atoi(csv.out), 1 + 2 * 3);
    outcome_free(&csv);
}

static void what_is_wrong_is_named(UNUSED void **state) {
    char *room = strdup(in_folder("room.exr")),
         *out = strdup(in_folder("bad")); /* copies, because in_folder's results are overwritten */
    glint_fails(2, "no capture given", "sweep", "-o", out, "--vary=screen_trace.cells=8,16");
    glint_fails(2, "no output folder given: -o FOLDER", "sweep", room, "--vary=screen_trace.cells=8,16");
    glint_fails(2, "nothing to vary", "sweep", room, "-o", out);
    glint_fails(2, "there is no slot scren_trace (did you mean screen_trace?)", "sweep", room, "-o", out,
                "--vary=scren_trace.cells=8,16");
    glint_fails(2, "no parameter cell (did you mean cells?)", "sweep", room, "-o", out,
                "--vary=screen_trace.cell=8,16");
    glint_fails(2, "no variant hizz (did you mean hiz?)", "sweep", room, "-o", out, "--vary=screen_trace=dda,hizz");
    glint_fails(2, "screen_trace.cells: expected 1 to 65536 (cells), found 0", "sweep", room, "-o", out,
                "--vary=screen_trace.cells=0..4");
    glint_fails(2, "expected lhs:N", "sweep", room, "-o", out, "--vary=screen_trace.cells=8,16", "--sample=sobol:4");
    glint_fails(2, "expected one run for each of 1 captures, found 2", "sweep", room, "-o", out,
                "--vary=screen_trace.cells=8,16", "--reference=a", "--reference=b");
    glint_fails(2, "expected either runs or truth", "sweep", room, "-o", out, "--vary=screen_trace.cells=8,16",
                "--reference=a", "--reference=truth");
    glint_fails(2, "metric 'rmsd' (did you mean rmse?): expected one of", "sweep", room, "-o", out,
                "--vary=screen_trace.cells=8,16", "--metric=rmsd");
    glint_fails(1, "truth.reflection.ggx: missing", "sweep", in_folder("street.exr"), "-o", out, PLAIN,
                "--reference=truth", "--vary=screen_trace.steps=8,16");
    glint_fails(2, "expected a run of", "sweep", in_folder("street.exr"), "-o", in_folder("bad2"), PLAIN, "--reference",
                in_folder("reference"), "--vary=screen_trace.steps=8,16");
    /* a folder with another sweep, and one whose log was edited */
    glint_fails(2, "two: contains a sweep with other metrics", "sweep", room, in_folder("street.exr"), "-o",
                in_folder("two"), PLAIN, "--rays=16", "--repeat=0", "--vary=screen_trace=linear,dda",
                "--vary=screen_trace.steps=4,64", "--metric=ssim");
    glint_fails(2, "contains a sweep with other vary: [\"screen_trace=linear,dda\"", "sweep", room,
                in_folder("street.exr"), "-o", in_folder("two"), PLAIN, "--rays=16", "--repeat=0",
                "--vary=screen_trace=linear,dda");
    FILE *log = fopen(in_folder("two/log.jsonl"), "ab");
    assert_non_null(log);
    fputs("{\"capture\":0,\"point\":3}\n", log);
    fclose(log);
    glint_fails(1, "expected a line of this sweep", "sweep", room, in_folder("street.exr"), "-o", in_folder("two"),
                PLAIN, "--rays=16", "--repeat=0", "--vary=screen_trace=linear,dda", "--vary=screen_trace.steps=4,64");
    free(room);
    free(out);
}

/* Columns of the CSV file, and titles of tune's table. */
static void classes_are_those_of_the_effect(UNUSED void **state) {
    free(glint_ok("sample", "room", "--light=1", "-o", in_folder("shaded.exr"), "--size=32x18", "--cube-size=8",
                  "--truth=4", "--truth-of=occlusion,picture"));
    free(glint_ok("sweep", in_folder("shaded.exr"), "-o", in_folder("occlusion"), PLAIN, "--use=ao_trace=horizon",
                  "--use=ao_apply=bilinear", "--effect=occlusion", "--reference=truth", "--repeat=0", "--no-pictures",
                  "--vary=ao_trace.steps=2,4"));
    char *text = checked(run_program("cat", in_folder("occlusion/points.csv"), NULL), 0, __FILE__, __LINE__);
    assert_contains(text, "truth all rmse");
    assert_contains(text, "truth near rmse");
    assert_contains(text, "truth open rmse");
    assert_null(strstr(text, "glossy"));
    free(text);
    /* The picture is judged as a whole: what occlusion costs counts, and changes its error. */
    text = glint_ok("sweep", in_folder("shaded.exr"), "-o", in_folder("picture"), PLAIN, "--use=ao_trace=horizon",
                    "--use=ao_apply=bilinear", "--effect=picture", "--reference=truth", "--repeat=0", "--no-pictures",
                    "--vary=ao_trace.steps=2,4", "--json");
    json_t *points = parse_json(text), *few = json_array_get(json_object_get(points, "points"), 0),
           *many = json_array_get(json_object_get(points, "points"), 1);
    double errors[2], costs[2];
    assert_int_equal(
        json_unpack(few, "{s:{s:F}, s:{s:F}}", "error", "mean", &errors[0], "fetches_px", "mean", &costs[0]), 0);
    assert_int_equal(
        json_unpack(many, "{s:{s:F}, s:{s:F}}", "error", "mean", &errors[1], "fetches_px", "mean", &costs[1]), 0);
    assert_true(costs[1] > costs[0] && errors[0] != errors[1] && errors[1] > 0);
    json_decref(points);
    free(text);
    text = glint_ok("tune", in_folder("shaded.exr"), "-o", in_folder("occlusion.json"), PLAIN, "--use=ao_trace=horizon",
                    "--use=ao_apply=bilinear", "--effect=occlusion", "--reference=truth", "--repeat=0",
                    "--budget-fetches=80%", "--tries=4", "--vary=ao_trace.steps=2..8");
    assert_contains(text, "near  farther     open");
    assert_null(strstr(text, "mirror-like"));
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_are_the_pipelines_they_name),
        cmocka_unit_test(a_killed_sweep_goes_on),
        cmocka_unit_test(several_captures_have_a_mean_and_a_worst_case),
        cmocka_unit_test(classes_are_those_of_the_effect),
        cmocka_unit_test(what_is_wrong_is_named),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
