/* Private temporary folders. A process has a lock on its own (flock), which ends with it: so those of killed processes are known. */
#include "io/temporary.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *walk) {
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

void temporary_remove_folder(const char *folder) {
    if (rmdir(folder) != 0) nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS); /* nftw needs memory */
}

/* Our own folder of this name with the lock, or -1: gone, somebody else's, or in use. */
static int lock_folder(const char *path) {
    struct stat named, opened;
    const int file = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (file >= 0 && fstat(file, &opened) == 0 && opened.st_uid == geteuid() && flock(file, LOCK_EX | LOCK_NB) == 0 &&
        lstat(path, &named) == 0 && named.st_ino == opened.st_ino && named.st_dev == opened.st_dev)
        return file;
    if (file >= 0) close(file);
    return -1;
}

static void remove_abandoned(const char *parent, const char *what) {
    char start[64], path[4096];
    const int length = snprintf(start, sizeof start, "glint-%s.", what);
    DIR *entries = opendir(parent);
    for (const struct dirent *entry; entries && (entry = readdir(entries));) {
        if (strncmp(entry->d_name, start, (size_t)length) != 0 || strlen(entry->d_name) != (size_t)length + 6 ||
            snprintf(path, sizeof path, "%s/%s", parent, entry->d_name) >= (int)sizeof path)
            continue;
        const int file = lock_folder(path);
        if (file < 0) continue;
        temporary_remove_folder(path);
        close(file);
    }
    if (entries) closedir(entries);
}

bool temporary_make(struct temporary *temporary, const char *what, struct glint_error *err) {
    const char *parent = getenv("TMPDIR");
    if (!parent || !*parent) parent = "/tmp";
    remove_abandoned(parent, what);
    /* Another process may take a folder for an abandoned one before it is locked. */
    for (int i = 0; i < 100; i++) {
        *temporary = (struct temporary){.lock = -1};
        const int length = snprintf(temporary->path, sizeof temporary->path, "%s/glint-%s.XXXXXX", parent, what);
        if (length >= (int)sizeof temporary->path) errno = ENAMETOOLONG;
        if (length >= (int)sizeof temporary->path || !mkdtemp(temporary->path)) break;
        if ((temporary->lock = lock_folder(temporary->path)) >= 0) return true;
        rmdir(temporary->path);
    }
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", temporary->path, strerror(errno));
    *temporary = (struct temporary){0};
    return false;
}

void temporary_remove(struct temporary *temporary) {
    if (!temporary->path[0]) return;
    temporary_remove_folder(temporary->path);
    close(temporary->lock);
    *temporary = (struct temporary){0};
}
