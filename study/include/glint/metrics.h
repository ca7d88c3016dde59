/* How far two images are apart, in whole and by class of pixel. docs/metrics.md states every formula and its source. */
#ifndef GLINT_METRICS_H
#define GLINT_METRICS_H

#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Values of `components` floats a pixel; `values` is malloc'd. */
struct glint_pixels {
    uint32_t width, height, components;
    float *values;
};
void glint_pixels_finish(struct glint_pixels *pixels);

/* ---- Metrics ---- */

enum glint_metric {
    GLINT_METRIC_MEAN,               /* of found - truth */
    GLINT_METRIC_RMSE,               /* root of the mean of (found - truth)² */
    GLINT_METRIC_RELATIVE_MSE,       /* mean of (found - truth)²/(truth² + epsilon) */
    GLINT_METRIC_SYMMETRIC,          /* mean of |found - truth|/(|found| + |truth| + GLINT_SYMMETRIC_EPSILON) */
    GLINT_METRIC_PSNR,               /* 20 log10(peak/RMSE) in dB: better is higher; +inf for equal images */
    GLINT_METRIC_CLEAN_RMSE,         /* RMSE and relative MSE without what the truth's noise is expected to add */
    GLINT_METRIC_CLEAN_RELATIVE_MSE, /* the same of the relative one */
    GLINT_METRIC_SSIM,               /* in [-1, 1], 1 for equal images: better is higher */
    GLINT_METRIC_FLIP,               /* in [0, 1] */
    GLINT_METRIC_HDR_FLIP,           /* in [0, 1] */
    GLINT_METRIC_COUNT
};
struct glint_metric_info {
    const char *name;  /* "relative_mse": as --metrics takes it and JSON has it */
    const char *title; /* "relative MSE" */
    const char *what;  /* one line */
    bool higher_is_better;
};
/* NULL past the last. */
const struct glint_metric_info *glint_metric(size_t metric);
/* "rmse,flip": a bit (1 << metric) for each; "all" for all. */
bool glint_metrics_parse(const char *names, uint32_t *metrics, struct glint_error *err);
#define GLINT_METRICS_ALL ((1u << GLINT_METRIC_COUNT) - 1)
/* What costs no more than reading the images once. */
#define GLINT_METRICS_CHEAP ((1u << GLINT_METRIC_SSIM) - 1)

/* Added to the square of the truth below the fraction of the relative error, so that black can be compared. */
#define GLINT_RELATIVE_EPSILON 0.01
#define GLINT_SYMMETRIC_EPSILON 0.05
/* Pixels per degree of a display 0.7 m wide, of 3840 pixels, seen from 0.7 m. */
#define GLINT_PPD 67.0206432766

/* ---- Classes of pixels ---- */

/* A label for each pixel and the labels' names; any partition of an image: by surface, by angle, by source. */
struct glint_classes {
    const char *title;        /* "surface"; not copied, nor are the names */
    const char *const *names; /* names[0] is that of label 1 */
    uint32_t count;           /* of names; at most GLINT_CLASSES */
    uint8_t *labels;          /* one a pixel, rows from the top: k for names[k - 1], 0 for none of them; malloc'd */
};
#define GLINT_CLASSES 64
void glint_classes_finish(struct glint_classes *classes);

/* How often each pair of labels of two sets meets; table[i·(b->count + 1) + j] counts pixels of label i of `a` and j of `b`. `table`
   has (a->count + 1)·(b->count + 1) elements. `mask` as below. */
void glint_classes_cross(const struct glint_classes *a, const struct glint_classes *b, size_t pixels,
                         const uint8_t *mask, uint64_t *table);

/* ---- Comparing ---- */

/* Zero means the default that is named. */
struct glint_metric_options {
    uint32_t metrics; /* bits 1 << GLINT_METRIC_…; 0: GLINT_METRICS_CHEAP */
    /* Names of the components, "R G B A"; NULL: R G B A as far as there are components. Compared are the channels that both
       images have. SSIM is taken of the luminance of R G B, of a single channel where these are not all there; FLIP
       needs R G B. */
    const char *found_channels, *truth_channels;
    const uint8_t
        *mask; /* pixels that are 0 here are left out, and are black in both images for SSIM and FLIP; NULL: none */
    const struct glint_classes *classes; /* sets of classes, each labelling every pixel */
    size_t class_sets;
    /* One value a pixel or NULL: the standard error of a truth that is itself a mean of samples, relative to its value; pixels
       of which it is +inf are left out, as by the mask. */
    const float *truth_error;
    double epsilon;  /* of the relative MSE; 0: GLINT_RELATIVE_EPSILON */
    double peak;     /* of PSNR; 0: the highest absolute value of the truth, among what is compared */
    double ppd;      /* pixels per degree of FLIP; 0: GLINT_PPD */
    double exposure; /* f-stops that the images are multiplied by (2^exposure) for SSIM and FLIP */
    /* f-stops of HDR-FLIP; both 0: from the truth's luminance. */
    double start_exposure, stop_exposure;
    uint32_t resamples; /* of the bootstrap behind the intervals; 0: none, intervals are NAN */
    uint32_t seed;
    bool keep_resampled; /* for glint_metrics_difference */
};
#define GLINT_RESAMPLES 400

/* `value` and its 95 % confidence interval (percentile bootstrap over tiles of pixels: neighbours do not err
   independently). NAN: not asked for, or there is nothing that it could be computed from. */
struct glint_figure {
    double value, low, high;
};
struct glint_metric_row {
    const char *set, *name; /* "all", "all" for the first row; else a title and a name of the classes */
    uint64_t pixels;        /* compared */
    uint64_t invalid;       /* left out because one of the images is NaN or infinite there */
    double truth_mean;      /* of all channels */
    double truth_noise;     /* root mean square of what truth_error says */
    struct glint_figure of[GLINT_METRIC_COUNT];
};
struct glint_metric_table {
    struct glint_metric_row *rows; /* all pixels, then each class of each set, those without pixels too */
    size_t count;
    /* NaN or infinite in the found image, in the truth; the first such pixel of both. Such pixels are in no figure; whoever
       reports figures must fail when there are any: glint_metrics_valid. */
    uint64_t invalid_found, invalid_truth;
    uint32_t first_x, first_y;
    double epsilon, peak, ppd, exposure;  /* as used */
    double start_exposure, stop_exposure; /* of HDR-FLIP, f-stops */
    uint32_t exposures;                   /* 0: not computed */
    uint32_t resamples, seed, tile_px, tiles;
    /* A value a pixel, malloc'd, NULL when not asked for. */
    float *flip, *hdr_flip;
    double *resampled; /* [row][metric][resample], malloc'd, NULL unless asked for */
};

/* Both images are of one size. False with an error when they are not, or share no channel. */
bool glint_metrics_compare(const struct glint_pixels *found, const struct glint_pixels *truth,
                           const struct glint_metric_options *options, struct glint_metric_table *table,
                           struct glint_error *err);
void glint_metric_table_finish(struct glint_metric_table *table);
/* False, with how many and where the first is, when either image was NaN or infinite; `what` begins the message. */
bool glint_metrics_valid(const struct glint_metric_table *table, const char *what, struct glint_error *err);

/* How much more `b` errs than `a` in a metric of a row, and the interval of that difference. Both are comparisons of images of one size by
   the same classes, resamples and seed, and keep their resampled figures: tiles were drawn alike, so that what both pictures
   have in common is in neither end of the interval. It is far narrower than what two intervals beside each other tell. */
bool glint_metrics_difference(const struct glint_metric_table *a, const struct glint_metric_table *b, size_t row,
                              enum glint_metric metric, struct glint_figure *difference, struct glint_error *err);

/* ---- Errors by class of surface ---- */

/* What a pixel shows, by roughness: mirror-like up to the first threshold, glossy up to the second, rough above. */
#define GLINT_MIRROR_ROUGHNESS 0.1
#define GLINT_GLOSSY_ROUGHNESS 0.5
enum glint_surface {
    GLINT_SURFACE_NONE, /* sky, or nothing that reflects: in no figure */
    GLINT_SURFACE_MIRROR,
    GLINT_SURFACE_GLOSSY,
    GLINT_SURFACE_ROUGH,
    GLINT_SURFACE_COUNT
};
/* "all", "mirror-like", "glossy", "rough": names of the elements of the arrays below, where all surfaces come first. */
const char *glint_surface_name(enum glint_surface surface);
/* Labels that are enum glint_surface as a set of classes; they stay the caller's. */
struct glint_classes glint_surface_classes(const uint8_t *labels);
enum glint_surface glint_surface_of(double roughness);

struct glint_image_error {
    uint64_t pixels;     /* compared */
    uint64_t invalid;    /* NaN or infinite in one of the images; in no other figure */
    double truth_mean;   /* of all channels */
    double mean;         /* of found - truth */
    double rmse;         /* root of the mean of (found - truth)² */
    double relative_mse; /* mean of (found - truth)²/(truth² + GLINT_RELATIVE_EPSILON) */
    double symmetric; /* mean of |found - truth|/(|found| + |truth| + GLINT_SYMMETRIC_EPSILON): no outlier rules it */
    /* rmse and relative_mse without what the truth's own noise is expected to add, and that noise's root mean square. Truths whose
       draws are spread better than independent ones have less noise than they declare: the real error lies between. */
    double clean_rmse, clean_relative_mse, truth_noise;
};
struct glint_image_errors {
    struct glint_image_error of[GLINT_SURFACE_COUNT]; /* [0]: all surfaces */
};
/* glint_metrics_compare of the first `channels` channels, by surface and without intervals. `surfaces` may be NULL: all
   pixels are compared then, as [0] alone. */
bool glint_study_image(const struct glint_pixels *found, const struct glint_pixels *truth, uint32_t channels,
                       const uint8_t *surfaces, const float *truth_error, struct glint_image_errors *errors,
                       struct glint_error *err);

/* ---- Errors of distances ---- */

struct glint_distance_error {
    uint64_t rays, invalid; /* invalid: NaN, negative; counts as infinitely wrong */
    double right;           /* share within 5 % of the truth */
    double median, p95;     /* of |found - truth|/truth; 0 where both are infinite, infinite where one is */
};
struct glint_distance_errors {
    struct glint_distance_error of[GLINT_SURFACE_COUNT];
};
/* Distances in metres, +inf for the sky; `count` of each. Values of the truth that are not above 0 are left out. */
bool glint_study_distances(const float *found, const float *truth, const uint8_t *surfaces, size_t count,
                           struct glint_distance_errors *errors, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
