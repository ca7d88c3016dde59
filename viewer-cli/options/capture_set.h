/* Sets of captures: an argument of commands that take captures may also be a folder of them, or a set file, which gives them tags. */
#ifndef GLINT_VIEWER_CAPTURE_SET_H
#define GLINT_VIEWER_CAPTURE_SET_H

#include "glint/capture.h"
#include "options/args.h"

/* Replaces every folder and every set file (.json) in the list by its captures: of a folder those of its set.json, or else its captures
   *.exr by name, and of a set file those that it lists, in its order. Other arguments stay. */
bool capture_set_expand(struct list *captures, struct glint_error *err);
/* False for a file that can be read and is no capture, such as one with cube maps that captures share. */
bool capture_set_may_hold(const char *path);
/* The tags of a capture, a JSON array; NULL for one without. */
const json_t *capture_set_tags(const struct list *captures, size_t i);
bool capture_set_has_tag(const struct list *captures, size_t i, const char *tag);
/* All tags of the captures, each once, in the order in which they come; a new JSON array. */
json_t *capture_set_all_tags(const struct list *captures);
/* The hash that the set file says; NULL if it says none. */
const char *capture_set_hash(const struct list *captures, size_t i);
/* Whether the capture has the hash that its set file says; true if that says none. */
bool capture_set_check(const struct list *captures, size_t i, const char *hash, struct glint_error *err);
/* The same for a capture that is open: of one whose set file says no hash, nothing is read. */
bool capture_set_check_open(const struct list *captures, size_t i, struct glint_capture *capture,
                            struct glint_error *err);
/* Whether a failure is the capture's own, and other captures may do: it is not the lack of memory, space or a device, which may be there the next time. */
bool capture_set_fails_alone(const struct list *captures, size_t i, const struct glint_error *own);

#endif
