/* Files of a run: run folders, the engine's images, and users' shaders. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "need.h"
#include "unit.h"

/* Composes with the engine's own reflection in the capture, which the replay then refers to; the caller closes it. */
static struct glint_capture *compose_engines(struct fixture *fixture,
                                             float reflection[FIXTURE_HEIGHT][FIXTURE_WIDTH][4]) {
    static const char *const names[] = {"R", "G", "B", "A"};
    const char *const last[] = {"compose", NULL};
    struct glint_error err = {0};
    struct glint_channel channels[4];
    char path[128];
    for (int c = 0; c < 4; c++)
        channels[c] =
            (struct glint_channel){names[c], GLINT_F32, &reflection[0][0][c], sizeof reflection[0][0], 0, NULL};
    const struct glint_part part = {.name = "engine.upscale.reflection",
                                    .width = FIXTURE_WIDTH,
                                    .height = FIXTURE_HEIGHT,
                                    .channels = channels,
                                    .channel_count = 4};
    snprintf(path, sizeof path, "%s/engine.exr", fixture->folder);
    if (!fixture_write_capture(path, &(struct fixture_options){.extra = &part, .extra_count = 1}, &err))
        fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
    fixture_run(fixture, &(struct glint_replay_options){.passes = last});
    return capture;
}

/* The engine's intermediate in the capture replaces the pass that would write it. */
static void an_engines_image_replaces_a_pass(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    static float reflection[FIXTURE_HEIGHT][FIXTURE_WIDTH][4], composed[2][FIXTURE_HEIGHT][FIXTURE_WIDTH][4];
    fixture_run(fixture, NULL);
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "reflection"),
                                        GLINT_F32, reflection, &err));
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed[0], &err));
    struct glint_capture *capture = compose_engines(fixture, reflection);
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed[1], &err));
    assert_memory_equal(composed[0], composed[1], sizeof composed[0]);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

/* NaN and values beyond half floats are counted, in memory and in run.json, with the first one and the pass that wrote it. */
static void bad_values_are_counted_and_placed(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    static float reflection[FIXTURE_HEIGHT][FIXTURE_WIDTH][4];
    char folder[128];
    memset(reflection, 0, sizeof reflection);
    reflection[2][3][1] = NAN, reflection[5][7][0] = reflection[5][8][0] = -1e6f;
    struct glint_capture *capture = compose_engines(fixture, reflection);
    const struct glint_bad_values *bad = NULL;
    size_t count = 0;
    assert_true(glint_replay_bad_values(fixture->replay, &bad, &count, &err));
    assert_true(count >= 1);
    assert_string_equal(bad[0].image, "reflection");
    assert_string_equal(bad[0].pass->slot, "upscale");
    assert_string_equal(bad[0].channel, "G");
    assert_int_equal(bad[0].x, 3);
    assert_int_equal(bad[0].y, 2);
    assert_true(isnan(bad[0].value));
    assert_int_equal(bad[0].not_finite, 1);
    assert_int_equal(bad[0].clamped, 2);
    fixture_write_run(fixture, "bad", folder);
    struct glint_run *run = glint_run_open(folder, &err);
    assert_non_null(run);
    assert_non_null(strstr(glint_run_json(run), "\"bad_values\": ["));
    assert_non_null(strstr(glint_run_json(run), "\"value\": \"NaN\""));
    assert_non_null(strstr(glint_run_json(run), "\"clamped\": 2"));
    glint_run_close(&run);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    fixture_run(fixture, NULL);
    assert_true(glint_replay_bad_values(fixture->replay, &bad, &count, &err));
    assert_int_equal(count, 0);
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

/* The minimum and maximum finite value of a channel that oiiotool reports. */
static void foreign_range(const char *file, const char *channel, int subimage, double range[2]) {
    char command[512], line[4096];
    snprintf(command, sizeof command, "oiiotool '%s' --subimage %d --ch '%s' --printstats 2>&1", file, subimage,
             channel);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    range[0] = NAN, range[1] = NAN;
    while (fgets(line, sizeof line, pipe)) {
        sscanf(line, " Stats Min: %lf", &range[0]);
        sscanf(line, " Stats Max: %lf", &range[1]);
    }
    assert_int_equal(pclose(pipe), 0);
}

static void foreign_tools_read_the_same_values(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char folder[128], file[256], command[512];
    static const char *const programs[] = {"exrheader", "exrinfo", "oiiotool"};
    for (size_t i = 0; i < 3; i++) need_program(programs[i]);
    fixture_run(fixture, &(struct glint_replay_options){.diagnostics = true});
    fixture_write_run(fixture, "foreign", folder);
    /* exrinfo 3.1.5 never sets its exit status, so its messages are checked */
    snprintf(command, sizeof command,
             "exrheader %s/*.exr >/dev/null && test -z \"$(exrinfo %s/*.exr 2>&1 >/dev/null)\"", folder, folder);
    assert_int_equal(system(command), 0);
    const char *const images[][3] = {{"depth_half", "02-downsample.exr", "Z"},
                                     {"reflection", "07-upscale.exr", "G"},
                                     {"composed", "08-compose.exr", "B"},
                                     {"screen_travelled", "03-screen_trace.exr", "Z"}};
    for (size_t i = 0; i < 4; i++) {
        const struct glint_image *image = glint_replay_find_image(fixture->replay, images[i][0]);
        const size_t count = (size_t)image->width * image->height;
        float *pixels = malloc(count * image->components * sizeof *pixels);
        assert_true(glint_replay_read_image(fixture->replay, image, GLINT_F32, pixels, &err));
        const size_t channel = strcspn("RGB", images[i][2]) % 3;
        double low = INFINITY, high = -INFINITY, range[2];
        for (size_t p = 0; p < count; p++) {
            const double value = (double)pixels[p * image->components + channel];
            if (!isfinite(value)) continue;
            low = fmin(low, value), high = fmax(high, value);
        }
        /* The part's index in the file is that of the row among the pass's images. */
        int subimage = 0;
        for (size_t r = 0; r < image->pass->row_count && &image->pass->rows[r] != image->row; r++)
            subimage +=
                image->pass->rows[r].kind == GLINT_ROW_WRITE || image->pass->rows[r].kind == GLINT_ROW_DIAGNOSTIC;
        snprintf(file, sizeof file, "%s/%s", folder, images[i][1]);
        foreign_range(file, images[i][2], subimage, range);
        /* it prints six decimals */
        assert_true(fabs(range[0] - low) <= 1e-6 * (1 + fabs(low)));
        assert_true(fabs(range[1] - high) <= 1e-6 * (1 + fabs(high)));
        free(pixels);
    }
}

static void a_run_folder_reads_back_as_it_was(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct snapshot images;
    char folder[128];
    fixture_run(fixture, &(struct glint_replay_options){.diagnostics = true});
    snapshot_take(&images, fixture->replay);
    fixture_write_run(fixture, "back", folder);
    struct glint_run *back = glint_run_open(folder, &err);
    if (!back) fail_msg("%s", err.message);
    assert_int_equal(glint_run_image_count(back), images.count);
    for (size_t i = 0; i < images.count; i++) {
        const struct glint_image *image = glint_replay_find_image(fixture->replay, images.images[i].name);
        const struct glint_run_image *stored = glint_run_find(back, image->name);
        assert_non_null(stored);
        assert_string_equal(stored->slot, image->pass->slot);
        assert_string_equal(stored->unit, image->row->unit);
        assert_string_equal(stored->meaning, image->row->help);
        assert_int_equal(stored->components, image->components);
        void *pixels = malloc(images.images[i].bytes);
        const size_t value = images.images[i].bytes / ((size_t)image->width * image->height * image->components);
        const enum glint_type type = stored->integer ? (value == 1 ? GLINT_U8 : GLINT_U32)
                                     : value == 2    ? GLINT_F16
                                                     : GLINT_F32;
        if (!glint_run_read(back, stored, type, pixels, &err)) fail_msg("%s", err.message);
        assert_memory_equal(pixels, images.images[i].data, images.images[i].bytes);
        free(pixels);
    }
    assert_non_null(strstr(glint_run_json(back), "\"length_m\""));
    glint_run_close(&back);
    snapshot_free(&images);
}

static bool exists(const char *folder, const char *name) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

static void a_run_does_not_replace_its_own_inputs(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const char *const last[] = {"compose", NULL};
    char folder[128];
    fixture_run(fixture, NULL);
    fixture_write_run(fixture, "inputs", folder);
    fixture_run(fixture, &(struct glint_replay_options){.passes = last, .inputs = folder});
    assert_false(glint_replay_write(fixture->replay, folder, NULL, NULL, &err));
    fixture_says(&err, "this folder holds the inputs of the run");
    assert_true(exists(folder, "run.json"));
    assert_true(exists(folder, "02-downsample.exr"));
}

static void inputs_of_another_capture_are_warned_of(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const char *const last[] = {"compose", NULL};
    char folder[128], path[128];
    fixture_run(fixture, NULL);
    fixture_write_run(fixture, "inputs", folder);
    snprintf(path, sizeof path, "%s/other.exr", fixture->folder);
    assert_true(fixture_write_capture(path, &(struct fixture_options){.no_cubemaps = true}, &err));
    struct glint_capture *other = glint_capture_open(path, NULL, &err);
    assert_non_null(other);
    for (int same = 0; same < 2; same++) {
        assert_true(glint_replay_load(fixture->replay, same ? fixture->capture : other, &err));
        fixture_run(fixture, &(struct glint_replay_options){.passes = last, .inputs = folder});
        fixture_write_run(fixture, "warned", path);
        struct glint_run *run = glint_run_open(path, &err);
        assert_non_null(run);
        assert_true((strstr(glint_run_json(run), "was made from another capture") != NULL) == !same);
        glint_run_close(&run);
    }
    glint_capture_close(&other);
}

/* Catches: a run that looks complete and is not, and an older one that is lost with it. */
static void an_interrupted_write_leaves_what_was_there(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    for (int older = 0; older < 2; older++) {
        struct glint_error err = {0};
        char folder[128];
        fixture_run(fixture, NULL);
        if (older) fixture_write_run(fixture, "interrupted", folder);
        else snprintf(folder, sizeof folder, "%s/interrupted", fixture->folder);
        assert_false(glint_replay_write(fixture->replay, folder, fixture_stop_at_resolve, NULL, &err));
        assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
        assert_int_equal(exists(folder, "run.json"), older);
        assert_int_equal(exists(folder, "08-compose.exr"), older);
        assert_int_equal(exists(folder, "02-downsample.exr"), older);
        assert_false(exists(folder, ".glint-new"));
        struct glint_run *run = glint_run_open(folder, &err);
        assert_int_equal(run != NULL, older);
        glint_run_close(&run);
    }
}

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void a_users_shader_replaces_the_pass(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char path[128], assignment[160];
    struct snapshot built_in, copied;
    snprintf(path, sizeof path, "%s/mine.comp", fixture->folder);
    snprintf(assignment, sizeof assignment, "resolve=%s", path);
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&built_in, fixture->replay);
    write_text(path, glint_pass_text("reflection/resolve/hit.comp"));
    struct glint_pipeline *pipeline = glint_pipeline_create(GLINT_TEST_PRESET, &err);
    assert_true(glint_pipeline_shader(pipeline, assignment, &err));
    const struct glint_replay_options options = {.no_cache = true};
    if (!glint_replay_run(fixture->replay, pipeline, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
    snapshot_take(&copied, fixture->replay);
    snapshot_compare(&copied, &built_in);
    /* An edited file runs again, and only the passes after it do. */
    write_text(path,
               "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"shared/bindings.glsl\"\n"
               "#include \"hit.pass.h\"\n#include \"shared/push_begin.glsl\"\n#include \"hit.pass.h\"\n};\n"
               "void main() { imageStore(reflection_half, ivec2(gl_GlobalInvocationID.xy), vec4(0.25)); }\n");
    if (!glint_replay_run(fixture->replay, pipeline, NULL, NULL, NULL, &err)) fail_msg("%s", err.message);
    assert_true(fixture_result(fixture, "cubemap_trace")->cached);
    assert_false(fixture_result(fixture, "resolve")->cached);
    const struct glint_image *image = glint_replay_find_image(fixture->replay, "reflection_half");
    float *pixels = malloc((size_t)image->width * image->height * 4 * sizeof *pixels);
    assert_true(glint_replay_read_image(fixture->replay, image, GLINT_F32, pixels, &err));
    for (size_t i = 0; i < (size_t)image->width * image->height * 4; i++) assert_true(pixels[i] == 0.25f);
    free(pixels);
    glint_pipeline_destroy(&pipeline);
    snapshot_free(&built_in), snapshot_free(&copied);
    fixture_check_messages(fixture);
}

static void a_users_shader_with_foreign_bindings_is_refused(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char path[128], assignment[160];
    snprintf(path, sizeof path, "%s/foreign.comp", fixture->folder);
    snprintf(assignment, sizeof assignment, "resolve=%s", path);
    write_text(path, "#version 460\nlayout(local_size_x = 8, local_size_y = 8) in;\n"
                     "layout(set = 0, binding = 3) buffer B { uint x[]; } b;\nvoid main() { b.x[0] = 1; }\n");
    struct glint_pipeline *pipeline = glint_pipeline_create(GLINT_TEST_PRESET, &err);
    assert_true(glint_pipeline_shader(pipeline, assignment, &err));
    assert_false(glint_replay_run(fixture->replay, pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "foreign.comp");
    fixture_says(&err, "binding 3 of set 0");
    glint_pipeline_destroy(&pipeline);
    fixture_check_messages(fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_engines_image_replaces_a_pass),
        cmocka_unit_test(bad_values_are_counted_and_placed),
        cmocka_unit_test(a_run_folder_reads_back_as_it_was),
        cmocka_unit_test(foreign_tools_read_the_same_values),
        cmocka_unit_test(a_run_does_not_replace_its_own_inputs),
        cmocka_unit_test(inputs_of_another_capture_are_warned_of),
        cmocka_unit_test(an_interrupted_write_leaves_what_was_there),
        cmocka_unit_test(a_users_shader_replaces_the_pass),
        cmocka_unit_test(a_users_shader_with_foreign_bindings_is_refused),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
