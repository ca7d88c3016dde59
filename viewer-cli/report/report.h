/* Run folders as a document of page.h. */
#ifndef GLINT_VIEWER_REPORT_H
#define GLINT_VIEWER_REPORT_H

#include "draw/page/page.h"

/* Describes one or several runs, side by side. `images`: names, NULL-terminated; NULL: those of full and half size. */
json_t *report_runs(const char *const *folders, size_t count, const char *const *images, struct glint_error *err);

struct comparison;
/* Stores the errors of a run in its folder for reports; a count of 0 removes stored ones. */
bool report_keep_errors(const char *folder, const struct comparison *compared, size_t count, struct glint_error *err);

/* ---- Parts of the report ---- */

struct report {
    const char *const *folders;
    size_t count;
    json_t **runs;      /* their run.json */
    char (*labels)[96]; /* short names of the runs */
    json_t *document;
    json_t *slots; /* slots of all runs, as keys in the order of their first appearance */
};

/* The member a.b of "a.b"; NULL if there is none. */
const json_t *report_find(const json_t *run, const char *key);
/* The text of a member, "" if there is none. */
const char *report_text(const json_t *object, const char *key);
const json_t *report_pass(const json_t *run, const char *slot);
bool report_ran(const json_t *pass);
/* Adds a column for each run, without a name if there is only one. */
void report_columns(json_t *table, const struct report *report, const char *unit);

/* Columns of a table, and the members of a list's rows that fill them, such as "a.b"; numbers are multiplied by `scale`. */
struct report_column {
    const char *name, *key, *unit;
    double scale;
    bool interval; /* adds the confidence interval, row.interval.KEY */
};
/* Adds a table of one list for each run, NULL for none. With several runs, rows begin with the run's name. Columns end
   with a NULL name. Nothing is added if all lists are empty. */
void report_table(const struct report *report, const json_t *const *lists, const struct report_column *columns,
                  json_t *blocks, const char *title);
/* [low, high], or NULL. */
const json_t *report_interval(const json_t *row, const char *key);

bool report_pictures(const struct report *report, const char *const *images, struct glint_error *err);
/* Adds errors if runs were compared with something. */
void report_errors(const struct report *report);
/* Adds the noise of reference runs, and their dependence on assumptions. */
void report_reference(const struct report *report);
void report_times(const struct report *report);

#endif
