/* What is learned from runs. */
#ifndef GLINT_STUDY_H
#define GLINT_STUDY_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Errors of images and of distances, by class of surface ---- */

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
enum glint_surface glint_surface_of(double roughness);
/* One enum glint_surface for each pixel of the G-buffer, rows from the top; malloc'd, NULL on failure. */
uint8_t *glint_study_surfaces(struct glint_capture *capture, struct glint_error *err);

/* Values of `components` floats a pixel; `values` is malloc'd. */
struct glint_pixels {
    uint32_t width, height, components;
    float *values;
};
void glint_pixels_finish(struct glint_pixels *pixels);

/* Added to the square of the truth below the fraction of the relative error, so that black can be compared. */
#define GLINT_RELATIVE_EPSILON 0.01
#define GLINT_SYMMETRIC_EPSILON 0.05

struct glint_image_error {
    uint64_t pixels;     /* compared */
    uint64_t invalid;    /* NaN or infinite in what was found; in no other figure */
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
/* Compares the first `channels` channels, pixel by pixel; both images are of one size, `surfaces` may be NULL: all pixels
   are compared then, as [0] alone. `truth_error`, one value a pixel or NULL, is the standard error of a truth that is
   itself a mean of samples, relative to its value. */
bool glint_study_image(const struct glint_pixels *found, const struct glint_pixels *truth, uint32_t channels,
                       const uint8_t *surfaces, const float *truth_error, struct glint_image_errors *errors,
                       struct glint_error *err);

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

/* ---- What is compared ---- */

/* The reflection of the last run at full resolution, as the passes left it for `compose`. False with an error when
   there is none. */
bool glint_study_reflection(struct glint_replay *replay, struct glint_pixels *pixels, struct glint_error *err);
/* The same of a run folder. */
bool glint_study_run_reflection(struct glint_run *run, struct glint_pixels *pixels, struct glint_error *err);
/* truth.reflection.LOBE of the lobe that the pipeline draws from (downsample.ndf), R G B; *error receives its
   standard error in each pixel (channel `error`), malloc'd, NULL when the part has none. */
bool glint_study_truth(struct glint_capture *capture, const struct glint_pipeline *pipeline,
                       struct glint_pixels *pixels, float **error, struct glint_error *err);
/* The preset `reference`, asked the same question as `pipeline`: its lobe and its fog. */
struct glint_pipeline *glint_study_reference(const struct glint_pipeline *pipeline, struct glint_error *err);

/* Which pixels the last run gives `reflection` for, 1 or 0 each: at least half of what is there is its own, by the
   reflection's alpha and, where the run makes one, the image `contribution`. malloc'd, NULL on failure. */
uint8_t *glint_study_given(struct glint_replay *replay, const struct glint_pixels *reflection, struct glint_error *err);

/* The last picture at full resolution, composed or with what is laid over it; NULL when there is none. */
const struct glint_image *glint_study_picture(struct glint_replay *replay);
/* Whether a pass of the last run read `part` of the capture ("water", "transparent"). */
bool glint_study_draws(struct glint_replay *replay, const char *part);
/* A picture against the capture's `scene` where `part` covers the opaque surfaces; 0 pixels where the capture lacks one of
   them. */
bool glint_study_over(const struct glint_pixels *picture, struct glint_capture *capture, const char *part,
                      struct glint_image_error *error, struct glint_error *err);

/* ---- Rays ---- */

/* Rays that ended for one reason in one tracer, by what the tracers' diagnostics say, whatever the truth. */
struct glint_end_row {
    char tracer[32];     /* "screen" for screen_end */
    const char *reason;  /* a name of passes/shared/end_reasons.h */
    const char *text;    /* what it means */
    uint64_t rays;       /* that no later tracer went on with */
    uint64_t pixels;     /* of those that were compared, those whose ray this is */
    double share, error; /* of all rays; mean symmetric error of those pixels, NAN without any */
};
struct glint_ends {
    struct glint_end_row rows[64]; /* those with rays, in the order of the tracers */
    size_t count;
    uint64_t rays;
    double steps, fetches; /* a ray, of all tracers together */
};
/* After a run with diagnostics. `found`, `truth` and `compared` (1: this pixel) are of full resolution; NULL: no errors.
   A run without a tracer has no rays. */
bool glint_study_ends(struct glint_replay *replay, const struct glint_pixels *found, const struct glint_pixels *truth,
                      const uint8_t *compared, struct glint_ends *ends, struct glint_error *err);

/* Rays that ended for one reason in one tracer. Their distance is compared with truth.mirror at the pixel they start
   from. A ray that reports +inf (only the direction counts) is right where the truth is the sky, and infinitely wrong
   elsewhere; so is the converse. */
struct glint_trace_row {
    const char *tracer; /* "screen", "cube map", "all" */
    const char *reason; /* a name of passes/shared/end_reasons.h, "all" */
    const char *text;   /* what it means */
    size_t rays;
    double share;        /* of all rays */
    double right;        /* share of this row's rays within 5 % of the truth */
    double median_error; /* relative */
    double p95_error;
    double
        radiance_error; /* mean of |found - truth|/(found + truth + GLINT_SYMMETRIC_EPSILON) over R G B of reflection_half and
                              truth.reflection.ggx; NAN when one is missing. The truth has no fog: compare without */
};
struct glint_trace_table {
    struct glint_trace_row rows[32]; /* those with rays, tracer by tracer; the last one is all of them */
    size_t count;
    struct glint_distance_errors surfaces; /* all rays, those of rougher surfaces too */
    double fetches[GLINT_SURFACE_COUNT];   /* mean of both tracers' texture fetches for a ray, what no device changes */
};

/* After a run with diagnostics that wrote depth_half, normal_half, pick, travelled and the tracers' end reasons (those of
   a slot left out count as not traced). Rays from surfaces up to `max_roughness`; mirror rays are compared, so run with
   downsample.jitter=0. The capture must carry truth.mirror. */
bool glint_study_trace(struct glint_replay *replay, struct glint_capture *capture, double max_roughness,
                       struct glint_trace_table *table, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
