/* Attributes of a capture as keys of a manifest. */
#ifndef GLINT_PACK_ATTRIBUTES_H
#define GLINT_PACK_ATTRIBUTES_H

#include <jansson.h>

#include "glint/exr.h"

/* The manifest's frame, from the attributes of `gbuffer`. NULL when out of memory. */
json_t *extract_frame(const struct glint_exr_part_info *gbuffer);
/* Adds what a part's attributes say: encodings, cubemap, planar, and attributes that glint does not know. False: an attribute cannot be
   written as JSON, or there was no memory. */
bool extract_attributes(const struct glint_exr_part_info *part, json_t *out, struct glint_error *err);
/* The engine's format of a channel, as glint.storage has it. */
const char *extract_storage(const struct glint_exr_part_info *part, const struct glint_channel_info *channel,
                            char text[64]);

#endif
