/* Shows hidden characters of texts as escapes. */
#include "shown.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The bytes of a UTF-8 sequence that begins with this one; 0 if none does. */
static size_t length_after(unsigned char first) {
    return first < 0x80                    ? 1
           : first >= 0xC2 && first < 0xE0 ? 2
           : first >= 0xE0 && first < 0xF0 ? 3
           : first >= 0xF0 && first < 0xF5 ? 4
                                           : 0;
}

enum { CUT = 0, INVALID = -1 };

/* The bytes of the first character, which is decoded; CUT if they end before it does. */
static int decode(const char *text, size_t size, uint32_t *character) {
    const unsigned char *p = (const unsigned char *)text;
    const size_t length = length_after(*p);
    if (!length) return INVALID;
    *character = length == 1 ? *p : *p & (0x7FU >> length);
    for (size_t i = 1; i < length; i++) {
        if (i == size) return CUT;
        if ((p[i] & 0xC0) != 0x80) return INVALID;
        *character = *character << 6 | (p[i] & 0x3F);
    }
    const bool overlong = (length == 3 && *character < 0x800) || (length == 4 && *character < 0x10000),
               none = (*character >= 0xD800 && *character < 0xE000) || *character > 0x10FFFF;
    return overlong || none ? INVALID : (int)length;
}

static bool is_hidden(uint32_t c) {
    static const uint32_t ranges[][2] = {
        {0, 0x1F},          /* C0 */
        {0x7F, 0x9F},       /* DEL, C1 */
        {0xAD, 0xAD},       /* soft hyphen */
        {0x61C, 0x61C},     /* mark of direction */
        {0x180E, 0x180E},   /* without a width */
        {0x200B, 0x200B},   /* without a width; the joiners after it are letters' */
        {0x200E, 0x200F},   /* marks of direction */
        {0x2028, 0x202E},   /* separators of lines, embeddings and overrides of the direction */
        {0x2060, 0x206F},   /* without a width, isolates */
        {0xFEFF, 0xFEFF},   /* byte order mark */
        {0xFFF9, 0xFFFB},   /* annotations */
        {0xE0000, 0xE007F}, /* tags */
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (c >= ranges[i][0] && c <= ranges[i][1]) return true;
    return false;
}

size_t shown_piece(const char *text, size_t size, char piece[SHOWN_PIECE]) {
    uint32_t c = 0;
    if (*text >= ' ' && *text <= '~') { /* most of all texts */
        piece[0] = *text;
        piece[1] = '\0';
        return 1;
    }
    const int length = decode(text, size, &c);
    if (length == CUT) return 0;
    if (length == INVALID || c < 0x20 || c == 0x7F) {
        const char *letter = length > 0 && c ? strchr("\nn\rr\tt", *text) : NULL;
        if (letter) snprintf(piece, SHOWN_PIECE, "\\%c", letter[1]);
        else snprintf(piece, SHOWN_PIECE, "\\x%02x", (unsigned)(unsigned char)*text);
        return 1;
    }
    if (is_hidden(c)) snprintf(piece, SHOWN_PIECE, c > 0xFFFF ? "\\U%08x" : "\\u%04x", c);
    else snprintf(piece, SHOWN_PIECE, "%.*s", length, text);
    return (size_t)length;
}

/* The first character of what ends with its NUL, where a cut one is as invalid as another. */
static size_t first_piece(const char *text, size_t size, char piece[SHOWN_PIECE]) {
    const size_t taken = shown_piece(text, size, piece);
    if (!taken) snprintf(piece, SHOWN_PIECE, "\\x%02x", (unsigned)(unsigned char)*text);
    return taken ? taken : 1;
}

void shown_text(char *to, size_t room, const char *text) {
    char piece[SHOWN_PIECE];
    size_t used = 0;
    for (size_t left = strlen(text), taken; left; text += taken, left -= taken) {
        taken = first_piece(text, left, piece);
        const size_t length = strlen(piece);
        if (used + length >= room) break;
        memcpy(to + used, piece, length);
        used += length;
    }
    to[used] = '\0';
}

char *shown_copy(const char *text) {
    char piece[SHOWN_PIECE];
    size_t room = 1;
    const char *at = text;
    for (size_t left = strlen(text), taken; left; at += taken, left -= taken) {
        taken = first_piece(at, left, piece);
        room += strlen(piece);
    }
    char *copy = malloc(room);
    if (copy) shown_text(copy, room, text);
    return copy;
}

bool shown_is_plain(const char *text) {
    uint32_t c = 0;
    for (size_t left = strlen(text); left;) {
        const int length = decode(text, left, &c);
        if (length <= 0 || is_hidden(c)) return false;
        text += length;
        left -= (size_t)length;
    }
    return true;
}

/* ---- JSON ---- */

/* Whether the character has to be escaped: those below the space are line breaks and indents outside of strings. Invalid bytes cannot be escaped. */
static bool is_hidden_json(const char *text, size_t left, uint32_t *c, size_t *length) {
    const int bytes = decode(text, left, c);
    *length = bytes > 0 ? (size_t)bytes : 1;
    return bytes > 0 && *c >= 0x20 && is_hidden(*c);
}

static size_t write_escape(char *to, uint32_t c) {
    if (c <= 0xFFFF) return (size_t)snprintf(to, 7, "\\u%04x", c);
    const uint32_t rest = c - 0x10000;
    return (size_t)snprintf(to, 13, "\\u%04x\\u%04x", 0xD800 + (rest >> 10), 0xDC00 + (rest & 0x3FF));
}

char *shown_json(char *json) {
    uint32_t c;
    size_t length, hidden = 0, size = json ? strlen(json) : 0, used = 0;
    for (size_t i = 0; i < size; i += length) hidden += is_hidden_json(json + i, size - i, &c, &length);
    if (!hidden) return json;
    char *text = malloc(size + 12 * hidden + 1);
    for (size_t i = 0; text && i < size; i += length) {
        if (is_hidden_json(json + i, size - i, &c, &length)) used += write_escape(text + used, c);
        else memcpy(text + used, json + i, length), used += length;
    }
    if (text) text[used] = '\0';
    free(json);
    return text;
}
