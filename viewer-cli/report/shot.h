/* Reports of shots: folders that `glint replay` wrote with several captures. */
#ifndef GLINT_VIEWER_REPORT_SHOT_H
#define GLINT_VIEWER_REPORT_SHOT_H

#include "glint/study.h"
#include "report/report.h"

/* Whether the folder is that of a shot. */
bool report_is_shot(const char *folder);
/* Describes it as a document of page.h, with the result of an effect (NULL: the first that the runs hold). Error and flicker need the captures where they were when they were replayed, with their truth. */
json_t *report_shot(const char *folder, const char *effect, struct glint_error *err);

/* ---- Parts of the report ---- */

enum shot_track { SHOT_FINAL, SHOT_RESULT, SHOT_TRUTH, SHOT_ERROR, SHOT_TRACKS };
enum { SHOT_BY_ERROR, SHOT_BY_FLICKER, SHOT_FIGURES };

struct shot_frame {
    char folder[4096], name[256];
    json_t *run; /* run.json */
    long long number;
    bool fogged;                        /* the picture has fog, which the truth lacks */
    double rmse, clean_rmse, symmetric; /* against the truth; NAN without one */
    bool has_change;                    /* the change since the frame before is known */
    struct glint_flicker flicker;
};
struct shot_report {
    const char *folder;
    const struct glint_effect *effect;
    struct shot_frame *frames;
    size_t count;
    json_t *tracks[SHOT_TRACKS]; /* PICTUREs, one for each frame, or empty */
    json_t *keys[SHOT_TRACKS];   /* KEYs of false colours, or NULL */
    size_t worst[SHOT_FIGURES];  /* count: unknown */
    char no_truth[1024];         /* why a frame has none; "": all have one */
    json_t *document;
};
/* The result of a frame, and the truth; `values` are NULL without one. */
struct shot_pixels {
    struct glint_pixels found, truth;
    float *error;  /* of the truth, relative */
    uint8_t *mask; /* of the pixels that are judged */
};
void shot_pixels_finish(struct shot_pixels *pixels);
/* Reads a frame's images. What is missing is no error: its reason goes to shot->no_truth. */
bool shot_read(struct shot_report *shot, size_t frame, struct shot_pixels *pixels, struct glint_error *err);
/* Stores the figures of a frame; `before`: the frame before it, or NULL. */
bool shot_measure(const struct shot_report *shot, struct shot_frame *frame, const struct shot_pixels *before,
                  const struct shot_pixels *now, struct glint_error *err);
void shot_find_worst(struct shot_report *shot);
json_t *shot_frame_name(const struct shot_frame *frame);
void shot_charts(const struct shot_report *shot);

#endif
