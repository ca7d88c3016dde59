/* The manifest's lights, and what parts of light and shadow carry. */
#ifndef GLINT_PACK_LIGHT_H
#define GLINT_PACK_LIGHT_H

#include "camera.h"

/* Reads `sun` and `lights` of the manifest's frame. */
bool lights_read(const struct node *frame_node, struct glint_frame *frame, struct glint_error *err);
void indirect_read(const struct node *part, struct glint_indirect *indirect);
bool shadow_read(const struct node *frame, const struct node *part, struct glint_shadow *shadow,
                 struct glint_error *err);
bool volume_read(const struct node *frame, const struct node *part, struct glint_light_volume *volume,
                 struct glint_error *err);
void froxels_read(const struct node *part, struct glint_froxels *froxels);
void truth_read(const struct node *part, struct glint_truth *truth);

#endif
