/* glint stability, as a user runs it: figures, layers, checks. gpu_stability tests the values. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"

static double largest_of(const char *file, const char *part, const char *channel) {
    struct glint_error err = {0};
    struct glint_exr *exr = glint_exr_open(file, NULL, &err);
    double largest = 0;
    if (!exr) fail_msg("%s", err.message);
    for (size_t p = 0; p < glint_exr_part_count(exr); p++) {
        const struct glint_exr_part_info *info = glint_exr_part(exr, p);
        const size_t pixels = (size_t)info->width * info->height;
        if (strcmp(info->name, part) != 0) continue;
        float *values = malloc(pixels * sizeof *values);
        assert_true(glint_exr_read(exr, p, &channel, 1, GLINT_F32, values, 0, &err));
        for (size_t i = 0; i < pixels; i++) largest = fmax(largest, isfinite(values[i]) ? (double)values[i] : 0);
        free(values);
    }
    glint_exr_close(&exr);
    return largest;
}

/* Catches: layers of one image under the name of another, a forecast that differs from the image's values. */
static void layers_match_the_figures(UNUSED void **state) {
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("room.exr"), "--size=64x36", "--cube-size=16"));
    char *text = glint_ok("stability", in_folder("room.exr"), PLAIN, "--seeds=2", "-o", in_folder("stable"), "--json",
                          "--bound=5");
    json_t *json = parse_json(text), *kept = json_load_file(in_folder("stable/stability.json"), 0, NULL);
    const json_t *images = json_object_get(json, "images"), *passes = json_object_get(json, "passes");
    assert_true(json_array_size(json_object_get(kept, "images")) == json_array_size(images));
    const json_t *travelled = named(images, "name", "travelled"), *lit = named(images, "name", "lit");
    const json_t *worst = json_array_get(json_object_get(travelled, "worst"), 0);
    const json_t *pass = named(passes, "slot", "cubemap_trace");
    char file[128];
    snprintf(file, sizeof file, "stable/%02d-cubemap_trace.exr", (int)number(pass, "place"));
    const double largest = largest_of(in_folder(file), "travelled", "amplification");
    assert_true(number(worst, "amplification") > 0);
    assert_true(number(worst, "amplification") <= largest * (1 + 1e-5)); /* JSON has at least six digits */
    assert_true(number(json_object_get(travelled, "amplification"), "largest") == number(worst, "amplification"));
    assert_true(largest_of(in_folder(file), "travelled", "flips") <= 2);
    const double peak =
        fmax(largest_of(in_folder("room.exr"), "lit", "R"),
             fmax(largest_of(in_folder("room.exr"), "lit", "G"), largest_of(in_folder("room.exr"), "lit", "B")));
    assert_true(fabs(number(json_object_get(lit, "overflow"), "largest") - peak) <= 1e-6 * peak);
    double starts = 0, above = 0;
    size_t i;
    const json_t *row;
    json_array_foreach(passes, i, row) {
        starts += number(row, "starts");
        above = fmax(above, number(json_object_get(row, "amplification"), "above"));
    }
    /* Each pixel starts at most once, and every one above the bound has started. */
    assert_true(starts >= above && starts <= 64 * 36);
    free(text);
    json_decref(json);
    json_decref(kept);
    free(glint_ok("view", in_folder("stable"), "--image=travelled", "-o", in_folder("worst.png")));
    struct pixels sheet = read_png(in_folder("stable/stability.png"));
    assert_true(sheet.width > 480);
    free(sheet.rgb);
}

static void checks_end_with_their_status(UNUSED void **state) {
    free(glint_ok("stability", in_folder("room.exr"), PLAIN, "--seeds=1", "--fail-above=1e30"));
    struct outcome found = glint("stability", in_folder("room.exr"), PLAIN, "--seeds=1", "--fail-above=0.001", NULL);
    assert_int_equal(found.status, 1);
    assert_contains(found.err, "downsample");
    outcome_free(&found);
    free(glint_ok("stability", in_folder("room.exr"), PLAIN, "--seeds=1", "--fail-above=0.001", "--fail-percent=100"));
    glint_fails(2, "found \"gbuffer:depht\"", "stability", in_folder("room.exr"), "--perturb=gbuffer:depht");
    glint_fails(2, "no capture given", "stability");
    glint_fails(2, "the same bound", "stability", in_folder("room.exr"), "--bound=3", "--fail-above=4");
    glint_fails(1, "nowhere.exr", "stability", in_folder("nowhere.exr"));
}

/* Perturbing albedo changes nothing, because rays do not depend on it. */
static void what_is_not_read_moves_nothing(UNUSED void **state) {
    char *text = glint_ok("stability", in_folder("room.exr"), PLAIN, "--seeds=2", "--perturb=gbuffer:albedo", "--json");
    json_t *json = parse_json(text);
    const json_t *images = json_object_get(json, "images");
    const json_t *travelled = named(images, "name", "travelled"), *composed = named(images, "name", "composed");
    assert_true(number(json_object_get(travelled, "amplification"), "largest") == 0);
    assert_true(number(travelled, "flipped") == 0);
    assert_true(number(json_object_get(composed, "amplification"), "largest") > 0);
    json_decref(json);
    free(text);
}

/* A pass that divides zero by zero in one channel of a pixel is named, before a pass that reads its image. */
static void the_first_pass_that_is_not_finite_is_named(UNUSED void **state) {
    static const char shader[] = "#version 460\n"
                                 "#extension GL_GOOGLE_include_directive : require\n"
                                 "#extension GL_EXT_samplerless_texture_functions : require\n"
                                 "#include \"shared/bindings.glsl\"\n"
                                 "#include \"bilinear.pass.h\"\n"
                                 "#include \"shared/push_begin.glsl\"\n"
                                 "#include \"bilinear.pass.h\"\n"
                                 "};\n"
                                 "void main() {\n"
                                 "    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);\n"
                                 "    if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;\n"
                                 "    float zero = float(dispatch_level);\n"
                                 "    float green = pixel == ivec2(40, 30) ? zero / zero : 1.0;\n"
                                 "    imageStore(reflection, pixel, vec4(1.0, green, 1.0, 1.0));\n"
                                 "}\n";
    FILE *file = fopen(in_folder("zero.comp"), "w");
    assert_non_null(file);
    assert_true(fputs(shader, file) >= 0 && fclose(file) == 0);
    char option[256];
    snprintf(option, sizeof option, "--shader=upscale=%s", in_folder("zero.comp"));
    char *text = glint_ok("stability", in_folder("room.exr"), PLAIN, "--seeds=1", "--json", option);
    json_t *json = parse_json(text);
    const json_t *first = json_object_get(json, "first_invalid"), *made = json_object_get(first, "made");
    assert_true(json_is_null(json_object_get(first, "captured")));
    assert_string_equal(json_string_value(json_object_get(made, "slot")), "upscale");
    assert_string_equal(json_string_value(json_object_get(made, "image")), "reflection");
    assert_string_equal(json_string_value(json_object_get(made, "channel")), "G");
    assert_string_equal(json_string_value(json_object_get(made, "value")), "NaN");
    assert_true(number(made, "x") == 40 && number(made, "y") == 30 && number(made, "not_finite") == 1);
    json_decref(json);
    free(text);
    text = glint_ok("stability", in_folder("room.exr"), PLAIN, "--seeds=1", option);
    assert_contains(text, "The first pass whose values are not finite is upscale/bilinear: reflection G at 40,30 is");
    free(text);
    text = glint_ok("stability", in_folder("room.exr"), PLAIN, "--seeds=1");
    assert_null(strstr(text, "not finite"));
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_match_the_figures),
        cmocka_unit_test(checks_end_with_their_status),
        cmocka_unit_test(what_is_not_read_moves_nothing),
        cmocka_unit_test(the_first_pass_that_is_not_finite_is_named),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
