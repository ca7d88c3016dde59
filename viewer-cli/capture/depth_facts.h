/* The resolution of the depth storage at several distances. */
#ifndef GLINT_VIEWER_DEPTH_FACTS_H
#define GLINT_VIEWER_DEPTH_FACTS_H

#include <jansson.h>

#include "glint/capture.h"

enum { DEPTH_PLACES = 3 };
struct depth_facts {
    const char *storage, *encoding;                  /* "D24", "device" */
    double at_m[DEPTH_PLACES], step_m[DEPTH_PLACES]; /* +inf: the next value is sky; NaN: no depth there */
};
/* For the depth of the G-buffer. */
struct depth_facts depth_facts(const struct glint_capture *capture);
/* "0.4 mm at 1 m, 4 cm at 10 m, not distinct from sky at 100 m" */
void depth_steps_text(const struct depth_facts *facts, char *text, size_t size);
/* {"storage", "encoding", "steps": [{"at_m", "step_m"}, …]}; step_m is null where the next value is sky or there is none. */
json_t *depth_facts_json(const struct depth_facts *facts);

#endif
