/* The textures of an engine's clouds and stars, by formulas. Values are those that the engine's formats hold. */
#ifndef SAMPLES_AIR_MAPS_H
#define SAMPLES_AIR_MAPS_H

#include "glint/air.h"
#include "vec.h"

enum { CLOUD_SIDE = 64, CLOUD_SLICES = GLINT_CLOUD_SLICES, CLOUD_NOISE = 32, STAR_SIDE = 256 };

struct air_maps {
    float density[CLOUD_SLICES][CLOUD_SIDE][CLOUD_SIDE], height[CLOUD_SLICES][CLOUD_SIDE][CLOUD_SIDE];
    float noise[CLOUD_NOISE][CLOUD_NOISE][CLOUD_NOISE];
    vec3 stars[6][STAR_SIDE][STAR_SIDE];
};
void air_maps_fill(struct air_maps *maps);

#endif
