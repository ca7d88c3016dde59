/* The cache folder: what it returns, what it does not, how much it keeps, and what many processes at once do to it. */
#include <stdio.h>
#include <stdlib.h>
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
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
    write_text(place.file, "second"); /* as of another process, with its own times */
    glint_cache_store(place.folder, keys[0], place.file, UINT64_MAX);
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

static void set_age(const char *path, time_t seconds) {
    const struct timespec times[2] = {{time(NULL) - seconds, 0}, {time(NULL) - seconds, 0}};
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
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

/* ---- Many processes ---- */

enum { PROCESSES = 6, KEYS = 5, LIMIT = 3000 };

static void make_key(unsigned k, char key[GLINT_CACHE_KEY_SIZE]) {
    snprintf(key, GLINT_CACHE_KEY_SIZE, "%032x", k + 1);
}

/* What the entries of a key begin with; what follows is of the process that stored it, as times are. */
static void make_contents(unsigned k, unsigned process, char text[1024]) {
    const int length = snprintf(text, 1024, "key %u process %u ", k, process);
    memset(text + length, (int)('a' + k), 600 + 20 * k);
    snprintf(text + length + 600 + 20 * k, 16, " end");
}

/* Changes an entry without its name, in place or by another file. */
static void damage_any(const struct place *place, unsigned chance, unsigned process) {
    char path[256 + sizeof place->folder], other[160];
    DIR *entries = opendir(place->folder);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        if (entry->d_name[0] == '.' || strstr(entry->d_name, ".tmp-") || chance-- % KEYS) continue;
        snprintf(path, sizeof path, "%s/%s", place->folder, entry->d_name);
        if (chance % 3 == 0) unlink(path);
        else if (chance % 3 == 1 && truncate(path, chance % 600)) continue;
        else {
            snprintf(other, sizeof other, "%s/wrong%u", place->top, process);
            write_text(other, "key 0 process 0 but not its end");
            rename(other, path);
        }
        break;
    }
    if (entries) closedir(entries);
}

/* Exits with 1 if it was given what nobody stored. */
static void use_cache(const struct place *place, unsigned process, unsigned rounds, atomic_uint *hits) {
    char key[GLINT_CACHE_KEY_SIZE], own[160], back[160], found[256], expected[1024], text[1024];
    unsigned chance = 12345 + process * 7919, k, by;
    snprintf(own, sizeof own, "%s/own%u.txt", place->top, process);
    snprintf(back, sizeof back, "%s/back%u", place->top, process);
    for (unsigned i = 0; i < rounds; i++) {
        chance = chance * 1103515245 + 12345;
        k = chance >> 16 & 0x7fff;
        if (k % 11 == 0) damage_any(place, k / 11, process);
        k %= KEYS;
        make_key(k, key);
        glint_cache_find(place->folder, key, found, sizeof found);
        if (!glint_cache_copy(place->folder, key, back)) {
            make_contents(k, process, text);
            write_text(own, text);
            glint_cache_store(place->folder, key, own, LIMIT);
            continue;
        }
        FILE *file = fopen(back, "r");
        const size_t length = file ? fread(text, 1, sizeof text - 1, file) : 0;
        text[length] = 0;
        if (file) fclose(file);
        if (sscanf(text, "key %*u process %u", &by) != 1) _exit(1);
        make_contents(k, by, expected);
        if (by >= PROCESSES || strcmp(text, expected) != 0) _exit(1);
        atomic_fetch_add(hits, 1);
    }
    _exit(0);
}

/* Catches: contents that are damaged, cut or of another key; an error that a file causes which vanishes; a limit that many exceed together; and
   temporary files that a killed process leaves. */
static void many_processes_read_write_evict_and_damage(UNUSED void **state) {
    struct place place;
    char path[256], key[GLINT_CACHE_KEY_SIZE], text[1024];
    int status;
    pid_t children[PROCESSES];
    begin(&place);
    atomic_uint *hits = mmap(NULL, sizeof *hits, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(hits, MAP_FAILED);
    for (unsigned p = 0; p < PROCESSES; p++) {
        children[p] = fork();
        assert_true(children[p] >= 0);
        if (children[p] == 0) use_cache(&place, p, p == 0 ? UINT32_MAX : 150, hits);
    }
    for (unsigned p = 1; p < PROCESSES; p++) {
        assert_int_equal(waitpid(children[p], &status, 0), children[p]);
        assert_int_equal(status, 0);
    }
    assert_int_equal(kill(children[0], SIGKILL), 0); /* the one that would go on for ever, somewhere in the midst */
    assert_int_equal(waitpid(children[0], &status, 0), children[0]);
    assert_true(WIFSIGNALED(status));
    assert_true(atomic_load(hits) > 50); /* of more than 750 */
    assert_int_equal(munmap(hits, sizeof *hits), 0);
    for (unsigned k = 0; k <= KEYS; k++) { /* whatever is left, and one that nobody stored */
        make_key(k, key);
        make_contents(k, 0, text);
        write_text(place.file, text);
        usleep(20000); /* times of files have a limited resolution */
        glint_cache_store(place.folder, key, place.file, LIMIT);
        assert_true(glint_cache_find(place.folder, key, path, sizeof path));
    }
    const size_t left = count_files(place.folder);
    assert_int_equal(left, 4); /* of more than 600 and less than 750 bytes each, and no temporary file */
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
        cmocka_unit_test(many_processes_read_write_evict_and_damage),
        cmocka_unit_test(a_folder_that_cannot_be_written_keeps_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
