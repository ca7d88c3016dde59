/* Quotes words of command lines. */
#include "io/shell.h"

#include <string.h>

#include "shown.h"

/* $'…', where bytes of hidden characters are octal, which ends after three digits. */
static void put_escaped(FILE *out, const char *text) {
    fputs("$'", out);
    for (char piece[SHOWN_PIECE]; *text;) {
        const size_t whole = shown_piece(text, strlen(text), piece), bytes = whole ? whole : 1;
        const bool plain = whole && !strncmp(piece, text, bytes) && !piece[bytes];
        for (size_t i = 0; i < bytes; i++, text++)
            if (!plain) fprintf(out, "\\%03o", (unsigned)(unsigned char)*text);
            else if (*text == '\'' || *text == '\\') fprintf(out, "\\%c", *text);
            else fputc(*text, out);
    }
    fputc('\'', out);
}

void shell_word(FILE *out, const char *text) {
    const size_t plain = strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=,:+@%-");
    if (*text && !text[plain]) {
        fputs(text, out);
        return;
    }
    if (!shown_is_plain(text)) {
        put_escaped(out, text);
        return;
    }
    fputc('\'', out);
    for (; *text; text++)
        if (*text == '\'') fputs("'\\''", out);
        else fputc(*text, out);
    fputc('\'', out);
}

void shell_path(FILE *out, const char *path) {
    if (path[0] != '-') {
        shell_word(out, path);
        return;
    }
    fputs("./", out);
    shell_word(out, path);
}
