/* Colour through OpenColorIO: scene-linear pixels to a display's view. */
#ifndef GLINT_VIEWER_OCIO_H
#define GLINT_VIEWER_OCIO_H

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

struct ocio_options {
    const char *config;  /* a file; NULL: $OCIO, else the built-in configuration */
    const char *input;   /* colour space of the pixels; NULL: the config's linear Rec. 709 */
    const char *display; /* NULL: the config's default */
    const char *view;    /* NULL: the display's default */
};

/* Converts width × height RGBA floats in place; alpha is kept. Unknown names are errors that list the known ones. */
bool ocio_apply(const struct ocio_options *options, float *rgba, size_t width, size_t height, struct glint_error *err);
/* "ACES, sRGB, raw": the built-in configuration's views. malloc'd; NULL on failure. */
char *ocio_builtin_views(void);

#ifdef __cplusplus
}
#endif
#endif
