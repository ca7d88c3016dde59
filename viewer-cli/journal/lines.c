/* The lines of logs, read one after the other, and counted. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "inside.h"
#include "io/output.h"
#include "journal/journal.h"

enum { MOST_LINE = 64 << 20 };

static bool grow(struct journal_line *line) {
    const size_t size = line->size ? 2 * line->size : 4096;
    char *text = realloc(line->text, size);
    if (!text) return false;
    line->text = text;
    line->size = size;
    return true;
}

static enum journal_next fail_line(const char *path, enum glint_code code, const char *why, struct glint_error *err) {
    glint_fail(err, code, "%s: %s", path, why);
    return JOURNAL_FAILED;
}

enum journal_next journal_next_line(FILE *log, const char *path, struct journal_line *line, struct glint_error *err) {
    int c = EOF;
    for (line->length = 0; c != '\n' && (c = getc_unlocked(log)) != EOF; line->text[line->length++] = (char)c) {
        if (line->length == MOST_LINE)
            return fail_line(path, GLINT_ERROR_LIMIT, "expected lines of at most 64 MiB", err);
        if (line->length + 1 >= line->size && !grow(line))
            return fail_line(path, GLINT_ERROR_MEMORY, "out of memory", err);
    }
    if (c == EOF && ferror(log)) return fail_line(path, GLINT_ERROR_IO, strerror(errno), err);
    if (line->text) line->text[line->length] = '\0';
    return c == EOF ? JOURNAL_END : JOURNAL_LINE;
}

json_t *journal_parse(const struct journal_line *line) {
    enum { SURELY_FEW_VALUES = 1 << 20 };
    if (line->length > SURELY_FEW_VALUES && !inside_json_fits("", line->text, line->length, NULL)) return NULL;
    return json_loads(line->text, 0, NULL);
}

/* Whole lines of a file that may be cut in its last one. */
static bool count_file(const char *path, struct journal_count *count, struct glint_error *err) {
    enum { PIECE = 1 << 16 };
    char piece[PIECE];
    struct stat info;
    glint_file file;
    uint64_t bytes;
    size_t got = 0;
    if (lstat(path, &info) != 0) return true;
    const double written = (double)info.st_mtim.tv_sec + (double)info.st_mtim.tv_nsec * 1e-9;
    if (written > count->written) count->written = written;
    if (!inside_open(&file, path, UINT64_MAX, &bytes, err)) return false;
    bool ok = true;
    for (uint64_t at = 0; ok && at < bytes; at += got) {
        ok = glint_file_read(file, piece, PIECE, at, &got) && got > 0;
        for (size_t i = 0; ok && i < got; i++) count->lines += piece[i] == '\n';
    }
    const int reason = errno;
    glint_file_close(file);
    return ok || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, got ? strerror(reason) : "cut while it was read");
}

bool journal_count_lines(const char *folder, struct journal_count *count, struct glint_error *err) {
    char path[4096], inner[4096];
    struct stat info;
    if (!journal_path(folder, "log.jsonl", path, err) || !count_file(path, count, err)) return false;
    DIR *entries = opendir(folder);
    bool ok = entries || errno == ENOENT || glint_fail(err, GLINT_ERROR_IO, "%s: %s", folder, strerror(errno));
    for (const struct dirent *entry; ok && entries && (entry = readdir(entries));) {
        if (entry->d_name[0] == '.' || !journal_path(folder, entry->d_name, inner, NULL)) continue;
        if (lstat(inner, &info) == 0 && S_ISDIR(info.st_mode) && journal_path(inner, "log.jsonl", path, NULL))
            ok = count_file(path, count, err);
    }
    if (entries) closedir(entries);
    return ok;
}
