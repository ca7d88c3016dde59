/* Writes pictures as PNG files. */
#ifndef GLINT_VIEWER_PNG_FILE_H
#define GLINT_VIEWER_PNG_FILE_H

#include "draw/view/picture.h"

/* Writes a temporary file that is renamed when complete, or to stdout for "-". 8-bit RGB, marked as sRGB. */
bool png_file_write(const char *path, const struct picture *picture, struct glint_error *err);
/* The same file in memory, malloc'd. */
bool png_encode(const struct picture *picture, uint8_t **bytes, size_t *size, struct glint_error *err);
/* Writes two or more pictures of one size as an endless animation, each shown for `turn_ms`. Viewers without support
   for animation show the first. */
bool png_file_animate(const char *path, const struct picture *pictures, size_t count, uint32_t turn_ms,
                      struct glint_error *err);

#endif
