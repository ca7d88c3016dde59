/* The cache of files for later processes. */
#include "cache.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <xxhash.h>

#include "glint/replay.h"

enum { PATH_SIZE = 4096, CHUNK = 1 << 20, DIGITS = CACHE_KEY_SIZE - 1, NAME = 2 * DIGITS + 5 };
static const char temporary[] = "tmp-"; /* prefix of the names of incomplete files */

static bool is_entry(const char *name) {
    return strlen(name) == NAME && strspn(name, "0123456789abcdef") == DIGITS && name[DIGITS] == '-' &&
           strspn(name + DIGITS + 1, "0123456789abcdef") == DIGITS && strcmp(name + NAME - 4, ".exr") == 0;
}

static bool join_path(char *path, size_t size, const char *folder, const char *name) {
    return snprintf(path, size, "%s/%s", folder, name) < (int)size;
}

const char *glint_cache_refusal(const char *folder) {
    struct stat info;
    if (lstat(folder, &info) != 0) return errno == ENOENT ? NULL : strerror(errno);
    if (S_ISLNK(info.st_mode)) return "it is a symbolic link";
    if (!S_ISDIR(info.st_mode)) return "it is no folder";
    if (info.st_uid != geteuid()) return "it belongs to another user";
    return info.st_mode & (S_IWGRP | S_IWOTH) ? "others may write to it" : NULL;
}

/* Hashes a file, and also copies it to the descriptor `to` unless that is negative. */
static bool hash_file(const char *path, char hex[CACHE_KEY_SIZE], int to) {
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    XXH3_state_t *state = XXH3_createState();
    char *chunk = malloc(CHUNK);
    ssize_t got = -1;
    bool ok = fd >= 0 && state && chunk && XXH3_128bits_reset(state) == XXH_OK;
    while (ok && (got = read(fd, chunk, CHUNK)) > 0) {
        XXH3_128bits_update(state, chunk, (size_t)got);
        for (ssize_t done = 0, some; to >= 0 && ok && done < got; done += some)
            ok = (some = write(to, chunk + done, (size_t)(got - done))) > 0;
    }
    ok = ok && got == 0;
    const XXH128_hash_t hash = ok ? XXH3_128bits_digest(state) : (XXH128_hash_t){0};
    snprintf(hex, CACHE_KEY_SIZE, "%016llx%016llx", (unsigned long long)hash.high64, (unsigned long long)hash.low64);
    free(chunk);
    XXH3_freeState(state);
    if (fd >= 0) close(fd);
    return ok;
}

/* The path of a key's entry and the hash that its name states. The file itself is not verified. */
static bool find_entry(const char *folder, const char *key, char *path, size_t size, char hash[CACHE_KEY_SIZE]) {
    DIR *entries = glint_cache_refusal(folder) ? NULL : opendir(folder);
    bool found = false;
    for (struct dirent *entry; entries && !found && (entry = readdir(entries));) {
        found = is_entry(entry->d_name) && strncmp(entry->d_name, key, DIGITS) == 0 &&
                join_path(path, size, folder, entry->d_name);
        if (found) snprintf(hash, CACHE_KEY_SIZE, "%.*s", DIGITS, entry->d_name + DIGITS + 1);
    }
    if (entries) closedir(entries);
    return found;
}

bool cache_find(const char *folder, const char *key, char *path, size_t size) {
    char hash[CACHE_KEY_SIZE], found[CACHE_KEY_SIZE];
    if (!find_entry(folder, key, path, size, hash)) return false;
    if (hash_file(path, found, -1) && strcmp(found, hash) == 0) return utimensat(AT_FDCWD, path, NULL, 0) == 0;
    unlink(path);
    return false;
}

/* Copies a file to a temporary file in `folder`. A hard link would not do, since the user may modify the files of a run. */
static bool copy_beside(const char *from, const char *folder, mode_t mode, char path[PATH_SIZE],
                        char hash[CACHE_KEY_SIZE]) {
    if (snprintf(path, PATH_SIZE, "%s/%s%ld", folder, temporary, (long)getpid()) >= PATH_SIZE) return false;
    unlink(path);
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    bool ok = fd >= 0 && hash_file(from, hash, fd);
    if (fd >= 0) ok = close(fd) == 0 && ok;
    if (!ok) unlink(path);
    return ok;
}

bool cache_copy(const char *folder, const char *key, const char *to) {
    char from[PATH_SIZE], path[PATH_SIZE], beside[PATH_SIZE], hash[CACHE_KEY_SIZE], found[CACHE_KEY_SIZE];
    const char *slash = strrchr(to, '/');
    snprintf(beside, sizeof beside, "%.*s", slash ? (int)(slash - to) : 1, slash ? to : ".");
    if (!find_entry(folder, key, from, sizeof from, hash) || !copy_beside(from, beside, 0666, path, found))
        return false;
    if (strcmp(found, hash) == 0 && rename(path, to) == 0) return true;
    unlink(path);
    return false;
}

static bool make_folders(const char *folder) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s", folder);
    for (char *slash = path; (slash = strchr(slash + 1, '/'));) {
        *slash = 0;
        mkdir(path, 0700);
        *slash = '/';
    }
    return mkdir(path, 0700) == 0 || errno == EEXIST;
}

struct entry {
    char name[NAME + 1];
    uint64_t bytes;
    struct timespec used;
};

static int oldest_first(const void *a, const void *b) {
    const struct timespec *x = &((const struct entry *)a)->used, *y = &((const struct entry *)b)->used;
    if (x->tv_sec != y->tv_sec) return x->tv_sec < y->tv_sec ? -1 : 1;
    return (x->tv_nsec > y->tv_nsec) - (x->tv_nsec < y->tv_nsec);
}

/* Removes the least recently used entries, and temporary files that an interrupted process left behind. */
static void trim_folder(const char *folder, uint64_t max_bytes) {
    enum { ENTRIES_MAX = 1 << 14, ABANDONED_SECONDS = 3600 };
    DIR *entries = opendir(folder);
    struct entry *list = calloc(ENTRIES_MAX, sizeof *list);
    size_t count = 0;
    uint64_t bytes = 0;
    char path[PATH_SIZE];
    struct stat file;
    for (struct dirent *entry; entries && list && count < ENTRIES_MAX && (entry = readdir(entries));) {
        if (!join_path(path, sizeof path, folder, entry->d_name) || lstat(path, &file) != 0) continue;
        if (strncmp(entry->d_name, temporary, sizeof temporary - 1) == 0 &&
            file.st_mtim.tv_sec + ABANDONED_SECONDS < time(NULL))
            unlink(path);
        if (!is_entry(entry->d_name)) continue;
        struct entry *one = &list[count++];
        memcpy(one->name, entry->d_name, sizeof one->name);
        one->bytes = (uint64_t)file.st_size;
        one->used = file.st_mtim;
        bytes += one->bytes;
    }
    if (entries) closedir(entries);
    if (list) qsort(list, count, sizeof *list, oldest_first);
    for (size_t i = 0; i < count && bytes > max_bytes; i++)
        if (join_path(path, sizeof path, folder, list[i].name) && unlink(path) == 0) bytes -= list[i].bytes;
    free(list);
}

void cache_store(const char *folder, const char *key, const char *file, uint64_t max_bytes) {
    char hash[CACHE_KEY_SIZE], old[CACHE_KEY_SIZE], name[NAME + 1], copied[PATH_SIZE], path[PATH_SIZE];
    if (!make_folders(folder) || glint_cache_refusal(folder) || !copy_beside(file, folder, 0600, copied, hash)) return;
    while (find_entry(folder, key, path, sizeof path, old) && unlink(path) == 0) {
    }
    snprintf(name, sizeof name, "%s-%s.exr", key, hash);
    if (!join_path(path, sizeof path, folder, name) || rename(copied, path) != 0) unlink(copied);
    trim_folder(folder, max_bytes);
}
