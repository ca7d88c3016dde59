/* Restricts reflections to a fraction of the pixels. */
#ifndef GLINT_SAMPLES_SHARE_H
#define GLINT_SAMPLES_SHARE_H

#include "render.h"

/* The fraction options->reflecting of all pixels reflects, as a block at the centre or as scattered squares of 2 x 2 pixels. Squares
   are smooth (0.05) or rough (0.4) at random, so that every pass has its share of work in each part of the image. Other properties of
   the pixels do not change. */
void share_reflections(const struct glint_sample_options *options, struct pixel *pixels);

#endif
