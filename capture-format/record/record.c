/* Records as text, and text in records. */
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

/* The bytes that follow the first one of a character, and the least and the greatest that the next one may be; -1 of no first one. */
static int following(unsigned char first, unsigned char *least, unsigned char *greatest) {
    *least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
    *greatest = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
    if (first < 0x80) return 0;
    return first < 0xC2 ? -1 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : first < 0xF5 ? 3 : -1;
}

bool record_can_hold(const char *text) {
    for (const unsigned char *at = (const unsigned char *)text; *at;) {
        unsigned char least, greatest;
        const int count = following(*at++, &least, &greatest);
        if (count < 0) return false;
        for (int i = 0; i < count; i++, at++) {
            if (*at < least || *at > greatest) return false;
            least = 0x80, greatest = 0xBF;
        }
    }
    return true;
}
