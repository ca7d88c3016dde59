/* The writer: sibling files, background mode, compressions, and errors. */
#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fixture.h"
#include "glint/exr.h"
#include "unit.h"

static bool exists(const char *path) {
    return access(path, F_OK) == 0;
}

/* Whether the folder of `path` contains other files whose names begin with its own. */
static bool has_leftovers(const char *path) {
    char folder[512];
    snprintf(folder, sizeof folder, "%s", path);
    char *slash = strrchr(folder, '/');
    *slash = 0;
    bool found = false;
    DIR *dir = opendir(folder);
    for (struct dirent *e; dir && (e = readdir(dir));) found |= !strncmp(e->d_name, slash + 1, strlen(slash + 1));
    if (dir) closedir(dir);
    return found;
}

static struct glint_writer *begin(const char *path, bool background) {
    struct glint_error err = {0};
    const struct glint_writer_options options = {.background = background};
    const struct glint_frame frame = fixture_frame();
    struct glint_writer *writer = glint_writer_create(path, &options, &err);
    if (!writer || !glint_writer_set_frame(writer, &frame, &err)) fail_msg("%s", err.message);
    return writer;
}

static bool add_part(struct glint_writer *writer, enum fixture_part which, struct glint_error *err) {
    struct fixture_channels channels;
    const struct glint_part part = fixture_part(&fixture, which, &channels);
    return glint_writer_add_part(writer, &part, err);
}

/* ---- compressions ---- */

static void every_compression_reads_back(UNUSED void **state) {
    static float out[FIX_W * FIX_H * 3];
    static const char *const names[] = {"albedo.R", "motion.X", "vertexNormal.Y"};
    static const size_t at[] = {7, 10, 14};
    off_t sizes[GLINT_RLE + 1], plain = 0;
    /* Noise alone would be stored uncompressed. Half of the image is constant, so that every method compresses it. */
    for (size_t i = 0; i < FIX_W * FIX_H / 2; i++)
        for (size_t c = 4; c < 17; c++) fixture.gbuffer[17 * i + c] = 0.375f;
    for (int c = GLINT_ZIP; c <= GLINT_RLE; c++) {
        char path[512];
        struct glint_error err = {0};
        const struct glint_writer_options options = {.compression = (enum glint_compression)c};
        if (!fixture_write(&fixture, fixture_path(path, "compression.exr"), FIXTURE_PARTS, &options, &err))
            fail_msg("%s", err.message);
        struct glint_capture *capture = glint_capture_open(path, NULL, &err);
        if (!capture ||
            !glint_capture_read_raw(capture, glint_capture_find(capture, "gbuffer"), names, 3, GLINT_F32, out, 0, &err))
            fail_msg("%d: %s", c, err.message);
        for (size_t i = 0; i < FIX_W * FIX_H; i++)
            for (size_t n = 0; n < 3; n++) {
                const float in = fixture.gbuffer[17 * i + at[n]];
                /* PXR24 keeps 15 bits of a float's mantissa, rounded. */
                if (c == GLINT_PXR24) assert_true(fabsf(out[3 * i + n] - in) <= fabsf(in) * ldexpf(1, -16));
                else assert_true(out[3 * i + n] == in);
            }
        glint_capture_close(&capture);
        struct stat info;
        assert_int_equal(stat(path, &info), 0);
        if (c == GLINT_NONE) plain = info.st_size;
        sizes[c] = info.st_size;
        unlink(path);
    }
    for (int c = GLINT_ZIP; c <= GLINT_RLE; c++)
        if (c != GLINT_NONE && sizes[c] >= plain)
            fail_msg("compression %d: %ld of %ld bytes", c, (long)sizes[c], (long)plain);
    fixture_init(&fixture);
}

static void the_same_input_gives_the_same_bytes(UNUSED void **state) {
    char hashes[3][33];
    for (int i = 0; i < 3; i++) {
        char path[512];
        struct glint_error err = {0};
        const struct glint_writer_options options = {.threads = (uint32_t)i};
        assert_true(fixture_write(&fixture, fixture_path(path, "same.exr"), FIXTURE_PARTS, &options, &err));
        struct glint_capture *capture = glint_capture_open(path, NULL, &err);
        assert_non_null(capture);
        assert_true(glint_capture_hash(capture, hashes[i], &err));
        glint_capture_close(&capture);
        unlink(path);
    }
    assert_string_equal(hashes[0], hashes[1]);
    assert_string_equal(hashes[0], hashes[2]);
}

/* ---- background ---- */

/* A folder has the name meanwhile: the worker fails, which must be the result of wait and not of finish. */
static void a_failure_of_the_worker_is_told_by_wait(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    fixture_path(path, "background.exr");
    struct glint_writer *writer = begin(path, true);
    for (int p = 0; p <= FIXTURE_LIT; p++) assert_true(add_part(writer, (enum fixture_part)p, &err));
    assert_true(glint_make_folder(path, &err));
    assert_true(glint_writer_finish(writer, &err));
    assert_false(glint_writer_wait(writer, &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
    glint_writer_destroy(&writer);
    assert_int_equal(rmdir(path), 0);
    assert_false(has_leftovers(path));
}

static void memory_is_the_callers_again_after_add_part(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    static float color[FIX_W * FIX_H * 3], out[FIX_W * FIX_H * 3];
    struct glint_writer *writer = begin(fixture_path(path, "copied.exr"), true);
    assert_true(add_part(writer, FIXTURE_GBUFFER, &err));
    for (size_t i = 0; i < FIX_W * FIX_H * 3; i++) color[i] = (float)i;
    char names[3][2] = {"R", "G", "B"}, part_name[] = "lit";
    struct glint_channel channels[3];
    for (int i = 0; i < 3; i++)
        channels[i] =
            (struct glint_channel){.name = names[i], .type = GLINT_F32, .data = color + i, .x_stride_bytes = 12};
    const struct glint_part part = {
        .name = part_name, .width = FIX_W, .height = FIX_H, .channels = channels, .channel_count = 3};
    if (!glint_writer_add_part(writer, &part, &err)) fail_msg("%s", err.message);
    memset(color, 0xff, sizeof color);
    memset(names, 'x', sizeof names);
    memset(part_name, 'x', sizeof part_name - 1);
    memset(channels, 0xff, sizeof channels);
    if (!glint_writer_finish(writer, &err) || !glint_writer_wait(writer, &err)) fail_msg("%s", err.message);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_capture_read(capture, glint_capture_find(capture, "lit"), (const char *const[]){"R", "G", "B"}, 3,
                                   GLINT_F32, out, 0, &err));
    for (size_t i = 0; i < FIX_W * FIX_H * 3; i++) assert_true(out[i] == (float)i);
    glint_capture_close(&capture);
    unlink(path);
}

static void nothing_is_left_without_finish(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    for (int background = 0; background < 2; background++) {
        struct glint_writer *writer = begin(fixture_path(path, "dropped.exr"), background);
        for (int p = 0; p <= FIXTURE_LIT; p++) assert_true(add_part(writer, (enum fixture_part)p, &err));
        glint_writer_destroy(&writer);
        assert_null(writer);
        assert_false(has_leftovers(path));
    }
}

static void a_failed_write_leaves_what_was_there(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    fixture_path(path, "kept.exr");
    FILE *old = fopen(path, "w");
    fputs("old", old);
    fclose(old);
    struct glint_writer *writer = begin(path, false);
    assert_true(add_part(writer, FIXTURE_GBUFFER, &err)); /* lit is missing */
    assert_false(glint_writer_finish(writer, &err));
    assert_int_equal(err.code, GLINT_ERROR_FORMAT);
    assert_non_null(strstr(err.message, "lit"));
    glint_writer_destroy(&writer);
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_size, 3);
    unlink(path);
    assert_false(has_leftovers(path));
}

static void a_folder_that_is_not_there_is_an_io_error(UNUSED void **state) {
    struct glint_error err = {0};
    assert_false(fixture_write(&fixture, "/nowhere/at/all.exr", FIXTURE_LIT + 1, NULL, &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
    assert_non_null(strstr(err.message, "/nowhere/at/all.exr"));
}

/* ---- errors after which the writer stays usable ---- */

struct refusal {
    enum fixture_part base;
    void (*change)(struct glint_part *part, struct fixture_channels *channels);
    enum glint_code code;
    const char *words[2]; /* parts of the message */
};

static void unknown_role(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->name = "gbufer";
}
static void no_channel(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->channel_count = 9;
}
static void extra_channel(struct glint_part *p, struct fixture_channels *c) {
    (void)p, c->all[2].name = "Blue";
}
static void twice(struct glint_part *p, struct fixture_channels *c) {
    (void)p, c->all[2].name = "R";
}
static void float_stencil(struct glint_part *p, struct fixture_channels *c) {
    (void)p, c->all[16].type = GLINT_F32;
}
static void not_a_cube(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->height -= 6;
}
static void no_center(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->cubemap = NULL;
}
static void no_size(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->width = 0;
}
static void no_data(struct glint_part *p, struct fixture_channels *c) {
    (void)p, c->all[1].data = NULL;
}
static void reserved(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->name = "sss.profile";
}
static void bad_encoding(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->encodings.color = (enum glint_color_encoding)9;
}
static void path_in_sibling(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->channel_count = 0, p->sibling = "../probes.exr";
}
static void octahedral_with_z(struct glint_part *p, struct fixture_channels *c) {
    (void)c, p->encodings.normal = GLINT_NORMAL_OCTAHEDRAL;
}
static void half_motion(struct glint_part *p, struct fixture_channels *c) {
    (void)p, c->all[11].name = "stencil.id", p->channel_count = 16;
}
static void ours(struct glint_part *p, UNUSED struct fixture_channels *c) {
    static const struct glint_attribute a = {.name = "glint.up", .type = GLINT_ATTRIBUTE_STRING, .string = "+z"};
    p->attributes = &a;
    p->attribute_count = 1;
}
static void inside_out_box(struct glint_part *p, UNUSED struct fixture_channels *c) {
    static struct glint_cubemap cube = {.inner = GLINT_VOLUME_BOX, .box_min = {1, 1, 1}, .box_max = {2, 2, 0}};
    p->cubemap = &cube;
}
static void far_away(struct glint_part *p, UNUSED struct fixture_channels *c) {
    static struct glint_cubemap cube = {.center = {INFINITY, 0, 0}};
    p->cubemap = &cube;
}

static const struct refusal refusals[] = {
    {FIXTURE_LIT, unknown_role, GLINT_ERROR_USAGE, {"gbufer", "role"}},
    {FIXTURE_GBUFFER, no_channel, GLINT_ERROR_FORMAT, {"albedo.B", "missing"}},
    {FIXTURE_LIT, extra_channel, GLINT_ERROR_FORMAT, {"part lit", "Blue"}},
    {FIXTURE_LIT, twice, GLINT_ERROR_USAGE, {"part lit", "R"}},
    {FIXTURE_GBUFFER, float_stencil, GLINT_ERROR_FORMAT, {"stencil.id", "uint"}},
    {FIXTURE_CUBEMAP_1, not_a_cube, GLINT_ERROR_FORMAT, {"part cubemap.017", "N x 6N"}},
    {FIXTURE_CUBEMAP_1, no_center, GLINT_ERROR_FORMAT, {"glint.center", "missing"}},
    {FIXTURE_SKY, not_a_cube, GLINT_ERROR_FORMAT, {"part sky", "8 x 42"}},
    {FIXTURE_LIT, no_size, GLINT_ERROR_USAGE, {"part lit", "0 x"}},
    {FIXTURE_LIT, no_data, GLINT_ERROR_USAGE, {"part lit", "data"}},
    {FIXTURE_LIT, reserved, GLINT_ERROR_FORMAT, {"part sss.profile", "reserved"}},
    {FIXTURE_LIT, bad_encoding, GLINT_ERROR_USAGE, {"glint.color", "found 9"}},
    {FIXTURE_CUBEMAP_0, path_in_sibling, GLINT_ERROR_FORMAT, {"plain file name", "../probes.exr"}},
    {FIXTURE_GBUFFER, octahedral_with_z, GLINT_ERROR_FORMAT, {"normal.Z", "octahedral"}},
    {FIXTURE_GBUFFER, half_motion, GLINT_ERROR_FORMAT, {"stencil.id", "uint"}},
    {FIXTURE_LIT, ours, GLINT_ERROR_USAGE, {"glint.up", "part lit"}},
    {FIXTURE_CUBEMAP_0, inside_out_box, GLINT_ERROR_FORMAT, {"boxMin", "cubemap.000"}},
    {FIXTURE_CUBEMAP_0, far_away, GLINT_ERROR_FORMAT, {"glint.center", "finite"}},
};

static void what_breaks_a_rule_is_refused_and_the_writer_stays_usable(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    struct glint_writer *writer = begin(fixture_path(path, "refused.exr"), false);
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, refusals[i].base, &channels);
        refusals[i].change(&part, &channels);
        err = (struct glint_error){0};
        if (glint_writer_add_part(writer, &part, &err)) fail_msg("refusal %zu was accepted", i);
        for (int w = 0; w < 2; w++)
            if (err.code != refusals[i].code || !strstr(err.message, refusals[i].words[w]))
                fail_msg("refusal %zu: code %d, \"%s\"", i, (int)err.code, err.message);
    }
    for (int p = 0; p < FIXTURE_PARTS; p++)
        if (!add_part(writer, (enum fixture_part)p, &err)) fail_msg("%s", err.message);
    assert_false(add_part(writer, FIXTURE_LIT, &err)); /* a duplicate name */
    assert_int_equal(err.code, GLINT_ERROR_USAGE);
    if (!glint_writer_finish(writer, &err)) fail_msg("%s", err.message);
    assert_false(add_part(writer, FIXTURE_LIT, &err)); /* after finish */
    glint_writer_destroy(&writer);
    assert_true(exists(path));
    unlink(path);
}

static void a_frame_that_breaks_a_rule_is_refused(UNUSED void **state) {
    struct glint_error err = {0};
    char path[512];
    for (int i = 0; i < 9; i++) {
        struct glint_frame frame = fixture_frame();
        if (i == 0) frame.camera.world_to_view[3] = NAN;
        if (i == 1) frame.camera.world_to_view[0] *= 2; /* scale */
        if (i == 2) frame.camera.view_to_clip[11] = 0;  /* not invertible */
        if (i == 3) frame.camera.view_to_clip[1] = 0.5; /* not of the form */
        if (i == 4) frame.previous.view_to_clip[0] = INFINITY;
        if (i == 5) frame.metres_per_unit = -1;
        if (i == 6) frame.up = (enum glint_axis)17;
        if (i == 7) frame.class_count = 1000;
        if (i == 8) frame.fog.density = NAN;
        struct glint_writer *writer = glint_writer_create(fixture_path(path, "frame.exr"), NULL, &err);
        err = (struct glint_error){0};
        if (glint_writer_set_frame(writer, &frame, &err) || err.code == GLINT_OK) fail_msg("frame %d was accepted", i);
        glint_writer_destroy(&writer);
    }
}

static void zero_is_the_default(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    struct glint_frame frame = {0};
    frame.camera = fixture_frame().camera;
    struct glint_writer *writer = glint_writer_create(fixture_path(path, "zero.exr"), NULL, &err);
    assert_true(glint_writer_set_frame(writer, &frame, &err));
    for (int p = 0; p <= FIXTURE_LIT; p++) assert_true(add_part(writer, (enum fixture_part)p, &err));
    if (!glint_writer_finish(writer, &err)) fail_msg("%s", err.message);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    const struct glint_frame *found = glint_capture_frame(capture);
    assert_true(found->exposure == 1 && found->pre_exposure == 1 && found->metres_per_unit == 1);
    assert_true(found->motion_range == 1 && !found->has_previous && !found->has_fog && !found->has_player);
    glint_capture_close(&capture);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_compression_reads_back),
        cmocka_unit_test(the_same_input_gives_the_same_bytes),
        cmocka_unit_test(a_failure_of_the_worker_is_told_by_wait),
        cmocka_unit_test(memory_is_the_callers_again_after_add_part),
        cmocka_unit_test(nothing_is_left_without_finish),
        cmocka_unit_test(a_failed_write_leaves_what_was_there),
        cmocka_unit_test(a_folder_that_is_not_there_is_an_io_error),
        cmocka_unit_test(what_breaks_a_rule_is_refused_and_the_writer_stays_usable),
        cmocka_unit_test(a_frame_that_breaks_a_rule_is_refused),
        cmocka_unit_test(zero_is_the_default),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
