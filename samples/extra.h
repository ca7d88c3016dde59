/* What an engine has beside the picture and its light: the mask of stippled pixels, caustics, curvature, light in the air. */
#ifndef SAMPLES_EXTRA_H
#define SAMPLES_EXTRA_H

#include "dump.h"

/* Writes the parts that the options ask for. */
bool extra_write(const struct dump *dump, const struct world *world, const struct glint_sample_options *options,
                 struct job *job, struct glint_error *err);

#endif
