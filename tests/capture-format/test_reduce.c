/* glint_edit_reduce, and parts that a copy takes as they are compressed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "glint/edit.h"
#include "hostile.h"
#include "rewrite.h"
#include "unit.h"

static char whole[512], copy[512], other[512];

static int make_whole(void **state) {
    struct glint_error err = {0};
    fixture_setup(state);
    fixture_path(copy, "reduce-copy.exr");
    fixture_path(other, "reduce-other.exr");
    return fixture_write(&fixture, fixture_path(whole, "reduce-whole.exr"), FIXTURE_PARTS, NULL, &err) ? 0 : -1;
}

static int remove_files(UNUSED void **state) {
    unlink(whole);
    unlink(copy);
    unlink(other);
    return 0;
}

static char said[4096];

static void say(UNUSED void *user, const char *text) {
    const size_t at = strlen(said);
    snprintf(said + at, sizeof said - at, "%s\n", text);
}

static struct glint_edit *opened(const char *path) {
    struct glint_error err = {0};
    said[0] = 0;
    struct glint_edit *edit = glint_edit_open(path, NULL, say, NULL, &err);
    if (!edit) fail_msg("%s", err.message);
    return edit;
}

/* Crops (unless the rectangle is NULL), reduces (unless the factor is 0) and writes. */
static void make(const char *from, const char *to, const struct glint_edit_rectangle *rectangle, uint32_t factor) {
    struct glint_error err = {0};
    struct glint_edit *edit = opened(from);
    if ((rectangle && !glint_edit_crop(edit, rectangle, &err)) || (factor && !glint_edit_reduce(edit, factor, &err)) ||
        !glint_edit_write(edit, to, &err))
        fail_msg("%s", err.message);
    glint_edit_close(&edit);
}

static void print_violation(UNUSED void *user, UNUSED const char *rule, const char *message) {
    print_message("# %s\n", message);
}

static size_t violations(const char *path) {
    struct glint_error err = {0};
    size_t count = 0;
    if (!glint_capture_validate(path, NULL, print_violation, NULL, &count, &err)) fail_msg("%s", err.message);
    return count;
}

/* Every part, channel and pixel is the same; returns how many channels. */
static size_t expect_same_pixels(const char *left, const char *right) {
    static struct rewrite a, b;
    size_t channels = 0;
    rewrite_load(&a, left);
    rewrite_load(&b, right);
    assert_int_equal(a.count, b.count);
    for (size_t p = 0; p < a.count; p++) {
        const struct glint_exr_part *from = &a.parts[p].part, *to = &rewrite_find(&b, a.parts[p].name)->part;
        assert_true(from->width == to->width && from->height == to->height && from->channel_count == to->channel_count);
        for (size_t c = 0; c < from->channel_count; c++, channels++) {
            const size_t bytes = from->channels[c].stored == GLINT_STORED_HALF ? 2 : 4;
            if (memcmp(a.parts[p].data[c], rewrite_pixels(&b, a.parts[p].name, from->channels[c].name),
                       (size_t)from->width * from->height * bytes))
                fail_msg("%s: %s differs", a.parts[p].name, from->channels[c].name);
        }
    }
    rewrite_finish(&a);
    rewrite_finish(&b);
    return channels;
}

/* The same file in one edit and in two, in which the second sees the copy of the first as any other capture. */
static void crop_and_reduce_is_one_after_the_other(UNUSED void **state) {
    static const struct glint_edit_rectangle rectangles[] = {{4, 2, 20, 12}, {0, 0, 40, 24}, {6, 8, 34, 16}};
    for (size_t i = 0; i < 3; i++)
        for (uint32_t factor = 2; factor < 5; factor++) {
            make(whole, copy, &rectangles[i], factor);
            make(whole, other, &rectangles[i], 0);
            char last[512];
            make(other, fixture_path(last, "reduce-last.exr"), NULL, factor);
            assert_true(expect_same_pixels(copy, last) > 50);
            unlink(last);
        }
}

static void a_factor_of_one_changes_nothing(UNUSED void **state) {
    make(whole, copy, NULL, 1);
    assert_string_equal(said, "");
    assert_true(expect_same_pixels(whole, copy) > 50);
}

static void parts_that_do_not_fit_are_left_out(UNUSED void **state) {
    static struct rewrite r;
    rewrite_load(&r, whole);
    static const uint32_t sizes[4][2] = {{10, 6}, {1, 1}, {5, 3}, {7, 24}};
    static const char *const names[] = {"engine.a.quarter", "engine.a.mean", "engine.a.eighth", "engine.a.list"};
    for (size_t i = 0; i < 4; i++) {
        struct rewrite_part *to = &r.parts[r.count++];
        *to = *rewrite_find(&r, "engine.screen_trace.anything");
        snprintf(to->name, sizeof to->name, "%s", names[i]);
        to->part.width = sizes[i][0], to->part.height = sizes[i][1];
        for (size_t c = 0; c < to->part.channel_count; c++) {
            void *pixels = malloc((size_t)FIX_W * FIX_H * 4);
            assert_non_null(pixels);
            memcpy(pixels, to->data[c], (size_t)FIX_W * FIX_H * 4);
            to->channels[c].data = to->data[c] = pixels;
        }
    }
    unlink(other);
    rewrite_save(&r, other);
    rewrite_finish(&r);
    /* The eighth's 5 x 3 texels, of a frame of 40 x 24: by 2 there are 3 x 2 of 20 x 12 pixels, and by 16 none of 3 x 2 pixels. */
    make(other, copy, NULL, 2);
    assert_null(strstr(said, "left out"));
    assert_non_null(strstr(said, "engine.a.list: kept whole"));
    struct glint_edit *edit = opened(copy);
    assert_int_equal(glint_edit_part(edit, glint_edit_find(edit, "engine.a.eighth"))->width, 3);
    assert_int_equal(glint_edit_part(edit, glint_edit_find(edit, "engine.a.quarter"))->height, 3);
    glint_edit_close(&edit);
    make(other, copy, NULL, 16);
    assert_non_null(strstr(said, "engine.a.quarter: left out; its texels"));
    assert_non_null(strstr(said, "engine.a.eighth: left out; its texels"));
    edit = opened(copy);
    assert_null(glint_edit_part(edit, glint_edit_find(edit, "engine.a.quarter")));
    assert_int_equal(glint_edit_part(edit, glint_edit_find(edit, "engine.a.mean"))->width, 1);
    assert_int_equal(glint_edit_part(edit, glint_edit_find(edit, "engine.a.list"))->height, 24);
    glint_edit_close(&edit);
    assert_int_equal(violations(copy), 0);
}

static void a_checkerboard_is_left_out_by_even_factors(UNUSED void **state) {
    static float drawn[FIX_W * FIX_H];
    static const char *const channel[] = {"drawn"};
    struct glint_error err = {0};
    for (uint32_t i = 0; i < FIX_W * FIX_H; i++) drawn[i] = (float)((i / FIX_W + i % FIX_W) % 2);
    struct glint_edit *edit = opened(whole);
    assert_true(glint_edit_add_part(edit, "stipple", FIX_W, FIX_H, channel, 1, drawn, &err) &&
                glint_edit_write(edit, other, &err));
    glint_edit_close(&edit);
    make(other, copy, NULL, 2);
    assert_non_null(strstr(said, "stipple: left out"));
    make(other, copy, NULL, 3);
    assert_null(strstr(said, "stipple"));
    static struct rewrite r;
    rewrite_load(&r, copy);
    const struct glint_exr_part *part = &rewrite_find(&r, "stipple")->part;
    const float *kept = rewrite_pixels(&r, "stipple", "drawn");
    for (uint32_t i = 0; i < part->width * part->height; i++)
        assert_true((int)kept[i] == (int)((i / part->width + i % part->width) % 2)); /* 3 x + 1, 3 y + 1: as before */
    rewrite_finish(&r);
    assert_int_equal(violations(copy), 0);
}

/* Clip = viewToClip · worldToView · (p, 1), divided by w: whether it is on the screen of this camera. */
static bool on_screen(const struct glint_camera *camera, const double p[3]) {
    double view[4] = {0, 0, 0, 1}, clip[4] = {0};
    for (int i = 0; i < 3; i++) {
        view[i] = camera->world_to_view[4 * i + 3];
        for (int k = 0; k < 3; k++) view[i] += camera->world_to_view[4 * i + k] * p[k];
    }
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) clip[i] += camera->view_to_clip[4 * i + k] * view[k];
    return clip[3] > 0 && fabs(clip[0]) <= clip[3] && fabs(clip[1]) <= clip[3];
}

/* The world position that the copy's camera sees through a pixel at a depth. */
static void seen_at(const struct glint_frame *frame, const uint32_t size[2], uint32_t x, uint32_t y, double depth,
                    double p[3]) {
    const double *m = frame->camera.view_to_clip, *v = frame->camera.world_to_view, w = m[14] < 0 ? -1 : 1;
    const double up = frame->clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1;
    const double ndc[2] = {(2.0 * x + 1) / size[0] - 1, up * ((2.0 * y + 1) / size[1] - 1)};
    const double view[3] = {(ndc[0] - m[2] * w) / m[0] * depth - v[3], (ndc[1] - m[6] * w) / m[5] * depth - v[7],
                            w * depth - v[11]};
    for (int i = 0; i < 3; i++) p[i] = v[i] * view[0] + v[4 + i] * view[1] + v[8 + i] * view[2];
}

/* In world space and with the copy's camera: the point at the given distance along the reflected ray is on screen. Borders move by half a pixel. */
static void hits_stay_visible_if_they_are_on_the_new_screen(UNUSED void **state) {
    static const char *const surface_names[] = {"depth.Z", "normal.X", "normal.Y", "normal.Z"};
    static const char *const truth_names[] = {"distance.Z", "visible"};
    static float surface[FIX_W * FIX_H * 4], truth[FIX_W * FIX_H * 2], before[FIX_W * FIX_H * 2];
    struct glint_error err = {0};
    size_t counts[2] = {0}, hidden = 0;
    struct glint_capture *from = glint_capture_open(whole, NULL, &err);
    assert_true(from && glint_capture_read(from, glint_capture_find(from, "truth.mirror"), truth_names, 2, GLINT_F32,
                                           before, 0, &err));
    for (uint32_t factor = 2; factor < 8; factor++) {
        make(whole, copy, NULL, factor);
        struct glint_capture *to = glint_capture_open(copy, NULL, &err);
        const struct glint_part_info *part = to ? glint_capture_find(to, "gbuffer") : NULL;
        assert_true(
            part && glint_capture_read(to, part, surface_names, 4, GLINT_F32, surface, 0, &err) &&
            glint_capture_read(to, glint_capture_find(to, "truth.mirror"), truth_names, 2, GLINT_F32, truth, 0, &err));
        const struct glint_frame *frame = glint_capture_frame(to);
        const uint32_t size[2] = {part->width, part->height}, middle = (factor - 1) / 2;
        double eye[3], p[3];
        glint_camera_position(&frame->camera, eye);
        for (uint32_t i = 0; i < size[0] * size[1]; i++) {
            const uint32_t x = i % size[0], y = i / size[0];
            const bool was = before[2 * ((middle + y * factor) * FIX_W + middle + x * factor) + 1] != 0;
            double length = 0, along = 0;
            seen_at(frame, size, x, y, (double)surface[4 * i], p);
            for (int a = 0; a < 3; a++) length += (p[a] - eye[a]) * (p[a] - eye[a]);
            for (int a = 0; a < 3; a++)
                along += (p[a] - eye[a]) / sqrt(length) * (double)surface[4 * i + 1 + (uint32_t)a];
            for (int a = 0; a < 3; a++)
                p[a] += (double)truth[2 * i] *
                        ((p[a] - eye[a]) / sqrt(length) - 2 * along * (double)surface[4 * i + 1 + (uint32_t)a]);
            assert_int_equal(truth[2 * i + 1] != 0, was && on_screen(&frame->camera, p));
            counts[truth[2 * i + 1] != 0]++;
            hidden += was && truth[2 * i + 1] == 0;
        }
        glint_capture_close(&to);
    }
    glint_capture_close(&from);
    print_message("# %zu hits stay visible, %zu are hidden, %zu of them by the copies\n", counts[1], counts[0], hidden);
    assert_true(counts[1] > 10 && hidden > 10);
}

/* ---- chunks that are copied ---- */

static uint8_t *load(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static void store(const char *path, const uint8_t *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static void a_copy_of_every_compression_has_the_same_pixels(UNUSED void **state) {
    static const enum glint_compression all[] = {GLINT_ZIP, GLINT_NONE, GLINT_ZIPS, GLINT_PIZ, GLINT_RLE};
    struct glint_error err = {0};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        const struct glint_writer_options options = {.compression = all[i]};
        assert_true(fixture_write(&fixture, other, FIXTURE_PARTS, &options, &err));
        make(other, copy, NULL, 0);
        assert_true(expect_same_pixels(other, copy) > 50);
        size_t sizes[2];
        uint8_t *a = load(whole, &sizes[0]), *b = load(copy, &sizes[1]);
        assert_int_equal(sizes[0], sizes[1]); /* whichever it was, the copy is as the writer's default */
        assert_memory_equal(a, b, sizes[0]);
        free(a);
        free(b);
    }
}

/* Damage makes attributes of unknown types, of which OpenEXRCore leaks some when they are written. */
static bool has_unknown_types(const struct glint_edit *edit) {
    const struct glint_exr_part_info *part;
    for (size_t p = 0; (part = glint_edit_part(edit, p)); p++)
        for (size_t a = 0; a < part->attribute_count; a++)
            if (part->attributes[a].type == GLINT_EXR_OPAQUE && strcmp(part->attributes[a].type_name, "m44f") != 0)
                return true;
    return false;
}

/* Copies of damaged files: nothing crashes, and what is written opens if the copy was made. */
static void damaged_files_are_refused_or_copied(UNUSED void **state) {
    size_t size, written = 0, refused = 0;
    uint8_t *bytes = load(whole, &size), *damaged = malloc(size);
    assert_non_null(damaged);
    for (uint32_t seed = 0; seed < 400; seed++) {
        memcpy(damaged, bytes, size);
        store(other, damaged, hostile_damage(damaged, size, seed));
        struct glint_error err = {0};
        struct glint_edit *edit = glint_edit_open(other, &hostile_limits, NULL, NULL, &err);
        const bool unknown = edit && has_unknown_types(edit);
        bool ok = edit && glint_edit_reduce(edit, 2 + seed % 3, &err);
        ok = ok && !unknown && glint_edit_write(edit, copy, &err);
        glint_edit_close(&edit);
        if (unknown) continue;
        if (!ok && (err.code == GLINT_OK || !err.message[0])) fail_msg("seed %u: failed without a reason", seed);
        written += ok;
        refused += !ok;
        if (!ok) continue;
        struct glint_capture *capture = glint_capture_open(copy, &hostile_limits, &err);
        if (!capture) fail_msg("seed %u: %s", seed, err.message);
        glint_capture_close(&capture);
    }
    print_message("# %zu copied, %zu refused\n", written, refused);
    assert_true(written > 20 && refused > 20);
    free(bytes);
    free(damaged);
}

static void impossible_factors_are_refused(UNUSED void **state) {
    static const uint32_t bad[] = {0, 25, 40, 1u << 31, UINT32_MAX};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct glint_error err = {0};
        struct glint_edit *edit = opened(whole);
        assert_false(glint_edit_reduce(edit, bad[i], &err));
        assert_int_equal(err.code, GLINT_ERROR_USAGE);
        assert_non_null(strstr(err.message, "n from 1 to 24"));
        glint_edit_close(&edit);
    }
    struct glint_error err = {0};
    struct glint_edit *edit = opened(whole);
    glint_edit_drop_part(edit, glint_edit_find(edit, "gbuffer"));
    assert_false(glint_edit_reduce(edit, 2, &err));
    assert_non_null(strstr(err.message, "gbuffer is left out"));
    glint_edit_close(&edit);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crop_and_reduce_is_one_after_the_other),
        cmocka_unit_test(a_factor_of_one_changes_nothing),
        cmocka_unit_test(parts_that_do_not_fit_are_left_out),
        cmocka_unit_test(a_checkerboard_is_left_out_by_even_factors),
        cmocka_unit_test(hits_stay_visible_if_they_are_on_the_new_screen),
        cmocka_unit_test(a_copy_of_every_compression_has_the_same_pixels),
        cmocka_unit_test(damaged_files_are_refused_or_copied),
        cmocka_unit_test(impossible_factors_are_refused),
    };
    return cmocka_run_group_tests_name("reduce", tests, make_whole, remove_files);
}
