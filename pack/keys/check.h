/* Checks the keys and values of a manifest by keys_rows.h. */
#ifndef GLINT_PACK_CHECK_H
#define GLINT_PACK_CHECK_H

#include "keys.h"
#include "node.h"

/* Whether the value is an object whose keys are all known, and of their kinds. */
bool node_check(const struct node *node, const struct object *object, struct glint_error *err);

#endif
