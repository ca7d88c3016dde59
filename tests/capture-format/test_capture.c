/* The reader returns what was written. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "rewrite.h"
#include "unit.h"

static struct glint_capture *open_all(const char *path) {
    struct glint_error err = {0};
    if (!fixture_write(&fixture, path, FIXTURE_PARTS, NULL, &err)) fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

static void every_role_comes_back(UNUSED void **state) {
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

static void frame_comes_back_bit_for_bit(UNUSED void **state) {
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
    const struct glint_part_info *sky = glint_capture_find(capture, "sky"), *levels[GLINT_MAX_LEVELS];
    assert_true(sky->has_sky && !sky->has_probe);
    assert_true(sky->sky.has_ground == fixture.sky.has_ground && sky->sky.ground == fixture.sky.ground);
    double roughness[GLINT_MAX_LEVELS];
    assert_int_equal(glint_capture_probe(capture, 0, levels, roughness), 0);
    assert_int_equal(glint_capture_probe(capture, 2, levels, roughness), 2);
    for (int l = 0; l < 2; l++) {
        assert_true(levels[l]->has_probe && levels[l]->index == 2 && levels[l]->level == l);
        assert_true(levels[l]->width == (uint32_t)FIX_CUBE >> l && roughness[l] == fixture.probe[l].roughness);
        const struct glint_probe *got = &levels[l]->probe, *given = &fixture.probe[l];
        assert_true(got->has_roughness == given->has_roughness && got->roughness == given->roughness);
        assert_true(got->has_ground == given->has_ground && got->ground == given->ground);
        assert_int_equal(got->has_box, given->has_box);
        assert_memory_equal(&got->box, &given->box, sizeof given->box);
    }
    glint_capture_close(&capture);
    unlink(path);
}

static void names_of_levels(UNUSED void **state) {
    static const struct {
        const char *name, *role;
        int32_t index;
    } names[] = {{"probe.000", "probe", 0},          {"probe.012.level1", "probe", 12},
                 {"probe.012.level15", "probe", 12}, {"probe.000.level0", NULL, -1},
                 {"probe.000.level01", NULL, -1},    {"probe.000.level", NULL, -1},
                 {"probe.000.level1.x", NULL, -1},   {"probe.00.level1", NULL, -1},
                 {"probe.000.levels", NULL, -1},     {"probe.000.level100", NULL, -1},
                 {"cubemap.000.level1", NULL, -1},   {"sky.level1", NULL, -1},
                 {"previous.probe.000", NULL, -1},   {"probe", NULL, -1}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        int32_t index;
        bool previous;
        const struct glint_role *role = glint_role_find(names[i].name, &index, &previous);
        if (!role != !names[i].role || (role && strcmp(role->name, names[i].role)) || index != names[i].index)
            fail_msg("%s: %s, %d", names[i].name, role ? role->name : "no role", index);
    }
}

/* ---- single values ---- */

static void lengths_are_metres(UNUSED void **state) {
    char path[512];
    static float out[6 * FIX_CUBE * FIX_CUBE];
    struct glint_error err = {0};
    struct glint_capture *capture = open_all(fixture_path(path, "lengths.exr"));
    const char *const names[] = {"distance.Z"};
    if (!glint_capture_read(capture, glint_capture_find(capture, "cubemap.000"), names, 1, GLINT_F32, out, 0, &err))
        fail_msg("%s", err.message);
    for (size_t i = 0; i < 6 * FIX_CUBE * FIX_CUBE; i++) {
        const double metres = 0.01 * (double)fixture.cube[5 * i + 4];
        if (isinf(metres)) assert_true(isinf(out[i]) && out[i] > 0);
        else assert_true(fabs((double)out[i] - metres) <= metres * ldexp(1, -24)); /* one rounding to float */
    }
    glint_capture_close(&capture);
    unlink(path);
}

/* A capture with the channel `any` of the part `engine.any`: 256 x 256 values. */
static struct glint_capture *with_values(const char *path, enum glint_type type, const void *values) {
    const struct glint_channel channel = {.name = "any", .type = type, .data = values};
    const struct glint_part part = {
        .name = "engine.any", .width = 256, .height = 256, .channels = &channel, .channel_count = 1};
    const struct glint_frame frame = fixture_frame();
    struct glint_error err = {0};
    struct glint_writer *writer = glint_writer_create(path, NULL, &err);
    bool ok = writer && glint_writer_set_frame(writer, &frame, &err) && glint_writer_add_part(writer, &part, &err);
    for (int p = 0; ok && p <= FIXTURE_LIT; p++) {
        struct fixture_channels channels;
        const struct glint_part other = fixture_part(&fixture, (enum fixture_part)p, &channels);
        ok = glint_writer_add_part(writer, &other, &err);
    }
    ok = ok && glint_writer_finish(writer, &err);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = ok ? glint_capture_open(path, NULL, &err) : NULL;
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

static void read_values(struct glint_capture *capture, size_t count, enum glint_type type, void *out) {
    struct glint_error err = {0};
    const char *const names[] = {"any", NULL};
    const struct glint_part_info *part = glint_capture_find(capture, "engine.any");
    if (!glint_capture_read(capture, part, names, count, type, out, 0, &err)) fail_msg("%s", err.message);
}

static void every_half_keeps_its_bits(UNUSED void **state) {
    char path[512];
    static uint16_t in[65536], back[2 * 65536];
    static float wide[65536];
    for (uint32_t i = 0; i < 65536; i++) in[i] = (uint16_t)i;
    struct glint_capture *capture = with_values(fixture_path(path, "half.exr"), GLINT_F16, in);
    read_values(capture, 2, GLINT_F16, back);
    for (uint32_t i = 0; i < 65536; i++) assert_true(back[2 * i] == in[i] && back[2 * i + 1] == 0);
    read_values(capture, 1, GLINT_F32, wide);
    for (uint32_t i = 0; i < 65536; i++) {
        const int e = (int)(i >> 10 & 31), f = (int)(i & 1023);
        const double value = e == 31 ? (f ? (double)NAN : (double)INFINITY)
                             : e     ? ldexp(1024 + f, e - 25)
                                     : ldexp(f, -24);
        if (isnan(value)) assert_true(isnan(wide[i]));
        else assert_true((double)wide[i] == (i & 0x8000 ? -value : value));
    }
    glint_capture_close(&capture);
    unlink(path);
}

/* Floats are rounded to the nearest half, ties to even, compared with both exact neighbours. */
static void floats_round_to_the_nearest_half(UNUSED void **state) {
    char path[512];
    static float in[65536];
    static uint16_t out[65536];
    for (uint32_t i = 0; i < 65536; i++) {
        const double magnitude = ldexp(1 + fixture_noise(i, 1), (int)(fixture_noise(i, 2) * 44) - 28);
        in[i] = (float)(i & 1 ? -magnitude : magnitude);
        /* every eighth value is halfway between two halves */
        if (i % 8 == 0) in[i] = (float)ldexp(2 * (1024 + (int)(i >> 3 & 1023)) + 1, (int)(i % 29) - 25);
    }
    struct glint_capture *capture = with_values(fixture_path(path, "nearest.exr"), GLINT_F32, in);
    read_values(capture, 1, GLINT_F16, out);
    for (uint32_t i = 0; i < 65536; i++) {
        double near[3]; /* the half below, the result, the half above */
        for (int d = -1; d <= 1; d++) {
            const int bits = (out[i] & 0x7fff) + d, e = bits >> 10, f = bits & 1023;
            near[d + 1] = bits < 0 ? -ldexp(1, -24) : e ? ldexp(1024 + f, e - 25) : ldexp(f, -24);
        }
        const double v = fabs((double)in[i]), error = fabs(v - near[1]);
        if (out[i] & 1) assert_true(error < fabs(v - near[0]) && error < fabs(v - near[2]));
        else assert_true(error <= fabs(v - near[0]) && error <= fabs(v - near[2]));
        assert_true(near[1] == 0 || (out[i] >> 15) == (in[i] < 0));
    }
    glint_capture_close(&capture);
    unlink(path);
}

/* Each 8- and 16-bit value decodes to the value nearest to its own code. */
static void every_code_comes_back(UNUSED void **state) {
    static const enum glint_type types[] = {GLINT_UNORM8, GLINT_SNORM8, GLINT_UNORM16, GLINT_SNORM16};
    static uint8_t small[65536];
    static uint16_t large[65536];
    static float out[65536];
    for (uint32_t i = 0; i < 65536; i++) small[i] = (uint8_t)i, large[i] = (uint16_t)i;
    for (size_t t = 0; t < 4; t++) {
        char path[512];
        struct glint_capture *capture =
            with_values(fixture_path(path, "codes.exr"), types[t], t < 2 ? (void *)small : (void *)large);
        read_values(capture, 1, GLINT_F32, out);
        for (uint32_t i = 0; i < 65536; i++) {
            const long codes[] = {(uint8_t)i, (int8_t)i, (uint16_t)i, (int16_t)i}, tops[] = {255, 127, 65535, 32767};
            const long top = tops[t], code = codes[t] < -top ? -top : codes[t];
            assert_int_equal(lround((double)out[i] * (double)top), code);
        }
        glint_capture_close(&capture);
        unlink(path);
    }
}

static void folders_are_made_with_those_around_them(UNUSED void **state) {
    static const char *const made[] = {"around/within/deepest", "around/within", "around"};
    struct glint_error err = {0};
    char path[512];
    assert_true(glint_make_folder(fixture_path(path, made[0]), &err));
    assert_true(glint_make_folder(path, &err)); /* it is there already */
    for (size_t i = 0; i < 3; i++) assert_int_equal(rmdir(fixture_path(path, made[i])), 0);
    FILE *file = fopen(fixture_path(path, "around"), "w");
    assert_non_null(file);
    fclose(file);
    char below[520];
    snprintf(below, sizeof below, "%s/within", path);
    assert_false(glint_make_folder(below, &err));
    assert_string_equal(strstr(err.message, ": "), ": expected a folder, found something else");
    assert_int_equal(strncmp(err.message, path, strlen(path)), 0);
    unlink(path);
}

/* Channels that a part need not have are read as FORMAT.md says, alone and among others, and no others are. */
static void absent_channels_read_as_their_values(UNUSED void **state) {
    static const char *const names[] = {"material.metalness", "material.specular", "albedo.G", "material.roughness"};
    static const char *const gone[] = {"material.metalness", "material.specular", "albedo.R", "albedo.G",
                                       "albedo.B",           "motion.X",          "motion.Y", "motion.Z"};
    static const float values[] = {0, 0.5f, 0.8f};
    static const uint16_t halves[] = {0, 0x3800, 0x3a66};
    static struct fixture f;
    static struct rewrite r;
    static float read[FIX_W * FIX_H * 4], alone[FIX_W * FIX_H];
    static uint16_t half[FIX_W * FIX_H * 4];
    struct glint_error err = {0};
    char path[512];
    fixture_init(&f);
    assert_true(fixture_write(&f, fixture_path(path, "absent.exr"), FIXTURE_LIT + 1, NULL, &err));
    rewrite_load(&r, path);
    for (size_t i = 0; i < sizeof gone / sizeof *gone; i++) rewrite_remove_channel(&r, "gbuffer", gone[i]);
    unlink(path);
    rewrite_save(&r, path);
    rewrite_finish(&r);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    const struct glint_part_info *part = glint_capture_find(capture, "gbuffer");
    assert_true(glint_capture_read(capture, part, names, 4, GLINT_F32, read, 2, &err));
    assert_true(glint_capture_read(capture, part, names, 4, GLINT_F16, half, 2, &err));
    for (size_t i = 0; i < FIX_W * FIX_H; i++) {
        for (size_t c = 0; c < 3; c++) assert_true(read[4 * i + c] == values[c] && half[4 * i + c] == halves[c]);
        assert_true(read[4 * i + 3] == f.gbuffer[17 * i + 4]); /* as stored */
    }
    for (size_t c = 0; c < 3; c++) {
        assert_true(glint_capture_read(capture, part, &names[c], 1, GLINT_F32, alone, 1, &err));
        for (size_t i = 0; i < FIX_W * FIX_H; i++) assert_true(alone[i] == values[c]);
        assert_true(glint_part_can_read(part, names[c]) && !glint_part_has_channel(part, names[c]));
    }
    const char *const motion = "motion.X";
    assert_false(glint_part_can_read(part, motion));
    assert_false(glint_capture_read(capture, part, &motion, 1, GLINT_F32, alone, 1, &err));
    glint_capture_close(&capture);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_role_comes_back),
        cmocka_unit_test(frame_comes_back_bit_for_bit),
        cmocka_unit_test(names_of_levels),
        cmocka_unit_test(lengths_are_metres),
        cmocka_unit_test(absent_channels_read_as_their_values),
        cmocka_unit_test(every_half_keeps_its_bits),
        cmocka_unit_test(floats_round_to_the_nearest_half),
        cmocka_unit_test(every_code_comes_back),
        cmocka_unit_test(folders_are_made_with_those_around_them),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
