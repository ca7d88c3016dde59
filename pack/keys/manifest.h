/* Reads a manifest into memory. */
#ifndef GLINT_PACK_MANIFEST_H
#define GLINT_PACK_MANIFEST_H

#include "node.h"

/* Reads and parses the file, and checks every key and kind of value by keys_rows.h, but not the channels of parts. */
bool manifest_open(struct manifest *manifest, const char *path, const struct glint_pack_options *options,
                   struct faults *faults, struct glint_error *err);
void manifest_close(struct manifest *manifest);

#endif
