/* Reads a texture's file. */
#ifndef GLINT_PACK_READ_H
#define GLINT_PACK_READ_H

#include "image.h"

/* Reads the file as the texture's node says; `cube`: it is wanted as a cube map, and no single face. Errors name the node. */
bool image_read(struct image *image, const struct node *texture, const char *path, bool cube, struct glint_error *err);

#endif
