/* Makes a run the baseline, in one atomic step. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "check/check.h"
#include "complete.h"
#include "glint/exr.h"
#include "glint/replay.h"
#include "inside.h"
#include "io/copy.h"
#include "io/memory.h"

enum { PATH_SIZE = 4096 };

static bool fail_at(const char *path, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
}

static bool join(char path[PATH_SIZE], const char *folder, const char *name, struct glint_error *err) {
    return snprintf(path, PATH_SIZE, "%s%s", folder, name) < PATH_SIZE ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

/* {FILE: true} of a run, run.json among them; NULL with an error. */
static json_t *files_of(const char *folder, struct glint_error *err) {
    struct glint_run *run = glint_run_open(folder, err); /* which checks the names */
    json_t *root = run ? json_loads(glint_run_json(run), 0, NULL) : NULL, *files = json_object(), *pass, *image;
    size_t p, i;
    json_object_set_new(files, "run.json", json_true());
    json_array_foreach(json_object_get(root, "passes"), p, pass)
        json_array_foreach(json_object_get(pass, "images"), i, image)
            json_object_set_new(files, json_string_value(json_object_get(image, "file")), json_true());
    if (run && !root) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    if (!root) {
        json_decref(files);
        files = NULL;
    }
    json_decref(root);
    glint_run_close(&run);
    return files;
}

/* The most that a file of a run may have: the bytes of its pixels, which compression never adds to, and room for headers and tables. */
static bool find_most_bytes(const char *path, uint64_t *most, struct glint_error *err) {
    struct glint_exr *exr = glint_exr_open(path, &(struct glint_limits){.no_link = true}, err);
    *most = 1 << 22;
    for (size_t p = 0; exr && p < glint_exr_part_count(exr); p++) {
        const struct glint_exr_part_info *part = glint_exr_part(exr, p);
        uint64_t texel = 0;
        for (size_t c = 0; c < part->channel_count; c++) texel += part->channels[c].stored == GLINT_STORED_HALF ? 2 : 4;
        *most += ((uint64_t)part->width * texel + 32) * part->height;
    }
    const bool ok = exr != NULL;
    glint_exr_close(&exr);
    return ok;
}

static bool copy_file(const char *from, const char *to, struct glint_error *err) {
    uint64_t most = 1 << 22;
    const char *suffix = strrchr(from, '.');
    if (strcmp(suffix ? suffix : "", ".json") != 0 && !find_most_bytes(from, &most, err)) return false;
    return copy_plain(from, to, most, err);
}

static bool copy_into(const char *from, const char *to, const char *name, struct glint_error *err) {
    char source[PATH_SIZE], copy[PATH_SIZE], file[300];
    snprintf(file, sizeof file, "/%.290s", name);
    return join(source, from, file, err) && join(copy, to, file, err) && copy_file(source, copy, err);
}

/* run.json last, and whole: a folder that has it is a whole run. Its names are on the disk as well then. */
static bool copy_run(const char *from, const char *to, const json_t *files, struct glint_error *err) {
    static const char record[] = "run.json";
    char inside[PATH_SIZE], source[PATH_SIZE], copy[PATH_SIZE], last[PATH_SIZE];
    const char *name;
    json_t *value;
    bool ok = join(inside, to, "/", err);
    json_object_foreach((json_t *)files, name, value) {
        if (strcmp(name, record) != 0) ok = ok && copy_into(from, to, name, err);
    }
    return ok && join(source, from, "/run.json", err) && join(copy, to, "/run.json-copy", err) &&
           join(last, to, "/run.json", err) && copy_file(source, copy, err) &&
           (rename(copy, last) == 0 || fail_at(last, err)) && (glint_path_sync_folder(inside) || fail_at(to, err));
}

static bool same_contents(const char *a, const char *b) {
    enum { PIECE = 1 << 16 };
    FILE *first = fopen(a, "rb"), *second = fopen(b, "rb");
    char *one = malloc(PIECE), *other = malloc(PIECE);
    bool same = first && second && one && other;
    for (size_t got = PIECE; same && got == PIECE;) {
        got = fread(one, 1, PIECE, first);
        same = fread(other, 1, PIECE, second) == got && !memcmp(one, other, got) && !ferror(first) && !ferror(second);
    }
    free(one);
    free(other);
    if (first) fclose(first);
    if (second) fclose(second);
    return same;
}

static bool is_same_run(const char *a, const char *b, const json_t *files) {
    const char *name;
    json_t *value;
    bool same = true;
    json_object_foreach((json_t *)files, name, value) {
        char first[PATH_SIZE], second[PATH_SIZE];
        same = same && snprintf(first, PATH_SIZE, "%s/%s", a, name) < PATH_SIZE &&
               snprintf(second, PATH_SIZE, "%s/%s", b, name) < PATH_SIZE && same_contents(first, second);
    }
    return same;
}

/* Refuses folders with files that do not belong to the run, because they would be lost. */
static bool holds_only(const char *folder, const json_t *files, struct glint_error *err) {
    DIR *directory = opendir(folder);
    if (!directory) return fail_at(folder, err);
    bool ok = true;
    for (struct dirent *entry; ok && (entry = readdir(directory)) != NULL;)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 &&
            !json_object_get(files, entry->d_name))
            ok = glint_fail(
                err, GLINT_ERROR_IO,
                "%s: %s does not belong to this run and would be moved by --approve; move it elsewhere first", folder,
                entry->d_name);
    closedir(directory);
    return ok;
}

static void remove_files(const char *folder, const json_t *files) {
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)files, name, value) {
        char path[PATH_SIZE];
        if (snprintf(path, sizeof path, "%s/%s", folder, name) < PATH_SIZE) unlink(path);
    }
    rmdir(folder);
}

/* Removes the previous backup. */
static bool clear_kept(const char *kept, struct glint_error *err) {
    if (access(kept, F_OK) != 0) return true;
    json_t *files = files_of(kept, err);
    const bool ok = files && holds_only(kept, files, err);
    if (ok) remove_files(kept, files);
    json_decref(files);
    return ok;
}

/* The new folder takes the old one's name, which becomes `kept`. Where a file system cannot exchange two names, there is a
   moment in which neither has it, and both are there. */
static bool exchange(const char *fresh, const char *baseline, const char *kept, struct glint_error *err) {
    const bool swapped = renameat2(AT_FDCWD, fresh, AT_FDCWD, baseline, RENAME_EXCHANGE) == 0;
    if (!swapped && errno != EINVAL && errno != ENOSYS) return fail_at(baseline, err);
    if (rename(swapped ? fresh : baseline, kept) != 0) {
        fail_at(kept, err);
        if (swapped) renameat2(AT_FDCWD, fresh, AT_FDCWD, baseline, RENAME_EXCHANGE);
        return false;
    }
    if (swapped || rename(fresh, baseline) == 0) return true;
    fail_at(baseline, err);
    return rename(kept, baseline), false;
}

static bool replace(const char *fresh, const char *baseline, const char *kept, struct glint_error *err) {
    if (access(baseline, F_OK) != 0 || rmdir(baseline) == 0)
        return rename(fresh, baseline) == 0 || fail_at(baseline, err);
    json_t *files = files_of(baseline, err);
    const bool ok =
        files && holds_only(baseline, files, err) && clear_kept(kept, err) && exchange(fresh, baseline, kept, err);
    json_decref(files);
    return ok;
}

static bool remove_contents(DIR *entries, const char *folder, struct glint_error *err) {
    bool ok = true;
    rewinddir(entries);
    for (const struct dirent *entry; (entry = readdir(entries));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 &&
            unlinkat(dirfd(entries), entry->d_name, 0) != 0)
            ok = fail_at(folder, err);
    return ok;
}

/* Whether the folder has not been moved elsewhere. */
static bool has_name(DIR *entries, const char *folder) {
    struct stat opened, named;
    return fstat(dirfd(entries), &opened) == 0 && lstat(folder, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

/* Locks the folder of the copy and opens it, so that it can be removed without memory or another descriptor. Clears what a process left there that was
   killed: the old baseline, if that has its place neither as the baseline nor as the one before it (between the two steps of `exchange`), or a copy
   that is of no use any more. */
static struct glint_folder_lock *begin_copy(const char *fresh, const char *kept, DIR **entries,
                                            struct glint_error *err) {
    char record[PATH_SIZE];
    struct glint_folder_lock *lock = join(record, fresh, "/run.json", err) ? glint_folder_lock(fresh, err) : NULL;
    if (lock && access(record, F_OK) == 0 && access(kept, F_OK) != 0) {
        const bool moved = rename(fresh, kept) == 0 || fail_at(kept, err);
        glint_folder_unlock(&lock);
        if (moved) lock = glint_folder_lock(fresh, err);
    }
    *entries = lock ? opendir(fresh) : NULL;
    if (lock && !*entries) fail_at(fresh, err);
    if (lock && !(*entries && remove_contents(*entries, fresh, err))) glint_folder_unlock(&lock);
    return lock;
}

/* The locks are on the folders themselves, and so go with them where they are renamed: nobody else approves anything as this baseline until both have
   their places. */
static bool approve(const char *run, const char *baseline, const json_t *files, struct glint_error *err) {
    char fresh[PATH_SIZE], kept[PATH_SIZE];
    if (!join(fresh, baseline, ".new~", err) || !join(kept, baseline, "~", err)) return false;
    DIR *entries = NULL;
    struct glint_folder_lock *lock = begin_copy(fresh, kept, &entries, err), *old = NULL;
    bool ok = lock && (access(baseline, F_OK) != 0 || (old = glint_folder_lock(baseline, err))) &&
              copy_run(run, fresh, files, err);
    if (ok && memory_ran_out())
        ok = glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", run); /* a file may lack */
    /* The one before stays what it is if this run is approved twice, as it is after an interruption. */
    const bool again = ok && is_same_run(fresh, baseline, files);
    ok = ok && (again || replace(fresh, baseline, kept, err)) &&
         (glint_path_sync_folder(baseline) || fail_at(baseline, err));
    if (lock && (again || !ok) && has_name(entries, fresh) && remove_contents(entries, fresh, NULL)) rmdir(fresh);
    if (entries) closedir(entries);
    glint_folder_unlock(&old);
    glint_folder_unlock(&lock);
    return ok;
}

bool check_approve(const char *run, const char *baseline, struct glint_error *err) {
    char path[PATH_SIZE];
    size_t length = strlen(baseline);
    while (length > 1 && baseline[length - 1] == '/') length--;
    snprintf(path, sizeof path, "%.*s", (int)length, baseline);
    struct stat from, to;
    if (length >= sizeof path) return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", baseline);
    if (stat(run, &from) == 0 && stat(path, &to) == 0 && from.st_dev == to.st_dev && from.st_ino == to.st_ino)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: run and baseline are the same folder", run);
    struct glint_folder_lock *lock = glint_folder_lock_shared(run, err); /* so that its files belong together */
    json_t *files = lock ? files_of(run, err) : NULL;
    const bool ok = files && approve(run, path, files, err);
    json_decref(files);
    glint_folder_unlock(&lock);
    return ok;
}
