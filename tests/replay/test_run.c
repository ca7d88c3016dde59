/* Tests without a device: surveys, plans, and untrusted run folders. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "fixture.h"
#include "glint/exr.h"
#include "unit.h"

/* The fixture's floor is metal in columns 0, 11, … and dielectric elsewhere; its wall is metal in those columns only. */
static void the_survey_counts_what_the_frame_holds(void **state) {
    const struct fixture *fixture = *state;
    struct glint_error err = {0};
    struct glint_survey survey;
    static float channels[FIXTURE_HEIGHT][FIXTURE_WIDTH][3];
    const char *const names[] = {"depth.Z", "material.metalness", "material.specular"};
    assert_true(glint_survey_capture(fixture->capture, &survey, &err));
    assert_true(glint_capture_read(fixture->capture, glint_capture_find(fixture->capture, "gbuffer"), names, 3,
                                   GLINT_F32, channels, 1, &err));
    uint64_t sky = 0, reflecting = 0, binned = 0;
    for (int y = 0; y < FIXTURE_HEIGHT; y++)
        for (int x = 0; x < FIXTURE_WIDTH; x++) {
            const bool is_sky = isinf(channels[y][x][0]);
            sky += is_sky;
            reflecting += !is_sky && (channels[y][x][1] > 0 || channels[y][x][2] > 0);
        }
    for (int b = 0; b < GLINT_SURVEY_BINS; b++) binned += survey.reflecting.by_roughness[b];
    assert_int_equal(survey.pixels, FIXTURE_WIDTH * FIXTURE_HEIGHT);
    assert_int_equal(survey.sky, sky);
    assert_int_equal(survey.reflecting.count, reflecting);
    assert_int_equal(binned, reflecting);
    assert_true(sky > 0 && reflecting > 0);
    assert_int_equal(survey.cubemaps, FIXTURE_CUBEMAPS);
    assert_true(survey.has_sky);
    assert_true(survey.depth_m[1] == 6); /* the wall */
}

static void a_plan_needs_no_device(void **state) {
    const struct fixture *fixture = *state;
    struct glint_error err = {0};
    struct glint_replay *replay = glint_replay_create(NULL, &err);
    const struct glint_plan_entry *entries;
    size_t count;
    const char *const skip[] = {"upscale", NULL};
    assert_non_null(replay);
    assert_true(glint_replay_load(replay, fixture->capture, &err));
    assert_true(glint_replay_plan(replay, fixture->pipeline, &(struct glint_replay_options){.skip = skip}, &entries,
                                  &count, &err));
    assert_int_equal(count, glint_pipeline_pass_count(fixture->pipeline));
    for (size_t i = 0; i < count; i++) {
        const bool skipped = strcmp(entries[i].pass->slot, "upscale") == 0;
        assert_int_equal(entries[i].runs, !skipped);
        if (skipped) assert_string_equal(entries[i].reason, "skipped on request");
        if (strcmp(entries[i].pass->slot, "cubemap_select") == 0)
            assert_non_null(strstr(entries[i].reason, "3 cube maps"));
    }
    assert_false(glint_replay_run(replay, fixture->pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "without a device");
    assert_false(glint_replay_write(replay, fixture->folder, NULL, NULL, &err));
    glint_replay_destroy(&replay);
}

#define IMAGE(name, file, size)                                                                                        \
    "{\"name\": \"" name "\", \"file\": \"" file                                                                       \
    "\", \"part\": \"p\", \"channels\": \"X Y\", \"format\": \"RG32F\", " size "}"
#define RUN(images) "{\"format\": 1, \"passes\": [{\"slot\": \"s\", \"variant\": \"v\", \"images\": [" images "]}]}"

/* Creates a run folder with this run.json and one EXR file, a.exr, of 3 × 2. */
static const char *make_run(const struct fixture *fixture, const char *json) {
    static char folder[128];
    static const float values[2][3][2] = {{{1, 2}, {3, 4}, {5, 6}}, {{7, 8}, {9, 10}, {11, 12}}};
    char path[256];
    struct glint_error err = {0};
    snprintf(folder, sizeof folder, "%s/run", fixture->folder);
    mkdir(folder, 0777);
    const struct glint_exr_channel channels[] = {{"X", GLINT_STORED_FLOAT, &values[0][0][0], 8, 0},
                                                 {"Y", GLINT_STORED_FLOAT, &values[0][0][1], 8, 0}};
    const struct glint_exr_part part = {.name = "p", .width = 3, .height = 2, .channels = channels, .channel_count = 2};
    snprintf(path, sizeof path, "%s/a.exr", folder);
    if (!glint_exr_write(path, &part, 1, 1, &err)) fail_msg("%s", err.message);
    snprintf(path, sizeof path, "%s/run.json", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(json, file);
    fclose(file);
    return folder;
}

static void a_good_run_is_read(void **state) {
    struct glint_error err = {0};
    float values[2][3][2] = {0};
    struct glint_run *run =
        glint_run_open(make_run(*state, RUN(IMAGE("i", "a.exr", "\"width\": 3, \"height\": 2"))), &err);
    if (!run) fail_msg("%s", err.message);
    const struct glint_run_image *image = glint_run_find(run, "i");
    assert_non_null(image);
    assert_int_equal(image->components, 2);
    assert_true(glint_run_read(run, image, GLINT_F32, values, &err));
    assert_true(values[1][2][0] == 11 && values[0][1][1] == 4);
    glint_run_close(&run);
    assert_null(run);
}

static void bad_runs_are_refused_by_name(void **state) {
    static const struct {
        const char *json, *says;
    } cases[] = {
        {"", "run.json"},
        {"{", "run.json:1"},
        {"[]", "expected format 1"},
        {"{\"format\": 2, \"passes\": []}", "expected format 1, found 2"},
        {"{\"format\": 1}", "expected an array of passes"},
        {RUN(IMAGE("i", "../a.exr", "\"width\": 3, \"height\": 2")), "file in the folder, found '../a.exr'"},
        {RUN(IMAGE("i", "/etc/passwd", "\"width\": 3, \"height\": 2")), "file in the folder, found '/etc/passwd'"},
        {RUN(IMAGE("i", "a.exr", "\"width\": -3, \"height\": 2")),
         "image i: expected a name, 1 to 4 channels and a size"},
        {RUN(IMAGE("i", "a.exr", "\"width\": 99999999999, \"height\": 2")), "image i"},
        {RUN(IMAGE("", "a.exr", "\"width\": 3, \"height\": 2")), "expected a name"},
        {RUN("3"), "expected a name"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct glint_error err = {0};
        assert_null(glint_run_open(make_run(*state, cases[i].json), &err));
        fixture_says(&err, cases[i].says);
    }
}

static void what_the_json_promises_is_checked_when_read(void **state) {
    static const struct {
        const char *json, *says;
    } cases[] = {
        {RUN(IMAGE("i", "a.exr", "\"width\": 4, \"height\": 2")), "expected 4 x 2, found 3 x 2"},
        {RUN(IMAGE("i", "gone.exr", "\"width\": 3, \"height\": 2")), "gone.exr"},
        {RUN(IMAGE("i", "run.json", "\"width\": 3, \"height\": 2")), "run.json"},
        {RUN("{\"name\": \"i\", \"file\": \"a.exr\", \"part\": \"q\", \"channels\": \"X\", \"format\": \"R32F\", "
             "\"width\": 3, \"height\": 2}"),
         "part q: missing"},
        {RUN("{\"name\": \"i\", \"file\": \"a.exr\", \"part\": \"p\", \"channels\": \"W\", \"format\": \"R32F\", "
             "\"width\": 3, \"height\": 2}"),
         "W"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct glint_error err = {0};
        float values[32];
        struct glint_run *run = glint_run_open(make_run(*state, cases[i].json), &err);
        if (!run) fail_msg("%s", err.message);
        assert_false(glint_run_read(run, glint_run_find(run, "i"), GLINT_F32, values, &err));
        fixture_says(&err, cases[i].says);
        glint_run_close(&run);
    }
}

/* run.json truncated after every byte: an error or a run, but no crash. */
static void a_cut_run_json_is_an_error(void **state) {
    char json[512];
    snprintf(json, sizeof json, "%s", RUN(IMAGE("i", "a.exr", "\"width\": 3, \"height\": 2")));
    for (size_t length = strlen(json); length-- > 0;) {
        struct glint_error err = {0};
        json[length] = 0;
        assert_null(glint_run_open(make_run(*state, json), &err));
        assert_true(err.message[0] != 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_survey_counts_what_the_frame_holds),
        cmocka_unit_test(a_plan_needs_no_device),
        cmocka_unit_test(a_good_run_is_read),
        cmocka_unit_test(bad_runs_are_refused_by_name),
        cmocka_unit_test(what_the_json_promises_is_checked_when_read),
        cmocka_unit_test(a_cut_run_json_is_an_error),
    };
    return cmocka_run_group_tests(tests, fixture_setup_host, fixture_teardown);
}
