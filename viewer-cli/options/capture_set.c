/* Sets of captures, as folders and as set files:

   {"format": 1, "captures": [{"path": "alley/0001.exr", "hash": "16c1…", "tags": ["rain", "night"]}, …]}

   Paths are relative to the set file and may lead anywhere: what they name is opened as a capture. */
#include "options/capture_set.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "glint/exr.h"
#include "journal/journal.h"

enum { MOST_CAPTURES = 100000, MOST_TAGS = 64, PATH_SIZE = 4096 };

static bool ends_with(const char *path, const char *suffix) {
    const size_t length = strlen(path), tail = strlen(suffix);
    return length > tail && !strcasecmp(path + length - tail, suffix);
}

/* ---- Set files ---- */

static bool fail_entry(const char *file, size_t i, const char *what, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s: captures[%zu]: %s", file, i, what);
}

static bool check_tags(const char *file, size_t i, const json_t *tags, struct glint_error *err) {
    if (!tags) return true;
    bool ok = json_is_array(tags) && json_array_size(tags) <= MOST_TAGS;
    for (size_t k = 0; ok && k < json_array_size(tags); k++) {
        const char *tag = json_string_value(json_array_get(tags, k));
        ok = tag && tag[0] && strlen(tag) < 64;
    }
    return ok || fail_entry(file, i, "expected tags to be a list of at most 64 names of 1 to 63 bytes", err);
}

static bool check_hash(const char *file, size_t i, const json_t *hash, struct glint_error *err) {
    const char *text = json_string_value(hash);
    const bool ok = !hash || (text && strlen(text) == 32 && strspn(text, "0123456789abcdef") == 32);
    return ok || fail_entry(file, i, "expected hash to be 32 hexadecimal digits, as run.json has them (xxh3_128)", err);
}

static bool check_keys(const char *file, size_t i, const json_t *entry, struct glint_error *err) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)entry, key, value) {
        if (!strcmp(key, "path") || !strcmp(key, "hash") || !strcmp(key, "tags") || !strcmp(key, "comment")) continue;
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: captures[%zu]: expected path, hash, tags or comment, found %s",
                          file, i, key);
    }
    return true;
}

/* The capture's path as it can be opened from here; a new reference. */
static json_t *place_path(const char *file, const char *path) {
    const size_t folder = (size_t)(base_name(file) - file);
    return path[0] == '/' ? json_string(path) : json_sprintf("%.*s%s", (int)folder, file, path);
}

static bool add_entry(json_t *into, const char *file, size_t i, const json_t *entry, struct glint_error *err) {
    const json_t *hash = json_object_get(entry, "hash"), *tags = json_object_get(entry, "tags");
    const char *path = json_string_value(json_object_get(entry, "path"));
    if (!path || !path[0] || strlen(path) >= PATH_SIZE)
        return fail_entry(file, i, "expected an object with the path of a capture", err);
    if (!check_keys(file, i, entry, err) || !check_hash(file, i, hash, err) || !check_tags(file, i, tags, err))
        return false;
    json_t *placed =
        json_pack("{s:o, s:O?, s:O?}", "path", place_path(file, path), "hash", (json_t *)hash, "tags", (json_t *)tags);
    return (placed && json_array_append_new(into, placed) == 0) || fail_memory(err);
}

static bool check_named_once(const json_t *set, const char *file, struct glint_error *err) {
    json_t *seen = json_object();
    bool ok = seen || fail_memory(err);
    for (size_t i = 0; ok && i < json_array_size(set); i++) {
        const char *path = json_string_value(json_object_get(json_array_get(set, i), "path"));
        if (json_object_get(seen, path))
            ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: captures[%zu]: %s is listed twice", file, i, path);
        else ok = json_object_set_new(seen, path, json_true()) == 0 || fail_memory(err);
    }
    json_decref(seen);
    return ok;
}

#define NO_SET                                                                                                         \
    "expected a set of captures of format 1, found a JSON file; glint pack makes a capture of a manifest, and "        \
    "--preset reads presets"

/* Adds the captures of a set file to `into`. */
static bool read_set(json_t *into, const char *file, struct glint_error *err) {
    char *real = realpath(file, NULL); /* the user may name a link */
    struct glint_error why = {0};
    json_t *set = real ? json_inside(real, &why) : NULL, *own = json_array();
    const json_t *captures = json_object_get(set, "captures");
    if (!real) glint_fail(err, GLINT_ERROR_IO, "%s: %s", file, strerror(errno));
    else if (!set) glint_fail(err, why.code, "%s; " NO_SET, why.message);
    bool ok = set && (own || fail_memory(err));
    if (ok && json_integer_value(json_object_get(set, "format")) != 1)
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: " NO_SET, file);
    if (ok && !json_array_size(captures))
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a list of captures", file);
    for (size_t i = 0; ok && i < json_array_size(captures); i++)
        ok = add_entry(own, file, i, json_array_get(captures, i), err);
    ok = ok && check_named_once(own, file, err) && (json_array_extend(into, own) == 0 || fail_memory(err));
    json_decref(own);
    json_decref(set);
    free(real);
    return ok;
}

/* ---- Folders ---- */

/* What cannot be read is left to the command, which says why. */
bool capture_set_may_hold(const char *path) {
    struct glint_exr *exr = glint_exr_open(path, NULL, NULL);
    bool is = !exr;
    for (size_t i = 0; exr && i < glint_exr_part_count(exr) && !is; i++)
        is = !strcmp(glint_exr_part(exr, i)->name, GLINT_PART_GBUFFER);
    glint_exr_close(&exr);
    return is;
}

static bool add_file(json_t *into, const char *folder, const char *name, struct glint_error *err) {
    char path[PATH_SIZE];
    const size_t length = strlen(folder);
    const char *between = length && folder[length - 1] == '/' ? "" : "/";
    if (name[0] == '.' || !ends_with(name, ".exr")) return true;
    if (snprintf(path, sizeof path, "%s%s%s", folder, between, name) >= PATH_SIZE)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    if (!capture_set_may_hold(path)) return true;
    json_t *entry = json_pack("{s:s}", "path", path);
    return (entry && json_array_append_new(into, entry) == 0) ||
           glint_fail(err, GLINT_ERROR_FORMAT, "%s: out of memory, or a name that is not UTF-8", folder);
}

static bool read_folder(json_t *into, const char *folder, struct glint_error *err) {
    char path[PATH_SIZE];
    struct stat info;
    struct dirent **entries = NULL;
    if (!journal_path(folder, "run.json", path, err)) return false;
    if (stat(path, &info) == 0)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: expected captures, found a run, which is what a replay makes of one", folder);
    if (!journal_path(folder, "set.json", path, err)) return false;
    if (stat(path, &info) == 0) return read_set(into, path, err);
    const size_t before = json_array_size(into);
    const int count = scandir(folder, &entries, NULL, alphasort);
    bool ok = count >= 0 || glint_fail(err, GLINT_ERROR_IO, "%s: %s", folder, strerror(errno));
    for (int i = 0; i < count; i++) {
        ok = ok && add_file(into, folder, entries[i]->d_name, err);
        free(entries[i]);
    }
    free(entries);
    if (ok && json_array_size(into) == before)
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a folder with captures (*.exr) or set.json, found none",
                        folder);
    return ok;
}

/* ---- Lists ---- */

enum kind { CAPTURE, FOLDER, SET_FILE };
static enum kind kind_of(const char *path) {
    struct stat info;
    if (!strcmp(path, "-") || stat(path, &info) != 0) return CAPTURE;
    return S_ISDIR(info.st_mode) ? FOLDER : ends_with(path, ".json") ? SET_FILE : CAPTURE;
}

static bool expand_one(json_t *into, const char *path, struct glint_error *err) {
    const enum kind kind = kind_of(path);
    if (kind != CAPTURE) return kind == FOLDER ? read_folder(into, path, err) : read_set(into, path, err);
    json_t *name = json_stringn_nocheck(path, strlen(path)), *entry = name ? json_pack("{s:o}", "path", name) : NULL;
    return (entry && json_array_append_new(into, entry) == 0) || fail_memory(err);
}

bool capture_set_expand(struct list *captures, struct glint_error *err) {
    bool any = false;
    for (size_t i = 0; i < captures->count; i++) any |= kind_of(captures->items[i]) != CAPTURE;
    if (!any) return true;
    json_t *set = json_array();
    bool ok = set || fail_memory(err);
    for (size_t i = 0; ok && i < captures->count; i++) ok = expand_one(set, captures->items[i], err);
    if (ok && json_array_size(set) > MOST_CAPTURES)
        ok = glint_fail(err, GLINT_ERROR_LIMIT, "expected at most %d captures, found %zu", MOST_CAPTURES,
                        json_array_size(set));
    const char **items = ok ? calloc(json_array_size(set) + 1, sizeof *items) : NULL;
    if (!items) {
        json_decref(set);
        return ok ? fail_memory(err) : false;
    }
    for (size_t i = 0; i < json_array_size(set); i++)
        items[i] = json_string_value(json_object_get(json_array_get(set, i), "path"));
    free(captures->items);
    *captures = (struct list){.items = items, .count = json_array_size(set), .set = set};
    return true;
}

const json_t *capture_set_tags(const struct list *captures, size_t i) {
    return json_object_get(json_array_get(captures->set, i), "tags");
}

static bool is_among(const json_t *tags, const char *tag) {
    for (size_t k = 0; k < json_array_size(tags); k++)
        if (!strcmp(json_string_value(json_array_get(tags, k)), tag)) return true;
    return false;
}

bool capture_set_has_tag(const struct list *captures, size_t i, const char *tag) {
    return is_among(capture_set_tags(captures, i), tag);
}

json_t *capture_set_all_tags(const struct list *captures) {
    json_t *all = json_array(), *tag;
    for (size_t i = 0; i < captures->count; i++) {
        json_t *tags = (json_t *)capture_set_tags(captures, i);
        size_t k;
        json_array_foreach(tags, k, tag) {
            if (!is_among(all, json_string_value(tag))) json_array_append(all, tag);
        }
    }
    return all;
}

const char *capture_set_hash(const struct list *captures, size_t i) {
    return json_string_value(json_object_get(json_array_get(captures->set, i), "hash"));
}

bool capture_set_check(const struct list *captures, size_t i, const char *hash, struct glint_error *err) {
    const char *expected = capture_set_hash(captures, i);
    return !expected || !strcmp(expected, hash) ||
           glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected the hash %s, as its set says, found %s",
                      captures->items[i], expected, hash);
}

bool capture_set_check_open(const struct list *captures, size_t i, struct glint_capture *capture,
                            struct glint_error *err) {
    char hash[33];
    return !capture_set_hash(captures, i) ||
           (glint_capture_hash(capture, hash, err) && capture_set_check(captures, i, hash, err));
}

bool capture_set_fails_alone(const struct list *captures, size_t i, const struct glint_error *own) {
    const bool gone = own->code == GLINT_ERROR_IO && access(captures->items[i], F_OK) != 0 && errno == ENOENT;
    return gone || own->code == GLINT_ERROR_FORMAT || own->code == GLINT_ERROR_LIMIT ||
           own->code == GLINT_ERROR_UNSUPPORTED;
}
