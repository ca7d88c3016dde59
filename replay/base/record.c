/* Records as text. */
#include "record.h"

#include <stdlib.h>
#include <string.h>

#include "shown.h"

struct text {
    char *bytes;
    size_t length, capacity;
    bool failed;
};

static int append(const char *bytes, size_t length, void *user) {
    struct text *text = user;
    const size_t needed = text->length + length + 1;
    if (!text->failed && needed > text->capacity) {
        const size_t capacity = needed > 2 * text->capacity ? needed : 2 * text->capacity;
        char *longer = realloc(text->bytes, capacity);
        text->failed = !longer;
        if (longer) text->bytes = longer, text->capacity = capacity;
    }
    if (text->failed) return -1;
    memcpy(text->bytes + text->length, bytes, length);
    text->bytes[text->length += length] = '\0';
    return 0;
}

char *record_text(const json_t *record, size_t flags) {
    struct text text = {0};
    const bool whole = record && json_dump_callback(record, append, &text, flags) == 0 && !text.failed;
    if (whole) return shown_json(text.bytes);
    free(text.bytes);
    return NULL;
}
