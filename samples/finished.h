/* The final image of opaque surfaces: diffuse and reflected light. */
#ifndef SAMPLES_FINISHED_H
#define SAMPLES_FINISHED_H

#include "render.h"

/* The radiance along a ray: what the hit surface emits and scatters, plus one sample (u, v) of its reflection. */
vec3 finished_look(const struct world *world, vec3 origin, vec3 direction, float u, float v);
/* The radiance that a pixel shows of the hit, with one sample of its reflection. */
vec3 finished_pixel(const struct world *world, const struct view *view, const struct pixel *pixel,
                    const struct hit *hit, float u, float v);

/* `picture` has room for the size of the view: `lit` plus the mean of that many rays of each surface's GGX lobe. */
bool render_finished(const struct world *world, const struct view *view, const struct pixel *pixels, uint32_t samples,
                     vec3 *picture, struct job *job, double weight, struct glint_error *err);

#endif
