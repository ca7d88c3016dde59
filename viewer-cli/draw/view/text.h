/* Draws text on pictures in the built-in font, DejaVu Sans. */
#ifndef GLINT_VIEWER_TEXT_H
#define GLINT_VIEWER_TEXT_H

#include "draw/view/picture.h"

struct text;
struct text *text_create(uint32_t height_px, struct glint_error *err);
void text_destroy(struct text **text);
int text_measure(struct text *text, const char *string);
/* Draws with the baseline at y. */
void text_draw(struct text *text, struct picture *picture, int x, int y, const char *string, struct rgb color);

#endif
