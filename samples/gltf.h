/* Scenes from glTF 2 files, through Assimp. */
#ifndef SAMPLES_GLTF_H
#define SAMPLES_GLTF_H

#include "scene.h"

/* Base colour, roughness, metalness, emission and normals, as factors, vertex colours and textures (PNG, JPEG; alpha
   mask, but no blending), the first camera; a scene without a camera is seen from where all of it fits. */
bool gltf_load(const char *path, struct scene *scene, struct glint_error *err);

#endif
