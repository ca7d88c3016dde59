/* Whole runs on a device under validation: the same bits however a run is cut, repeated or watched. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "fixture.h"

static void run(struct fixture *fixture, const struct glint_replay_options *options) {
    struct glint_error err = {0};
    if (!glint_replay_run(fixture->replay, fixture->pipeline, options, NULL, NULL, &err)) fail_msg("%s", err.message);
}

static void write_run(struct fixture *fixture, const char *name, char *path) {
    struct glint_error err = {0};
    snprintf(path, 128, "%s/%s", fixture->folder, name);
    if (!glint_replay_write(fixture->replay, path, NULL, NULL, &err)) fail_msg("%s", err.message);
}

static const struct glint_pass_result *result_of(const struct fixture *fixture, const char *slot) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(results[i].pass->slot, slot) == 0) return &results[i];
    fail_msg("no result of %s", slot);
    return NULL;
}

static void assert_says(const struct glint_error *err, const char *part) {
    if (!strstr(err->message, part)) fail_msg("expected '%s' in: %s", part, err->message);
}

static void a_run_makes_every_image_of_its_passes(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const struct glint_replay_options options = {.diagnostics = true, .no_cache = true};
    size_t count, expected = 0;
    run(fixture, &options);
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    assert_int_equal(count, glint_pipeline_pass_count(fixture->pipeline));
    for (size_t p = 0; p < count; p++) {
        assert_true(results[p].ran);
        assert_int_equal(results[p].time.n, 1);
        for (size_t r = 0; r < results[p].pass->row_count; r++) {
            const struct glint_row *row = &results[p].pass->rows[r];
            if (row->kind != GLINT_ROW_WRITE && row->kind != GLINT_ROW_DIAGNOSTIC) continue;
            const struct glint_image *image = glint_replay_find_image(fixture->replay, row->name);
            assert_non_null(image);
            assert_ptr_equal(image->pass, results[p].pass);
            if (row->size == GLINT_SIZE_HALF) assert_int_equal(image->width, (FIXTURE_WIDTH + 1) / 2);
            if (row->size == GLINT_SIZE_HALF) assert_int_equal(image->height, (FIXTURE_HEIGHT + 1) / 2);
            if (row->size == GLINT_SIZE_FULL) assert_int_equal(image->height, FIXTURE_HEIGHT);
            if (row->size == GLINT_SIZE_ACTIVE) assert_int_equal(image->width, FIXTURE_CUBEMAPS);
            expected++;
        }
    }
    assert_int_equal(glint_replay_image_count(fixture->replay), expected);
    fixture_check_messages(fixture);
}

static void the_picture_is_finite_and_reflects(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    static float composed[FIXTURE_HEIGHT][FIXTURE_WIDTH][4], reflection[FIXTURE_HEIGHT][FIXTURE_WIDTH][4];
    run(fixture, NULL);
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed, &err));
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "reflection"),
                                        GLINT_F32, reflection, &err));
    size_t reflecting = 0;
    for (int y = 0; y < FIXTURE_HEIGHT; y++)
        for (int x = 0; x < FIXTURE_WIDTH; x++) {
            for (int c = 0; c < 4; c++) assert_true(isfinite(composed[y][x][c]));
            reflecting += reflection[y][x][0] > 0;
        }
    assert_true(reflecting > FIXTURE_WIDTH * FIXTURE_HEIGHT / 4); /* about half of the picture is floor */
    fixture_check_messages(fixture);
}

static void the_same_input_gives_the_same_bits(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const struct glint_replay_options options = {.no_cache = true};
    struct snapshot first, second;
    run(fixture, &options);
    snapshot_take(&first, fixture->replay);
    run(fixture, &options);
    snapshot_take(&second, fixture->replay);
    assert_int_equal(first.count, second.count);
    assert_true(snapshot_compare(&first, &second) > 10);
    snapshot_free(&first), snapshot_free(&second);
    fixture_check_messages(fixture);
}

static void diagnostics_change_no_bit(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct snapshot plain, diagnosed;
    run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&plain, fixture->replay);
    run(fixture, &(struct glint_replay_options){.no_cache = true, .diagnostics = true});
    snapshot_take(&diagnosed, fixture->replay);
    assert_true(diagnosed.count > plain.count);
    snapshot_compare(&plain, &diagnosed);
    snapshot_free(&plain), snapshot_free(&diagnosed);
    fixture_check_messages(fixture);
}

/* Every suffix of the pipeline, and every pass alone, on the images of the whole run. */
static void every_cut_gives_the_bits_of_the_whole(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct snapshot whole, part;
    char folder[128];
    const char *slots[32] = {NULL};
    size_t count;
    run(fixture, &(struct glint_replay_options){.diagnostics = true, .no_cache = true});
    snapshot_take(&whole, fixture->replay);
    write_run(fixture, "whole", folder);
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    assert_true(count < 32);
    for (size_t i = 0; i < count; i++) slots[i] = results[i].pass->slot;
    for (size_t cut = 0; cut < count; cut++)
        for (int alone = 0; alone < 2; alone++) {
            const char *one[] = {slots[cut], NULL};
            run(fixture,
                &(struct glint_replay_options){
                    .passes = alone ? one : slots + cut, .inputs = folder, .diagnostics = true, .no_cache = true});
            snapshot_take(&part, fixture->replay);
            assert_true(snapshot_compare(&part, &whole) > 0);
            assert_true(result_of(fixture, slots[cut])->ran);
            snapshot_free(&part);
        }
    snapshot_free(&whole);
    fixture_check_messages(fixture);
}

static void an_unchanged_pass_does_not_run_again(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = fixture->pipeline;
    size_t count;
    run(fixture, &(struct glint_replay_options){.no_cache = true});
    run(fixture, NULL);
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    for (size_t i = 0; i < count; i++) assert_int_equal(results[i].cached, results[i].pass->host == NULL);
    const double seconds = glint_replay_seconds(fixture->replay, "read");
    assert_true(glint_pipeline_set(pipeline, "cubemap_trace.length_m=55", &err));
    run(fixture, NULL);
    assert_true(result_of(fixture, "screen_trace")->cached);
    assert_false(result_of(fixture, "cubemap_trace")->cached);
    assert_false(result_of(fixture, "compose")->cached);
    assert_true(glint_replay_seconds(fixture->replay, "read") == seconds); /* nothing was read for it */
    fixture_check_messages(fixture);
}

static void a_cached_run_has_the_bits_of_a_fresh_one(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct snapshot cached, fresh;
    assert_true(glint_pipeline_set(fixture->pipeline, "downsample.share=0.5", &err));
    run(fixture, NULL);
    assert_true(glint_pipeline_set(fixture->pipeline, "downsample.share=1", &err));
    run(fixture, NULL);
    snapshot_take(&cached, fixture->replay);
    run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&fresh, fixture->replay);
    assert_int_equal(snapshot_compare(&cached, &fresh), fresh.count);
    snapshot_free(&cached), snapshot_free(&fresh);
    fixture_check_messages(fixture);
}

static void sharing_memory_changes_no_bit(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const outputs[] = {"reflection_half", "composed", NULL};
    struct snapshot whole, part;
    run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&whole, fixture->replay);
    run(fixture, &(struct glint_replay_options){.no_cache = true, .outputs = outputs, .repeat = 2});
    snapshot_take(&part, fixture->replay);
    assert_int_equal(snapshot_compare(&part, &whole), 2);
    assert_int_equal(result_of(fixture, "compose")->time.n, 2);
    snapshot_free(&whole), snapshot_free(&part);
    fixture_check_messages(fixture);
}

static void float_precision_widens_every_half_image(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    run(fixture, &(struct glint_replay_options){.float_precision = true});
    assert_int_equal(glint_replay_find_image(fixture->replay, "composed")->format, GLINT_FORMAT_RGBA32F);
    for (size_t i = 0; i < glint_replay_image_count(fixture->replay); i++) {
        const enum glint_format format = glint_replay_image(fixture->replay, i)->format;
        assert_true(format != GLINT_FORMAT_R16F && format != GLINT_FORMAT_RG16F && format != GLINT_FORMAT_RGBA16F);
    }
    fixture_check_messages(fixture);
}

/* Frames that call for less, each through its own replay. */
static void check_frame(struct fixture *fixture, const struct fixture_options *frame, const char *dropped,
                        const char *reason) {
    struct glint_error err = {0};
    char path[128];
    static float composed[FIXTURE_HEIGHT][FIXTURE_WIDTH][4];
    snprintf(path, sizeof path, "%s/frame.exr", fixture->folder);
    assert_true(fixture_write_capture(path, frame, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
    run(fixture, NULL);
    assert_false(result_of(fixture, dropped)->ran);
    assert_string_equal(result_of(fixture, dropped)->reason, reason);
    assert_true(result_of(fixture, "compose")->ran);
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed, &err));
    for (int y = 0; y < FIXTURE_HEIGHT; y++)
        for (int x = 0; x < FIXTURE_WIDTH; x++) assert_true(isfinite(composed[y][x][0]));
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

static void a_matte_frame_drops_all_but_the_last_pass(void **state) {
    char reason[64];
    snprintf(reason, sizeof reason, "0 of %d pixels reflect", FIXTURE_WIDTH * FIXTURE_HEIGHT);
    check_frame(fixture_need_device(state), &(struct fixture_options){.matte = true}, "screen_trace", reason);
}

static void a_frame_without_cube_maps_still_runs(void **state) {
    check_frame(fixture_need_device(state), &(struct fixture_options){.no_cubemaps = true}, "cubemap_active",
                "0 cube maps");
}

/* The engine's own intermediate in the capture replaces the pass that would make it. */
static void an_engines_image_stands_in_for_a_pass(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const char *const last[] = {"compose", NULL};
    static float reflection[FIXTURE_HEIGHT][FIXTURE_WIDTH][4], composed[2][FIXTURE_HEIGHT][FIXTURE_WIDTH][4];
    char path[128];
    run(fixture, NULL);
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "reflection"),
                                        GLINT_F32, reflection, &err));
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed[0], &err));
    struct glint_channel channels[4];
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++)
        channels[c] =
            (struct glint_channel){names[c], GLINT_F32, &reflection[0][0][c], sizeof reflection[0][0], 0, NULL};
    const struct glint_part part = {.name = "engine.upscale.reflection",
                                    .width = FIXTURE_WIDTH,
                                    .height = FIXTURE_HEIGHT,
                                    .channels = channels,
                                    .channel_count = 4};
    snprintf(path, sizeof path, "%s/engine.exr", fixture->folder);
    if (!fixture_write_capture(path, &(struct fixture_options){.extra = &part}, &err)) fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
    run(fixture, &(struct glint_replay_options){.passes = last});
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed[1], &err));
    assert_memory_equal(composed[0], composed[1], sizeof composed[0]);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

/* What oiiotool says of a channel of a part: its least and greatest finite value. */
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
    run(fixture, &(struct glint_replay_options){.diagnostics = true});
    write_run(fixture, "foreign", folder);
    snprintf(command, sizeof command, "exrheader %s/*.exr >/dev/null && exrinfo %s/*.exr >/dev/null", folder, folder);
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
        /* The part's place in the file is that of the row among the pass's images. */
        int subimage = 0;
        for (size_t r = 0; r < image->pass->row_count && &image->pass->rows[r] != image->row; r++)
            subimage +=
                image->pass->rows[r].kind == GLINT_ROW_WRITE || image->pass->rows[r].kind == GLINT_ROW_DIAGNOSTIC;
        snprintf(file, sizeof file, "%s/%s", folder, images[i][1]);
        foreign_range(file, images[i][2], subimage, range);
        /* It prints six decimals. */
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
    run(fixture, &(struct glint_replay_options){.diagnostics = true});
    snapshot_take(&images, fixture->replay);
    write_run(fixture, "back", folder);
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

static bool stop_late(void *user, const char *what, double done) {
    (void)user, (void)done;
    return strcmp(what, "resolve") != 0;
}

static void an_interrupted_write_never_looks_complete(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char folder[128];
    run(fixture, NULL);
    write_run(fixture, "interrupted", folder);
    assert_true(exists(folder, "run.json"));
    assert_true(exists(folder, "08-compose.exr"));
    assert_false(glint_replay_write(fixture->replay, folder, stop_late, NULL, &err));
    assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
    assert_false(exists(folder, "run.json"));
    assert_false(exists(folder, "08-compose.exr")); /* nothing of the run before it is left */
    assert_null(glint_run_open(folder, &err));
    write_run(fixture, "interrupted", folder);
    assert_true(exists(folder, "run.json"));
}

static void an_interrupted_run_can_be_taken_up_again(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct snapshot whole, again;
    size_t count;
    run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&whole, fixture->replay);
    assert_false(glint_replay_run(fixture->replay, fixture->pipeline, &(struct glint_replay_options){.no_cache = true},
                                  stop_late, NULL, &err));
    assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
    glint_replay_results(fixture->replay, &count);
    assert_int_equal(count, 0);
    run(fixture, NULL);
    assert_false(result_of(fixture, "resolve")->cached);
    snapshot_take(&again, fixture->replay);
    snapshot_compare(&again, &whole);
    snapshot_free(&whole), snapshot_free(&again);
    fixture_check_messages(fixture);
}

static void missing_inputs_name_the_pass_that_makes_them(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const char *const only[] = {"resolve", NULL};
    assert_false(glint_replay_run(fixture->replay, fixture->pipeline, &(struct glint_replay_options){.passes = only},
                                  NULL, NULL, &err));
    assert_says(&err, "resolve/hit reads travelled, which cubemap_trace makes");
    assert_says(&err, "depth_half, which downsample makes");
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
    run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&built_in, fixture->replay);
    write_text(path, glint_pass_text("resolve/hit.comp"));
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia3", &err);
    assert_true(glint_pipeline_shader(pipeline, assignment, &err));
    const struct glint_replay_options options = {.no_cache = true};
    if (!glint_replay_run(fixture->replay, pipeline, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
    snapshot_take(&copied, fixture->replay);
    snapshot_compare(&copied, &built_in);
    /* An edited file runs again, and only what follows it does. */
    write_text(path,
               "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"shared/bindings.glsl\"\n"
               "#include \"hit.pass.h\"\n#include \"shared/push_begin.glsl\"\n#include \"hit.pass.h\"\n};\n"
               "void main() { imageStore(reflection_half, ivec2(gl_GlobalInvocationID.xy), vec4(0.25)); }\n");
    if (!glint_replay_run(fixture->replay, pipeline, NULL, NULL, NULL, &err)) fail_msg("%s", err.message);
    assert_true(result_of(fixture, "cubemap_trace")->cached);
    assert_false(result_of(fixture, "resolve")->cached);
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
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia3", &err);
    assert_true(glint_pipeline_shader(pipeline, assignment, &err));
    assert_false(glint_replay_run(fixture->replay, pipeline, NULL, NULL, NULL, &err));
    assert_says(&err, "foreign.comp");
    assert_says(&err, "binding 3 of set 0");
    glint_pipeline_destroy(&pipeline);
    fixture_check_messages(fixture);
}

static void devices_are_listed_and_chosen_by_index_or_name(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_device_info infos[16];
    struct glint_error err = {0};
    const size_t count = glint_devices(infos, 16, &err);
    assert_true(count >= 1);
    size_t usable = 0;
    while (usable < count && !infos[usable].usable) assert_true(infos[usable++].reason[0] != 0);
    assert_string_equal(glint_device_get_info(fixture->device)->name, infos[usable].name);
    assert_null(glint_device_create(&(struct glint_device_options){.select = "no such device"}, &err));
    assert_says(&err, "no device matches 'no such device'");
    char index[16];
    snprintf(index, sizeof index, "%zu", usable);
    struct glint_device *device = glint_device_create(&(struct glint_device_options){.select = index}, &err);
    assert_non_null(device);
    glint_device_destroy(&device);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(devices_are_listed_and_chosen_by_index_or_name),
        cmocka_unit_test(a_run_makes_every_image_of_its_passes),
        cmocka_unit_test(the_picture_is_finite_and_reflects),
        cmocka_unit_test(the_same_input_gives_the_same_bits),
        cmocka_unit_test(diagnostics_change_no_bit),
        cmocka_unit_test(every_cut_gives_the_bits_of_the_whole),
        cmocka_unit_test(an_unchanged_pass_does_not_run_again),
        cmocka_unit_test(a_cached_run_has_the_bits_of_a_fresh_one),
        cmocka_unit_test(sharing_memory_changes_no_bit),
        cmocka_unit_test(float_precision_widens_every_half_image),
        cmocka_unit_test(a_matte_frame_drops_all_but_the_last_pass),
        cmocka_unit_test(a_frame_without_cube_maps_still_runs),
        cmocka_unit_test(an_engines_image_stands_in_for_a_pass),
        cmocka_unit_test(a_run_folder_reads_back_as_it_was),
        cmocka_unit_test(foreign_tools_read_the_same_values),
        cmocka_unit_test(an_interrupted_write_never_looks_complete),
        cmocka_unit_test(an_interrupted_run_can_be_taken_up_again),
        cmocka_unit_test(missing_inputs_name_the_pass_that_makes_them),
        cmocka_unit_test(a_users_shader_replaces_the_pass),
        cmocka_unit_test(a_users_shader_with_foreign_bindings_is_refused),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
