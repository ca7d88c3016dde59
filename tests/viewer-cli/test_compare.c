/* glint compare, as a user runs it: presets beside each other. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../capture-format/rewrite.h"

static const json_t *preset_of(const json_t *json, size_t capture, const char *name) {
    const json_t *row = json_array_get(json_object_get(json, "captures"), capture);
    return named(json_object_get(row, "presets"), "preset", name);
}

static const json_t *surfaces_of(const json_t *preset, const char *name) {
    return named(json_object_get(preset, "surfaces"), "surfaces", name);
}

static double share_of_ends(const json_t *preset) {
    double sum = 0;
    size_t i;
    const json_t *row;
    json_array_foreach(json_object_get(preset, "ends"), i, row) sum += number(row, "share");
    return sum;
}

/* The error of a preset with a reflection in every pixel equals that of `replay --against truth`. */
static void errors_are_those_of_replay(UNUSED void **state) {
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("room.exr"), "--size=96x54", "--cube-size=16",
                  "--truth=1"));
    char *text = glint_ok("compare", in_folder("room.exr"), "--presets=mafia3,kf2", "--repeat=2", "--json");
    json_t *json = parse_json(text);
    free(text);
    text = glint_ok("replay", in_folder("room.exr"), "--against=truth", "--set=resolve.fog=false", "--json");
    json_t *replayed = parse_json(text);
    free(text);
    const json_t *run = json_array_get(json_object_get(replayed, "runs"), 0);
    const json_t *image = json_object_get(json_object_get(run, "against_truth"), "image");
    const json_t *expected = json_object_get(image, "surfaces"), *mafia3 = preset_of(json, 0, "mafia3");
    assert_true(number(surfaces_of(mafia3, "all"), "coverage") == 1);
    for (size_t i = 0; i < json_array_size(expected); i++) {
        const json_t *row = json_array_get(expected, i);
        const json_t *own = surfaces_of(mafia3, json_string_value(json_object_get(row, "surfaces")));
        assert_true(number(own, "pixels") == number(row, "pixels"));
        assert_true(fabs(number(own, "symmetric") - number(row, "symmetric")) < 1e-9);
        assert_true(fabs(number(own, "rmse") - number(row, "rmse")) < 1e-9);
    }
    /* screen space alone has fewer reflections; common ones are equal */
    const json_t *kf2 = surfaces_of(preset_of(json, 0, "kf2"), "all");
    double coverage = number(kf2, "coverage");
    assert_true(coverage > 0.2 && coverage < 0.95);
    assert_true(number(json_object_get(kf2, "shared"), "symmetric") == number(kf2, "symmetric"));
    assert_true(number(json_object_get(surfaces_of(mafia3, "all"), "shared"), "pixels") == number(kf2, "given"));
    assert_true(fabs(share_of_ends(preset_of(json, 0, "kf2")) - 1) < 1e-9);
    assert_true(fabs(share_of_ends(mafia3) - 1) < 1e-9);
    assert_true(number(mafia3, "fetches") > 1 && number(mafia3, "steps") > 1);
    assert_true(number(json_object_get(mafia3, "frame_ms"), "n") == 2);
    assert_true(number(json_object_get(mafia3, "frame_ms"), "median") > 0);
    json_decref(json);
    json_decref(replayed);
}

/* One table and one sheet of all captures; presets that a scene cannot run are skipped and listed. */
static void several_captures_make_one_table_and_one_sheet(UNUSED void **state) {
    free(glint_ok("sample", "matte", "--light=4", "-o", in_folder("matte.exr"), "--size=32x18", "--cube-size=16",
                  "--truth=1"));
    free(glint_ok("sample", "mirror_box", "-o", in_folder("box.exr"), "--size=48x27", "--cube-size=16"));
    char *text = glint_ok("compare", in_folder("box.exr"), in_folder("matte.exr"), "--presets=kf2,mafia3_shipped",
                          "--repeat=1", "-o", in_folder("out"));
    assert_contains(text, "kf2");
    assert_contains(text, "left out: 0 of 576 pixels reflect");
    assert_contains(text, "part truth.reflection.ggx: missing");
    assert_contains(text, "hit a surface");
    free(text);
    json_t *json = json_load_file(in_folder("out/table.json"), 0, NULL);
    assert_non_null(json);
    assert_contains(json_string_value(json_object_get(preset_of(json, 1, "kf2"), "notes")), "screen_trace");
    assert_true(json_array_size(json_object_get(preset_of(json, 1, "kf2"), "surfaces")) == 0);
    json_decref(json);
    struct outcome csv =
        run_program("sh", "-c", "awk -F, 'NR > 1 { print $2 }' \"$0\"", in_folder("out/table.csv"), NULL);
    assert_string_equal(csv.out, "\"kf2\"\n\"mafia3_shipped\"\n\"kf2\"\n\"mafia3_shipped\"\n");
    outcome_free(&csv);
    text = glint_ok("compare", in_folder("matte.exr"), "--repeat=1", "--effect=reflection", "--json");
    json = parse_json(text);
    assert_non_null(preset_of(json, 0, "mafia_de = mafia_de_frame = mafia_de_taa")); /* one and the same reflections */
    assert_non_null(preset_of(json, 0, "mafia3"));
    json_decref(json);
    free(text);
    struct pixels sheet = read_png(in_folder("out/sheet.png"));
    assert_int_equal(sheet.width, 3 * (480 + 12) + 12);
    assert_true(sheet.height > 2 * 270);
    free(sheet.rgb);
}

/* Layers over opaque surfaces are compared in the final image; presets without them have larger errors. */
static void water_is_compared_in_the_finished_picture(UNUSED void **state) {
    free(glint_ok("sample", "lake", "--light=4", "-o", in_folder("lake.exr"), "--size=48x27", "--cube-size=16",
                  "--truth=1"));
    char *text = glint_ok("compare", in_folder("lake.exr"), "--presets=gtav,kf2", "--repeat=1", "--json");
    json_t *json = parse_json(text);
    const json_t *with = named(json_object_get(preset_of(json, 0, "gtav"), "over"), "part", "water");
    const json_t *without = named(json_object_get(preset_of(json, 0, "kf2"), "over"), "part", "water");
    assert_true(json_is_true(json_object_get(with, "drawn")) && json_is_false(json_object_get(without, "drawn")));
    assert_true(number(with, "pixels") > 200 && number(with, "pixels") == number(without, "pixels"));
    assert_true(number(with, "symmetric") < 0.7 * number(without, "symmetric"));
    /* the reflection of opaque surfaces excludes that of water */
    assert_true(number(surfaces_of(preset_of(json, 0, "gtav"), "all"), "pixels") < number(with, "pixels"));
    json_decref(json);
    free(text);
}

/* The left half of the truth has no weight: errors are unknown there, and not drawn. */
static void what_the_truth_does_not_know_is_neutral(UNUSED void **state) {
    static struct rewrite r;
    rewrite_load(&r, in_folder("room.exr"));
    const struct rewrite_part *truth = rewrite_find(&r, "truth.reflection.ggx");
    const uint32_t width = truth->part.width, height = truth->part.height;
    float *weight = rewrite_pixels(&r, "truth.reflection.ggx", "weight");
    for (size_t i = 0; i < (size_t)width * height; i++)
        if (i % width < width / 2) weight[i] = 0;
    rewrite_save(&r, in_folder("half.exr"));
    rewrite_finish(&r);
    free(glint_ok("compare", in_folder("half.exr"), "--presets=mafia3", "--repeat=1", "-o", in_folder("half")));
    const struct pixels error = read_png(in_folder("half/pictures/0-1-error.png"));
    assert_true(error.width == width && error.height == height);
    const uint8_t *neutral = pixel(&error, 0, 0);
    size_t painted = 0;
    assert_true(neutral[0] > 64 && abs(neutral[0] - neutral[1]) < 8 && abs(neutral[1] - neutral[2]) < 8);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const bool grey = !memcmp(pixel(&error, x, y), neutral, 3);
            if (x < width / 2) assert_true(grey);
            else painted += !grey;
        }
    assert_true(painted > (size_t)width * height / 4); /* most of the right half reflects */
    free(error.rgb);
}

static void settings_reach_their_preset_alone(UNUSED void **state) {
    char *text = glint_ok("compare", in_folder("box.exr"), "--presets=kf2,mafia3_shipped", "--repeat=1", "--json",
                          "--set=kf2:screen_trace.length_m=0.01");
    json_t *json = parse_json(text);
    assert_true(number(surfaces_of(preset_of(json, 0, "kf2"), "all"), "coverage") < 0.1);
    assert_true(number(surfaces_of(preset_of(json, 0, "mafia3_shipped"), "all"), "coverage") > 0.5);
    json_decref(json);
    free(text);
    glint_fails(2, "no capture given", "compare");
    glint_fails(2, "unknown preset 'kf3'", "compare", in_folder("box.exr"), "--presets=kf3");
    glint_fails(2, "preset kf2 is listed twice", "compare", in_folder("box.exr"), "--presets=kf2,kf2");
    glint_fails(2, "preset mafia3 is not among --presets", "compare", in_folder("box.exr"), "--presets=kf2",
                "--set=mafia3:resolve.fog=true");
    glint_fails(2, "preset kf2: resolve/blurred has no parameter blurr (did you mean blur?)", "compare",
                in_folder("box.exr"), "--presets=kf2", "--set=kf2:resolve.blurr=1");
    glint_fails(2, "expected PRESET:SLOT.PARAM=VALUE", "compare", in_folder("box.exr"), "--set=resolve.blur=1");
    glint_fails(1, "nowhere.exr", "compare", in_folder("nowhere.exr"));
}

/* Names, and that JSON says which effect was judged. */
static void an_effect_is_chosen_by_name(UNUSED void **state) {
    glint_fails(2, "there is no effect reflektion (did you mean reflection?)", "compare", in_folder("box.exr"),
                "--effect=reflektion");
    glint_fails(2, "there is no effect prepare", "reference", in_folder("box.exr"), "--effect=prepare");
    /* A preset without the slots of an effect */
    FILE *preset = fopen(in_folder("bare.json"), "w");
    assert_non_null(preset);
    fputs("{\"name\": \"bare\", \"title\": \"Normals\", \"source\": \"glint\", \"slots\": {\"downsample\": \"none\"}}",
          preset);
    fclose(preset);
    glint_fails(2, "--effect reflection: no slot of the pipeline makes the reflection", "stability",
                in_folder("box.exr"), "-p", in_folder("bare.json"), "--effect=reflection");
    char *text = glint_ok("passes", "--json");
    json_t *json = parse_json(text);
    const json_t *effects = json_object_get(json, "effects");
    assert_true(json_array_size(effects) >= 1);
    assert_string_equal(json_string_value(json_object_get(json_array_get(effects, 0), "effect")), "reflection");
    json_decref(json);
    free(text);
    text = glint_ok("compare", in_folder("box.exr"), "--presets=kf2", "--repeat=1", "--effect=reflection", "--json");
    json = parse_json(text);
    assert_string_equal(json_string_value(json_object_get(json, "effect")), "reflection");
    json_decref(json);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_those_of_replay),
        cmocka_unit_test(several_captures_make_one_table_and_one_sheet),
        cmocka_unit_test(water_is_compared_in_the_finished_picture),
        cmocka_unit_test(what_the_truth_does_not_know_is_neutral),
        cmocka_unit_test(settings_reach_their_preset_alone),
        cmocka_unit_test(an_effect_is_chosen_by_name),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
