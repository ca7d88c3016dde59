/* The reference: what a capture's own data give with so many rays that little noise is left, and how much that is. */
#ifndef GLINT_REFERENCE_H
#define GLINT_REFERENCE_H

#include "glint/study.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Rays go to two halves, A and B, that share no random number: A draws from the rays 0, 1, … of its pixels, B from those
   after GLINT_REFERENCE_SECOND. They grow together, by rounds of GLINT_REFERENCE_BATCH rays each, and the result is their
   mean. As both are independent and of one size, (A - B)/2 has the variance of (A + B)/2 whatever the rays' distribution, so
   its root mean square is the standard error that is reported. */
enum {
    GLINT_REFERENCE_BATCH = 8,
    GLINT_REFERENCE_ROUND = 2 * GLINT_REFERENCE_BATCH,
    GLINT_REFERENCE_SECOND = 1 << 20,
    GLINT_REFERENCE_RAYS_MAX = 2 * GLINT_REFERENCE_SECOND
};

struct glint_reference_noise {
    uint64_t pixels;
    double mean;     /* of the reflection, all channels */
    double error;    /* standard error: root mean square of (A - B)/2 */
    double relative; /* error / mean; 0 where both are */
};
struct glint_reference_state {
    uint32_t rays;                                           /* a pixel, of both halves */
    uint32_t begun;                                          /* rays of the round under way, which are in no figure */
    double seconds;                                          /* spent on them, in all calls */
    struct glint_reference_noise noise[GLINT_SURFACE_COUNT]; /* [0]: all surfaces */
};

struct glint_reference;
struct glint_reference_options {
    const char *folder;  /* a run folder in which it is kept and from which it goes on, or NULL: memory alone */
    bool overwrite;      /* removes what the folder holds, instead of going on or failing */
    bool all;            /* no pass is dropped for having nothing to do */
    uint64_t keep_bytes; /* as of glint_replay_options, for a replay that others use too */
    /* Rays that are run in one piece, which an interruption loses; 0: one on a software device, else GLINT_REFERENCE_BATCH, of
       large pictures fewer. Their means are rounded, so that it decides the last bits. */
    uint32_t at_once;
};
/* `pipeline`, as glint_study_reference() makes it, is copied; its rays are not asked for. The replay, which has `capture`
   loaded, stays the caller's and must outlive the reference; other runs of it may come between calls here. A folder that
   holds another capture's reference, or one of other settings, another device or other shaders, is an error that names the
   difference. */
struct glint_reference *glint_reference_create(struct glint_replay *replay, struct glint_capture *capture,
                                               const struct glint_pipeline *pipeline,
                                               const struct glint_reference_options *options, struct glint_error *err);
void glint_reference_destroy(struct glint_reference **reference);

/* Traces until a pixel has `rays` rays, rounded up to whole rounds, or all surfaces' relative noise is at most `noise` (0:
   never). The folder holds a complete reference of fewer rays all the while, from the first round on, and beside it, in
   unfinished.exr, the rays of the round under way: both are renewed every few seconds, at the end and when the call is
   interrupted. There is no folder before there is something to go on from. However often it was, the images have the same bits as of one call on the same device.
   Fails when the reflection is NaN or infinite anywhere, or when nothing reflects. */
bool glint_reference_trace(struct glint_reference *reference, uint32_t rays, double noise, glint_progress progress,
                           void *user, struct glint_error *err);
/* Valid until the next trace. */
const struct glint_reference_state *glint_reference_state(const struct glint_reference *reference);
/* R G B A; *error, unless NULL, receives each pixel's standard error relative to its value, by both halves: a rough estimate
   for one pixel, unbiased in sums of (error · value)². Both are malloc'd. */
bool glint_reference_pixels(const struct glint_reference *reference, struct glint_pixels *pixels, float **error,
                            struct glint_error *err);
/* The object "reference" of run.json, malloc'd text: rays, seconds, noise [{surfaces, pixels, mean, error, relative}], sensitivity
   {rays, rows [{slot, parameter, value, tried, ran, reason, change [{surfaces, mean, rmse, noise, relative}]}]} once it was
   asked for, settings in a folder. NULL when memory is short. */
char *glint_reference_json(const struct glint_reference *reference);
/* The second of them from a run folder; NULL when the run declares none, as one of `glint replay`. */
bool glint_study_run_error(struct glint_run *run, float **error, struct glint_error *err);

/* What a reference is off the truth by where neither has noise: what the capture's data cannot say. errors->of[].clean_*
   lack what both declare, and truth_noise is both together. Errors are relative, NULL for none. */
bool glint_study_missing(const struct glint_pixels *reference, const float *reference_error,
                         const struct glint_pixels *truth, const float *truth_error, const uint8_t *surfaces,
                         struct glint_image_errors *errors, struct glint_error *err);

/* How far the reference moves when a parameter that one of its passes declares as ASSUMED is halved or doubled. Both draw
   the same random numbers, so that they differ by little else. */
struct glint_reference_change {
    double mean;     /* of the change, all channels */
    double rmse;     /* between both references, without noise: root of the mean product of the halves' changes */
    double noise;    /* standard error of what they differ by, which rmse lacks */
    double relative; /* rmse / mean of the reference */
};
struct glint_reference_assumption {
    const struct glint_pass *pass;
    const struct glint_row *row; /* the parameter */
    double value, tried;
    bool ran;
    char reason[128]; /* why not */
    struct glint_reference_change of[GLINT_SURFACE_COUNT];
};
enum { GLINT_ASSUMPTIONS_MAX = 32 };
struct glint_reference_sensitivity {
    uint32_t rays; /* a pixel, of each reference that is compared */
    struct glint_reference_assumption rows[GLINT_ASSUMPTIONS_MAX];
    size_t count;
};
/* Traces every change and the reference itself anew, with as many rays as asked for, rounded up to whole rounds. A folder
   keeps what was found, once the reference has rays. */
bool glint_reference_sensitivity(struct glint_reference *reference, uint32_t rays, glint_progress progress, void *user,
                                 struct glint_reference_sensitivity *sensitivity, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
