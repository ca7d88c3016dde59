/* glint diff: two sides, each a list of images, and what is found of each pair of them. */
#ifndef GLINT_VIEWER_DIFF_H
#define GLINT_VIEWER_DIFF_H

#include <jansson.h>

#include "glint/difference.h"
#include "glint/exr.h"
#include "glint/metrics.h"
#include "glint/replay.h"
#include "draw/view/render.h"

/* idiff's, in the order of how bad they are. */
enum diff_status { DIFF_SAME = 0, DIFF_WARN = 1, DIFF_FAIL = 2, DIFF_SIZE = 3, DIFF_FILE = 4, DIFF_USAGE = 5 };

/* ---- Sides: side.c ---- */

enum { DIFF_CHANNELS = 64 };
struct diff_image {
    char *name;
    const char *slot, *variant, *unit; /* of a run's; "" where that is not known */
    uint32_t width, height;
    const char **channels; /* DIFF_CHANNELS at most */
    bool *integers;        /* beside them */
    size_t channel_count;
    size_t part;                       /* of the file */
    const struct glint_run_image *run; /* NULL: of a file */
};
struct diff_side {
    const char *text; /* as it was given */
    char *path, *part, *layer;
    struct glint_exr *exr; /* one of these two */
    struct glint_run *run;
    json_t *json;    /* of the run */
    bool is_capture; /* a file that holds a G-buffer */
    struct diff_image *images;
    size_t count;
};
/* Lists the images; a capture beside a run gives the engine's intermediates, named as the run's images are. */
bool diff_sides_open(struct diff_side sides[2], const char *const paths[2], struct glint_error *err);
void diff_side_finish(struct diff_side *side);
/* Values of some channels, interleaved: uint32_t where they are whole numbers, else float. */
bool diff_side_read(struct diff_side *side, const struct diff_image *image, const char *const *channels, size_t count,
                    bool integers, void *out, struct glint_error *err);

/* ---- Pairs: pairs.c, compare.c ---- */

struct diff_pair {
    const struct diff_image *a, *b; /* one of them may be missing */
    enum diff_status status;
    bool left_out;  /* one side lacks it, and may: a plan does without */
    char note[160]; /* why, where no value says it */
    struct glint_difference difference;
    struct glint_metric_table metrics; /* no rows: none were asked for, or there are no figures of this image */
    float *heat;                       /* a pixel: its largest difference; NULL unless asked for */
};
struct diff_options {
    struct glint_difference_limits limits;
    struct glint_metric_options metrics; /* metrics == 0: none */
    bool heat;
};
struct diff {
    struct diff_side sides[2];
    struct diff_options options;
    struct diff_pair *pairs;
    size_t count;
    int planned;     /* the side that was planned while the other ran everything; -1: neither */
    size_t left_out; /* images, with what one side lacks */
    bool *rayless;   /* texels of rays that the plan does not trace, and the other run does; NULL: none are known */
    uint32_t rays_width, rays_height;
    size_t rayless_count;
    json_t *settings; /* what two runs say differently of themselves: [{"what", "a", "b"}] */
    enum diff_status status;
};
/* Which images belong together. */
bool diff_pair_up(struct diff *diff, struct glint_error *err);
/* Pairs the images of both sides, and compares them. */
bool diff_compare(struct diff *diff, glint_progress progress, void *user, struct glint_error *err);
void diff_finish(struct diff *diff);
const struct diff_image *diff_pair_image(const struct diff_pair *pair); /* whichever is there */
/* The pair whose pass, in the order of the run, is the first that differs; diff->count when none does. */
size_t diff_first(const struct diff *diff);

/* ---- A run as planned beside one of everything: planned.c ---- */

bool diff_planned_begin(struct diff *diff, struct glint_error *err);
/* Whether one side lacks the image because its run did without: it says why of the pass that makes it. */
bool diff_is_planned_out(const struct diff *diff, const struct diff_pair *pair);
/* Makes values of rays that only one of the runs traced the same. */
void diff_planned_skip(const struct diff *diff, const struct diff_pair *pair, size_t count, const uint32_t *a,
                       uint32_t *b);

/* settings.c */
json_t *diff_settings(const json_t *a, const json_t *b);

/* report.c */
extern const char *const diff_words[]; /* of each status but those of errors */
/* The channel where the difference is largest; "" when nothing was compared. */
const char *diff_channel(const struct diff_pair *pair);
json_t *diff_json(const struct diff *diff);
void diff_print(const struct diff *diff, bool verbose);

/* ---- Pictures of what differs, PNG files: picture.c ---- */

/* What is drawn of a pair that both sides have: the layer whose values differ most, by one range of values, and where it
   differs. */
struct diff_drawing {
    struct source sources[2];
    struct picture pictures[3]; /* first, second, heat map; that one empty unless it was asked for */
    struct legend legends[3];
};
bool diff_draw(struct diff *diff, const struct diff_pair *pair, struct diff_drawing *drawing, struct glint_error *err);
void diff_drawing_finish(struct diff_drawing *drawing);
/* Names for the two sides, as short as they differ. */
void diff_labels(const struct diff *diff, char labels[2][64]);

/* Where images differ, and by how much; nothing is written when several images are all the same. */
bool diff_write_heat(const char *path, struct diff *diff, struct glint_error *err);
/* Both images and the heat map, a row for each pair that differs; when none does, of the last. */
bool diff_write_beside(const char *path, struct diff *diff, struct glint_error *err);
/* Both images in turns: the first that differs, else the last. */
bool diff_write_flicker(const char *path, struct diff *diff, struct glint_error *err);

/* ---- The page: page.c ---- */

/* What a page says beside the comparison; all of it may be NULL. */
struct diff_page {
    const char *title;
    const char *lead, *kind; /* a text shown first, and which of page_text's kinds it is */
    bool refresh;            /* it loads itself again while somebody works on what it shows */
    bool picture_first;      /* the finished picture before the images that differ, not after them */
};
bool diff_write_page(const char *path, struct diff *diff, const struct diff_page *page, struct glint_error *err);

#endif
