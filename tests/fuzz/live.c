/* Fuzzes the answers of glint live: the input's first byte chooses a request, and the rest is its body. No job is taken on, as after the
   end of the server, so that no device is needed. The canonical form of a state that was taken is taken, too, and is its own canonical form. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "live/live.h"
#include "options/pipeline_args.h"

static const char *const presets[] = {"mafia3", "kf2", "gtav", NULL};
static struct pipeline_args args;
static struct live_frame frames[] = {{.path = "a.exr", .number = 1, .width = 4, .height = 3},
                                     {.path = "-b.exr", .number = 2, .width = 4, .height = 3}};
static struct live live = {.args = &args,
                           .frames = frames,
                           .count = 2,
                           .presets = (const char **)(uintptr_t)presets,
                           .stopping = true,
                           .lock = PTHREAD_MUTEX_INITIALIZER,
                           .wake = PTHREAD_COND_INITIALIZER,
                           .changed = PTHREAD_COND_INITIALIZER,
                           .converting = PTHREAD_MUTEX_INITIALIZER};

static void check_answer(struct http_answer *answer) {
    fuzz_must(answer->json || answer->data || answer->next, "a request has an answer");
    json_decref(answer->json);
    free(answer->data);
    if (answer->close) answer->close(answer->stream);
}

static void check_canonical(const json_t *json) {
    struct state state, again;
    struct glint_error err = {0};
    if (fuzz_reason(state_read(&state, &live, json, &err), &err)) {
        fuzz_must(state_read(&again, &live, state.json, &err), err.message);
        fuzz_must(json_equal(state.json, again.json) && state.key == again.key,
                  "a canonical state is its own canonical form");
        state_finish(&again);
    }
    state_finish(&state);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    size_t posts = 0;
    const struct http_route *post[32];
    for (const struct http_route *route = live_routes; route->path && posts < 32; route++)
        if (!strcmp(route->method, "POST")) post[posts++] = route;
    if (!size) return 0;
    json_t *body = json_loadb((const char *)data + 1, size - 1, JSON_REJECT_DUPLICATES, NULL);
    if (json_is_object(body)) {
        const struct http_route *route = post[data[0] % posts];
        const struct http_request request = {.method = "POST", .path = route->path, .body = body};
        struct http_answer answer = {0};
        if (json_object_get(body, "state")) check_canonical(json_object_get(body, "state"));
        route->handler(&live, &request, &answer);
        check_answer(&answer);
    }
    json_decref(body);
    return 0;
}
