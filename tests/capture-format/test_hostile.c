/* Untrusted files are read or refused with a reason, within the documented limits of memory. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "glint/exr.h"
#include "heap.h"
#include "hostile.h"
#include "unit.h"

static uint8_t *whole;
static size_t size;

static void load_file(int parts) {
    char path[512];
    struct glint_error err = {0};
    free(whole);
    if (!fixture_write(&fixture, fixture_path(path, "hostile.exr"), parts, NULL, &err)) fail_msg("%s", err.message);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    size = (size_t)ftell(file);
    rewind(file);
    whole = malloc(size);
    assert_non_null(whole);
    assert_int_equal(fread(whole, 1, size, file), size);
    fclose(file);
    unlink(path);
}

/* The position of `text` in the file after `from`. */
static size_t find_bytes(const char *text, size_t length, size_t from) {
    for (size_t i = from; i + length <= size; i++)
        if (!memcmp(whole + i, text, length)) return i;
    fail_msg("not found");
    return 0;
}

/* Wine takes a while for each file and thread; what is done with the bytes is the same on every system. */
#ifdef _WIN32
enum { EACH_HEADER_BYTE = 11 };
static uint32_t damaged_files = 200;
#else
enum { EACH_HEADER_BYTE = 1 };
static uint32_t damaged_files = 500; /* or as many as the argument says */
#endif

/* ---- truncated ---- */

static void cut_off_anywhere_is_refused(UNUSED void **state) {
    load_file(FIXTURE_LIT + 1);
    struct glint_error err = {0};
    assert_true(hostile_use_bytes(whole, size, &err));
    /* Every byte of the headers and of the last chunk, and every 97th in between. */
    const size_t headers = find_bytes("lineOrder", 9, find_bytes("lineOrder", 9, 0) + 1) + 512;
    for (size_t cut = 0; cut < size; cut += cut < headers || cut + 512 > size ? EACH_HEADER_BYTE : 97) {
        err = (struct glint_error){0};
        if (hostile_use_bytes(whole, cut, &err)) fail_msg("%zu of %zu bytes were taken", cut, size);
        if (!strstr(err.message, hostile_name)) fail_msg("%zu bytes: no file named: %s", cut, err.message);
    }
}

/* ---- damaged ---- */

static void damage_is_read_or_refused(UNUSED void **state) {
    load_file(FIXTURE_CUBEMAP_1 + 1);
    uint8_t *copy = malloc(size);
    assert_non_null(copy);
    size_t refused = 0;
    for (uint32_t seed = 0; seed < damaged_files; seed++) {
        struct glint_error err = {0};
        memcpy(copy, whole, size);
        refused += !hostile_use_bytes(copy, hostile_damage(copy, size, seed), &err);
    }
    free(copy);
    /* Most of the damage must hit something relevant. */
    assert_true(refused > damaged_files / 3);
}

/* ---- a single wrong value ---- */

/* Overwrites `count` bytes of a copy at `at`, and expects an error that contains `words`. */
static void assert_lie_refused(size_t at, const void *bytes, size_t count, const char *words) {
    struct glint_error err = {0};
    uint8_t *copy = malloc(size);
    assert_non_null(copy);
    memcpy(copy, whole, size);
    memcpy(copy + at, bytes, count);
    const size_t before = heap_peak_reset();
    const bool taken = hostile_use_bytes(copy, size, &err);
    const size_t used = heap_peak() - before;
    free(copy);
    if (taken) fail_msg("a lie at byte %zu, beginning with %d, was taken", at, ((const uint8_t *)bytes)[0]);
    if (!strstr(err.message, words)) fail_msg("expected \"%s\" in \"%s\"", words, err.message);
    if (used > hostile_limits.memory_bytes)
        fail_msg("%zu bytes taken, the limit is %llu", used, (unsigned long long)hostile_limits.memory_bytes);
}

static void absurd_headers_take_no_memory(UNUSED void **state) {
    load_file(FIXTURE_LIT + 1);
    const size_t window = find_bytes("dataWindow\0box2i\0", 17, 0) + 17 + 4;
    const int32_t huge[4] = {0, 0, 0x7ffffff0, 0x7ffffff0}, wide[4] = {0, 0, 2000, 23}, tall[4] = {0, 0, 39, 7000};
    const int32_t turned[4] = {39, 23, 0, 0}, extreme[4] = {INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX};
    assert_lie_refused(window, huge, 16, "Invalid data window");
    assert_lie_refused(window, wide, 16, "2001 x 24 pixels, the limit is 1024 x 6144");
    assert_lie_refused(window, tall, 16, "40 x 7001 pixels, the limit is 1024 x 6144");
    assert_lie_refused(window, turned, 16, "Invalid data window");
    assert_lie_refused(window, extreme, 16, "Invalid data window");
    const size_t channels = find_bytes("channels\0chlist\0", 16, 0) + 16;
    assert_lie_refused(channels, &(int32_t){0x7fffffff}, 4, hostile_name);
    assert_lie_refused(channels, &(int32_t){-1}, 4, hostile_name);
    const size_t storage = find_bytes("glint.storage\0stringvector\0", 27, 0) + 27;
    assert_lie_refused(storage, &(int32_t){0x7fffffff}, 4, hostile_name);
    assert_lie_refused(storage + 4, &(int32_t){0x7fffffff}, 4, hostile_name);
    const size_t chunks = find_bytes("chunkCount\0int\0", 15, 0) + 15 + 4;
    assert_lie_refused(chunks, &(int32_t){0x7fffffff}, 4, "expected 2 chunks");
    assert_lie_refused(chunks, &(int32_t){0}, 4, hostile_name);
    assert_lie_refused(0, &(uint32_t){0}, 4, hostile_name); /* not an EXR file */
}

static void two_parts_of_one_name_are_refused(UNUSED void **state) {
    load_file(FIXTURE_CUBEMAP_1 + 1);
    assert_lie_refused(find_bytes("cubemap.017", 11, 0), "cubemap.000", 11, "cubemap.000");
}

static void subsampled_parts_are_refused(UNUSED void **state) {
    load_file(FIXTURE_LIT + 1);
    /* The first channel of lit: name, type, flags, then the sampling in x. */
    const size_t list = find_bytes("channels\0chlist\0", 16, find_bytes("channels\0chlist\0", 16, 0) + 1) + 16 + 4;
    assert_memory_equal(whole + list, "B", 2);
    assert_lie_refused(list + 2 + 4 + 4, &(int32_t){2}, 4, "part lit: expected flat scanlines");
}

static void limits_hold(UNUSED void **state) {
    load_file(FIXTURE_PARTS);
    char path[512];
    struct glint_error err = {0};
    assert_true(fixture_write(&fixture, fixture_path(path, "limits.exr"), FIXTURE_PARTS, NULL, &err));
    const struct glint_limits all[] = {{.file_bytes = 1000}, {.width = 30}, {.parts = 3}, {.memory_bytes = 400000}};
    static const char *const words[] = {"the limit is 1000", "the limit is 30 x 180", "the limit is 3", "3125 bytes"};
    for (int i = 0; i < 4; i++) {
        err = (struct glint_error){0};
        assert_null(glint_capture_open(path, &all[i], &err));
        assert_int_equal(err.code, GLINT_ERROR_LIMIT);
        if (!strstr(err.message, words[i])) fail_msg("%s", err.message);
    }
    /* Chunks that do not fit are refused before memory is allocated for them. */
    const struct glint_writer_options piz = {.compression = GLINT_PIZ}; /* chunks of 32 lines */
    assert_true(fixture_write(&fixture, path, FIXTURE_LIT + 1, &piz, &err));
    const struct glint_limits tight = {.memory_bytes = 1300000};
    struct glint_capture *capture = glint_capture_open(path, &tight, &err);
    static float out[FIX_W * FIX_H];
    assert_non_null(capture);
    assert_false(glint_capture_read(capture, glint_capture_find(capture, "gbuffer"), (const char *const[]){"depth.Z"},
                                    1, GLINT_F32, out, 0, &err));
    assert_int_equal(err.code, GLINT_ERROR_LIMIT);
    glint_capture_close(&capture);
    unlink(path);
}

/* The headers that need the most memory per byte: many channels, many small attributes, many strings. */
static void crowded_headers_stay_within_memory(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    static char names[1000][8];
    static struct glint_exr_channel channels[1000];
    static struct glint_exr_attribute attributes[1000];
    static const char *empty[1000];
    static const double one = 1;
    for (int i = 0; i < 1000; i++) {
        snprintf(names[i], sizeof names[i], "c%03d", i);
        channels[i] = (struct glint_exr_channel){.name = names[i], .stored = GLINT_STORED_HALF, .data = names};
        attributes[i] =
            (struct glint_exr_attribute){.name = names[i], .type = GLINT_EXR_INT, .numbers = &one, .count = 1};
        empty[i] = "";
    }
    attributes[0] =
        (struct glint_exr_attribute){.name = "e", .type = GLINT_EXR_STRINGS, .strings = empty, .count = 1000};
    struct glint_exr_part parts[8];
    for (int i = 0; i < 8; i++)
        parts[i] = (struct glint_exr_part){.name = names[i],
                                           .width = 1,
                                           .height = 1,
                                           .channels = channels,
                                           .channel_count = 1000,
                                           .attributes = attributes,
                                           .attribute_count = 1000};
    for (size_t count = 1; count <= 8; count++) {
        if (!glint_exr_write(fixture_path(path, "crowded.exr"), parts, count, 1, &err)) fail_msg("%s", err.message);
        /* From limits that just suffice for the headers to limits that do not. */
        for (uint64_t memory = 4 << 20; memory <= 64 << 20; memory *= 2) {
            const struct glint_limits limits = {.memory_bytes = memory};
            const size_t before = heap_peak_reset();
            struct glint_capture *capture = glint_capture_open(path, &limits, &err);
            assert_null(capture); /* gbuffer is missing, or a limit is exceeded */
            struct glint_exr *exr = glint_exr_open(path, &limits, &err);
            const size_t used = heap_peak() - before;
            if (used > memory)
                fail_msg("%zu parts: %zu bytes taken, the limit is %llu", count, used, (unsigned long long)memory);
            glint_exr_close(&exr);
        }
    }
    unlink(path);
}

static void what_is_no_file_is_refused(UNUSED void **state) {
#ifdef _WIN32
    static const char *const paths[] = {"/", "C:\\", "NUL", "nul", "\\\\.\\NUL", "/nowhere.exr", ""};
#else
    static const char *const paths[] = {"/", "/dev/null", "/dev/zero", "/nowhere.exr", ""};
#endif
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        struct glint_error err = {0};
        assert_null(glint_capture_open(paths[i], NULL, &err));
        assert_int_equal(err.code, GLINT_ERROR_IO);
    }
}

static int teardown(UNUSED void **state) {
    free(whole);
    return 0;
}

int main(int argc, char **argv) {
    if (argc > 1) damaged_files = (uint32_t)atoi(argv[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_off_anywhere_is_refused),       cmocka_unit_test(absurd_headers_take_no_memory),
        cmocka_unit_test(two_parts_of_one_name_are_refused), cmocka_unit_test(limits_hold),
        cmocka_unit_test(subsampled_parts_are_refused),      cmocka_unit_test(crowded_headers_stay_within_memory),
        cmocka_unit_test(what_is_no_file_is_refused),        cmocka_unit_test(damage_is_read_or_refused),
    };
    return cmocka_run_group_tests(tests, fixture_setup, teardown);
}
