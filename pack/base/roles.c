/* Finds a part's role in the registry. */
#include "roles.h"

#include <string.h>

const struct glint_role *role_of(const char *part, bool *previous) {
    int32_t index;
    return glint_role_find(part, &index, previous);
}

const struct glint_role_channel *role_channel(const struct glint_role *role, const char *name) {
    for (size_t i = 0; role && i < role->channel_count; i++)
        if (!strcmp(role->channels[i].name, name)) return &role->channels[i];
    return NULL;
}
