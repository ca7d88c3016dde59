/* Colour conversion through OpenColorIO: scene-linear pixels to a view of a display. */
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

/* Converts width × height RGBA floats in place, except alpha. An unknown name is an error that lists the known ones. */
bool ocio_apply(const struct ocio_options *options, float *rgba, size_t width, size_t height, struct glint_error *err);
/* "ACES, sRGB, raw": the views of the built-in configuration, malloc'd; NULL on failure. */
char *ocio_builtin_views(void);

#ifdef __cplusplus
}
#endif
#endif
