/* The light that the engine collects in the air before the camera: cells of the view frustum. */
#ifndef SAMPLES_FROXELS_H
#define SAMPLES_FROXELS_H

#include "dump.h"

/* Writes the part `froxels`, in a scene with fog. */
bool froxels_write(const struct dump *dump, const struct world *world, struct job *job, struct glint_error *err);

#endif
