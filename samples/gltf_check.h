/* Validates the numbers in a glTF file before an importer uses them. */
#ifndef SAMPLES_GLTF_CHECK_H
#define SAMPLES_GLTF_CHECK_H

#include "glint/common.h"

#include <stdint.h>

/* Facts that the importer does not report, or not reliably. */
struct gltf_facts {
    uint64_t triangles; /* number of triangles that the meshes declare */
    double fov_y_rad;   /* of the first camera; 0: not a perspective camera */
};

/* True for a glTF 2 file (.gltf or .glb) whose buffers are complete, whose views and accessors lie inside of what they refer to, and
   whose indices of objects are all valid. */
bool gltf_check(const char *path, struct gltf_facts *facts, struct glint_error *err);

#endif
