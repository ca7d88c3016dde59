/* A survey: one result for each of many captures, or runs. With a folder the results are lines of a journal there, from which an interrupted survey goes on; several
   processes do a share of it each, which glint merge puts together. */
#ifndef GLINT_VIEWER_SURVEY_H
#define GLINT_VIEWER_SURVEY_H

#include "command.h"
#include "journal/journal.h"
#include "journal/shard.h"

struct survey {
    const struct command *command;
    const char *item;   /* what has a line: "capture" or "run", by whose number lines are found */
    const char *folder; /* for the journal, of a shard its own; NULL: nothing stays on disk */
    struct shard shard;
    size_t count; /* of all captures */
    bool reread;  /* survey_line is called without a folder, too */
    /* From survey_open on: */
    size_t begin, end; /* those that are worked on: all, or those of the shard */
    struct journal journal;
    struct glint_folder_lock *lock; /* of a folder without a journal */
    int64_t *at;                    /* the place of each one's line; -1: none yet */
    struct shard_record record;
    char own[4096]; /* the folder of a share */
};

/* SURVEY_OUTPUT is the help of -o of a command that writes results.json, and SURVEY_RESULT its name. */
#define SURVEY_RESULT "results.json"
#define SURVEY_OUTPUT                                                                                                  \
    "folder for " SURVEY_RESULT ", which has what --json prints; an interrupted command goes on from its journal "     \
    "there"
/* A share needs a folder. To be called when all is parsed. */
void survey_check(const struct shard *shard, const char *out, struct argp_state *state);

/* The folder of a survey is `out`, and that of a share lies in it. */
bool survey_place(struct survey *survey, const char *out, struct glint_error *err);
/* Opens the journal, which belongs to a survey with the same definition (consumed; NULL, with an error, if it could not be made) or none; and finds the share, by
   what each costs. Captures that are
   `unrepeatable`, as those from stdin are, have no journal, and no shares. */
bool survey_open(struct survey *survey, json_t *definition, const double *costs, bool unrepeatable,
                 struct glint_error *err);
/* FOLDER/shard.json of a share, which becomes FOLDER/results.json when all are merged: first, and when it is done. Without shares they do nothing. */
bool survey_begin_shard(struct survey *survey, int argc, char **argv, struct glint_error *err);
bool survey_end_shard(struct survey *survey, struct glint_error *err);
/* All of this for captures that a command reads whole: they are the same while their sizes and times are, and cost their bytes. */
bool survey_begin_files(struct survey *survey, const char *out, const struct list *captures, int argc, char **argv,
                        struct glint_error *err);
/* The size of a file and when it was written, as a text that changes when the file does; adds its size to *bytes. */
json_t *survey_file(const char *path, double *bytes);
bool survey_has_stdin(const struct list *captures);

/* Makes the line of one; NULL with an error, which ends the survey. */
typedef json_t *(*survey_make)(void *user, size_t i, struct glint_error *err);
/* The line of one: the journal's, or what is made now, which is added to it. A new reference; NULL with an error. */
json_t *survey_take(struct survey *survey, size_t i, survey_make make, void *user, struct glint_error *err);
bool survey_has(const struct survey *survey, size_t i);
/* The line of one that has one. A new reference; NULL with an error. */
json_t *survey_line(struct survey *survey, size_t i, struct glint_error *err);
/* A line of a journal that somebody else may have made lacks something: an error that names it. */
bool survey_fail_line(const struct survey *survey, size_t i, struct glint_error *err);

/* Says what is kept of an interrupted survey. */
void survey_note_kept(const struct survey *survey);
/* Whether FOLDER/results.json is written: there is a folder, and not that of a share. */
bool survey_has_result(const struct survey *survey);
/* Writes it; json is consumed. */
bool survey_write_json(const struct survey *survey, json_t *json, struct glint_error *err);
/* Removes the journal of a survey that is finished, or has no result yet; that of a share stays. */
void survey_close(struct survey *survey, bool finished);

#endif
