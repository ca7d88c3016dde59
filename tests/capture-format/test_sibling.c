/* Cube maps in a sibling file: found by name in the same folder, and only used if their content hash matches. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "glint/edit.h"
#include "rewrite.h"
#include "unit.h"

static char probes[512], capture_path[512];

/* A file with the cube maps alone. A missing channel only shifts bytes. */
static void write_probes(size_t drop) {
    struct glint_error err = {0};
    struct glint_writer *writer = glint_writer_create(probes, NULL, &err);
    bool ok = writer != NULL;
    for (int p = FIXTURE_CUBEMAP_0; ok && p <= FIXTURE_CUBEMAP_1; p++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        part.channel_count -= drop;
        ok = glint_writer_add_part(writer, &part, &err);
    }
    ok = ok && glint_writer_finish(writer, &err);
    glint_writer_destroy(&writer);
    if (!ok) fail_msg("%s", err.message);
}

static bool write_capture(const char *sibling, bool background, struct glint_error *err) {
    const struct glint_writer_options options = {.background = background};
    struct glint_writer *writer = glint_writer_create(capture_path, &options, err);
    const struct glint_frame frame = fixture_frame();
    bool ok = writer && glint_writer_set_frame(writer, &frame, err);
    for (int p = 0; ok && p <= FIXTURE_CUBEMAP_1; p++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        struct glint_cubemap moved = fixture.cubemap;
        if (part.cubemap) {
            /* The attributes in the capture apply to its frame: fade and age change from frame to frame. */
            moved.fade = 0.75;
            part.cubemap = &moved;
            part.channel_count = 0;
            part.sibling = sibling;
        }
        ok = glint_writer_add_part(writer, &part, err);
    }
    ok = ok && glint_writer_finish(writer, err) && glint_writer_wait(writer, err);
    glint_writer_destroy(&writer);
    return ok;
}

static void pixels_come_from_the_sibling(UNUSED void **state) {
    static float out[6 * FIX_CUBE * FIX_CUBE * 5];
    static const char *const names[] = {"R", "G", "B", "A", "distance.Z"};
    write_probes(0);
    for (int background = 0; background < 2; background++) {
        struct glint_error err = {0};
        if (!write_capture("probes.exr", background, &err)) fail_msg("%s", err.message);
        struct glint_capture *capture = glint_capture_open(capture_path, NULL, &err);
        if (!capture) fail_msg("%s", err.message);
        const struct glint_part_info *part = glint_capture_find(capture, "cubemap.017");
        assert_string_equal(part->sibling, "probes.exr");
        assert_int_equal(part->width, FIX_CUBE);
        assert_int_equal(part->height, 6 * FIX_CUBE);
        assert_int_equal(part->channel_count, 5);
        assert_true(part->cubemap.fade == 0.75);
        if (!glint_capture_read_raw(capture, part, names, 5, GLINT_F32, out, 0, &err)) fail_msg("%s", err.message);
        assert_memory_equal(out, fixture.cube, sizeof fixture.cube);
        glint_capture_close(&capture);
    }
}

static void assert_refused(const char *words) {
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(capture_path, NULL, &err);
    if (capture) fail_msg("taken, expected \"%s\"", words);
    if (!strstr(err.message, words) || !strstr(err.message, "cubemap.000"))
        fail_msg("expected \"%s\", found \"%s\"", words, err.message);
}

static void one_changed_byte_is_refused(UNUSED void **state) {
    struct glint_error err = {0};
    write_probes(0);
    assert_true(write_capture("probes.exr", false, &err));
    /* the last byte, which belongs to the pixels of the last chunk */
    FILE *file = fopen(probes, "r+b");
    fseek(file, -1, SEEK_END);
    const int last = fgetc(file);
    fseek(file, -1, SEEK_END);
    fputc(last ^ 1, file);
    fclose(file);
    assert_refused("expected the hash");
}

static const char *said;
static void note_rule(void *user, const char *rule, const char *message) {
    static char text[1024];
    (void)user;
    snprintf(text, sizeof text, "%s: %s", rule, message);
    said = text;
}

/* The placeholder is 1 x 6 black pixels, so that no tool shows something else than glint. */
static void a_placeholder_with_colours_is_a_violation(UNUSED void **state) {
    struct glint_error err = {0};
    static struct rewrite r;
    size_t violations = 0;
    write_probes(0);
    assert_true(write_capture("probes.exr", false, &err));
    assert_true(glint_capture_validate(capture_path, NULL, note_rule, NULL, &violations, &err));
    assert_int_equal(violations, 0);
    rewrite_load(&r, capture_path);
    const struct rewrite_part *part = rewrite_find(&r, "cubemap.017");
    assert_int_equal(part->channels[1].stored, GLINT_STORED_HALF);
    ((uint16_t *)part->data[1])[5] = 0x3c00;
    rewrite_save(&r, capture_path);
    rewrite_finish(&r);
    assert_true(glint_capture_validate(capture_path, NULL, note_rule, NULL, &violations, &err));
    assert_int_equal(violations, 1);
    if (!strstr(said, "sibling: ") || !strstr(said, "cubemap.017: B: expected a placeholder of black pixels"))
        fail_msg("%s", said);
}

static void another_file_of_that_name_is_refused(UNUSED void **state) {
    struct glint_error err = {0};
    write_probes(0);
    assert_true(write_capture("probes.exr", false, &err));
    write_probes(1);
    assert_refused("expected the hash");
    unlink(probes);
    assert_refused("No such file");
}

/* Names that lead out of the folder, or to no file at all, on some system, are refused on all. */
static void a_name_is_a_file_of_the_folder_on_every_system(UNUSED void **state) {
    static const char *const hostile[] = {
        ".",       "..",        "../x.exr", "..\\x.exr", "a/b.exr",    "a\\b.exr",        "/x.exr",   "\\x.exr",
        "C:x.exr", "C:\\x.exr", "x.exr:y",  "\\\\s\\x",  "\\\\.\\NUL", "\\\\?\\C:\\x",    "NUL",      "nul.exr",
        "Con",     "aux.a.b",   "PRN .exr", "com1",      "LPT9.exr",   "COM\xC2\xB2.exr", "CONOUT$",  "x.exr.",
        "x.exr ",  "x?.exr",    "*.exr",    "<x>.exr",   "a|b",        "\"x\"",           "a\nb.exr", "x\x7f"};
    static const char *const fine[] = {"nulls.exr",
                                       "com.exr",
                                       "COM10.exr",
                                       "console.exr",
                                       "x .exr",
                                       "...x",
                                       ".exr",
                                       "gr\u00F6\u00DFer \u5F71.exr",
                                       "a'b;c$d~1,=+[x]{y}.exr"};
    write_probes(0);
    for (size_t i = 0; i < sizeof hostile / sizeof *hostile; i++) {
        struct glint_error err = {0};
        if (write_capture(hostile[i], false, &err)) fail_msg("\"%s\" was written", hostile[i]);
        if (!strstr(err.message, "plain file name")) fail_msg("\"%s\": %s", hostile[i], err.message);
    }
    for (size_t i = 0; i < sizeof fine / sizeof *fine; i++) {
        struct glint_error err = {0};
        /* It is not there, which is the only thing wrong with it. */
        if (write_capture(fine[i], false, &err)) fail_msg("\"%s\" was written", fine[i]);
        if (!strstr(err.message, "No such file")) fail_msg("\"%s\": %s", fine[i], err.message);
    }
}

/* The same names in a file that another program wrote. */
static void a_reader_refuses_such_names(UNUSED void **state) {
    static const char *const hostile[] = {"..\\probes.exr", "C:probes.exr", "NUL", "./probes.exr", "probes.exr."};
    for (size_t i = 0; i < sizeof hostile / sizeof *hostile; i++) {
        static struct rewrite r;
        struct glint_error err = {0};
        write_probes(0);
        assert_true(write_capture("probes.exr", false, &err));
        rewrite_load(&r, capture_path);
        rewrite_attribute(&r, "cubemap.000", "glint.sibling")->string = hostile[i];
        rewrite_save(&r, capture_path);
        rewrite_finish(&r);
        assert_refused("plain file name");
        /* A copy elsewhere would take the sibling's pixels along; "./probes.exr" even has the right hash. */
        struct glint_edit *edit = glint_edit_open(capture_path, NULL, NULL, NULL, &err);
        if (!edit) fail_msg("%s", err.message);
        assert_false(glint_edit_write(edit, "/nowhere/copy.exr", &err));
        if (!strstr(err.message, "plain file name")) fail_msg("\"%s\": %s", hostile[i], err.message);
        glint_edit_close(&edit);
    }
}

/* The hash is right, but the file has no such part, which only a faulty writer can produce. */
static void a_sibling_without_the_part_is_refused(UNUSED void **state) {
    struct glint_error err = {0};
    assert_true(fixture_write(&fixture, probes, FIXTURE_LIT + 1, NULL, &err));
    assert_true(write_capture("probes.exr", false, &err));
    assert_refused("expected a part of this name");
}

static void a_sibling_that_is_not_there_is_an_error_of_the_writer(UNUSED void **state) {
    for (int background = 0; background < 2; background++) {
        struct glint_error err = {0};
        unlink(probes);
        unlink(capture_path);
        assert_false(write_capture("probes.exr", background, &err));
        assert_int_equal(err.code, GLINT_ERROR_IO);
        assert_non_null(strstr(err.message, "probes.exr"));
        assert_true(access(capture_path, F_OK) != 0);
    }
}

static void cube_maps_alone_are_no_capture(UNUSED void **state) {
    struct glint_error err = {0};
    write_probes(0);
    assert_null(glint_capture_open(probes, NULL, &err));
    assert_non_null(strstr(err.message, "gbuffer"));
}

static void count_violation(void *user, const char *rule, const char *message) {
    (void)rule, (void)message;
    ++*(size_t *)user;
}

/* A file with cube maps alone is valid. */
static void cube_maps_alone_validate(UNUSED void **state) {
    struct glint_error err = {0};
    size_t reported = 0, count = 0;
    write_probes(0);
    assert_true(glint_capture_validate(probes, NULL, count_violation, &reported, &count, &err));
    assert_int_equal(count, 0);
    assert_int_equal(reported, 0);
}

static int setup(UNUSED void **state) {
    fixture_init(&fixture);
    fixture_path(probes, "probes.exr");
    fixture_path(capture_path, "shot.0001.exr");
    return 0;
}

static int teardown(UNUSED void **state) {
    unlink(probes);
    unlink(capture_path);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_come_from_the_sibling),
        cmocka_unit_test(one_changed_byte_is_refused),
        cmocka_unit_test(a_placeholder_with_colours_is_a_violation),
        cmocka_unit_test(another_file_of_that_name_is_refused),
        cmocka_unit_test(a_name_is_a_file_of_the_folder_on_every_system),
        cmocka_unit_test(a_reader_refuses_such_names),
        cmocka_unit_test(a_sibling_without_the_part_is_refused),
        cmocka_unit_test(a_sibling_that_is_not_there_is_an_error_of_the_writer),
        cmocka_unit_test(cube_maps_alone_are_no_capture),
        cmocka_unit_test(cube_maps_alone_validate),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
