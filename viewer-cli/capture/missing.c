/* What a capture lacks of what passes would read, in words. */
#include "capture/missing.h"

#include <stdio.h>
#include <string.h>

size_t missing_add(struct missing *missing, const struct glint_replay *replay) {
    const size_t before = missing->count;
    const struct glint_absence *absence;
    for (size_t i = 0; (absence = glint_replay_missing(replay, i)) != NULL; i++) {
        bool known = missing->count == MISSING_MOST;
        for (size_t k = 0; k < missing->count; k++) known |= missing->items[k] == absence;
        if (!known) missing->items[missing->count++] = absence;
    }
    return missing->count - before;
}

const char *missing_name(const struct glint_absence *absence) {
    static char name[128];
    snprintf(name, sizeof name, "%s%s%s", absence->role, absence->channels[0] ? ":" : "", absence->channels);
    return name;
}

void missing_note(const struct command *command, const struct missing *missing, size_t first) {
    for (size_t i = first; i < missing->count; i++)
        command_note(command, "no %s: %s", missing_name(missing->items[i]), missing->items[i]->cost);
}

json_t *missing_json(const struct missing *missing) {
    json_t *list = json_array();
    for (size_t i = 0; i < missing->count; i++)
        json_array_append_new(list, json_pack("{ss ss ss}", "role", missing->items[i]->role, "channels",
                                              missing->items[i]->channels, "cost", missing->items[i]->cost));
    return list;
}

const char *missing_cost(const char *part, const char *channel) {
    size_t count;
    const struct glint_absence *all = glint_absences(&count);
    for (size_t i = 0; i < count; i++) {
        const size_t length = strlen(all[i].role);
        if (strncmp(part, all[i].role, length) != 0 || (part[length] && part[length] != '.')) continue;
        if (channel ? all[i].channels[0] && !strncmp(channel, all[i].channels, strlen(all[i].channels))
                    : !all[i].channels[0])
            return all[i].cost;
    }
    return NULL;
}
