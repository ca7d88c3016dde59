/* Panes of glass over the frame: meshes that no other ray meets. */
#ifndef SAMPLES_GLASS_H
#define SAMPLES_GLASS_H

#include "render.h"

struct glass_pixel {
    float depth; /* of the nearest pane, along the view axis; INFINITY: none */
    vec3 normal; /* towards the viewer, rounded to half floats, as the engine's buffer holds it */
    float roughness;
    vec3 color; /* what the pane shows by itself */
    float opacity;
    vec3 scene; /* what the camera sees through and in the nearest pane */
};

/* `panes` is the scene's WORLD_GLASS. `scene` follows the mirror ray to where it ends; both faces of the pane reflect by
   Fresnel's formulas, again and again. */
bool render_glass(const struct world *world, const struct world *panes, const struct view *view,
                  const struct pixel *pixels, struct glass_pixel *glass, struct job *job, double weight,
                  struct glint_error *err);

#endif
