/* Which face of a cube map a direction meets, as Vulkan orients faces. */
#ifndef GLINT_VIEWER_CUBE_FACE_H
#define GLINT_VIEWER_CUBE_FACE_H

#ifdef __cplusplus
extern "C" {
#endif

/* 0 to 5: +X -X +Y -Y +Z -Z; u and v in [0, 1] from its top left corner. */
int cube_face_of(const double direction[3], double *u, double *v);

#ifdef __cplusplus
}
#endif
#endif
