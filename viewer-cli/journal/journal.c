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
    char *line = NULL;
    size_t size = 0;
    off_t whole = 0;
    bool ok = file != NULL || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    for (ssize_t length; ok && (length = getline(&line, &size, file)) > 0 && line[length - 1] == '\n';
         whole += length) {
        json_error_t error;
        json_t *json = json_loads(line, 0, &error);
        if (!json || !journal->keep(journal->user, json))
            ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: byte %lld: expected a line of this %s, found '%.80s'", path,
                            (long long)whole, journal->kind, line);
        journal->results += ok;
        json_decref(json);
    }
    free(line);
    if (file) fclose(file);
    if (ok && ftruncate(journal->log, whole) != 0)
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
    static const off_t most = 1 << 28;
    struct stat info = {0};
    const int log = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (log < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (fstat(log, &info) == 0 && S_ISREG(info.st_mode) && info.st_size <= most) {
        journal->log = log;
        return true;
    }
    close(log);
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a file of at most %lld bytes", path, (long long)most);
}

bool journal_open(struct journal *journal, const json_t *definition, struct glint_error *err) {
    char path[4096];
    if (!journal->folder) return true;
    if (!(journal->lock = glint_folder_lock(journal->folder, err))) return false;
    if (!check_definition(journal, definition, err) || !journal_path(journal->folder, "log.jsonl", path, err))
        return false;
    if (!open_log(journal, path, err)) return false;
    return read_log(journal, path, err);
}

bool journal_append(struct journal *journal, json_t *line, struct glint_error *err) {
    char *text = line ? record_text(line, JSON_COMPACT) : NULL;
    const size_t length = text ? strlen(text) : 0;
    bool ok = text || fail_memory(err);
    if (ok) text[length] = '\n'; /* one write of a whole line */
    if (ok && journal->log > 0 && write(journal->log, text, length + 1) != (ssize_t)(length + 1))
        ok = glint_fail(err, GLINT_ERROR_IO, "%s/log.jsonl: %s", journal->folder, strerror(errno));
    if (ok) journal->keep(journal->user, line);
    journal->results += ok && journal->log > 0;
    free(text);
    json_decref(line);
    return ok;
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

void journal_close(struct journal *journal) {
    if (journal->log > 0) close(journal->log);
    journal->log = 0;
    glint_folder_unlock(&journal->lock);
}
