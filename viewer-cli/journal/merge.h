/* Puts the shards of a study together (glint merge). */
#ifndef GLINT_VIEWER_MERGE_H
#define GLINT_VIEWER_MERGE_H

#include <jansson.h>

#include "options/args.h"

/* All shards of one command. */
struct merge {
    struct merge_part *parts;
    size_t count;
    json_t *studies;         /* the folder of each study in that of a shard: "", or one a study, such as an effect */
    const char *command;     /* "sweep"; owned by the parts, as are the next two */
    const json_t *arguments; /* of its command line, a list of texts */
    const char *folder;      /* in which it was run */
    size_t results;          /* lines of the merged journals */
};
/* Reads what the folders of shards say of themselves: each share of the same study has to be there once, and done. */
bool merge_open(struct merge *merge, const struct list *folders, struct glint_error *err);
/* Writes the definition and the journal of each whole study into a folder, in the order of one process, and links or copies the other files of
   the shards, such as references and pictures. Takes no more memory for more results. */
bool merge_write(struct merge *merge, const char *out, struct glint_error *err);
/* For a command that reads the journals of its shards itself (struct command: rounds): puts all shards into the folder, and their other files. */
bool merge_gather(struct merge *merge, const char *out, struct glint_error *err);
void merge_close(struct merge *merge);

#endif
