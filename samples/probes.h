/* Automatic placement of cube maps. */
#ifndef SAMPLES_PROBES_H
#define SAMPLES_PROBES_H

#include "world.h"

/* Replaces the scene's cube maps by up to eight in free space, far from each other, the first one near the camera. */
void place_probes(struct scene *scene, const struct world *world);

#endif
