/* The output of glint info for captures: mirror_box, and a street under the sky. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"

static char capture[256];

static int make_capture(void **state) {
    if (make_folder(state) != 0) return -1;
    snprintf(capture, sizeof capture, "%s", in_folder("box.exr"));
    free(glint_ok("sample", "mirror_box", "-o", capture, "--size=160x90", "--cube-size", "64"));
    return 0;
}

/* Floats represent a distance of 10 m to 2^-20 m; D24 with near at 0.1 m to 10² / 0.1 / (2²⁴ − 1), in the table and in JSON. */
static void info_tells_what_depth_resolves(UNUSED void **state) {
    const char *path = in_folder("device.exr");
    free(glint_ok("sample", "mirror_box", "-o", path, "--size=32x18", "--cube-size", "8", "--depth", "device"));
    const struct {
        const char *file, *storage;
        double at_10_m;
    } cases[] = {{capture, "R32F", ldexp(1, -20)}, {path, "D24", 1000.0 / 16777215}};
    for (size_t i = 0; i < 2; i++) {
        char *text = glint_ok("info", cases[i].file, "--headers", "--json");
        json_t *json = parse_json(text);
        const json_t *depth = json_object_get(json, "depth"),
                     *step = json_array_get(json_object_get(depth, "steps"), 1);
        assert_string_equal(json_string_value(json_object_get(depth, "storage")), cases[i].storage);
        assert_true(number(step, "at_m") == 10);
        /* the two values of D24 are not exactly at 10 m */
        assert_true(fabs(number(step, "step_m") / cases[i].at_10_m - 1) < 1e-4);
        json_decref(json);
        free(text);
    }
    char *text = glint_ok("info", path, "--headers");
    assert_contains(text, "0.6 µm at 1 m, 60 µm at 10 m");
    free(text);
}

static void info_tells_the_camera_and_the_ranges(UNUSED void **state) {
    char *text = glint_ok("info", capture), *json_text = glint_ok("info", capture, "--json");
    json_t *json = parse_json(json_text);
    const json_t *camera = json_object_get(json, "camera"), *position = json_object_get(camera, "position");
    /* Inside the box of 8 × 4 × 6 m, looking along a unit vector. */
    const double size[] = {8, 4, 6};
    double length = 0;
    for (size_t k = 0; k < 3; k++) {
        double p = json_number_value(json_array_get(position, k));
        double d = json_number_value(json_array_get(json_object_get(camera, "forward"), k));
        assert_true(p > 0 && p < size[k]);
        length += d * d;
    }
    assert_true(fabs(length - 1) < 1e-6);
    double aspect = tan(number(camera, "fov_x_deg") * M_PI / 360) / tan(number(camera, "fov_y_deg") * M_PI / 360);
    assert_true(fabs(aspect - 160.0 / 90) < 1e-6);

    const json_t *gbuffer = named(json_object_get(json, "parts"), "name", "gbuffer");
    assert_int_equal((int)number(gbuffer, "width"), 160);
    assert_int_equal((int)number(gbuffer, "height"), 90);
    const json_t *depth = named(json_object_get(gbuffer, "channels"), "name", "depth.Z");
    const json_t *range = json_object_get(depth, "range");
    assert_string_equal(json_string_value(json_object_get(depth, "unit")), "m");
    assert_true(number(range, "min") > 0 && number(range, "max") < sqrt(8 * 8 + 4 * 4 + 6 * 6));
    assert_int_equal((int)number(range, "nan"), 0);
    /* Every ray hits a wall: there is no sky, and the survey counts each pixel once. */
    const json_t *survey = json_object_get(json, "survey");
    assert_int_equal((int)number(survey, "pixels"), 160 * 90);
    assert_int_equal((int)number(survey, "sky"), 0);
    double reflecting = 0;
    for (size_t i = 0; i < 10; i++)
        reflecting += json_number_value(json_array_get(json_object_get(survey, "roughness"), i));
    assert_true(reflecting > 0 && fabs(reflecting - number(survey, "reflecting")) < 0.5);

    assert_contains(text, "cubemap.NNN × 8");
    assert_contains(text, "depth.Z");
    assert_contains(text, "reflecting");
    json_decref(json);
    free(text);
    free(json_text);
}

/* oiiotool reads the same file independently. */
static void ranges_equal_those_of_oiiotool(UNUSED void **state) {
    char *text = glint_ok("info", capture, "--json");
    json_t *json = parse_json(text);
    const json_t *lit = named(json_object_get(json, "parts"), "name", "lit");
    size_t index = 0;
    for (json_t *part; (part = json_array_get(json_object_get(json, "parts"), index)) != lit;) index++;
    char subimage[16];
    snprintf(subimage, sizeof subimage, "%zu", index);
    struct outcome other = run_program("oiiotool", capture, "--subimage", subimage, "--printstats", NULL);
    assert_int_equal(other.status, 0);
    static const char *const keys[] = {"min", "max", "mean"}, *const titles[] = {"Min: ", "Max: ", "Avg: "};
    static const char *const channels[] = {"R", "G", "B"};
    for (size_t k = 0; k < 3; k++) {
        const char *at = strstr(other.out, titles[k]);
        assert_non_null(at);
        char *end = (char *)at + strlen(titles[k]);
        for (size_t c = 0; c < 3; c++) {
            double theirs = strtod(end, &end);
            const json_t *channel = named(json_object_get(lit, "channels"), "name", channels[c]);
            double ours = number(json_object_get(channel, "range"), keys[k]);
            assert_true(fabs(ours - theirs) <= 1e-6 + 1e-5 * fabs(theirs)); /* printed with six digits */
        }
    }
    outcome_free(&other);
    json_decref(json);
    free(text);
}

static float *channel_of(struct glint_exr *exr, const char *name, size_t pixels) {
    struct glint_error err = {0};
    size_t part = 0;
    while (strcmp(glint_exr_part(exr, part)->name, "gbuffer") != 0) part++;
    float *values = malloc(pixels * sizeof *values);
    assert_non_null(values);
    if (!glint_exr_read(exr, part, &name, 1, GLINT_F32, values, 1, &err)) fail_msg("%s", err.message);
    return values;
}

/* The sample scenes write 0 at sky, where roughness is undefined; no surface of the street is as smooth. */
static void ranges_are_of_surfaces_alone(UNUSED void **state) {
    enum { PIXELS = 96 * 54 };
    struct glint_error err = {0};
    const char *path = in_folder("street.exr");
    free(glint_ok("sample", "street", "--light=4", "-o", path, "--size=96x54", "--cube-size", "16"));
    struct glint_exr *exr = glint_exr_open(path, NULL, &err);
    assert_non_null(exr);
    float *depth_m = channel_of(exr, "depth.Z", PIXELS), *roughness = channel_of(exr, "material.roughness", PIXELS);
    size_t surfaces = 0, smooth_sky = 0;
    double low = INFINITY, high = -INFINITY, sum = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const double r = (double)roughness[i];
        if (isinf(depth_m[i])) {
            smooth_sky += r < 0.01;
            continue;
        }
        surfaces++;
        low = fmin(low, r), high = fmax(high, r), sum += r;
    }
    assert_true(smooth_sky > 0 && surfaces > 0 && low > 0.01);

    char *text = glint_ok("info", path), *json_text = glint_ok("info", path, "--json");
    json_t *json = parse_json(json_text);
    const json_t *channels = json_object_get(named(json_object_get(json, "parts"), "name", "gbuffer"), "channels");
    const json_t *range = json_object_get(named(channels, "name", "material.roughness"), "range");
    assert_true(number(range, "values") == (double)surfaces);
    const double printed = 1e-8; /* with nine digits */
    assert_true(fabs(number(range, "min") - low) < printed && fabs(number(range, "max") - high) < printed);
    assert_true(fabs(number(range, "mean") - sum / (double)surfaces) < printed);
    const json_t *depths = json_object_get(named(channels, "name", "depth.Z"), "range");
    assert_true(number(depths, "values") == PIXELS && number(depths, "inf") == (double)(PIXELS - surfaces));
    assert_contains(text, "ranges cover surfaces only");
    json_decref(json);
    free(text);
    free(json_text);
    free(depth_m);
    free(roughness);
    glint_exr_close(&exr);
}

/* What a preset leaves out is the list of the passes that its plan does not run, however many they are. */
static void info_lists_what_presets_leave_out(UNUSED void **state) {
    char *info_text = glint_ok("info", capture, "--json");
    json_t *info = parse_json(info_text);
    size_t longest = 0;
    for (size_t i = 0; i < json_array_size(json_object_get(info, "presets")); i++) {
        const json_t *preset = json_array_get(json_object_get(info, "presets"), i);
        char *plan_text =
            glint_ok("plan", capture, "--preset", json_string_value(json_object_get(preset, "preset")), "--json");
        json_t *plan = parse_json(plan_text);
        const json_t *passes = json_object_get(plan, "passes"), *left_out = json_object_get(preset, "left_out");
        size_t count = 0;
        assert_true(json_is_array(left_out) && json_is_array(json_object_get(preset, "effects")));
        for (size_t k = 0; k < json_array_size(passes); k++) {
            const json_t *pass = json_array_get(passes, k);
            if (json_is_true(json_object_get(pass, "runs"))) continue;
            assert_true(json_equal(json_array_get(left_out, count++), json_object_get(pass, "slot")));
        }
        assert_int_equal(count, json_array_size(left_out));
        longest = count > longest ? count : longest;
        json_decref(plan);
        free(plan_text);
    }
    assert_true(longest > 0);
    json_decref(info);
    free(info_text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(info_tells_the_camera_and_the_ranges), cmocka_unit_test(info_tells_what_depth_resolves),
        cmocka_unit_test(ranges_equal_those_of_oiiotool),       cmocka_unit_test(ranges_are_of_surfaces_alone),
        cmocka_unit_test(info_lists_what_presets_leave_out),
    };
    return cmocka_run_group_tests(tests, make_capture, remove_folder);
}
