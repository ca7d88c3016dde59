/* From the caller's memory to the type that the file stores. */
#ifndef GLINT_PIXELS_H
#define GLINT_PIXELS_H

#include "glint/capture.h"

/* Half where it gives every value of the type back exactly after rounding to its steps, else float; uint for integers. */
enum glint_stored glint_pixels_stored(enum glint_type type);
/* The engine's format when it names none: "half", "float", "uint", "unorm8" … */
const char *glint_pixels_storage(enum glint_type type);
/* `out` is tight and of the stored type. */
void glint_pixels_copy(const struct glint_channel *from, uint32_t width, uint32_t height, void *out);

#endif
