/* glint probe, as a user runs it: its steps compared with the files of a run. gpu_probe tests the steps of all tracers. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"

#define CAPTURE in_folder("street.exr")

static void make_capture(void) {
    if (!file_exists(CAPTURE))
        free(glint_ok("sample", "street", "--light=4", "-o", CAPTURE, "--size=96x54", "--cube-size=16"));
}

/* A channel of a run's file whose name ends like this. */
static float *channel_of(const char *file, const char *part, const char *channel, size_t *width, size_t *height) {
    struct glint_error err = {0};
    struct glint_exr *exr = glint_exr_open(file, NULL, &err);
    float *values = NULL;
    if (!exr) fail_msg("%s", err.message);
    for (size_t p = 0; p < glint_exr_part_count(exr); p++) {
        const struct glint_exr_part_info *info = glint_exr_part(exr, p);
        if (strcmp(info->name, part) != 0) continue;
        *width = info->width, *height = info->height;
        values = malloc(*width * *height * sizeof *values);
        assert_true(values && glint_exr_read(exr, p, &channel, 1, GLINT_F32, values, 0, &err));
    }
    glint_exr_close(&exr);
    assert_non_null(values);
    return values;
}

static const char *word(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    assert_non_null(text);
    return text;
}

static const json_t *last_step(const json_t *pass, const char *kind) {
    const json_t *steps = json_object_get(pass, "steps"), *step, *found = NULL;
    size_t i;
    json_array_foreach(steps, i, step) if (strcmp(json_string_value(json_object_get(step, "kind")), kind) == 0) found =
        step;
    return found;
}

/* Pixels of all kinds: each one's last step equals the run's file, and no record is dropped. */
static void a_trace_agrees_with_the_run(UNUSED void **state) {
    size_t width = 0, height = 0, hits = 0, skies = 0;
    make_capture();
    free(glint_ok("replay", CAPTURE, PLAIN, "-o", in_folder("run"), "--diagnostics"));
    char file[300];
    json_t *run = json_load_file(in_folder("run/run.json"), 0, NULL);
    const json_t *traced = named(json_object_get(run, "passes"), "slot", "screen_trace");
    const json_t *image = named(json_object_get(traced, "images"), "name", "screen_travelled");
    snprintf(file, sizeof file, "run/%s", word(image, "file"));
    json_decref(run);
    float *far = channel_of(in_folder(file), "screen_travelled", "Z", &width, &height);
    for (unsigned y = 31; y < 54; y += 15)
        for (unsigned x = 5; x < 96; x += 60) {
            char pixel[32];
            snprintf(pixel, sizeof pixel, "%u,%u", x, y);
            char *text = glint_ok("probe", CAPTURE, pixel, PLAIN, "--json", "--alone");
            json_t *json = parse_json(text);
            const json_t *pass =
                named(json_object_get(json_object_get(json, "pipeline"), "passes"), "slot", "screen_trace");
            const json_t *end = last_step(pass, "screen_end"), *travelled = json_object_get(end, "travelled_m");
            const float found = far[(y / 2) * width + x / 2];
            if (json_is_null(travelled)) assert_true(isinf(found));
            else assert_true((float)json_number_value(travelled) == found);
            hits += strcmp(word(end, "end"), "hit") == 0;
            skies += strcmp(word(end, "end"), "sky") == 0;
            json_decref(json);
            free(text);
        }
    free(far);
    assert_true(hits > 0);
    print_message("# %zu hits, %zu in the sky\n", hits, skies);
}

static size_t count_occurrences(const char *text, const char *what) {
    size_t n = 0;
    while ((text = strstr(text, what))) n++, text += strlen(what);
    return n;
}

static char *read_text(const char *path) {
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 20) - 1, f) > 0);
    fclose(f);
    return text;
}

/* A mark for each step with a position, a legend of decisions, and the hit of the reference. */
static void a_drawing_has_every_step(UNUSED void **state) {
    make_capture();
    char *text =
        glint_ok("probe", CAPTURE, "40,45", PLAIN, "--use=screen_trace=dda", "-o", in_folder("ray.svg"), "--json");
    json_t *json = parse_json(text);
    size_t drawn = 0, i, p;
    const json_t *pass, *step;
    json_array_foreach(json_object_get(json_object_get(json, "pipeline"), "passes"), p, pass)
        json_array_foreach(json_object_get(pass, "steps"), i, step) {
        drawn += json_object_get(step, "decision") && json_is_number(json_object_get(step, "travelled_m"));
    }
    char *svg = read_text(in_folder("ray.svg"));
    assert_true(drawn > 3);
    assert_int_equal(count_occurrences(svg, "<title>"), drawn);
    assert_contains(svg, "pixel 40,45");
    assert_contains(svg, "depth in m, linear in 1/z");
    assert_contains(svg, "in front: continues");
    assert_int_equal(count_occurrences(svg, "<svg"), count_occurrences(svg, "</svg>"));
    assert_non_null(json_object_get(json, "reference"));
    json_decref(json);
    free(svg);
    free(text);
}

/* Records of averages with each weight: samples at the end of the ray, and the reflection composed over the image. */
static void mixtures_are_printed_and_drawn(UNUSED void **state) {
    make_capture();
    char *text = glint_ok("probe", CAPTURE, "40,45", "--preset=kf2", "--alone", "-o", in_folder("kf2.svg"));
    assert_contains(text, "adds a sample of the picture");
    assert_contains(text, "attenuates the reflection");
    assert_contains(text, "image reflection, alpha 0.");
    char *svg = read_text(in_folder("kf2.svg"));
    assert_contains(svg, "resolve/blurred: combines");
    assert_contains(svg, "compose/contribution: blends one layer over another");
    assert_contains(svg, "upper layer: reflection, ");
    assert_int_equal(count_occurrences(svg, "<svg"), count_occurrences(svg, "</svg>"));
    free(svg);
    free(text);
    text = glint_ok("probe", CAPTURE, "40,45", "--preset=mafia_de", "--alone", "--json", "-o", in_folder("de.svg"));
    json_t *json = parse_json(text);
    const json_t *pass = named(json_object_get(json_object_get(json, "pipeline"), "passes"), "slot", "blur");
    const json_t *made = last_step(pass, "result"), *tap = last_step(pass, "tap");
    assert_string_equal(word(made, "image"), "reflection_levels");
    assert_int_equal(json_number_value(json_object_get(made, "texel_x")), 40 / 2 / 2); /* level 1, the last one */
    assert_true(json_number_value(json_object_get(tap, "weight")) > 0);
    svg = read_text(in_folder("de.svg"));
    assert_contains(svg, "reflection_across level 0, texel 5,5 combines");
    json_decref(json);
    free(svg);
    free(text);
}

static void the_text_tells_it_all(UNUSED void **state) {
    make_capture();
    char *text = glint_ok("probe", CAPTURE, "40,45", PLAIN, "--set=screen_trace.length_m=0");
    assert_contains(text, "capture  G-buffer at the pixel");
    assert_contains(text, "normal_jittered");
    assert_contains(text, "cubemap_trace/march");
    assert_contains(text, "behind m");
    assert_contains(text, "cubemap.00");
    assert_contains(text, "composed");
    assert_contains(text, "reference: screen_trace/dda, cubemap_trace/exact");
    free(text);
    text = glint_ok("probe", CAPTURE, "48,1", PLAIN, "--alone");
    assert_contains(text, "no ray: it is sky");
    free(text);
    free(glint_ok("sample", "matte", "--light=4", "-o", in_folder("matte.exr"), "--size=64x36", "--cube-size=8"));
    text = glint_ok("probe", in_folder("matte.exr"), "20,30"); /* no pass runs */
    assert_contains(text, "pixel 20,30 of 64 x 36, texel");
    free(text);
}

static void what_is_asked_wrong_is_said(UNUSED void **state) {
    make_capture();
    glint_fails(2, "no capture given", "probe");
    glint_fails(2, "no pixel of", "probe", CAPTURE);
    glint_fails(2, "expected a pixel X,Y", "probe", CAPTURE, "12.5,3");
    glint_fails(2, "expected one capture and one pixel", "probe", CAPTURE, "12,3", "13,3");
    glint_fails(2, "pixel 96,3: outside of the picture of 96 x 54 pixels", "probe", CAPTURE, "96,3");
    glint_fails(2, "pixel -5,3: outside of the picture of 96 x 54 pixels", "probe", CAPTURE, "-5,3");
    glint_fails(2, "pixel 5,-3: outside of the picture of 96 x 54 pixels", "probe", CAPTURE, "--alone", "5,-3");
    glint_fails(2, "expected a pixel X,Y", "probe", CAPTURE, "-5");
    glint_fails(2, "invalid option -- '5'", "probe", CAPTURE, "-j5,3");
    glint_fails(1, "pixel 48,1 has no ray to draw", "probe", CAPTURE, "48,1", PLAIN, "-o", in_folder("none.svg"));
    assert_false(file_exists(in_folder("none.svg")));
    glint_fails(1, "nowhere.exr", "probe", in_folder("nowhere.exr"), "1,1");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_trace_agrees_with_the_run), cmocka_unit_test(a_drawing_has_every_step),
        cmocka_unit_test(mixtures_are_printed_and_drawn), cmocka_unit_test(the_text_tells_it_all),
        cmocka_unit_test(what_is_asked_wrong_is_said)};
    return cmocka_run_group_tests_name("cli_probe", tests, make_folder, remove_folder);
}
