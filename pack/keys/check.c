/* Checks the keys and values of a manifest by keys_rows.h. */
#include "check.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nearest.h"

static const char *kind_of(const json_t *value) {
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return "a list";
    case JSON_STRING:
        return "a text";
    case JSON_INTEGER:
    case JSON_REAL:
        return "a number";
    case JSON_TRUE:
    case JSON_FALSE:
        return "true or false";
    case JSON_NULL:
        break;
    }
    return "null";
}

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static bool
fault(const struct node *node, struct glint_error *err, const char *format, ...) {
    char message[900];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    node_fail(node, err, GLINT_ERROR_FORMAT, "%s", message);
    node_keep(node, err);
    return false;
}

static bool goes_on(const struct node *node) {
    return node->manifest->faults->count < FAULTS_MAX;
}

static bool expected(const struct node *node, const char *what, struct glint_error *err) {
    char found[96];
    if (json_is_string(node->value)) snprintf(found, sizeof found, "\"%.60s\"", json_string_value(node->value));
    else if (json_is_integer(node->value))
        snprintf(found, sizeof found, "%lld", (long long)json_integer_value(node->value));
    else if (json_is_real(node->value)) snprintf(found, sizeof found, "%g", json_real_value(node->value));
    else snprintf(found, sizeof found, "%s", kind_of(node->value));
    return fault(node, err, "expected %s, found %s", what, found);
}

static bool check_list(const struct node *node, size_t count, bool (*check)(const json_t *value), const char *what,
                       struct glint_error *err) {
    char text[64];
    snprintf(text, sizeof text, "%zu %s", count, what);
    if (!json_is_array(node->value)) return expected(node, text, err);
    if (json_array_size(node->value) != count)
        return fault(node, err, "expected %s, found %zu", text, json_array_size(node->value));
    for (size_t i = 0; i < count; i++) {
        const struct node item = node_item(node, i);
        if (!check(item.value)) return expected(&item, what[0] == 'n' ? "a number" : "a text", err);
    }
    return true;
}

static bool is_number(const json_t *value) {
    return json_is_number(value);
}

static bool is_text(const json_t *value) {
    return json_is_string(value);
}

static bool check_matrix(const struct node *node, struct glint_error *err) {
    if (!json_is_array(node->value) || json_array_size(node->value) != 4)
        return check_list(node, 16, is_number, "numbers", err);
    for (size_t i = 0; i < 4; i++) {
        const struct node row = node_item(node, i);
        if (!check_list(&row, 4, is_number, "numbers", err)) return false;
    }
    return true;
}

static bool check_planes(const struct node *node, size_t most, struct glint_error *err) {
    if (!json_is_array(node->value)) return expected(node, "a list of planes", err);
    if (json_array_size(node->value) > most)
        return fault(node, err, "expected at most %zu planes, found %zu", most, json_array_size(node->value));
    for (size_t i = 0; i < json_array_size(node->value); i++) {
        const struct node plane = node_item(node, i);
        if (!check_list(&plane, 4, is_number, "numbers", err)) return false;
    }
    return true;
}

static bool check_choice(const struct node *node, const char *words, struct glint_error *err) {
    const char *found = json_string_value(node->value);
    char list[256], copy[256];
    struct glint_nearest near = glint_nearest_to(found ? found : "");
    size_t length = 0;
    snprintf(copy, sizeof copy, "%s", words);
    char *rest = NULL;
    for (char *word = strtok_r(copy, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        if (found && !strcmp(word, found)) return true;
        glint_nearest_offer(&near, word);
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%s", length ? ", " : "", word);
    }
    if (!found) return expected(node, list, err);
    return fault(node, err, "expected %s, found \"%.60s\"%s", list, found, glint_nearest_text(&near));
}

static bool check_choices(const struct node *node, const struct key *key, struct glint_error *err) {
    if (!check_list(node, strcmp(key->name, "axes") ? 6 : 3, is_text, "axes", err)) return false;
    for (size_t i = 0; i < json_array_size(node->value); i++) {
        const struct node item = node_item(node, i);
        if (!check_choice(&item, key->detail, err)) return false;
    }
    return true;
}

/* Bytes may be many, numbers of texels and frames are 32 bits. */
static bool check_count(const struct node *node, struct glint_error *err) {
    const bool bytes = node->key && (strstr(node->key, "pitch") || !strcmp(node->key, "offset"));
    if (!json_is_integer(node->value) || json_integer_value(node->value) < 0)
        return expected(node, "an integer from 0", err);
    if (json_integer_value(node->value) > (bytes ? INT64_MAX : (json_int_t)UINT32_MAX))
        return expected(node, "an integer below 2^32", err);
    return true;
}

static bool check_objects(const struct node *node, const struct key *key, struct glint_error *err) {
    const struct object *object = pack_object(key->detail);
    const bool channels = !strcmp(key->detail, "channel"), attributes = !strcmp(key->detail, "attribute");
    bool ok = true;
    if (key->kind == KEY_ONE) return node_check(node, object, err);
    if (key->kind == KEY_LIST) {
        if (!json_is_array(node->value)) return expected(node, "a list", err);
        for (size_t i = 0; i < json_array_size(node->value) && goes_on(node); i++) {
            const struct node item = node_item(node, i);
            ok = node_check(&item, object, err) && ok;
        }
        return ok;
    }
    if (!json_is_object(node->value)) return expected(node, "an object", err);
    for (void *at = json_object_iter(node->value); at && goes_on(node); at = json_object_iter_next(node->value, at)) {
        const struct node child = node_child(node, json_object_iter_key(at));
        if (channels && !json_is_object(child.value)) continue; /* they are checked as they are read */
        if (attributes && (json_is_string(child.value) || json_is_number(child.value))) continue;
        ok = node_check(&child, object, err) && ok;
    }
    return ok;
}

static bool check_value(const struct node *node, const struct key *key, struct glint_error *err) {
    switch (key->kind) {
    case KEY_TEXT:
        return json_is_string(node->value) || expected(node, "a text", err);
    case KEY_NUMBER:
        return json_is_number(node->value) || expected(node, "a number", err);
    case KEY_COUNT:
        return check_count(node, err);
    case KEY_BOOL:
        return json_is_boolean(node->value) || expected(node, "true or false", err);
    case KEY_NUMBERS:
        return check_list(node, strtoul(key->detail, NULL, 10), is_number, "numbers", err);
    case KEY_TEXTS:
        return check_list(node, strtoul(key->detail, NULL, 10), is_text, "texts", err);
    case KEY_MATRIX:
        return check_matrix(node, err);
    case KEY_PLANES:
        return check_planes(node, strtoul(key->detail, NULL, 10), err);
    case KEY_CHOICE:
        return check_choice(node, key->detail, err);
    case KEY_CHOICES:
        return check_choices(node, key, err);
    case KEY_ONE:
    case KEY_LIST:
    case KEY_MAP:
        return check_objects(node, key, err);
    case KEY_ANY:
        break;
    }
    return true;
}

static bool unknown_key(const struct node *node, const struct object *object, struct glint_error *err) {
    struct glint_nearest near = glint_nearest_to(node->key);
    for (const struct key *key = object->keys; key->name; key++) glint_nearest_offer(&near, key->name);
    return fault(node, err, "%s has no such key%s", object->name, glint_nearest_text(&near));
}

bool node_check(const struct node *node, const struct object *object, struct glint_error *err) {
    bool ok = true;
    if (!json_is_object(node->value)) return expected(node, "an object", err);
    for (void *at = json_object_iter(node->value); at && goes_on(node); at = json_object_iter_next(node->value, at)) {
        const struct node child = node_child(node, json_object_iter_key(at));
        const struct key *key = pack_key(object, child.key);
        if (!strcmp(child.key, "comment")) continue;
        const bool channel = !key && !strcmp(object->name, "part");
        if (channel) ok = (!json_is_object(child.value) || node_check(&child, pack_object("channel"), err)) && ok;
        else ok = (key ? check_value(&child, key, err) : unknown_key(&child, object, err)) && ok;
    }
    for (const struct key *key = object->keys; key->name && goes_on(node); key++)
        if (key->required && !node_has(node, key->name))
            ok = fault(node, err, "%s is missing: %s", key->name, key->meaning);
    return ok;
}
