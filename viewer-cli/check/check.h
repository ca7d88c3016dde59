/* glint check: finds the baselines of runs, and makes a run the baseline. */
#ifndef GLINT_VIEWER_CHECK_H
#define GLINT_VIEWER_CHECK_H

#include "diff/options.h"
#include "journal/survey.h"

/* ---- Pairs of folders: runs.c ---- */

struct check_pair {
    char *run, *baseline;       /* paths */
    bool has_run, has_baseline; /* whether a run lies there */
};
struct check_pairs {
    struct check_pair *items;
    size_t count;
};
/* Whether a folder is one run, and not a folder of runs. */
bool check_is_run(const char *folder);
/* A run and its baseline; of a folder of runs (as replay makes of several captures) each with the one of its name, by name. */
bool check_pairs_find(struct check_pairs *pairs, const char *run, const char *baseline, struct glint_error *err);
void check_pairs_finish(struct check_pairs *pairs);

/* Opens the survey of these runs, which are the same while their run.json and the limits are, and cost the bytes of their files: journal.c */
bool check_survey_open(struct survey *survey, const struct check_pairs *pairs, const struct diff_args *args,
                       struct glint_error *err);

/* ---- What is told of many runs: survey.c ---- */

struct check_row {
    const struct check_pair *pair;
    enum diff_status status;
    size_t differing, images; /* that differ by more than the limits, or that only one run has; all */
    char *first;              /* "SLOT: IMAGE", the first that differs; or NULL */
    char *message;            /* why they were not compared; or NULL */
};
struct check_survey {
    struct check_row *rows; /* zero-initialised */
    size_t count;
};
/* Adds a row of the JSON of a pair: that of a diff, or "status" with a "note" or an "error" why there is none, and "approved" if the differences were. False
   without memory, and for JSON that somebody else has made and that lacks something, without an error. */
bool check_survey_add(struct check_survey *survey, const struct check_pair *pair, const json_t *json,
                      struct glint_error *err);
/* Sorts the rows: the worst status first, then the most images that differ. */
void check_survey_sort(struct check_survey *survey);
void check_survey_print(const struct check_survey *survey);
/* {"summary": {STATUS: number}, "worst": the rows} */
json_t *check_survey_json(const struct check_survey *survey);
void check_survey_finish(struct check_survey *survey);

/* ---- Approval: approve.c ---- */

/* The files of `run` become `baseline`, all at once: whoever reads it finds the old one or the new one. The old one is kept
   as BASELINE~, in place of what was kept there before. A folder that holds anything but a run is an error. */
bool check_approve(const char *run, const char *baseline, struct glint_error *err);

#endif
