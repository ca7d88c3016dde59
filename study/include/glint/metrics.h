/* Error metrics of an image (`found`) against a better one (`truth`), over all pixels and by class of pixel. docs/metrics.md states
   every formula and its source. */
#ifndef GLINT_METRICS_H
#define GLINT_METRICS_H

#include <stdint.h>

#include "glint/common.h"
#include "glint/passes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An image of `components` floats a pixel, rows from the top; `values` is malloc'd. */
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
    GLINT_METRIC_CLEAN_RMSE,         /* RMSE without the expected contribution of the truth's noise */
    GLINT_METRIC_CLEAN_RELATIVE_MSE, /* relative MSE without it */
    GLINT_METRIC_SSIM,               /* in [-1, 1], 1 for equal images: better is higher */
    GLINT_METRIC_FLIP,               /* in [0, 1] */
    GLINT_METRIC_HDR_FLIP,           /* in [0, 1] */
    GLINT_METRIC_COUNT
};
struct glint_metric_info {
    const char *name;  /* "relative_mse": as --metrics takes it and JSON has it */
    const char *title; /* "relative MSE" */
    const char *what;  /* a description of one line */
    bool higher_is_better;
};
/* NULL past the last. */
const struct glint_metric_info *glint_metric(size_t metric);
/* "rmse,flip": a bit (1 << metric) for each; "all" for all. */
bool glint_metrics_parse(const char *names, uint32_t *metrics, struct glint_error *err);
#define GLINT_METRICS_ALL ((1u << GLINT_METRIC_COUNT) - 1)
/* Metrics that need no more than a pass over both images. */
#define GLINT_METRICS_CHEAP ((1u << GLINT_METRIC_SSIM) - 1)

/* Added to the denominators of the relative and of the symmetric error, so that black pixels can be compared. */
#define GLINT_RELATIVE_EPSILON 0.01
#define GLINT_SYMMETRIC_EPSILON 0.05
/* Pixels per degree of a display 0.7 m wide, of 3840 pixels, seen from 0.7 m. */
#define GLINT_PPD 67.0206432766

/* ---- Classes of pixels ---- */

enum { GLINT_CLASSES = 64 };
/* A partition of an image's pixels, such as by surface, by angle or by source: a label for each pixel, and the labels' names. */
struct glint_classes {
    const char *title;                /* "surface"; neither it nor the names are copied */
    const char *names[GLINT_CLASSES]; /* names[k - 1] belongs to label k */
    uint32_t count;                   /* number of names */
    uint8_t *labels;                  /* one a pixel, rows from the top; 0: the pixel is in no class; malloc'd */
};
void glint_classes_finish(struct glint_classes *classes);

/* The contingency table of two partitions: table[i·(b->count + 1) + j] receives the number of pixels with label i in `a` and j in `b`.
   `table` has (a->count + 1)·(b->count + 1) elements. Pixels that are 0 in `mask` (may be NULL) are left out. */
void glint_classes_cross(const struct glint_classes *a, const struct glint_classes *b, size_t pixels,
                         const uint8_t *mask, uint64_t *table);

/* ---- Comparing ---- */

/* A zero-initialised struct selects the defaults that are stated. */
struct glint_metric_options {
    uint32_t metrics; /* bits 1 << GLINT_METRIC_…; 0: GLINT_METRICS_CHEAP */
    /* Names of the components, such as "R G B A", the default for NULL. Channels that both images have are compared. SSIM uses the
       luminance of R G B, or a single channel if not all three are there; FLIP needs R G B. */
    const char *found_channels, *truth_channels;
    /* Pixels that are 0 here are left out; for SSIM and FLIP they are black in both images. NULL: all pixels count. */
    const uint8_t *mask;
    const struct glint_classes *classes; /* `class_sets` partitions, whose classes get figures of their own */
    size_t class_sets;
    /* NULL, or one value a pixel: the relative standard error of a truth that is itself a mean of samples. Pixels where it is +inf are
       left out as by the mask. */
    const float *truth_error;
    double epsilon;  /* of the relative MSE; 0: GLINT_RELATIVE_EPSILON */
    double peak;     /* of PSNR; 0: the largest magnitude of the truth among the compared pixels */
    double ppd;      /* pixels per degree for FLIP; 0: GLINT_PPD */
    double exposure; /* in f-stops: SSIM and FLIP compare the images multiplied by 2^exposure */
    /* First and last exposure of HDR-FLIP in f-stops; both 0: chosen by the truth's luminance. */
    double start_exposure, stop_exposure;
    uint32_t resamples; /* bootstrap resamples for the confidence intervals; 0: none, and the intervals are NAN */
    uint32_t seed;
    bool keep_resampled; /* for glint_metrics_difference */
};
#define GLINT_RESAMPLES 400

/* A value and its 95 % confidence interval, by percentile bootstrap over tiles of pixels, since the errors of neighbours are correlated.
   NAN if it was not requested or cannot be computed. */
struct glint_figure {
    double value, low, high;
};
struct glint_metric_row {
    const char *set, *name; /* title of the partition and name of the class; "all", "all" for the first row */
    uint64_t pixels;        /* number of compared pixels */
    uint64_t invalid;       /* pixels left out since one of the images is NaN or infinite there */
    double truth_mean;      /* over all channels */
    double truth_noise;     /* root mean square of the truth's standard error */
    struct glint_figure of[GLINT_METRIC_COUNT];
};
struct glint_metric_table {
    struct glint_metric_row *rows; /* all pixels, then each class of each partition, also classes without pixels */
    size_t count;
    /* Numbers of pixels that are NaN or infinite in the found image and in the truth, and the first such pixel. They are in no figure;
       callers that report figures must fail if there are any (glint_metrics_valid). */
    uint64_t invalid_found, invalid_truth;
    uint32_t first_x, first_y;
    double epsilon, peak, ppd, exposure;  /* the values used */
    double start_exposure, stop_exposure; /* the values used, f-stops */
    uint32_t exposures;                   /* number of exposures of HDR-FLIP; 0: not computed */
    uint32_t resamples, seed, tile_px, tiles;
    /* One value a pixel, malloc'd; NULL if not requested. */
    float *flip, *hdr_flip;
    double *resampled; /* [row][metric][resample], malloc'd, NULL unless requested */
};

/* Fails if the images differ in size or have no channel in common. */
bool glint_metrics_compare(const struct glint_pixels *found, const struct glint_pixels *truth,
                           const struct glint_metric_options *options, struct glint_metric_table *table,
                           struct glint_error *err);
void glint_metric_table_finish(struct glint_metric_table *table);
/* Fails if either image has NaN or infinite pixels. The message begins with `what` and states their number and the first pixel. */
bool glint_metrics_valid(const struct glint_metric_table *table, const char *what, struct glint_error *err);

/* The difference of a metric between two comparisons, `b` minus `a`, and its confidence interval. Both must compare images of one size
   with the same classes, resamples and seed and have kept their resampled figures. As they drew the same tiles, errors that both have in
   common cancel, and the interval is far narrower than the two single intervals suggest. */
bool glint_metrics_difference(const struct glint_metric_table *a, const struct glint_metric_table *b, size_t row,
                              enum glint_metric metric, struct glint_figure *difference, struct glint_error *err);

/* Values that come in clusters, such as the figures of captures, of which those of one shot resemble each other. */
struct glint_clustered {
    const double *values;   /* NAN: unknown, which is left out */
    const size_t *clusters; /* of each value, less than cluster_count */
    size_t count, cluster_count;
    uint32_t resamples, seed;
};
/* The mean of the known values (NAN without any) and its 95 % interval, by a bootstrap over clusters: NAN if fewer than two have known values.
   Of few clusters the interval is too narrow. For a paired difference, the values are the differences of the pairs. */
bool glint_clustered_mean(const struct glint_clustered *clustered, struct glint_figure *mean, struct glint_error *err);

/* ---- Change from frame to frame ---- */

/* Root mean squares over the first three channels of the pixels that are compared in both frames. Errors that stay where they are cancel:
   what is left is what a viewer sees flicker. NAN without pixels, or without a truth. */
struct glint_flicker {
    uint64_t pixels;
    double picture, truth; /* the change of each from one frame to the next */
    double beside;         /* the change of the picture less that of the truth */
    double clean;          /* the same without the truth's noise, which the frames must have drawn independently */
};
/* Each array holds two frames, the earlier one first. `truth`, `truth_error` (relative standard errors, +inf where there is no truth) and
   `mask` (0: left out), and their elements but those of `truth`, may be NULL. Fails if sizes differ, or if some images have three channels or
   more and others fewer, of which the first is compared. */
bool glint_study_flicker(const struct glint_pixels found[2], const struct glint_pixels *truth,
                         const float *const *truth_error, const uint8_t *const *mask, struct glint_flicker *flicker,
                         struct glint_error *err);

/* ---- Errors by class of pixel ---- */

struct glint_image_error {
    uint64_t pixels;     /* number of compared pixels */
    uint64_t invalid;    /* pixels that are NaN or infinite in one of the images, which are in no other figure */
    double truth_mean;   /* over all channels */
    double mean;         /* of found - truth */
    double rmse;         /* root of the mean of (found - truth)² */
    double relative_mse; /* mean of (found - truth)²/(truth² + GLINT_RELATIVE_EPSILON) */
    double
        symmetric; /* mean of |found - truth|/(|found| + |truth| + GLINT_SYMMETRIC_EPSILON), robust against outliers */
    /* rmse and relative_mse without the expected contribution of the truth's noise, and the root mean square of that noise. A truth
       with stratified samples has less noise than it declares; the real error then lies between both values. */
    double clean_rmse, clean_relative_mse, truth_noise;
};
struct glint_image_errors {
    struct glint_image_error of[GLINT_CLASS_COUNT]; /* [0]: all pixels */
};
/* glint_metrics_compare of the first `channels` channels by class (labels: glint/passes.h), without intervals. If `labels` is NULL, all
   pixels are compared and only element 0 is set. */
bool glint_study_image(const struct glint_pixels *found, const struct glint_pixels *truth, uint32_t channels,
                       const uint8_t *labels, const float *truth_error, struct glint_image_errors *errors,
                       struct glint_error *err);

/* ---- Errors of distances ---- */

struct glint_distance_error {
    uint64_t rays, invalid; /* invalid: rays with a NaN or negative distance, whose error counts as infinite */
    double right;           /* fraction within 5 % of the truth */
    double median, p95;     /* of |found - truth|/truth, which is 0 if both are infinite and infinite if one is */
};
struct glint_distance_errors {
    struct glint_distance_error of[GLINT_CLASS_COUNT];
};
/* Compares `count` distances in metres, +inf for the sky. Rays whose true distance is not above 0 are left out. */
bool glint_study_distances(const float *found, const float *truth, const uint8_t *labels, size_t count,
                           struct glint_distance_errors *errors, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
