/* The terminal that a command prints to: its width, its colours, lines that are wrapped at words, and no control character but glint's own. */
#ifndef GLINT_VIEWER_CONSOLE_H
#define GLINT_VIEWER_CONSOLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* From here on hidden characters (shown.h) that are printed to stdout and stderr, terminals or not, are shown as escapes, except for line
   breaks and what console_code sends, and long lines are wrapped at words on terminals. Called once, by main; false without memory. A name
   that may have line breaks of its own is printed through name_text. */
bool console_begin(void);
/* Writes what is left of a line. */
void console_end(void);
/* Whether stdout is written as it is from here on: JSON, CSV, pictures. */
void console_plain(bool plain);
/* Sends a control sequence to `out`, stdout or stderr. */
void console_code(FILE *out, const char *code);
/* A name of a stranger as it is printed, on one line. Valid for a few calls of the same thread. */
const char *name_text(const char *name);
/* The number of columns of the terminal that `out`, stdout or stderr, is; 0 if it is not one. */
size_t console_width(FILE *out);

/* What a text is, as a colour. Without colour it must be as clear. */
enum mark { MARK_NONE, MARK_TITLE, MARK_GOOD, MARK_WARN, MARK_FAIL };
/* What is printed to `out` between these is marked. */
void mark_begin(FILE *out, enum mark mark);
void mark_end(FILE *out, enum mark mark);
/* Prints a marked text to stdout; line breaks belong outside of it. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void mark_print(enum mark mark, const char *format, ...);

/* The values of --color, NULL-terminated, and the choice. The default, auto, is colour on terminals unless $NO_COLOR is set. */
extern const char *const console_colors[];
void console_choose_color(int choice);

#endif
