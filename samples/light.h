/* What an engine has of its light beside the picture: sun and lamps, a shadow map, a shadow mask, ambient occlusion, a volume of light. */
#ifndef SAMPLES_LIGHT_H
#define SAMPLES_LIGHT_H

#include "air.h"

/* The frame's sun and lamps, moved by the offset. */
void light_describe(const struct scene *scene, const double offset[3], struct glint_frame *frame);

/* Writes the parts `indirect` and `emissive`, where the scene has such light, and the ones that the options ask for. air: NULL without clouds. */
bool light_write(const struct dump *dump, const struct world *world, const struct air *air, const struct pixel *pixels,
                 const struct glint_sample_options *options, struct job *job, struct glint_error *err);

#endif
