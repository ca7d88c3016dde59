/* A part that the writer keeps until it is written: a copy of the pixels, and the headers as the reader will find them. */
#ifndef GLINT_WRITER_PART_H
#define GLINT_WRITER_PART_H

#include "attributes.h"
#include "part.h"

struct glint_writer_part {
    char *name;
    struct glint_exr_part file;
    struct glint_exr_part_info as_read; /* the same, as the reader will find it */
    struct glint_part_info info;
    struct glint_attribute_list attributes;
    struct glint_arena arena;
};

/* Copies a part and checks it by the reader's rules. `path` is for error messages. NULL on failure. */
struct glint_writer_part *glint_writer_part_create(const char *path, const struct glint_part *part,
                                                   enum glint_compression compression, struct glint_error *err);
void glint_writer_part_destroy(struct glint_writer_part **part);

#endif
