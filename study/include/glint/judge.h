/* Judges pipelines on one capture: how far each is from better answers, and what it costs. The capture is uploaded once,
   and what pipelines have in common is computed once. One thread at a time. */
#ifndef GLINT_JUDGE_H
#define GLINT_JUDGE_H

#include "glint/study.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_answer {
    GLINT_ANSWER_REFERENCE, /* what the same data give at best */
    GLINT_ANSWER_TRUTH,     /* what a path tracer computed for the scene itself */
    GLINT_ANSWER_COUNT
};
const char *glint_answer_name(enum glint_answer answer); /* "reference", "truth" */

enum { GLINT_JUDGE_RAYS = 64 };
struct glint_judge_options {
    bool reference, truth; /* which answers pipelines are compared with */
    /* Where the reference comes from. A run folder, which must be of this capture; NULL: it is traced, once for each question
       that pipelines ask (their lobe and their fog), as <glint/reference.h> does it. */
    const char *reference_run;
    const char *reference_folder; /* NULL, or a folder that must exist: references are kept in it, and found again */
    uint32_t reference_rays;      /* a pixel; 0: GLINT_JUDGE_RAYS */
    double reference_noise;       /* relative, at which it has enough of them; 0: never */
    bool all;                     /* every pass runs, also one that has nothing to do */
    uint32_t metrics;             /* as in struct glint_metric_options; 0: the cheap ones */
    uint32_t resamples;           /* of the intervals of errors; 0: no intervals */
    uint32_t seed;                /* likewise */
    bool keep_resampled;          /* for glint_metrics_difference of two verdicts */
    uint64_t
        keep_bytes; /* memory of the device for images beside those of one run; 0: a quarter of it, 4 GiB at most */
};

struct glint_judge;
/* Device and strings stay the caller's and must outlive the judge. */
struct glint_judge *glint_judge_create(struct glint_device *device, const struct glint_judge_options *options,
                                       struct glint_error *err);
void glint_judge_destroy(struct glint_judge **judge);
/* The capture stays the caller's; NULL unloads. Pipelines are told apart by the lineage that is given with them: in a shot
   each remembers the frame before as it left it itself. */
bool glint_judge_load(struct glint_judge *judge, struct glint_capture *capture, struct glint_error *err);
/* Not to be loaded or destroyed; its last run is the pipeline's that was looked at or timed last. */
struct glint_replay *glint_judge_replay(struct glint_judge *judge);
struct glint_capture *glint_judge_capture(const struct glint_judge *judge);
/* One enum glint_surface for each pixel of the loaded capture's G-buffer. */
const uint8_t *glint_judge_surfaces(const struct glint_judge *judge);

/* What a pipeline is compared with, of R G B (A); valid until the next load. *error: the standard error of each pixel relative
   to its value, NULL where none is declared. The capture's lack of a truth is GLINT_ERROR_FORMAT. */
const struct glint_pixels *glint_judge_answer(struct glint_judge *judge, enum glint_answer answer,
                                              const struct glint_pipeline *pipeline, const float **error,
                                              glint_progress progress, void *user, struct glint_error *err);

struct glint_verdict_pass {
    const struct glint_pass *pass;
    bool ran, cached_work;
    bool executed; /* on the device; false also where nothing changed since an earlier run */
    char reason[192];
};
struct glint_verdict {
    /* Over the pixels that reflect; the first row is all of them, then come the classes of surface. No rows: there is no such
       answer. Pixels for which the pipeline gives no reflection count with what is there. */
    struct glint_metric_table errors[GLINT_ANSWER_COUNT];
    struct glint_error no_truth;    /* why the capture gives none, though it was asked for */
    struct glint_ends ends;         /* why rays ended; steps and fetches a ray */
    double steps_px, fetches_px;    /* the same of all rays of a frame, for a pixel of the capture */
    struct glint_pixels reflection; /* zeros where the passes that make one have nothing to do */
    uint8_t *given;                 /* glint_study_given */
    struct glint_verdict_pass *passes;
    size_t pass_count;
    double run_seconds, metric_seconds; /* of the wall clock: passes and readback; all that came after */
};
void glint_verdict_finish(struct glint_verdict *verdict);
/* Runs the pipeline, with diagnostics, where something changed since an earlier pipeline, and compares. */
bool glint_judge_look(struct glint_judge *judge, const struct glint_pipeline *pipeline, uint32_t lineage,
                      struct glint_verdict *verdict, glint_progress progress, void *user, struct glint_error *err);

struct glint_pass_cost {
    const struct glint_pass *pass;
    bool cached_work; /* see struct glint_pass_result */
    uint64_t ns;
};
struct glint_cost {
    struct glint_pass_cost *passes; /* those that ran, in order */
    size_t pass_count;
    uint64_t frame_ns, cubemaps_ns; /* sums: what each frame pays; cached work */
};
void glint_cost_finish(struct glint_cost *cost);
/* Times belong to rounds. Within a round, work that pipelines have in common is measured once, by the first of them, and
   its time stands in the costs of all; each pass is run once before it is timed. To compare pipelines call these in
   turns: A B C, next round, A B C. Later rounds measure everything anew. Diagnostics are off. */
void glint_judge_next_round(struct glint_judge *judge);
/* `whole`: measures all passes of this pipeline, in one piece. */
bool glint_judge_time(struct glint_judge *judge, const struct glint_pipeline *pipeline, uint32_t lineage, bool whole,
                      struct glint_cost *cost, glint_progress progress, void *user, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
