/* Whole runs on a device with validation: the same bits for partial, repeated and diagnostic runs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

static void a_run_makes_every_image_of_its_passes(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const struct glint_replay_options options = {.diagnostics = true, .no_cache = true};
    size_t count, expected = 0;
    fixture_run(fixture, &options);
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
    fixture_run(fixture, NULL);
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
    assert_true(reflecting > FIXTURE_WIDTH * FIXTURE_HEIGHT / 4); /* about half of the image is floor */
    fixture_check_messages(fixture);
}

static void the_same_input_gives_the_same_bits(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const struct glint_replay_options options = {.no_cache = true};
    struct snapshot first, second;
    fixture_run(fixture, &options);
    snapshot_take(&first, fixture->replay);
    fixture_run(fixture, &options);
    snapshot_take(&second, fixture->replay);
    assert_int_equal(first.count, second.count);
    assert_true(snapshot_compare(&first, &second) > 10);
    snapshot_free(&first), snapshot_free(&second);
    fixture_check_messages(fixture);
}

static void diagnostics_change_no_bit(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct snapshot plain, diagnosed;
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&plain, fixture->replay);
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true, .diagnostics = true});
    snapshot_take(&diagnosed, fixture->replay);
    assert_true(diagnosed.count > plain.count);
    snapshot_compare(&plain, &diagnosed);
    snapshot_free(&plain), snapshot_free(&diagnosed);
    fixture_check_messages(fixture);
}

/* Every suffix of the pipeline, and every single pass, starting from the images of the whole run. */
static void every_cut_gives_the_bits_of_the_whole(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct snapshot whole, part;
    char folder[128];
    const char *slots[32] = {NULL};
    size_t count;
    fixture_run(fixture, &(struct glint_replay_options){.diagnostics = true, .no_cache = true});
    snapshot_take(&whole, fixture->replay);
    fixture_write_run(fixture, "whole", folder);
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    assert_true(count < 32);
    for (size_t i = 0; i < count; i++) slots[i] = results[i].pass->slot;
    for (size_t cut = 0; cut < count; cut++)
        for (int alone = 0; alone < 2; alone++) {
            const char *one[] = {slots[cut], NULL};
            fixture_run(fixture, &(struct glint_replay_options){.passes = alone ? one : slots + cut,
                                                                .inputs = folder,
                                                                .diagnostics = true,
                                                                .no_cache = true});
            snapshot_take(&part, fixture->replay);
            assert_true(snapshot_compare(&part, &whole) > 0);
            assert_true(fixture_result(fixture, slots[cut])->ran);
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
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true});
    fixture_run(fixture, NULL);
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    for (size_t i = 0; i < count; i++) assert_int_equal(results[i].cached, results[i].pass->host == NULL);
    const double seconds = glint_replay_seconds(fixture->replay, "read");
    assert_true(glint_pipeline_set(pipeline, "cubemap_trace.length_m=55", &err));
    fixture_run(fixture, NULL);
    assert_true(fixture_result(fixture, "screen_trace")->cached);
    assert_false(fixture_result(fixture, "cubemap_trace")->cached);
    assert_false(fixture_result(fixture, "compose")->cached);
    assert_true(glint_replay_seconds(fixture->replay, "read") == seconds);         /* nothing was read for it */
    assert_true(glint_pipeline_set(pipeline, "cubemap_trace.length_m=300", &err)); /* the default: others share it */
    fixture_check_messages(fixture);
}

static void a_cached_run_has_the_bits_of_a_fresh_one(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct snapshot cached, fresh;
    assert_true(glint_pipeline_set(fixture->pipeline, "downsample.share=0.5", &err));
    fixture_run(fixture, NULL);
    assert_true(glint_pipeline_set(fixture->pipeline, "downsample.share=1", &err));
    fixture_run(fixture, NULL);
    snapshot_take(&cached, fixture->replay);
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&fresh, fixture->replay);
    assert_int_equal(snapshot_compare(&cached, &fresh), fresh.count);
    snapshot_free(&cached), snapshot_free(&fresh);
    fixture_check_messages(fixture);
}

static void sharing_memory_changes_no_bit(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const outputs[] = {"reflection_half", "composed", NULL};
    struct snapshot whole, part;
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&whole, fixture->replay);
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true, .outputs = outputs, .repeat = 2});
    snapshot_take(&part, fixture->replay);
    assert_int_equal(snapshot_compare(&part, &whole), 2);
    assert_int_equal(fixture_result(fixture, "compose")->time.n, 2);
    snapshot_free(&whole), snapshot_free(&part);
    fixture_check_messages(fixture);
}

static void float_precision_widens_every_half_image(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    fixture_run(fixture, &(struct glint_replay_options){.float_precision = true});
    assert_int_equal(glint_replay_find_image(fixture->replay, "composed")->format, GLINT_FORMAT_RGBA32F);
    for (size_t i = 0; i < glint_replay_image_count(fixture->replay); i++) {
        const enum glint_format format = glint_replay_image(fixture->replay, i)->format;
        assert_true(format != GLINT_FORMAT_R16F && format != GLINT_FORMAT_RG16F && format != GLINT_FORMAT_RGBA16F);
    }
    fixture_check_messages(fixture);
}

/* The final image of the last run is in its folder, although no pass wrote it. */
static void check_written(struct fixture *fixture) {
    struct glint_error err = {0};
    static float composed[2][FIXTURE_HEIGHT][FIXTURE_WIDTH][4];
    char folder[128];
    fixture_write_run(fixture, "instead", folder);
    struct glint_run *run = glint_run_open(folder, &err);
    const struct glint_run_image *image = run ? glint_run_find(run, "composed") : NULL;
    assert_non_null(image);
    assert_string_equal(image->slot, "compose");
    assert_true(glint_run_read(run, image, GLINT_F32, composed[0], &err));
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed[1], &err));
    assert_memory_equal(composed[0], composed[1], sizeof composed[0]);
    glint_run_close(&run);
}

/* Where nothing reflects, composed equals lit: under both names, and under each alone if only that is requested. */
static void check_composed_is_lit(struct fixture *fixture) {
    struct snapshot whole, substituted;
    const char *const composed[] = {"composed", NULL}, *const other[] = {"depth_half", NULL};
    fixture_run(fixture, &(struct glint_replay_options){.all = true, .outputs = composed});
    assert_true(fixture_result(fixture, "compose")->ran);
    snapshot_take(&whole, fixture->replay);
    for (int captured = 0; captured < 2; captured++) {
        fixture_run(fixture, &(struct glint_replay_options){.captured = captured});
        assert_true(!fixture_result(fixture, "compose")->ran && fixture_result(fixture, "compose")->shown);
        assert_int_equal(glint_replay_image_count(fixture->replay), 1 + captured);
        const struct glint_image *lit = glint_replay_find_image(fixture->replay, "lit");
        assert_true((lit != NULL) == captured && (!lit || !lit->pass));
        assert_string_equal(glint_replay_find_image(fixture->replay, "composed")->pass->slot, "compose");
        if (captured) continue; /* a snapshot is of passes' images */
        snapshot_take(&substituted, fixture->replay);
        assert_int_equal(snapshot_compare(&substituted, &whole), 1);
        snapshot_free(&substituted);
    }
    snapshot_free(&whole);
    check_written(fixture);
    fixture_run(fixture, &(struct glint_replay_options){.outputs = other});
    assert_false(fixture_result(fixture, "compose")->shown);
    assert_int_equal(glint_replay_image_count(fixture->replay), 0);
}

/* Frames that need less, each with a replay of its own. */
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
    fixture_run(fixture, NULL);
    assert_false(fixture_result(fixture, dropped)->ran);
    assert_string_equal(fixture_result(fixture, dropped)->reason, reason);
    assert_true(fixture_result(fixture, "compose")->ran != frame->matte);
    assert_true(glint_replay_read_image(fixture->replay, glint_replay_find_image(fixture->replay, "composed"),
                                        GLINT_F32, composed, &err));
    for (int y = 0; y < FIXTURE_HEIGHT; y++)
        for (int x = 0; x < FIXTURE_WIDTH; x++) assert_true(isfinite(composed[y][x][0]));
    if (frame->matte) check_composed_is_lit(fixture);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

static void a_matte_frame_drops_all_passes(void **state) {
    char reason[64];
    snprintf(reason, sizeof reason, "0 of %d pixels reflect", FIXTURE_WIDTH * FIXTURE_HEIGHT);
    check_frame(fixture_need_device(state), &(struct fixture_options){.matte = true}, "screen_trace", reason);
}

static void a_frame_without_cube_maps_still_runs(void **state) {
    check_frame(fixture_need_device(state), &(struct fixture_options){.no_cubemaps = true}, "cubemap_active",
                "0 cube maps");
}

static void an_interrupted_run_can_be_taken_up_again(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct snapshot whole, again;
    size_t count;
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&whole, fixture->replay);
    assert_false(glint_replay_run(fixture->replay, fixture->pipeline, &(struct glint_replay_options){.no_cache = true},
                                  fixture_stop_at_resolve, NULL, &err));
    assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
    glint_replay_results(fixture->replay, &count);
    assert_int_equal(count, 0);
    fixture_run(fixture, NULL);
    assert_false(fixture_result(fixture, "resolve")->cached);
    snapshot_take(&again, fixture->replay);
    snapshot_compare(&again, &whole);
    snapshot_free(&whole), snapshot_free(&again);
    fixture_check_messages(fixture);
}

static void a_pipeline_of_nothing_runs(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char path[128];
    snprintf(path, sizeof path, "%s/nothing.json", fixture->folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs("{\"slots\": {}}", file) >= 0 && fclose(file) == 0);
    struct glint_pipeline *pipeline = glint_pipeline_create(path, &err);
    if (!pipeline) fail_msg("%s", err.message);
    if (!glint_replay_run(fixture->replay, pipeline, NULL, NULL, NULL, &err)) fail_msg("%s", err.message);
    assert_int_equal(glint_replay_image_count(fixture->replay), 0);
    glint_pipeline_destroy(&pipeline);
    fixture_check_messages(fixture);
}

static void missing_inputs_name_the_pass_that_makes_them(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const char *const only[] = {"resolve", NULL};
    assert_false(glint_replay_run(fixture->replay, fixture->pipeline, &(struct glint_replay_options){.passes = only},
                                  NULL, NULL, &err));
    fixture_says(&err, "resolve/hit reads travelled, which cubemap_trace makes");
    fixture_says(&err, "depth_half, which downsample makes");
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
    fixture_says(&err, "no device matches 'no such device'");
    char index[16];
    snprintf(index, sizeof index, "%zu", usable);
    struct glint_device *device = glint_device_create(&(struct glint_device_options){.select = index}, &err);
    assert_non_null(device);
    glint_device_destroy(&device);
}

/* The walls of a room without ceiling, with one colour per face: equal for any size of the faces. */
static float *cubemap_texels(uint32_t face, float light) {
    float *texels = malloc(6 * (size_t)face * face * 5 * sizeof *texels), *to = texels;
    assert_non_null(texels);
    for (uint32_t f = 0; f < 6; f++)
        for (uint32_t y = 0; y < face; y++)
            for (uint32_t x = 0; x < face; x++, to += 5) {
                const double a = (x + 0.5) / face * 2 - 1, b = (y + 0.5) / face * 2 - 1;
                to[0] = light * (float)f, to[1] = light, to[2] = light * (float)(6 - f), to[3] = f != 2;
                to[4] = f == 2 ? INFINITY : (float)(3 * sqrt(1 + a * a + b * b));
            }
    return texels;
}

/* Replays a capture whose cube maps have these sizes. */
static void replay_cubemaps(struct fixture *fixture, const uint32_t sizes[3], float light, struct snapshot *snapshot) {
    static const char *const channel_names[] = {"R", "G", "B", "A", "distance.Z"};
    static const char *const names[] = {"cubemap.000", "cubemap.001", "cubemap.002"};
    struct glint_error err = {0};
    struct glint_channel channels[3][5];
    struct glint_cubemap cubemaps[3];
    struct glint_part parts[3];
    float *texels[3];
    char path[128];
    for (int i = 0; i < 3; i++) {
        texels[i] = cubemap_texels(sizes[i], light);
        for (int c = 0; c < 5; c++)
            channels[i][c] =
                (struct glint_channel){channel_names[c], GLINT_F32, texels[i] + c, 5 * sizeof(float), 0, NULL};
        cubemaps[i] = (struct glint_cubemap){.center = {i - 1.0, 1.5, -2.0 - i}};
        parts[i] = (struct glint_part){.name = names[i],
                                       .width = sizes[i],
                                       .height = 6 * sizes[i],
                                       .channels = channels[i],
                                       .channel_count = 5,
                                       .cubemap = &cubemaps[i]};
    }
    snprintf(path, sizeof path, "%s/sizes.exr", fixture->folder);
    const struct fixture_options options = {.no_cubemaps = true, .extra = parts, .extra_count = 3};
    if (!fixture_write_capture(path, &options, &err)) fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
    fixture_run(fixture, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(snapshot, fixture->replay);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
    for (int i = 0; i < 3; i++) free(texels[i]);
}

/* Counts texels of an image of half floats that differ by more than 1/256. */
static size_t count_other_texels(const struct snapshot *a, const struct snapshot *b, const char *image) {
    size_t i = 0, count = 0;
    while (i < a->count && strcmp(a->images[i].name, image) != 0) i++;
    assert_true(i < a->count && b->count == a->count && b->images[i].bytes == a->images[i].bytes);
    const uint16_t *x = a->images[i].data, *y = b->images[i].data;
    for (size_t k = 0; k < a->images[i].bytes / 8; k++) {
        bool other = false;
        for (size_t c = 4 * k; c < 4 * k + 4; c++) other = other || abs(x[c] - y[c]) > 4; /* units in the last place */
        count += other;
    }
    return count;
}

static void cube_maps_of_different_sizes_are_taken_at_the_largest(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct snapshot mixed, alike, darker;
    replay_cubemaps(fixture, (const uint32_t[]){8, 24, 10}, 0.1F, &mixed);
    replay_cubemaps(fixture, (const uint32_t[]){24, 24, 24}, 0.1F, &alike);
    replay_cubemaps(fixture, (const uint32_t[]){24, 24, 24}, 0.05F, &darker); /* and cube maps have an effect */
    assert_int_equal(count_other_texels(&mixed, &alike, "composed"), 0);
    assert_true(count_other_texels(&alike, &darker, "composed") > 100);
    snapshot_free(&mixed), snapshot_free(&alike), snapshot_free(&darker);
    fixture_check_messages(fixture);
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
        cmocka_unit_test(a_matte_frame_drops_all_passes),
        cmocka_unit_test(a_frame_without_cube_maps_still_runs),
        cmocka_unit_test(cube_maps_of_different_sizes_are_taken_at_the_largest),
        cmocka_unit_test(an_interrupted_run_can_be_taken_up_again),
        cmocka_unit_test(a_pipeline_of_nothing_runs),
        cmocka_unit_test(missing_inputs_name_the_pass_that_makes_them),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
