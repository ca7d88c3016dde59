/* Compares presets on the same captures: coverage, error against the truth, and cost. */
#ifndef GLINT_VIEWER_COMPARE_H
#define GLINT_VIEWER_COMPARE_H

#include "capture/missing.h"
#include "options/args.h"
#include "glint/judge.h"
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
    const char *folder;  /* folder in which pictures/ contains them at their own size */
    size_t values_bytes; /* bytes of pixel values stored for each picture */
    json_t *rows;        /* for each row, the pictures as JSON for the page */
};

/* Runs every preset on the capture; showings[i] is of contestant i. One that fails says so in its showing. `pictures`: NULL
   for none. False when nothing can be shown at all, or after Ctrl-C. */
bool contest_run(struct contest *contest, struct glint_capture *capture, struct showing *showings,
                 struct contest_pictures *pictures, struct glint_error *err);
void showing_finish(struct showing *showing);

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

/* All captures of a call: showings[capture · contest->count + contestant]. */
struct contest_table {
    const struct contest *contest;
    const char *const *captures;
    const struct showing *showings;
    size_t capture_count;
};
void contest_print(const struct contest_table *table);
json_t *contest_json(const struct contest_table *table);
/* Lines of text, malloc'd; NULL when memory is short. */
char *contest_csv(const struct contest_table *table);
/* FOLDER/index.html, from page.json and the pictures of each capture. */
bool contest_write_page(const char *folder, const struct contest_table *table, const struct contest_pictures *pictures,
                        struct glint_error *err);

#endif
