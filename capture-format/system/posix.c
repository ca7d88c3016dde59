/* system.h for POSIX. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "system.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

glint_file glint_file_open(const char *path) {
    return open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
}

glint_file glint_file_open_unlinked(const char *path) {
    return open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
}

glint_file glint_file_create(const char *path) {
    return open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

/* Who uses a temporary file holds a lock on it, which ends with the process. One that cannot be locked for other reasons, as on some network
   file systems, is not removed by others either. */
static bool is_locked_by_others(int file) {
    return flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

glint_file glint_file_create_temporary(const char *path, bool secret) {
    struct stat found;
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, secret ? 0600 : 0666);
    if (file < 0) return GLINT_NO_FILE;
    /* Before it was locked another process may have taken it for one that nobody uses. */
    if (!is_locked_by_others(file) && fstat(file, &found) == 0 && found.st_nlink > 0) return file;
    close(file);
    errno = EEXIST;
    return GLINT_NO_FILE;
}

bool glint_file_close(glint_file file) {
    return close((int)file) == 0;
}

/* Network file systems report at the first close what they could not write; the second descriptor keeps the lock. */
bool glint_file_close_as(glint_file file, const char *from, const char *to) {
    const int locked = fcntl((int)file, F_DUPFD_CLOEXEC, 0);
    const bool ok = close((int)file) == 0 && rename(from, to) == 0;
    const int reason = errno;
    if (locked >= 0) close(locked);
    errno = reason;
    return ok;
}

bool glint_file_read(glint_file file, void *buffer, size_t size, uint64_t offset, size_t *got) {
    *got = 0;
    while (*got < size) {
        const ssize_t step = pread((int)file, (char *)buffer + *got, size - *got, (off_t)(offset + *got));
        if (step < 0 && errno == EINTR) continue;
        if (step < 0) return false;
        if (step == 0) break;
        *got += (size_t)step;
    }
    return true;
}

bool glint_file_write(glint_file file, const void *buffer, size_t size, uint64_t offset) {
    for (size_t done = 0; done < size;) {
        const ssize_t step = pwrite((int)file, (const char *)buffer + done, size - done, (off_t)(offset + done));
        if (step < 0 && errno == EINTR) continue;
        if (step == 0) errno = ENOSPC;
        if (step <= 0) return false;
        done += (size_t)step;
    }
    return true;
}

bool glint_file_sync(glint_file file) {
    int done;
    do done = fsync((int)file);
    while (done != 0 && errno == EINTR);
    return done == 0;
}

static void describe(const struct stat *from, struct glint_file_info *info) {
    *info = (struct glint_file_info){.kind = S_ISREG(from->st_mode)   ? GLINT_FILE_REGULAR
                                             : S_ISDIR(from->st_mode) ? GLINT_FILE_FOLDER
                                                                      : GLINT_FILE_OTHER,
                                     .bytes = (uint64_t)from->st_size,
                                     .device = (uint64_t)from->st_dev,
                                     .number = (uint64_t)from->st_ino};
}

bool glint_file_describe(glint_file file, struct glint_file_info *info) {
    struct stat found;
    if (fstat((int)file, &found)) return false;
    describe(&found, info);
    return true;
}

bool glint_path_describe(const char *path, struct glint_file_info *info) {
    struct stat found;
    if (stat(path, &found)) return false;
    describe(&found, info);
    return true;
}

bool glint_path_replace(const char *from, const char *to) {
    return rename(from, to) == 0;
}

bool glint_path_remove(const char *path) {
    return unlink(path) == 0;
}

/* Also what is written as a temporary file of a temporary file. */
static bool is_temporary(const char *name, const char *of) {
    static const size_t mark = sizeof GLINT_TEMPORARY - 1, tail = sizeof GLINT_TEMPORARY - 1 + GLINT_TEMPORARY_DIGITS;
    const size_t whole = strlen(name);
    size_t length = whole;
    while (length > tail && !strncmp(name + length - tail, GLINT_TEMPORARY, mark) &&
           strspn(name + length - tail + mark, "0123456789abcdef") == GLINT_TEMPORARY_DIGITS)
        length -= tail;
    return length < whole && (!*of || (strlen(of) == length && !strncmp(name, of, length)));
}

/* The folder of the path, opened, or -1. */
static int open_folder(const char *path) {
    const size_t length = glint_path_folder(path);
    char *folder = length ? strndup(path, length) : strdup(".");
    const int file = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    free(folder);
    return file;
}

void glint_path_remove_temporaries(const char *path) {
    const int folder = open_folder(path);
    DIR *entries = folder >= 0 ? fdopendir(folder) : NULL;
    struct stat found;
    if (!entries && folder >= 0) close(folder);
    for (const struct dirent *entry; entries && (entry = readdir(entries));) {
        if (!is_temporary(entry->d_name, path + glint_path_folder(path))) continue;
        const int file = openat(folder, entry->d_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (file >= 0 && fstat(file, &found) == 0 && S_ISREG(found.st_mode) && flock(file, LOCK_EX | LOCK_NB) == 0)
            unlinkat(folder, entry->d_name, 0);
        if (file >= 0) close(file);
    }
    if (entries) closedir(entries);
}

/* File systems that cannot do it say EINVAL; a folder that we may write but not read cannot be opened. */
bool glint_path_sync_folder(const char *path) {
    const int folder = open_folder(path);
    if (folder < 0) return errno == EACCES;
    const bool ok = fsync(folder) == 0 || errno == EINVAL;
    const int reason = errno;
    close(folder);
    errno = reason;
    return ok;
}

bool glint_path_create_folder(const char *path) {
    return mkdir(path, 0777) == 0;
}

size_t glint_path_folder(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

long glint_process_id(void) {
    return (long)getpid();
}

uint32_t glint_random(void) {
    uint32_t number;
    struct timespec now;
    if (getrandom(&number, sizeof number, GRND_NONBLOCK) == sizeof number) return number;
    clock_gettime(CLOCK_MONOTONIC, &now); /* just after the machine has started */
    return (uint32_t)now.tv_nsec * 2654435761U ^ (uint32_t)getpid();
}

/* ---- Threads ---- */

static void *run_thread(void *user) {
    const struct glint_thread *thread = user;
    thread->work(thread->user);
    return NULL;
}

bool glint_thread_start(struct glint_thread *thread, void (*work)(void *user), void *user) {
    thread->work = work;
    thread->user = user;
    return pthread_create(&thread->handle, NULL, run_thread, thread) == 0;
}

void glint_thread_join(struct glint_thread *thread) {
    pthread_join(thread->handle, NULL);
}

uint32_t glint_cores(void) {
    cpu_set_t own; /* of a machine's cores a job of a cluster may have few */
    if (sched_getaffinity(0, sizeof own, &own) == 0) return (uint32_t)CPU_COUNT(&own);
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 1 ? 1 : (uint32_t)cores;
}

void glint_mutex_init(glint_mutex *mutex) {
    pthread_mutex_init(mutex, NULL);
}
void glint_mutex_finish(glint_mutex *mutex) {
    pthread_mutex_destroy(mutex);
}
void glint_mutex_lock(glint_mutex *mutex) {
    pthread_mutex_lock(mutex);
}
void glint_mutex_unlock(glint_mutex *mutex) {
    pthread_mutex_unlock(mutex);
}

void glint_condition_init(glint_condition *condition) {
    pthread_cond_init(condition, NULL);
}
void glint_condition_finish(glint_condition *condition) {
    pthread_cond_destroy(condition);
}
void glint_condition_wait(glint_condition *condition, glint_mutex *mutex) {
    pthread_cond_wait(condition, mutex);
}
void glint_condition_wake_all(glint_condition *condition) {
    pthread_cond_broadcast(condition);
}
