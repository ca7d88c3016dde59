/* PNG and JPEG files from strangers, as 8-bit RGBA. */
#ifndef SAMPLES_IMAGE_H
#define SAMPLES_IMAGE_H

#include "glint/common.h"

#include <stddef.h>
#include <stdint.h>

/* A side of an image may be at most this long. */
enum { IMAGE_MAX_SIDE = 8192 };

/* Returns width × height × 4 bytes, top row first, for free(). NULL, naming `name`, when the bytes are no whole image of
   either kind. Prints nothing. */
uint8_t *image_decode(const char *name, const uint8_t *bytes, size_t size, uint32_t *width, uint32_t *height,
                      struct glint_error *err);

#endif
