/* Mutates JSON as a tree: values are changed, copied, moved, left out and renamed, so that most of what comes out can be parsed. What stands
   before the first brace is another's, and stays. */
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "mutate.h"

/* A value of a tree, by what holds it. */
struct place {
    json_t *holder, *value;
    const char *key; /* NULL: an element of an array */
    size_t index;
};
enum { PLACES = 4096, DEPTH = 64 };
struct places {
    struct place all[PLACES];
    size_t count;
};

static void list_places(struct places *places, json_t *holder, size_t depth) {
    const char *key;
    json_t *value;
    size_t i;
    if (depth == DEPTH) return;
    json_object_foreach(holder, key, value) {
        if (places->count < PLACES) places->all[places->count++] = (struct place){holder, value, key, 0};
        list_places(places, value, depth + 1);
    }
    json_array_foreach(holder, i, value) {
        if (places->count < PLACES) places->all[places->count++] = (struct place){holder, value, NULL, i};
        list_places(places, value, depth + 1);
    }
}

static json_t *odd_value(uint64_t *state) {
    static const double reals[] = {0.5, -0.0, 1e-300, -1e300, 1e308, 3.4e38, 65504, 16777217, 4294967296.5, 1e19};
    static const json_int_t integers[] = {0,     1,         -1,        2,          255,       65535,
                                          65536, INT32_MAX, INT32_MIN, UINT32_MAX, INT64_MAX, INT64_MIN};
    static char text[5000];
    switch (draw(state, 8)) {
    case 0:
        return json_real(reals[draw(state, sizeof reals / sizeof *reals)]);
    case 1:
    case 2:
        return json_integer(integers[draw(state, sizeof integers / sizeof *integers)]);
    case 3:
        return json_boolean(draw(state, 2));
    case 4:
        return json_null();
    case 5:
        return draw(state, 2) ? json_array() : json_object();
    case 6:
        memset(text, 'a', sizeof text);
        return json_stringn(text, draw(state, 4) ? draw(state, 300) : sizeof text);
    default:
        return json_string("");
    }
}

/* libFuzzer's mutation of a text, without what is no ASCII or would end it. */
static json_t *mutated_text(const char *text) {
    enum { MOST = 512 };
    uint8_t bytes[MOST];
    size_t size = strlen(text) < MOST ? strlen(text) : MOST, kept = 0;
    memcpy(bytes, text, size);
    size = LLVMFuzzerMutate(bytes, size, MOST);
    for (size_t i = 0; i < size; i++)
        if (bytes[i] && bytes[i] < 0x80) bytes[kept++] = bytes[i];
    return json_stringn((const char *)bytes, kept);
}

static json_t *mutated_scalar(const json_t *value, uint64_t *state) {
    if (json_is_string(value)) return mutated_text(json_string_value(value));
    if (json_is_integer(value)) {
        json_int_t number = json_integer_value(value);
        if (draw(state, 2)) return odd_value(state);
        LLVMFuzzerMutate((uint8_t *)&number, sizeof number, sizeof number);
        return json_integer(number);
    }
    if (json_is_real(value)) {
        double number = json_real_value(value);
        LLVMFuzzerMutate((uint8_t *)&number, sizeof number, sizeof number);
        json_t *real = json_real(number);
        return real ? real : json_real(0);
    }
    return odd_value(state);
}

/* Takes over the value. */
static void put(const struct place *at, json_t *value) {
    if (at->key) json_object_set_new(at->holder, at->key, value);
    else json_array_set_new(at->holder, at->index, value);
}

/* A copy, as what is in a tree twice would be changed twice. */
static void add(json_t *holder, const char *key, const json_t *value) {
    if (json_is_object(holder)) json_object_set_new(holder, key ? key : "a", json_deep_copy(value));
    else if (json_is_array(holder)) json_array_insert_new(holder, json_array_size(holder) / 2, json_deep_copy(value));
}

static void rename_key(const struct place *at, const struct place *other, uint64_t *state) {
    json_t *name = draw(state, 2) && other->key ? json_string(other->key) : mutated_text(at->key);
    if (name && json_string_value(name)) json_object_set(at->holder, json_string_value(name), at->value);
    json_decref(name);
}

static void mutate_tree(json_t *root, uint64_t *state) {
    static struct places places;
    places.count = 0;
    list_places(&places, root, 0);
    if (!places.count) {
        add(root, "a", root);
        return;
    }
    const struct place at = places.all[draw(state, places.count)], other = places.all[draw(state, places.count)];
    switch (draw(state, 8)) {
    case 0:
        put(&at, odd_value(state));
        break;
    case 1:
        put(&at, json_deep_copy(other.value));
        break;
    case 2:
        add(json_is_object(other.value) || json_is_array(other.value) ? other.value : other.holder, at.key, at.value);
        break;
    case 3:
        if (at.key) rename_key(&at, &other, state);
        else json_array_remove(at.holder, at.index);
        break;
    case 4:
        if (at.key) json_object_del(at.holder, at.key);
        else json_array_append_new(at.holder, json_deep_copy(other.value));
        break;
    default:
        put(&at, json_is_object(at.value) || json_is_array(at.value) ? json_deep_copy(other.value)
                                                                     : mutated_scalar(at.value, state));
    }
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed) {
    uint64_t state = seed;
    const uint8_t *brace = size ? memchr(data, '{', size) : NULL;
    const size_t before = brace ? (size_t)(brace - data) : 0;
    json_t *root = brace && draw(&state, 16) ? json_loadb((const char *)brace, size - before, 0, NULL) : NULL;
    size_t written = 0;
    if (root) {
        for (size_t i = 1 + draw(&state, 3); i > 0; i--) mutate_tree(root, &state);
        written = json_dumpb(root, (char *)data + before, most - before, JSON_COMPACT | JSON_ENCODE_ANY);
        if (before && !draw(&state, 4)) data[draw(&state, before)] = (uint8_t)draw(&state, 256);
    }
    json_decref(root);
    return written && written <= most - before ? before + written : LLVMFuzzerMutate(data, size, most);
}
