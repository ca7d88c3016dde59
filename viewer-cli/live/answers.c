/* The requests of glint live by their paths, and what their answers share. */
#include "live/answers.h"

#include <string.h>

/* clang-format off */
const struct http_route live_routes[] = {
    {"GET",  "/api/v1/registry",   live_answer_registry},
    {"GET",  "/api/v1/events",     live_listen},
    {"GET",  "/api/v1/picture",    live_answer_picture},
    {"GET",  "/api/v1/difference", live_answer_difference},
    {"POST", "/api/v1/pipeline",   live_answer_pipeline},
    {"POST", "/api/v1/run",        live_answer_run},
    {"POST", "/api/v1/values",     live_answer_values},
    {"POST", "/api/v1/answer",     live_answer_answer},
    {"POST", "/api/v1/figures",    live_answer_figures},
    {"POST", "/api/v1/probe",      live_answer_probe},
    {"POST", "/api/v1/preset",     live_answer_preset},
    {"POST", "/api/v1/report",     live_answer_report},
    {"POST", "/api/v1/write",      live_answer_write},
    {NULL, NULL, NULL},
};
/* clang-format on */

/* A member of another type is a mistake of the caller's, and would otherwise count as one that is missing. */
static bool check_types(const json_t *body, struct glint_error *err) {
    enum { FLAG, TEXT, TEXT_OR_NULL, LIST };
    static const char *const expected[] = {"true or false", "a text", "a text or null", "an array"};
    static const struct {
        const char *name;
        int type;
    } members[] = {{"draft", FLAG},  {"quick", FLAG}, {"urgent", FLAG}, {"reference", FLAG},       {"client", TEXT},
                   {"effect", TEXT}, {"name", TEXT},  {"of", TEXT},     {"against", TEXT_OR_NULL}, {"metrics", LIST}};
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        const json_t *json = json_object_get(body, members[i].name);
        const int type = members[i].type;
        const bool fits = type == FLAG   ? json_is_boolean(json)
                          : type == LIST ? json_is_array(json)
                                         : json_is_string(json) || (type == TEXT_OR_NULL && json_is_null(json));
        if (json && !fits)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected %s", members[i].name, expected[type]);
    }
    return true;
}

bool answer_state(struct live *live, const struct http_request *request, const char *name, struct state *state,
                  struct http_answer *answer) {
    struct glint_error err = {0};
    const bool typed = check_types(request->body, &err);
    const json_t *json = typed ? json_object_get(request->body, name) : NULL;
    const bool ok =
        json ? state_read(state, live, json, &err)
             : typed && glint_fail(&err, GLINT_ERROR_USAGE, "the body has no member \"%s\" with a state", name);
    if (ok) return true;
    if (json) state_finish(state);
    http_error(answer, &err);
    return false;
}

const char *answer_text(const struct http_request *request, const char *name) {
    return json_string_value(json_object_get(request->body, name));
}

bool answer_flag(const struct http_request *request, const char *name) {
    return json_is_true(json_object_get(request->body, name));
}

bool answer_number(const struct http_request *request, const char *name, json_int_t lowest, json_int_t highest,
                   json_int_t missing, json_int_t *number, struct glint_error *err) {
    const json_t *json = json_object_get(request->body, name);
    *number = json ? json_integer_value(json) : missing;
    return (!json || json_is_integer(json)) && *number >= lowest && *number <= highest
               ? true
               : glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a whole number from %lld to %lld", name,
                            (long long)lowest, (long long)highest);
}

void answer_json(struct http_answer *answer, json_t *json) {
    if (json) *answer = (struct http_answer){.json = json};
    else http_refuse(answer, 500, "memory", "out of memory");
}

void answer_with(struct http_answer *answer, bool ok, json_t *json, const struct glint_error *err) {
    if (ok) answer_json(answer, json);
    else {
        json_decref(json);
        http_error(answer, err);
    }
}
