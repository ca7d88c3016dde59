/* The commands that glint batch cuts into shards, and their options beside its own. */
#ifndef GLINT_VIEWER_BATCH_STUDIED_H
#define GLINT_VIEWER_BATCH_STUDIED_H

#include "command.h"

/* The command of this name, if it is one of those, which have --shard; or NULL. */
const struct command *batch_studied(const char *name);
/* Their names, as "check, compare, …", malloc'd; NULL without memory. */
char *batch_studied_names(void);
/* Makes `whole` glint batch with the options of the command as well, of which those go that both have; its options are malloc'd. False without memory. */
bool batch_widen(const struct command *batch, const struct command *studied, struct command *whole);

#endif
