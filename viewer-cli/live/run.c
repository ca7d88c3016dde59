/* Checks and replays states: answers /api/v1/pipeline and /api/v1/run. */
#include <stdlib.h>
#include <string.h>

#include "live/answers.h"
#include "options/args.h"
#include "options/pass_names.h"

/* {"state", "command", "slots"}; NULL on failure. */
static json_t *describe(const struct live *live, const struct state *state, struct glint_error *err) {
    json_t *slots = state_slots(state, err);
    char *command = slots ? state_command(live, state, "run") : NULL;
    json_t *json =
        command ? json_pack("{s:O, s:s, s:O}", "state", state->json, "command", command, "slots", slots) : NULL;
    if (slots && !json) fail_memory(err);
    json_decref(slots);
    free(command);
    return json;
}

void live_answer_pipeline(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct state state;
    struct glint_error err = {0};
    if (!answer_state(live, request, "state", &state, answer)) return;
    json_t *json = describe(live, &state, &err);
    answer_with(answer, json != NULL, json, &err);
    state_finish(&state);
}

/* ---- Results ---- */

/* The time of a pass when it last ran with what it depends on now, from its own program if that was ever used; NULL: it was never
   measured. */
static json_t *time_of(struct live *live, const struct glint_pass_result *result, bool *quick) {
    enum { TIMES_KEPT = 100000 };
    char own[24], generic[32];
    snprintf(own, sizeof own, "%016llx", (unsigned long long)result->key);
    snprintf(generic, sizeof generic, "%sq", own);
    if (result->time.n) {
        if (json_object_size(live->times) > TIMES_KEPT) json_object_clear(live->times);
        json_object_set_new(live->times, result->quick ? generic : own,
                            json_integer((json_int_t)result->time.median_ns));
    }
    json_t *ns = result->key ? json_object_get(live->times, own) : NULL;
    *quick = result->key && !ns && json_object_get(live->times, generic);
    return *quick ? json_object_get(live->times, generic) : ns;
}

static json_t *passes_json(struct live *live, json_int_t *frame_ns) {
    size_t count;
    json_t *list = json_array();
    const struct glint_pass_result *results = glint_replay_results(live->replay, &count);
    for (size_t i = 0; i < count; i++) {
        const struct glint_pass_result *r = &results[i];
        bool quick = false;
        json_t *ns = r->ran ? time_of(live, r, &quick) : NULL;
        if (ns && !r->cached_work) *frame_ns += json_integer_value(ns);
        json_array_append_new(list, json_pack("{s:s, s:s, s:b, s:b, s:b, s:b, s:s, s:O, s:b}", "slot", r->pass->slot,
                                              "variant", r->pass->variant, "ran", r->ran, "cached", r->cached,
                                              "cached_work", r->cached_work, "host", r->pass->host != NULL, "reason",
                                              r->reason, "ns", ns ? ns : json_null(), "quick", quick));
    }
    return list;
}

static json_t *channels_json(const struct glint_image *image) {
    const char *names = image->row->kind == GLINT_ROW_CAPTURE ? image->row->source : image->row->channels;
    json_t *list = json_array();
    for (const char *at = names ? names : ""; *at; at += strcspn(at, " "), at += strspn(at, " "))
        json_array_append_new(list, json_stringn(at, strcspn(at, " ")));
    return list;
}

static json_t *image_json(const struct glint_image *image) {
    const struct glint_pass *pass = image->pass;
    return json_pack("{s:s, s:s?, s:s?, s:I, s:I, s:o, s:s, s:s, s:I, s:I, s:b}", "name", image->name, "slot",
                     pass ? pass->slot : NULL, "variant", pass ? pass->variant : NULL, "width",
                     (json_int_t)image->width, "height", (json_int_t)image->height, "channels", channels_json(image),
                     "unit", image->row->unit, "meaning", image->row->help, "level", (json_int_t)image->level, "levels",
                     (json_int_t)image->levels, "cube", glint_row_is_cube(image->row));
}

/* In the order of the passes, those of the capture first. */
static json_t *images_json(const struct live *live) {
    json_t *list = json_array();
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(live->replay, &count);
    const size_t images = glint_replay_image_count(live->replay);
    for (size_t p = 0; p <= count; p++)
        for (size_t i = 0; i < images; i++) {
            const struct glint_image *image = glint_replay_image(live->replay, i);
            const struct glint_pass *pass = p ? results[p - 1].pass : NULL;
            if (image->pass == pass && image->components <= 4) json_array_append_new(list, image_json(image));
        }
    return list;
}

static json_t *warnings_json(const struct live *live) {
    json_t *list = json_array();
    const char *text;
    for (size_t i = 0; (text = glint_replay_warning(live->replay, i)); i++)
        json_array_append_new(list, json_string(text));
    return list;
}

/* The last picture that the run made, else its last image. */
static const char *picture_of(const struct live *live) {
    const struct glint_image *picture = glint_study_picture(live->replay);
    const size_t count = glint_replay_image_count(live->replay);
    if (picture) return picture->name;
    for (size_t i = count; i-- > 0;)
        if (glint_replay_image(live->replay, i)->pass) return glint_replay_image(live->replay, i)->name;
    return count ? glint_replay_image(live->replay, 0)->name : NULL;
}

/* Whether last bits of some image can differ from those of a run without `quick`. */
static bool is_quick(const struct live *live) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(live->replay, &count);
    for (size_t i = 0; i < count; i++)
        if (results[i].from_quick) return true;
    return false;
}

struct running {
    struct state state;
    bool draft, quick;
    json_t *result;
};

static bool work_run(struct live *live, void *user, struct glint_error *err) {
    struct running *running = user;
    const struct state *state = &running->state;
    const double start = glint_now_seconds();
    char id[RUN_ID];
    if (!live_replay(live, state, running->draft, running->quick, err)) return false;
    const double seconds = glint_now_seconds() - start;
    json_int_t frame_ns = 0;
    runs_note(live, state, running->draft, is_quick(live), id);
    if (!runs_keep_watched(live, state, id, err)) return false;
    const struct glint_part_info *gbuffer = glint_capture_find(live->capture, "gbuffer");
    json_t *passes = passes_json(live, &frame_ns), *result = describe(live, state, err);
    json_t *more = json_pack("{s:s, s:b, s:b, s:[II], s:f, s:o, s:I, s:o, s:s?, s:o}", "run", id, "draft",
                             running->draft, "quick", is_quick(live), "size", (json_int_t)gbuffer->width,
                             (json_int_t)gbuffer->height, "seconds", seconds, "passes", passes, "frame_ns", frame_ns,
                             "images", images_json(live), "picture", picture_of(live), "warnings", warnings_json(live));
    const bool ok = result && more && json_object_update(result, more) == 0;
    json_decref(more);
    if (ok) running->result = result;
    else json_decref(result), fail_memory(err);
    return ok;
}

void live_answer_run(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct glint_error err = {0};
    struct running running = {.draft = answer_flag(request, "draft"), .quick = answer_flag(request, "quick")};
    if (!answer_state(live, request, "state", &running.state, answer)) return;
    const unsigned flags = answer_flag(request, "urgent") ? JOB_URGENT : 0;
    const bool ok = live_do(live, flags, answer_text(request, "client"), work_run, &running, &err);
    answer_with(answer, ok, running.result, &err);
    state_finish(&running.state);
}
