/* Light that bounces, baked to vertices once, as games bake it to light maps: shading stays noise-free and cheap. */
#ifndef SAMPLES_BAKE_H
#define SAMPLES_BAKE_H

#include "parallel.h"
#include "world.h"

/* Gives every mesh its `light`: sky, emissive surfaces and `bounces` of diffuse light, `samples` rays a vertex. Moving
   meshes are lit where they stand at frame 1, and do not light or darken anything. */
bool bake_light(struct scene *scene, uint32_t samples, struct job *job, double weight, struct glint_error *err);

#endif
