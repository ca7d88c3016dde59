/* The files that commands write. */
#include "io/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/console.h"
#include "io/memory.h"

enum { START_BYTES = 16 };

static const struct kind {
    unsigned bit;
    const char *suffix, *name;
    const char *starts[2]; /* how a file of this kind begins, after white space */
} kinds[] = {
    {OUTPUT_PNG, ".png", "a PNG picture", {"\x89PNG", NULL}},
    {OUTPUT_SVG, ".svg", "an SVG drawing", {"<svg", "<?xml"}},
    {OUTPUT_HTML, ".html", "an HTML page", {"<!doctype html", "<html"}},
    {OUTPUT_JSON, ".json", "a JSON file", {"{", "["}},
    {OUTPUT_EXR, ".exr", "an OpenEXR file", {"v/1\x01", NULL}},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), tail = strlen(end);
    return length > tail && text[length - tail - 1] != '/' && !strcasecmp(text + length - tail, end);
}

/* NULL for a file of no kind that is known here. */
static const struct kind *kind_of_contents(const char *path) {
    char start[START_BYTES + 1] = {0};
    FILE *file = fopen(path, "rb");
    const size_t got = file ? fread(start, 1, START_BYTES, file) : 0;
    if (file) fclose(file);
    const char *text = start + strspn(start, " \t\r\n");
    for (size_t k = 0; got && k < KINDS; k++)
        for (size_t s = 0; s < 2 && kinds[k].starts[s]; s++)
            if (!strncasecmp(text, kinds[k].starts[s], strlen(kinds[k].starts[s]))) return &kinds[k];
    return NULL;
}

/* "FILE.svg or FILE.html" */
static void list_suffixes(unsigned bits, char *text, size_t room) {
    size_t used = 0;
    *text = '\0';
    for (size_t k = 0; k < KINDS && used < room; k++)
        if (bits & kinds[k].bit)
            used += (size_t)snprintf(text + used, room - used, "%sFILE%s", used ? " or " : "", kinds[k].suffix);
}

bool output_is(const char *path, enum output_kind kind) {
    for (size_t k = 0; k < KINDS; k++)
        if (kinds[k].bit == (unsigned)kind) return ends_with(path, kinds[k].suffix);
    return false;
}

bool output_check(const char *path, unsigned bits, bool overwrite, struct glint_error *err) {
    struct stat status;
    const bool there = stat(path, &status) == 0;
    if (!strcmp(path, "-") || (there && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))) return true;
    if (there && S_ISDIR(status.st_mode))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a file, found a folder", path);
    const struct kind *kind = NULL;
    for (size_t k = 0; k < KINDS; k++)
        if ((bits & kinds[k].bit) && ends_with(path, kinds[k].suffix)) kind = &kinds[k];
    if (!kind) {
        char expected[128];
        list_suffixes(bits, expected, sizeof expected);
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected %s, as that is what is written", path, expected);
    }
    if (!there || !status.st_size || overwrite) return true;
    const struct kind *found = kind_of_contents(path);
    if (found == kind) return true;
    return glint_fail(err, GLINT_ERROR_USAGE, "%s exists and is %s, not %s; --overwrite replaces it", path,
                      found ? found->name : "another kind of file", kind->name);
}

FILE *output_stream(int descriptor, const char *mode) {
    const int copy = dup(descriptor);
    FILE *file = copy >= 0 ? fdopen(copy, mode) : NULL;
    const int why = errno;
    if (!file && copy >= 0) close(copy);
    errno = why;
    return file;
}

bool output_open(struct output *output, const char *path, struct glint_error *err) {
    struct stat status;
    *output = (struct output){.path = path};
    if (!strcmp(path, "-")) {
        output->path = "stdout";
        output->file = stdout;
        console_plain(true);
        return true;
    }
    output->direct = stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
    if (!output->direct && !complete_open(&output->complete, path, err)) return false;
    output->file = output->direct ? fopen(path, "wb") : output_stream((int)output->complete.file, "wb");
    if (output->file) return true;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (!output->direct) complete_close(&output->complete, false, false, err);
    return false;
}

/* What was buffered can fail to be written as late as here. */
static bool finish(struct output *output, struct glint_error *err) {
    errno = 0;
    const bool flushed = !ferror(output->file) && fflush(output->file) == 0;
    const int reason = errno;
    const bool closed = output->file == stdout || fclose(output->file) == 0;
    const int code = flushed ? errno : reason;
    output->file = NULL;
    return (flushed && closed) || glint_fail(err, GLINT_ERROR_IO, "%s: %s", output->path,
                                             code ? strerror(code) : "not everything could be written");
}

bool output_close(struct output *output, bool ok, struct glint_error *err) {
    if (ok && memory_ran_out()) ok = glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", output->path);
    if (ok) ok = finish(output, err);
    if (output->file && output->file != stdout) fclose(output->file);
    if (output->complete.temporary) ok = complete_close(&output->complete, ok, false, err);
    *output = (struct output){0};
    return ok;
}

bool output_text(const char *path, const char *text, struct glint_error *err) {
    struct output output;
    if (!output_open(&output, path, err)) return false;
    if (fputs(text, output.file) >= 0) return output_close(&output, true, err);
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    return output_close(&output, false, err);
}
