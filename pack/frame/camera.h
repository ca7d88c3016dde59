/* Cameras: matrices in any order, or a position and a field of view. */
#ifndef GLINT_PACK_CAMERA_H
#define GLINT_PACK_CAMERA_H

#include "glint/capture.h"
#include "node.h"

/* The projection that a matrix describes, for a depth buffer in [0, 1]. */
struct projection {
    bool is_reversed, is_infinite;
    double near, far; /* units */
};
struct projection projection_of(const double view_to_clip[16], enum glint_clip_z clip_z);
enum glint_depth_encoding projection_encoding(const struct projection *projection);

/* How the frame's matrices are listed. */
struct matrix_order {
    bool is_transposed, is_column_major, is_row_vectors;
};
/* `frame`: the manifest's frame. */
bool matrix_order_read(const struct node *frame, struct matrix_order *order, struct glint_error *err);
/* Any matrix, as the frame lists its own; the key must be there. */
bool matrix_read(const struct node *frame, const struct node *node, const char *key, double out[16],
                 struct glint_error *err);
/* "world_to_view" or its inverse; *found: whether it was said. */
bool view_read(const struct node *node, const char *prefix, const struct matrix_order *order, double out[16],
               bool *found, struct glint_error *err);
bool camera_read(const struct node *frame, const struct node *node, const char *prefix,
                 const struct matrix_order *order, uint32_t width, uint32_t height, struct glint_camera *camera,
                 struct glint_error *err);

#endif
