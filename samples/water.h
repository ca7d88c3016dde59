/* Calm water with ripples: a plane above the scene's bottom, which other rays do not hit. */
#ifndef SAMPLES_WATER_H
#define SAMPLES_WATER_H

#include "render.h"

#define WATER_INDEX 1.333f /* refractive index */

struct water_pixel {
    float depth; /* of the surface, along the view axis; INFINITY: none */
    vec3 normal; /* rounded to half floats as in the engine's buffer */
    vec3 color;  /* colour of the light that the water scatters */
    float opacity, thickness;
    vec3 scene; /* the image including the water */
};

/* The unit normal of the surface there: of a sum of waves, whose heights are negligible. */
vec3 water_normal(const struct water *water, vec3 at);
/* Renders water over the pixels of the frame. `scene` is exact: Fresnel's equations, with both the reflected and the refracted ray
   traced to their hits, which do not hit the water again. */
bool render_water(const struct world *world, const struct view *view, const struct pixel *pixels,
                  struct water_pixel *water, struct job *job, double weight, struct glint_error *err);

/* The camera mirrored at the water, for an image of any size. */
struct view mirrored_view(const struct water *water, const struct view *view);
/* Renders everything above the water. Alpha stays unchanged; distance is along the view axis. */
bool render_planar(const struct world *world, const struct view *mirrored, struct texel *texels, struct job *job,
                   double weight, struct glint_error *err);

#endif
