/* Materials of a glTF file: factors, textures, alpha mask. */
#ifndef SAMPLES_GLTF_MATERIAL_H
#define SAMPLES_GLTF_MATERIAL_H

#include "scene.h"

struct aiMaterial;
struct aiScene;

/* Converts a material and adds its look to the scene. `path` is that of the glTF file, next to which images are read. */
bool gltf_material(const struct aiScene *file, const struct aiMaterial *from, const char *path, struct scene *scene,
                   struct material *material, struct glint_error *err);

#endif
