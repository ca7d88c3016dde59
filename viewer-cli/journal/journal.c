/* Studies on disk: a definition, and a log with one line for each result. */
#include "journal/journal.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/output.h"
#include "record.h"

bool journal_path(const char *folder, const char *name, char path[4096], struct glint_error *err) {
    return snprintf(path, 4096, "%s/%s", folder, name) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

static bool same_definition(const struct journal *journal, const json_t *theirs, const json_t *ours,
                            struct glint_error *err) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)ours, key, value) {
        const json_t *other = json_object_get(theirs, key);
        if (json_equal(other, value)) continue;
        char *found = other ? record_text(other, JSON_ENCODE_ANY | JSON_COMPACT) : NULL;
        char *expected = record_text(value, JSON_ENCODE_ANY | JSON_COMPACT);
        glint_fail(err, GLINT_ERROR_USAGE,
                   "%s: contains a %s with other %s: %.300s instead of %.300s; use the same arguments, or choose "
                   "another folder",
                   journal->folder, journal->kind, key, found ? found : "none", expected ? expected : "?");
        free(found);
        free(expected);
        return false;
    }
    return true;
}

/* Reads all complete lines. An incomplete last line, left by a crash, is cut off. */
static bool read_log(struct journal *journal, const char *path, struct glint_error *err) {
    FILE *file = output_stream(journal->log, "rb");
    struct journal_line line = {0};
    enum journal_next next = JOURNAL_FAILED;
    journal->at = 0;
    bool ok = file != NULL || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    for (; ok && (next = journal_next_line(file, path, &line, err)) == JOURNAL_LINE;
         journal->at += (int64_t)line.length) {
        json_t *json = journal_parse(&line);
        if (!json || !journal->keep(journal->user, json))
            ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: byte %lld: expected a line of this %s, found '%.80s'", path,
                            (long long)journal->at, journal->kind, line.text);
        journal->results += ok;
        json_decref(json);
    }
    free(line.text);
    if (file) fclose(file);
    ok = ok && next != JOURNAL_FAILED;
    if (ok && ftruncate(journal->log, journal->at) != 0)
        ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    return ok;
}

static bool write_definition(const json_t *definition, const char *path, struct glint_error *err) {
    char *text = record_text(definition, JSON_INDENT(1));
    const bool ok = text ? output_text(path, text, err) : fail_memory(err);
    free(text);
    return ok;
}

/* Compares our definition with the stored one, if there is one. */
static bool check_definition(const struct journal *journal, const json_t *definition, struct glint_error *err) {
    char path[4096], name[64];
    snprintf(name, sizeof name, "%s.json", journal->kind);
    if (!journal_path(journal->folder, name, path, err)) return false;
    if (access(path, F_OK) != 0) return write_definition(definition, path, err);
    json_t *theirs = json_inside(path, err);
    const bool ok = theirs && same_definition(journal, theirs, definition, err);
    json_decref(theirs);
    return ok;
}

/* The folder may come from somebody else: the log is a file of this folder, not a link to another, which would be cut off, nor a pipe. */
static bool open_log(struct journal *journal, const char *path, struct glint_error *err) {
    struct stat info = {0};
    const int log = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (log < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (fstat(log, &info) == 0 && S_ISREG(info.st_mode)) {
        journal->log = log;
        return true;
    }
    close(log);
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a file, found a device or a pipe", path);
}

/* A file without a name, for lines that are read back and belong to no folder. */
static bool open_temporary(struct journal *journal, struct glint_error *err) {
    FILE *file = tmpfile();
    journal->log = file ? fcntl(fileno(file), F_DUPFD_CLOEXEC, 1) : -1;
    const int reason = errno;
    if (file) fclose(file);
    if (journal->log > 0) return true;
    journal->log = 0;
    return glint_fail(err, GLINT_ERROR_IO, "a temporary file for results: %s", strerror(reason));
}

bool journal_open(struct journal *journal, const json_t *definition, struct glint_error *err) {
    char path[4096];
    if (!journal->folder) return !journal->reread || open_temporary(journal, err);
    if (!(journal->lock = glint_folder_lock(journal->folder, err))) return false;
    if (!check_definition(journal, definition, err) || !journal_path(journal->folder, "log.jsonl", path, err))
        return false;
    if (!open_log(journal, path, err)) return false;
    return read_log(journal, path, err);
}

/* Appends all of it, or nothing. */
static bool write_whole(int log, off_t at, const char *text, size_t length) {
    for (size_t done = 0; done < length;) {
        const ssize_t wrote = write(log, text + done, length - done);
        if (wrote > 0) done += (size_t)wrote;
        else if (wrote == 0 || errno != EINTR) {
            const int reason = wrote == 0 ? ENOSPC : errno;
            if (ftruncate(log, at) != 0) return false;
            errno = reason;
            return false;
        }
    }
    return true;
}

static bool write_line(struct journal *journal, const char *text, size_t length, struct glint_error *err) {
    const char *folder = journal->folder ? journal->folder : "a temporary file for results";
    const off_t at = lseek(journal->log, 0, SEEK_END);
    if (at < 0 || !write_whole(journal->log, at, text, length))
        return glint_fail(err, GLINT_ERROR_IO, "%s%s: %s", folder, journal->folder ? "/log.jsonl" : "",
                          strerror(errno));
    journal->at = at;
    journal->results++;
    return true;
}

bool journal_append(struct journal *journal, json_t *line, struct glint_error *err) {
    char *text = line ? record_text(line, JSON_COMPACT) : NULL;
    const size_t length = text ? strlen(text) : 0;
    bool ok = text || fail_memory(err);
    if (ok) text[length] = '\n'; /* one write of a whole line */
    ok = ok && (journal->log <= 0 || write_line(journal, text, length + 1, err));
    if (ok) journal->keep(journal->user, line);
    free(text);
    json_decref(line);
    return ok;
}

json_t *journal_read(struct journal *journal, int64_t at, struct glint_error *err) {
    struct journal_line line = {0};
    const char *path = journal->folder ? journal->folder : "the temporary file of results";
    errno = 0;
    if (!journal->back) journal->back = output_stream(journal->log, "rb");
    const bool found = journal->back && fseeko(journal->back, at, SEEK_SET) == 0;
    if (!found) glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    const enum journal_next next = found ? journal_next_line(journal->back, path, &line, err) : JOURNAL_FAILED;
    json_t *json = next == JOURNAL_LINE ? journal_parse(&line) : NULL;
    if (next == JOURNAL_LINE && !json) fail_memory(err);
    if (next == JOURNAL_END) glint_fail(err, GLINT_ERROR_IO, "%s: a result cannot be read back", path);
    free(line.text);
    return json;
}

static bool has_reference(const char *folder) {
    DIR *dir = opendir(folder);
    bool found = false;
    for (const struct dirent *entry; dir && !found && (entry = readdir(dir));)
        found = !strncmp(entry->d_name, "reference-", strlen("reference-"));
    if (dir) closedir(dir);
    return found;
}

void journal_describe_kept(const struct journal *journal, const char *results, char text[512]) {
    const bool reference = journal->folder && has_reference(journal->folder);
    if (!journal->results && !reference) {
        snprintf(text, 512, "interrupted before the first of the %s: there is nothing to resume from", results);
        return;
    }
    char count[200] = "";
    if (journal->results) snprintf(count, sizeof count, "%zu of the %s", journal->results, results);
    snprintf(text, 512, "%s%s%s are kept in %.200s; the same command resumes from there", count,
             journal->results && reference ? " and " : "", reference ? "the rays of the reference" : "",
             journal->folder);
}

void journal_remove(const char *folder, const char *kind) {
    char name[64], path[4096];
    snprintf(name, sizeof name, "%s.json", kind);
    const char *const names[] = {"log.jsonl", name};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (journal_path(folder, names[i], path, NULL)) unlink(path);
}

void journal_close(struct journal *journal) {
    if (journal->back) fclose(journal->back);
    journal->back = NULL;
    if (journal->log > 0) close(journal->log);
    journal->log = 0;
    glint_folder_unlock(&journal->lock);
}
