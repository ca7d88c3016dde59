/* A glTF file's own numbers, checked before an importer trusts them. */
#ifndef SAMPLES_GLTF_CHECK_H
#define SAMPLES_GLTF_CHECK_H

#include "glint/common.h"

#include <stdint.h>

/* What the importer does not say, or not reliably. */
struct gltf_facts {
    uint64_t triangles; /* that the meshes should have */
    double fov_y_rad;   /* of the first camera; 0: not a perspective camera */
};

/* True for a glTF 2 file (.gltf or .glb) in which every buffer is there in full, every view and accessor lies inside
   what it refers to, and every index of the file's own objects refers to something. */
bool gltf_check(const char *path, struct gltf_facts *facts, struct glint_error *err);

#endif
