/* Colour maps of false-colour images. */
#ifndef GLINT_VIEWER_COLORMAP_H
#define GLINT_VIEWER_COLORMAP_H

#include "draw/view/picture.h"

/* Viridis for t in [0, 1], perceptually uniform from dark blue to yellow. */
struct rgb colormap_viridis(double t);
/* The colour of a category; small numbers have different ones, and 0 is dark grey. */
struct rgb colormap_category(uint32_t index);

#endif
