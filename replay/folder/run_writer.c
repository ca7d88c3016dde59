/* Puts a whole run in the place of the run that a folder holds. The new run is written into FOLDER/.glint-new, run.json last. Then

   1. the old run.json moves into .glint-new, as old.json: from here on the new run is the folder's, and whoever finds it so completes it;
   2. the new run's files move into the folder; the old run's files that have no successor, and old.json, are removed;
   3. the new run.json moves into the folder, which is a complete run again.

   Wherever a process ends, the folder holds the old run, or all of the new one. Where an old run is replaced, what a step needs is on the disk
   before it, so that the same holds for a loss of power. */
#include "run_writer.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "complete.h"
#include "glint/replay.h"
#include "run_json.h"

enum { PATH_SIZE = 4096, NAME_SIZE = 300 };
#define NEW "/.glint-new"

struct glint_run_writer {
    struct glint_folder_lock *lock;
    char folder[PATH_SIZE], staging[PATH_SIZE];
    DIR *staged; /* .glint-new or NULL: open, so that it can be moved or removed without memory or another descriptor */
};

static bool fail_at(const char *path, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
}

static bool is_file(const char *folder, const char *name) {
    char path[PATH_SIZE];
    struct stat found;
    return snprintf(path, sizeof path, "%s/%s", folder, name) < PATH_SIZE && lstat(path, &found) == 0 &&
           S_ISREG(found.st_mode);
}

static bool is_folder(const char *path) {
    struct stat found;
    return lstat(path, &found) == 0 && S_ISDIR(found.st_mode);
}

typedef bool (*visit)(const char *folder, const char *name, void *user, struct glint_error *err);

static bool each_entry(DIR *entries, const char *folder, visit visit, void *user, struct glint_error *err) {
    bool ok = true;
    rewinddir(entries);
    for (const struct dirent *entry; ok && (entry = readdir(entries));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            ok = visit(folder, entry->d_name, user, err);
    return ok;
}

static bool each_file(const char *folder, visit visit, void *user, struct glint_error *err) {
    DIR *entries = opendir(folder);
    if (!entries) return fail_at(folder, err);
    const bool ok = each_entry(entries, folder, visit, user, err);
    closedir(entries);
    return ok;
}

static bool remove_file(const char *folder, const char *name, void *user, struct glint_error *err) {
    char path[PATH_SIZE];
    (void)user;
    return (snprintf(path, sizeof path, "%s/%s", folder, name) < PATH_SIZE && unlink(path) == 0) ||
           fail_at(folder, err);
}

static bool sync_file(const char *folder, const char *name, void *user, struct glint_error *err) {
    char path[PATH_SIZE];
    (void)user;
    const int file =
        snprintf(path, sizeof path, "%s/%s", folder, name) < PATH_SIZE ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    const bool ok = (file >= 0 && fsync(file) == 0) || fail_at(path, err);
    if (file >= 0) close(file);
    return ok;
}

/* Moves a file of .glint-new, run.json and old.json excepted, into the folder. */
static bool move_file(const char *staging, const char *name, void *user, struct glint_error *err) {
    char from[PATH_SIZE], to[PATH_SIZE];
    const char *folder = user;
    if (!strcmp(name, "run.json") || !strcmp(name, "old.json")) return true;
    if (snprintf(from, sizeof from, "%s/%s", staging, name) >= PATH_SIZE ||
        snprintf(to, sizeof to, "%s/%s", folder, name) >= PATH_SIZE)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    return rename(from, to) == 0 || fail_at(to, err);
}

static bool sync_folder(const char *folder, struct glint_error *err) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%.4000s/", folder);
    return glint_path_sync_folder(path) || fail_at(folder, err);
}

static bool rename_in(const char *from, const char *from_name, const char *to, const char *to_name,
                      struct glint_error *err) {
    char source[PATH_SIZE], target[PATH_SIZE];
    snprintf(source, sizeof source, "%.4000s/%s", from, from_name);
    snprintf(target, sizeof target, "%.4000s/%s", to, to_name);
    return rename(source, target) == 0 || fail_at(target, err);
}

/* The images of old.json that run.json in the folder `kept`, if that has one, does not list. */
static bool remove_old_images(const char *folder, const char *staging, const char *kept, struct glint_error *err) {
    char old[PATH_SIZE], record[PATH_SIZE];
    snprintf(old, sizeof old, "%.4000s/old.json", staging);
    snprintf(record, sizeof record, "%.4000s/run.json", kept);
    return run_remove_images(old, is_file(kept, "run.json") ? record : NULL, folder, err);
}

/* Steps 2 and 3. They can be repeated from wherever they ended. `staged`: .glint-new, open. */
static bool move_entries(const char *folder, const char *staging, DIR *staged, struct glint_error *err) {
    const bool replaced = is_file(staging, "old.json");
    bool ok = each_entry(staged, staging, move_file, (void *)folder, err);
    if (replaced) {
        ok = ok && remove_old_images(folder, staging, staging, err) && sync_folder(folder, err) &&
             remove_file(staging, "old.json", NULL, err);
    }
    ok = ok && rename_in(staging, "run.json", folder, "run.json", err) && (!replaced || sync_folder(folder, err));
    if (ok) rmdir(staging);
    return ok;
}

static bool move_in(const char *folder, const char *staging, struct glint_error *err) {
    DIR *staged = opendir(staging);
    const bool ok = staged ? move_entries(folder, staging, staged, err) : fail_at(staging, err);
    if (staged) closedir(staged);
    return ok;
}

static bool has_whole_run(const char *folder, const char *staging) {
    return is_folder(staging) && is_file(staging, "run.json") && !is_file(folder, "run.json");
}

/* What a process left that was killed: a run that only had to be moved is kept, and what is not whole removed, such as the images of a run that was
   being removed. */
static bool clear_staging(const char *folder, const char *staging, struct glint_error *err) {
    struct stat found;
    if (lstat(staging, &found) != 0) return true;
    if (!S_ISDIR(found.st_mode))
        return glint_fail(err, GLINT_ERROR_IO, "%s: expected a folder, found something else", staging);
    if (has_whole_run(folder, staging)) return move_in(folder, staging, err);
    if (is_file(staging, "old.json") && !remove_old_images(folder, staging, folder, err)) return false;
    return each_file(staging, remove_file, NULL, err) && (rmdir(staging) == 0 || fail_at(staging, err));
}

bool run_writer_recover(const char *folder) {
    enum { WAIT_MS = 10, WAITS = 500 };
    char staging[PATH_SIZE];
    if (snprintf(staging, sizeof staging, "%s" NEW, folder) >= PATH_SIZE) return false;
    /* It may be that another process is just moving it. */
    for (int i = 0; i < WAITS && has_whole_run(folder, staging); i++) {
        struct glint_folder_lock *lock = glint_folder_lock(folder, NULL);
        const bool ours = lock && has_whole_run(folder, staging);
        const bool failed = ours && !move_in(folder, staging, NULL);
        glint_folder_unlock(&lock);
        if (failed) return false;
        if (!ours) nanosleep(&(struct timespec){.tv_nsec = WAIT_MS * 1000000}, NULL);
    }
    /* Empty, it is what was left after the last move. */
    struct glint_folder_lock *lock = is_folder(staging) ? glint_folder_lock(folder, NULL) : NULL;
    if (lock) rmdir(staging);
    glint_folder_unlock(&lock);
    return is_file(folder, "run.json");
}

bool glint_run_is_unfinished(const char *folder, bool shot) {
    DIR *entries = is_folder(folder) && !run_writer_recover(folder) ? opendir(folder) : NULL;
    bool unfinished = entries != NULL;
    for (const struct dirent *entry; unfinished && (entry = readdir(entries));) {
        char path[PATH_SIZE];
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, "..") || !strcmp(entry->d_name, &NEW[1])) continue;
        unfinished = shot && snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) < PATH_SIZE &&
                     glint_run_is_unfinished(path, false);
    }
    if (entries) closedir(entries);
    return unfinished;
}

/* run.json moves first, as in a replacement: it says what has to be removed, until everything is. */
bool glint_run_remove(const char *folder, struct glint_error *err) {
    char staging[PATH_SIZE];
    if (snprintf(staging, sizeof staging, "%s" NEW, folder) >= PATH_SIZE)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    if (!clear_staging(folder, staging, err)) return false;
    if (!is_file(folder, "run.json")) return true;
    return (mkdir(staging, 0777) == 0 || fail_at(staging, err)) &&
           rename_in(folder, "run.json", staging, "old.json", err) && clear_staging(folder, staging, err);
}

struct glint_run_writer *glint_run_writer_open(const char *folder, struct glint_error *err) {
    struct glint_run_writer *writer = calloc(1, sizeof *writer);
    if (!writer) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder), NULL;
    const bool fits = snprintf(writer->folder, PATH_SIZE, "%s", folder) < PATH_SIZE - NAME_SIZE;
    snprintf(writer->staging, PATH_SIZE, "%.*s" NEW, PATH_SIZE - NAME_SIZE, folder);
    if (fits) writer->lock = glint_folder_lock(folder, err);
    else glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    if (!writer->lock) glint_run_writer_close(&writer);
    return writer;
}

const char *run_writer_folder(const struct glint_run_writer *writer) {
    return writer->folder;
}

static void end_staging(struct glint_run_writer *writer) {
    if (writer->staged) closedir(writer->staged);
    writer->staged = NULL;
}

const char *glint_run_writer_begin(struct glint_run_writer *writer, struct glint_error *err) {
    end_staging(writer);
    if (!clear_staging(writer->folder, writer->staging, err)) return NULL;
    if (mkdir(writer->staging, 0777) != 0) return fail_at(writer->staging, err), NULL;
    if ((writer->staged = opendir(writer->staging))) return writer->staging;
    fail_at(writer->staging, err);
    rmdir(writer->staging);
    return NULL;
}

static void remove_staging(struct glint_run_writer *writer) {
    if (!writer->staged) return;
    rewinddir(writer->staged);
    for (const struct dirent *entry; (entry = readdir(writer->staged));)
        unlinkat(dirfd(writer->staged), entry->d_name, 0);
    rmdir(writer->staging);
    end_staging(writer);
}

static bool complete(const struct glint_run_writer *writer, bool replaces, struct glint_error *err) {
    return (!replaces || (sync_folder(writer->folder, err) && sync_folder(writer->staging, err))) &&
           move_entries(writer->folder, writer->staging, writer->staged, err);
}

bool glint_run_writer_commit(struct glint_run_writer *writer, struct glint_error *err) {
    const char *folder = writer->folder, *staging = writer->staging;
    const bool replaces = is_file(folder, "run.json");
    if (!writer->staged) return glint_fail(err, GLINT_ERROR_USAGE, "%s: there is no run to put here", folder);
    if (replaces && !(each_file(staging, sync_file, NULL, err) && sync_folder(staging, err) &&
                      rename_in(folder, "run.json", staging, "old.json", err)))
        return false;
    /* From here on nothing can be taken back. If it fails twice, whoever opens the folder next completes it. */
    const bool ok = complete(writer, replaces, NULL) || complete(writer, replaces, err);
    end_staging(writer);
    return ok;
}

void glint_run_writer_close(struct glint_run_writer **pointer) {
    struct glint_run_writer *writer = *pointer;
    *pointer = NULL;
    if (!writer) return;
    remove_staging(writer);
    glint_folder_unlock(&writer->lock);
    free(writer);
}
