/* What the answers of glint live share: reading members of bodies and queries. */
#ifndef GLINT_VIEWER_LIVE_ANSWERS_H
#define GLINT_VIEWER_LIVE_ANSWERS_H

#include "live/live.h"

/* Reads the member `name` of the body as a state. On failure the answer is the error. */
bool answer_state(struct live *live, const struct http_request *request, const char *name, struct state *state,
                  struct http_answer *answer);
/* A text member of the body, or NULL. */
const char *answer_text(const struct http_request *request, const char *name);
bool answer_flag(const struct http_request *request, const char *name);
/* A whole number from `lowest` to `highest`; `missing` where there is none. */
bool answer_number(const struct http_request *request, const char *name, json_int_t lowest, json_int_t highest,
                   json_int_t missing, json_int_t *number, struct glint_error *err);
/* The answer is the JSON, or out of memory. Takes it over. */
void answer_json(struct http_answer *answer, json_t *json);
/* The answer is the JSON if `ok`, else the error. */
void answer_with(struct http_answer *answer, bool ok, json_t *json, const struct glint_error *err);

#endif
