/* Finds the cube-map face that a direction hits, with Vulkan's orientation of faces. */
#ifndef GLINT_VIEWER_CUBE_FACE_H
#define GLINT_VIEWER_CUBE_FACE_H

#ifdef __cplusplus
extern "C" {
#endif

/* Returns 0 to 5 for +X -X +Y -Y +Z -Z; u and v are in [0, 1] from the top left corner. */
int cube_face_of(const double direction[3], double *u, double *v);

#ifdef __cplusplus
}
#endif
#endif
