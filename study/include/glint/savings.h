/* What a plan saves: the passes as planned and all of them, timed in turns. */
#ifndef GLINT_SAVINGS_H
#define GLINT_SAVINGS_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Medians over the rounds; 0: it did not run, or on the host. */
struct glint_saving {
    uint64_t planned_ns, whole_ns;
};
/* Of all passes of a round, and of what part of them every frame pays: without work on cube maps that is done when one
   changes. The survey counts as the plan's. */
struct glint_savings_time {
    struct glint_time planned, whole;
    double ratio[3]; /* planned / whole of each round: the lower quartile, the median, the upper quartile */
};
struct glint_savings {
    struct glint_saving *passes; /* in the order of the plan */
    size_t pass_count;
    uint32_t rounds;
    uint64_t survey_ns; /* of pixels, and of cube maps, which is made once for as long as they stay; medians */
    struct glint_savings_time all, frame;
};
/* The replay has a device, and a capture is loaded. Of the options, what concerns times and memory is set here. */
bool glint_study_savings(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                         const struct glint_replay_options *options, uint32_t rounds, struct glint_savings *savings,
                         glint_progress progress, void *user, struct glint_error *err);
void glint_savings_finish(struct glint_savings *savings);

#ifdef __cplusplus
}
#endif
#endif
