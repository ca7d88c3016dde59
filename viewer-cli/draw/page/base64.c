/* Encodes bytes as JSON strings. */
#include "draw/page/base64.h"

#include <stdlib.h>
#include <string.h>

json_t *base64_json(const char *before, const uint8_t *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = malloc(strlen(before) + (size + 2) / 3 * 4 + 1);
    if (!text) return NULL;
    char *to = stpcpy(text, before);
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const uint32_t v = (uint32_t)bytes[i] << 16 | (uint32_t)(left > 1 ? bytes[i + 1] : 0) << 8 |
                           (uint32_t)(left > 2 ? bytes[i + 2] : 0);
        *to++ = digits[v >> 18];
        *to++ = digits[v >> 12 & 63];
        *to++ = left > 1 ? digits[v >> 6 & 63] : '=';
        *to++ = left > 2 ? digits[v & 63] : '=';
    }
    json_t *json = json_stringn(text, (size_t)(to - text));
    free(text);
    return json;
}
