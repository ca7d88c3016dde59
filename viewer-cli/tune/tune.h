/* Tuning: the parameters of a pipeline whose error is least within a budget, on one or several captures. */
#ifndef GLINT_VIEWER_TUNE_H
#define GLINT_VIEWER_TUNE_H

#include "options/answer_args.h"
#include "options/args.h"
#include "glint/judge.h"
#include "glint/search.h"
#include "journal/journal.h"
#include "io/progress.h"

enum { TUNE_TEXT = 48 };

/* What is tuned: a parameter, the pipeline's rays, or the variant of a slot. */
struct tune_axis {
    char name[128];              /* "slot.parameter", "pipeline.rays", "slot" */
    bool other;                  /* of a variant that is not the start's */
    const struct glint_row *row; /* of a parameter */
    char (*texts)[TUNE_TEXT];    /* its choices, axis.choices of them; NULL for numbers */
    struct glint_search_axis axis;
};
/* What is declared and left alone. */
struct tune_left {
    char name[128], why[224];
};
/* Of one pipeline on a capture, or over those that it is tuned on. */
struct tune_figures {
    double error, cost;
};
struct tune_subject {
    const char *path;
    bool held_out; /* looked at in the end alone */
    struct glint_capture *capture;
    struct glint_judge *judge;
    double start_ms; /* what times are relative to; 0: not measured yet */
    struct tune_figures
        yard;      /* what --over worst and --baseline measure others by here: the baseline's, else the start's */
    double factor; /* of TUNE_SCALED here: the least at which it costs no less than what was tuned */
};

/* A median with the interval that holds the true one with 95 %. */
struct tune_median {
    double value, low, high;
};
enum { TUNE_START, TUNE_TUNED, TUNE_SCALED, TUNE_CONTENDERS };
/* A contender on one capture, measured anew. */
struct tune_measured {
    struct glint_metric_table errors;
    double steps_px, fetches_px;
    struct tune_median ms;   /* NAN: not timed */
    struct tune_median part; /* of its time that the tuned one takes, round by round */
};

struct tune {
    const char *out, *folder; /* the preset's file; where the rest is kept */
    struct list captures, held_out, vary, slots, shaders;
    struct answer_args against;
    const char *command_line;
    bool all, fetches, by_error, baseline, worst;
    double limit; /* of cost, or of error */
    bool part;    /* the limit is a part of the start's figure */
    uint32_t tries, seed, rounds, repeat;
    enum glint_metric metric;

    struct glint_pipeline *base;
    struct glint_device *device;
    struct progress *progress;
    char label[64];
    double done; /* of all the work, 0 to 1 */

    struct tune_subject *subjects; /* captures, then held-out ones */
    size_t subject_count;
    struct tune_axis *axes;
    size_t axis_count;
    struct tune_left *left;
    size_t left_count;
    struct journal journal;
    json_t *lines; /* of the journal: figures by values */
    size_t fresh;  /* pipelines that this call evaluated */

    struct glint_search_result found;
    struct tune_figures start;
    double asked,
        within;    /* the limit in the figure's own unit; what is searched for: the baseline's cost, if that is less */
    size_t chosen; /* of found.points */
    bool confirmed, confirmed_within;
    double factor;   /* that all counts are scaled by, for TUNE_SCALED */
    double *scaling; /* the values there */
    struct tune_figures scaled;
    bool scaled_within; /* else no factor keeps the limit, and it is the one that comes nearest */
    struct glint_pipeline *contenders[TUNE_CONTENDERS]; /* NULL: none */
    struct tune_measured *measured;                     /* subject · TUNE_CONTENDERS + contender */
};
void tune_finish(struct tune *tune);
const char *tune_cost_unit(const struct tune *tune);       /* "ms", "fetches/px" */
extern const char *const tune_contenders[TUNE_CONTENDERS]; /* "start", "tuned", "scaled" */

/* What follows calls only what stands before it. */

/* axes.c */
/* The axes that --vary names, or all that are declared; what is left alone of these, and why. After tune_load. */
bool tune_make_axes(struct tune *tune, struct glint_error *err);
void tune_value_text(const struct tune_axis *axis, double value, char text[TUNE_TEXT]);
/* Whether the time of a slot counts: all do, or those of --slots. */
bool tune_slot_counts(const struct tune *tune, const char *slot);
/* The start with these values. */
struct glint_pipeline *tune_pipeline(const struct tune *tune, const double *values, struct glint_error *err);
/* The start's values, with all counts that may move and cost something times a factor; false: there are none. */
bool tune_scale(const struct tune *tune, double factor, double *values);

/* subjects.c */
/* Opens and uploads the captures that are tuned on, and runs the start once on each. */
bool tune_load(struct tune *tune, struct glint_error *err);
/* One more capture with a judge of its own. */
bool tune_load_subject(struct tune *tune, size_t subject, uint32_t resamples, struct glint_error *err);
void tune_unload_subject(struct tune *tune, size_t subject);
/* One round of what counts of a frame; `whole`: in one piece. */
bool tune_time(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline, bool whole,
               double *ms, struct glint_error *err);
/* Sorts the values. */
struct tune_median tune_median(double *values, size_t count);
struct tune_times {
    struct tune_median ms, part; /* NAN without rounds */
};
/* Rounds of all pipelines that are not NULL, in turns, each in one piece. */
bool tune_time_in_turns(struct tune *tune, struct tune_subject *subject, struct glint_pipeline *const *pipelines,
                        struct tune_times times[TUNE_CONTENDERS], struct glint_error *err);
bool tune_report(void *user, const char *what, double done); /* a glint_progress; user: the tune */

/* try.c */
/* Begins the journal, or goes on with it. After tune_make_axes. */
bool tune_open(struct tune *tune, struct glint_error *err);
/* Of these values, tried now or found in the journal. */
bool tune_evaluate(struct tune *tune, const double *values, struct tune_figures *figures, struct glint_error *err);
/* Others are measured by these values' figures from now on. They must have been evaluated. */
void tune_set_yard(struct tune *tune, const double *values);
/* These were measured to take this part of what they may, and these of the baseline's time on the captures: costs are
   limited, or measured, by that from now on. */
void tune_correct(struct tune *tune, const double *values, double part, const double *parts);
/* The values of all that was tried, one after the other; the caller frees them. */
bool tune_all_tried(const struct tune *tune, double **values, size_t *count, struct glint_error *err);

/* baseline.c */
/* Finds the largest factor that keeps the budget, or the smallest that keeps the error, and makes its figures the yard. A
   budget becomes what it costs, so that both take the same. */
bool tune_find_scale(struct tune *tune, struct glint_error *err);
/* Sets a subject's factor, from the baseline's own upwards or downwards. */
bool tune_match_scale(struct tune *tune, size_t subject, struct glint_error *err);

/* search.c */
/* Finds tune->found. What was found until an error stays. */
bool tune_search(struct tune *tune, struct glint_error *err);
/* Goes on from all that is kept when the chosen one was measured to take that (tune_correct). A fourth of the tries. */
bool tune_search_again(struct tune *tune, double part, const double *parts, struct glint_error *err);

/* confirm.c */
/* Chooses the best point that keeps the limit when it is measured again. */
bool tune_choose(struct tune *tune, struct glint_error *err);
/* Measures start, tuned and scaled on all captures, in turns. */
bool tune_confirm(struct tune *tune, struct glint_error *err);

/* "less", "more", "equal" with the interval of how much more b errs than a; of the part of its time that the tuned one takes. */
const char *tune_verdict(const struct glint_figure *difference);
const char *tune_part_verdict(const struct tune_median *part);
bool tune_difference(const struct tune *tune, size_t subject, int a, int b, size_t row,
                     struct glint_figure *difference);

/* least.c: what no point reaches, with the least that was found, and which passes take that. Returns false. */
bool tune_fail_least(struct tune *tune, struct glint_error *err);

/* preset.c: a preset with its provenance. */
bool tune_write_preset(const struct tune *tune, struct glint_error *err);
json_t *tune_json(const struct tune *tune);

/* report.c */
void tune_print(const struct tune *tune);

/* page.c: FOLDER/NAME.html, NAME.svg and page.json. */
bool tune_write_page(const struct tune *tune, struct glint_error *err);

#endif
