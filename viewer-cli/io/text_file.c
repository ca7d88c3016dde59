/* Writes text files. */
#include "io/text_file.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

bool text_file_write(const char *path, const char *text, struct glint_error *err) {
    char temporary[4096];
    if (snprintf(temporary, sizeof temporary, "%s.tmp-%ld", path, (long)getpid()) >= (int)sizeof temporary)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", path);
    FILE *file = fopen(temporary, "wb");
    if (!file) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    bool written = fputs(text, file) >= 0;
    written = fclose(file) == 0 && written;
    if (written && rename(temporary, path) == 0) return true;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    unlink(temporary);
    return false;
}

void csv_text(FILE *out, const char *text) {
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"') fputc('"', out);
        fputc(*text, out);
    }
    fputc('"', out);
}
