/* Tuning: the parameters of a pipeline whose error is least within a budget, on one or several captures. */
#ifndef GLINT_VIEWER_TUNE_H
#define GLINT_VIEWER_TUNE_H

#include "options/answer_args.h"
#include "command.h"
#include "options/args.h"
#include "glint/judge.h"
#include "glint/search.h"
#include "journal/again.h"
#include "journal/journal.h"
#include "journal/shard.h"
#include "io/progress.h"

enum { TUNE_TEXT = 48 };

/* What is tuned: a parameter, the pipeline's rays, or the variant of a slot. */
struct tune_axis {
    char name[128];              /* "slot.parameter", "pipeline.rays", "slot" */
    bool other;                  /* parameter of a variant that the start does not use */
    const struct glint_row *row; /* of a parameter */
    char (*texts)[TUNE_TEXT];    /* its choices, axis.choices of them; NULL for numbers */
    struct glint_search_axis axis;
};
/* A declared parameter that is not tuned, and the reason. */
struct tune_left {
    char name[128], why[256]; /* "cocoon.size", "is used for cube maps, …" */
};
#define TUNE_NO_EFFECT "has no effect on these captures"
/* Error and cost of a pipeline on one capture, or over all captures that are tuned on. */
struct tune_figures {
    double error, cost;
};
struct tune_subject {
    const char *path;
    bool held_out; /* not tuned on; measured in the final comparison only */
    char *broken;  /* why it is left out; NULL: it is not */
    json_t *slots; /* {SLOT: {"ran", "cached", "needed", "reason"}}: what the start's passes did; NULL: not known yet */
    bool noted;    /* the journal has either */
    struct glint_capture *capture;
    struct glint_judge *judge; /* NULL: not loaded */
    double start_ms;           /* what times are relative to; 0: not measured yet */
    struct tune_figures
        norm;      /* what --over worst and --baseline measure others by here: the baseline's, else the start's */
    double factor; /* of TUNE_SCALED here: the least at which it costs no less than what was tuned */
};

/* A median with the interval that holds the true one with 95 %. */
struct tune_median {
    double value, low, high;
};
enum { TUNE_START, TUNE_TUNED, TUNE_SCALED, TUNE_CONTENDERS };
/* Final measurement of a contender on one capture. */
struct tune_measured {
    struct glint_metric_table errors;
    double steps_px, fetches_px;
    struct tune_median ms;   /* NAN: not timed */
    struct tune_median part; /* time of the tuned preset relative to this contender's, round by round */
};

struct tune {
    const char *out, *folder; /* file of the preset; folder for everything else, of a shard its own */
    const char *common;       /* the folder of all shards */
    struct shard shard;
    struct list captures, held_out, vary, slots;
    const struct list *shaders; /* of --shader */
    struct answer_args against;
    const char *command_line;
    bool all, fetches, by_error, baseline, worst;
    double limit; /* limit of cost or error */
    bool part;    /* the limit is relative to the start */
    uint32_t tries, seed, rounds, repeat;
    enum glint_metric metric;

    struct glint_pipeline *base;
    struct glint_device *device;
    struct progress *progress;
    char label[64];
    double done; /* progress of all work, 0 to 1 */

    struct tune_subject *subjects; /* captures, then held-out ones */
    size_t subject_count;
    struct again again;
    struct tune_axis *axes;
    size_t axis_count;
    struct tune_left *left;
    size_t left_count;
    struct journal journal;
    json_t *definition;
    json_t *lines;              /* of points: figures on all captures by values; the journal's, but of a shard */
    json_t *single;             /* lines of points on one capture, by tune_point_key: of this shard and of the others */
    bool timed;                 /* the journal has the start's times */
    size_t fresh;               /* number of pipelines that this call evaluated; of a shard on each capture */
    struct tune_shards *shards; /* the others' journals; NULL: there are none */

    struct glint_search_result found;
    struct tune_figures start;
    double asked,
        within;    /* the limit in the figure's own unit; what is searched for: the baseline's cost, if that is less */
    size_t chosen; /* index in found.points */
    bool confirmed, confirmed_within;
    double factor;   /* by which all counts are scaled in TUNE_SCALED */
    double *scaling; /* the scaled values */
    struct tune_figures scaled;
    bool scaled_within;                                 /* false: no factor meets the limit, and this is the nearest */
    struct glint_pipeline *contenders[TUNE_CONTENDERS]; /* NULL: none */
    json_t *provenance;                                 /* how the preset was found, as last written */
    struct tune_measured *measured;                     /* subject · TUNE_CONTENDERS + contender */
    struct tune_overall *overall;                       /* of all of them (tune/overall.h); NULL: not measured yet */
};
void tune_finish(struct tune *tune);
const char *tune_cost_unit(const struct tune *tune);       /* "ms", "fetches/px" */
extern const char *const tune_contenders[TUNE_CONTENDERS]; /* "start", "tuned", "scaled" */

/* The modules below depend only on those above them. */

/* axes.c */
/* Makes the axes that --vary names, or all declared ones of the passes that ran (tune_begin_captures), and lists parameters that are not tuned with the
   reason. */
bool tune_make_axes(struct tune *tune, struct glint_error *err);
/* What the start's passes did in its last run on this capture, for its `slots`; NULL with an error. */
json_t *tune_slots(struct tune *tune, struct tune_subject *subject, struct glint_error *err);
void tune_value_text(const struct tune_axis *axis, double value, char text[TUNE_TEXT]);
/* Whether the time of a slot counts: by default all, else those of --slots. */
bool tune_slot_counts(const struct tune *tune, const char *slot);
/* A copy of the start with these values. */
struct glint_pipeline *tune_pipeline(const struct tune *tune, const double *values, struct glint_error *err);
/* The start's values with all tuned counts that cost time multiplied by a factor; false if there are no such counts. */
bool tune_scale(const struct tune *tune, double factor, double *values);

/* subjects.c */
bool tune_make_subjects(struct tune *tune, struct glint_error *err);
/* Opens and uploads a capture with its own judge, and finds what errors are measured against, unless it is loaded. */
bool tune_load_subject(struct tune *tune, size_t subject, uint32_t resamples, struct glint_error *err);
/* Whether one of several captures fails by itself, by this error: it is left out, and another run would fail in the same way. Else it is an error of all,
   such as too little memory. */
bool tune_fails_alone(const struct tune *tune, size_t subject, const struct glint_error *own);
/* The number of captures that are tuned on and can be read. */
size_t tune_live(const struct tune *tune);
void tune_unload_subject(struct tune *tune, size_t subject);
/* Evaluates a pipeline, and measures the cost of one round, as glint_judge_evaluate and glint_judge_time do, once more if the device is lost. */
bool tune_judge(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                struct glint_verdict *verdict, struct glint_error *err);
bool tune_cost(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline, bool whole,
               struct glint_cost *cost, struct glint_error *err);
/* Times one round of the counted passes; `whole`: all passes of the frame in one submission. */
bool tune_time(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline, bool whole,
               double *ms, struct glint_error *err);
/* Sorts the values. */
struct tune_median tune_median(double *values, size_t count);
struct tune_times {
    struct tune_median ms, part; /* NAN without rounds */
};
/* Times alternating rounds of all pipelines that are not NULL, each as a whole frame. */
bool tune_time_in_turns(struct tune *tune, struct tune_subject *subject, struct glint_pipeline *const *pipelines,
                        struct tune_times times[TUNE_CONTENDERS], struct glint_error *err);
bool tune_report(void *user, const char *what, double done); /* a glint_progress; user: the tune */

/* work.c */
/* Begins the journal, or resumes it. --vary's axes must be made before it. */
bool tune_open(struct tune *tune, struct glint_error *err);
/* Receives a line of a journal, own or another shard's; false if it is none of this search. */
bool tune_keep_line(void *user, json_t *line);
/* Whether all lines so far are of these axes, which may be made after the journal is opened. */
bool tune_check_lines(const struct tune *tune, struct glint_error *err);
/* Decodes the texts of values. */
void tune_values_of(const struct tune *tune, const json_t *texts, double *values);
/* A piece of work that shards share out: the start on a capture (`values` NULL), or the point of these values, which are texts as in the journal. */
bool tune_is_known(const struct tune *tune, size_t capture, const json_t *values);
/* Does it and keeps the result; a shard appends it to its journal. A capture of several that cannot be read is left out. */
bool tune_do(struct tune *tune, size_t capture, const json_t *values, struct glint_error *err);
/* Appends to the journal what came of the start on a capture, unless it is there. */
bool tune_note_beginning(struct tune *tune, size_t capture, struct glint_error *err);
/* The name of such work, malloc'd; NULL without memory. */
char *tune_point_key(size_t capture, const json_t *values);

/* shards.c */
/* Reads what the shards of the folder have done; of a shard those of the same search, of the whole search all. */
bool tune_shards_open(struct tune *tune, struct glint_error *err);
void tune_shards_close(struct tune *tune);
/* Has the work on all captures done that is not known yet, each time once: by this process alone, or by all shards that run. `points`: values of
   points; NULL: the start. Returns when all of it is known. */
bool tune_share(struct tune *tune, const json_t *points, struct glint_error *err);

/* try.c */
/* Runs the start once on each capture, unless the journal has what came of it. */
bool tune_begin_captures(struct tune *tune, struct glint_error *err);
/* Evaluates these values, or finds them in the journal. */
bool tune_evaluate(struct tune *tune, const double *values, struct tune_figures *figures, struct glint_error *err);
/* Evaluates points that are needed next together with the other shards; does nothing without shards. A glint_search_announce; user: the tune. */
bool tune_announce(void *user, const double *values, size_t count, struct glint_error *err);
/* Makes the figures of these values, which must have been evaluated, the norm for others. */
void tune_set_norm(struct tune *tune, const double *values);
/* Corrects costs from now on: these values were timed to take `part` of their limit, and parts[capture] of the baseline's time. */
void tune_correct(struct tune *tune, const double *values, double part, const double *parts);
/* The values of all evaluated points, one after the other; the caller frees them. */
bool tune_all_tried(const struct tune *tune, double **values, size_t *count, struct glint_error *err);

/* baseline.c */
/* Finds the largest factor that meets the budget, or the smallest that meets the error, and makes its figures the norm. The budget then
   becomes the baseline's cost, so that both cost the same. */
bool tune_find_scale(struct tune *tune, struct glint_error *err);
/* Finds the factor of equal cost on one capture, starting from the baseline's factor. */
bool tune_match_scale(struct tune *tune, size_t subject, struct glint_error *err);

/* search.c */
/* Fills tune->found; on an error the points so far stay. */
bool tune_search(struct tune *tune, struct glint_error *err);
/* Corrects costs (tune_correct) and continues the search from all known points with a fourth of the tries. */
bool tune_search_again(struct tune *tune, double part, const double *parts, struct glint_error *err);

/* confirm.c */
/* Chooses the best point that meets the limit in the final timing. */
bool tune_choose(struct tune *tune, struct glint_error *err);
/* Measures start, tuned and scaled on all captures, alternating. */
bool tune_confirm(struct tune *tune, struct glint_error *err);

/* "less", "more", "equal" with the interval of how much more b errs than a; of the part of its time that the tuned one takes. */
const char *tune_verdict(const struct glint_figure *difference);
const char *tune_part_verdict(const struct tune_median *part);
bool tune_difference(const struct tune *tune, size_t subject, int a, int b, size_t row,
                     struct glint_figure *difference);

/* least.c: fails with a message that no point meets the limit, with the best point and its most expensive passes. Returns false. */
bool tune_fail_least(struct tune *tune, struct glint_error *err);

/* preset.c: writes the preset with a record of how it was found. */
bool tune_write_preset(struct tune *tune, struct glint_error *err);
json_t *tune_json(const struct tune *tune);

/* report.c */
void tune_print(const struct tune *tune);

/* page.c: FOLDER/NAME.html, NAME.svg and page.json. */
bool tune_write_page(const struct tune *tune, struct glint_error *err);

#endif
