/* Finds keys of the manifest, and the known name that is nearest to an unknown one. */
#include "keys.h"

#include <ctype.h>
#include <stdio.h>
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

/* ---- Suggestions ---- */

enum { LONGEST = 64 };

/* Levenshtein's distance without regard to case; names that are longer than LONGEST are far from everything. */
static size_t distance_of(const char *a, const char *b) {
    const size_t n = strlen(a), m = strlen(b);
    size_t row[LONGEST + 1];
    if (n > LONGEST || m > LONGEST) return LONGEST;
    for (size_t j = 0; j <= m; j++) row[j] = j;
    for (size_t i = 1; i <= n; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= m; j++) {
            const size_t change = diagonal + (tolower((unsigned char)a[i - 1]) != tolower((unsigned char)b[j - 1]));
            diagonal = row[j];
            size_t best = row[j] < row[j - 1] ? row[j] + 1 : row[j - 1] + 1;
            row[j] = best < change ? best : change;
        }
    }
    return row[m];
}

struct suggestion suggestion_for(const char *wanted) {
    return (struct suggestion){.wanted = wanted, .distance = LONGEST};
}

void suggestion_offer(struct suggestion *suggestion, const char *name) {
    const size_t distance = distance_of(suggestion->wanted, name);
    if (distance >= suggestion->distance) return;
    suggestion->distance = distance;
    suggestion->best = name;
}

const char *suggestion_text(struct suggestion *suggestion) {
    suggestion->text[0] = '\0';
    if (suggestion->best && suggestion->distance <= 1 + strlen(suggestion->wanted) / 3)
        snprintf(suggestion->text, sizeof suggestion->text, "; did you mean \"%.80s\"?", suggestion->best);
    return suggestion->text;
}
