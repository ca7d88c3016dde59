/* Sets of captures: an argument of commands that take captures may also be a folder of them, or a set file, which gives them tags. */
#ifndef GLINT_VIEWER_CAPTURE_SET_H
#define GLINT_VIEWER_CAPTURE_SET_H

#include "options/args.h"

/* Replaces every folder and every set file (.json) in the list by its captures: of a folder those of its set.json, or else its captures
   *.exr by name, and of a set file those that it lists, in its order. Other arguments stay. */
bool capture_set_expand(struct list *captures, struct glint_error *err);
/* The tags of a capture, a JSON array; NULL for one without. */
const json_t *capture_set_tags(const struct list *captures, size_t i);
/* Whether the capture has the hash that its set file says; true if that says none. */
bool capture_set_check(const struct list *captures, size_t i, const char *hash, struct glint_error *err);

#endif
