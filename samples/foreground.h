/* What a first-person game holds before its camera: seen by it alone, reflected by nothing. */
#ifndef SAMPLES_FOREGROUND_H
#define SAMPLES_FOREGROUND_H

#include "view.h"

/* Adds a gun and the hands that hold it to the scene, where the camera of frame 1 has them, and their stencil class. They
   move as the camera does, but do not turn with it. */
void foreground_add(struct scene *scene, const struct glint_sample_options *options);

#endif
