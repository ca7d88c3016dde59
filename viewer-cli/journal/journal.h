/* What a study is and what it has found, in its folder: an interrupted one goes on from there. */
#ifndef GLINT_VIEWER_JOURNAL_H
#define GLINT_VIEWER_JOURNAL_H

#include <jansson.h>

#include "options/args.h"
#include "glint/judge.h"

/* FOLDER/KIND.json says what is studied, FOLDER/log.jsonl has a line for each result. */
struct journal {
    const char *folder; /* NULL: nothing is kept on disk */
    const char *kind;   /* "sweep" */
    int log;            /* file descriptor; 0: none */
    /* Takes a line of the log, which it may keep a reference of; false: it is none of this study's. */
    bool (*keep)(void *user, json_t *line);
    void *user;
};
/* Begins the folder, or goes on and gives all its lines to `keep`. A folder that holds another study is an error that names
   the difference; one that another process works in is one too. */
bool journal_open(struct journal *journal, const json_t *definition, struct glint_error *err);
/* Appends a line, which it takes, and gives it to `keep`. It is in the file whole or not at all. */
bool journal_append(struct journal *journal, json_t *line, struct glint_error *err);
void journal_close(struct journal *journal);

/* "FOLDER/name"; the path is at most 4096 long. */
bool journal_path(const char *folder, const char *name, char path[4096], struct glint_error *err);

/* ---- What definitions and lines hold ---- */

json_t *strings_json(const char *const *items);
/* Preset, rays, and each slot's variant and values. */
json_t *pipeline_json(const struct glint_pipeline *pipeline);
/* The users' shaders themselves: a file that was changed is another study. NULL with an error. */
json_t *shaders_json(const struct list *shaders, struct glint_error *err);
/* The hash of each capture. NULL with an error. */
json_t *captures_json(const struct list *captures, struct glint_error *err);
/* {CLASS: {"pixels": N, METRIC: value, …}} */
json_t *errors_json(const struct glint_metric_table *table, uint32_t metrics);
/* {"round", "frame_ms", "cubemaps_ms", "passes": {SLOT: ms}} */
json_t *cost_json(const struct glint_cost *cost, uint32_t round);

#endif
