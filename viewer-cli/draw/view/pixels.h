/* Draws pixels in memory, as wide as the cells of a sheet. */
#ifndef GLINT_VIEWER_PIXELS_H
#define GLINT_VIEWER_PIXELS_H

#include "glint/judge.h"
#include "draw/view/sheet.h"

/* Reads an image of the last run as floats. */
bool pixels_read(struct glint_replay *replay, const struct glint_image *image, struct glint_pixels *pixels,
                 struct glint_error *err);
/* The relative difference |a - b| / (a + b) of two RGB images. It is -inf (no value) where `mask` is 0, or where `error`, the relative
   error of the second image, is infinite, as of a truth whose samples have no weight. A NULL `error` is 0 everywhere. */
bool pixels_difference(const struct glint_pixels *a, const struct glint_pixels *b, const float *error,
                       const uint8_t *mask, struct glint_pixels *difference, struct glint_error *err);
/* A source that borrows the values. */
struct source pixels_source(const struct glint_pixels *pixels, const char *title);
/* Options with the range 0 to 1. */
struct render_options pixels_options(void);
/* Draws a colour image, or one channel in false colours from 0 to 1, with its title below, preceded by `label`. */
bool pixels_draw(struct picture *picture, const struct glint_pixels *pixels, const char *title, const char *label,
                 struct glint_error *err);

#endif
