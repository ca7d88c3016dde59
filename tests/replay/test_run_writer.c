/* Runs that replace others in their folders, at once: wherever a process ends, the folder has the old run or the new one. And the locks of folders. */
#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

#define RUN(name, file)                                                                                                \
    "{\"format\": 1, \"passes\": [{\"slot\": \"s\", \"variant\": \"v\", \"images\": [{\"name\": \"" name               \
    "\", \"file\": \"" file                                                                                            \
    "\", \"part\": \"p\", \"channels\": \"X\", \"format\": \"R32F\", \"width\": 1, \"height\": 1}]}]}"

static void write_text(const char *folder, const char *name, const char *text) {
    char path[256];
    assert_true(snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
}

static bool exists(const char *folder, const char *name) {
    char path[256];
    assert_true(snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path);
    return access(path, F_OK) == 0;
}

static const char *new_folder(void **state, const char *name) {
    static char folder[128];
    const struct fixture *fixture = *state;
    snprintf(folder, sizeof folder, "%s/%s", fixture->folder, name);
    assert_int_equal(mkdir(folder, 0777), 0);
    return folder;
}

/* A folder with the old run, and a file of the user. */
static const char *old_run(void **state, const char *name) {
    const char *folder = new_folder(state, name);
    write_text(folder, "old.exr", "old");
    write_text(folder, "both.exr", "old");
    write_text(folder, "mine.txt", "mine");
    write_text(folder, "run.json", RUN("old", "old.exr"));
    return folder;
}

static void write_new(const char *staging) {
    write_text(staging, "new.exr", "new");
    write_text(staging, "run.json", RUN("new", "new.exr"));
}

static void expect_run(const char *folder, bool new) {
    struct glint_error err = {0};
    struct glint_run *run = glint_run_open(folder, &err);
    if (!run) fail_msg("%s", err.message);
    assert_non_null(glint_run_find(run, new ? "new" : "old"));
    glint_run_close(&run);
    assert_int_equal(exists(folder, "new.exr"), new);
    assert_int_equal(exists(folder, "old.exr"), !new);
    assert_true(exists(folder, "mine.txt"));
}

/* Catches: a run that is there before it is whole, what stays of the old one, and files of the user that go. */
static void a_run_replaces_another_at_once(void **state) {
    struct glint_error err = {0};
    const char *folder = old_run(state, "replaced");
    for (int commit = 0; commit < 2; commit++) {
        struct glint_run_writer *writer = glint_run_writer_open(folder, &err);
        if (!writer) fail_msg("%s", err.message);
        const char *staging = glint_run_writer_begin(writer, &err);
        if (!staging) fail_msg("%s", err.message);
        write_new(staging);
        expect_run(folder, false);
        if (commit && !glint_run_writer_commit(writer, &err)) fail_msg("%s", err.message);
        glint_run_writer_close(&writer);
        expect_run(folder, commit);
        assert_false(exists(folder, ".glint-new"));
    }
}

/* Catches: a folder without a run where a process ended between two steps of the replacement. */
static void an_interrupted_replacement_is_completed(void **state) {
    enum { BEFORE, OLD_MOVED, NEW_MOVED, OLD_REMOVED, MOMENTS };
    static const char *const names[MOMENTS] = {"before", "old_moved", "new_moved", "old_removed"};
    for (int at = BEFORE; at < MOMENTS; at++) {
        struct glint_error err = {0};
        char staging[256], from[512], to[512];
        const char *folder = old_run(state, names[at]);
        snprintf(staging, sizeof staging, "%s/.glint-new", folder);
        assert_int_equal(mkdir(staging, 0777), 0);
        write_new(staging);
        snprintf(from, sizeof from, "%s/run.json", folder);
        snprintf(to, sizeof to, "%s/old.json", staging);
        if (at >= OLD_MOVED) assert_int_equal(rename(from, to), 0);
        snprintf(from, sizeof from, "%s/new.exr", staging);
        snprintf(to, sizeof to, "%s/new.exr", folder);
        if (at >= NEW_MOVED) assert_int_equal(rename(from, to), 0);
        snprintf(from, sizeof from, "%s/old.json", staging);
        snprintf(to, sizeof to, "%s/old.exr", folder);
        if (at >= OLD_REMOVED) assert_true(unlink(from) == 0 && unlink(to) == 0);
        expect_run(folder, at != BEFORE);
        assert_int_equal(exists(folder, ".glint-new"), at == BEFORE);
        /* What is not the folder's run is removed by the next process that writes. */
        struct glint_run_writer *writer = glint_run_writer_open(folder, &err);
        assert_non_null(glint_run_writer_begin(writer, &err));
        glint_run_writer_close(&writer);
        assert_false(exists(folder, ".glint-new"));
        expect_run(folder, at != BEFORE);
    }
}

/* Catches: images that stay when a removal is interrupted, and files of the user that go. */
static void an_interrupted_removal_is_completed(void **state) {
    struct glint_error err = {0};
    char staging[256], from[512], to[512];
    const char *folder = old_run(state, "removed");
    snprintf(staging, sizeof staging, "%s/.glint-new", folder);
    snprintf(from, sizeof from, "%s/run.json", folder);
    snprintf(to, sizeof to, "%s/old.json", staging);
    assert_true(mkdir(staging, 0777) == 0 && rename(from, to) == 0);
    assert_null(glint_run_open(folder, &err));
    assert_true(glint_run_remove(folder, &err));
    assert_false(exists(folder, "old.exr") || exists(folder, ".glint-new"));
    assert_true(exists(folder, "mine.txt") && exists(folder, "both.exr"));
    assert_true(glint_run_remove(folder, &err));
}

/* Catches: a run or a file of the user that is taken for what an interrupted process left, a whole run that is, and a name that can never be used
   again after an interruption. */
static void an_unfinished_run_is_told_from_all_others(void **state) {
    char inner[256], staging[300];
    assert_false(glint_run_is_unfinished(old_run(state, "finished"), false));
    const char *folder = new_folder(state, "unfinished");
    assert_true(glint_run_is_unfinished(folder, false) && glint_run_is_unfinished(folder, true));
    snprintf(inner, sizeof inner, "%s/frame", folder);
    snprintf(staging, sizeof staging, "%s/.glint-new", inner);
    assert_true(mkdir(inner, 0777) == 0 && mkdir(staging, 0777) == 0);
    write_text(staging, "new.exr", "half");
    assert_true(glint_run_is_unfinished(inner, false) && exists(staging, "new.exr"));
    assert_true(glint_run_is_unfinished(folder, true) && !glint_run_is_unfinished(folder, false));
    write_text(inner, "mine.txt", "mine");
    assert_false(glint_run_is_unfinished(inner, false) || glint_run_is_unfinished(folder, true));
    /* A whole run that only had to be moved. */
    write_new(staging);
    assert_false(glint_run_is_unfinished(inner, false));
    expect_run(inner, true);
    snprintf(inner, sizeof inner, "%s/file", folder);
    write_text(folder, "file", "mine");
    assert_false(glint_run_is_unfinished(inner, false) || glint_run_is_unfinished("/nowhere", false));
}

/* Catches: files that are moved out of another folder, or removed there, because a run folder says so. */
static void a_link_is_not_followed(void **state) {
    struct glint_error err = {0};
    char link[256], elsewhere[128];
    snprintf(elsewhere, sizeof elsewhere, "%s", new_folder(state, "elsewhere"));
    write_new(elsewhere);
    const char *folder = new_folder(state, "linked");
    snprintf(link, sizeof link, "%s/.glint-new", folder);
    assert_int_equal(symlink(elsewhere, link), 0);
    assert_null(glint_run_open(folder, &err));
    struct glint_run_writer *writer = glint_run_writer_open(folder, &err);
    assert_non_null(writer);
    assert_null(glint_run_writer_begin(writer, &err));
    fixture_says(&err, "expected a folder, found something else");
    glint_run_writer_close(&writer);
    assert_true(exists(elsewhere, "new.exr") && exists(elsewhere, "run.json"));
}

/* A process that holds the lock until it is killed. */
static pid_t hold(const char *folder) {
    int told[2];
    char byte = 0;
    assert_int_equal(pipe(told), 0);
    const pid_t child = fork();
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL); /* also if the test fails */
        if (!glint_folder_lock(folder, NULL) || write(told[1], "1", 1) != 1) _exit(1);
        for (;;) pause();
    }
    assert_int_equal(read(told[0], &byte, 1), 1);
    close(told[0]);
    close(told[1]);
    return child;
}

/* Whether the system lists a lock on the folder by the number that stat shows, which file systems on top of others need not do. */
static bool is_listed(const char *folder) {
    struct stat found;
    char line[256], number[40];
    bool listed = false;
    FILE *list = fopen("/proc/locks", "r");
    assert_int_equal(stat(folder, &found), 0);
    snprintf(number, sizeof number, ":%llu ", (unsigned long long)found.st_ino);
    while (list && fgets(line, sizeof line, list)) listed = listed || strstr(line, number);
    if (list) fclose(list);
    return listed;
}

/* Catches: two processes that write, an error that does not say who is in the way, and a lock that outlives its process. */
static void one_process_at_a_time_writes(void **state) {
    struct glint_error err = {0};
    char process[64];
    const char *folder = old_run(state, "locked");
    const pid_t child = hold(folder);
    assert_null(glint_run_writer_open(folder, &err));
    assert_int_equal(err.code, GLINT_ERROR_IO);
    fixture_says(&err, folder);
    if (is_listed(folder)) snprintf(process, sizeof process, "process %ld is using this folder", (long)child);
    else snprintf(process, sizeof process, "another process is using this folder");
    fixture_says(&err, process);
    assert_null(glint_folder_lock_shared(folder, &err));
    expect_run(folder, false); /* which may be read */
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, NULL, 0), child);
    struct glint_folder_lock *first = glint_folder_lock_shared(folder, &err),
                             *second = glint_folder_lock_shared(folder, &err);
    assert_true(first && second);
    assert_null(glint_folder_lock(folder, &err));
    glint_folder_unlock(&first);
    glint_folder_unlock(&second);
    struct glint_folder_lock *lock = glint_folder_lock(folder, &err);
    assert_non_null(lock);
    glint_folder_unlock(&lock);
}

/* Catches: empty folders that stay, and one of somebody else that goes. */
static void a_folder_made_for_the_lock_goes_with_it(void **state) {
    struct glint_error err = {0};
    const struct fixture *fixture = *state;
    char folder[128];
    snprintf(folder, sizeof folder, "%s/made", fixture->folder);
    for (int i = 0; i < 3; i++) {
        struct glint_folder_lock *lock = glint_folder_lock(folder, &err);
        assert_non_null(lock);
        if (i == 1) assert_true(rmdir(folder) == 0 && mkdir(folder, 0777) == 0);
        if (i == 2) write_text(folder, "kept", "");
        glint_folder_unlock(&lock);
        assert_int_equal(access(folder, F_OK) == 0, i > 0);
        if (i == 1) assert_int_equal(rmdir(folder), 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_replaces_another_at_once),
        cmocka_unit_test(an_interrupted_replacement_is_completed),
        cmocka_unit_test(an_interrupted_removal_is_completed),
        cmocka_unit_test(an_unfinished_run_is_told_from_all_others),
        cmocka_unit_test(a_link_is_not_followed),
        cmocka_unit_test(one_process_at_a_time_writes),
        cmocka_unit_test(a_folder_made_for_the_lock_goes_with_it),
    };
    return cmocka_run_group_tests(tests, fixture_setup_host, fixture_teardown);
}
