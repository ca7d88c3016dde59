/* A world whose origin is the centre of a planet, dumped by an engine with rotations in floats: the commands compute the same camera as
   at the origin, motion is consistent, the replay is equal, and the uncertainty of the rotation is reported. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../capture-format/rewrite.h"
#include "glint/exr.h"

static const double offset[3] = {5e6, 0, -4e6}; /* 6,400 km */
static char near[256], far[256];

/* The rotation in floats, the previous camera's with slightly different rounding, and the translation that follows from it and the
   position in double. */
static void move_camera(double *m, bool previous) {
    double eye[3];
    for (int i = 0; i < 3; i++) eye[i] = offset[i] - (m[i] * m[3] + m[4 + i] * m[7] + m[8 + i] * m[11]);
    for (int r = 0; r < 3; r++) {
        m[4 * r + 3] = 0;
        for (int k = 0; k < 3; k++) {
            const float kept = (float)m[4 * r + k];
            m[4 * r + k] = (double)(previous ? nextafterf(kept, 0) : kept);
            m[4 * r + 3] -= m[4 * r + k] * eye[k];
        }
    }
}

static int make_captures(void **state) {
    static const char *const cameras[] = {"glint.worldToView", "glint.previousWorldToView"};
    static struct rewrite r;
    static double moved[2 + REWRITE_PARTS][16];
    size_t count = 0;
    if (make_folder(state) != 0) return -1;
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("room.exr"), "--frames", "2", "--size=96x54",
                  "--cube-size", "32"));
    snprintf(near, sizeof near, "%s", in_folder("room.0002.exr"));
    snprintf(far, sizeof far, "%s", in_folder("far.exr"));
    rewrite_load(&r, near);
    for (size_t i = 0; i < r.count; i++)
        for (size_t a = 0; a < r.parts[i].part.attribute_count; a++) {
            struct glint_exr_attribute *attribute = &r.parts[i].attributes[a];
            const bool camera = !strcmp(attribute->name, cameras[0]) || !strcmp(attribute->name, cameras[1]);
            const bool place = !strcmp(attribute->name, "glint.center") || !strcmp(attribute->name, "glint.player");
            if (!camera && !place) continue;
            double *to = moved[count++];
            memcpy(to, attribute->numbers, attribute->count * sizeof *to);
            for (int k = 0; place && k < 3; k++) to[k] += offset[k];
            if (camera) move_camera(to, !strcmp(attribute->name, cameras[1]));
            attribute->numbers = to;
        }
    rewrite_save(&r, far);
    rewrite_finish(&r);
    return count > 3 ? 0 : -1;
}

static void info_finds_the_camera(UNUSED void **state) {
    char *there_text = glint_ok("info", far, "--json"), *here_text = glint_ok("info", near, "--json");
    json_t *there = parse_json(there_text), *here = parse_json(here_text);
    const json_t *a = json_object_get(json_object_get(there, "camera"), "position"),
                 *b = json_object_get(json_object_get(here, "camera"), "position");
    /* printed with nine digits: centimetres. With the transposed rotation the camera is up to some 100 mm off. */
    for (size_t k = 0; k < 3; k++)
        assert_true(fabs(json_number_value(json_array_get(a, k)) - json_number_value(json_array_get(b, k)) -
                         offset[k]) < 0.011);
    assert_int_equal(json_array_size(json_object_get(here, "notes")), 0);
    assert_int_equal(json_array_size(json_object_get(there, "notes")), 2);
    char *text = glint_ok("info", far);
    assert_contains(text,
                    "note: gbuffer: glint.worldToView: expected a rotation in double precision, found one that is");
    free(text);
    json_decref(there);
    json_decref(here);
    free(there_text);
    free(here_text);
}

static void validate_says_what_is_left_open(UNUSED void **state) {
    char *text = glint_ok("validate", far), *json_text = glint_ok("validate", far, near, "--json");
    assert_contains(text, "note: gbuffer: glint.previousWorldToView: ");
    assert_contains(text, ": valid");
    json_t *json = parse_json(json_text);
    const json_t *files = json_object_get(json, "files");
    assert_true(json_is_true(json_object_get(json_array_get(files, 0), "valid")));
    assert_int_equal(json_array_size(json_object_get(json_array_get(files, 0), "notes")), 2);
    assert_int_equal(json_array_size(json_object_get(json_array_get(files, 1), "notes")), 0);
    json_decref(json);
    free(text);
    free(json_text);
}

static void motion_agrees_as_at_the_origin(UNUSED void **state) {
    char *texts[2] = {glint_ok("lint", near, "--json"), glint_ok("lint", far, "--json")};
    double shares[2];
    for (int i = 0; i < 2; i++) {
        json_t *json = parse_json(texts[i]);
        const json_t *motion = named(json_object_get(json, "agreement"), "what", "motion with the reprojection");
        shares[i] = number(motion, "share");
        assert_int_equal(json_array_size(json_object_get(json, "findings")), 0);
        json_decref(json);
        free(texts[i]);
    }
    assert_true(shares[0] > 0.9 && fabs(shares[1] - shares[0]) < 0.01);
}

static void the_replay_says_so_too(UNUSED void **state) {
    char path[512];
    free(glint_ok("replay", far, "-o", in_folder("run"), "--passes", "downsample"));
    snprintf(path, sizeof path, "%s/run.json", in_folder("run"));
    json_t *json = json_load_file(path, 0, NULL);
    assert_non_null(json);
    const json_t *warnings = json_object_get(json, "warnings");
    size_t warned = 0;
    for (size_t i = 0; i < json_array_size(warnings); i++)
        warned += strstr(json_string_value(json_array_get(warnings, i)), "orthonormal to") != NULL;
    assert_int_equal(warned, 2);
    json_decref(json);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(info_finds_the_camera),
        cmocka_unit_test(validate_says_what_is_left_open),
        cmocka_unit_test(motion_agrees_as_at_the_origin),
        cmocka_unit_test(the_replay_says_so_too),
    };
    return cmocka_run_group_tests(tests, make_captures, remove_folder);
}
