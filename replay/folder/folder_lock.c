/* Keeps other processes from writing into a folder. The lock is on the folder's own descriptor (flock), so that it leaves no file and ends with the
   process, however that ends. File systems that lock no folders, such as NFS, leave the folder unlocked. */
#include "glint/replay.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system.h"

struct glint_folder_lock {
    int file;
    char *made; /* the folder, if it was made for the lock */
};

/* The process that holds a lock on the file, as Linux lists them: "1: FLOCK  ADVISORY  WRITE 1234 fe:00:5678 0 EOF". 0 if it is not listed, as
   when it runs in another container. The numbers of devices are not compared: file systems such as btrfs show another one to stat. */
static long find_holder(int file) {
    FILE *list = fopen("/proc/locks", "re");
    struct stat found;
    char line[256];
    long holder = 0;
    if (!list) return 0;
    while (!holder && fstat(file, &found) == 0 && fgets(line, sizeof line, list)) {
        long process;
        unsigned long long number;
        if (sscanf(line, "%*s FLOCK %*s %*s %ld %*x:%*x:%llu", &process, &number) == 2 && number == found.st_ino)
            holder = process;
    }
    fclose(list);
    return holder;
}

static bool fail_held(const char *folder, int file, struct glint_error *err) {
    const long holder = find_holder(file);
    char who[64] = "another process";
    if (holder > 0) snprintf(who, sizeof who, "process %ld", holder);
    return glint_fail(err, GLINT_ERROR_IO,
                      "%s: %s is using this folder; wait until it has ended, or choose another folder", folder, who);
}

static bool same_file(const char *path, int file) {
    struct stat named, opened;
    return stat(path, &named) == 0 && fstat(file, &opened) == 0 && named.st_dev == opened.st_dev &&
           named.st_ino == opened.st_ino;
}

enum { FAILED = -1, HELD = -2 }; /* by another process */

/* The folder's descriptor with the lock. */
static int open_locked(const char *folder, bool shared, struct glint_error *err) {
    for (;;) {
        if (!shared && !glint_make_folder(folder, err)) return FAILED;
        const int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (file < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", folder, strerror(errno)), FAILED;
        if (flock(file, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            fail_held(folder, file, err);
            close(file);
            return HELD;
        }
        if (same_file(folder, file)) return file;
        close(file); /* the folder was removed or replaced meanwhile */
    }
}

/* What processes left that were killed while they wrote into the folder. */
static void remove_temporaries(const char *folder) {
    char path[4096];
    if (snprintf(path, sizeof path, "%s/", folder) < (int)sizeof path) glint_path_remove_temporaries(path);
}

static struct glint_folder_lock *lock_folder(const char *folder, bool shared, struct glint_error *err) {
    struct glint_folder_lock *lock = calloc(1, sizeof *lock);
    if (!lock || (!shared && access(folder, F_OK) != 0 && !(lock->made = strdup(folder)))) {
        free(lock);
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder), NULL;
    }
    lock->file = open_locked(folder, shared, err);
    if (lock->file == HELD) free(lock->made), lock->made = NULL; /* who holds it made it */
    if (lock->file < 0) glint_folder_unlock(&lock);
    else if (!shared) remove_temporaries(folder);
    return lock;
}

struct glint_folder_lock *glint_folder_lock(const char *folder, struct glint_error *err) {
    return lock_folder(folder, false, err);
}

struct glint_folder_lock *glint_folder_lock_shared(const char *folder, struct glint_error *err) {
    return lock_folder(folder, true, err);
}

void glint_folder_unlock(struct glint_folder_lock **pointer) {
    struct glint_folder_lock *lock = *pointer;
    *pointer = NULL;
    if (!lock) return;
    if (lock->made && (lock->file < 0 || same_file(lock->made, lock->file)))
        rmdir(lock->made); /* which fails unless it is empty */
    if (lock->file >= 0) close(lock->file);
    free(lock->made);
    free(lock);
}
