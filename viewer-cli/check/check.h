/* glint check: finds the baselines of runs, and makes a run the baseline. */
#ifndef GLINT_VIEWER_CHECK_H
#define GLINT_VIEWER_CHECK_H

#include "glint/common.h"

/* ---- Pairs of folders: runs.c ---- */

struct check_pair {
    char *run, *baseline;       /* paths */
    bool has_run, has_baseline; /* whether a run lies there */
};
struct check_pairs {
    struct check_pair *items;
    size_t count;
};
/* A run and its baseline; of a folder of runs (as replay makes of several captures) each with the one of its name, by name. */
bool check_pairs_find(struct check_pairs *pairs, const char *run, const char *baseline, struct glint_error *err);
void check_pairs_finish(struct check_pairs *pairs);

/* ---- Approval: approve.c ---- */

/* The files of `run` become `baseline`, all at once: whoever reads it finds the old one or the new one. The old one is kept
   as BASELINE~, in place of what was kept there before. A folder that holds anything but a run is an error. */
bool check_approve(const char *run, const char *baseline, struct glint_error *err);

#endif
