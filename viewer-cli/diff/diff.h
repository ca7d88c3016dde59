/* glint diff: two sides, each a list of images, compared pair by pair. */
#ifndef GLINT_VIEWER_DIFF_H
#define GLINT_VIEWER_DIFF_H

#include <jansson.h>

#include "glint/difference.h"
#include "glint/exr.h"
#include "glint/metrics.h"
#include "glint/replay.h"
#include "draw/view/render.h"

/* Exit statuses of OpenImageIO's idiff, from the best to the worst. */
enum diff_status { DIFF_SAME = 0, DIFF_WARN = 1, DIFF_FAIL = 2, DIFF_SIZE = 3, DIFF_FILE = 4, DIFF_USAGE = 5 };

/* ---- Sides: side.c ---- */

enum { DIFF_CHANNELS = 64 };
struct diff_image {
    char *name;
    const char *slot, *variant, *unit; /* of an image of a run; "" if unknown */
    uint32_t width, height;            /* at which it is compared */
    uint32_t own_width, own_height;    /* at which it is stored */
    const char **channels;             /* at most DIFF_CHANNELS */
    const char **stored;               /* their names in a captured part */
    bool *integers;                    /* for each channel */
    bool display;                      /* colours were encoded for a display, and are read decoded */
    size_t channel_count;
    size_t part;                            /* index in the file */
    const struct glint_run_image *run;      /* NULL: an image of a file */
    const struct glint_part_info *captured; /* NULL, or the part of the capture, whose values are decoded */
};
struct diff_side {
    const char *text; /* as on the command line */
    char *path, *part, *layer;
    struct glint_exr *exr; /* one of these two is open */
    struct glint_run *run;
    struct glint_capture *capture; /* of a part that is compared with an image of a run */
    json_t *json;                  /* run.json */
    bool is_capture;               /* the file contains a G-buffer */
    struct diff_image *images;
    size_t count;
};
/* Opens both sides and lists their images. If one is a capture and the other a run, the capture's engine intermediates
   are listed under the names of the run's images, or the one part that is named, such as truth.reflection.ggx. */
bool diff_sides_open(struct diff_side sides[2], const char *const paths[2], struct glint_error *err);
void diff_side_finish(struct diff_side *side);
/* The image of this name, or NULL. */
const struct diff_image *diff_side_image(const struct diff_side *side, const char *name);
/* Reads some channels, interleaved: as uint32_t if they are integers, else as float. Resamples to the size at which the image is compared. */
bool diff_side_read(struct diff_side *side, const struct diff_image *image, const char *const *channels, size_t count,
                    bool integers, void *out, struct glint_error *err);

/* Makes an image that is read as `out`: each texel is the mean of the area that it covers, of integers the one at its centre. resample.c */
struct diff_size {
    uint32_t width, height;
};
void diff_resample(const void *in, struct diff_size from, void *out, struct diff_size to, size_t channels,
                   bool integers);

/* ---- Pairs: pairs.c, compare.c ---- */

struct diff_pair {
    const struct diff_image *a, *b; /* one of them may be NULL */
    enum diff_status status;
    bool left_out;  /* only one side has the image, which is correct because the plan of the other skipped it */
    char note[240]; /* the reason, if the values do not show it */
    struct glint_difference difference;
    struct glint_metric_table metrics; /* no rows: not requested, or not defined for this image */
    /* The same over R, G and B alone, where the image has alpha, which may mean another thing in each; without marks or rows elsewhere. */
    struct glint_difference color;
    struct glint_metric_table color_metrics;
    float *heat; /* the largest difference of each pixel; NULL unless requested */
};
struct diff_options {
    struct glint_difference_limits limits;
    struct glint_metric_options metrics; /* metrics == 0: none */
    bool heat;
    bool resample; /* compares images of different sizes at the smaller one */
};
struct diff {
    struct diff_side sides[2];
    struct diff_options options;
    struct diff_pair *pairs;
    size_t count;
    int planned;     /* the side that was planned if the other ran all passes; -1: neither */
    size_t left_out; /* number of images that one side skipped */
    bool *rayless;   /* texels of rays that the plan skips and the other run traces; NULL: unknown */
    uint32_t rays_width, rays_height;
    size_t rayless_count;
    json_t *settings; /* settings in which the two runs differ: [{"what", "a", "b"}] */
    enum diff_status status;
};
/* Finds the image of the other side for each image. */
bool diff_pair_up(struct diff *diff, struct glint_error *err);
/* Pairs the images of both sides and compares them. */
bool diff_compare(struct diff *diff, glint_progress progress, void *user, struct glint_error *err);
void diff_finish(struct diff *diff);
const struct diff_image *diff_pair_image(const struct diff_pair *pair); /* the one that exists */
/* The first pair that differs, in the order of the passes; diff->count if there is none. */
size_t diff_first(const struct diff *diff);

/* ---- Comparison of a planned run with one that ran all passes: planned.c ---- */

bool diff_planned_begin(struct diff *diff, struct glint_error *err);
/* Whether the run of one side skipped the image, as its run.json says for the pass that writes it. */
bool diff_is_planned_out(const struct diff *diff, const struct diff_pair *pair);
/* Sets values of rays that only one run traced to the same value. */
void diff_planned_skip(const struct diff *diff, const struct diff_pair *pair, size_t count, const uint32_t *a,
                       uint32_t *b);

/* settings.c */
json_t *diff_settings(const json_t *a, const json_t *b);

/* report.c */
extern const char *const diff_words[]; /* of each status except errors */
/* The channel with the largest difference; "" if nothing was compared. */
const char *diff_channel(const struct diff_pair *pair);
json_t *diff_json(const struct diff *diff);
void diff_print(const struct diff *diff, bool verbose);

/* ---- Pictures of the differences, as PNG files: picture.c ---- */

/* Drawing of a pair: the layer with the largest difference of both images in one range of values, and the heat map. */
struct diff_drawing {
    struct source sources[2];
    struct picture pictures[3]; /* first, second, heat map (empty unless requested) */
    struct legend legends[3];
};
bool diff_draw(struct diff *diff, const struct diff_pair *pair, struct diff_drawing *drawing, struct glint_error *err);
void diff_drawing_finish(struct diff_drawing *drawing);
/* The shortest names that tell the two sides apart. */
void diff_labels(const struct diff *diff, char labels[2][64]);

/* Heat maps of the differences. Nothing is written if there are several images and all are equal. */
bool diff_write_heat(const char *path, struct diff *diff, struct glint_error *err);
/* Both images and the heat map, in one row for each pair that differs; of the last pair if none does. */
bool diff_write_beside(const char *path, struct diff *diff, struct glint_error *err);
/* Both images of the first pair that differs, else of the last, as an animation. */
bool diff_write_flicker(const char *path, struct diff *diff, struct glint_error *err);

/* ---- The page: page.c ---- */

/* What the page shows besides the comparison. All pointers may be NULL. */
struct diff_page {
    const char *title;
    const char *lead, *kind; /* a text at the top, and its kind for page_text */
    bool refresh;            /* the page reloads itself as long as a process updates it */
};
bool diff_write_page(const char *path, struct diff *diff, const struct diff_page *page, struct glint_error *err);

#endif
