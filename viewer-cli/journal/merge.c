/* Puts the shards of a study together: one journal of theirs, in the order of one process, and their files. */
#include "journal/merge.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "complete.h"
#include "inside.h"
#include "io/copy.h"
#include "journal/journal.h"
#include "journal/shard.h"
#include "record.h"

/* The place of a result in the order of one process: its phase, its capture, or its run of replay, then its round, then its point. Those that a line lacks come first. */
enum { KEYS = 5 };
static const char *const key_names[KEYS] = {"phase", "capture", "run", "round", "point"};

struct merge_part {
    const char *folder;
    json_t *record; /* shard.json */
    uint32_t number;
    char study[4096], path[4096]; /* the folder and the log of the study that is merged */
    FILE *log;
    struct journal_line line;
    int64_t key[KEYS]; /* 0: none, else 1 more than the line says */
    bool has;          /* the line is one to be written */
};

static bool fail_at(const char *path, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
}

static json_t *read_json(const char *folder, const char *name, struct glint_error *err) {
    char path[4096];
    return journal_path(folder, name, path, err) ? json_inside(path, err) : NULL;
}

/* ---- What shards say of themselves ---- */

static const char *text_of(const struct merge_part *part, const char *key) {
    return json_string_value(json_object_get(part->record, key));
}
static json_int_t number_of(const struct merge_part *part, const char *key) {
    return json_integer_value(json_object_get(part->record, key));
}

static bool check_record(const struct merge_part *part, struct glint_error *err) {
    const json_t *arguments = json_object_get(part->record, "arguments");
    bool ok = number_of(part, "format") == 1 && text_of(part, "command") && text_of(part, "folder") &&
              json_is_array(arguments) && number_of(part, "shard") >= 1 &&
              number_of(part, "shard") <= number_of(part, "of") && number_of(part, "of") <= 1000000;
    for (size_t i = 0; ok && i < json_array_size(arguments); i++) ok = json_is_string(json_array_get(arguments, i));
    if (!ok) return glint_fail(err, GLINT_ERROR_FORMAT, "%s/shard.json: expected a shard of format 1", part->folder);
    return json_is_true(json_object_get(part->record, "done")) ||
           glint_fail(
               err, GLINT_ERROR_USAGE,
               "%s: shard %lld of %lld is not done; the same command goes on with it: glint %s --shard %lld/%lld",
               part->folder, (long long)number_of(part, "shard"), (long long)number_of(part, "of"),
               text_of(part, "command"), (long long)number_of(part, "shard"), (long long)number_of(part, "of"));
}

static int by_number(const void *a, const void *b) {
    const struct merge_part *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

/* Whether the parts, by their numbers, are all shares of one study. */
static bool check_whole(const struct merge *merge, struct glint_error *err) {
    const struct merge_part *first = &merge->parts[0];
    const json_int_t of = number_of(first, "of");
    for (size_t i = 0; i < merge->count; i++) {
        const struct merge_part *part = &merge->parts[i];
        if (number_of(part, "of") != of || strcmp(text_of(part, "command"), merge->command) != 0)
            return glint_fail(err, GLINT_ERROR_USAGE,
                              "%s: expected one of %lld shards of glint %s, found one of %lld of glint %s",
                              part->folder, (long long)of, merge->command, (long long)number_of(part, "of"),
                              text_of(part, "command"));
        if (part->number == i + 1) continue;
        if (i && part->number == merge->parts[i - 1].number)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s and %s: both are shard %u of %lld",
                              merge->parts[i - 1].folder, part->folder, part->number, (long long)of);
        return glint_fail(err, GLINT_ERROR_USAGE, "shard %zu of %lld is missing", i + 1, (long long)of);
    }
    return (json_int_t)merge->count == of ||
           glint_fail(err, GLINT_ERROR_USAGE, "shard %zu of %lld is missing", merge->count + 1, (long long)of);
}

static void definition_name(const struct merge *merge, char name[64]) {
    snprintf(name, 64, "%.50s.json", merge->command);
}

/* FOLDER/study; FOLDER itself where that is "". */
static bool study_path(const char *folder, const char *study, char path[4096], struct glint_error *err) {
    return snprintf(path, 4096, "%s%s%s", folder, *study ? "/" : "", study) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

static bool has_definition(const struct merge *merge, const char *folder) {
    char name[64], path[4096];
    struct stat info;
    definition_name(merge, name);
    return journal_path(folder, name, path, NULL) && lstat(path, &info) == 0;
}

/* A shard is one study, or has several in folders. */
static bool find_studies(struct merge *merge, struct glint_error *err) {
    const char *folder = merge->parts[0].folder;
    char path[4096];
    if (!(merge->studies = json_array())) return fail_memory(err);
    DIR *entries = has_definition(merge, folder) ? NULL : opendir(folder);
    for (const struct dirent *entry; entries && (entry = readdir(entries));)
        if (entry->d_name[0] != '.' && journal_path(folder, entry->d_name, path, NULL) && has_definition(merge, path))
            json_array_append_new(merge->studies, json_string(entry->d_name));
    if (entries) closedir(entries);
    if (json_array_size(merge->studies)) return true;
    return json_array_append_new(merge->studies, json_string("")) == 0 || fail_memory(err);
}

/* Whether it is the same study in all shards. */
static bool check_study(const struct merge *merge, const char *study, struct glint_error *err) {
    char name[64], path[4096];
    json_t *first = NULL;
    bool ok = true;
    definition_name(merge, name);
    for (size_t i = 0; ok && i < merge->count; i++) {
        json_t *own = study_path(merge->parts[i].folder, study, path, err) ? read_json(path, name, err) : NULL;
        ok = own != NULL;
        if (ok && first && !json_equal(first, own))
            ok = glint_fail(err, GLINT_ERROR_USAGE,
                            "%s/%s: differs from that of %s: these are shards of different studies", path, name,
                            merge->parts[0].folder);
        if (first) json_decref(own);
        else first = own;
    }
    json_decref(first);
    return ok;
}

static bool check_studies(const struct merge *merge, struct glint_error *err) {
    for (size_t i = 0; i < json_array_size(merge->studies); i++)
        if (!check_study(merge, json_string_value(json_array_get(merge->studies, i)), err)) return false;
    return true;
}

bool merge_open(struct merge *merge, const struct list *folders, struct glint_error *err) {
    *merge = (struct merge){.parts = calloc(folders->count + 1, sizeof *merge->parts)};
    if (!merge->parts) return fail_memory(err);
    for (size_t i = 0; i < folders->count; i++) {
        struct merge_part *part = &merge->parts[merge->count++];
        part->folder = folders->items[i];
        if (!(part->record = read_json(part->folder, "shard.json", err)) || !check_record(part, err)) return false;
        part->number = (uint32_t)number_of(part, "shard");
    }
    qsort(merge->parts, merge->count, sizeof *merge->parts, by_number);
    merge->command = text_of(&merge->parts[0], "command");
    merge->folder = text_of(&merge->parts[0], "folder");
    merge->arguments = json_object_get(merge->parts[0].record, "arguments");
    return check_whole(merge, err) && find_studies(merge, err) && check_studies(merge, err);
}

static void close_log(struct merge_part *part) {
    free(part->line.text);
    if (part->log) fclose(part->log);
    part->line = (struct journal_line){0};
    part->log = NULL;
}

void merge_close(struct merge *merge) {
    for (size_t i = 0; merge->parts && i < merge->count; i++) {
        json_decref(merge->parts[i].record);
        close_log(&merge->parts[i]);
    }
    free(merge->parts);
    json_decref(merge->studies);
    *merge = (struct merge){0};
}

/* ---- Journals ---- */

static bool read_keys(struct merge_part *part) {
    json_t *json = journal_parse(&part->line);
    bool ok = json != NULL, any = false;
    for (int k = 0; k < KEYS; k++) {
        const json_t *value = json_object_get(json, key_names[k]);
        ok = ok && (!value || (json_is_integer(value) && json_integer_value(value) >= 0));
        part->key[k] = ok && value ? json_integer_value(value) + 1 : 0;
        any |= value != NULL;
    }
    json_decref(json);
    return ok && any;
}

/* Reads the next whole line; what was cut off at the end of a journal is none. */
static bool next_line(struct merge_part *part, struct glint_error *err) {
    const enum journal_next next = journal_next_line(part->log, part->path, &part->line, err);
    part->has = next == JOURNAL_LINE;
    return next == JOURNAL_END || (part->has && read_keys(part)) ||
           (part->has && glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a line of a %s, found '%.80s'", part->path,
                                    text_of(part, "command"), part->line.text));
}

static bool open_log(struct merge_part *part, struct glint_error *err) {
    glint_file file;
    uint64_t bytes;
    if (!journal_path(part->study, "log.jsonl", part->path, err) ||
        !inside_open(&file, part->path, UINT64_MAX, &bytes, err))
        return false;
    part->log = fdopen((int)file, "rb");
    if (part->log) return next_line(part, err);
    glint_file_close(file);
    return fail_at(part->path, err);
}

static int compare_keys(const struct merge_part *a, const struct merge_part *b) {
    for (int k = 0; k < KEYS; k++)
        if (a->key[k] != b->key[k]) return a->key[k] < b->key[k] ? -1 : 1;
    return 0;
}

/* The part whose line comes first, and the one that comes after it; NULL where there is none. */
static void find_first(const struct merge *merge, struct merge_part **first, struct merge_part **second) {
    *first = *second = NULL;
    for (size_t i = 0; i < merge->count; i++) {
        struct merge_part *part = &merge->parts[i];
        if (!part->has) continue;
        if (!*first || compare_keys(part, *first) < 0) *second = *first, *first = part;
        else if (!*second || compare_keys(part, *second) < 0) *second = part;
    }
}

static bool write_lines(struct merge *merge, FILE *out, const char *path, struct glint_error *err) {
    struct merge_part *first, *second, last = {.key = {-1}};
    for (find_first(merge, &first, &second); first; find_first(merge, &first, &second))
        while (first->has && (!second || compare_keys(first, second) <= 0)) {
            if (!compare_keys(first, &last))
                return glint_fail(err, GLINT_ERROR_FORMAT, "%s: a result is there twice: '%.80s'", first->path,
                                  first->line.text);
            memcpy(last.key, first->key, sizeof last.key);
            if (fwrite(first->line.text, 1, first->line.length, out) != first->line.length) return fail_at(path, err);
            merge->results++;
            if (!next_line(first, err)) return false;
        }
    return true;
}

static bool write_log(struct merge *merge, const char *out, struct glint_error *err) {
    char path[4096];
    struct output log;
    bool ok = true;
    for (size_t i = 0; ok && i < merge->count; i++) ok = open_log(&merge->parts[i], err);
    if (ok && journal_path(out, "log.jsonl", path, err) && (ok = output_open(&log, path, err))) {
        ok = write_lines(merge, log.file, path, err);
        ok = output_close(&log, ok, err);
    }
    for (size_t i = 0; i < merge->count; i++) close_log(&merge->parts[i]);
    return ok;
}

/* ---- Other files ---- */

/* A file of a shard gets a second name in the whole study's folder, or is copied where the file system has no such names. */
static bool take_file(const char *from, const char *to, struct glint_error *err) {
    struct stat info;
    if (lstat(to, &info) == 0) return true; /* of another shard, which made the same, or of an earlier merge */
    if (lstat(from, &info) != 0) return fail_at(from, err);
    if (!S_ISREG(info.st_mode)) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a file", from);
    if (link(from, to) == 0) return true;
    char *temporary = complete_temporary(to);
    const bool ok = temporary
                        ? copy_plain(from, temporary, UINT64_C(1) << 32, err) && complete_rename(temporary, to, err)
                        : fail_memory(err);
    if (temporary && !ok) unlink(temporary);
    free(temporary);
    return ok;
}

static bool is_hidden(const char *name) {
    return name[0] == '.' || strstr(name, ".tmp-");
}

static bool take_folder(const char *from, const char *to, struct glint_error *err) {
    DIR *entries = opendir(from);
    if (!entries) return fail_at(from, err);
    bool ok = glint_make_folder(to, err);
    for (const struct dirent *entry; ok && (entry = readdir(entries));) {
        char source[4096], target[4096];
        if (is_hidden(entry->d_name)) continue;
        ok = journal_path(from, entry->d_name, source, err) && journal_path(to, entry->d_name, target, err) &&
             take_file(source, target, err);
    }
    closedir(entries);
    return ok;
}

/* The folders of references and pictures. */
static bool take_folders(const struct merge_part *part, const char *out, struct glint_error *err) {
    DIR *entries = opendir(part->study);
    if (!entries) return fail_at(part->study, err);
    bool ok = true;
    for (const struct dirent *entry; ok && (entry = readdir(entries));) {
        char source[4096], target[4096];
        struct stat info;
        if (is_hidden(entry->d_name)) continue;
        ok = journal_path(part->study, entry->d_name, source, err) && journal_path(out, entry->d_name, target, err);
        if (ok && lstat(source, &info) == 0 && S_ISDIR(info.st_mode)) ok = take_folder(source, target, err);
    }
    closedir(entries);
    return ok;
}

static bool write_definition(const struct merge *merge, const char *out, struct glint_error *err) {
    char name[64], path[4096];
    definition_name(merge, name);
    json_t *definition = read_json(merge->parts[0].study, name, err);
    char *text = definition ? record_text(definition, JSON_INDENT(1)) : NULL;
    if (definition && !text) fail_memory(err);
    const bool ok = text && journal_path(out, name, path, err) && output_text(path, text, err);
    free(text);
    json_decref(definition);
    return ok;
}

/* The journal comes last: without it, the study has no results. */
static bool write_study(struct merge *merge, const char *study, const char *out, struct glint_error *err) {
    char path[4096];
    bool ok = study_path(out, study, path, err) && glint_make_folder(path, err);
    for (size_t i = 0; ok && i < merge->count; i++)
        ok = study_path(merge->parts[i].folder, study, merge->parts[i].study, err);
    ok = ok && write_definition(merge, path, err);
    for (size_t i = 0; ok && i < merge->count; i++) ok = take_folders(&merge->parts[i], path, err);
    return ok && write_log(merge, path, err);
}

bool merge_write(struct merge *merge, const char *out, struct glint_error *err) {
    struct glint_folder_lock *lock = glint_make_folder(out, err) ? glint_folder_lock(out, err) : NULL;
    bool ok = lock != NULL;
    for (size_t i = 0; ok && i < json_array_size(merge->studies); i++)
        ok = write_study(merge, json_string_value(json_array_get(merge->studies, i)), out, err);
    glint_folder_unlock(&lock);
    return ok;
}

static bool gather_shard(struct merge *merge, struct merge_part *part, const char *out, struct glint_error *err) {
    const struct shard shard = {part->number, (uint32_t)number_of(part, "of")};
    char name[64], folder[4096], from[4096], to[4096];
    definition_name(merge, name);
    const char *const names[] = {name, "shard.json", "log.jsonl"};
    if (!study_path(part->folder, "", part->study, err) || !shard_folder(&shard, out, folder, err) ||
        !glint_make_folder(folder, err) || !take_folders(part, out, err))
        return false;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!journal_path(part->folder, names[i], from, err) || !journal_path(folder, names[i], to, err) ||
            !take_file(from, to, err))
            return false;
    return true;
}

bool merge_gather(struct merge *merge, const char *out, struct glint_error *err) {
    struct glint_folder_lock *lock = glint_make_folder(out, err) ? glint_folder_lock(out, err) : NULL;
    bool ok = lock != NULL;
    for (size_t i = 0; ok && i < merge->count; i++) ok = gather_shard(merge, &merge->parts[i], out, err);
    glint_folder_unlock(&lock);
    return ok;
}
