/* Atmosphere and clouds of a manifest's frame. The writer checks their ranges. */
#ifndef GLINT_PACK_AIR_H
#define GLINT_PACK_AIR_H

#include "glint/capture.h"
#include "node.h"

void air_read(const struct node *frame_node, struct glint_frame *frame);

#endif
