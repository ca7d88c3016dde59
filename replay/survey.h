/* The survey of a G-buffer that is already in memory, and the facts that NEEDS rows ask for. */
#ifndef GLINT_REPLAY_SURVEY_H
#define GLINT_REPLAY_SURVEY_H

#include "glint/replay.h"

/* Channels of one part, decoded to interleaved floats. */
struct channels {
    const struct glint_part_info *part;
    const char **names; /* point into rows and literals */
    size_t count;
    float *data; /* NULL before they are read */
};
bool channels_add(struct channels *channels, const char *name, size_t length, struct glint_error *err);
/* Adds the channels of a capture row ("R G B -"). */
bool channels_add_row(struct channels *channels, const struct glint_row *row, struct glint_error *err);
/* The channel's place; count when it is not among them. */
size_t channels_find(const struct channels *channels, const char *name, size_t length);
bool channels_read(struct channels *channels, struct glint_capture *capture, struct glint_error *err);
void channels_finish(struct channels *channels);
/* enlarge.c. A cube map at another size: between its texels colours are interpolated, and distances where they are of one
   surface. */
bool channels_enlarge(struct channels *channels, uint32_t face, struct glint_error *err);
bool channels_add_survey(struct channels *channels, struct glint_error *err);

/* Whether a fact is known without a look at any pixel; whether it is about what cube maps show. */
bool fact_is_of_parts(const char *fact);
bool fact_is_of_cubemaps(const char *fact);

/* survey_device.c. The pass that counts. */
const struct glint_pass *survey_pass(void);
/* Runs passes of the survey, and reads what they make, one after the other; the caller frees it. */
struct pipeline_pass;
uint32_t *survey_run(struct glint_replay *replay, struct pipeline_pass *passes, size_t count,
                     const char *const *outputs, const struct glint_replay_options *wanted, struct glint_time *time,
                     struct glint_error *err);
/* The figures that plans go by; `whole`: those that only a device counts and all that it counts as the host does. */
bool survey_on_device(struct glint_replay *replay, const struct glint_replay_options *wanted, bool whole,
                      struct glint_error *err);

/* survey_cubemaps.c: looks at the active cube maps when a pass of the graph asks what they show; the graph has then to be made
   anew. `before`: how many the survey knows of from the last graph. */
struct graph;
bool survey_cubemaps(struct glint_replay *replay, const struct glint_pipeline *pipeline, const struct graph *graph,
                     const struct glint_replay_options *options, uint32_t before, struct glint_error *err);

/* Over channels that hold at least the survey's. */
void survey_channels(const struct channels *channels, struct glint_survey *survey);
void survey_capture_parts(const struct glint_capture *capture, struct glint_survey *survey);
/* facts.c. Whether a fact holds, as NEEDS rows name it, "rough 0.1" with the value of its parameter; *known is false when
   there is no such fact. shows_all: every surface's reflection is shown, whatever its material. */
bool survey_fact(const struct glint_survey *survey, bool shows_all, const char *fact, char *reason, size_t size,
                 bool *known);

#endif
