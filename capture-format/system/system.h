/* What the capture library asks of the operating system: files named by UTF-8 paths, threads and locks. posix.c and windows.c
   implement it; nothing else in this library calls the system. Functions that fail set errno, on Windows, too. */
#ifndef GLINT_SYSTEM_H
#define GLINT_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef _WIN32
#include <pthread.h>
#endif

/* ---- Files ---- */

/* A descriptor, or a HANDLE of Windows. */
typedef intptr_t glint_file;
#define GLINT_NO_FILE ((glint_file)-1)

enum glint_file_kind { GLINT_FILE_REGULAR, GLINT_FILE_FOLDER, GLINT_FILE_OTHER };
struct glint_file_info {
    enum glint_file_kind kind;
    uint64_t bytes;
    uint64_t device, number; /* the same for two names of one file */
};

/* For reading. Returns at once for a pipe, too. Others may replace or remove the file meanwhile. */
glint_file glint_file_open(const char *path);
/* The same, but fails with ELOOP where the path itself is a symbolic link. */
glint_file glint_file_open_unlinked(const char *path);
/* For writing; a file that exists is emptied. */
glint_file glint_file_create(const char *path);
/* For writing; fails with EEXIST if anything has this name. It counts as in use until it is closed. Nobody else may read it if `secret`. */
glint_file glint_file_create_temporary(const char *path, bool secret);
bool glint_file_close(glint_file file);
/* Closes a file of glint_file_create_temporary, named `from`, and renames it to `to`, which it replaces. It is in use until it has the new name. On
   failure it is closed and keeps its name. */
bool glint_file_close_as(glint_file file, const char *from, const char *to);
/* Less than `size` bytes are only read at the end of the file. Several threads may read one file. */
bool glint_file_read(glint_file file, void *buffer, size_t size, uint64_t offset, size_t *got);
bool glint_file_write(glint_file file, const void *buffer, size_t size, uint64_t offset);
/* Returns when the file's contents are on the disk. */
bool glint_file_sync(glint_file file);
bool glint_file_describe(glint_file file, struct glint_file_info *info);

bool glint_path_describe(const char *path, struct glint_file_info *info);
static inline bool glint_file_same(const struct glint_file_info *a, const struct glint_file_info *b) {
    return a->device == b->device && a->number == b->number;
}
/* Renames a closed file. A file `to` is replaced, even while others read it: they keep what they opened. */
bool glint_path_replace(const char *from, const char *to);
bool glint_path_remove(const char *path);
/* Temporary names are PATH.tmp- and eight hexadecimal digits. */
#define GLINT_TEMPORARY ".tmp-"
enum { GLINT_TEMPORARY_DIGITS = 8 };
/* Removes the files with temporary names of `path` that no process uses any more: those of processes that were killed. If `path` ends with a
   separator, those of all files in this folder. */
void glint_path_remove_temporaries(const char *path);
/* Returns when the names in the folder of this path are on the disk, where the system can say so. */
bool glint_path_sync_folder(const char *path);
bool glint_path_create_folder(const char *path);
/* The length of a path's folder, separator included; 0 if it has none. */
size_t glint_path_folder(const char *path);

long glint_process_id(void);
/* Not to be guessed by others. */
uint32_t glint_random(void);

/* ---- Threads ---- */

struct glint_thread {
    void (*work)(void *user);
    void *user;
#ifdef _WIN32
    void *handle;
#else
    pthread_t handle;
#endif
};

#ifdef _WIN32
typedef struct {
    void *lock;
} glint_mutex; /* an SRWLOCK */
typedef struct {
    void *queue;
} glint_condition; /* a CONDITION_VARIABLE */
#else
typedef pthread_mutex_t glint_mutex;
typedef pthread_cond_t glint_condition;
#endif

/* *thread belongs to the running thread until it is joined. */
bool glint_thread_start(struct glint_thread *thread, void (*work)(void *user), void *user);
void glint_thread_join(struct glint_thread *thread);
/* Those on which the process may run. */
uint32_t glint_cores(void);

void glint_mutex_init(glint_mutex *mutex);
void glint_mutex_finish(glint_mutex *mutex);
void glint_mutex_lock(glint_mutex *mutex);
void glint_mutex_unlock(glint_mutex *mutex);

void glint_condition_init(glint_condition *condition);
void glint_condition_finish(glint_condition *condition);
void glint_condition_wait(glint_condition *condition, glint_mutex *mutex);
void glint_condition_wake_all(glint_condition *condition);

#endif
