/* What goes in through the writer comes out of the reader. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <setjmp.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "fixture.h"

static struct fixture fixture;

static struct glint_capture *open_all(const char *path) {
    struct glint_error err = {0};
    if (!fixture_write(&fixture, path, FIXTURE_PARTS, NULL, &err)) fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

static void every_role_comes_back(void **state) {
    (void)state;
    char path[512];
    struct glint_error err = {0};
    struct glint_capture *capture = open_all(fixture_path(path, "roles.exr"));
    assert_int_equal(glint_capture_part_count(capture), FIXTURE_PARTS);
    for (int p = 0; p < FIXTURE_PARTS; p++) {
        struct fixture_channels channels;
        const struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        const struct glint_part_info *info = glint_capture_find(capture, part.name);
        assert_non_null(info);
        assert_int_equal(info->width, part.width);
        assert_int_equal(info->height, part.height);
        assert_int_equal(info->channel_count, part.channel_count);
        for (size_t c = 0; c < part.channel_count; c++) {
            static float values[FIX_W * FIX_H];
            const bool integer = part.channels[c].type == GLINT_U32;
            if (!glint_capture_read_raw(capture, info, &part.channels[c].name, 1, integer ? GLINT_U32 : GLINT_F32,
                                        values, 0, &err))
                fail_msg("%s", err.message);
            const size_t stride = part.channels[c].x_stride_bytes ? part.channels[c].x_stride_bytes : 4;
            for (size_t i = 0; i < (size_t)part.width * part.height; i++)
                assert_memory_equal(&values[i], (const char *)part.channels[c].data + i * stride, 4);
        }
    }
    glint_capture_close(&capture);
    assert_null(capture);
    unlink(path);
}

static void frame_comes_back_bit_for_bit(void **state) {
    (void)state;
    char path[512];
    struct glint_capture *capture = open_all(fixture_path(path, "frame.exr"));
    const struct glint_frame expected = fixture_frame(), *found = glint_capture_frame(capture);
    assert_memory_equal(&found->camera, &expected.camera, sizeof expected.camera);
    assert_memory_equal(&found->previous, &expected.previous, sizeof expected.previous);
    assert_true(found->has_previous && found->has_player && found->has_fog && !found->cut);
    assert_memory_equal(found->player, expected.player, sizeof expected.player);
    assert_memory_equal(found->jitter_px, expected.jitter_px, sizeof expected.jitter_px);
    assert_true(found->exposure == expected.exposure && found->pre_exposure == expected.pre_exposure);
    assert_true(found->metres_per_unit == expected.metres_per_unit && found->motion_range == expected.motion_range);
    assert_true(found->depth_near == expected.depth_near && found->depth_far == expected.depth_far);
    assert_int_equal(found->number, expected.number);
    assert_memory_equal(found->fog.color, expected.fog.color, sizeof expected.fog.color);
    assert_true(found->fog.density == expected.fog.density && found->fog.base == expected.fog.base);
    assert_true(found->fog.scale_height == expected.fog.scale_height);
    assert_int_equal(found->class_count, 2);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(found->classes[i].value, expected.classes[i].value);
        assert_int_equal(found->classes[i].mask, expected.classes[i].mask);
        assert_string_equal(found->classes[i].name, expected.classes[i].name);
    }
    const struct glint_part_info *cube = glint_capture_find(capture, "cubemap.017");
    assert_true(cube->has_cubemap && cube->index == 17);
    assert_memory_equal(&cube->cubemap, &fixture.cubemap, sizeof fixture.cubemap);
    const struct glint_part_info *planar = glint_capture_find(capture, "planar.002");
    assert_true(planar->has_planar);
    assert_memory_equal(&planar->planar, &fixture.planar, sizeof fixture.planar);
    glint_capture_close(&capture);
    unlink(path);
}

static int setup(void **state) {
    (void)state;
    fixture_init(&fixture);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_role_comes_back),
        cmocka_unit_test(frame_comes_back_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
