/* The finished picture of opaque surfaces: what they reflect, over what they scatter. */
#ifndef SAMPLES_FINISHED_H
#define SAMPLES_FINISHED_H

#include "render.h"

/* What arrives along a ray: what leaves the point it meets, with one drawn share (u, v) of what that reflects. */
vec3 finished_look(const struct world *world, vec3 origin, vec3 direction, float u, float v);

/* `picture` has room for the view's size: `lit`, and the mean of so many rays of the surfaces' own GGX lobes. */
bool render_finished(const struct world *world, const struct view *view, const struct pixel *pixels, uint32_t samples,
                     vec3 *picture, struct job *job, double weight, struct glint_error *err);

#endif
