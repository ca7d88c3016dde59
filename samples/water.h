/* Still water with ripples: a level plane over the scene's bottom, which rays otherwise pass. */
#ifndef SAMPLES_WATER_H
#define SAMPLES_WATER_H

#include "render.h"

struct water_pixel {
    float depth; /* of the surface, along the view axis; INFINITY: none */
    vec3 normal; /* rounded to half floats, as the engine's buffer holds it */
    vec3 color;  /* of the light that the water scatters */
    float opacity, thickness;
    vec3 scene; /* what the camera sees, the water included */
};

/* Over the frame's own pixels. `scene` is exact: Fresnel's formulas, the reflected and the refracted ray each followed to
   where it ends. Neither meets the water again. */
bool render_water(const struct world *world, const struct view *view, const struct pixel *pixels,
                  struct water_pixel *water, struct job *job, double weight, struct glint_error *err);

/* The camera that sees what is above the water upside down, at any size of picture. */
struct view mirrored_view(const struct water *water, const struct view *view);
/* Nothing below the water is drawn. Alpha is left alone; distance is along the view axis. */
bool render_planar(const struct world *world, const struct view *mirrored, struct texel *texels, struct job *job,
                   double weight, struct glint_error *err);

#endif
