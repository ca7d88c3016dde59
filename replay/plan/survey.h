/* The survey: figures of a frame's pixels, parts and active cube maps, and the facts that follow from them. */
#ifndef GLINT_REPLAY_SURVEY_H
#define GLINT_REPLAY_SURVEY_H

#include <jansson.h>

#include "channels.h"
#include "graph.h"

/* The survey of the active cube maps, which is valid as long as they do not change. */
struct cube_survey {
    uint64_t key; /* hash of their contents; 0: not surveyed yet */
    struct glint_survey_cubemap active[GLINT_SURVEY_CUBEMAPS];
    struct glint_time time;
};

struct survey_state {
    struct glint_survey figures;
    bool done;              /* the pixels of the loaded frame were counted */
    bool changed;           /* as a pass of the pipeline makes them in place of the capture's */
    struct glint_time time; /* n = 0: on the host */
    uint64_t traced_key;    /* hash of what figures.active_traced depends on */
    struct glint_time trace_time;
    struct cube_survey cubes; /* kept for later frames with the same cube maps */
};

bool channels_add_survey(struct channels *channels, struct glint_error *err);
/* `channels` must contain those of channels_add_survey. */
void survey_channels(const struct channels *channels, struct glint_survey *survey);
void survey_capture_parts(const struct glint_capture *capture, struct glint_survey *survey);

/* facts.c: what a fact depends on, and whether it holds, with the figure as the reason. `fact` has the name that NEEDS rows use, followed by the
   limit if there is one: "rough 0.1". shows_all: the reflection of every surface is visible, whatever its material. */
enum fact_about survey_fact_about(const char *fact);
bool survey_fact(const struct glint_survey *survey, bool shows_all, const char *fact, char *reason, size_t size);

/* survey_record.c: members of run.json. */
json_t *time_record(const struct glint_time *time);
json_t *survey_record(const struct survey_state *state, const struct glint_frame *frame);

#endif
