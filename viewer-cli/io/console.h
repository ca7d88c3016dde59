/* The terminal that a command prints to: its width, its colours, and lines that are wrapped at words. */
#ifndef GLINT_VIEWER_CONSOLE_H
#define GLINT_VIEWER_CONSOLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* From here on long lines of stdout and stderr are wrapped at words where they are terminals. Called once, by main. */
void console_begin(void);
/* From here on stdout is written as it is: JSON, CSV, pictures. */
void console_plain(void);
/* The number of columns of the terminal that `out`, stdout or stderr, is; 0 if it is not one. */
size_t console_width(FILE *out);

/* What a text is, as a colour. Without colour it must be as clear. */
enum mark { MARK_NONE, MARK_TITLE, MARK_GOOD, MARK_WARN, MARK_FAIL };
/* The escape sequences around a marked text, or "" without colour. */
const char *mark_begin(FILE *out, enum mark mark);
const char *mark_end(FILE *out, enum mark mark);
/* Prints a marked text to stdout; line breaks belong outside of it. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void mark_print(enum mark mark, const char *format, ...);

/* The values of --color, NULL-terminated, and the choice. The default, auto, is colour on terminals unless $NO_COLOR is set. */
extern const char *const console_colors[];
void console_choose_color(int choice);

#endif
