/* The cache of files for later processes. */
#include "cache.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <xxhash.h>

#include "complete.h"
#include "glint/replay.h"

enum { PATH_SIZE = 4096, CHUNK = 1 << 20, DIGITS = CACHE_KEY_SIZE - 1, NAME = 2 * DIGITS + 5 };

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

/* The descriptor of a file that can be read, or -1: not of a pipe, which would have us wait, nor of a symbolic link. */
static int open_entry(const char *path) {
    struct stat found;
    const int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0 || (fstat(fd, &found) == 0 && S_ISREG(found.st_mode) && found.st_size <= (off_t)CACHE_BYTES_MAX))
        return fd;
    close(fd);
    return -1;
}

/* Hashes the key and the contents of a file, and also copies these to `to` unless that is GLINT_NO_FILE. With the key in the hash an entry under
   another key's name is a damaged one. */
static bool hash_file(const char *path, const char *key, char hex[CACHE_KEY_SIZE], glint_file to) {
    const int fd = open_entry(path);
    XXH3_state_t *state = XXH3_createState();
    char *chunk = malloc(CHUNK);
    uint64_t done = 0;
    size_t got = CHUNK;
    bool ok = fd >= 0 && state && chunk && XXH3_128bits_reset(state) == XXH_OK &&
              XXH3_128bits_update(state, key, DIGITS) == XXH_OK;
    for (; ok && got == CHUNK; done += got) {
        ok = glint_file_read(fd, chunk, CHUNK, done, &got) && XXH3_128bits_update(state, chunk, got) == XXH_OK &&
             (to == GLINT_NO_FILE || glint_file_write(to, chunk, got, done));
    }
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
    if (hash_file(path, key, found, GLINT_NO_FILE) && strcmp(found, hash) == 0)
        return utimensat(AT_FDCWD, path, NULL, 0) == 0;
    unlink(path);
    return false;
}

/* A hard link would not do, since the user may modify the files of a run. */
bool cache_copy(const char *folder, const char *key, const char *to) {
    char from[PATH_SIZE], hash[CACHE_KEY_SIZE], found[CACHE_KEY_SIZE];
    struct complete_file copy;
    if (!find_entry(folder, key, from, sizeof from, hash) || !complete_open(&copy, to, NULL)) return false;
    const bool same = hash_file(from, key, found, copy.file) && strcmp(found, hash) == 0;
    return complete_close(&copy, same, false, NULL);
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

/* Removes the least recently used entries. */
static void trim_folder(const char *folder, uint64_t max_bytes) {
    enum { ENTRIES_MAX = 1 << 14 };
    DIR *entries = opendir(folder);
    struct entry *list = calloc(ENTRIES_MAX, sizeof *list);
    size_t count = 0;
    uint64_t bytes = 0;
    char path[PATH_SIZE];
    struct stat file;
    for (struct dirent *entry; entries && list && count < ENTRIES_MAX && (entry = readdir(entries));) {
        if (!is_entry(entry->d_name) || !join_path(path, sizeof path, folder, entry->d_name) || lstat(path, &file) != 0)
            continue;
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

/* Whose hash becomes part of its name while it is copied. */
static bool store_entry(const char *folder, const char *key, const char *file) {
    char hash[CACHE_KEY_SIZE], old[CACHE_KEY_SIZE], name[NAME + 1], path[PATH_SIZE], found[PATH_SIZE];
    struct complete_file copy;
    if (!join_path(path, sizeof path, folder, key) || !complete_open_secret(&copy, path, NULL)) return false;
    bool ok = hash_file(file, key, hash, copy.file);
    while (ok && find_entry(folder, key, found, sizeof found, old) && unlink(found) == 0) continue;
    snprintf(name, sizeof name, "%s-%s.exr", key, hash);
    ok = ok && join_path(path, sizeof path, folder, name);
    return complete_close(&copy, ok, false, NULL);
}

void cache_store(const char *folder, const char *key, const char *file, uint64_t max_bytes) {
    char inside[PATH_SIZE];
    if (!make_folders(folder) || glint_cache_refusal(folder) || !join_path(inside, sizeof inside, folder, "")) return;
    glint_path_remove_temporaries(inside);
    if (store_entry(folder, key, file)) trim_folder(folder, max_bytes);
}
