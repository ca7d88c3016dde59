/* The reference: an effect's converged result from a capture's own data, traced with many rays, and an estimate of its remaining noise. */
#ifndef GLINT_REFERENCE_H
#define GLINT_REFERENCE_H

#include "glint/study.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Rays are split into two halves A and B with different random numbers: A uses the ray indices from 0 on, B those from
   GLINT_REFERENCE_SECOND on. Rounds of GLINT_REFERENCE_BATCH rays for each half are traced, and the result is the mean of both halves.
   As these are independent and of one size, (A - B)/2 has the variance of (A + B)/2 for any distribution of the rays, and its root mean
   square is reported as the standard error. */
enum {
    GLINT_REFERENCE_BATCH = 8,
    GLINT_REFERENCE_ROUND = 2 * GLINT_REFERENCE_BATCH,
    GLINT_REFERENCE_SECOND = 1 << 20,
    GLINT_REFERENCE_RAYS_MAX = 2 * GLINT_REFERENCE_SECOND
};

struct glint_reference_noise {
    uint64_t pixels;
    double mean;     /* of the result, over all channels */
    double error;    /* standard error: root mean square of (A - B)/2 */
    double relative; /* error / mean; 0 if both are 0 */
};
struct glint_reference_state {
    uint32_t rays;  /* rays a pixel, of both halves together */
    uint32_t begun; /* rays of the unfinished round, which are in no figure yet */
    uint32_t kept;  /* rays that the folder holds, from which tracing resumes; an interrupted call tries to keep all */
    double seconds; /* time spent on all rays, in all calls */
    struct glint_reference_noise noise[GLINT_CLASS_COUNT]; /* [0]: all pixels */
};

struct glint_reference;
struct glint_reference_options {
    const struct glint_effect *effect; /* NULL: the first of glint_effects() */
    const char *folder; /* the run folder that stores the reference and from which tracing resumes; NULL: not stored */
    /* A cache folder (glint/cache.h), or NULL. A reference with a folder that was traced up to its last ray is also stored there, and one that another
       process stored there is taken over instead of being traced: it has the same bits. References with a limit of noise are traced. */
    const char *cache;
    bool overwrite;      /* removes what the folder holds, instead of resuming or failing */
    bool all;            /* as in struct glint_replay_options */
    uint64_t keep_bytes; /* as in struct glint_replay_options, for a replay that also runs other pipelines */
    /* Rays that are traced in one run, and lost if it is interrupted; 0: one on a software device, else GLINT_REFERENCE_BATCH, or fewer
       for large pictures. The mean of each run is rounded, so that this number affects the last bits of the result. */
    uint32_t at_once;
};
/* `pipeline` comes from glint_study_reference() and is copied; its number of rays is ignored. The caller keeps the replay, which must
   have `capture` loaded and outlive the reference; it may run other pipelines between the calls. Fails if the folder holds the reference
   of another capture, or one with other settings, device or shaders; the message names the difference. */
struct glint_reference *glint_reference_create(struct glint_replay *replay, struct glint_capture *capture,
                                               const struct glint_pipeline *pipeline,
                                               const struct glint_reference_options *options, struct glint_error *err);
void glint_reference_destroy(struct glint_reference **reference);

/* Traces with another replay from here on, of the same device, which was lost and opened again; it must have the same capture loaded. The rays so far are kept. */
void glint_reference_continue(struct glint_reference *reference, struct glint_replay *replay);
/* Traces until each pixel has `rays` rays, rounded up to whole rounds, or until the relative noise over all pixels is at most `noise`
   (0: no such limit). From the first round on the folder always holds a complete reference of the rays so far, and in unfinished.exr the
   rays of the unfinished round. Both are updated every few seconds, at the end and when the call is interrupted; the folder is created with
   the first of them. Interrupting and resuming changes no bit of the result on the same device. Fails if the result is NaN or
   infinite anywhere. */
bool glint_reference_trace(struct glint_reference *reference, uint32_t rays, double noise, glint_progress progress,
                           void *user, struct glint_error *err);
/* Valid until the next trace. */
const struct glint_reference_state *glint_reference_state(const struct glint_reference *reference);
/* The reference with all channels of the result. *error (may be NULL) receives the relative standard error of each pixel, estimated from both halves: rough
   for a single pixel, but unbiased in sums of (error · value)². Both are malloc'd. */
bool glint_reference_pixels(const struct glint_reference *reference, struct glint_pixels *pixels, float **error,
                            struct glint_error *err);
/* The object "reference" of run.json as malloc'd text: rays, seconds, noise [{surfaces, pixels, mean, error, relative}]; with a folder
   also settings; after glint_reference_sensitivity also sensitivity {rays, rows [{slot, parameter, value, tried, ran, reason,
   change [{surfaces, mean, rmse, noise, relative}]}]}. NULL if memory is exhausted. */
char *glint_reference_json(const struct glint_reference *reference);
/* The relative standard error of the result in a run folder, malloc'd. *error is NULL if the run is no reference of the effect. */
bool glint_study_run_error(struct glint_run *run, const struct glint_effect *effect, float **error,
                           struct glint_error *err);

/* The bias of a reference: its error against the truth without the noise of either, caused by what the capture's data do not contain.
   errors->of[].clean_* have the noise of both removed, and truth_noise is that of both. The error images are relative standard errors; NULL
   stands for none. */
bool glint_study_reference_bias(const struct glint_pixels *reference, const float *reference_error,
                                const struct glint_pixels *truth, const float *truth_error, const uint8_t *labels,
                                struct glint_image_errors *errors, struct glint_error *err);

/* How much the reference changes when a parameter that one of its passes declares as ASSUMED is halved or doubled. Both references use
   the same random numbers, so that little else differs. */
struct glint_reference_change {
    double mean;  /* mean change, over all channels */
    double rmse;  /* between both references, without noise: root of the mean product of the changes of both halves */
    double noise; /* standard error of the change, which rmse does not contain */
    double relative; /* rmse / mean of the reference */
};
struct glint_reference_assumption {
    const struct glint_pass *pass;
    const struct glint_row *row; /* the parameter */
    double value, tried;         /* its value in the reference, and the changed value */
    bool ran;
    char reason[128]; /* why it did not run */
    struct glint_reference_change of[GLINT_CLASS_COUNT];
};
enum { GLINT_ASSUMPTIONS_MAX = 32 };
struct glint_reference_sensitivity {
    uint32_t rays; /* rays a pixel of each compared reference */
    struct glint_reference_assumption rows[GLINT_ASSUMPTIONS_MAX];
    size_t count;
};
/* Traces the reference once more and with each change, with `rays` rays a pixel rounded up to whole rounds. If the reference has a
   folder and rays, the result is stored there, too. */
bool glint_reference_sensitivity(struct glint_reference *reference, uint32_t rays, glint_progress progress, void *user,
                                 struct glint_reference_sensitivity *sensitivity, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
