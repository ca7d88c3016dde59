/* The declarations of passes and effects as JSON, as scripts and the live page read them. */
#ifndef GLINT_VIEWER_PASS_JSON_H
#define GLINT_VIEWER_PASS_JSON_H

#include <jansson.h>

#include "glint/declarations.h"

/* {"effect", "slot", "variant", "slot_title", "title", "source", "host", "needs", "called_by", "reads", "writes", "parameters", "reference"} */
json_t *pass_json(const struct glint_pass *pass);
/* {"effect", "title", "about", "results", "truth", "channels", "called_for_by", "term", "classes"} */
json_t *effect_json(const struct glint_effect *effect);

#endif
