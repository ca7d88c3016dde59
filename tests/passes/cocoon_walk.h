/* A second way through the cocoon's image, in double precision and by small steps. */
#ifndef COCOON_WALK_H
#define COCOON_WALK_H
#include <stdint.h>

enum { COCOON_WIDTH = 32, COCOON_WALK = 4096 };

/* The face that a direction meets, and the place on it in [0, 1]², by the two directions that span it. */
uint32_t place_on_face(const double d[3], double place[2]);

/* |v| / distance of the cocoon in direction v, between four samples of one cube map's six faces. */
double cocoon_gauge(const float *cocoon, const double v[3]);

/* The first way out, by small even steps of the angle; < 0: the ray is never inside. `stays`: by how many of them the ray
   was inside, at most. */
double cocoon_walk(const float *cocoon, const double start[3], const double d[3], int *stays);
#endif
