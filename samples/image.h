/* Decodes untrusted PNG and JPEG files to 8-bit RGBA. */
#ifndef SAMPLES_IMAGE_H
#define SAMPLES_IMAGE_H

#include "glint/common.h"

#include <stddef.h>
#include <stdint.h>

/* The largest width and height of an image. */
enum { IMAGE_MAX_SIDE = 8192 };

/* Returns width × height × 4 bytes, top row first; release with free(). NULL with an error that contains `name` if the bytes are not a
   complete image. Prints nothing. */
uint8_t *image_decode(const char *name, const uint8_t *bytes, size_t size, uint32_t *width, uint32_t *height,
                      struct glint_error *err);

#endif
