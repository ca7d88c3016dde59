/* Waits for changes of files by polling ten times a second, which works on every file system and with editors that
   write a new file and rename it. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <xxhash.h>

#include "watch/watch.h"

static bool append(char ***list, size_t *count, char *text, struct glint_error *err) {
    char **larger = text ? realloc(*list, (*count + 1) * sizeof *larger) : NULL;
    if (!larger) {
        free(text);
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    }
    larger[(*count)++] = text;
    *list = larger;
    return true;
}

/* The folder of a path, malloc'd. */
static char *folder_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? strndup(path, (size_t)(slash - path + 1)) : strdup("./");
}

static bool add_folders_below(struct watch_files *files, const char *folder, struct glint_error *err) {
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, NULL, alphasort);
    bool ok = append(&files->folders, &files->folder_count, strdup(folder), err);
    for (int i = 0; i < count; i++) {
        char *path = NULL;
        struct stat info;
        if (ok && entries[i]->d_name[0] != '.' && asprintf(&path, "%s/%s", folder, entries[i]->d_name) >= 0) {
            if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
                ok = append(&files->folders, &files->folder_count, path, err);
            else free(path);
        }
        free(entries[i]);
    }
    free(entries);
    return ok;
}

/* ---- State of the files ---- */

/* Hashes attributes that change with the contents and are cheap to read. */
static void add_file(XXH64_state_t *hash, const char *path) {
    struct stat info;
    XXH64_update(hash, path, strlen(path));
    if (stat(path, &info) != 0) return;
    XXH64_update(hash, &info.st_mtim, sizeof info.st_mtim);
    XXH64_update(hash, &info.st_size, sizeof info.st_size);
    XXH64_update(hash, &info.st_ino, sizeof info.st_ino);
}

static bool is_source(const char *name) {
    static const char *const ends[] = {".comp", ".glsl", ".h", ".json"};
    const char *end = strrchr(name, '.');
    for (size_t i = 0; end && i < sizeof ends / sizeof *ends; i++)
        if (!strcmp(end, ends[i])) return true;
    return false;
}

static void add_folder(XXH64_state_t *hash, const char *folder) {
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        char *path = NULL;
        if (is_source(entries[i]->d_name) && asprintf(&path, "%s/%s", folder, entries[i]->d_name) >= 0) {
            add_file(hash, path);
            free(path);
        }
        free(entries[i]);
    }
    free(entries);
}

static uint64_t state_of(const struct watch_files *files) {
    XXH64_state_t *hash = XXH64_createState();
    if (!hash) return files->state;
    XXH64_reset(hash, 0);
    for (size_t i = 0; i < files->file_count; i++) add_file(hash, files->files[i]);
    for (size_t i = 0; i < files->folder_count; i++) add_folder(hash, files->folders[i]);
    const uint64_t state = XXH64_digest(hash);
    XXH64_freeState(hash);
    return state;
}

bool watch_files_init(struct watch_files *files, const struct pipeline_args *args, struct glint_error *err) {
    const char *const names[] = {getenv("GLINT_PASSES"), getenv("GLINT_PRESETS")};
    *files = (struct watch_files){0};
    bool ok = !args->preset || append(&files->files, &files->file_count, strdup(args->preset), err);
    for (size_t i = 0; ok && i < args->shader.count; i++) {
        const char *path = strchr(args->shader.items[i], '=');
        if (path)
            ok = append(&files->files, &files->file_count, strdup(path + 1), err) &&
                 append(&files->folders, &files->folder_count, folder_of(path + 1), err);
    }
    for (size_t i = 0; ok && i < 2; i++)
        if (names[i] && names[i][0]) ok = add_folders_below(files, names[i], err);
    files->state = state_of(files);
    return ok;
}

void watch_files_finish(struct watch_files *files) {
    for (size_t i = 0; i < files->file_count; i++) free(files->files[i]);
    for (size_t i = 0; i < files->folder_count; i++) free(files->folders[i]);
    free(files->files);
    free(files->folders);
    *files = (struct watch_files){0};
}

bool watch_files_wait(struct watch_files *files, bool (*ended)(void *user), void *user) {
    const struct timespec tenth = {.tv_nsec = 100000000};
    const uint64_t known = files->state;
    for (uint64_t before = known; !ended(user);) {
        const uint64_t now = state_of(files);
        files->state = now;
        if (now != known && now == before) return true; /* unchanged since the last poll, so completely written */
        before = now;
        nanosleep(&tenth, NULL);
    }
    return false;
}
