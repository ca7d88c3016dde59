/* Finds the cube-map face that a direction hits. */
#include "capture/cube_face.h"

#include <math.h>

int cube_face_of(const double d[3], double *u, double *v) {
    const double a[3] = {fabs(d[0]), fabs(d[1]), fabs(d[2])};
    const int axis = a[0] >= a[1] && a[0] >= a[2] ? 0 : a[1] >= a[2] ? 1 : 2;
    const double across[6] = {-d[2], d[2], d[0], d[0], d[0], -d[0]},
                 down[6] = {-d[1], -d[1], d[2], -d[2], -d[1], -d[1]};
    const int face = 2 * axis + (d[axis] < 0);
    *u = 0.5 * (across[face] / a[axis] + 1);
    *v = 0.5 * (down[face] / a[axis] + 1);
    return face;
}
