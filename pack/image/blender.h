/* A manifest for a multilayer EXR file of Blender. */
#ifndef GLINT_PACK_BLENDER_H
#define GLINT_PACK_BLENDER_H

#include "node.h"

/* Adds to the manifest what is in the file: its texture, and channels that the manifest does not say. */
bool blender_add(const struct manifest *manifest, const char *path, struct glint_error *err);

#endif
