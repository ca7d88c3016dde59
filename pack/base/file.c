/* Reads and writes whole files. */
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "complete.h"
#include "inside.h"

static const uint64_t MOST_COPIED = (uint64_t)64 << 30; /* as of a capture */

static bool read_all(int file, const char *path, struct bytes *bytes, struct glint_error *err) {
    size_t done = 0;
    while (done < bytes->size) {
        const ssize_t more = read(file, bytes->data + done, bytes->size - done);
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
        if (more == 0)
            return glint_fail(err, GLINT_ERROR_IO, "%s: expected %zu bytes, found %zu: it shrinks", path, bytes->size,
                              done);
        done += (size_t)more;
    }
    return true;
}

bool file_read(const char *path, uint64_t most, struct bytes *bytes, struct glint_error *err) {
    struct stat about;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    bool ok = false;
    *bytes = (struct bytes){0};
    if (file < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (fstat(file, &about)) glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    else if (!S_ISREG(about.st_mode)) glint_fail(err, GLINT_ERROR_IO, "%s: expected a file, found none", path);
    else if ((uint64_t)about.st_size > most)
        glint_fail(err, GLINT_ERROR_LIMIT, "%s: expected at most %llu bytes, found %lld", path,
                   (unsigned long long)most, (long long)about.st_size);
    else if (!(bytes->data = malloc((size_t)about.st_size + 1)))
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    else {
        bytes->size = (size_t)about.st_size;
        ok = read_all(file, path, bytes, err);
        bytes->data[bytes->size] = '\0';
    }
    close(file);
    if (!ok) {
        free(bytes->data);
        *bytes = (struct bytes){0};
    }
    return ok;
}

char *file_beside(const char *beside, const char *name) {
    const char *slash = strrchr(beside, '/');
    const size_t folder = name[0] == '/' || !slash ? 0 : (size_t)(slash - beside) + 1, length = strlen(name);
    char *path = malloc(folder + length + 1);
    if (!path) return NULL;
    memcpy(path, beside, folder);
    memcpy(path + folder, name, length + 1);
    return path;
}

bool file_same(const char *a, const char *b) {
    struct stat first, second;
    return !stat(a, &first) && !stat(b, &second) && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

bool file_write(const char *path, const void *data, size_t size, struct glint_error *err) {
    struct complete_file out;
    if (!complete_open(&out, path, err)) return false;
    const bool ok = glint_file_write(out.file, data, size, 0);
    if (!ok) glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    return complete_close(&out, ok, false, err);
}

static bool same_bytes(glint_file first, glint_file second) {
    static const size_t piece = 65536;
    char *one = malloc(piece), *other = malloc(piece);
    bool same = one && other;
    uint64_t done = 0;
    for (size_t got = piece, also; same && got == piece; done += got)
        same = glint_file_read(first, one, piece, done, &got) && glint_file_read(second, other, piece, done, &also) &&
               got == also && !memcmp(one, other, got);
    free(one);
    free(other);
    return same;
}

bool file_equal(const char *a, const char *b) {
    glint_file first = GLINT_NO_FILE, second = GLINT_NO_FILE;
    uint64_t bytes, others;
    const bool open =
        inside_open(&first, a, UINT64_MAX, &bytes, NULL) && inside_open(&second, b, UINT64_MAX, &others, NULL);
    const bool same = open && bytes == others && same_bytes(first, second);
    if (first != GLINT_NO_FILE) glint_file_close(first);
    if (second != GLINT_NO_FILE) glint_file_close(second);
    return same;
}

static bool copy_all(glint_file from, glint_file to) {
    static const size_t piece = 65536;
    char *bytes = malloc(piece);
    bool ok = bytes != NULL;
    uint64_t done = 0;
    for (size_t got = piece; ok && got == piece; done += got)
        ok = glint_file_read(from, bytes, piece, done, &got) && glint_file_write(to, bytes, got, done);
    free(bytes);
    return ok;
}

bool file_copy(const char *from, const char *to, struct glint_error *err) {
    struct complete_file out;
    glint_file in;
    uint64_t bytes;
    if (!inside_open(&in, from, MOST_COPIED, &bytes, err)) return false;
    bool ok = complete_open(&out, to, err);
    if (ok) {
        ok = copy_all(in, out.file);
        if (!ok) glint_fail(err, GLINT_ERROR_IO, "%s: cannot be copied to %s: %s", from, to, strerror(errno));
        ok = complete_close(&out, ok, false, err);
    }
    glint_file_close(in);
    return ok;
}
