/* What is learned from runs. */
#ifndef GLINT_STUDY_H
#define GLINT_STUDY_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

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
    double radiance_error; /* mean of |found - truth|/(found + truth + 0.05) over R G B of reflection_half and
                              truth.reflection.ggx; NAN when one is missing. The truth has no fog: compare without */
};
struct glint_trace_table {
    struct glint_trace_row rows[32]; /* those with rays, tracer by tracer; the last one is all of them */
    size_t count;
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
