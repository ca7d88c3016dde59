/* Pictures of which only a part reflects. */
#ifndef GLINT_SAMPLES_SHARE_H
#define GLINT_SAMPLES_SHARE_H

#include "render.h"

/* Of all pixels options->reflecting reflect, those of a block in the picture's middle, or squares of 2 x 2 that are scattered
   over it: squares are smooth (0.05) or rough (0.4) at random, so that every pass has its share of work in each part of the
   picture. What else is known of the pixels stays. */
void share_reflections(const struct glint_sample_options *options, struct pixel *pixels);

#endif
