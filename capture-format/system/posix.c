/* system.h for POSIX. */
#include "system.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
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

bool glint_file_close(glint_file file) {
    return close((int)file) == 0;
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
    return fsync((int)file) == 0;
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
