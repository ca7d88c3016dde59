/* Pictures of pixels in memory, at the width of a sheet's cells. */
#ifndef GLINT_VIEWER_PIXELS_H
#define GLINT_VIEWER_PIXELS_H

#include "glint/judge.h"
#include "draw/view/sheet.h"

/* An image of the last run as floats. */
bool pixels_read(struct glint_replay *replay, const struct glint_image *image, struct glint_pixels *pixels,
                 struct glint_error *err);
/* How far two images of R G B are apart: |a - b| over their sum. Not compared, -inf, where `mask` is 0 or the relative
   error of the second is infinite, as that of a truth without weight; NULL: it is known everywhere. */
bool pixels_difference(const struct glint_pixels *a, const struct glint_pixels *b, const float *error,
                       const uint8_t *mask, struct glint_pixels *difference, struct glint_error *err);
/* As what is shown, borrowing the values. */
struct source pixels_source(const struct glint_pixels *pixels, const char *title);
/* From 0 to 1. */
struct render_options pixels_options(void);
/* Colour, or one channel in false colour from 0 to 1, with its title below; `label` goes before it. */
bool pixels_draw(struct picture *picture, const struct glint_pixels *pixels, const char *title, const char *label,
                 struct glint_error *err);

#endif
