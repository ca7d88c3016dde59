/* Loads scenes from glTF 2 files through Assimp. */
#ifndef SAMPLES_GLTF_H
#define SAMPLES_GLTF_H

#include "scene.h"

/* Supports base colour, roughness, metalness, emission and normals as factors, vertex colours and textures (PNG, JPEG; alpha mask, but
   no blending), and the first camera. Without a camera, the view shows the whole scene. */
bool gltf_load(const char *path, struct scene *scene, struct glint_error *err);

#endif
