/* glint tune, as a user runs it. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AXES "--vary=screen_trace.steps=2..64", "--vary=cubemap_trace.steps_hq=4..64", "--vary=cubemap_trace.secant"

static int make_captures(void **state) {
    if (make_folder(state)) return 1;
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("room.exr"), "--size=64x36", "--cube-size=16",
                  "--truth=1"));
    free(glint_ok("sample", "street", "--light=4", "-o", in_folder("street.exr"), "--size=64x36", "--cube-size=16"));
    return 0;
}

static const json_t *contender(const json_t *tuned, size_t capture, const char *name) {
    const json_t *confirmed = json_array_get(json_object_get(tuned, "confirmed"), capture);
    return json_object_get(json_object_get(confirmed, "contenders"), name);
}

static double value_of(const json_t *object, const char *key) {
    return number(json_object_get(object, key), "value");
}

/* The start's counts times a factor, as AXES allows. */
struct counts {
    double screen, cubes;
};
static struct counts scaled_counts(double factor) {
    return (struct counts){fmax(2, round(32 * factor)), fmax(4, round(24 * factor))};
}

/* The cost of the start with these counts, measured by a search without tries. */
static double fetches_of(struct counts counts) {
    char folder[64], screen[64], cubes[64];
    snprintf(folder, sizeof folder, "%.0f-%.0f", counts.screen, counts.cubes);
    snprintf(screen, sizeof screen, "--set=screen_trace.steps=%.0f", counts.screen);
    snprintf(cubes, sizeof cubes, "--set=cubemap_trace.steps_hq=%.0f", counts.cubes);
    char *text = glint_ok("tune", in_folder("room.exr"), "-o", in_folder("one.json"), "--folder", in_folder(folder),
                          PLAIN, screen, cubes, "--budget-fetches=100%", "--reference=truth", "--tries=1", "--repeat=0",
                          "--vary=cubemap_trace.secant", "--json");
    json_t *search = parse_json(text);
    const double fetches = number(contender(search, 0, "start"), "fetches_px");
    free(text);
    json_decref(search);
    return fetches;
}

/* Catches: a budget that is exceeded, a preset that differs from the measured point, and figures of other pipelines. */
static void the_preset_is_what_was_found(UNUSED void **state) {
    char *text = glint_ok("tune", in_folder("room.exr"), "-o", in_folder("found.json"), PLAIN, "--budget-fetches=60%",
                          "--reference=truth", "--tries=24", "--repeat=2", "--baseline=scale", AXES, "--json");
    json_t *tuned = parse_json(text), *preset = load_json("found.json");
    free(text);
    const json_t *from = json_object_get(preset, "provenance"), *start = contender(tuned, 0, "start");
    const json_t *found = contender(tuned, 0, "tuned"), *scaled = contender(tuned, 0, "scaled");
    const double budget = value_of(from, "limit"), scale = number(json_object_get(tuned, "scaled"), "factor");
    assert_true(fabs(budget - 0.6 * number(start, "fetches_px")) < 1e-6); /* nine digits are printed */
    assert_true(number(found, "fetches_px") <= budget &&
                fabs(number(found, "fetches_px") - number(from, "cost")) < 1e-7);
    const json_t *errors = json_object_get(found, "errors");
    /* the baseline meets the budget, and a larger one would not; the tuned preset costs no more and has no larger error than a baseline
       of its cost */
    const double factor = number(scaled, "factor");
    const struct counts own = scaled_counts(factor);
    struct counts under = own;
    for (double f = factor; under.screen == own.screen && under.cubes == own.cubes; f /= 1.02) under = scaled_counts(f);
    assert_true(json_is_true(json_object_get(json_object_get(tuned, "scaled"), "within")));
    assert_true(factor <= scale && number(scaled, "fetches_px") <= budget);
    assert_true(fetches_of(scaled_counts(1.25 * scale)) > budget);
    assert_true(fetches_of(under) < number(found, "fetches_px"));
    assert_true(fabs(number(json_object_get(from, "limit"), "within") -
                     number(json_object_get(tuned, "scaled"), "cost")) < 1e-7);
    assert_true(number(scaled, "fetches_px") >= number(found, "fetches_px"));
    assert_true(value_of(json_object_get(scaled, "errors"), "all") >= value_of(errors, "all"));
    assert_true(fabs(value_of(errors, "all") - number(from, "error")) < 1e-7);
    assert_true(number(json_object_get(found, "ms"), "median") > 0);
    const json_t *less = json_object_get(json_array_get(json_object_get(tuned, "confirmed"), 0), "tuned_less_scaled");
    assert_true(fabs(value_of(less, "all") - value_of(errors, "all") +
                     value_of(json_object_get(scaled, "errors"), "all")) < 1e-7);
    /* the preset alone replays with the same error, and contains the reported changes */
    text = glint_ok("replay", in_folder("room.exr"), "-p", in_folder("found.json"), "--against=truth", "--json");
    json_t *replayed = parse_json(text);
    free(text);
    const json_t *run = json_array_get(json_object_get(replayed, "runs"), 0);
    const json_t *rows = json_object_get(json_object_get(json_object_get(run, "against_truth"), "image"), "surfaces");
    static const char *const classes[] = {"all", "mirror-like", "glossy", "rough"};
    for (size_t i = 0; i < 4; i++)
        assert_true(fabs(number(named(rows, "surfaces", classes[i]), "rmse") - value_of(errors, classes[i])) < 1e-9);
    size_t i;
    const json_t *moved;
    assert_true(json_array_size(json_object_get(from, "moved")) > 0);
    json_array_foreach(json_object_get(from, "moved"), i, moved) {
        const json_t *value =
            json_object_get(json_object_get(preset, "set"), json_string_value(json_object_get(moved, "name")));
        char set[64] = "";
        if (json_is_boolean(value)) snprintf(set, sizeof set, "%s", json_is_true(value) ? "true" : "false");
        else if (value) snprintf(set, sizeof set, "%.9g", json_number_value(value));
        if (value) assert_string_equal(set, json_string_value(json_object_get(moved, "to")));
    }
    assert_true(file_exists(in_folder("found.tune/found.html")) && file_exists(in_folder("found.tune/found.svg")));
    free(glint_ok("report", in_folder("found.tune"), "-o", in_folder("again.html")));
    json_decref(replayed);
    json_decref(preset);
    json_decref(tuned);
}

/* The deterministic part of the results, which is equal for the same seed; a second run finds all of it in the folder. */
static void a_seed_gives_the_same_preset_again(UNUSED void **state) {
    json_t *sets[3], *moved[3];
    for (int i = 0; i < 3; i++) {
        const char *out = in_folder(i == 1 ? "b.json" : "a.json");
        char *text = glint_ok("tune", in_folder("room.exr"), "-o", out, PLAIN, "--budget-fetches=60%",
                              "--reference=truth", "--tries=12", "--repeat=0", "--seed=5", AXES, "--json");
        json_t *tuned = parse_json(text), *preset = load_json(i == 1 ? "b.json" : "a.json");
        free(text);
        sets[i] = json_incref(json_object_get(preset, "set"));
        moved[i] = json_incref(json_object_get(json_object_get(preset, "provenance"), "moved"));
        assert_int_equal((int)number(tuned, "fresh"),
                         i == 2 ? 0 : (int)number(json_object_get(tuned, "provenance"), "points"));
        json_decref(preset);
        json_decref(tuned);
    }
    for (int i = 1; i < 3; i++) {
        assert_true(json_equal(sets[0], sets[i]) && json_equal(moved[0], moved[i]));
    }
    for (int i = 0; i < 3; i++) json_decref(sets[i]), json_decref(moved[i]);
}

/* Interrupted with half a line at the end: the best point so far is stored, and the same command ends like an uninterrupted one. */
static void an_interrupted_search_goes_on(UNUSED void **state) {
    char command[1200];
    static const char arguments[] = "--budget-fetches=60% --reference=truth --tries=12 --repeat=0 --seed=5 "
                                    "--vary=screen_trace.steps=2..64 --vary=cubemap_trace.steps_hq=4..64 "
                                    "--vary=cubemap_trace.secant --json";
    snprintf(command, sizeof command,
             "cd %s; \"$GLINT\" tune room.exr -o c.json -p %s %s & pid=$!; "
             "until { mapfile -t lines <c.tune/log.jsonl; } 2>/dev/null && [ ${#lines[@]} -ge 4 ]; do "
             "kill -0 $pid || exit 9; sleep 0.01; done; kill -INT $pid; wait $pid",
             in_folder(""), GLINT_TEST_PRESET, arguments);
    struct outcome stopped = run_program("bash", "-c", command, NULL);
    assert_int_equal(stopped.status, 130);
    assert_contains(stopped.err, "the same command resumes from there");
    outcome_free(&stopped);
    json_t *best = load_json("c.json");
    assert_true(json_is_false(json_object_get(json_object_get(best, "provenance"), "confirmed")));
    json_decref(best);
    FILE *log = fopen(in_folder("c.tune/log.jsonl"), "ab");
    assert_non_null(log);
    fputs("{\"values\":[\"3\",", log);
    fclose(log);
    snprintf(command, sizeof command, "cd %s && \"$GLINT\" tune room.exr -o c.json -p %s %s", in_folder(""),
             GLINT_TEST_PRESET, arguments);
    char *text = checked(run_program("sh", "-c", command, NULL), 0, __FILE__, __LINE__);
    json_t *went_on = parse_json(text), *whole = load_json("a.json"), *same = load_json("c.json");
    free(text);
    assert_true(number(went_on, "fresh") < 12 && number(went_on, "fresh") > 0);
    assert_true(json_equal(json_object_get(whole, "set"), json_object_get(same, "set")));
    json_decref(went_on);
    json_decref(whole);
    json_decref(same);
}

/* With ample time: whatever the noisy times of the search are, the point with the smallest error is chosen, and the search continues
   with the remaining time. */
static void time_that_is_left_is_used(UNUSED void **state) {
    char *text = glint_ok("tune", in_folder("room.exr"), "-o", in_folder("e.json"), PLAIN, "--budget-ms=3000%",
                          "--reference=truth", "--tries=4", "--rounds=1", "--repeat=2", AXES, "--json"),
         line[4096];
    json_t *tuned = parse_json(text);
    free(text);
    double least = INFINITY;
    size_t points = 0;
    FILE *log = fopen(in_folder("e.tune/log.jsonl"), "rb");
    assert_non_null(log);
    while (fgets(line, sizeof line, log)) {
        json_t *kept = parse_json(line);
        const json_t *first = json_array_get(json_object_get(kept, "captures"), 0);
        if (first) least = fmin(least, number(first, "error")), points++;
        json_decref(kept);
    }
    fclose(log);
    assert_true(points > 4);
    assert_true(fabs(value_of(json_object_get(contender(tuned, 0, "tuned"), "errors"), "all") - least) < 1e-7);
    json_decref(tuned);
}

static bool says(const json_t *left, const char *name, const char *why) {
    size_t i;
    const json_t *one;
    json_array_foreach(left, i, one) if (!strcmp(json_string_value(json_object_get(one, "name")), name)) return strstr(
        json_string_value(json_object_get(one, "why")), why) != NULL;
    return false;
}

/* All declared parameters that can matter; two captures, one held out, in the least time for an error. */
static void what_cannot_matter_is_left_alone(UNUSED void **state) {
    char *text = glint_ok("tune", in_folder("room.exr"), "--held-out", in_folder("street.exr"), "-o",
                          in_folder("d.json"), PLAIN, "--error=120%", "--tries=2", "--rounds=1", "--repeat=1",
                          "--rays=4", "--json", "--use=cubemap_mips=plain");
    json_t *tuned = parse_json(text);
    free(text);
    const json_t *left = json_object_get(tuned, "left");
    assert_true(says(left, "downsample.ndf", "would change the reference"));
    assert_true(says(left, "compose.fresnel", "does not influence the reflection"));
    assert_true(says(left, "cubemap_active.count", "on the host only"));
    assert_true(says(left, "cubemap_mips.join", "not processed every frame"));
    assert_true(says(left, "screen_trace.thickness", "which the reference makes too"));
    assert_false(says(left, "cubemap_trace.steps_hq", ""));
    assert_int_equal(json_array_size(json_object_get(tuned, "confirmed")), 2);
    assert_true(number(json_object_get(contender(tuned, 1, "tuned"), "ms"), "median") > 0);
    json_decref(tuned);
}

static void what_is_wrong_is_named(UNUSED void **state) {
    char *room = strdup(in_folder("room.exr")), *out = strdup(in_folder("bad.json"));
    const char *budget = "--budget-ms=50%";
    glint_fails(2, "no capture given", "tune", "-o", out, budget);
    glint_fails(2, "expected one of --budget-ms, --budget-fetches and --error", "tune", room, "-o", out);
    glint_fails(2, "expected one of --budget-ms, --budget-fetches and --error", "tune", room, "-o", out, budget,
                "--error=0.1");
    glint_fails(2, "no output file given", "tune", room, budget);
    glint_fails(2, "expected FILE.json", "tune", room, "-o", "bad", budget);
    glint_fails(2, "expected FILE.json", "tune", room, "-o", ".json", budget);
    glint_fails(2, "expected a number above 0", "tune", room, "-o", out, "--budget-ms=-1");
    glint_fails(2, "expected a number above 0", "tune", room, "-o", out, "--budget-ms=nan");
    glint_fails(2, "expected a number above 0", "tune", room, "-o", out, "--budget-ms=2x");
    glint_fails(2, "--cost can only be used with --error", "tune", room, "-o", out, budget, "--cost=fetches");
    glint_fails(2, "--slots cannot be used with fetches", "tune", room, "-o", out, "--budget-fetches=9",
                "--slots=resolve");
    glint_fails(2, "there is no slot resolv", "tune", room, "-o", out, budget, "--slots=resolv");
    glint_fails(2, "which is better when lower", "tune", room, "-o", out, budget, "--metric=psnr");
    glint_fails(2, "expected one run for each of 1 captures", "tune", room, "-o", out, budget, "--reference=a",
                "--reference=b");
    static const char *const axes[][2] = {
        {"--vary=scren_trace.steps", "there is no slot scren_trace"},
        {"--vary=screen_trace.step", "no parameter step (did you mean steps?)"},
        {"--vary=screen_trace.steps=0..8", "expected a range within 1 to"},
        {"--vary=screen_trace.steps=8..2", "expected A..B with A below B"},
        {"--vary=screen_trace.steps=2.5..64", "expected whole numbers"},
        {"--vary=screen_trace.steps=2..3", "expected a range that contains the start value"},
        {"--vary=screen_trace.steps=", "--vary: expected SLOT.PARAMETER"},
        {"--vary=screen_trace=linear,hizz", "no variant hizz"},
        {"--vary=screen_trace", "expected variants"},
        {"--vary=downsample.ndf", "would change the reference"},
        {"--vary=cubemap_trace.fallback=0..1", "expected a list of choices"},
        {"--vary=pipeline.rays=0..4", "expected a range within 1 to 1024"},
    };
    for (size_t i = 0; i < sizeof axes / sizeof *axes; i++)
        glint_fails(2, axes[i][1], "tune", room, "-o", out, PLAIN, "--reference=truth", budget, axes[i][0]);
    glint_fails(2, "no tuned parameter is a count", "tune", room, "-o", in_folder("odd.json"), PLAIN,
                "--reference=truth", budget, "--baseline=scale", "--repeat=0", "--rounds=1",
                "--vary=cubemap_trace.secant");
    glint_fails(1, "; its most expensive passes: screen_trace/linear takes 100 % (not tried: ", "tune", room, "-o",
                in_folder("none.json"), PLAIN, "--reference=truth", "--budget-ms=1e-6", "--slots=screen_trace",
                "--tries=1", "--rounds=1", AXES);
    glint_fails(2, "is given twice", "tune", room, "-o", out, PLAIN, "--reference=truth", budget,
                "--vary=screen_trace.steps", "--vary=screen_trace.steps=2..64");
    glint_fails(1, "truth.reflection.ggx: missing", "tune", in_folder("street.exr"), "-o", out, PLAIN,
                "--reference=truth", budget, "--vary=screen_trace.steps");
    /* a budget that no point meets; a folder with another search, and one whose log was edited */
    glint_fails(1, "no point meets a cost limit of 0.001 fetches/px: the best of", "tune", room, "-o", out, PLAIN,
                "--reference=truth", "--budget-fetches=0.001", "--tries=12", AXES);
    assert_false(file_exists(out));
    glint_fails(2, "bad.tune: contains a tune with other axes", "tune", room, "-o", out, PLAIN, "--reference=truth",
                "--budget-fetches=0.001", "--vary=screen_trace.steps");
    FILE *log = fopen(in_folder("bad.tune/log.jsonl"), "ab");
    assert_non_null(log);
    fputs("{\"values\":[\"1\"],\"captures\":[{\"error\":0,\"cost\":0}]}\n", log);
    fclose(log);
    glint_fails(1, "expected a line of this tune", "tune", room, "-o", out, PLAIN, "--reference=truth",
                "--budget-fetches=0.001", AXES);
    free(room);
    free(out);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_preset_is_what_was_found),     cmocka_unit_test(a_seed_gives_the_same_preset_again),
        cmocka_unit_test(an_interrupted_search_goes_on),    cmocka_unit_test(time_that_is_left_is_used),
        cmocka_unit_test(what_cannot_matter_is_left_alone), cmocka_unit_test(what_is_wrong_is_named),
    };
    return cmocka_run_group_tests(tests, make_captures, remove_folder);
}
