/* Bakes indirect light to vertices, as games bake light maps: shading is then free of noise and cheap. */
#ifndef SAMPLES_BAKE_H
#define SAMPLES_BAKE_H

#include "parallel.h"
#include "world.h"

/* Computes the `light` of every mesh: sky, emissive surfaces and `bounces` of diffuse light with `samples` rays per vertex. Moving
   meshes are lit at their positions at frame 1 and do not affect others. */
bool bake_light(struct scene *scene, uint32_t samples, struct job *job, double weight, struct glint_error *err);

#endif
