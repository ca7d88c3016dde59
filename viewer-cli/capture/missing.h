/* What a capture lacks of what passes would read, in words. */
#ifndef GLINT_VIEWER_MISSING_H
#define GLINT_VIEWER_MISSING_H

#include <jansson.h>

#include "command.h"
#include "glint/replay.h"

enum { MISSING_MOST = 64 };
struct missing {
    const struct glint_absence *items[MISSING_MOST];
    size_t count;
};
/* Adds what the last plan or run of a replay misses, each once. Returns how many were new. */
size_t missing_add(struct missing *missing, const struct glint_replay *replay);
/* One line on stderr for each item from `first` on: "no cubemap:distance: rays …". */
void missing_note(const struct command *command, const struct missing *missing, size_t first);
/* [{"role", "channels", "cost"}, …] */
json_t *missing_json(const struct missing *missing);
/* "cubemap:distance" in static storage for one call. */
const char *missing_name(const struct glint_absence *absence);
/* The cost of leaving out a part, or channels of it; NULL if nothing is known to depend on them. */
const char *missing_cost(const char *part, const char *channel);

/* Which presets find what they read, and what would open what, by plans on the host. */
bool carries_print(struct glint_capture *capture, struct glint_error *err);
json_t *carries_json(struct glint_capture *capture, struct glint_error *err);

#endif
