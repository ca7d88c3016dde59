/* The cache folder: what it returns, what it does not, and how much it keeps. */
#include <stdio.h>
#include <stdlib.h>
#include <dirent.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "glint/cache.h"
#include "glint/replay.h"
#include "unit.h"

static const char *const keys[] = {"00000000000000000000000000000000", "11111111111111111111111111111111",
                                   "22222222222222222222222222222222"};
struct place {
    char top[64], folder[96], file[96], back[96];
};

static void begin(struct place *place) {
    snprintf(place->top, sizeof place->top, "/tmp/glint-cache-XXXXXX");
    assert_non_null(mkdtemp(place->top));
    snprintf(place->folder, sizeof place->folder, "%s/a/b", place->top); /* neither exists */
    snprintf(place->file, sizeof place->file, "%s/file", place->top);
    snprintf(place->back, sizeof place->back, "%s/back", place->top);
}

static void remove_place(const struct place *place) {
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", place->top);
    assert_int_equal(system(command), 0);
}

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void expect_text(const char *path, const char *text) {
    char found[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(found, sizeof found, file));
    fclose(file);
    assert_string_equal(found, text);
}

static size_t count_files(const char *folder) {
    size_t count = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (struct dirent *entry; (entry = readdir(entries));) count += entry->d_name[0] != '.';
    closedir(entries);
    return count;
}

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
    write_text(place.file, "second");
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    assert_true(glint_cache_copy(place.folder, keys[0], place.back));
    expect_text(place.back, "second");
    assert_int_equal(count_files(place.folder), 1); /* no incomplete or old files */
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

/* Catches: a wait for a pipe, and a read of what a link leads to. */
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
    }
    remove_place(&place);
}

/* Catches: temporary files that stay, and entries that others may read. */
static void a_killed_process_leaves_nothing_for_long(UNUSED void **state) {
    struct place place;
    char path[256];
    struct stat found;
    begin(&place);
    write_text(place.file, "first");
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    snprintf(path, sizeof path, "%s/%s.tmp-0123abcd", place.folder, keys[1]);
    write_text(path, "half");
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
    assert_int_equal(access(path, F_OK), -1);
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
        cmocka_unit_test(a_killed_process_leaves_nothing_for_long),
        cmocka_unit_test(what_was_not_used_for_longest_goes),
        cmocka_unit_test(a_folder_that_cannot_be_written_keeps_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
