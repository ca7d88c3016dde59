/* Finds keys of the manifest. */
#include "keys.h"

#include <string.h>

#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)
#define REQUIRED true
#define OPTIONAL false

/* An object is one row without a name, followed by its keys. */
enum {
#define OBJECT(id, name, meaning) ROW_##id,
#define KEY(...) CAT(ROW_AT_, __LINE__),
#include "keys_rows.h"
    ROW_END
};

static const struct key rows[] = {
#define OBJECT(id, name, meaning) {NULL, KEY_ANY, name, false, "", meaning},
#define KEY(name, kind, detail, need, fallback, meaning) {name, KEY_##kind, detail, need, fallback, meaning},
#include "keys_rows.h"
    {NULL, KEY_ANY, "", false, "", ""},
};

const struct object pack_objects[] = {
#define OBJECT(id, name, meaning) {name, meaning, &rows[ROW_##id + 1]},
#define KEY(...)
#include "keys_rows.h"
    {NULL, NULL, NULL},
};

const struct object *pack_object(const char *name) {
    for (const struct object *object = pack_objects; object->name; object++)
        if (!strcmp(object->name, name)) return object;
    return NULL;
}

const struct key *pack_key(const struct object *object, const char *name) {
    for (const struct key *key = object->keys; key->name; key++)
        if (!strcmp(key->name, name)) return key;
    return NULL;
}
