/* glint diff, as a user runs it: compared with idiff on the same files, with runs, and with the engine's intermediates. */
#include "cli.h"
#include "need.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT };

static void write_encoded(const char *name, const char *part, uint32_t width, size_t channels, const float *values,
                          const char *color) {
    static const char *const names[] = {"R", "G", "B", "A"};
    struct glint_error err = {0};
    struct glint_exr_channel list[4];
    for (size_t k = 0; k < channels; k++)
        list[k] = (struct glint_exr_channel){.name = names[k],
                                             .stored = GLINT_STORED_FLOAT,
                                             .data = values + k,
                                             .x_stride_bytes = 4 * channels,
                                             .y_stride_bytes = 4 * channels * width};
    const struct glint_exr_attribute attribute = {.name = "glint.color", .type = GLINT_EXR_STRING, .string = color};
    const struct glint_exr_part file = {.name = part,
                                        .width = width,
                                        .height = PIXELS / width,
                                        .channels = list,
                                        .channel_count = channels,
                                        .attributes = &attribute,
                                        .attribute_count = color ? 1 : 0};
    if (!glint_exr_write(in_folder(name), &file, 1, 0, &err)) fail_msg("%s", err.message);
}
static void write_image(const char *name, const char *part, uint32_t width, size_t channels, const float *values) {
    write_encoded(name, part, width, channels, values, NULL);
}

static float values[4 * PIXELS], others[4 * PIXELS];

static void write_pair(void) {
    for (size_t i = 0; i < 3 * PIXELS; i++) others[i] = values[i] = 0.1F + 0.05F * (float)(i % 17);
    values[3 * 77] = others[3 * 77] = NAN;
    values[3 * 78] = others[3 * 78] = INFINITY;
    for (size_t i = 200; i < 220; i++) others[3 * i + 1] += 1e-3F;
    others[3 * (9 * WIDTH + 7) + 2] += 0.25F;
    write_image("a.exr", "a", WIDTH, 3, values);
    write_image("b.exr", "b", WIDTH, 3, others);
}

/* "Mean error = 0.1" */
static double figure_of(const char *text, const char *name) {
    const char *at = strstr(text, name);
    if (!at) fail_msg("idiff says nothing of %s: %s", name, text);
    return atof(strchr(at, '=') + 1);
}

/* Catches: options that are confused, counts of values instead of pixels, and limits that are inclusive. */
static void verdicts_are_idiffs(UNUSED void **state) {
    static const char *const limits[] = {
        "-fail 1e-6",
        "-fail 0.01",
        "-fail 0.3 -warn 0.3",
        "-fail 0.01 -failpercent 0.08 -warn 1",
        "-fail 0.01 -failpercent 0.09 -warn 1",
        "-fail 0.01 -failpercent 0.09",
        "-fail 0.0001 -failpercent 1.7 -warn 1",
        "-fail 0.0001 -failpercent 1.75 -warn 1",
        "-fail 0.0001 -failpercent 1.8 -warn 1",
        "-fail 0.0001 -failpercent 5 -hardfail 0.2 -warn 1",
        "-fail 0.0001 -failpercent 5 -hardfail 0.3 -warn 1",
        "-fail 0.0001 -failpercent 5 -warn 0.0001 -warnpercent 5",
        "-fail 0.0001 -failpercent 5 -warn 0.0001 -warnpercent 1",
        "-fail 0.0001 -failpercent 5 -warn 1 -hardwarn 0.2",
        "-failrelative 0.1",
        "-failrelative 2 -warnrelative 2",
        "-allowfailures 20",
        "-allowfailures 21",
        "-fail 0.01 -allowfailures 1 -hardfail 0.1",
    };
    char line[512];
    need_program("idiff"); /* the exit status of a shell is less specific */
    write_pair();
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        snprintf(line, sizeof line, "idiff %s \"$0\" \"$1\"", limits[i]);
        struct outcome theirs = run_program("sh", "-c", line, in_folder("a.exr"), in_folder("b.exr"), NULL);
        snprintf(line, sizeof line, "\"$GLINT\" diff %s \"$0\" \"$1\"", limits[i]);
        struct outcome ours = run_program("sh", "-c", line, in_folder("a.exr"), in_folder("b.exr"), NULL);
        if (ours.status != theirs.status)
            fail_msg("%s: idiff ends with %d, glint diff with %d\n%s", limits[i], theirs.status, ours.status, ours.out);
        outcome_free(&theirs);
        outcome_free(&ours);
    }
}

static void figures_are_idiffs(UNUSED void **state) {
    struct outcome theirs = run_program("idiff", in_folder("a.exr"), in_folder("b.exr"), NULL);
    struct outcome ours = glint("diff", in_folder("a.exr"), in_folder("b.exr"), "--json", NULL);
    json_t *json = parse_json(ours.out);
    const json_t *image = json_array_get(json_object_get(json, "images"), 0);
    const json_t *largest = json_object_get(image, "largest");
    assert_true(fabs(number(image, "mean") / figure_of(theirs.out, "Mean error") - 1) < 1e-4);
    assert_true(fabs(number(image, "rms") / figure_of(theirs.out, "RMS error") - 1) < 1e-4);
    assert_true(fabs(number(image, "psnr") / figure_of(theirs.out, "Peak SNR") - 1) < 1e-4);
    assert_true(fabs(number(largest, "by") / figure_of(theirs.out, "Max error") - 1) < 1e-4);
    assert_contains(theirs.out, "@ (7, 9, B)");
    assert_contains(theirs.out, "21 pixels");
    assert_true(number(largest, "x") == 7 && number(largest, "y") == 9);
    assert_string_equal(json_string_value(json_object_get(largest, "channel")), "B");
    assert_true(number(image, "failed") == 21 && number(image, "differing") == 21);
    /* 20 differences of a thousandth, apart from rounding, and one of a quarter */
    double counted = 0;
    for (size_t i = 0; i < json_array_size(json_object_get(image, "histogram")); i++)
        counted += number(json_array_get(json_object_get(image, "histogram"), i), "values");
    assert_true(counted == 3 * PIXELS);
    outcome_free(&theirs);
    outcome_free(&ours);
    json_decref(json);
}

/* Linear colours and the same, encoded by the curve of sRGB, are the same picture. Catches: encoded values that are compared as they are, an
   alpha that is decoded, too. */
static void encoded_pictures_are_decoded(UNUSED void **state) {
    for (size_t i = 0; i < 4 * PIXELS; i++) {
        const double linear = (double)(i % 97) / 96;
        values[i] = (float)linear;
        others[i] = (float)(i % 4 == 3            ? linear
                            : linear <= 0.0031308 ? 12.92 * linear
                                                  : 1.055 * pow(linear, 1 / 2.4) - 0.055);
    }
    write_image("linear.exr", "p", WIDTH, 4, values);
    write_encoded("srgb.exr", "p", WIDTH, 4, others, "srgb");
    write_image("raw.exr", "p", WIDTH, 4, others);
    for (int raw = 0; raw < 2; raw++) {
        struct outcome found = glint("diff", in_folder("linear.exr"), in_folder(raw ? "raw.exr" : "srgb.exr"), "-fail",
                                     "2e-6", "-warn", "2e-6", NULL);
        if (found.status != (raw ? 2 : 0)) fail_msg("%d: %d\n%s%s", raw, found.status, found.out, found.err);
        outcome_free(&found);
    }
}

static void status_is(int status, const char *first, const char *second, const char *says) {
    struct outcome found = glint("diff", in_folder(first), in_folder(second), NULL);
    if (found.status != status) fail_msg("%s, %s: %d\n%s%s", first, second, found.status, found.out, found.err);
    assert_contains(status >= 4 ? found.err : found.out, says);
    outcome_free(&found);
}

/* The exit statuses that idiff defines, and cases in which idiff itself treats missing data as black. */
static void what_cannot_be_compared_has_its_own_code(UNUSED void **state) {
    write_image("wide.exr", "a", 2 * WIDTH, 3, values);
    write_image("four.exr", "a", WIDTH, 4, values);
    write_image("nan.exr", "a", WIDTH, 3, values);
    status_is(0, "a.exr", "a.exr", "PASS");
    status_is(3, "a.exr", "wide.exr", "80 x 15");
    status_is(2, "a.exr", "four.exr", "channel A");
    status_is(4, "a.exr", "nowhere.exr", "nowhere.exr");
    others[3 * 77] = 0.5F;
    write_image("nan.exr", "a", WIDTH, 3, others);
    status_is(2, "a.exr", "nan.exr", "∞"); /* a NaN on only one side exceeds every limit */
    struct outcome found = glint("diff", "-fail", "1e9", in_folder("a.exr"), in_folder("nan.exr"), NULL);
    assert_int_equal(found.status, 2);
    outcome_free(&found);
    found = glint("diff", in_folder("a.exr"), NULL);
    assert_int_equal(found.status, 5);
    outcome_free(&found);
    /* idiff 2.4 does not report this if no pixel fails */
    found = glint("diff", "-fail", "1", in_folder("a.exr"), in_folder("b.exr"), NULL);
    assert_int_equal(found.status, 1);
    outcome_free(&found);
    found = glint("diff", "-fail", "1", "-hardfail", "0.2", in_folder("a.exr"), in_folder("b.exr"), NULL);
    assert_int_equal(found.status, 2);
    outcome_free(&found);
}

static json_t *diff_of(int status, const char *a, const char *b) {
    struct outcome found = glint("diff", in_folder(a), in_folder(b), "--json", "--metrics=rmse", NULL);
    if (found.status != status) fail_msg("%s, %s: %d\n%s", a, b, found.status, found.err);
    json_t *json = parse_json(found.out);
    outcome_free(&found);
    return json;
}

/* With alpha, the figures of R, G and B alone are those of the same images without it; and the verdict is that of all channels. */
static void alpha_does_not_hide_colors(UNUSED void **state) {
    static float opaque[4 * PIXELS], clear[4 * PIXELS];
    write_pair();
    for (size_t i = 0; i < PIXELS; i++)
        for (size_t k = 0; k < 4; k++) {
            const float *from = k < 3 && isfinite(values[3 * i + k]) ? values : NULL;
            opaque[4 * i + k] = k == 3 ? 1 : from ? values[3 * i + k] : 0;
            clear[4 * i + k] = k == 3 ? 0 : from ? others[3 * i + k] : 0;
            if (k < 3 && !from) values[3 * i + k] = others[3 * i + k] = 0;
        }
    write_image("opaque.exr", "a", WIDTH, 4, opaque);
    write_image("clear.exr", "a", WIDTH, 4, clear);
    write_image("a.exr", "a", WIDTH, 3, values);
    write_image("b.exr", "b", WIDTH, 3, others);
    json_t *with = diff_of(2, "opaque.exr", "clear.exr"), *without = diff_of(2, "a.exr", "b.exr");
    const json_t *image = json_array_get(json_object_get(with, "images"), 0), *rgb = json_object_get(image, "rgb"),
                 *alone = json_array_get(json_object_get(without, "images"), 0);
    static const char *const figures[] = {"mean", "rms", "psnr"};
    for (size_t i = 0; i < 3; i++)
        assert_true(fabs(number(rgb, figures[i]) - number(alone, figures[i])) <= 1e-9 * number(alone, figures[i]));
    assert_true(number(alone, "rms") > 0 && number(image, "rms") > 0.4); /* of which alpha is 1 in 4 */
    assert_true(json_equal(json_object_get(rgb, "metrics"), json_object_get(alone, "metrics")));
    assert_true(!json_equal(json_object_get(image, "metrics"), json_object_get(alone, "metrics")));
    assert_null(json_object_get(alone, "rgb"));
    json_decref(with);
    json_decref(without);
    free(glint_ok("diff", in_folder("opaque.exr"), in_folder("opaque.exr")));
    struct outcome found = glint("diff", "-fail", "2", in_folder("opaque.exr"), in_folder("clear.exr"), NULL);
    assert_contains(found.out, "of R, G and B alone: mean ");
    outcome_free(&found);
}

static void runs_name_what_differs_first(UNUSED void **state) {
    free(glint_ok("sample", "mirror_box", "-o", in_folder("box.exr"), "--size=48x27", "--cube-size=16"));
    free(glint_ok("replay", in_folder("box.exr"), PLAIN, "--use=temporal=rough", "-o", in_folder("one"),
                  "--diagnostics"));
    free(glint_ok("replay", in_folder("box.exr"), PLAIN, "--use=temporal=rough", "-o", in_folder("same"),
                  "--diagnostics"));
    free(glint_ok("replay", in_folder("box.exr"), PLAIN, "-o", in_folder("other"), "--diagnostics",
                  "--set=cubemap_trace.steps_hq=5"));
    json_t *json = diff_of(0, "one", "same");
    assert_int_equal(json_array_size(json_object_get(json, "settings")), 0);
    assert_true(json_array_size(json_object_get(json, "images")) > 20);
    json_decref(json);
    json = diff_of(2, "one", "other");
    const json_t *setting = named(json_object_get(json, "settings"), "what", "cubemap_trace.steps_hq");
    assert_true(number(setting, "a") == 24 && number(setting, "b") == 5);
    assert_string_equal(json_string_value(json_object_get(json_object_get(json, "first"), "slot")), "cubemap_trace");
    const json_t *images = json_object_get(json, "images"), *lost = named(images, "name", "reflection_temporal");
    assert_contains(json_string_value(json_object_get(lost, "note")), "the second does not contain this image");
    assert_true(number(named(images, "name", "screen_travelled"), "differing") == 0);
    assert_true(number(named(images, "name", "cubemap_end"), "differing") > 0);
    json_decref(json);
    struct outcome found =
        glint("diff", in_folder("one"), in_folder("other"), "-o", in_folder("heat.png"), "--metrics=rmse", NULL);
    assert_int_equal(found.status, 2);
    assert_contains(found.out, "the first that differs is cubemap_trace: travelled");
    outcome_free(&found);
    struct pixels heat = read_png(in_folder("heat.png"));
    assert_true(heat.width > 480);
    free(heat.rgb);
}

/* Catches: a plan reported as different because of what it skips, and one reported as equal although something else differs: a ray's
   end, the final image, an image missing for another reason. */
static void a_plan_is_compared_in_what_both_have(UNUSED void **state) {
    free(glint_ok("sample", "mirror_box", "-o", in_folder("part.exr"), "--size=48x27", "--cube-size=16",
                  "--reflecting=20"));
    free(glint_ok("replay", in_folder("part.exr"), "-o", in_folder("planned")));
    free(glint_ok("replay", in_folder("part.exr"), "-o", in_folder("all"), "--all"));
    free(glint_ok("replay", in_folder("part.exr"), "-o", in_folder("shorter"), "--all",
                  "--set=cubemap_trace.steps_hq=5"));
    free(glint_ok("replay", in_folder("part.exr"), "-o", in_folder("dimmer"), "--all", "--set=compose.fresnel=false"));
    free(glint_ok("replay", in_folder("part.exr"), "-o", in_folder("cut"), "--all",
                  "--passes=downsample,hiz,screen_trace"));
    for (int turned = 0; turned < 2; turned++) {
        const char *const a = turned ? "all" : "planned", *const b = turned ? "planned" : "all";
        struct outcome found = glint("diff", in_folder(a), in_folder(b), NULL);
        assert_int_equal(found.status, 0);
        assert_contains(found.out, "not computed by the plan of ");
        assert_contains(found.out, "images that both contain are the same");
        outcome_free(&found);
        json_t *json = diff_of(0, a, b);
        const json_t *planned = json_object_get(json, "planned"), *images = json_object_get(json, "images");
        assert_string_equal(json_string_value(json_object_get(planned, "run")), in_folder("planned"));
        assert_true(number(planned, "images_left_out") > 0);
        assert_true(number(planned, "rays_left_out") > 0.5 * 24 * 14 && number(planned, "rays_left_out") < 24 * 14);
        assert_string_equal(json_string_value(json_object_get(named(images, "name", "tile_list"), "verdict")),
                            "left out");
        assert_true(number(named(images, "name", "reflection_half"), "differing") == 0);
        json_decref(json);
    }
    json_t *json = diff_of(2, "planned", "shorter");
    assert_string_equal(json_string_value(json_object_get(json_object_get(json, "first"), "slot")), "cubemap_trace");
    json_decref(json);
    json = diff_of(2, "planned", "dimmer");
    assert_string_equal(json_string_value(json_object_get(json_object_get(json, "first"), "image")), "composed");
    json_decref(json);
    json = diff_of(2, "planned", "cut");
    assert_contains(
        json_string_value(json_object_get(named(json_object_get(json, "images"), "name", "composed"), "note")),
        "the second does not contain this image");
    json_decref(json);
}

/* The engine's own image under the name of its slot; intermediates that it did not dump are not missing. */
static void a_run_is_compared_with_the_engine(UNUSED void **state) {
    static const char *const rgba[] = {"R", "G", "B", "A"};
    static const float gbuffer[1];
    static float image[48 * 27 * 4];
    struct glint_error err = {0};
    struct outcome found = glint("diff", in_folder("one"), in_folder("box.exr"), NULL);
    assert_int_equal(found.status, 4);
    assert_contains(found.err, "engine.SLOT.IMAGE, found none");
    outcome_free(&found);
    struct outcome files = run_program("sh", "-c", "ls \"$0\"/*compose.exr", in_folder("one"), NULL);
    files.out[strcspn(files.out, "\n")] = '\0';
    struct glint_exr *exr = glint_exr_open(files.out, NULL, &err);
    assert_non_null(exr);
    assert_true(glint_exr_read(exr, 0, rgba, 4, GLINT_F32, image, 0, &err));
    glint_exr_close(&exr);
    outcome_free(&files);
    for (int changed = 0; changed < 2; changed++) {
        struct glint_exr_channel channels[4];
        image[4 * (48 * 3 + 5) + 1] += changed ? 0.5F : 0;
        for (size_t k = 0; k < 4; k++)
            channels[k] = (struct glint_exr_channel){
                .name = rgba[k], .stored = GLINT_STORED_FLOAT, .data = image + k, .x_stride_bytes = 16};
        const struct glint_exr_channel depth = {.name = "depth.Z", .stored = GLINT_STORED_FLOAT, .data = gbuffer};
        const struct glint_exr_part parts[] = {
            {.name = "gbuffer", .width = 1, .height = 1, .channels = &depth, .channel_count = 1},
            {.name = "engine.compose.composed", .width = 48, .height = 27, .channels = channels, .channel_count = 4}};
        if (!glint_exr_write(in_folder("dumped.exr"), parts, 2, 0, &err)) fail_msg("%s", err.message);
        json_t *json = diff_of(changed ? 2 : 0, "one", "dumped.exr");
        const json_t *only = json_array_get(json_object_get(json, "images"), 0);
        assert_int_equal(json_array_size(json_object_get(json, "images")), 1);
        assert_true(number(only, "failed") == changed);
        if (changed) assert_true(number(json_object_get(only, "largest"), "x") == 5);
        json_decref(json);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verdicts_are_idiffs),
        cmocka_unit_test(figures_are_idiffs),
        cmocka_unit_test(encoded_pictures_are_decoded),
        cmocka_unit_test(what_cannot_be_compared_has_its_own_code),
        cmocka_unit_test(alpha_does_not_hide_colors),
        cmocka_unit_test(runs_name_what_differs_first),
        cmocka_unit_test(a_plan_is_compared_in_what_both_have),
        cmocka_unit_test(a_run_is_compared_with_the_engine),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
