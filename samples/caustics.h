/* Sunlight that the ripples of water focus on its bottom. */
#ifndef SAMPLES_CAUSTICS_H
#define SAMPLES_CAUSTICS_H

#include "dump.h"

/* Writes the part water.caustics, in scenes with water and a sun. */
bool caustics_write(const struct dump *dump, const struct world *world, struct job *job, struct glint_error *err);

#endif
