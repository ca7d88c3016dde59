/* Pictures as PNG files. */
#ifndef GLINT_VIEWER_PNG_FILE_H
#define GLINT_VIEWER_PNG_FILE_H

#include "view/picture.h"

/* To a temporary file that is renamed when complete, or to stdout for "-". RGB, 8 bits, marked as sRGB. */
bool png_file_write(const char *path, const struct picture *picture, struct glint_error *err);

#endif
