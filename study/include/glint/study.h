/* Results of runs as the study measures them: those of effects, classes of pixels, why and where rays ended. */
#ifndef GLINT_STUDY_H
#define GLINT_STUDY_H

#include "glint/metrics.h"
#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Classes of pixels ---- */

/* The number of channels that are judged of an effect's result, and in *names (may be NULL) how metrics call them: "R G B", or "R" for one. */
uint32_t glint_effect_channels(const struct glint_effect *effect, const char **names);
/* The label of each pixel of the G-buffer (GLINT_CLASS_NONE, …), rows from the top; malloc'd, NULL on failure. */
uint8_t *glint_study_labels(struct glint_capture *capture, const struct glint_effect *effect, struct glint_error *err);
/* The partition that labels make. The caller keeps the labels. */
struct glint_classes glint_study_classes_of(const struct glint_effect *effect, const uint8_t *labels);

/* Partitions of the pixels that follow from the capture. A label of 0 means that the effect is not judged at the pixel, so that the labels
   of the first partition are the mask of the pixels to compare. */
enum {
    GLINT_CLASSES_EFFECT,   /* those of the effect: glint_study_labels */
    GLINT_CLASSES_ANGLE,    /* by N·V: up to 0.1 (grazing), 0.25, 0.5, 1 */
    GLINT_CLASSES_DISTANCE, /* by the distance from the camera: up to 3 m, 10 m, 30 m, farther */
    GLINT_CLASSES_HIT, /* by the hit distance of the exact ray: up to 1 m, 4 m, 16 m, farther, sky; needs the part effect->rays */
    GLINT_CAPTURE_CLASSES
};
/* *count receives the number of partitions: GLINT_CAPTURE_CLASSES, or one less without that part. Release each with
   glint_classes_finish. */
bool glint_study_classes(struct glint_capture *capture, const struct glint_effect *effect,
                         struct glint_classes sets[GLINT_CAPTURE_CLASSES], size_t *count, struct glint_error *err);
/* A partition by where the last run, which must have had diagnostics, found each pixel's light: screen, cube map, fallback, sky,
   nothing found; 0: the pixel has no ray. `labels` is NULL if no tracer ran. */
bool glint_study_source(struct glint_replay *replay, const struct glint_effect *effect, uint32_t width, uint32_t height,
                        struct glint_classes *source, struct glint_error *err);

/* ---- Results and pictures ---- */

/* The row of the image that a pipeline makes as the effect's result, or NULL if it has no pass for it. */
const struct glint_row *glint_study_made(const struct glint_pipeline *pipeline, const struct glint_effect *effect);
/* Whether both pipelines make the result, by the same passes with the same values, shaders and number of rays. */
bool glint_study_same(const struct glint_pipeline *a, const struct glint_pipeline *b,
                      const struct glint_effect *effect);
/* The result of the last run at full resolution, before it is composed into the picture. Fails with GLINT_ERROR_USAGE if there is none. */
bool glint_study_result(struct glint_replay *replay, const struct glint_effect *effect, struct glint_pixels *pixels,
                        struct glint_error *err);
/* The image of that result, or NULL. */
const struct glint_image *glint_study_result_image(struct glint_replay *replay, const struct glint_effect *effect);
/* The result in a run folder, and its image, or NULL. */
const struct glint_run_image *glint_study_run_result_image(const struct glint_run *run,
                                                           const struct glint_effect *effect);
bool glint_study_run_result(struct glint_run *run, const struct glint_effect *effect, struct glint_pixels *pixels,
                            struct glint_error *err);
/* The name of the part that holds the truth of what a pipeline estimates; NULL: of a pipeline with the default of the choice. */
void glint_study_truth_part(const struct glint_effect *effect, const struct glint_pipeline *pipeline, char part[96]);
/* The capture's true result for that pipeline, with the channels that the effect declares. *error receives the relative standard error of
   each pixel, malloc'd: channel `error`, 0 if the part does not have it, +inf where the truth is unknown (`weight` is 0). Fails with
   GLINT_ERROR_FORMAT if the capture has no such part. */
bool glint_study_truth(struct glint_capture *capture, const struct glint_effect *effect,
                       const struct glint_pipeline *pipeline, struct glint_pixels *pixels, float **error,
                       struct glint_error *err);
/* Whether a run answers the same question as a pipeline: has the same values of the parameters that define what is to be estimated of the
   effect, as far as both have them. The error names the run by its folder, and the first value that differs. */
bool glint_study_fits(const struct glint_run *run, const char *folder, const struct glint_pipeline *pipeline,
                      const struct glint_effect *effect, struct glint_error *err);
/* The preset `reference` with those parameters of `pipeline` that define what is to be estimated, such as the lobe and fog. */
struct glint_pipeline *glint_study_reference(const struct glint_pipeline *pipeline, struct glint_error *err);

/* Coverage of the last run's result: 1 for each pixel that shows it with a weight of at least one half, which is its alpha, if it has one,
   times the image of role CONTRIBUTION if a pass of the effect makes one; otherwise 0. malloc'd, NULL on failure. */
uint8_t *glint_study_coverage(struct glint_replay *replay, const struct glint_effect *effect,
                              const struct glint_pixels *result, struct glint_error *err);

/* The final picture at full resolution, with transparent surfaces and water if the run composes them, or NULL. */
const struct glint_image *glint_study_picture(struct glint_replay *replay);
/* Whether a pass of the last run reads a part of the capture ("water", "transparent"). */
bool glint_study_reads_part(struct glint_replay *replay, const char *part);
/* The error of a picture against the capture's part `scene`, over the pixels where a surface of `part` covers the opaque ones. `pixels` is
   0 if the capture lacks one of both parts. */
bool glint_study_overlay_error(const struct glint_pixels *picture, struct glint_capture *capture, const char *part,
                               struct glint_image_error *error, struct glint_error *err);

/* ---- Rays ---- */

/* Rays that ended for one reason in one tracer, according to the tracer's diagnostics. */
struct glint_end_row {
    const char *tracer;  /* the label of its row TRACER */
    const char *reason;  /* a name of passes/shared/end_reasons.h */
    const char *text;    /* its meaning */
    uint64_t rays;       /* number of rays that no later tracer continued */
    uint64_t pixels;     /* number of compared pixels with such a ray */
    double share, error; /* fraction of all rays; mean symmetric error of these pixels, NAN without any */
};
struct glint_ends {
    struct glint_end_row rows[64]; /* those with rays, in the order of the tracers */
    size_t count;
    uint64_t rays;
    double steps, fetches; /* mean for a ray, over all tracers together */
    /* Sums over the texels of those passes of the effect that count them and have no row TRACER: [0] once a frame, [1] for each ray. */
    double more_steps[2], more_fetches[2];
};
/* Call it after a run with diagnostics. All images are of full resolution. Only tracers of the effect count, and of their rays only those
   of pixels that are not 0 in `labels` (glint_study_labels; NULL: all). Errors are those of `found` against `truth` in the pixels that are 1 in `compared`;
   both may be NULL for no errors. A run without a tracer has no rays. */
bool glint_study_ends(struct glint_replay *replay, const struct glint_effect *effect, const uint8_t *labels,
                      const struct glint_pixels *found, const struct glint_pixels *truth, const uint8_t *compared,
                      struct glint_ends *ends, struct glint_error *err);

enum { GLINT_TRUTH_ON_SCREEN, GLINT_TRUTH_ELSEWHERE, GLINT_TRUTH_SKY, GLINT_TRUTH_ENDS };
/* Rays that ended for one reason in one tracer. Their distance is compared with the part effect->rays at the pixel they start from. The error is 0 if
   both distances are +inf (sky) and infinite if only one is. */
struct glint_trace_row {
    const char *tracer; /* the label of its row TRACER, "all" */
    const char *reason; /* a name of passes/shared/end_reasons.h, "all" */
    const char *text;   /* its meaning */
    size_t rays;
    size_t truth[GLINT_TRUTH_ENDS]; /* numbers of these rays by where the true mirror ray ends */
    double share;                   /* fraction of all rays */
    double right;                   /* fraction of these rays within 5 % of the true distance */
    double median_error;            /* relative */
    double p95_error;
    /* Mean of |found - truth|/(found + truth + GLINT_SYMMETRIC_EPSILON) over R G B of the rays' radiance and the effect's truth, where
       that is known; NAN if it is nowhere. The truth has no fog, so run without fog. */
    double radiance_error;
};
struct glint_trace_table {
    struct glint_trace_row rows[32]; /* rows with rays, tracer by tracer; the last row is the total */
    size_t count;
    struct glint_distance_errors surfaces; /* over all rays, also those from surfaces rougher than max_roughness */
    double fetches
        [GLINT_CLASS_COUNT]; /* mean texture fetches of both tracers for a ray, which do not depend on the device */
};

/* Call it after a run with diagnostics in which rays are mirror rays (downsample.jitter=0) and the images of the roles RAY_* and of the
   tracers' end reasons are available; a tracer that the pipeline leaves out counts as not traced. The rows contain rays from surfaces up
   to `max_roughness`. The capture must have the part effect->rays. */
bool glint_study_trace(struct glint_replay *replay, struct glint_capture *capture, const struct glint_effect *effect,
                       double max_roughness, struct glint_trace_table *table, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
