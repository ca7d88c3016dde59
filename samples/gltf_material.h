/* Materials of a glTF file: factors, textures, alpha mask. */
#ifndef SAMPLES_GLTF_MATERIAL_H
#define SAMPLES_GLTF_MATERIAL_H

#include "scene.h"

struct aiMaterial;
struct aiScene;

/* The material, and its look in the scene. `path` is the glTF file's; images are read beside it. */
bool gltf_material(const struct aiScene *file, const struct aiMaterial *from, const char *path, struct scene *scene,
                   struct material *material, struct glint_error *err);

#endif
