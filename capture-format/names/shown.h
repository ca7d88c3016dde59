/* Texts of strangers as they may be shown: names in files, names of files, messages of libraries. For glint's own libraries and its program.

   Hidden characters are those that a terminal or a reader's eye is steered by: control characters (C0, DEL, C1), marks and overrides of
   the direction of writing, separators of lines, characters without a width, and bytes that are no UTF-8. They are shown as escapes:
   \n, \r, \t, \x1b for a byte, \u202e for a character. Everything else, a backslash included, stays as it is. */
#ifndef GLINT_SHOWN_H
#define GLINT_SHOWN_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SHOWN_PIECE = 13 }; /* room for the longest escape, or a character as it is */

/* Writes the first character of the text as it is shown, and returns its bytes; 0 if these are only the beginning of a character. */
size_t shown_piece(const char *text, size_t size, char piece[SHOWN_PIECE]);
/* Writes the text as it is shown, on one line, cut between characters where it does not fit. `to` may not overlap the text. */
void shown_text(char *to, size_t room, const char *text);
/* The same, malloc'd; NULL without memory. */
char *shown_copy(const char *text);
/* Whether nothing of the text is hidden. */
bool shown_is_plain(const char *text);

/* JSON text with the hidden characters of its strings as \u escapes: other characters stay as they are. Takes `json`, malloc'd or NULL, and
   returns it or a longer one; NULL without memory. */
char *shown_json(char *json);

#ifdef __cplusplus
}
#endif

#endif
