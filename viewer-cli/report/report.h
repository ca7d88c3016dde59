/* Run folders as a document of page.h. */
#ifndef GLINT_VIEWER_REPORT_H
#define GLINT_VIEWER_REPORT_H

#include "draw/page/page.h"

/* Several runs stand beside each other. `images`: which, NULL-terminated; NULL: those of the frame's or half the frame's
   size that the first run has. */
json_t *report_runs(const char *const *folders, size_t count, const char *const *images, struct glint_error *err);

struct comparison;
/* Keeps in a run's folder what the run was compared with, for its reports; NULL: nothing, and what was there is removed. */
bool report_keep_errors(const char *folder, const struct comparison *compared, struct glint_error *err);

/* ---- Its parts ---- */

struct report {
    const char *const *folders;
    size_t count;
    json_t **runs;      /* their run.json */
    char (*labels)[96]; /* short names */
    json_t *document;
    json_t *slots; /* of all runs, as keys in the order in which they are met */
};

/* "b" of "a" for "a.b"; NULL when there is none. */
const json_t *report_find(const json_t *run, const char *key);
/* A member's text, "" when there is none. */
const char *report_text(const json_t *object, const char *key);
const json_t *report_pass(const json_t *run, const char *slot);
bool report_ran(const json_t *pass);
/* A column for each run; alone it needs no name. */
void report_columns(json_t *table, const struct report *report, const char *unit);

/* Columns of a table and the members of a run's list that fill them, "a.b" for b of a; numbers are multiplied by `scale`. */
struct report_column {
    const char *name, *key, *unit;
    double scale;
    bool interval; /* with its confidence interval, row.interval.KEY */
};
/* One list for each run, NULL for none; several runs' rows begin with their run's name. Columns end with a NULL name.
   Nothing at all when the lists are empty. */
void report_table(const struct report *report, const json_t *const *lists, const struct report_column *columns,
                  json_t *blocks, const char *title);
/* [low, high], or NULL. */
const json_t *report_interval(const json_t *row, const char *key);

bool report_pictures(const struct report *report, const char *const *images, struct glint_error *err);
/* When runs were compared with something. */
void report_errors(const struct report *report);
/* When a run is a reference: its noise, and what it depends on. */
void report_reference(const struct report *report);
void report_times(const struct report *report);

#endif
