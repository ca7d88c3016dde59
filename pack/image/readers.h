/* The readers of files that describe themselves, one a file: image_NAME.c. */
#ifndef GLINT_PACK_READERS_H
#define GLINT_PACK_READERS_H

#include "image.h"

bool image_read_exr(struct image *image, const struct node *texture, const char *path, struct glint_error *err);
bool image_read_blender(struct image *image, const struct node *texture, const char *path, struct glint_error *err);
bool image_read_npy(struct image *image, const struct node *texture, struct glint_error *err);
bool image_read_ktx2(struct image *image, const struct node *texture, struct glint_error *err);
bool image_read_dds(struct image *image, const struct node *texture, struct glint_error *err);

#endif
