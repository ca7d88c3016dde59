/* Definition and results of a study in its folder, from which an interrupted study resumes. */
#ifndef GLINT_VIEWER_JOURNAL_H
#define GLINT_VIEWER_JOURNAL_H

#include <jansson.h>
#include <stdio.h>

#include "options/args.h"
#include "glint/judge.h"

/* FOLDER/KIND.json holds the definition, FOLDER/log.jsonl a line for each result. */
struct journal {
    const char *folder; /* NULL: nothing is stored on disk */
    const char *kind;   /* "sweep" */
    bool reread;        /* lines are read back by journal_read: without a folder they are in a temporary file */
    int log;            /* file descriptor; 0: none */
    struct glint_folder_lock *lock;
    size_t results; /* lines of the log */
    /* Receives each line of the log, and may keep a reference to it. Returns false if the line does not belong to the study. */
    bool (*keep)(void *user, json_t *line);
    void *user;
    int64_t at; /* the place of the line that `keep` receives, or received last */
    FILE *back; /* what journal_read reads from; or NULL */
};
/* Creates the folder, or resumes and passes all its lines to `keep`. A folder with a different study is an error that
   names the difference; a folder in use by another process is an error, too. */
bool journal_open(struct journal *journal, const json_t *definition, struct glint_error *err);
/* Appends a line, which it takes ownership of, and passes it to `keep`. The line is written completely or not at all. */
bool journal_append(struct journal *journal, json_t *line, struct glint_error *err);
/* The line at a place that `at` was. NULL with an error. */
json_t *journal_read(struct journal *journal, int64_t at, struct glint_error *err);
/* Removes the journal in a folder. The log goes first: what is left if the process ends in between is a journal without results. */
void journal_remove(const char *folder, const char *kind);
void journal_close(struct journal *journal);
/* What an interrupted study leaves in its folder: how many results ("evaluations"), and rays of references. */
void journal_describe_kept(const struct journal *journal, const char *results, char text[512]);

/* "FOLDER/name" in at most 4096 bytes. */
bool journal_path(const char *folder, const char *name, char path[4096], struct glint_error *err);

/* A line of a log, with its line break. A log has any number of lines; that one of somebody else cannot take all memory, a line has a limit. */
struct journal_line {
    char *text; /* malloc'd; NULL before the first */
    size_t size, length;
};
enum journal_next { JOURNAL_FAILED = -1, JOURNAL_END, JOURNAL_LINE };
/* Reads the next line of the log at `path`, the name for errors. What a crash left of a last line is none. */
enum journal_next journal_next_line(FILE *log, const char *path, struct journal_line *line, struct glint_error *err);
/* Its value; NULL if it is none, has too many values to be a result, or without memory. */
json_t *journal_parse(const struct journal_line *line);
/* How many whole lines logs have, and when one was written last, in seconds. */
struct journal_count {
    size_t lines;
    double written;
};
/* Adds those of FOLDER/log.jsonl, and of the logs of studies in folders of it, to zero-initialised counts. */
bool journal_count_lines(const char *folder, struct journal_count *count, struct glint_error *err);

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
