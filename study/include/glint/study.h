/* What is learned from runs. */
#ifndef GLINT_STUDY_H
#define GLINT_STUDY_H

#include "glint/metrics.h"
#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Classes of pixels ---- */

/* One enum glint_surface for each pixel of the G-buffer, rows from the top; malloc'd, NULL on failure. */
uint8_t *glint_study_surfaces(struct glint_capture *capture, struct glint_error *err);

/* What a capture says of each pixel of its G-buffer. Labels are 0 where nothing reflects, so that those of the first set are the mask
   of what is compared. */
enum {
    GLINT_CLASSES_SURFACE, /* by roughness: enum glint_surface */
    GLINT_CLASSES_ANGLE, /* by N·V, the cosine between normal and direction to the eye: up to 0.1 (grazing), 0.25, 0.5, 1 */
    GLINT_CLASSES_DISTANCE, /* by the surface's distance from the eye: up to 3 m, 10 m, 30 m, farther */
    GLINT_CLASSES_HIT, /* by how far the exact mirror ray goes: up to 1 m, 4 m, 16 m, farther, sky; needs truth.mirror */
    GLINT_CAPTURE_CLASSES
};
/* *count receives how many sets there are: GLINT_CAPTURE_CLASSES, or one less without truth.mirror. Each is released by
   glint_classes_finish. */
bool glint_study_classes(struct glint_capture *capture, struct glint_classes sets[GLINT_CAPTURE_CLASSES], size_t *count,
                         struct glint_error *err);
/* Where the last run, one with diagnostics, has each pixel's reflection from, by the end reason of its ray: screen, cube map, fallback,
   sky, nothing found; 0 without a ray. `labels` is NULL when no tracer ran. */
bool glint_study_source(struct glint_replay *replay, uint32_t width, uint32_t height, struct glint_classes *source,
                        struct glint_error *err);

/* ---- What is compared ---- */

/* The reflection of the last run at full resolution, as the passes left it for `compose`. False with an error when
   there is none. */
bool glint_study_reflection(struct glint_replay *replay, struct glint_pixels *pixels, struct glint_error *err);
/* The image that these are read from; NULL when there is none. */
const struct glint_image *glint_study_reflection_image(struct glint_replay *replay);
/* The reflection of a run folder. */
bool glint_study_run_reflection(struct glint_run *run, struct glint_pixels *pixels, struct glint_error *err);
/* truth.reflection.LOBE of the lobe that the pipeline draws from (downsample.ndf), R G B; *error receives its standard error in
   each pixel, malloc'd: channel `error`, 0 when the part has none, +inf where nothing is known (`weight` 0). */
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
/* After a run with diagnostics. `surfaces` (glint_study_surfaces: rays of those that reflect nothing count nowhere; NULL: all
   do), `found`, `truth` and `compared` (1: this pixel) are of full resolution; the last two NULL: no errors. A run
   without a tracer has no rays. */
bool glint_study_ends(struct glint_replay *replay, const uint8_t *surfaces, const struct glint_pixels *found,
                      const struct glint_pixels *truth, const uint8_t *compared, struct glint_ends *ends,
                      struct glint_error *err);

enum { GLINT_TRUTH_ON_SCREEN, GLINT_TRUTH_ELSEWHERE, GLINT_TRUTH_SKY, GLINT_TRUTH_ENDS };
/* Rays that ended for one reason in one tracer. Their distance is compared with truth.mirror at the pixel they start
   from. A ray that reports +inf (only the direction counts) is right where the truth is the sky, and infinitely wrong
   elsewhere; so is the converse. */
struct glint_trace_row {
    const char *tracer; /* "screen", "cube map", "all" */
    const char *reason; /* a name of passes/shared/end_reasons.h, "all" */
    const char *text;   /* what it means */
    size_t rays;
    size_t truth[GLINT_TRUTH_ENDS]; /* of these rays, where the truth's mirror ray ends */
    double share;                   /* of all rays */
    double right;                   /* share of this row's rays within 5 % of the truth */
    double median_error;            /* relative */
    double p95_error;
    double
        radiance_error; /* mean of |found - truth|/(found + truth + GLINT_SYMMETRIC_EPSILON) over R G B of reflection_half and
                              truth.reflection.ggx, where it is known; NAN when it is nowhere. The truth has no fog: compare without */
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
