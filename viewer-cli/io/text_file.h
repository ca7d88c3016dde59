/* Writes text files. */
#ifndef GLINT_VIEWER_TEXT_FILE_H
#define GLINT_VIEWER_TEXT_FILE_H

#include <stdio.h>

#include "glint/common.h"

/* Writes a temporary file and renames it when complete. */
bool text_file_write(const char *path, const char *text, struct glint_error *err);

/* Writes a text as a quoted cell of CSV. */
void csv_text(FILE *out, const char *text);

#endif
