/* A capture that is copied with changes. */
#ifndef GLINT_EDIT_INTERNAL_H
#define GLINT_EDIT_INTERNAL_H

#include "attributes.h"
#include "exr_internal.h"
#include "glint/edit.h"
#include "part.h"

/* Stored pixels of several channels of one type, interleaved. */
struct glint_edit_block {
    uint8_t *data;
    uint32_t channels;
};

struct glint_edit_channel {
    struct glint_channel_info info;
    struct glint_edit_block *block; /* NULL: not read yet */
    uint32_t place;                 /* in the block */
};

struct glint_edit_part {
    struct glint_exr_part_info info; /* as it will be written; `channels` is filled on demand */
    struct glint_edit_channel *channels;
    struct glint_channel_info *listed;
    struct glint_attribute_list attributes;
    struct glint_exr *exr; /* the file of its pixels, the capture's own or a sibling; NULL: made by the edit */
    size_t index;          /* in that file */
    uint32_t x, y, step;   /* its pixels begin there in the file's, and are every step-th one */
    uint32_t full_width;
};

struct glint_edit_sibling {
    char *name;
    struct glint_exr *exr;
};

struct glint_edit {
    struct glint_exr *exr;
    struct glint_arena arena;
    struct glint_edit_part *parts;
    size_t count;
    struct glint_edit_sibling *siblings;
    size_t sibling_count;
    struct glint_edit_block **blocks;
    size_t block_count, block_capacity;
    glint_edit_note note;
    void *user;
};

GLINT_PRINTF(2, 3)
void glint_edit_say(const struct glint_edit *edit, const char *format, ...);
bool glint_edit_fail_memory(const struct glint_edit *edit, struct glint_error *err);
/* A string attribute, or NULL. */
const char *glint_edit_string(const struct glint_edit_part *part, const char *name);
/* Reads what is not read yet of a part's pixels, as stored. */
bool glint_edit_read(struct glint_edit *edit, struct glint_edit_part *part, struct glint_error *err);
/* Of a channel that is read. */
struct glint_edit_pixels glint_edit_pixels_of(const struct glint_edit_part *part,
                                              const struct glint_edit_channel *channel);
/* Takes the pixels of a part from its sibling into the copy. Does nothing to other parts. */
bool glint_edit_resolve(struct glint_edit *edit, struct glint_edit_part *part, struct glint_error *err);
/* Memory for pixels that lives as long as the edit; NULL without memory. */
struct glint_edit_block *glint_edit_block(struct glint_edit *edit, size_t bytes, uint32_t channels);
/* The part's role, or NULL. */
const struct glint_role *glint_edit_role(const struct glint_edit_part *part);

#endif
