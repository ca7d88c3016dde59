/* Converts the structs of capture.h to EXR attributes and back, by the rows of the registry. */
#ifndef GLINT_ATTRIBUTES_H
#define GLINT_ATTRIBUTES_H

#include "arena.h"
#include "check.h"
#include "glint/exr.h"

struct glint_attribute_list {
    struct glint_exr_attribute *all;
    size_t count, capacity;
};

/* Adds a zeroed element; NULL if memory is exhausted. */
struct glint_exr_attribute *glint_attribute_push(struct glint_arena *arena, struct glint_attribute_list *list);
bool glint_attribute_push_string(struct glint_arena *arena, struct glint_attribute_list *list, const char *name,
                                 const char *value);

/* Adds the attributes of `from`, the scope's struct. False if memory is exhausted or a value has no name. */
bool glint_attributes_encode(struct glint_arena *arena, struct glint_attribute_list *list, enum glint_scope scope,
                             const void *from);
/* Fills `to` (zeroed) from the part's attributes and checks them: types, ranges, matrices, volumes. */
bool glint_attributes_decode(struct glint_check *check, const struct glint_exr_part_info *part, enum glint_scope scope,
                             void *to);
/* Sets OpenEXR's standard attributes worldToCamera and worldToNDC from a decoded frame. False if memory is exhausted. */
bool glint_attributes_set_standard(struct glint_arena *arena, struct glint_attribute_list *list,
                                   const struct glint_frame *frame);
/* Replaces a rotation that is not precise to double by the nearest rotation, keeping the position. Sets rotation_error. */
void glint_camera_make_rigid(struct glint_camera *camera);
/* Whether the name is glint's: it begins with `glint.` */
bool glint_attribute_is_ours(const char *name);
/* Reports names of glint's that the format does not know or has on other parts. Parts whose channels are any are kept as they are. */
bool glint_attribute_names_check(struct glint_check *check, const struct glint_exr_part_info *from,
                                 const struct glint_part_info *part);

#endif
