/* What planning saves: the time of the passes as planned against the time of all passes over all pixels, measured in turns. */
#ifndef GLINT_SAVINGS_H
#define GLINT_SAVINGS_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Medians over the rounds of one pass as planned, and in the whole pipeline; 0: it did not run, or it is a host pass. */
struct glint_saving {
    uint64_t planned_ns, whole_ns;
};
/* Sums over the passes of a round. The survey counts as part of the planned time. */
struct glint_savings_time {
    struct glint_time planned, whole;
    double ratio[3]; /* quartiles over the rounds of planned / whole: lower, median, upper */
};
struct glint_savings {
    struct glint_saving *passes; /* in the order of the plan */
    size_t pass_count;
    uint32_t rounds;
    uint64_t
        survey_ns; /* median time of the survey of pixels and of that of cube maps, which is only needed when these change */
    struct glint_savings_time all,
        frame; /* of all passes; without those whose work is only needed when a cube map changes */
};
/* The replay must have a device and a loaded capture. Options about timing and memory are overridden. */
bool glint_study_savings(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                         const struct glint_replay_options *options, uint32_t rounds, struct glint_savings *savings,
                         glint_progress progress, void *user, struct glint_error *err);
void glint_savings_finish(struct glint_savings *savings);

#ifdef __cplusplus
}
#endif
#endif
