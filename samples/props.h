/* Objects that several scenes share, placed on the ground at the scene's current place. */
#ifndef SAMPLES_PROPS_H
#define SAMPLES_PROPS_H

#include "scene.h"

/* A car of 4.3 m that faces +X. A parked one has a simplified version for cube maps; a moving one moves by the scene's step and is not
   in cube maps. */
void prop_car(struct scene *scene, vec3 paint, bool moving);
/* A pole of 6 m with a spot light on an arm that reaches 1.8 m along +X. */
void prop_street_lamp(struct scene *scene, vec3 intensity);
/* Posts and two thin bars along +X. */
void prop_railing(struct scene *scene, float length_m);
void prop_flower_pot(struct scene *scene, float height_m);
/* A shrub in a tub with stippled leaves. */
void prop_shrub(struct scene *scene, float height_m);
/* Steps of 0.17 m by 0.30 m that rise towards -Z. */
void prop_stairs(struct scene *scene, uint32_t count, float width_m, const struct material *material);

/* Adds a wall to the mesh that was begun last: along +X and +Y from 0, `thickness_m` deep towards +Z, with openings in ascending order
   that do not overlap. */
struct opening {
    float from, to, low, high;
};
void prop_wall(struct scene *scene, float length_m, float height_m, float thickness_m, const struct opening *openings,
               uint32_t count);
/* The frame and bars of a window in such an opening. */
void prop_window_frame(struct scene *scene, const struct opening *opening, float thickness_m, uint32_t columns,
                       uint32_t rows);

#endif
