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
#include "glint/exr.h"
#include "glint/replay.h"
#include "inside.h"
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

static bool write_all(int file, const char *bytes, size_t size) {
    while (size > 0) {
        const ssize_t count = write(file, bytes, size);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes += count;
        size -= (size_t)count;
    }
    return true;
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
    static const size_t size = 1 << 20;
    uint64_t most = 1 << 22, bytes;
    glint_file in;
    const char *suffix = strrchr(from, '.');
    if (strcmp(suffix ? suffix : "", ".json") != 0 && !find_most_bytes(from, &most, err)) return false;
    if (!inside_open(&in, from, most, &bytes, err)) return false;
    const int out = open(to, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    char *block = malloc(size);
    bool ok = block || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok && out < 0) ok = fail_at(to, err);
    for (uint64_t done = 0; ok && done < bytes;) {
        size_t count = bytes - done < size ? (size_t)(bytes - done) : size;
        ok = glint_file_read(in, block, count, done, &count) || fail_at(from, err);
        if (ok && !count) ok = glint_fail(err, GLINT_ERROR_IO, "%s: it shrinks", from);
        ok = ok && (write_all(out, block, count) || fail_at(to, err));
        done += count;
    }
    if (ok && fsync(out) != 0) ok = fail_at(to, err);
    if (out >= 0 && close(out) != 0 && ok) ok = fail_at(to, err);
    glint_file_close(in);
    free(block);
    return ok;
}

static bool copy_run(const char *from, const char *to, const json_t *files, struct glint_error *err) {
    const char *name;
    json_t *value;
    bool ok = glint_make_folder(to, err);
    json_object_foreach((json_t *)files, name, value) {
        char source[PATH_SIZE], copy[PATH_SIZE], file[300];
        snprintf(file, sizeof file, "/%.290s", name);
        ok = ok && join(source, from, file, err) && join(copy, to, file, err) && copy_file(source, copy, err);
    }
    return ok;
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

/* Whether a folder contains only these files. */
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

static bool replace(const char *fresh, const char *baseline, struct glint_error *err) {
    char kept[PATH_SIZE];
    if (access(baseline, F_OK) != 0 || rmdir(baseline) == 0)
        return rename(fresh, baseline) == 0 || fail_at(baseline, err);
    json_t *files = files_of(baseline, err);
    const bool ok = files && holds_only(baseline, files, err) && join(kept, baseline, "~", err) &&
                    clear_kept(kept, err) && exchange(fresh, baseline, kept, err);
    json_decref(files);
    return ok;
}

bool check_approve(const char *run, const char *baseline, struct glint_error *err) {
    char path[PATH_SIZE], fresh[PATH_SIZE], suffix[32];
    size_t length = strlen(baseline);
    while (length > 1 && baseline[length - 1] == '/') length--;
    snprintf(path, sizeof path, "%.*s", (int)length, baseline);
    snprintf(suffix, sizeof suffix, ".tmp-%ld", (long)getpid());
    struct stat from, to;
    if (length >= sizeof path || !join(fresh, path, suffix, err))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", baseline);
    if (stat(run, &from) == 0 && stat(path, &to) == 0 && from.st_dev == to.st_dev && from.st_ino == to.st_ino)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: run and baseline are the same folder", run);
    json_t *files = files_of(run, err);
    bool ok = files && copy_run(run, fresh, files, err);
    if (ok && memory_ran_out())
        ok = glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", run); /* a file may lack */
    ok = ok && replace(fresh, path, err);
    if (!ok && files) remove_files(fresh, files);
    json_decref(files);
    return ok;
}
