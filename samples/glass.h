/* Renders panes of glass over the frame. Only these rays hit their meshes. */
#ifndef SAMPLES_GLASS_H
#define SAMPLES_GLASS_H

#include "render.h"

struct glass_pixel {
    float depth; /* of the nearest pane, along the view axis; INFINITY: none */
    vec3 normal; /* towards the viewer, rounded to half floats as in the engine's buffer */
    float roughness;
    vec3 color; /* the pane's own colour */
    float opacity;
    vec3 scene; /* the image with transmission and reflection of the nearest pane */
};

/* `panes` is the scene's WORLD_GLASS. `scene` includes the exact mirror ray; both faces of the pane reflect by Fresnel's equations,
   with all interreflections. */
bool render_glass(const struct world *world, const struct world *panes, const struct view *view,
                  const struct pixel *pixels, struct glass_pixel *glass, struct job *job, double weight,
                  struct glint_error *err);

#endif
