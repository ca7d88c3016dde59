/* The weapon of a first-person game, which only the camera sees and nothing reflects. */
#ifndef SAMPLES_FOREGROUND_H
#define SAMPLES_FOREGROUND_H

#include "view.h"

/* Adds a gun, the hands that hold it and their stencil class to the scene, placed for the camera of frame 1. They move with the camera
   but do not turn with it. */
void foreground_add(struct scene *scene, const struct glint_sample_options *options);

#endif
