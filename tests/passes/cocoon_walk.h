/* An independent evaluation of the cocoon's image, in double precision and with small steps. */
#ifndef COCOON_WALK_H
#define COCOON_WALK_H
#include <stdint.h>

enum { COCOON_WIDTH = 32, COCOON_WALK = 4096 };

/* The face of a direction, and the position on it in [0, 1]² along the two directions that span the face. */
uint32_t place_on_face(const double d[3], double place[2]);

/* |v| / distance of the cocoon in direction v, interpolated between four samples of the six faces of a cube map. */
double cocoon_gauge(const float *cocoon, const double v[3]);

/* The first exit from the cocoon, by small even steps of the angle; < 0: the ray is never inside. *stays: the largest number of
   consecutive steps inside. */
double cocoon_walk(const float *cocoon, const double start[3], const double d[3], int *stays);
#endif
