/* What follows from a change of the frame's pixels: cameras, motion and what the truth says of the screen. Shared by glint_edit_crop and
   glint_edit_reduce. */
#ifndef GLINT_EDIT_FRAME_H
#define GLINT_EDIT_FRAME_H

#include "edit_internal.h"

/* The new frame's pixel i is pixel first + step · i of the frame before, on each axis. */
struct glint_edit_map {
    struct glint_edit *edit;
    struct glint_capture *capture; /* as the file has it, before all changes */
    uint32_t size[2];              /* of the frame before */
    uint32_t first[2], count[2];   /* count: size of the new frame */
    uint32_t step;
    struct glint_error *err;
};

/* Opens the capture that is edited. `first`, `count` and `step` are the caller's. */
bool glint_edit_map_open(struct glint_edit_map *map, struct glint_edit *edit, struct glint_error *err);
void glint_edit_map_close(struct glint_edit_map *map);
/* Changes every part, the gbuffer first. */
typedef bool (*glint_edit_map_change)(const struct glint_edit_map *map, size_t p);
bool glint_edit_map_parts(const struct glint_edit_map *map, glint_edit_map_change change);
/* Where the new picture begins in the old one, and how much of it it covers, in pixels of the old one. It may begin before it and end after it. */
double glint_edit_map_begin(const struct glint_edit_map *map, int axis);
double glint_edit_map_covered(const struct glint_edit_map *map, int axis);

/* Projections and jitter. */
bool glint_edit_map_cameras(const struct glint_edit_map *map);
/* The range of packed motion. */
bool glint_edit_map_range(const struct glint_edit_map *map);
/* Motion and the truth's mirror rays in a part of the frame's size, whose pixels are the new frame's already. */
bool glint_edit_map_part(const struct glint_edit_map *map, size_t p);

/* How many times smaller than the frame before an image of the engine's is, with sizes rounded up or down; 0: a cube map, or no whole number of
   times, of which the edit's user is told. */
uint32_t glint_edit_map_ratio(const struct glint_edit_map *map, const struct glint_exr_part_info *part, bool *up);

#endif
