/* The output of --against for images: metrics by name, classes of pixels, intervals, non-finite values. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CAPTURE in_folder("box.exr")
#define RAIN in_folder("rain.exr")

static const json_t *image_of(const json_t *json) {
    const json_t *run = json_array_get(json_object_get(json, "runs"), 0);
    const json_t *image = json_object_get(json_object_get(run, "against_truth"), "image");
    assert_non_null(image);
    return image;
}

static int make_capture(void **state) {
    if (make_folder(state)) return -1;
    free(glint_ok("sample", "mirror_box", "-o", CAPTURE, "--size=96x54", "--cube-size=32", "--truth=1"));
    return 0;
}

/* Each set of classes contains every pixel once, and its means combine to the mean of all. */
static void check_sets(const json_t *classes, double pixels, double mean) {
    static const char *const sets[] = {"angle", "distance", "hit distance", "source"};
    for (size_t s = 0; s < sizeof sets / sizeof sets[0]; s++) {
        double here = 0, sum = 0;
        for (size_t i = 0; i < json_array_size(classes); i++) {
            const json_t *row = json_array_get(classes, i);
            if (strcmp(json_string_value(json_object_get(row, "set")), sets[s])) continue;
            here += number(row, "pixels");
            sum += number(row, "pixels") * number(row, "mean_error");
        }
        if (here != pixels) fail_msg("%s: %g of %g pixels", sets[s], here, pixels);
        assert_true(fabs(sum / pixels - mean) < 1e-6);
    }
}

static void classes_part_the_pixels(UNUSED void **state) {
    char *text = glint_ok("replay", CAPTURE, PLAIN, "--against=truth", "--json");
    json_t *json = parse_json(text);
    const json_t *image = image_of(json), *all = named(json_object_get(image, "surfaces"), "surfaces", "all");
    assert_true(number(all, "pixels") > 1000);
    check_sets(json_object_get(image, "classes"), number(all, "pixels"), number(all, "mean_error"));
    assert_true(number(image, "epsilon") == 0.01 && number(image, "peak") > 0);
    const json_t *interval = json_object_get(json_object_get(all, "interval"), "rmse");
    double low = json_number_value(json_array_get(interval, 0)), high = json_number_value(json_array_get(interval, 1));
    assert_true(0 < low && low < number(all, "rmse") && number(all, "rmse") < high);
    assert_true(number(all, "flip") > 0 && number(all, "ssim") < 1);
    assert_null(json_object_get(all, "hdr_flip"));
    /* the same again, bit for bit */
    char *again = glint_ok("replay", CAPTURE, PLAIN, "--against=truth", "--json");
    json_t *other = parse_json(again);
    assert_true(json_equal(image, image_of(other)));
    json_decref(json), json_decref(other);
    free(text), free(again);
}

static void metrics_are_chosen(UNUSED void **state) {
    char *text = glint_ok("replay", CAPTURE, PLAIN, "--against=truth", "--json", "--metrics=psnr,hdr_flip", "--ppd=20",
                          "--peak=2");
    json_t *json = parse_json(text);
    const json_t *image = image_of(json), *all = named(json_object_get(image, "surfaces"), "surfaces", "all");
    const json_t *exposures = json_object_get(image, "hdr_flip");
    assert_true(number(image, "ppd") == 20 && number(image, "peak") == 2);
    assert_true(number(all, "hdr_flip") > 0 && number(all, "hdr_flip") < 1 && number(all, "psnr") > 0);
    assert_true(number(exposures, "exposures") >= 2 && number(exposures, "start") < number(exposures, "stop"));
    assert_null(json_object_get(all, "rmse"));
    json_decref(json);
    free(text);
    text = glint_ok("replay", CAPTURE, PLAIN, "--against=truth", "--metrics=hdr_flip");
    assert_contains(text, "HDR-ꟻLIP over");
    free(text);
    glint_fails(2, "metric 'flop' (did you mean flip?): expected one of all, mean_error", "replay", CAPTURE,
                "--against=truth", "--metrics=flop");
    glint_fails(2, "above 0", "replay", CAPTURE, "--against=truth", "--ppd=0");
}

/* Presets without fog need not switch it off. */
static void advice_of_help_works_in_every_preset(UNUSED void **state) {
    static const char *const presets[] = {"mafia3", "mafia_de", "gtav", "kf2"};
    char *help = glint_ok("replay", "--help");
    assert_contains(help, "without fog");
    free(help);
    for (size_t i = 0; i < sizeof presets / sizeof *presets; i++)
        free(glint_ok("replay", CAPTURE, "--against=truth", "--preset", presets[i], "--set=pipeline.fog=false"));
}

/* End reasons of rays by those of the truth, and the sources of reflections in both. */
static void ends_are_held_against_the_truth_and_the_reference(UNUSED void **state) {
    char *text = glint_ok("replay", CAPTURE, PLAIN, "--against=truth", "--json", "--set=downsample.jitter=false");
    json_t *json = parse_json(text);
    const json_t *rays =
        json_object_get(json_object_get(json_array_get(json_object_get(json, "runs"), 0), "against_truth"), "rays");
    const json_t *hit = named(rays, "reason", "hit"), *truth = json_object_get(hit, "truth");
    assert_string_equal(json_string_value(json_object_get(hit, "tracer")), "screen");
    double screen = number(truth, "screen"), elsewhere = number(truth, "elsewhere"), sky = number(truth, "sky");
    assert_true(screen + elsewhere + sky == number(hit, "rays"));
    assert_true(screen > 0.9 * number(hit, "rays")); /* a screen trace finds what is visible on screen */
    json_decref(json);
    free(text);
    text = glint_ok("replay", CAPTURE, PLAIN, "--against=reference", "--diagnostics", "--json");
    json = parse_json(text);
    const json_t *sources = json_object_get(
        json_object_get(json_array_get(json_object_get(json, "runs"), 0), "against_reference"), "sources");
    const json_t *ours = json_object_get(sources, "screen");
    assert_true(number(ours, "screen") > number(ours, "cube map"));
    json_decref(json);
    free(text);
}

/* The image's errors against the truth, as text, after checking what is said of fog. */
static char *truth_errors(const char *setting, const char *said) {
    struct outcome outcome = glint("replay", RAIN, PLAIN, "--against=truth", "--json", setting, NULL);
    assert_int_equal(outcome.status, 0);
    assert_contains(outcome.err, said);
    json_t *json = parse_json(outcome.out);
    char *text = json_dumps(image_of(json), JSON_SORT_KEYS);
    json_decref(json);
    outcome_free(&outcome);
    return text;
}

static void both_sides_have_the_same_fog(UNUSED void **state) {
    static const char left_out[] = "its fog is left out", applied[] = "its fog is applied";
    free(glint_ok("sample", "rain_street", "--light=4", "-o", RAIN, "--size=48x27", "--cube-size=8", "--truth=1"));
    char *unsaid = truth_errors(NULL, left_out), *off = truth_errors("--set=pipeline.fog=false", left_out),
         *on = truth_errors("--set=pipeline.fog=true", applied);
    assert_string_equal(unsaid, off);
    assert_string_not_equal(unsaid, on);
    free(unsaid), free(off), free(on);

    char *clear = NULL, *fogged = NULL, *both = NULL;
    assert_true(asprintf(&clear, "--against=reference=%s", in_folder("clear")) > 0);
    assert_true(asprintf(&fogged, "--against=reference=%s", in_folder("fogged")) > 0);
    assert_true(asprintf(&both, "--against=both=%s", in_folder("fogged")) > 0);
    free(glint_ok("reference", RAIN, "-o", in_folder("clear"), "--rays=2", "--set=pipeline.fog=false"));
    free(glint_ok("reference", RAIN, "-o", in_folder("fogged"), "--rays=2"));
    struct outcome outcome = glint("replay", RAIN, PLAIN, clear, NULL);
    assert_int_equal(outcome.status, 0);
    assert_contains(outcome.err, left_out);
    outcome_free(&outcome);
    outcome = glint("replay", RAIN, PLAIN, fogged, NULL);
    assert_int_equal(outcome.status, 0);
    assert_null(strstr(outcome.err, left_out));
    outcome_free(&outcome);
    glint_fails(2, "expected a run with resolve.fog=0, as here, found 1", "replay", RAIN, PLAIN, both);
    glint_fails(2, "expected a run with downsample.ndf=blinn_phong, as here, found ggx", "replay", RAIN, PLAIN, fogged,
                "--set=downsample.ndf=blinn_phong");
    glint_fails(1, "nodir", "replay", RAIN, "--against=reference=nodir");
    free(clear), free(fogged), free(both);
}

static void what_is_no_number_fails(UNUSED void **state) {
    FILE *file = fopen(in_folder("bad.comp"), "w");
    assert_non_null(file);
    fputs("#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"shared/bindings.glsl\"\n"
          "#include \"bilinear.pass.h\"\n#include \"shared/push_begin.glsl\"\n#include \"bilinear.pass.h\"\n};\n"
          "void main() {\n    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);\n"
          "    if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;\n"
          "    bool bad = pixel == ivec2(41, 50) || pixel == ivec2(40, 51);\n"
          "    imageStore(reflection, pixel, vec4(bad ? uintBitsToFloat(0x7fc00000u) : 0.5));\n}\n",
          file);
    assert_int_equal(fclose(file), 0);
    char *shader = NULL;
    assert_true(asprintf(&shader, "--shader=upscale=%s", in_folder("bad.comp")) > 0);
    struct outcome outcome = glint("replay", CAPTURE, PLAIN, "--against=truth", shader, NULL);
    assert_int_equal(outcome.status, 1);
    assert_contains(outcome.err,
                    "NaN or infinite in 2 pixels, and in 0 of what it is compared with; the first is 41,50");
    outcome_free(&outcome);
    free(shader);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(classes_part_the_pixels),
        cmocka_unit_test(metrics_are_chosen),
        cmocka_unit_test(advice_of_help_works_in_every_preset),
        cmocka_unit_test(ends_are_held_against_the_truth_and_the_reference),
        cmocka_unit_test(both_sides_have_the_same_fog),
        cmocka_unit_test(what_is_no_number_fails),
    };
    return cmocka_run_group_tests(tests, make_capture, remove_folder);
}
