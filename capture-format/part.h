/* A part of an EXR file as a part of a capture, and the rules that bind it. The reader, validate and the writer (on
   what it is about to write) all go through these. */
#ifndef GLINT_PART_H
#define GLINT_PART_H

#include "arena.h"
#include "check.h"
#include "glint/exr.h"

/* Fills `out` from headers alone and checks the rules of a single part. `scanline`: it can be read. False: stop. */
bool glint_part_parse(struct glint_check *check, struct glint_arena *arena, const struct glint_exr_part_info *from,
                      bool scanline, struct glint_part_info *out);
/* Parses the frame's attributes from `gbuffer` into *frame and checks the rules between parts. Sizes of siblings must
   be known, or 0. *has_frame: false for a file of cube maps only. */
bool glint_parts_check(struct glint_check *check, const struct glint_exr_part_info *const *files,
                       const struct glint_part_info *parts, size_t count, struct glint_frame *frame, bool *has_frame);
/* Which of the role's declared encodings holds for a channel; 0 (canonical) where none applies. */
int glint_part_encoding(const struct glint_part_info *part, const struct glint_role_channel *channel);
/* Whether a normal is stored with its Z; where not, it follows from X and Y. */
bool glint_normal_has_z(enum glint_normal_encoding encoding);
#define GLINT_SIBLING_ATTRIBUTE "glint.sibling"
#define GLINT_SIBLING_HASH_ATTRIBUTE "glint.siblingHash"
#define GLINT_STORAGE_ATTRIBUTE "glint.storage"
#define GLINT_VERSION_ATTRIBUTE "glint.version"

#endif
