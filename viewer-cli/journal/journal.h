/* Definition and results of a study in its folder, from which an interrupted study resumes. */
#ifndef GLINT_VIEWER_JOURNAL_H
#define GLINT_VIEWER_JOURNAL_H

#include <jansson.h>

#include "options/args.h"
#include "glint/judge.h"

/* FOLDER/KIND.json holds the definition, FOLDER/log.jsonl a line for each result. */
struct journal {
    const char *folder; /* NULL: nothing is stored on disk */
    const char *kind;   /* "sweep" */
    int log;            /* file descriptor; 0: none */
    struct glint_folder_lock *lock;
    size_t results; /* lines of the log */
    /* Receives each line of the log, and may keep a reference to it. Returns false if the line does not belong to the study. */
    bool (*keep)(void *user, json_t *line);
    void *user;
};
/* Creates the folder, or resumes and passes all its lines to `keep`. A folder with a different study is an error that
   names the difference; a folder in use by another process is an error, too. */
bool journal_open(struct journal *journal, const json_t *definition, struct glint_error *err);
/* Appends a line, which it takes ownership of, and passes it to `keep`. The line is written completely or not at all. */
bool journal_append(struct journal *journal, json_t *line, struct glint_error *err);
void journal_close(struct journal *journal);
/* What an interrupted study leaves in its folder: how many results ("evaluations"), and rays of references. */
void journal_describe_kept(const struct journal *journal, const char *results, char text[512]);

/* "FOLDER/name" in at most 4096 bytes. */
bool journal_path(const char *folder, const char *name, char path[4096], struct glint_error *err);

/* ---- Contents of definitions and lines ---- */

/* The value in a file of a folder, which somebody else may have made; NULL with an error. */
json_t *json_inside(const char *path, struct glint_error *err);
json_t *strings_json(const char *const *items);
/* Preset, number of rays, and each slot's variant and parameters. */
json_t *pipeline_json(const struct glint_pipeline *pipeline);
/* Hashes of the users' shaders: a changed shader is a different study. NULL with an error. */
json_t *shaders_json(const struct list *shaders, struct glint_error *err);
/* The hash of each capture. NULL with an error; with `lenient`, {"failed": message} stands for a capture that cannot be
   read, and a hash that a set file says is taken from there: whoever reads the capture checks it. */
json_t *captures_json(const struct list *captures, bool lenient, struct glint_error *err);
/* {CLASS: {"pixels": N, METRIC: value, …}} */
json_t *errors_json(const struct glint_metric_table *table, uint32_t metrics);
/* {"round", "frame_ms", "cubemaps_ms", "passes": {SLOT: ms}} */
json_t *cost_json(const struct glint_cost *cost, uint32_t round);

#endif
