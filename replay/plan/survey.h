/* What a frame holds: figures of its pixels, its parts and its active cube maps, and the facts that follow. */
#ifndef GLINT_REPLAY_SURVEY_H
#define GLINT_REPLAY_SURVEY_H

#include <jansson.h>

#include "channels.h"
#include "graph.h"

/* What cube maps show, as long as they stay the same. */
struct cube_survey {
    uint64_t key; /* of what the cube maps hold; 0: there was none */
    struct glint_survey_cubemap active[GLINT_SURVEY_CUBEMAPS];
    struct glint_time time;
};

struct survey_state {
    struct glint_survey figures;
    bool done;              /* of the pixels of the frame that is loaded */
    struct glint_time time; /* n = 0: it was not the device that counted */
    uint64_t followed_key;  /* of what figures.followed was found from */
    struct glint_time followed_time;
    struct cube_survey cubes; /* the last one of cube maps, which later frames may share */
};

bool channels_add_survey(struct channels *channels, struct glint_error *err);
/* Over channels that hold at least the survey's. */
void survey_channels(const struct channels *channels, struct glint_survey *survey);
void survey_capture_parts(const struct glint_capture *capture, struct glint_survey *survey);

/* facts.c. What a fact is about, as NEEDS rows name it, "rough 0.1" with the value of its parameter; and whether it holds, with
   the figure. shows_all: every surface's reflection is shown, whatever its material. */
enum fact_about survey_fact_about(const char *fact);
bool survey_fact(const struct glint_survey *survey, bool shows_all, const char *fact, char *reason, size_t size);

/* survey_record.c: as run.json has it, and times. */
json_t *time_record(const struct glint_time *time);
json_t *survey_record(const struct survey_state *state, const struct glint_frame *frame);

#endif
