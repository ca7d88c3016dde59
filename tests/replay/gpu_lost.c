/* What a caller does after calls of Vulkan that failed: with the same device and replay if the device is there, with new ones if it was lost. The faults
   come from fault_layer.c; the argument is the folder of its manifest, and a second one, "all" or the name of a function, tries every call. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

static bool everything;
static const char *only;

static struct glint_device *open_device(void) {
    struct glint_error err = {0};
    struct glint_device *device = glint_device_create(NULL, &err);
    if (!device) fail_msg("%s", err.message);
    return device;
}

static struct glint_replay *open_replay(struct glint_device *device, struct glint_capture *capture) {
    struct glint_error err = {0};
    struct glint_replay *replay = glint_replay_create(device, &err);
    if (!replay || !glint_replay_load(replay, capture, &err)) fail_msg("%s", err.message);
    return replay;
}

static const struct glint_replay_options diagnostics = {.diagnostics = true};

static bool run(struct glint_replay *replay, const struct fixture *fixture, struct glint_error *err) {
    return glint_replay_run(replay, fixture->pipeline, &diagnostics, NULL, NULL, err);
}

static void expect_whole(struct glint_replay *replay, const struct fixture *fixture, const struct snapshot *whole) {
    struct glint_error err = {0};
    struct snapshot again;
    if (!run(replay, fixture, &err)) fail_msg("%s", err.message);
    snapshot_take(&again, replay);
    assert_int_equal(again.count, whole->count);
    assert_true(snapshot_compare(&again, whole) > 10);
    snapshot_free(&again);
}

static void arm(const char *call, uint32_t number, const char *result, const char *times) {
    char text[16];
    snprintf(text, sizeof text, "%u", number);
    setenv("GLINT_FAULT_FROM", text, 1);
    setenv("GLINT_FAULT_RESULT", result, 1);
    setenv("GLINT_FAULT_TIMES", times, 1);
    setenv("GLINT_FAULT_CALL", call, 1);
}

static void disarm(void) {
    unsetenv("GLINT_FAULT_CALL");
}

/* A run in which a call fails once; false if it has no call of that number. Afterwards the same replay, or a new device's, gives the same images. */
static bool try_fault(const struct fixture *fixture, const struct snapshot *whole, const char *call, uint32_t number,
                      const char *result) {
    struct glint_error err = {0};
    struct glint_device *device = open_device();
    struct glint_replay *replay = open_replay(device, fixture->capture);
    const bool given_up = !strcmp(call, "vkWaitForFences") && !strcmp(result, "VK_TIMEOUT"); /* if it goes on */
    const bool lost = !strcmp(result, "VK_ERROR_DEVICE_LOST") || given_up;
    const bool memory = strstr(result, "MEMORY") != NULL;
    assert_false(glint_device_lost(device));
    arm(call, number, result, given_up ? "0" : "1");
    const bool failed = !run(replay, fixture, &err);
    disarm();
    if (failed) {
        assert_int_equal(err.code, memory ? GLINT_ERROR_MEMORY : GLINT_ERROR_DEVICE);
        fixture_says(&err, fixture->capture_path);
        assert_true(glint_device_lost(device) == lost);
        assert_true(glint_device_given_up(device) == given_up);
    }
    if (failed && lost) {
        assert_false(run(replay, fixture, &err));
        assert_int_equal(err.code, GLINT_ERROR_DEVICE);
        glint_replay_destroy(&replay);
        glint_device_destroy(&device);
        device = open_device();
        replay = open_replay(device, fixture->capture);
    }
    expect_whole(replay, fixture, whole);
    glint_replay_destroy(&replay);
    glint_device_destroy(&device);
    return failed;
}

static void a_replay_goes_on_after_a_call_that_failed(void **state) {
    static const char *const calls[] = {"vkAllocateMemory",
                                        "vkMapMemory",
                                        "vkBindBufferMemory",
                                        "vkBindImageMemory",
                                        "vkCreateBuffer",
                                        "vkCreateBufferView",
                                        "vkCreateImage",
                                        "vkCreateImageView",
                                        "vkCreateShaderModule",
                                        "vkCreatePipelineLayout",
                                        "vkCreateComputePipelines",
                                        "vkCreateDescriptorSetLayout",
                                        "vkCreateDescriptorPool",
                                        "vkAllocateDescriptorSets",
                                        "vkResetCommandPool",
                                        "vkBeginCommandBuffer",
                                        "vkEndCommandBuffer",
                                        "vkCreateQueryPool",
                                        "vkResetFences",
                                        "vkWaitForFences",
                                        "vkGetQueryPoolResults",
                                        "vkQueueSubmit2",
                                        "vkGetPhysicalDeviceImageFormatProperties"};
    static const char *const results[] = {"VK_ERROR_OUT_OF_DEVICE_MEMORY", "VK_TIMEOUT", "VK_ERROR_OUT_OF_HOST_MEMORY",
                                          "VK_ERROR_DEVICE_LOST"};
    const struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_replay *replay = open_replay(fixture->device, fixture->capture);
    if (!run(replay, fixture, &err)) fail_msg("%s", err.message);
    struct snapshot whole;
    snapshot_take(&whole, replay);
    size_t tried = 0, failed = 0;
    for (size_t c = 0; c < sizeof calls / sizeof *calls; c++) {
        bool any = true, first = false;
        if (only && strcmp(only, calls[c]) != 0) continue;
        for (uint32_t number = 1; any; number += everything ? 1 : 3 * number) {
            any = false;
            for (size_t r = 0; r < 4; r++) {
                const bool gives_up = !strcmp(calls[c], "vkWaitForFences") && number == 4 && r == 1;
                if (!everything && r != (c + number) % 4 && !gives_up) continue;
                if (!strcmp(calls[c], "vkGetPhysicalDeviceImageFormatProperties") && r == 3)
                    continue; /* no call of a device */
                any |= try_fault(fixture, &whole, calls[c], number, results[r]);
                tried++;
            }
            failed += any;
            first |= any;
        }
        if (!first && strcmp(calls[c], "vkGetPhysicalDeviceImageFormatProperties")) fail_msg("no %s failed", calls[c]);
    }
    print_message("# %zu runs with faults\n", tried);
    assert_true(failed > 30 || only);
    snapshot_free(&whole);
    glint_replay_destroy(&replay);
}

/* As a server does whose device goes and comes back. */
static void a_device_that_comes_back(void **state) {
    const struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char file[160];
    snprintf(file, sizeof file, "%s/lost", fixture->folder);
    setenv("GLINT_FAULT_FILE", file, 1);
    struct glint_device *device = open_device();
    struct glint_replay *replay = open_replay(device, fixture->capture);
    struct snapshot whole;
    assert_true(run(replay, fixture, &err));
    snapshot_take(&whole, replay);
    for (int turn = 0; turn < 3; turn++) {
        const struct glint_image *image = glint_replay_find_image(replay, "composed");
        float *pixels = calloc((size_t)image->width * image->height * image->components, sizeof *pixels);
        assert_non_null(pixels);
        fclose(fopen(file, "w"));
        if (turn == 1) { /* between a run and what is read of it */
            assert_false(glint_replay_read_image(replay, image, GLINT_F32, pixels, &err));
            assert_int_equal(err.code, GLINT_ERROR_DEVICE);
            fixture_says(&err, fixture->capture_path);
            fixture_says(&err, "reading back composed");
        } else if (turn == 2) {
            char folder[160];
            snprintf(folder, sizeof folder, "%s/never", fixture->folder);
            assert_false(glint_replay_write(replay, folder, NULL, NULL, &err));
            assert_int_equal(err.code, GLINT_ERROR_DEVICE);
            assert_int_not_equal(access(folder, F_OK), 0);
        }
        free(pixels);
        const struct glint_replay_options again = {.no_cache = true};
        assert_false(glint_replay_run(replay, fixture->pipeline, &again, NULL, NULL, &err));
        assert_int_equal(err.code, GLINT_ERROR_DEVICE);
        fixture_says(&err, "the device was lost");
        assert_true(glint_device_lost(device));
        glint_replay_destroy(&replay);
        glint_device_destroy(&device);
        device = glint_device_create(NULL, &err);
        assert_null(device);
        assert_int_equal(err.code, GLINT_ERROR_DEVICE);
        unlink(file);
        device = open_device();
        replay = open_replay(device, fixture->capture);
        expect_whole(replay, fixture, &whole);
    }
    snapshot_free(&whole);
    glint_replay_destroy(&replay);
    glint_device_destroy(&device);
    unsetenv("GLINT_FAULT_FILE");
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_replay_goes_on_after_a_call_that_failed),
        cmocka_unit_test(a_device_that_comes_back),
    };
    if (argc < 2) return 1;
    everything = argc > 2;
    only = argc > 2 && strcmp(argv[2], "all") != 0 ? argv[2] : NULL;
    setenv("VK_LAYER_PATH", argv[1], 1);
    setenv("VK_INSTANCE_LAYERS", "VK_LAYER_GLINT_fault", 1);
    setenv("GLINT_TEST_UNCHECKED", "1", 1); /* the path hides the validation layer */
    return cmocka_run_group_tests_name("lost", tests, fixture_setup_device, fixture_teardown);
}
