/* Colours that stand for values. */
#ifndef GLINT_VIEWER_COLORMAP_H
#define GLINT_VIEWER_COLORMAP_H

#include "draw/view/picture.h"

/* Viridis for t in [0, 1]: perceptually even, dark blue to yellow. */
struct rgb colormap_viridis(double t);
/* A colour of its own for each small number; 0 is a dark grey. */
struct rgb colormap_category(uint32_t index);

#endif
