/* Measures the error and the cost of several pipelines on one capture. The capture is uploaded once, and work that pipelines have in
   common is done once. A judge may be used by one thread at a time. */
#ifndef GLINT_JUDGE_H
#define GLINT_JUDGE_H

#include "glint/study.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the result of a pipeline is compared with. */
enum glint_target {
    GLINT_TARGET_REFERENCE, /* the converged result from the data of the capture */
    GLINT_TARGET_TRUTH,     /* the path tracer's result for the scene itself, which the capture may carry */
    GLINT_TARGET_COUNT
};
const char *glint_target_name(enum glint_target target); /* "reference", "truth" */

enum { GLINT_JUDGE_RAYS = 64 };
struct glint_judge_options {
    const struct glint_effect *effect; /* whose result is compared; NULL: the first of glint_effects() */
    bool reference, truth;             /* which targets pipelines are compared with */
    /* A run folder of this capture whose result is the reference. NULL: the reference is traced (glint/reference.h), once for each
       combination of the parameters that define it among the pipelines. */
    const char *reference_run;
    const char *reference_folder; /* NULL, or an existing folder that stores traced references for later calls */
    const char *cache;            /* NULL, or a cache folder for these, too (glint/reference.h) */
    uint32_t reference_rays;      /* rays a pixel; 0: GLINT_JUDGE_RAYS */
    double reference_noise;       /* relative noise at which tracing stops early; 0: never */
    bool all;                     /* as in struct glint_replay_options */
    uint32_t metrics;             /* as in struct glint_metric_options; 0: the cheap ones */
    uint32_t resamples;           /* for the confidence intervals of errors; 0: no intervals */
    uint32_t seed;                /* of the resampling */
    bool keep_resampled;          /* for glint_metrics_difference of two verdicts */
    uint64_t keep_bytes; /* as in struct glint_replay_options; 0: a quarter of the device's memory, 4 GiB at most */
};

struct glint_judge;
/* The caller keeps the device and the options' strings, which must outlive the judge. */
struct glint_judge *glint_judge_create(struct glint_device *device, const struct glint_judge_options *options,
                                       struct glint_error *err);
void glint_judge_destroy(struct glint_judge **judge);
/* The caller keeps the capture; NULL unloads. When the frames of a shot are loaded one after the other, each pipeline keeps its own
   history, by the number `lineage` that its calls pass. */
bool glint_judge_load(struct glint_judge *judge, struct glint_capture *capture, struct glint_error *err);
/* When the device was lost: leaves it, and comes back after glint_device_reopen, with the capture and what is known of it but without history. Nothing but these two and
   glint_judge_destroy may be called in between. */
void glint_judge_leave(struct glint_judge *judge);
bool glint_judge_return(struct glint_judge *judge, struct glint_error *err);
/* The judge's replay, for reading results: its last run is that of the pipeline evaluated or timed last. Do not load or destroy it. */
struct glint_replay *glint_judge_replay(struct glint_judge *judge);
struct glint_capture *glint_judge_capture(const struct glint_judge *judge);
const struct glint_effect *glint_judge_effect(const struct glint_judge *judge);
/* The label of each pixel of the loaded capture's G-buffer: glint_study_labels. */
const uint8_t *glint_judge_labels(const struct glint_judge *judge);

/* The target that a pipeline is compared with, with the channels of the effect first; valid until the next load. *error receives the relative standard error of
   each pixel, or NULL if it is unknown. Fails with GLINT_ERROR_FORMAT if the capture has no truth. */
const struct glint_pixels *glint_judge_target(struct glint_judge *judge, enum glint_target target,
                                              const struct glint_pipeline *pipeline, const float **error,
                                              glint_progress progress, void *user, struct glint_error *err);

/* Slots that evaluations and timings from here on skip or force, as in struct glint_replay_options; the caller keeps the lists. NULL: none. */
void glint_judge_override(struct glint_judge *judge, const char *const *skip, const char *const *force);

struct glint_verdict_pass {
    const struct glint_pass *pass;
    bool ran, cached_work;
    bool executed; /* on the device; false for a host pass and if its images were up to date */
    char reason[192];
};
struct glint_verdict {
    /* Errors over the judged pixels: first of all, then by class. Without rows if there is no such target. Pixels that
       the pipeline does not cover count with the value that they have. */
    struct glint_metric_table errors[GLINT_TARGET_COUNT];
    struct glint_error no_truth; /* why there is no truth although the options request it */
    struct glint_ends ends;      /* why rays ended; steps and fetches a ray */
    double steps_px, fetches_px; /* steps and fetches of all rays of a frame, divided by the capture's pixels */
    struct glint_pixels result;  /* all 0 if the passes that make it were dropped */
    uint8_t *coverage;           /* glint_study_coverage */
    struct glint_verdict_pass *passes;
    size_t pass_count;
    double run_seconds, metric_seconds; /* wall-clock time of passes and readback, and of the comparison after it */
};
void glint_verdict_finish(struct glint_verdict *verdict);
/* Runs the pipeline with diagnostics, executing only passes that earlier runs did not execute in the same way, and compares its result. */
bool glint_judge_evaluate(struct glint_judge *judge, const struct glint_pipeline *pipeline, uint32_t lineage,
                          struct glint_verdict *verdict, glint_progress progress, void *user, struct glint_error *err);

struct glint_pass_cost {
    const struct glint_pass *pass;
    bool cached_work; /* see struct glint_pass_result */
    uint64_t ns;
};
struct glint_cost {
    struct glint_pass_cost *passes; /* the passes that ran, in order */
    size_t pass_count;
    uint64_t frame_ns, cubemaps_ns; /* sums: the cost of each frame; the cost when a cube map changes (cached_work) */
};
void glint_cost_finish(struct glint_cost *cost);
/* Times belong to rounds. Within a round, work that pipelines have in common is measured once, in the first of them, and its time
   counts for each of them. Each pass runs once before it is timed, and diagnostics are off. To compare pipelines, time them in turns:
   A B C, next round, A B C, and so on; each round measures everything again. */
void glint_judge_next_round(struct glint_judge *judge);
/* With `whole` all passes of this pipeline are executed and measured, also those that others have in common with it. */
bool glint_judge_time(struct glint_judge *judge, const struct glint_pipeline *pipeline, uint32_t lineage, bool whole,
                      struct glint_cost *cost, glint_progress progress, void *user, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
