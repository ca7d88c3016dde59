/* Colour conversion through OpenColorIO: scene-linear pixels to a view of a display. */
#ifndef GLINT_VIEWER_OCIO_H
#define GLINT_VIEWER_OCIO_H

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

struct ocio_options {
    const char *config;                  /* a file; NULL: $OCIO, else the built-in configuration */
    const char *input;                   /* colour space of the pixels; NULL: the config's linear Rec. 709 */
    const char *display;                 /* NULL: the config's default */
    const char *view;                    /* NULL: the display's default */
    const struct ocio_conversion *ready; /* what ocio_prepare made of the names above, or NULL */
};

/* Finds the conversion, which takes longer than to apply it to a small picture. NULL on failure; an unknown name is an error that lists
   the known ones. */
struct ocio_conversion *ocio_prepare(const struct ocio_options *options, struct glint_error *err);
void ocio_release(struct ocio_conversion **conversion);
/* Converts width × height RGBA floats in place, except alpha. Several threads may use one conversion. */
bool ocio_apply(const struct ocio_options *options, float *rgba, size_t width, size_t height, struct glint_error *err);
/* Calls `each` for every view of every display of the configuration, in its order; `preferred`: the default of its display, and the display
   is the default one. */
bool ocio_list(const char *config, void (*each)(void *user, const char *display, const char *view, bool preferred),
               void *user, struct glint_error *err);
/* "ACES, sRGB, raw": the views of the built-in configuration, malloc'd; NULL on failure. */
char *ocio_builtin_views(void);

#ifdef __cplusplus
}
#endif
#endif
