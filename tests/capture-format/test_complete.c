/* Files that are complete or not there at all. */
#include "complete.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

static char path[512];

static void write_text(const char *name, const char *text) {
    const glint_file file = glint_file_create(name);
    assert_true(file != GLINT_NO_FILE && glint_file_write(file, text, strlen(text), 0) && glint_file_close(file));
}

static void assert_text(const char *name, const char *text) {
    char found[64] = "";
    size_t got = 0;
    const glint_file file = glint_file_open(name);
    assert_true(file != GLINT_NO_FILE && glint_file_read(file, found, sizeof found - 1, 0, &got));
    glint_file_close(file);
    assert_string_equal(found, text);
}

static bool exists(const char *name) {
    struct glint_file_info info;
    return glint_path_describe(name, &info);
}

/* Opens it over a file that has the name already, and writes "new". Returns the temporary name. */
static const char *begin(struct complete_file *out, struct glint_error *err) {
    static char temporary[600];
    write_text(fixture_path(path, "complete"), "old");
    assert_true(complete_open(out, path, err));
    snprintf(temporary, sizeof temporary, "%s", out->temporary);
    assert_true(glint_file_write(out->file, "new", 3, 0));
    assert_text(path, "old");
    assert_text(temporary, "new");
    return temporary;
}

/* Catches: a name that a file gets too early, late or never, and temporary files that stay. */
static void a_complete_file_gets_its_name(UNUSED void **state) {
    for (int durable = 0; durable < 2; durable++) {
        struct glint_error err = {0};
        struct complete_file out;
        const char *temporary = begin(&out, &err);
        assert_true(complete_close(&out, true, durable, &err));
        assert_text(path, "new");
        assert_false(exists(temporary));
        assert_true(glint_path_remove(path));
    }
}

/* Catches: an incomplete file that replaces a complete one, and an error that hides the first. */
static void an_incomplete_file_is_removed(UNUSED void **state) {
    struct glint_error err = {0};
    struct complete_file out;
    const char *temporary = begin(&out, &err);
    glint_fail(&err, GLINT_ERROR_LIMIT, "first");
    assert_false(complete_close(&out, false, true, &err));
    assert_string_equal(err.message, "first");
    assert_text(path, "old");
    assert_false(exists(temporary));
    assert_true(glint_path_remove(path));
}

/* Catches: errors without the file's own name, and what is left behind by them. */
static void what_fails_is_named(UNUSED void **state) {
    struct glint_error err = {0};
    struct complete_file out;
    char temporary[600], folder[512], start[600];
    assert_false(complete_open(&out, "nowhere/complete.txt", &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
    assert_memory_equal(err.message, "nowhere/complete.txt: ", strlen("nowhere/complete.txt: "));
    /* a folder takes the name meanwhile */
    assert_true(complete_open(&out, fixture_path(folder, "taken"), &err));
    snprintf(temporary, sizeof temporary, "%s", out.temporary);
    assert_true(exists(temporary));
    assert_true(glint_path_create_folder(folder));
    err = (struct glint_error){0};
    assert_false(complete_close(&out, true, false, &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
    snprintf(start, sizeof start, "%s: ", folder);
    assert_memory_equal(err.message, start, strlen(start));
    assert_false(exists(temporary));
    assert_int_equal(rmdir(folder), 0);
}

/* Catches: temporary files of processes that were killed which stay; and those of running ones, and files of the user, that are removed. */
static void what_a_killed_process_left_is_removed(UNUSED void **state) {
    static const char *const names[] = {"complete.tmp-0123abcd", "complete.tmp-0123abc", "complete.tmp-0123abcX",
                                        "other.tmp-0123abcd", "complete.tmp-mine"};
    enum { NAMES = sizeof names / sizeof *names };
    char paths[NAMES][512];
    struct glint_error err = {0};
    struct complete_file running, out;
    for (int i = 0; i < NAMES; i++) write_text(fixture_path(paths[i], names[i]), "left");
    assert_true(complete_open(&running, fixture_path(path, "complete"), &err));
    assert_true(complete_open(&out, path, &err));
    assert_true(exists(running.temporary));
    assert_string_not_equal(running.temporary, out.temporary);
#ifndef _WIN32 /* where they stay for an hour */
    assert_false(exists(paths[0]));
#endif
    for (int i = 1; i < NAMES; i++) assert_true(exists(paths[i]));
    assert_true(glint_file_write(running.file, "first", 5, 0) && complete_close(&running, true, false, &err));
    assert_true(glint_file_write(out.file, "second", 6, 0) && complete_close(&out, true, false, &err));
    assert_text(path, "second");
    for (int i = 0; i < NAMES; i++) glint_path_remove(paths[i]);
    assert_true(glint_path_remove(path));
}

#ifndef _WIN32
/* Catches: files of a cache that others may read. */
static void a_secret_file_is_secret(UNUSED void **state) {
    struct glint_error err = {0};
    struct complete_file out;
    struct stat found;
    assert_true(complete_open_secret(&out, fixture_path(path, "secret"), &err));
    assert_int_equal(stat(out.temporary, &found), 0);
    assert_int_equal(found.st_mode & 0777, 0600);
    assert_true(complete_close(&out, true, false, &err));
    assert_int_equal(stat(path, &found), 0);
    assert_int_equal(found.st_mode & 0777, 0600);
    assert_true(glint_path_remove(path));
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_complete_file_gets_its_name), cmocka_unit_test(an_incomplete_file_is_removed),
        cmocka_unit_test(what_fails_is_named),           cmocka_unit_test(what_a_killed_process_left_is_removed),
#ifndef _WIN32
        cmocka_unit_test(a_secret_file_is_secret),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
