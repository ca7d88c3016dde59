/* Errors, ends of rays, fetches and times of a state, and what its result should be: answers /api/v1/figures and answer. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/sort.h"
#include "live/answers.h"
#include "options/args.h"

/* ---- The judge ---- */

void live_close_judge(struct live *live) {
    if (live->judge) glint_judge_destroy(&live->judge);
    glint_capture_close(&live->judged.capture);
    free(live->judged.folder);
    live->judged = (struct judged){0};
}

/* A folder for the references of one effect, in which later requests find them. */
static char *reference_folder(const struct live *live, const struct glint_effect *effect, struct glint_error *err) {
    char *folder = NULL;
    if (asprintf(&folder, "%s/reference-%s", live->temporary.path, effect->name) < 0) {
        fail_memory(err);
        return NULL;
    }
    if (glint_make_folder(folder, err)) return folder;
    free(folder);
    return NULL;
}

static bool open_judge(struct live *live, const struct judged *wanted, struct glint_error *err) {
    struct judged *now = &live->judged;
    const bool same = live->judge && now->effect == wanted->effect && now->metrics == wanted->metrics &&
                      now->reference == wanted->reference && now->truth == wanted->truth;
    if (same) return true;
    live_close_judge(live);
    *now = *wanted;
    now->capture = NULL;
    now->before = 0;
    if (!live_open_device(live, err) || !(now->folder = reference_folder(live, wanted->effect, err))) return false;
    const struct glint_judge_options options = {.effect = wanted->effect,
                                                .reference = wanted->reference,
                                                .truth = wanted->truth,
                                                .reference_run = live->reference,
                                                .reference_folder = now->folder,
                                                .metrics = wanted->metrics,
                                                .all = live->args->replay.all};
    return (live->judge = glint_judge_create(live->device, &options, err));
}

static const char *const *slots_or_null(const char **slots) {
    return slots[0] ? slots : NULL;
}

static bool load_frame(struct live *live, size_t frame, struct glint_error *err) {
    struct glint_capture *before = live->judged.capture;
    live->judged.capture = glint_capture_open(live->frames[frame].path, NULL, err);
    const bool ok = live->judged.capture && glint_judge_load(live->judge, live->judged.capture, err);
    if (!ok) {
        glint_judge_load(live->judge, NULL, NULL);
        glint_capture_close(&live->judged.capture);
    }
    glint_capture_close(&before);
    live->judged.frame = frame;
    return ok;
}

/* Loads the state's frame, with the history that the frames before it leave. */
static bool load_frames(struct live *live, const struct state *state, struct glint_error *err) {
    const size_t first = state_first_frame(live, state), last = state->capture;
    const bool there = live->judged.capture && live->judged.frame == last;
    glint_judge_override(live->judge, slots_or_null(state->skip), slots_or_null(state->force));
    if (there && (first == last || live->judged.before == state->key)) return true;
    live->judged.before = 0;
    for (size_t frame = first; frame <= last; frame++) {
        const struct glint_replay_options options = {.results = live->judged.effect->results,
                                                     .all = live->args->replay.all,
                                                     .skip = slots_or_null(state->skip),
                                                     .force = slots_or_null(state->force)};
        if (!load_frame(live, frame, err)) return false;
        if (frame < last &&
            !glint_replay_run(glint_judge_replay(live->judge), state->pipeline, &options, live_progress, live, err))
            return false;
    }
    live->judged.before = state->key;
    return true;
}

/* After anything but an interruption the judge begins again. */
static bool keep_judge(struct live *live, bool ok, const struct glint_error *err) {
    if (live->judge) glint_judge_override(live->judge, NULL, NULL);
    if (ok || err->code == GLINT_ERROR_USAGE) return ok;
    if (err->code == GLINT_ERROR_DEVICE || err->code == GLINT_ERROR_MEMORY) live_close(live);
    else if (err->code != GLINT_ERROR_INTERRUPTED) live_close_judge(live);
    else live->judged.before = 0;
    return ok;
}

static bool has_truth(struct live *live, const struct state *state, const struct glint_effect *effect) {
    char part[96];
    struct glint_capture *capture = glint_capture_open(live->frames[state->capture].path, NULL, NULL);
    glint_study_truth_part(effect, state->pipeline, part);
    const bool has = capture && !effect->no_truth && glint_capture_find(capture, part);
    glint_capture_close(&capture);
    return has;
}

static const struct glint_effect *read_effect(const struct http_request *request, struct glint_error *err) {
    const char *name = answer_text(request, "effect");
    const struct glint_effect *effect = name ? glint_effect_find(name) : NULL;
    if (!effect) glint_fail(err, GLINT_ERROR_USAGE, "there is no effect %.60s", name ? name : "in the body");
    return effect;
}

/* ---- Figures ---- */

enum { ROUNDS_MAX = 100 };
struct measuring {
    struct state state;
    const struct glint_effect *effect;
    uint32_t metrics, rounds;
    bool reference, truth;
    const char *why;
    json_t *result;
};

static json_t *errors_json(const struct glint_metric_table *table) {
    json_t *list = json_array();
    for (size_t i = 0; i < table->count; i++)
        for (size_t k = 0; k < GLINT_METRIC_COUNT; k++) {
            const struct glint_metric_row *row = &table->rows[i];
            if (isnan(row->of[k].value)) continue;
            json_array_append_new(list, json_pack("{s:s, s:s, s:I, s:s, s:o, s:o, s:o}", "set", row->set, "class",
                                                  row->name, "pixels", (json_int_t)row->pixels, "metric",
                                                  glint_metric(k)->name, "value", json_number(row->of[k].value), "low",
                                                  json_number(row->of[k].low), "high", json_number(row->of[k].high)));
        }
    return list;
}

static json_t *ends_json(const struct glint_ends *ends) {
    json_t *list = json_array();
    for (size_t i = 0; i < ends->count; i++) {
        const struct glint_end_row *row = &ends->rows[i];
        json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:I, s:f, s:o}", "tracer", row->tracer, "reason",
                                              row->reason, "text", row->text, "rays", (json_int_t)row->rays, "share",
                                              row->share, "error", json_number(row->error)));
    }
    return list;
}

/* Adds up the texels of diagnostic images whose unit is fetches, by the slot that writes them. */
static bool count_fetches(struct live *live, json_t *fetches, struct glint_error *err) {
    struct glint_replay *replay = glint_judge_replay(live->judge);
    for (size_t i = 0; i < glint_replay_image_count(replay); i++) {
        const struct glint_image *image = glint_replay_image(replay, i);
        if (!image->pass || image->row->kind != GLINT_ROW_DIAGNOSTIC || strcmp(image->row->unit, "fetches") != 0)
            continue;
        const size_t texels = (size_t)image->width * image->height;
        uint32_t *values = malloc((texels + 1) * sizeof *values);
        json_int_t sum = json_integer_value(json_object_get(fetches, image->pass->slot));
        if (!values) return fail_memory(err);
        const bool ok = glint_replay_read_image(replay, image, GLINT_U32, values, err);
        for (size_t t = 0; ok && t < texels; t++) sum += values[t];
        free(values);
        if (!ok) return false;
        json_object_set_new(fetches, image->pass->slot, json_integer(sum));
    }
    return true;
}

/* Times of passes by round, in the order of the first round. */
struct timing {
    struct glint_cost first;
    uint64_t *ns; /* rounds for each pass */
    uint64_t frame[ROUNDS_MAX], cubemaps[ROUNDS_MAX];
};

static bool time_rounds(struct live *live, const struct measuring *m, struct timing *timing, struct glint_error *err) {
    for (uint32_t r = 0; r < m->rounds; r++) {
        struct glint_cost cost;
        glint_judge_next_round(live->judge);
        if (!glint_judge_time(live->judge, m->state.pipeline, 0, true, &cost, live_progress, live, err)) return false;
        if (!timing->ns && !(timing->ns = calloc(m->rounds * (cost.pass_count + 1), sizeof *timing->ns))) {
            glint_cost_finish(&cost);
            return fail_memory(err);
        }
        timing->frame[r] = cost.frame_ns;
        timing->cubemaps[r] = cost.cubemaps_ns;
        if (r == 0) timing->first = cost;
        for (size_t p = 0; p < cost.pass_count && p < timing->first.pass_count; p++)
            timing->ns[p * m->rounds + r] = cost.passes[p].ns;
        if (r > 0) glint_cost_finish(&cost);
    }
    return true;
}

static json_t *passes_json(const struct glint_verdict *verdict, const json_t *fetches, struct timing *timing,
                           uint32_t rounds) {
    json_t *list = json_array();
    for (size_t i = 0; i < verdict->pass_count; i++) {
        const char *slot = verdict->passes[i].pass->slot;
        json_t *ns = json_null(), *count = json_object_get(fetches, slot);
        for (size_t p = 0; p < timing->first.pass_count; p++)
            if (timing->first.passes[p].pass == verdict->passes[i].pass)
                ns = json_integer((json_int_t)glint_time_statistics(timing->ns + p * rounds, rounds).median_ns);
        json_array_append_new(
            list, json_pack("{s:s, s:O, s:o}", "slot", slot, "fetches", count ? count : json_null(), "ns", ns));
    }
    return list;
}

static json_t *median_json(uint64_t *ns, uint32_t rounds) {
    return rounds ? json_integer((json_int_t)glint_time_statistics(ns, rounds).median_ns) : json_null();
}

static bool work_figures(struct live *live, void *user, struct glint_error *err) {
    struct measuring *m = user;
    struct glint_verdict verdict = {0};
    struct timing timing = {.ns = NULL};
    json_t *fetches = json_object();
    const struct judged wanted = {
        .effect = m->effect, .metrics = m->metrics, .reference = m->reference, .truth = m->truth};
    bool ok = fetches && open_judge(live, &wanted, err) && load_frames(live, &m->state, err) &&
              glint_judge_evaluate(live->judge, m->state.pipeline, 0, &verdict, live_progress, live, err) &&
              count_fetches(live, fetches, err) && time_rounds(live, m, &timing, err);
    if (ok) {
        const struct glint_ends *ends = &verdict.ends;
        const struct glint_metric_table *table =
            &verdict.errors[m->truth ? GLINT_TARGET_TRUTH : GLINT_TARGET_REFERENCE];
        m->result = json_pack(
            "{s:s, s:s?, s:s?, s:o, s:o, s:I, s:f, s:f, s:f, s:f, s:o, s:o, s:o}", "effect", m->effect->name, "against",
            m->truth       ? "truth"
            : m->reference ? "reference"
                           : NULL,
            "why", m->why, "errors", errors_json(table), "ends", ends_json(ends), "rays", (json_int_t)ends->rays,
            "steps", ends->steps, "fetches", ends->fetches, "steps_px", verdict.steps_px, "fetches_px",
            verdict.fetches_px, "passes", passes_json(&verdict, fetches, &timing, m->rounds), "frame_ns",
            median_json(timing.frame, m->rounds), "cubemaps_ns", median_json(timing.cubemaps, m->rounds));
        ok = m->result || fail_memory(err);
    }
    json_decref(fetches);
    free(timing.ns);
    glint_cost_finish(&timing.first);
    glint_verdict_finish(&verdict);
    return keep_judge(live, ok, err);
}

static bool read_metrics(const json_t *list, uint32_t *metrics, struct glint_error *err) {
    size_t i;
    json_t *name;
    *metrics = 0;
    json_array_foreach((json_t *)list, i, name) {
        uint32_t one = 0;
        if (!json_is_string(name)) return glint_fail(err, GLINT_ERROR_USAGE, "metrics: expected names of metrics");
        if (!glint_metrics_parse(json_string_value(name), &one, err)) return false;
        *metrics |= one;
    }
    return true;
}

/* What the state is compared with: nothing where there is no truth, or no state's result that could be compared. */
static bool read_measuring(struct live *live, const struct http_request *request, struct measuring *m,
                           struct glint_error *err) {
    const char *against = answer_text(request, "against");
    json_int_t rounds;
    if (!(m->effect = read_effect(request, err)) ||
        !read_metrics(json_object_get(request->body, "metrics"), &m->metrics, err) ||
        !answer_number(request, "rounds", 0, ROUNDS_MAX, 0, &rounds, err))
        return false;
    m->rounds = (uint32_t)rounds;
    m->truth = against && !strcmp(against, "truth");
    m->reference = against && !strcmp(against, "reference");
    if (against && !m->truth && !m->reference)
        return glint_fail(err, GLINT_ERROR_USAGE, "against: expected reference, truth or null, found \"%.40s\"",
                          against);
    if (m->effect->no_truth && against) m->why = m->effect->no_truth;
    else if (m->truth && !has_truth(live, &m->state, m->effect)) m->why = "the capture holds no truth of the effect";
    if (m->why) m->truth = m->reference = false;
    return true;
}

void live_answer_figures(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct glint_error err = {0};
    struct measuring m = {.rounds = 0};
    if (!answer_state(live, request, "state", &m.state, answer)) return;
    const bool ok = read_measuring(live, request, &m, &err) &&
                    live_do(live, 0, answer_text(request, "client"), work_figures, &m, &err);
    answer_with(answer, ok, m.result, &err);
    state_finish(&m.state);
}

/* ---- What the result should be ---- */

static void name_target(const struct measuring *m, char *name, size_t size) {
    snprintf(name, size, "%s of %s", m->truth ? "truth" : "reference", m->effect->name);
}

static bool keep_target(struct live *live, const struct measuring *m, const struct glint_pixels *pixels,
                        char id[RUN_ID], struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B", "A"};
    const size_t values = (size_t)pixels->width * pixels->height * pixels->components;
    const struct glint_row *made = glint_study_made(m->state.pipeline, m->effect);
    struct source source = {.width = pixels->width, .height = pixels->height, .components = pixels->components};
    if (source.components > 4)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "the %s has %u channels, but at most 4 can be shown",
                          m->effect->noun, source.components);
    name_target(m, source.title, sizeof source.title);
    snprintf(source.unit, sizeof source.unit, "%.60s", made ? made->unit : "1");
    for (uint32_t k = 0; k < source.components; k++)
        snprintf(source.channels[k], sizeof source.channels[k], "%s", names[k]);
    if (!(source.texels = malloc((values + 1) * sizeof(float)))) return fail_memory(err);
    memcpy(source.texels, pixels->values, values * sizeof(float));
    runs_keep_answer(live, &source, id);
    return true;
}

static json_t *target_json(const struct live *live, const struct measuring *m, const char *id,
                           const struct glint_pixels *pixels) {
    const struct glint_row *made = glint_study_made(m->state.pipeline, m->effect);
    char name[64];
    json_t *channels = json_array(), *compares = json_array();
    for (size_t k = 0; m->effect->results[k]; k++) json_array_append_new(compares, json_string(m->effect->results[k]));
    name_target(m, name, sizeof name);
    for (uint32_t k = 0; k < pixels->components; k++) json_array_append_new(channels, json_stringn(&"RGBA"[k], 1));
    const bool fogged =
        m->truth && glint_capture_frame(glint_judge_capture(live->judge))->has_fog && pipeline_fog(m->state.pipeline);
    json_t *image =
        json_pack("{s:s, s:n, s:n, s:I, s:I, s:o, s:s, s:s, s:i, s:i, s:b}", "name", name, "slot", "variant", "width",
                  (json_int_t)pixels->width, "height", (json_int_t)pixels->height, "channels", channels, "unit",
                  made ? made->unit : "1", "meaning", m->truth ? "what a path tracer found" : "the converged result",
                  "level", 0, "levels", 1, "cube", 0);
    return json_pack("{s:s, s:b, s:O, s:[II], s:[], s:[o], s:s, s:o, s:s?}", "run", id, "draft", 0, "state",
                     m->state.json, "size", (json_int_t)pixels->width, (json_int_t)pixels->height, "passes", "images",
                     image, "picture", name, "compares", compares, "note",
                     fogged ? "The truth has no fog, and this state applies fog." : NULL);
}

static bool work_answer(struct live *live, void *user, struct glint_error *err) {
    struct measuring *m = user;
    const struct judged wanted = {.effect = m->effect, .reference = m->reference, .truth = m->truth};
    const enum glint_target target = m->truth ? GLINT_TARGET_TRUTH : GLINT_TARGET_REFERENCE;
    const float *error;
    char id[RUN_ID];
    const struct glint_pixels *pixels =
        open_judge(live, &wanted, err) && load_frames(live, &m->state, err)
            ? glint_judge_target(live->judge, target, m->state.pipeline, &error, live_progress, live, err)
            : NULL;
    const bool ok = pixels && keep_target(live, m, pixels, id, err) &&
                    ((m->result = target_json(live, m, id, pixels)) || fail_memory(err));
    return keep_judge(live, ok, err);
}

void live_answer_answer(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct glint_error err = {0};
    struct measuring m = {.rounds = 0};
    const char *of = answer_text(request, "of");
    if (!answer_state(live, request, "state", &m.state, answer)) return;
    m.truth = of && !strcmp(of, "truth");
    m.reference = of && !strcmp(of, "reference");
    bool ok = m.truth || m.reference || glint_fail(&err, GLINT_ERROR_USAGE, "of: expected \"reference\" or \"truth\"");
    ok = ok && (m.effect = read_effect(request, &err));
    ok = ok && (!m.effect->no_truth || glint_fail(&err, GLINT_ERROR_USAGE, "%s", m.effect->no_truth));
    ok = ok && live_do(live, 0, answer_text(request, "client"), work_answer, &m, &err);
    answer_with(answer, ok, m.result, &err);
    state_finish(&m.state);
}
