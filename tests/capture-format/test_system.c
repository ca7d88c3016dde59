/* What the operating system does for the library: paths, files that others have open, large offsets, threads. */
#define _GNU_SOURCE /* sched_setaffinity */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "system.h"
#include "threads.h"
#include "unit.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <sched.h>
#endif

static void write_text(const char *path, const char *text, size_t size) {
    const glint_file file = glint_file_create(path);
    if (file == GLINT_NO_FILE) fail_msg("%s: %s", path, strerror(errno));
    assert_true(glint_file_write(file, text, size, 0));
    assert_true(glint_file_sync(file));
    assert_true(glint_file_close(file));
}

static void assert_contents(glint_file file, const char *text, size_t size) {
    char found[256] = "";
    size_t got = 0;
    assert_true(glint_file_read(file, found, sizeof found, 0, &got));
    assert_int_equal(got, size);
    assert_memory_equal(found, text, size);
}

static void assert_file(const char *path, const char *text, size_t size) {
    const glint_file file = glint_file_open(path);
    if (file == GLINT_NO_FILE) fail_msg("%s: %s", path, strerror(errno));
    assert_contents(file, text, size);
    assert_true(glint_file_close(file));
}

/* Text modes would change line ends, and end at a Ctrl-Z. */
static void every_byte_is_kept(UNUSED void **state) {
    char path[512], bytes[256];
    for (int i = 0; i < 256; i++) bytes[i] = (char)i;
    memcpy(bytes + 100, "\r\n\n\r\x1a", 5);
    write_text(fixture_path(path, "bytes"), bytes, sizeof bytes);
    assert_file(path, bytes, sizeof bytes);
    struct glint_file_info info;
    assert_true(glint_path_describe(path, &info));
    assert_int_equal(info.bytes, 256);
    assert_int_equal(info.kind, GLINT_FILE_REGULAR);
    assert_true(glint_path_remove(path));
}

static void offsets_have_64_bits(UNUSED void **state) {
    char path[512], byte = 0;
    size_t got = 0;
    const uint64_t beyond = ((uint64_t)5 << 30) + 3;
    glint_file file = glint_file_create(fixture_path(path, "sparse"));
    assert_true(glint_file_write(file, "x", 1, beyond));
    assert_true(glint_file_close(file));
    file = glint_file_open(path);
    struct glint_file_info info;
    assert_true(glint_file_describe(file, &info));
    assert_true(info.bytes == beyond + 1);
    assert_true(glint_file_read(file, &byte, 1, beyond, &got) && got == 1 && byte == 'x');
    assert_true(glint_file_read(file, &byte, 1, beyond - ((uint64_t)1 << 32), &got) && got == 1 && byte == 0);
    assert_true(glint_file_read(file, &byte, 1, beyond + 1, &got) && got == 0);
    assert_true(glint_file_close(file));
    assert_true(glint_path_remove(path));
}

/* Names with spaces and letters of other scripts are those that other programs see. */
static void paths_are_utf8(UNUSED void **state) {
    static const char *const names[] = {"two words", "gr\u00F6\u00DFer", "\u5F71 \u0442\u0435\u043D\u044C",
                                        "\U0001F30A wave"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[512], within[600];
        struct glint_error err = {0};
        fixture_path(path, names[i]);
        snprintf(within, sizeof within, "%s/a capture of %s.exr", path, names[i]);
        assert_true(glint_make_folder(path, &err));
        if (!fixture_write(&fixture, within, FIXTURE_LIT + 1, NULL, &err)) fail_msg("%s", err.message);
        struct glint_capture *capture = glint_capture_open(within, NULL, &err);
        if (!capture) fail_msg("%s", err.message);
        glint_capture_close(&capture);
#ifdef _WIN32
        wchar_t wide[600];
        assert_true(MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, within, -1, wide, 600) > 0);
        assert_true(GetFileAttributesW(wide) != INVALID_FILE_ATTRIBUTES);
        assert_true(MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, 600) > 0);
        assert_true(glint_path_remove(within));
        assert_true(RemoveDirectoryW(wide));
#else
        assert_int_equal(access(within, F_OK), 0);
        assert_true(glint_path_remove(within));
        assert_int_equal(rmdir(path), 0);
#endif
    }
}

/* Longer than the 260 characters of Windows' older functions. */
static void long_paths_work(UNUSED void **state) {
    char path[512], base[512];
    struct glint_error err = {0};
    fixture_path(base, "");
    size_t lengths[4], count = 0, length = strlen(base);
    memcpy(path, base, length + 1);
    for (; count < 4; count++) {
        length += (size_t)snprintf(path + length, sizeof path - length, "%s%070d", count ? "/" : "", (int)count);
        lengths[count] = length;
    }
    assert_true(length > 260);
    if (!glint_make_folder(path, &err)) fail_msg("%s", err.message);
    strcat(path, "/x");
    write_text(path, "long", 4);
    assert_file(path, "long", 4);
    assert_true(glint_path_remove(path));
    while (count--) {
        path[lengths[count]] = 0;
#ifdef _WIN32
        char prefixed[600];
        wchar_t wide[600];
        snprintf(prefixed, sizeof prefixed, "\\\\?\\%s", path);
        for (char *c = prefixed; *c; c++)
            if (*c == '/') *c = '\\';
        assert_true(MultiByteToWideChar(CP_UTF8, 0, prefixed, -1, wide, 600) > 0);
        assert_true(RemoveDirectoryW(wide));
#else
        assert_int_equal(rmdir(path), 0);
#endif
    }
}

static void a_file_that_is_read_can_be_replaced(UNUSED void **state) {
    char from[512], to[512];
    fixture_path(from, "new");
    fixture_path(to, "place");
    write_text(to, "old", 3);
    const glint_file reader = glint_file_open(to), second = glint_file_open(to);
    for (int i = 0; i < 2; i++) { /* the second time, the replaced one is open, too */
        write_text(from, "newer", 5);
        if (!glint_path_replace(from, to)) fail_msg("%s", strerror(errno));
        assert_file(to, "newer", 5);
        assert_contents(reader, "old", 3);
    }
    assert_true(glint_file_close(reader));
    assert_contents(second, "old", 3);
    assert_true(glint_file_close(second));
    struct glint_file_info info;
    assert_false(glint_path_describe(from, &info));
    assert_true(glint_path_remove(to));
}

/* An open capture keeps its pixels while the next frame takes its place: how a viewer and an engine work beside each other. */
static void an_open_capture_keeps_its_pixels(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    static float out[FIX_W * FIX_H], first[FIX_W * FIX_H];
    fixture_path(path, "live.exr");
    for (size_t i = 0; i < FIX_W * FIX_H; i++) first[i] = fixture.color[4 * i];
    assert_true(fixture_write(&fixture, path, FIXTURE_LIT + 1, NULL, &err));
    struct glint_capture *old = glint_capture_open(path, NULL, &err);
    assert_non_null(old);
    for (size_t i = 0; i < FIX_W * FIX_H; i++) fixture.color[4 * i] = 0.25f;
    if (!fixture_write(&fixture, path, FIXTURE_LIT + 1, NULL, &err)) fail_msg("%s", err.message);
    fixture_init(&fixture);
    struct glint_capture *new = glint_capture_open(path, NULL, &err);
    if (!new) fail_msg("%s", err.message);
    const char *const names[] = {"R"};
    assert_true(glint_capture_read(old, glint_capture_find(old, "lit"), names, 1, GLINT_F32, out, 0, &err));
    assert_memory_equal(out, first, sizeof out);
    assert_true(glint_capture_read(new, glint_capture_find(new, "lit"), names, 1, GLINT_F32, out, 0, &err));
    assert_true(out[0] == 0.25f && out[FIX_W * FIX_H - 1] == 0.25f);
    glint_capture_close(&old);
    glint_capture_close(&new);
    assert_true(glint_path_remove(path));
}

#ifdef _WIN32
/* A program that opened the file without letting others remove it: an error, and the old file stays. */
static void a_locked_file_is_left_alone(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    write_text(fixture_path(path, "locked.exr"), "old", 3);
    FILE *lock = fopen(path, "rb");
    assert_non_null(lock);
    assert_false(fixture_write(&fixture, path, FIXTURE_LIT + 1, NULL, &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
    assert_non_null(strstr(err.message, "ermission denied"));
    fclose(lock);
    assert_file(path, "old", 3);
    assert_true(glint_path_remove(path));
}

static void a_path_that_is_not_utf8_is_an_error(UNUSED void **state) {
    errno = 0;
    assert_true(glint_file_open("C:\\gr\xF6\xDF"
                                "er.exr") == GLINT_NO_FILE);
    assert_int_equal(errno, EILSEQ);
}
#endif

static void errors_are_told_by_errno(UNUSED void **state) {
    char path[512];
    struct glint_file_info info;
    assert_true(glint_file_open(fixture_path(path, "nothing")) == GLINT_NO_FILE);
    assert_int_equal(errno, ENOENT);
    errno = 0;
    assert_false(glint_path_describe(path, &info));
    assert_int_equal(errno, ENOENT);
    errno = 0;
    assert_false(glint_path_replace(path, fixture_path((char[512]){0}, "else")));
    assert_int_equal(errno, ENOENT);
    errno = 0;
    assert_false(glint_path_create_folder(fixture_path(path, "")));
    assert_int_equal(errno, EEXIST);
    assert_true(glint_path_describe(path, &info));
    assert_int_equal(info.kind, GLINT_FILE_FOLDER);
    /* A folder is not replaced by a file. */
    char file[512], folder[512];
    write_text(fixture_path(file, "file"), "x", 1);
    assert_true(glint_path_create_folder(fixture_path(folder, "folder")));
    assert_false(glint_path_replace(file, folder));
    assert_true(glint_path_describe(folder, &info) && info.kind == GLINT_FILE_FOLDER);
    assert_file(file, "x", 1);
    assert_int_equal(rmdir(folder), 0);
    assert_true(glint_path_remove(file));
}

static void a_file_has_one_identity(UNUSED void **state) {
    char a[512], b[512], again[600];
    write_text(fixture_path(a, "a"), "a", 1);
    write_text(fixture_path(b, "b"), "a", 1);
    struct glint_file_info ia, ib, other;
    assert_true(glint_path_describe(a, &ia) && glint_path_describe(b, &ib));
    assert_false(glint_file_same(&ia, &ib));
    snprintf(again, sizeof again, "%s/./a", fixture_path((char[512]){0}, "."));
    assert_true(glint_path_describe(again, &other));
    assert_true(glint_file_same(&ia, &other));
    assert_true(glint_path_remove(a) && glint_path_remove(b));
}

static void folders_of_paths(UNUSED void **state) {
    static const struct {
        const char *path;
        size_t posix, windows;
    } rows[] = {{"x.exr", 0, 0},        {"a/x.exr", 2, 2},         {"/x.exr", 1, 1},  {"a/b/", 4, 4},
                {"a\\x.exr", 0, 2},     {"a/b\\x.exr", 2, 4},      {"C:x.exr", 0, 2}, {"C:\\x.exr", 0, 3},
                {"C:/a b/x.exr", 7, 7}, {"\\\\s\\d\\x.exr", 0, 6}, {"", 0, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
#ifdef _WIN32
        const size_t expected = rows[i].windows;
#else
        const size_t expected = rows[i].posix;
#endif
        if (glint_path_folder(rows[i].path) != expected)
            fail_msg("%s: expected %zu, found %zu", rows[i].path, expected, glint_path_folder(rows[i].path));
    }
}

struct turns {
    glint_mutex lock;
    glint_condition changed;
    size_t next;
};

/* Each index waits for the one before it, so that a lost wake-up would never end. */
static bool take_turn(void *user, UNUSED uint32_t worker, size_t index) {
    struct turns *turns = user;
    glint_mutex_lock(&turns->lock);
    while (turns->next != index) glint_condition_wait(&turns->changed, &turns->lock);
    turns->next++;
    glint_condition_wake_all(&turns->changed);
    glint_mutex_unlock(&turns->lock);
    return true;
}

static void threads_take_turns(UNUSED void **state) {
    struct turns turns = {.next = 0};
    glint_mutex_init(&turns.lock);
    glint_condition_init(&turns.changed);
    assert_true(glint_loop(2000, 8, take_turn, &turns));
    assert_int_equal(turns.next, 2000);
    assert_true(glint_cores() >= 1);
    glint_condition_finish(&turns.changed);
    glint_mutex_finish(&turns.lock);
}

#ifdef __linux__
static void cores_of_others_do_not_count(UNUSED void **state) {
    cpu_set_t own, one;
    assert_int_equal(sched_getaffinity(0, sizeof own, &own), 0);
    assert_int_equal(glint_cores(), CPU_COUNT(&own));
    size_t core = 0;
    while (!CPU_ISSET(core, &own)) core++;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    assert_int_equal(glint_cores(), 1);
    assert_int_equal(sched_setaffinity(0, sizeof own, &own), 0);
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_byte_is_kept),
        cmocka_unit_test(offsets_have_64_bits),
        cmocka_unit_test(paths_are_utf8),
        cmocka_unit_test(long_paths_work),
        cmocka_unit_test(a_file_that_is_read_can_be_replaced),
        cmocka_unit_test(an_open_capture_keeps_its_pixels),
#ifdef __linux__
        cmocka_unit_test(cores_of_others_do_not_count),
#endif
#ifdef _WIN32
        cmocka_unit_test(a_locked_file_is_left_alone),
        cmocka_unit_test(a_path_that_is_not_utf8_is_an_error),
#endif
        cmocka_unit_test(errors_are_told_by_errno),
        cmocka_unit_test(a_file_has_one_identity),
        cmocka_unit_test(folders_of_paths),
        cmocka_unit_test(threads_take_turns),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
