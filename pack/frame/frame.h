/* The manifest's frame, and the cameras and volumes that parts carry. */
#ifndef GLINT_PACK_FRAME_H
#define GLINT_PACK_FRAME_H

#include "camera.h"

/* Reads `frame` into *out; width and height are those of the G-buffer. */
bool frame_read(const struct node *frame, struct glint_frame *out, uint32_t width, uint32_t height,
                struct glint_error *err);
bool planar_read(const struct node *frame, const struct node *part, struct glint_planar *planar,
                 struct glint_error *err);
void sky_read(const struct node *part, struct glint_sky *sky);
bool probe_read(const struct node *part, struct glint_probe *probe, struct glint_error *err);
bool cubemap_read(const struct node *part, struct glint_cubemap *cubemap, struct glint_error *err);

#endif
