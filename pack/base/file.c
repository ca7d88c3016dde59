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

bool file_equal(const char *a, const char *b) {
    FILE *first = fopen(a, "rb"), *second = fopen(b, "rb");
    static const size_t piece = 65536;
    char *one = malloc(piece), *other = malloc(piece);
    bool same = first && second && one && other;
    for (size_t got = piece; same && got == piece;) {
        got = fread(one, 1, piece, first);
        same = fread(other, 1, piece, second) == got && !memcmp(one, other, got) && !ferror(first) && !ferror(second);
    }
    free(one);
    free(other);
    if (first) fclose(first);
    if (second) fclose(second);
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
    const glint_file in = glint_file_open(from);
    if (in == GLINT_NO_FILE) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", from, strerror(errno));
    bool ok = complete_open(&out, to, err);
    if (ok) {
        ok = copy_all(in, out.file);
        if (!ok) glint_fail(err, GLINT_ERROR_IO, "%s: cannot be copied to %s: %s", from, to, strerror(errno));
        ok = complete_close(&out, ok, false, err);
    }
    glint_file_close(in);
    return ok;
}
