/* The values of a manifest: the way to them, their lines for messages, and what they hold. */
#include "node.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Nodes ---- */

struct node node_root(const struct manifest *manifest) {
    return (struct node){.manifest = manifest, .value = manifest->root};
}

struct node node_child(const struct node *parent, const char *key) {
    return (struct node){
        .manifest = parent->manifest, .parent = parent, .key = key, .value = json_object_get(parent->value, key)};
}

struct node node_item(const struct node *parent, size_t index) {
    return (struct node){
        .manifest = parent->manifest, .parent = parent, .index = index, .value = json_array_get(parent->value, index)};
}

const char *node_path(const struct node *node, char text[512]) {
    const struct node *way[64];
    size_t count = 0, length = 0;
    for (; node->parent && count < 64; node = node->parent) way[count++] = node;
    text[0] = '\0';
    while (count--) {
        const struct node *step = way[count];
        int more = step->key ? snprintf(text + length, 512 - length, "%s%.200s", length ? "." : "", step->key)
                             : snprintf(text + length, 512 - length, "[%zu]", step->index);
        length += more > 0 ? (size_t)more : 0;
        if (length > 511) length = 511;
    }
    return text;
}

/* ---- Lines: the text is walked again, which jansson has accepted, so that every bracket and quote has its partner. ---- */

static const char *skip_space(const char *at, const char *end) {
    while (at < end && strchr(" \t\r\n,:", *at)) at++;
    return at;
}

static const char *skip_string(const char *at, const char *end) {
    for (at++; at < end && *at != '"'; at++)
        if (*at == '\\') at++;
    return at < end ? at + 1 : end;
}

static const char *skip_value(const char *at, const char *end) {
    size_t depth = 0;
    do {
        at = skip_space(at, end);
        if (at >= end) return end;
        if (*at == '"') at = skip_string(at, end);
        else if (*at == '{' || *at == '[') depth++, at++;
        else if (*at == '}' || *at == ']') depth--, at++;
        else
            while (at < end && !strchr(" \t\r\n,:]}", *at)) at++;
    } while (depth && at < end);
    return at;
}

static bool is_key(const char *at, const char *end, const char *key) {
    json_t *found = json_loadb(at, (size_t)(end - at), JSON_DECODE_ANY, NULL);
    const bool same = found && json_is_string(found) && !strcmp(json_string_value(found), key);
    json_decref(found);
    return same;
}

/* Where the node's value begins, its key if it has one. NULL if nothing was said. */
static const char *find_value(const struct node *node, const char **value) {
    const char *const end = node->manifest->text + node->manifest->size, *at = node->manifest->text;
    if (!node->parent) return *value = skip_space(at, end);
    if (!node->value || !find_value(node->parent, &at) || at >= end) return NULL;
    at = skip_space(at + 1, end);
    for (size_t i = 0; at < end && *at != '}' && *at != ']'; i++) {
        const char *const first = at;
        if (!node->key && i == node->index) return *value = at;
        at = skip_value(at, end);
        if (node->key) {
            *value = skip_space(at, end);
            if (is_key(first, at, node->key)) return first;
            at = skip_value(*value, end);
        }
        at = skip_space(at, end);
    }
    return NULL;
}

unsigned node_line(const struct node *node) {
    const char *value = NULL, *at = find_value(node, &value);
    if (!at) return node->parent ? node_line(node->parent) : 1;
    unsigned line = 1;
    for (const char *c = node->manifest->text; c < at; c++) line += *c == '\n';
    return line;
}

bool node_fail(const struct node *node, struct glint_error *err, enum glint_code code, const char *format, ...) {
    char message[900], path[512];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    node_path(node, path);
    return glint_fail(err, code, "%s:%u: %s%s%s", node->manifest->path, node_line(node), path, path[0] ? ": " : "",
                      message);
}

bool node_wrap(const struct node *node, struct glint_error *err) {
    const struct glint_error below = *err;
    return node_fail(node, err, below.code, "%s", below.message);
}

static bool is_known(const struct faults *faults, const char *text) {
    for (size_t i = 0; i < faults->count; i++) {
        const char *kept = i ? faults->more[i - 1] : faults->first.message;
        if (kept && !strcmp(kept, text)) return true;
    }
    return false;
}

bool node_keep(const struct node *node, const struct glint_error *err) {
    struct faults *faults = node->manifest->faults;
    if (err->code == GLINT_ERROR_MEMORY || err->code == GLINT_ERROR_INTERRUPTED) return false;
    if (faults->count < FAULTS_MAX && !is_known(faults, err->message)) {
        if (!faults->count) faults->first = *err;
        else faults->more[faults->count - 1] = strdup(err->message);
        faults->count++;
    }
    return faults->count < FAULTS_MAX;
}

bool faults_none(const struct faults *faults, const struct glint_pack_options *options, struct glint_error *err) {
    if (!faults->count) return true;
    for (size_t i = 1; options->fault && i < faults->count; i++)
        if (faults->more[i - 1]) options->fault(options->fault_user, faults->more[i - 1]);
    if (options->fault && faults->count == FAULTS_MAX)
        options->fault(options->fault_user, "there may be more errors: reading stopped here");
    *err = faults->first;
    return false;
}

void faults_finish(struct faults *faults) {
    for (size_t i = 0; i < FAULTS_MAX - 1; i++) free(faults->more[i]);
    *faults = (struct faults){.count = 0};
}

bool node_no_memory(const struct node *node, struct glint_error *err) {
    return node_fail(node, err, GLINT_ERROR_MEMORY, "out of memory");
}

void node_note(const struct node *node, enum glint_pack_note kind, const char *format, ...) {
    const struct glint_pack_options *options = node->manifest->options;
    char path[512], text[900];
    va_list args;
    if (!options->note) return;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    options->note(options->note_user, kind, node_path(node, path), text);
}

/* ---- Values ---- */

bool node_has(const struct node *node, const char *key) {
    return json_object_get(node->value, key) != NULL;
}

const char *node_text(const struct node *node, const char *key) {
    return json_string_value(json_object_get(node->value, key));
}

double node_number(const struct node *node, const char *key, double fallback) {
    const json_t *value = json_object_get(node->value, key);
    return value ? json_number_value(value) : fallback;
}

uint64_t node_count(const struct node *node, const char *key, uint64_t fallback) {
    const json_t *value = json_object_get(node->value, key);
    return value ? (uint64_t)json_integer_value(value) : fallback;
}

bool node_bool(const struct node *node, const char *key, bool fallback) {
    const json_t *value = json_object_get(node->value, key);
    return value ? json_is_true(value) : fallback;
}

bool node_numbers(const struct node *node, const char *key, double *out) {
    const json_t *list = json_object_get(node->value, key);
    size_t count = 0;
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *item = json_array_get(list, i);
        if (!json_is_array(item)) out[count++] = json_number_value(item);
        for (size_t k = 0; k < json_array_size(item); k++) out[count++] = json_number_value(json_array_get(item, k));
    }
    return list != NULL;
}
