/* Finds a part's role in the registry. */
#include "roles.h"

#include <ctype.h>
#include <string.h>

static bool matches(const struct glint_role *role, const char *name) {
    const size_t length = strlen(role->name);
    if (strncmp(name, role->name, length) != 0) return false;
    const char *rest = name + length;
    if (role->name[length - 1] == '.') return *rest != '\0';
    if (!role->numbered) return *rest == '\0';
    return rest[0] == '.' && isdigit((unsigned char)rest[1]) && isdigit((unsigned char)rest[2]) &&
           isdigit((unsigned char)rest[3]) && !rest[4];
}

const struct glint_role *role_of(const char *part, bool *previous) {
    static const char prefix[] = "previous.";
    size_t count = 0;
    const struct glint_role *roles = glint_roles(&count);
    *previous = !strncmp(part, prefix, sizeof prefix - 1);
    const char *name = *previous ? part + sizeof prefix - 1 : part;
    for (size_t i = 0; i < count; i++)
        if ((!*previous || roles[i].may_be_previous) && matches(&roles[i], name)) return &roles[i];
    *previous = false;
    return NULL;
}

const struct glint_role_channel *role_channel(const struct glint_role *role, const char *name) {
    for (size_t i = 0; role && i < role->channel_count; i++)
        if (!strcmp(role->channels[i].name, name)) return &role->channels[i];
    return NULL;
}
