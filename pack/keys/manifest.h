/* Reads a manifest into memory. */
#ifndef GLINT_PACK_MANIFEST_H
#define GLINT_PACK_MANIFEST_H

#include "node.h"

/* Reads and parses the file, and checks every key and kind of value by keys_rows.h, but not the channels of parts. */
bool manifest_open(struct manifest *manifest, const char *path, const struct glint_pack_options *options,
                   struct faults *faults, struct glint_error *err);
/* The path of a file that the manifest names at this node, malloc'd; NULL with an error where it lies outside the manifest's folder, by .., by a
   link or by an absolute path, and the options do not allow that. */
char *manifest_file(const struct node *node, const char *name, struct glint_error *err);
void manifest_close(struct manifest *manifest);

#endif
