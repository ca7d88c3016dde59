/* Reads and writes whole files. */
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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
    const size_t length = strlen(path) + 32;
    char *temporary = malloc(length);
    if (!temporary) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    snprintf(temporary, length, "%s.tmp-%ld", path, (long)getpid());
    FILE *out = fopen(temporary, "wb");
    bool ok = out && (!size || fwrite(data, 1, size, out) == size);
    const int reason = errno;
    ok = out && fclose(out) == 0 && ok && rename(temporary, path) == 0;
    if (!ok) {
        glint_fail(err, GLINT_ERROR_IO, "%s: cannot be written: %s", path, strerror(reason ? reason : errno));
        if (out) unlink(temporary);
    }
    free(temporary);
    return ok;
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

bool file_copy(const char *from, const char *to, struct glint_error *err) {
    const size_t length = strlen(to) + 32, piece = 65536;
    char *temporary = malloc(length), *bytes = malloc(piece);
    if (temporary) snprintf(temporary, length, "%s.tmp-%ld", to, (long)getpid());
    FILE *in = fopen(from, "rb"), *out = in && temporary ? fopen(temporary, "wb") : NULL;
    bool ok = in && out && bytes;
    for (size_t got = piece; ok && got == piece;) {
        got = fread(bytes, 1, piece, in);
        ok = fwrite(bytes, 1, got, out) == got && !ferror(in);
    }
    const bool closed = !out || fclose(out) == 0;
    ok = ok && closed && rename(temporary, to) == 0;
    if (!ok) glint_fail(err, GLINT_ERROR_IO, "%s: cannot be copied to %s: %s", from, to, strerror(errno));
    if (!ok && out) unlink(temporary);
    if (in) fclose(in);
    free(temporary);
    free(bytes);
    return ok;
}
