/* Pipelines are checked against the declarations; errors list known names and ranges. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/replay.h"
#include "unit.h"

static struct glint_pipeline *preset(void) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create(GLINT_TEST_PRESET, &err);
    if (!pipeline) fail_msg("%s", err.message);
    return pipeline;
}

static double value_of(const struct glint_pipeline *pipeline, const char *slot, const char *parameter) {
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        for (size_t r = 0; r < pass->row_count; r++)
            if (strcmp(pass->slot, slot) == 0 && strcmp(pass->rows[r].name, parameter) == 0)
                return glint_pipeline_value(pipeline, pass, &pass->rows[r]);
    }
    fail_msg("no %s.%s", slot, parameter);
    return 0;
}

static void assert_says(const struct glint_error *err, const char *part) {
    if (!strstr(err->message, part)) fail_msg("expected '%s' in: %s", part, err->message);
}

static void the_preset_holds_every_slot_with_its_defaults(UNUSED void **state) {
    struct glint_pipeline *pipeline = preset();
    assert_string_equal(glint_pipeline_name(pipeline), "plain");
    assert_int_equal(glint_pipeline_pass_count(pipeline), 8);
    assert_true(value_of(pipeline, "downsample", "share") == 1.0);
    assert_true(value_of(pipeline, "cubemap_active", "count") == 8);
    glint_pipeline_destroy(&pipeline);
    assert_null(pipeline);
}

static void values_are_set_by_number_by_word_and_by_choice(UNUSED void **state) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = preset();
    assert_true(glint_pipeline_set(pipeline, "downsample.share=0.25", &err));
    assert_true(value_of(pipeline, "downsample", "share") == 0.25);
    assert_true(glint_pipeline_set(pipeline, "downsample.ndf=blinn_phong", &err));
    assert_true(value_of(pipeline, "downsample", "ndf") == 0);
    assert_true(glint_pipeline_set(pipeline, "downsample.ndf=ggx", &err));
    assert_true(value_of(pipeline, "downsample", "ndf") == 1);
    assert_true(glint_pipeline_set(pipeline, "cubemap_active.force_outdoor=false", &err));
    assert_true(value_of(pipeline, "cubemap_active", "force_outdoor") == 0);
    glint_pipeline_destroy(&pipeline);
}

/* Equal values have equal bits, so that they are one value for what is kept by them. */
static void there_is_no_negative_zero(UNUSED void **state) {
    struct glint_pipeline *pipeline = preset();
    assert_true(glint_pipeline_set(pipeline, "downsample.share=-0", NULL));
    assert_false(signbit(value_of(pipeline, "downsample", "share")));
    glint_pipeline_destroy(&pipeline);
}

static void what_is_wrong_with_an_assignment_is_said(UNUSED void **state) {
    static const struct {
        const char *assignment, *says[3];
    } cases[] = {
        {"downsample.share=2", {"downsample.share", "0 to 1", "found 2"}},
        {"downsample.share=nan", {"downsample.share", "0 to 1", "nan"}},
        {"downsample.share=", {"SLOT.PARAMETER=VALUE", "downsample.share=", ""}},
        {"downsample.share=0.5x", {"downsample.share", "a number from 0 to 1", "0.5x"}},
        {"downsample.shares=1", {"downsample/pick", "shares", "did you mean share?"}},
        {"downsample.unlike_any=1", {"downsample/pick", "unlike_any", "known: "}},
        {"upscale.share=1", {"upscale/", "no parameter share", "known: "}},
        {"downsamples.share=1", {"there is no slot downsamples", "did you mean downsample?", ""}},
        {"nowhere.share=1", {"there is no slot nowhere", "cubemap_active", "upscale"}},
        {"cubemap_active.count=2.5", {"whole number", "1 to 16", "2.5"}},
        {"cubemap_active.count=17", {"1 to 16", "cube maps", "found 17"}},
        {"downsample.ndf=phong", {"downsample.ndf", "blinn_phong, ggx", "phong"}},
        {"share=1", {"SLOT.PARAMETER", "'share'", ""}},
        {".share=1", {"SLOT.PARAMETER", "'.share'", ""}},
        {"downsample.=1", {"SLOT.PARAMETER", "'downsample.'", ""}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct glint_error err = {0};
        struct glint_pipeline *pipeline = preset();
        assert_false(glint_pipeline_set(pipeline, cases[i].assignment, &err));
        assert_int_equal(err.code, GLINT_ERROR_USAGE);
        for (size_t s = 0; s < 3; s++) assert_says(&err, cases[i].says[s]);
        assert_true(value_of(pipeline, "downsample", "share") == 1.0);
        glint_pipeline_destroy(&pipeline);
    }
}

static void a_switch_is_set_in_every_pass_that_has_it(UNUSED void **state) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia_de", &err),
                          *without = glint_pipeline_create("kf2", &err);
    assert_true(value_of(pipeline, "resolve", "fog") == 1 && value_of(pipeline, "transparent_resolve", "fog") == 1);
    assert_true(glint_pipeline_set(pipeline, "pipeline.fog=false", &err));
    assert_true(value_of(pipeline, "resolve", "fog") == 0 && value_of(pipeline, "transparent_resolve", "fog") == 0);
    assert_true(glint_pipeline_set(without, "pipeline.fog=false", &err)); /* its passes have no fog */
    assert_false(glint_pipeline_set(without, "pipeline.fogs=false", &err));
    assert_says(&err, "pipeline has no parameter 'fogs' (did you mean fog?); known: rays, first_ray");
    assert_false(glint_pipeline_set(pipeline, "pipeline.fog=perhaps", &err));
    assert_says(&err, "resolve.fog: expected true, false or a number");
    glint_pipeline_destroy(&pipeline);
    glint_pipeline_destroy(&without);
}

static void slots_can_be_left_out_and_variants_are_checked(UNUSED void **state) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = preset();
    assert_true(glint_pipeline_use(pipeline, "upscale=none", &err));
    assert_int_equal(glint_pipeline_pass_count(pipeline), 7);
    assert_false(glint_pipeline_set(pipeline, "upscale.anything=1", &err));
    assert_says(&err, "not part of the pipeline");
    assert_true(glint_pipeline_use(pipeline, "upscale=bilinear", &err));
    assert_int_equal(glint_pipeline_pass_count(pipeline), 8);
    assert_false(glint_pipeline_use(pipeline, "upscale=trilinear", &err));
    assert_says(&err, "slot upscale has no variant trilinear (did you mean bilinear?)");
    assert_false(glint_pipeline_use(pipeline, "upscales=bilinear", &err));
    assert_says(&err, "there is no slot upscales (did you mean upscale?)");
    glint_pipeline_destroy(&pipeline);
}

static void a_host_pass_has_no_shader_to_replace(UNUSED void **state) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = preset();
    assert_false(glint_pipeline_shader(pipeline, "cubemap_active=mine.comp", &err));
    assert_says(&err, "runs on the host");
    assert_false(glint_pipeline_shader(pipeline, "nothing=mine.comp", &err));
    assert_true(glint_pipeline_shader(pipeline, "resolve=mine.comp", &err));
    glint_pipeline_destroy(&pipeline);
}

/* Writes `text` as a preset, and returns the error of reading it. */
static struct glint_error read_preset(const char *text) {
    char path[] = "/tmp/glint-preset-XXXXXX.json";
    int file = mkstemps(path, 5);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (ssize_t)strlen(text));
    close(file);
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create(path, &err);
    if (!pipeline) assert_says(&err, path);
    glint_pipeline_destroy(&pipeline);
    unlink(path);
    return err;
}

static void a_good_preset_file_is_read(UNUSED void **state) {
    struct glint_error err =
        read_preset("{\"slots\": {\"downsample\": \"pick\"}, \"set\": {\"downsample.share\": 0.5, \"downsample.ndf\": "
                    "\"ggx\", \"downsample.edges\": false}}");
    assert_int_equal(err.code, GLINT_OK);
}

static void every_fault_of_a_preset_is_reported_at_once(UNUSED void **state) {
    struct glint_error err = read_preset(
        "{\"slots\": {\"downsample\": \"pick\", \"resolve\": \"guess\", \"blurr\": \"none\"}, \"titel\": 1, "
        "\"set\": {\"downsample.share\": 3, \"downsample.sharp\": 1}}");
    assert_says(&err, "slot resolve has no variant guess; known: ");
    assert_says(&err, "there is no slot blurr (did you mean blur?)");
    assert_says(&err, "unknown key 'titel'");
    assert_says(&err, "0 to 1");
    assert_says(&err, "no parameter sharp (did you mean share?)");
}

static void broken_json_is_placed_by_line(UNUSED void **state) {
    struct glint_error err = read_preset("{\"slots\": {\n\"downsample\" \"pick\"}}");
    assert_int_equal(err.code, GLINT_ERROR_FORMAT);
    assert_says(&err, ".json:2:");
    err = read_preset("[1, 2]");
    assert_says(&err, "expected an object");
    err = read_preset("{\"slots\": {\"downsample\": \"pick\", \"downsample\": \"pick\"}}");
    assert_says(&err, "duplicate");
}

static void unknown_presets_name_the_known_ones(UNUSED void **state) {
    struct glint_error err = {0};
    assert_null(glint_pipeline_create("mafia4", &err));
    assert_says(&err, "mafia4");
    assert_says(&err, "mafia3");
    assert_null(glint_pipeline_create("/nowhere/x.json", &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
}

static void a_long_name_is_near_to_none(UNUSED void **state) {
    char name[400];
    struct glint_error err = {0};
    memset(name, 'a', sizeof name);
    name[sizeof name - 1] = '\0';
    assert_null(glint_pipeline_create(name, &err));
    if (strstr(err.message, "did you mean")) fail_msg("%s", err.message);
    assert_null(glint_pipeline_create("mafia4", &err));
    assert_says(&err, "did you mean mafia3?");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_preset_holds_every_slot_with_its_defaults),
        cmocka_unit_test(values_are_set_by_number_by_word_and_by_choice),
        cmocka_unit_test(there_is_no_negative_zero),
        cmocka_unit_test(what_is_wrong_with_an_assignment_is_said),
        cmocka_unit_test(a_switch_is_set_in_every_pass_that_has_it),
        cmocka_unit_test(slots_can_be_left_out_and_variants_are_checked),
        cmocka_unit_test(a_host_pass_has_no_shader_to_replace),
        cmocka_unit_test(a_good_preset_file_is_read),
        cmocka_unit_test(every_fault_of_a_preset_is_reported_at_once),
        cmocka_unit_test(broken_json_is_placed_by_line),
        cmocka_unit_test(unknown_presets_name_the_known_ones),
        cmocka_unit_test(a_long_name_is_near_to_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
