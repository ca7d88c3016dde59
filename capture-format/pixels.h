/* Converts channels from the caller's type to the stored type. */
#ifndef GLINT_PIXELS_H
#define GLINT_PIXELS_H

#include "glint/capture.h"

/* Half if it represents every value of the type exactly after rounding to the type's steps, else float; uint for integers. */
enum glint_stored glint_pixels_stored(enum glint_type type);
/* The storage format if the engine names none: "half", "float", "uint", "unorm8" … */
const char *glint_pixels_storage(enum glint_type type);
/* `out` is tightly packed and has the stored type. */
void glint_pixels_copy(const struct glint_channel *from, uint32_t width, uint32_t height, void *out);

#endif
