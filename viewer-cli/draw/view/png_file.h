/* Pictures as PNG files. */
#ifndef GLINT_VIEWER_PNG_FILE_H
#define GLINT_VIEWER_PNG_FILE_H

#include "draw/view/picture.h"

/* To a temporary file that is renamed when complete, or to stdout for "-". RGB, 8 bits, marked as sRGB. */
bool png_file_write(const char *path, const struct picture *picture, struct glint_error *err);
/* The same of two pictures or more, each shown for `turn_ms`, over and over; they have one size. Viewers that know nothing of
   animation show the first. */
bool png_file_animate(const char *path, const struct picture *pictures, size_t count, uint32_t turn_ms,
                      struct glint_error *err);

#endif
