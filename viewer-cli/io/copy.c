/* Copies of files in folders that may come from anybody. */
#include "io/copy.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "inside.h"

static bool fail_at(const char *path, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
}

static bool write_all(int file, const char *bytes, size_t size) {
    while (size > 0) {
        const ssize_t count = write(file, bytes, size);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes += count;
        size -= (size_t)count;
    }
    return true;
}

bool copy_plain(const char *from, const char *to, uint64_t most, struct glint_error *err) {
    static const size_t size = 1 << 20;
    uint64_t bytes;
    glint_file in;
    if (!inside_open(&in, from, most, &bytes, err)) return false;
    const int out = open(to, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    char *block = malloc(size);
    bool ok = block || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok && out < 0) ok = fail_at(to, err);
    for (uint64_t done = 0; ok && done < bytes;) {
        size_t count = bytes - done < size ? (size_t)(bytes - done) : size;
        ok = glint_file_read(in, block, count, done, &count) || fail_at(from, err);
        if (ok && !count) ok = glint_fail(err, GLINT_ERROR_IO, "%s: it shrinks", from);
        ok = ok && (write_all(out, block, count) || fail_at(to, err));
        done += count;
    }
    if (ok && fsync(out) != 0) ok = fail_at(to, err);
    if (out >= 0 && close(out) != 0 && ok) ok = fail_at(to, err);
    glint_file_close(in);
    free(block);
    return ok;
}
