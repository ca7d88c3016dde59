/* glint blame, as a user runs it. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A small pipeline: the linear march, the cube maps, one resolve. The tests hold for any number of rays, so there are few. */
#define FEW "--use=cubemap_mips=plain" /* as the reference has them, and so no player */
#define SMALL PLAIN, "--rays=4", "--player-rays=2", FEW

static const json_t *errors_of(const json_t *sum, const char *answer, const char *class) {
    return json_object_get(json_object_get(json_object_get(sum, "errors"), answer), class);
}

/* The shares of every reference and class sum up to the difference between preset and reference. */
static void assert_sums(const json_t *sum, size_t answers) {
    const char *answer, *class, *name;
    json_t *classes, *errors, *player;
    assert_int_equal(json_object_size(json_object_get(sum, "errors")), answers);
    json_object_foreach(json_object_get(sum, "errors"), answer, classes) {
        assert_true(json_object_size(classes) >= 2);
        json_object_foreach(classes, class, errors) {
            double shares = 0, size = 0;
            json_object_foreach(json_object_get(errors, "players"), name, player) {
                shares += number(player, "share");
                size += fabs(number(player, "share"));
            }
            assert_true(number(errors, "preset") > 0 && number(errors, "reference") > 0);
            /* some hundred additions */
            assert_true(fabs(shares - (number(errors, "preset") - number(errors, "reference"))) <
                        1e-12 * (size + number(errors, "preset")));
        }
    }
}

/* The errors of pipelines by `glint sweep`, which is independent of players. */
static void sweep_upscale(const char *cache, double errors[2]) {
    free(glint_ok("sweep", in_folder("room.exr"), "-o", in_folder("swept"), PLAIN, FEW, "--rays=4", "--repeat=0",
                  "--no-pictures", "--vary=upscale=best_match,bilinear", cache));
    json_t *json = load_json("swept/points.json");
    for (size_t i = 0; i < 2; i++) {
        const json_t *row =
            json_array_get(json_object_get(json_array_get(json_object_get(json, "points"), i), "captures"), 0);
        errors[i] =
            number(json_object_get(json_object_get(json_object_get(row, "errors"), "reference"), "all"), "symmetric");
    }
    json_decref(json);
}

/* The mean of a pipeline's two rounds, which is their median. */
static double logged_ms(const char *name, int coalition) {
    FILE *log = fopen(in_folder(name), "rb");
    char line[8192];
    double sum = 0;
    int rounds = 0;
    assert_non_null(log);
    while (fgets(line, sizeof line, log)) {
        json_t *json = parse_json(line);
        if (json_object_get(json, "round") && (int)number(json, "coalition") == coalition) {
            sum += number(json, "frame_ms");
            rounds++;
        }
        json_decref(json);
    }
    fclose(log);
    assert_int_equal(rounds, 2);
    return sum / rounds;
}

/* Catches: shares with a wrong sum, errors of wrong pipelines, a missing reference. */
static void shares_add_up_to_the_error(UNUSED void **state) {
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("room.exr"), "--size=32x18", "--cube-size=8",
                  "--truth=1"));
    char *cache = NULL;
    assert_true(asprintf(&cache, "--cache=%s", in_folder("cache")) > 0);
    char *text = glint_ok("blame", in_folder("room.exr"), "-o", in_folder("blame"), SMALL, "--use=upscale=best_match",
                          "--repeat=2", cache);
    assert_contains(text, "against the reference");
    assert_contains(text, "against the truth");
    assert_contains(text, "exact, from all");
    assert_contains(text, "left if all others are ideal");
    const char *times = strstr(text, "% of the error saved per ms");
    assert_non_null(times);
    assert_null(strstr(times, "e-0")); /* shares of the error, which is a number that can be read */
    free(text);
    json_t *found = load_json("blame/shares.json");
    const json_t *capture = json_array_get(json_object_get(found, "captures"), 0),
                 *players = json_object_get(found, "players"), *all = errors_of(capture, "reference", "all");
    const int count = (int)json_array_size(players);
    assert_true(count >= 4);
    assert_sums(capture, 2);
    assert_sums(json_object_get(found, "mean"), 2);
    assert_int_equal(number(capture, "pipelines"), 1 << count);
    /* one evaluation of each, and two rounds of both ends and of single replacements of either */
    assert_int_equal(count_lines("blame/log.jsonl"), (1 << count) + 2 * (2 * count + 2));
    double errors[2];
    sweep_upscale(cache, errors);
    free(cache);
    assert_true(reference_seconds("swept/reflection-*") == reference_seconds("blame/reflection-*"));
    assert_true(fabs(number(all, "preset") - errors[0]) < 1e-9);
    assert_true(fabs(number(all, "preset") -
                     number(json_object_get(json_object_get(all, "players"), "upscale"), "removed") - errors[1]) <
                1e-9);
    /* players count from the last one that runs; rays are the first */
    const double own = logged_ms("blame/log.jsonl", 0), many = logged_ms("blame/log.jsonl", 1 << (count - 1));
    assert_true(own > 0 && many > 0);
    assert_true(fabs(number(json_object_get(capture, "frame_ms"), "preset") - own) < 1e-9);
    assert_true(fabs(number(json_object_get(json_object_get(capture, "costs"), "rays"), "added_ms") - (many - own)) <
                1e-9);
    assert_true(number(json_object_get(json_object_get(capture, "costs"), "rays"), "added_fetches_px") > 0);
    assert_true(file_exists(in_folder("blame/index.html")) && file_exists(in_folder("blame/shares.svg")));
    assert_true(file_exists(in_folder("blame/bought.svg")) && file_exists(in_folder("blame/page.json")));
    char *svg = checked(run_program("cat", in_folder("blame/bought.svg"), NULL), 0, __FILE__, __LINE__);
    assert_contains(svg,
                    "zr0-cls-0"); /* the script draws it after others, and writes what it would write as the first */
    assert_null(strstr(svg, "zr1-"));
    free(svg);
    json_decref(found);
}

/* Stored results are reused for any options; after a kill, the same command resumes. */
static void a_killed_blame_goes_on(UNUSED void **state) {
    char command[1024];
    static const char arguments[] = FEW " --rays=4 --player-rays=2 --use=upscale=best_match --repeat=0";
    snprintf(command, sizeof command,
             "cd %s && exec \"$GLINT\" blame room.exr -o killed -p %s %s & pid=$!; "
             "until [ \"$(cat %s/killed/log.jsonl 2>/dev/null | wc -l)\" -ge 5 ]; do kill -0 $pid || exit 9; sleep "
             "0.05; done; kill -9 $pid; wait $pid",
             in_folder(""), GLINT_TEST_PRESET, arguments, in_folder(""));
    struct outcome killed = run_program("sh", "-c", command, NULL);
    assert_int_equal(killed.status, 128 + 9);
    outcome_free(&killed);
    if (file_exists(in_folder("killed/shares.json"))) { /* the results so far */
        json_t *partial = load_json("killed/shares.json");
        assert_true(json_is_false(json_object_get(partial, "complete")));
        json_decref(partial);
    }
    FILE *log = fopen(in_folder("killed/log.jsonl"), "ab");
    assert_non_null(log);
    fputs("{\"errors\":{\"reference\":{\"all\":{\"pix", log);
    fclose(log);
    snprintf(command, sizeof command, "cd %s && \"$GLINT\" blame room.exr -o killed -p %s %s", in_folder(""),
             GLINT_TEST_PRESET, arguments);
    free(checked(run_program("sh", "-c", command, NULL), 0, __FILE__, __LINE__));
    json_t *whole = load_json("blame/shares.json"), *resumed = load_json("killed/shares.json");
    assert_true(json_equal(json_object_get(json_object_get(whole, "mean"), "errors"),
                           json_object_get(json_object_get(resumed, "mean"), "errors")));
    assert_int_equal(count_lines("killed/log.jsonl"), 1 << json_array_size(json_object_get(whole, "players")));
    json_decref(whole);
    json_decref(resumed);
}

/* Errors are complete on screen and in the folder without waiting for times, which can be added later. */
static void answers_come_before_times(UNUSED void **state) {
    char command[1024];
    static const char arguments[] = FEW " --rays=4 --player-rays=2 --use=upscale=best_match";
    snprintf(command, sizeof command,
             "cd %s && cp -r killed asked && exec \"$GLINT\" blame room.exr -o asked -p %s %s --repeat=100000 & "
             "pid=$!; i=0; "
             "until grep -q '\"round\":' %s/asked/log.jsonl 2>/dev/null; do i=$((i+1)); [ $i -lt 600 ] || exit 9; "
             "sleep 0.05; "
             "done; kill -INT $pid; wait $pid",
             in_folder(""), GLINT_TEST_PRESET, arguments, in_folder(""));
    /* a shell's background job ignores interrupts, which its programs inherit; glint handles them nevertheless */
    struct outcome stopped = run_program("sh", "-c", command, NULL);
    assert_int_equal(stopped.status, 130);
    assert_contains(stopped.out, "exact, from all");
    assert_contains(stopped.out, "ms added if ideal");
    assert_contains(stopped.err, " are kept in ");
    outcome_free(&stopped);
    json_t *whole = load_json("blame/shares.json"), *found = load_json("asked/shares.json");
    assert_true(json_is_false(json_object_get(found, "complete")) && json_is_true(json_object_get(whole, "complete")));
    assert_true(json_equal(json_object_get(json_object_get(whole, "mean"), "errors"),
                           json_object_get(json_object_get(found, "mean"), "errors")));
    assert_true(file_exists(in_folder("asked/index.html")));
    const int lines = count_lines("asked/log.jsonl");
    json_decref(found);
    free(glint_ok("blame", in_folder("room.exr"), "-o", in_folder("asked"), SMALL, "--use=upscale=best_match",
                  "--repeat=1"));
    found = load_json("asked/shares.json");
    assert_true(json_is_true(json_object_get(found, "complete")) && count_lines("asked/log.jsonl") >= lines);
    const json_t *ms = json_object_get(json_object_get(found, "mean"), "frame_ms");
    assert_true(number(ms, "preset") > 0 && number(ms, "reference") > 0);
    json_decref(found);
    json_decref(whole);
}

/* Permutations in the same folder: no pipeline runs again, and another error has shares as well. */
static void permutations_have_intervals(UNUSED void **state) {
    const int lines = count_lines("killed/log.jsonl");
    free(glint_ok("blame", in_folder("room.exr"), "-o", in_folder("killed"), SMALL, "--use=upscale=best_match",
                  "--repeat=0", "--exact=0", "--permutations=20", "--interval=50", "--metric=relative_mse"));
    json_t *found = load_json("killed/shares.json");
    assert_int_equal(count_lines("killed/log.jsonl"), lines);
    const json_t *mean = json_object_get(found, "mean");
    assert_string_equal(json_string_value(json_object_get(found, "metric")), "relative_mse");
    assert_true(json_is_false(json_object_get(mean, "exact")));
    const double permutations = number(mean, "permutations");
    assert_true(permutations >= 2 && permutations <= 20);
    assert_sums(mean, 2);
    const json_t *rays = json_object_get(json_object_get(errors_of(mean, "reference", "all"), "players"), "rays");
    assert_true(number(rays, "low") < number(rays, "share") && number(rays, "share") < number(rays, "high"));
    json_decref(found);
}

static void several_captures_have_their_mean(UNUSED void **state) {
    free(glint_ok("sample", "street", "--light=4", "-o", in_folder("street.exr"), "--size=32x18", "--cube-size=8"));
    free(glint_ok("blame", in_folder("room.exr"), in_folder("street.exr"), "-o", in_folder("two"), SMALL, "--repeat=0",
                  "--exact=0", "--permutations=2"));
    json_t *found = load_json("two/shares.json");
    const json_t *captures = json_object_get(found, "captures"), *mean = json_object_get(found, "mean");
    const char *name;
    json_t *player;
    json_object_foreach(json_object_get(errors_of(mean, "reference", "all"), "players"), name, player) {
        double sum = 0;
        for (size_t c = 0; c < 2; c++)
            sum += number(
                json_object_get(json_object_get(errors_of(json_array_get(captures, c), "reference", "all"), "players"),
                                name),
                "share");
        assert_true(fabs(number(player, "share") - sum / 2) < 1e-12);
    }
    assert_sums(json_array_get(captures, 0), 2);
    assert_sums(json_array_get(captures, 1), 1); /* there is no truth */
    assert_sums(mean, 1);
    json_decref(found);
}

static double share_of(const char *folder, const char *name) {
    char path[64];
    snprintf(path, sizeof path, "%s/shares.json", folder);
    json_t *found = load_json(path);
    const json_t *all = errors_of(json_array_get(json_object_get(found, "captures"), 0), "reference", "all");
    const double share = number(json_object_get(json_object_get(all, "players"), name), "share");
    json_decref(found);
    return share;
}

/* A pass with history has a larger share in a shot than in a single frame. */
static void a_shot_has_a_history(UNUSED void **state) {
    static const char *const use = "--use=temporal=rough";
    char frames[2][600];
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("shot.exr"), "--frames=2", "--size=32x18",
                  "--cube-size=8"));
    for (int i = 0; i < 2; i++)
        snprintf(frames[i], sizeof frames[i], "%s", in_folder("shot.0001.exr")),
            frames[i][strlen(frames[i]) - 5] = (char)('1' + i);
    free(glint_ok("blame", frames[1], "-o", in_folder("alone"), SMALL, use, "--repeat=0", "--exact=0",
                  "--permutations=2"));
    free(glint_ok("blame", "--shot", frames[0], frames[1], "-o", in_folder("shot"), SMALL, use, "--repeat=1",
                  "--exact=0", "--permutations=2"));
    assert_true(share_of("shot", "temporal") < share_of("alone", "temporal") - 1e-4);
    glint_fails(2, "expected frame 3 of the shot, found 2", "blame", "--shot", frames[1], frames[1], "-o",
                in_folder("odd"), SMALL);
    glint_fails(2, "expected at least two frames", "blame", "--shot", frames[1]);
}

static void what_is_wrong_is_named(UNUSED void **state) {
    char *room = strdup(in_folder("room.exr")), *street = strdup(in_folder("street.exr"));
    glint_fails(2, "no capture given", "blame");
    glint_fails(1, "no.exr", "blame", "no.exr");
    glint_fails(2, "metric 'rmsd' (did you mean rmse?): expected one of", "blame", room, "--metric=rmsd");
    glint_fails(2, "--metric psnr: expected an error", "blame", room, "--metric=psnr");
    glint_fails(2, "--metric mean_error: expected an error", "blame", room, "--metric=mean_error");
    glint_fails(2, "--metric rmse,flip: expected one metric", "blame", room, "--metric=rmse,flip");
    glint_fails(2, "--interval 0: expected a percentage", "blame", room, "--interval=0");
    glint_fails(2, "--interval=nan: expected 1 number", "blame", room, "--interval=nan");
    glint_fails(2, "--exact", "blame", room, "--exact=21");
    glint_fails(2, "--permutations", "blame", room, "--permutations=1");
    glint_fails(2, "--player-rays", "blame", room, "--player-rays=2000");
    glint_fails(2, "reference: no slot differs from the reference", "blame", room, "-p", "reference");
    glint_fails(2, "no variant hizz (did you mean hiz?)", "blame", room, "--use=screen_trace=hizz");
    glint_fails(2, "expected one run for each of 1 captures, found 2", "blame", room, "--reference=a", "--reference=b");
    glint_fails(2, "expected either runs or truth", "blame", room, "--reference=a", "--reference=truth");
    glint_fails(1, "street.exr: part truth.reflection.ggx: missing", "blame", street, SMALL, "--reference=truth");
    glint_fails(2, "killed: contains a blame with other reference_rays: 4 instead of 8", "blame", room, "-o",
                in_folder("killed"), SMALL, "--use=upscale=best_match", "--rays=8");
    glint_fails(2, "contains a blame with other players", "blame", room, "-o", in_folder("killed"), SMALL,
                "--use=upscale=best_match", "--player-rays=3");
    static const char *const strange[] = {
        "{\"capture\":0,\"coalition\":4096,\"errors\":{}}", "{\"capture\":1,\"coalition\":0,\"errors\":{}}",
        "{\"capture\":0,\"coalition\":0}", "{\"capture\":-1,\"coalition\":0,\"errors\":{}}", "[]"};
    for (size_t i = 0; i < sizeof strange / sizeof *strange; i++) {
        free(checked(run_program("cp", in_folder("blame/log.jsonl"), in_folder("killed/log.jsonl"), NULL), 0, __FILE__,
                     __LINE__));
        FILE *log = fopen(in_folder("killed/log.jsonl"), "ab");
        assert_non_null(log);
        fprintf(log, "%s\n", strange[i]);
        fclose(log);
        glint_fails(1, "expected a line of this blame", "blame", room, "-o", in_folder("killed"), SMALL,
                    "--use=upscale=best_match", "--repeat=0");
    }
    free(room);
    free(street);
}

/* The handbook contains the reference of each slot. */
static void the_handbook_shows_references(UNUSED void **state) {
    char *text = glint_ok("passes", "cubemap_trace/exact");
    assert_contains(text, "The reference uses this variant, with skip=true, cubemap_mips.join=nearest");
    free(text);
    text = glint_ok("passes", "blur");
    assert_contains(text, "The reference leaves this slot out: a pixel of the reference uses only its own rays");
    free(text);
    text = glint_ok("passes", "lit_mips", "--json");
    json_t *passes = parse_json(text);
    free(text);
    const json_t *reference = json_object_get(json_array_get(json_object_get(passes, "passes"), 0), "reference");
    assert_true(json_is_false(json_object_get(reference, "is")));
    assert_non_null(json_object_get(json_object_get(reference, "with"), "downsample"));
    json_decref(passes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_add_up_to_the_error),       cmocka_unit_test(a_killed_blame_goes_on),
        cmocka_unit_test(answers_come_before_times),        cmocka_unit_test(permutations_have_intervals),
        cmocka_unit_test(several_captures_have_their_mean), cmocka_unit_test(a_shot_has_a_history),
        cmocka_unit_test(what_is_wrong_is_named),           cmocka_unit_test(the_handbook_shows_references),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
