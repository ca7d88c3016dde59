/* Command lines that a user may copy into a shell. */
#ifndef GLINT_VIEWER_SHELL_H
#define GLINT_VIEWER_SHELL_H

#include <stdio.h>

/* Writes a text as one word of a shell, quoted where that is needed. Hidden characters (shown.h) become escapes of $'…', which Bash, Zsh and
   POSIX of 2024 have, so that no terminal acts on them when the line is printed or pasted. */
void shell_word(FILE *out, const char *text);
/* The same of a path, which is no option, whatever it begins with. */
void shell_path(FILE *out, const char *path);

#endif
