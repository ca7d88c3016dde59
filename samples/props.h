/* Things that several scenes share. They stand at the scene's place, on the ground. */
#ifndef SAMPLES_PROPS_H
#define SAMPLES_PROPS_H

#include "scene.h"

/* 4.3 m long, driving towards its +X. Not moving, it has a simplified twin for cube maps; moving, by the scene's step,
   no cube map holds it. */
void prop_car(struct scene *scene, vec3 paint, bool moving);
/* A pole of 6 m whose arm reaches 1.8 m along +X, with a spot light. */
void prop_street_lamp(struct scene *scene, vec3 intensity);
/* Posts and two thin bars along +X. */
void prop_railing(struct scene *scene, float length_m);
void prop_flower_pot(struct scene *scene, float height_m);
/* A shrub in a tub, its leaves stippled. */
void prop_shrub(struct scene *scene, float height_m);
/* Steps that rise towards -Z: `count` of them, 0.17 m by 0.30 m. */
void prop_stairs(struct scene *scene, uint32_t count, float width_m, const struct material *material);

/* A wall of the mesh that was begun last: along +X from 0, up from 0, `thickness_m` deep towards +Z, with openings that
   stand in order and do not overlap. */
struct opening {
    float from, to, low, high;
};
void prop_wall(struct scene *scene, float length_m, float height_m, float thickness_m, const struct opening *openings,
               uint32_t count);
/* Frame and bars of a window in such an opening. */
void prop_window_frame(struct scene *scene, const struct opening *opening, float thickness_m, uint32_t columns,
                       uint32_t rows);

#endif
