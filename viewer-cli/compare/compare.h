/* Compares presets on the same captures: coverage, error against the truth, and cost. */
#ifndef GLINT_VIEWER_COMPARE_H
#define GLINT_VIEWER_COMPARE_H

#include "capture/missing.h"
#include "options/args.h"
#include "glint/judge.h"
#include "groups/groups.h"
#include "journal/survey.h"
#include "io/progress.h"
#include "draw/view/sheet.h"

enum { LABEL_SIZE = 160 };
struct contestant {
    /* The preset's name, or its file's without folder and .json; "a = b" of several that are one. */
    char label[LABEL_SIZE];
    struct glint_pipeline *pipeline;
};

/* Parts of a capture that cover its opaque surfaces. */
enum { CONTEST_OVER = 2 };
extern const char *const contest_over[CONTEST_OVER];

/* Over the rounds, of the sum of all passes, in ms. */
struct contest_time {
    uint32_t n;
    double min, median, max;
};

/* Results of one preset on one capture. */
struct showing {
    bool ran, compared; /* compared: with the truth */
    char failure[1024]; /* why it did not run, or why it was not compared */
    char *notes;        /* passes that did not run, with the reason; "" if none; malloc'd */
    uint64_t judged[GLINT_CLASS_COUNT], given[GLINT_CLASS_COUNT];
    struct glint_image_errors own;    /* over the pixels that the preset covers */
    struct glint_image_errors shared; /* over the pixels that all presets cover */
    /* the final image against the capture's `scene` where water or glass covers opaque surfaces */
    struct {
        bool drawn; /* a pass drew it */
        struct glint_image_error error;
    } over[CONTEST_OVER];
    struct glint_ends ends;
    double steps_px, fetches_px;         /* of all rays of a frame, per pixel of the picture */
    struct contest_time frame, cubemaps; /* cubemaps: work that is only done when a cube map changes */
    double *frame_ms, *cubemaps_ms;      /* one for each round; malloc'd */
    json_t *passes;                      /* {slot, variant, ran, reason} */
    json_t *kept;                        /* what it was read back from, which the texts of `ends` are in; or NULL */
};

struct contest {
    const struct glint_effect *effect; /* whose result is compared */
    struct contestant *all;            /* own their pipelines */
    size_t all_count;
    struct contestant *contestants; /* those of them that are measured */
    size_t count;
    bool join; /* measure presets once that make the effect's result in the same way */
    bool skip; /* leave out presets that do not make it */
    uint32_t rounds;
    struct glint_device *device;
    struct glint_judge *judge; /* created with the first capture; the index of a contestant is its lineage */
    struct progress *progress;
    struct missing *missing; /* what the captures lack of what the pipelines read */
};

/* Makes the pipelines of presets, by name or file, NULL-terminated. Settings are PRESET:SLOT.PARAM=VALUE. Fog is switched
   off, which the truth lacks, unless a setting says otherwise. */
bool contest_begin(struct contest *contest, const char *const *presets, const struct list *settings,
                   struct glint_error *err);
void contest_finish(struct contest *contest);
/* Chooses the effect that is compared from here on, and the contestants: with `join` of several that make its result by the same passes the
   first, which has the names of all; with `skip` only those that make it. */
void contest_judge(struct contest *contest, const struct glint_effect *effect);

/* Pictures of one capture: a column each for the truth and the presets. */
enum { CONTEST_ROWS = 3 }; /* the result, its error, the composed picture */
struct contest_pictures {
    const struct glint_effect *effect;
    struct picture *cells; /* cells of the sheet, row by row */
    size_t columns, capture;
    bool beside;         /* the page shows the files, and does not contain them */
    bool drawn;          /* the pictures are there */
    const char *folder;  /* folder in which pictures/ contains them at their own size */
    size_t values_bytes; /* bytes of pixel values stored for each picture */
    json_t *rows;        /* for each row, the pictures as JSON for the page */
};

/* Runs every preset on the capture; showings[i] is of contestant i. One that fails says so in its showing. `pictures`: NULL
   for none. False when nothing can be shown at all, or after Ctrl-C. */
bool contest_run(struct contest *contest, struct glint_capture *capture, struct showing *showings,
                 struct contest_pictures *pictures, struct glint_error *err);
/* Draws the pictures of a capture whose results are known. */
bool contest_picture(struct contest *contest, struct glint_capture *capture, struct contest_pictures *pictures,
                     struct glint_error *err);

struct answer {
    struct glint_verdict verdict;
    const struct glint_pixels *truth; /* of what the preset estimates; NULL without one */
    const float *truth_error;
    struct glint_pixels picture; /* the last one; empty without one */
    char picture_name[64];
};
bool contest_draw_truth(struct contest_pictures *pictures, const struct glint_pixels *truth,
                        struct glint_capture *capture, struct glint_error *err);
bool contest_draw(struct contest_pictures *pictures, size_t column, const struct contestant *contestant,
                  const struct answer *answer, const uint8_t *labels, struct glint_error *err);

/* ---- Results as JSON, and back: showing.c ---- */

void showing_finish(struct showing *showing);
/* The share of the judged pixels of a class for which the preset gives a result. */
double showing_coverage(const struct showing *s, size_t label);
json_t *showing_json(const struct glint_effect *effect, const char *label, const struct showing *s);
/* All but the times of single rounds. */
bool showing_read(const struct glint_effect *effect, json_t *json, struct showing *s, struct glint_error *err);

/* ---- Results of all captures, on disk: log.c ---- */

/* What is kept in memory of each preset on each capture. NAN: unknown. */
enum contest_figure {
    CONTEST_ERROR /* over the pixels that all presets cover */,
    CONTEST_MS,
    CONTEST_COVERAGE,
    CONTEST_FIGURES
};
enum contest_state { CONTEST_MISSING, CONTEST_DONE, CONTEST_UNREADABLE };
struct contest_log {
    const struct contest *contest;
    const struct list *captures;
    struct survey survey; /* a line for each capture */
    enum contest_state *states;
    double *figures;          /* [capture][preset][CONTEST_FIGURES] */
    struct showing *showings; /* of the capture `loaded` */
    size_t loaded;
    struct glint_error fault; /* what could not be read back */
};
/* Resumes if the folder, or NULL, has a journal of the same comparison. Close it even if this fails. */
bool contest_log_open(struct contest_log *log, const struct contest *contest, const struct list *captures,
                      const char *folder, const struct shard *shard, struct glint_error *err);
/* The results of a capture as a line, or why there are none (showings is NULL); NULL without memory. */
json_t *contest_log_entry(const struct contest *contest, const struct showing *showings, const char *failure);
/* Keeps the state and the figures of a line. False with an error if it belongs to another comparison. */
bool contest_log_keep(struct contest_log *log, size_t capture, const json_t *line, struct glint_error *err);
/* The results of a capture, empty ones where there are none; valid until those of another one are asked for. */
const struct showing *contest_log_showings(const struct contest_log *log, size_t capture);
/* {"capture": N, "presets": […], "failure": T}; a new reference, NULL where there is none. */
json_t *contest_log_line(const struct contest_log *log, size_t capture);
double contest_log_figure(const struct contest_log *log, size_t capture, size_t preset, enum contest_figure figure);
/* Whether all results could be read back so far. */
bool contest_log_check(const struct contest_log *log, struct glint_error *err);
/* Removes the journal if the comparison is finished, or has no result yet. */
void contest_log_close(struct contest_log *log, bool finished);

/* ---- What is shown ---- */

struct contest_table {
    const struct contest *contest;
    const struct contest_log *log;
    const char *const *captures;
    size_t capture_count;
    size_t shown[CAPTURES_SHOWN]; /* which captures these are */
    size_t shown_count;
    bool rows; /* there are more captures */
};
const struct showing *contest_showing(const struct contest_table *table, size_t capture, size_t preset);
void contest_print(const struct contest_table *table);
/* All captures, one after the other. */
struct contest_overall;
void contest_write_json(FILE *out, const struct contest_table *table, const struct contest_overall *overall,
                        size_t indent, size_t depth);
void contest_write_csv(FILE *out, const struct contest_table *table);
/* FOLDER/index.html, from page.json and the pictures of the captures that are shown. */
bool contest_write_page(const char *folder, const struct contest_table *table, const struct contest_overall *overall,
                        const struct contest_pictures *pictures, struct glint_error *err);

/* ---- The whole comparison of one effect: run.c ---- */

struct contest_work {
    const struct list *captures;
    const char *folder; /* for the results, or NULL */
    struct shard shard;
    struct shard_record *record; /* of a shard, written before its first results, and then NULL */
    size_t effects;              /* of which the shard has results */
    struct sheet sheet;
    struct contest_log log;
    struct contest_table table;
    struct contest_overall *overall; /* NULL for one capture */
    struct contest_pictures pictures[CAPTURES_SHOWN];
};
/* Of a shard it makes the results alone. */
bool contest_compare(struct contest *contest, struct contest_work *work, struct glint_error *err);
void contest_work_finish(struct contest_work *work, bool finished);

#endif
