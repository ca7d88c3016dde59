/* The keys that a manifest may have: keys_rows.h as data. */
#ifndef GLINT_PACK_KEYS_H
#define GLINT_PACK_KEYS_H

#include <stdbool.h>
#include <stddef.h>

enum key_kind {
    KEY_TEXT,
    KEY_NUMBER,
    KEY_COUNT,
    KEY_BOOL,
    KEY_NUMBERS,
    KEY_MATRIX,
    KEY_CHOICE,
    KEY_CHOICES,
    KEY_ONE,
    KEY_LIST,
    KEY_MAP,
    KEY_TEXTS,
    KEY_PLANES,
    KEY_ANY
};

struct key {
    const char *name; /* NULL ends the keys of an object */
    enum key_kind kind;
    const char *detail;
    bool required;
    const char *fallback, *meaning;
};

struct object {
    const char *name; /* NULL ends pack_objects */
    const char *meaning;
    const struct key *keys;
};

/* The first one is the whole manifest. */
extern const struct object pack_objects[];
const struct object *pack_object(const char *name);
const struct key *pack_key(const struct object *object, const char *name);

#endif
