/* Texts as files. */
#ifndef GLINT_VIEWER_TEXT_FILE_H
#define GLINT_VIEWER_TEXT_FILE_H

#include <stdio.h>

#include "glint/common.h"

/* To a temporary file that is renamed when complete. */
bool text_file_write(const char *path, const char *text, struct glint_error *err);

/* A text as a cell of CSV, in quotes. */
void csv_text(FILE *out, const char *text);

#endif
