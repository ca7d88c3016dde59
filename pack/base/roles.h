/* Finds a part's role in the registry. */
#ifndef GLINT_PACK_ROLES_H
#define GLINT_PACK_ROLES_H

#include "glint/capture.h"

/* The role of a part's name, NULL if there is none. */
const struct glint_role *role_of(const char *part, bool *previous);
const struct glint_role_channel *role_channel(const struct glint_role *role, const char *name);

#endif
