/* Shards of a study: equal shares of its work, each done by a process of its own in a folder of its own, which glint merge puts together. */
#ifndef GLINT_VIEWER_SHARD_H
#define GLINT_VIEWER_SHARD_H

#include <jansson.h>

#include "options/args.h"

/* Share `number` of `count`, from 1; of a study that is not shared, both are 0. */
struct shard {
    uint32_t number, count;
};
enum { KEY_SHARD = 896 };
/* clang-format off */
#define SHARD_OPTION \
    {"shard", KEY_SHARD, "K/N", 0, "Do the K-th of N equal shares of the work, in FOLDER/shards/K-of-N; glint merge FOLDER makes the result of all", 0}
/* clang-format on */
/* "K/N", or "whole": not shared. */
void shard_parse(struct shard *shard, const char *text, struct argp_state *state);
/* "OUT/shards/K-of-N". */
bool shard_folder(const struct shard *shard, const char *out, char path[4096], struct glint_error *err);
/* Whether the name of a folder is "K-of-N". */
bool shard_of_name(const char *name, struct shard *shard);

/* The pixels of a capture; 1 of one that cannot be read, which takes no time. False without memory. */
bool shard_pixels(const char *capture, double *pixels, struct glint_error *err);
/* The work on a capture: what any of its points costs before the first, such as its reference, and each point. */
struct shard_cost {
    double first, each;
};
/* The share's part of the points of all captures, in the order capture · points + point: from *begin on, before *end. All shares cost about the
   same. A capture is divided between two of them only where that evens out more work than its first work, which both then do. */
void shard_cut(const struct shard *shard, const struct shard_cost *captures, size_t count, size_t points, size_t *begin,
               size_t *end);

/* What FOLDER/shard.json says: the share, the number of results that its journal will have (fewer where points fail), how many it had when the command was started,
   when the file is written first, whether all are there, the command line that made it, and the file that the command writes last when all shards are merged. */
struct shard_record {
    struct shard shard;
    const char *folder;
    size_t results, kept;
    int argc; /* of the command, whose name is argv[0] */
    char *const *argv;
    const char *result; /* "results.json"; NULL: "index.html" */
};
bool shard_write(const struct shard_record *record, bool done, struct glint_error *err);
/* Writes it first, with the number of results that the folder has. */
bool shard_begin(struct shard_record *record, struct glint_error *err);
/* What a command prints when its share is done: how many of all it has, which are "captures". */
enum status shard_report(const struct shard_record *record, const char *what, size_t all, bool json);

#endif
