/* The cache folder: what it returns, what it does not, and how much it keeps. */
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cache_place.h"

static void what_was_stored_comes_back(UNUSED void **state) {
    struct place place;
    char path[256];
    begin(&place);
    assert_false(glint_cache_find(place.folder, keys[0], path, sizeof path)); /* no folder yet */
    write_text(place.file, "first");
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    write_text(place.file, "changed"); /* modified in place, but the entry is a copy */
    assert_true(glint_cache_copy(place.folder, keys[0], place.back));
    expect_text(place.back, "first");
    write_text(place.back, "changed");
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    expect_text(path, "first");
    assert_false(glint_cache_find(place.folder, keys[1], path, sizeof path));
    write_text(place.file, "second"); /* as of another process, with its own times */
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    assert_int_equal(count_files(place.folder), 1);
    assert_true(glint_cache_copy(place.folder, keys[0], place.back));
    expect_text(place.back, "first");
    write_text(path, "damaged");
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    assert_true(glint_cache_copy(place.folder, keys[0], place.back));
    expect_text(place.back, "second");
    assert_int_equal(count_files(place.folder), 1); /* no incomplete or damaged files */
    remove_place(&place);
}

/* Catches: damaged data that is returned as if it were the stored one. */
static void a_damaged_entry_is_none(UNUSED void **state) {
    struct place place;
    char path[256];
    begin(&place);
    for (int give = 0; give < 2; give++) {
        write_text(place.file, "first");
        glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
        assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
        write_text(path, give ? "firs" : "worst");
        if (give) assert_false(glint_cache_copy(place.folder, keys[0], place.back));
        else assert_false(glint_cache_find(place.folder, keys[0], path, sizeof path));
        assert_int_equal(access(place.back, F_OK), -1);
    }
    remove_place(&place);
}

/* Catches: the contents of another key under this one's name, with the hash that belongs to them. */
static void another_keys_contents_are_none(UNUSED void **state) {
    struct place place;
    char path[256], other[256];
    begin(&place);
    for (int i = 0; i < 2; i++) {
        write_text(place.file, i ? "first" : "other");
        glint_cache_store(place.folder, keys[i], place.file, UINT64_MAX);
    }
    assert_true(glint_cache_find(place.folder, keys[0], other, sizeof other));
    assert_true(glint_cache_find(place.folder, keys[1], path, sizeof path));
    assert_int_equal(unlink(path), 0);
    snprintf(path, sizeof path, "%s/%s%s", place.folder, keys[1], other + strlen(place.folder) + 1 + strlen(keys[0]));
    assert_int_equal(rename(other, path), 0);
    assert_false(glint_cache_copy(place.folder, keys[1], place.back));
    assert_false(glint_cache_find(place.folder, keys[1], path, sizeof path));
    assert_int_equal(count_files(place.folder), 0);
    remove_place(&place);
}

/* Catches: a wait for a pipe, a read of what a link leads to, and a removal of what could not be read. */
static void what_is_no_file_is_none(UNUSED void **state) {
    struct place place;
    char path[256];
    begin(&place);
    for (int kind = 0; kind < 3; kind++) {
        write_text(place.file, "first");
        glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
        assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
        assert_int_equal(rename(path, place.back), 0); /* the very contents */
        assert_int_equal(kind == 0 ? mkfifo(path, 0600) : kind == 1 ? symlink(place.back, path) : mkdir(path, 0700), 0);
        assert_false(glint_cache_copy(place.folder, keys[0], place.file));
        assert_false(glint_cache_find(place.folder, keys[0], path, sizeof path));
        assert_int_equal(count_files(place.folder), 1);
    }
    remove_place(&place);
}

/* Two processes that store at the same moment leave two entries of a key. Catches: a look-up that ends at the damaged one. */
static void one_of_two_entries_is_enough(UNUSED void **state) {
    struct place place;
    char path[256], other[256];
    begin(&place);
    for (int damaged = 0; damaged < 2; damaged++) {
        write_text(place.file, "first");
        glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
        assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
        snprintf(other, sizeof other, "%s/aside", place.top);
        assert_int_equal(rename(path, other), 0);
        write_text(place.file, "second");
        glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
        assert_int_equal(rename(other, path), 0);
        assert_int_equal(count_files(place.folder), 2);
        assert_true(glint_cache_find(place.folder, keys[0], other, sizeof other));
        if (damaged) write_text(path, "worse"); /* one is listed before the other */
        else write_text(other, "worse");
        assert_true(glint_cache_copy(place.folder, keys[0], place.back));
        expect_text(place.back, damaged || strcmp(path, other) == 0 ? "second" : "first");
        snprintf(path, sizeof path, "rm -r '%s'", place.folder);
        assert_int_equal(system(path), 0);
    }
    remove_place(&place);
}

/* Ends as it writes the third byte. */
static void be_killed_while_storing(const struct place *place) {
    const struct rlimit bytes = {2, 2};
    const pid_t child = fork();
    int status = 0;
    assert_true(child >= 0);
    if (child == 0) {
        setrlimit(RLIMIT_FSIZE, &bytes);
        signal(SIGXFSZ, SIG_DFL);
        glint_cache_store(place->folder, keys[1], place->file, UINT64_MAX);
        glint_cache_store(place->folder, keys[1], place->file, UINT64_MAX);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status) || status == 0);
}

/* Catches: temporary files of this machine that stay, those of others that go while they may be in use, and entries that others may read. */
static void a_killed_process_leaves_nothing_for_long(UNUSED void **state) {
    struct place place;
    char path[256], theirs[256];
    struct stat found;
    begin(&place);
    write_text(place.file, "first");
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    be_killed_while_storing(&place);
    assert_int_equal(count_files(place.folder), 2);
    snprintf(theirs, sizeof theirs, "%s/%s.tmp-0123abcd", place.folder, keys[1]);
    write_text(theirs, "half");
    glint_cache_store(place.folder, keys[2], place.file, UINT64_MAX);
    assert_int_equal(count_files(place.folder), 3); /* two entries, and theirs */
    set_age(theirs, 23 * 60 * 60);
    write_text(place.file, "another");
    glint_cache_store(place.folder, keys[1], place.file, UINT64_MAX);
    assert_int_equal(access(theirs, F_OK), 0);
    set_age(theirs, 25 * 60 * 60);
    assert_true(glint_cache_find(place.folder, keys[1], path, sizeof path));
    write_text(path, "damaged");
    glint_cache_store(place.folder, keys[1], place.file, UINT64_MAX);
    assert_int_equal(access(theirs, F_OK), -1);
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    assert_int_equal(stat(path, &found), 0);
    assert_int_equal(found.st_mode & 077, 0);
    assert_int_equal(stat(place.folder, &found), 0);
    assert_int_equal(found.st_mode & 077, 0);
    remove_place(&place);
}

/* Catches: a limit that is exceeded, or that evicts recently used entries. */
static void what_was_not_used_for_longest_goes(UNUSED void **state) {
    struct place place;
    char path[256];
    begin(&place);
    write_text(place.file, "ten bytes.");
    for (int i = 0; i < 2; i++) {
        glint_cache_store(place.folder, keys[i], place.file, 25);
        usleep(20000); /* times of files have a limited resolution */
    }
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    usleep(20000);
    glint_cache_store(place.folder, keys[2], place.file, 25);
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    assert_false(glint_cache_find(place.folder, keys[1], path, sizeof path));
    assert_true(glint_cache_find(place.folder, keys[2], path, sizeof path));
    remove_place(&place);
}

/* Catches: an entry that drives out all others before it goes itself, and a folder of many entries that is trimmed in part. */
static void however_many_entries_the_limit_holds(UNUSED void **state) {
    struct place place;
    char path[256];
    begin(&place);
    write_text(place.file, "ten bytes.");
    glint_cache_store(place.folder, keys[0], place.file, 25);
    write_text(place.file, "this text has more than twenty-five bytes");
    glint_cache_store(place.folder, keys[1], place.file, 25);
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    assert_int_equal(count_files(place.folder), 1);
    for (unsigned i = 0; i < 400; i++) {
        snprintf(path, sizeof path, "%s/%032x-%032x.exr", place.folder, i + 1, i);
        write_text(path, "ten bytes.");
        set_age(path, 1000 + i);
    }
    write_text(place.file, "ten bytes.");
    glint_cache_store(place.folder, keys[2], place.file, 100);
    assert_int_equal(count_files(place.folder), 10);
    snprintf(path, sizeof path, "%s/%032x-%032x.exr", place.folder, 8, 7);
    assert_int_equal(access(path, F_OK), 0);
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    assert_true(glint_cache_find(place.folder, keys[2], path, sizeof path));
    remove_place(&place);
}

static void the_limit_is_a_number_of_gibibytes(UNUSED void **state) {
    static const char *const bad[] = {"0", "x", "-1", "1.5", " 1", "4 GiB", "99999999999999999999"};
    struct place place;
    char path[256];
    begin(&place);
    write_text(place.file, "first");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(setenv("GLINT_CACHE_GIB", bad[i], 1), 0);
        assert_string_equal(glint_cache_refusal(place.folder), "GLINT_CACHE_GIB: expected whole GiB from 1 on");
        glint_cache_store(place.folder, keys[0], place.file, 0);
        assert_int_not_equal(access(place.folder, F_OK), 0);
    }
    assert_int_equal(setenv("GLINT_CACHE_GIB", "1", 1), 0);
    assert_null(glint_cache_refusal(place.folder));
    assert_int_equal(truncate(place.file, (off_t)1 << 30), 0); /* sparse */
    assert_int_equal(truncate(place.file, ((off_t)1 << 30) + 1), 0);
    glint_cache_store(place.folder, keys[0], place.file, 0);
    assert_false(glint_cache_find(place.folder, keys[0], path, sizeof path));
    assert_int_equal(unsetenv("GLINT_CACHE_GIB"), 0);
    write_text(place.file, "first");
    glint_cache_store(place.folder, keys[0], place.file, 0);
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    remove_place(&place);
}

/* Catches: a cache whose failure makes its user fail. */
static void a_folder_that_cannot_be_written_keeps_nothing(UNUSED void **state) {
    struct place place;
    char path[256];
    begin(&place);
    write_text(place.file, "first");
    glint_cache_store(place.file, keys[0], place.file, UINT64_MAX); /* a file exists at that path */
    assert_false(glint_cache_find(place.file, keys[0], path, sizeof path));
    assert_false(glint_cache_copy(place.file, keys[0], place.back));
    expect_text(place.file, "first");
    remove_place(&place);
}

/* What others could put there would be taken for what glint computed. */
static void a_folder_of_others_is_refused(UNUSED void **state) {
    struct place place;
    char path[256], link[128], with_slash[128];
    struct stat info;
    begin(&place);
    write_text(place.file, "private");
    assert_null(glint_cache_refusal(place.folder)); /* not there yet */
    const mode_t before = umask(0);
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    umask(before);
    assert_int_equal(stat(place.folder, &info), 0);
    assert_int_equal(info.st_mode & 07777, 0700);
    assert_true(glint_cache_find(place.folder, keys[0], path, sizeof path));
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 07777, 0600);

    for (int who = 0; who < 2; who++) {
        assert_int_equal(chmod(place.folder, who ? 0702 : 0720), 0);
        assert_string_equal(glint_cache_refusal(place.folder), "others may write to it");
        assert_false(glint_cache_find(place.folder, keys[0], path, sizeof path));
        assert_false(glint_cache_copy(place.folder, keys[0], place.back));
        glint_cache_store(place.folder, keys[1], place.file, UINT64_MAX);
        assert_int_equal(count_files(place.folder), 1);
    }
    assert_int_equal(chmod(place.folder, 0755), 0); /* they may read names, but no file */
    assert_null(glint_cache_refusal(place.folder));

    snprintf(link, sizeof link, "%s/link", place.top);
    snprintf(with_slash, sizeof with_slash, "%s/", place.folder);
    assert_int_equal(symlink(place.folder, link), 0);
    assert_string_equal(glint_cache_refusal(link), "it is a symbolic link");
    assert_false(glint_cache_find(link, keys[0], path, sizeof path));
    assert_null(glint_cache_refusal(with_slash));
    assert_string_equal(glint_cache_refusal(place.file), "it is no folder");
    if (geteuid() != 0) assert_string_equal(glint_cache_refusal("/"), "it belongs to another user");
    else if (chown(place.folder, 65534, 65534) == 0)
        assert_string_equal(glint_cache_refusal(place.folder), "it belongs to another user");
    remove_place(&place);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_stored_comes_back),
        cmocka_unit_test(a_folder_of_others_is_refused),
        cmocka_unit_test(a_damaged_entry_is_none),
        cmocka_unit_test(another_keys_contents_are_none),
        cmocka_unit_test(what_is_no_file_is_none),
        cmocka_unit_test(one_of_two_entries_is_enough),
        cmocka_unit_test(a_killed_process_leaves_nothing_for_long),
        cmocka_unit_test(what_was_not_used_for_longest_goes),
        cmocka_unit_test(however_many_entries_the_limit_holds),
        cmocka_unit_test(the_limit_is_a_number_of_gibibytes),
        cmocka_unit_test(a_folder_that_cannot_be_written_keeps_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
