/* The cache of files for later processes. No lock is needed for it to be correct: files get their names when they are complete, contents are
   verified by their hash, and whoever finds that a file is gone goes on as if it had never been there. */
#include "glint/cache.h"

#include <ctype.h>
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

enum {
    PATH_SIZE = 4096,
    CHUNK = 1 << 20,
    DIGITS = GLINT_CACHE_KEY_SIZE - 1,
    STEM = 2 * DIGITS + 1,
    EXTENSION = 8,
    LEFTOVER_SECONDS = 24 * 60 * 60
};

/* "KEY-HASH", and an extension or none. */
static bool is_entry(const char *name) {
    const size_t length = strlen(name);
    return length >= STEM && length <= STEM + EXTENSION && strspn(name, "0123456789abcdef") == DIGITS &&
           name[DIGITS] == '-' && strspn(name + DIGITS + 1, "0123456789abcdef") == DIGITS &&
           (length == STEM || name[STEM] == '.');
}

/* A temporary file of any machine. */
static bool is_temporary(const char *name) {
    const char *mark = strstr(name, GLINT_TEMPORARY);
    return mark && mark > name && strspn(name, "0123456789abcdef") == (size_t)(mark - name) &&
           strspn(mark + strlen(GLINT_TEMPORARY), "0123456789abcdef") == GLINT_TEMPORARY_DIGITS;
}

static bool join_path(char *path, size_t size, const char *folder, const char *name) {
    return snprintf(path, size, "%s/%s", folder, name) < (int)size;
}

/* What the folder may hold by $GLINT_CACHE_GIB, or 0 if that is no size. */
static uint64_t limit_bytes(void) {
    enum { USUAL_GIB = 4, MOST_GIB = 1 << 30 };
    const char *text = getenv("GLINT_CACHE_GIB");
    char *end;
    if (!text || !text[0]) return (uint64_t)USUAL_GIB << 30;
    const unsigned long value = strtoul(text, &end, 10);
    return isdigit((unsigned char)text[0]) && !*end && value <= MOST_GIB ? (uint64_t)value << 30 : 0;
}

const char *glint_cache_refusal(const char *folder) {
    struct stat info;
    if (!limit_bytes()) return "GLINT_CACHE_GIB: expected whole GiB from 1 on";
    if (lstat(folder, &info) != 0) return errno == ENOENT ? NULL : strerror(errno);
    if (S_ISLNK(info.st_mode)) return "it is a symbolic link";
    if (!S_ISDIR(info.st_mode)) return "it is no folder";
    if (info.st_uid != geteuid()) return "it belongs to another user";
    return info.st_mode & (S_IWGRP | S_IWOTH) ? "others may write to it" : NULL;
}

uint64_t glint_cache_processor(void) {
    static const char *const of_model[] = {"model name", "flags", "CPU implementer", "CPU part", "Features", "isa"};
    FILE *file = fopen("/proc/cpuinfo", "re");
    char line[8192];
    uint64_t hash = 0;
    while (file && fgets(line, sizeof line, file) && line[0] != '\n') /* the first of them */
        for (size_t i = 0; i < sizeof of_model / sizeof *of_model; i++)
            if (strncmp(line, of_model[i], strlen(of_model[i])) == 0)
                hash = XXH3_64bits_withSeed(line, strlen(line), hash);
    if (file) fclose(file);
    return hash;
}

/* The descriptor of a file that can be read, or -1: not of a pipe, which would have us wait, nor of a symbolic link. */
static int open_file(const char *path) {
    struct stat found;
    const int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0 || (fstat(fd, &found) == 0 && S_ISREG(found.st_mode) && (uint64_t)found.st_size <= limit_bytes()))
        return fd;
    close(fd);
    return -1;
}

/* Hashes the key and the contents of a file, and also copies these to `to` unless that is GLINT_NO_FILE. With the key in the hash an entry under
   another key's name is a damaged one. */
static bool hash_file(const char *path, const char *key, char hex[GLINT_CACHE_KEY_SIZE], glint_file to) {
    const int fd = open_file(path);
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
    snprintf(hex, GLINT_CACHE_KEY_SIZE, "%016llx%016llx", (unsigned long long)hash.high64,
             (unsigned long long)hash.low64);
    free(chunk);
    XXH3_freeState(state);
    if (fd >= 0) close(fd);
    return ok;
}

/* Whether a hash is the one in the name of an entry. */
static bool states_hash(const char *path, const char hash[GLINT_CACHE_KEY_SIZE]) {
    return strncmp(path + glint_path_folder(path) + DIGITS + 1, hash, DIGITS) == 0;
}

/* What cannot be read for other reasons, such as a server that does not answer, stays. */
static bool is_intact(const char *path, const char *key) {
    char hash[GLINT_CACHE_KEY_SIZE];
    if (!hash_file(path, key, hash, GLINT_NO_FILE)) return false;
    if (states_hash(path, hash)) return true;
    unlink(path);
    return false;
}

/* Two processes that store at the same moment may leave two entries of a key, which differ in what does not depend on it, such as times. */
bool glint_cache_find(const char *folder, const char *key, char *path, size_t size) {
    DIR *entries = glint_cache_refusal(folder) ? NULL : opendir(folder);
    bool found = false;
    for (const struct dirent *entry; entries && !found && (entry = readdir(entries));)
        found = is_entry(entry->d_name) && strncmp(entry->d_name, key, DIGITS) == 0 &&
                join_path(path, size, folder, entry->d_name) && is_intact(path, key);
    if (entries) closedir(entries);
    if (found) utimensat(AT_FDCWD, path, NULL, 0); /* the time of the file system's server, not of this machine */
    return found;
}

/* A hard link would not do, since the user may modify the files of a run. */
bool glint_cache_copy(const char *folder, const char *key, const char *to) {
    char from[PATH_SIZE], hash[GLINT_CACHE_KEY_SIZE];
    struct complete_file copy;
    if (!glint_cache_find(folder, key, from, sizeof from) || !complete_open(&copy, to, NULL)) return false;
    const bool same = hash_file(from, key, hash, copy.file) && states_hash(from, hash);
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
    char name[STEM + EXTENSION + 1];
    uint64_t bytes;
    struct timespec used;
};
struct entries {
    struct entry *list;
    size_t count, capacity;
    uint64_t bytes;
};

static int oldest_first(const void *a, const void *b) {
    const struct timespec *x = &((const struct entry *)a)->used, *y = &((const struct entry *)b)->used;
    if (x->tv_sec != y->tv_sec) return x->tv_sec < y->tv_sec ? -1 : 1;
    return (x->tv_nsec > y->tv_nsec) - (x->tv_nsec < y->tv_nsec);
}

static bool add_entry(struct entries *entries, const char *name, const struct stat *file) {
    if (entries->count == entries->capacity) {
        const size_t capacity = entries->capacity ? 2 * entries->capacity : 256;
        struct entry *list = realloc(entries->list, capacity * sizeof *list);
        if (!list) return false;
        entries->list = list;
        entries->capacity = capacity;
    }
    struct entry *entry = &entries->list[entries->count++];
    memcpy(entry->name, name, strlen(name) + 1); /* which is_entry measured */
    entry->bytes = (uint64_t)file->st_size;
    entry->used = file->st_mtim;
    entries->bytes += entry->bytes;
    return true;
}

/* Removes the least recently used entries, and temporary files that nobody has written to for a day before `now`: only their own machine knows
   whether they are in use. An entry that another process removed meanwhile counts as removed; else several of them would remove too many. */
static void trim_folder(const char *folder, uint64_t max_bytes, time_t now) {
    struct entries entries = {0};
    struct stat file;
    DIR *names = opendir(folder);
    bool ok = names != NULL;
    for (const struct dirent *name; ok && (name = readdir(names));) {
        const bool entry = is_entry(name->d_name);
        if ((!entry && !is_temporary(name->d_name)) ||
            fstatat(dirfd(names), name->d_name, &file, AT_SYMLINK_NOFOLLOW) != 0)
            continue;
        if (entry) ok = add_entry(&entries, name->d_name, &file);
        else if (file.st_mtim.tv_sec < now - LEFTOVER_SECONDS) unlinkat(dirfd(names), name->d_name, 0);
    }
    if (ok && entries.count) qsort(entries.list, entries.count, sizeof *entries.list, oldest_first);
    for (size_t i = 0; ok && i < entries.count && entries.bytes > max_bytes; i++)
        if (unlinkat(dirfd(names), entries.list[i].name, 0) == 0 || errno == ENOENT)
            entries.bytes -= entries.list[i].bytes;
    if (names) closedir(names);
    free(entries.list);
}

/* Temporary files are named after the running system, among whose processes a lock tells which of them are in use. On some network file systems it
   does not tell that to other machines. */
static void name_system(char name[GLINT_CACHE_KEY_SIZE]) {
    char text[320] = "", id[64] = "";
    FILE *file = fopen("/proc/sys/kernel/random/boot_id", "re");
    if (file && !fgets(id, sizeof id, file)) id[0] = 0;
    if (file) fclose(file);
    gethostname(text, sizeof text - sizeof id - 1);
    strcat(text, id);
    const XXH128_hash_t hash = XXH3_128bits(text, strlen(text));
    snprintf(name, GLINT_CACHE_KEY_SIZE, "%016llx%016llx", (unsigned long long)hash.high64,
             (unsigned long long)hash.low64);
}

/* Whose hash becomes part of its name while it is copied. */
static bool store_entry(const char *folder, const char *key, const char *file, char path[PATH_SIZE]) {
    char hash[GLINT_CACHE_KEY_SIZE], name[STEM + EXTENSION + 1];
    struct complete_file copy;
    const char *dot = strrchr(file + glint_path_folder(file), '.');
    name_system(name);
    if (!join_path(path, PATH_SIZE, folder, name) || !complete_open_secret(&copy, path, NULL)) return false;
    bool ok = hash_file(file, key, hash, copy.file);
    snprintf(name, sizeof name, "%s-%s%s", key, hash, dot && strlen(dot) <= EXTENSION ? dot : "");
    ok = ok && join_path(path, PATH_SIZE, folder, name);
    return complete_close(&copy, ok, false, NULL);
}

void glint_cache_store(const char *folder, const char *key, const char *file, uint64_t max_bytes) {
    const uint64_t most = max_bytes ? max_bytes : limit_bytes();
    char path[PATH_SIZE];
    struct stat info;
    if (stat(file, &info) != 0 || (uint64_t)info.st_size > most || !make_folders(folder) ||
        glint_cache_refusal(folder) || glint_cache_find(folder, key, path, sizeof path))
        return;
    if (store_entry(folder, key, file, path) && lstat(path, &info) == 0) trim_folder(folder, most, info.st_mtim.tv_sec);
}
