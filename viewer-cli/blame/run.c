/* Evaluates coalitions and times some of them, unless the results are in the log already. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blame/blame.h"
#include "journal/again.h"

/* State of the work on one capture. */
struct work {
    struct blame *blame;
    size_t capture;
    struct glint_judge *judge;
    struct again again;
    struct glint_capture *open, **before; /* blame->before.count of them */
    size_t done, total;
    char label[64];
};

static bool report(void *user, const char *what, double done) {
    const struct work *work = user;
    (void)what;
    return progress_report(work->blame->progress, work->label,
                           ((double)work->done + done) / (double)(work->total ? work->total : 1));
}

/* "scene.exr, times" */
static void name_phase(const struct work *work, const char *phase) {
    progress_phase(work->blame->progress, "%.24s, %s", base_name(work->blame->captures.items[work->capture]), phase);
}

static bool place_line(const struct work *work, uint32_t coalition, json_t *line, struct glint_error *err) {
    if (!line) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    json_object_set_new(line, "capture", json_integer((json_int_t)work->capture));
    json_object_set_new(line, "coalition", json_integer((json_int_t)coalition));
    return journal_append(&work->blame->journal, line, err);
}

/* "CAPTURE: with screen_trace, resolve replaced by its reference" */
struct step {
    char text[1024];
};
static struct step name_step(const struct work *work, uint32_t coalition) {
    struct step step;
    char names[600] = "";
    for (size_t p = 0; p < work->blame->count; p++) {
        const size_t length = strlen(names);
        if (coalition >> p & 1)
            snprintf(names + length, sizeof names - length, "%s%s", length ? ", " : "",
                     glint_player_name(work->blame->players, p));
    }
    snprintf(step.text, sizeof step.text, "%.360s: with %s replaced by its reference",
             work->blame->captures.items[work->capture], names[0] ? names : "nothing");
    return step;
}

static json_t *look_json(const struct blame *blame, const struct glint_verdict *verdict) {
    json_t *errors = json_object();
    for (int k = 0; k < GLINT_TARGET_COUNT; k++)
        if (verdict->errors[k].count)
            json_object_set_new(errors, glint_target_name((enum glint_target)k),
                                errors_json(&verdict->errors[k], blame->metrics));
    return json_pack("{s:o, s:f, s:f, s:f}", "errors", errors, "fetches_px", verdict->fetches_px, "run_seconds",
                     verdict->run_seconds, "metric_seconds", verdict->metric_seconds);
}

/* Runs the earlier frames of a shot, so that the pipeline has its own history. */
static bool run_before(struct work *work, const struct glint_pipeline *pipeline, struct glint_error *err) {
    struct glint_replay *replay = glint_judge_replay(work->judge);
    const struct glint_replay_options options = {.results = glint_judge_effect(work->judge)->results,
                                                 .all = work->blame->all};
    const size_t count = work->blame->before.count;
    for (size_t i = 0; i < count; i++)
        if (!glint_replay_load(replay, work->before[i], err) ||
            !glint_replay_run(replay, pipeline, &options, report, work, err))
            return false;
    return !count || glint_replay_load(replay, work->open, err);
}

static bool replay_coalition(struct work *work, uint32_t coalition, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_players_pipeline(work->blame->players, coalition, err);
    struct glint_verdict verdict = {0};
    struct glint_error own = {0};
    if (!pipeline) return false;
    bool ok;
    work->again.tried = false;
    do
        ok = run_before(work, pipeline, &own) &&
             glint_judge_evaluate(work->judge, pipeline, 0, &verdict, report, work, &own);
    while (!ok && again_try(&work->again, &own, "%s", name_step(work, coalition).text));
    if (ok && work->blame->against.truth && verdict.no_truth.code != GLINT_OK)
        ok = glint_fail(&own, verdict.no_truth.code, "%s", verdict.no_truth.message);
    for (int k = 0; ok && k < GLINT_TARGET_COUNT; k++)
        ok = !verdict.errors[k].count ||
             glint_metrics_valid(&verdict.errors[k], glint_target_name((enum glint_target)k), &own);
    if (ok) ok = place_line(work, coalition, look_json(work->blame, &verdict), err);
    else if (own.code == GLINT_ERROR_INTERRUPTED || glint_device_lost(work->again.device)) *err = own; /* names it */
    else glint_fail(err, own.code, "%s: %s", name_step(work, coalition).text, own.message);
    glint_verdict_finish(&verdict);
    glint_pipeline_destroy(&pipeline);
    return ok;
}

static const json_t *found(const struct blame *blame, size_t capture, uint32_t coalition) {
    char key[64];
    blame_look_key(capture, coalition, key);
    return json_object_get(blame->lines, key);
}

static bool play(void *user, uint32_t coalition, double *values, struct glint_error *err) {
    struct work *work = user;
    if (!found(work->blame, work->capture, coalition)) {
        snprintf(work->label, sizeof work->label, "%zu of %zu", work->done + 1, work->total);
        if (!replay_coalition(work, coalition, err)) return false;
    }
    work->done++;
    blame_values(work->blame, found(work->blame, work->capture, coalition), values);
    return true;
}

static bool time_one(struct work *work, uint32_t coalition, uint32_t round, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_players_pipeline(work->blame->players, coalition, err);
    struct glint_cost cost;
    bool ok;
    work->again.tried = false;
    do
        ok = pipeline && run_before(work, pipeline, err) &&
             glint_judge_time(work->judge, pipeline, 0, work->blame->shot, &cost, report, work, err);
    while (!ok && again_try(&work->again, err, "%s, round %u", name_step(work, coalition).text, round + 1));
    if (ok) {
        ok = place_line(work, coalition, cost_json(&cost, round), err);
        glint_cost_finish(&cost);
    }
    if (pipeline) glint_pipeline_destroy(&pipeline);
    return ok;
}

/* Times pipelines in the order A B C A B C …, so that slow changes, such as of the device's clock, affect all equally. */
static bool take_turns(struct work *work, struct glint_error *err) {
    struct blame *blame = work->blame;
    uint32_t timed[2 * GLINT_PLAYERS_MAX + 2];
    const size_t count = blame_timed(blame, timed);
    work->done = 0;
    work->total = count * blame->rounds;
    name_phase(work, "times");
    for (uint32_t round = 0; round < blame->rounds; round++) {
        glint_judge_next_round(work->judge);
        snprintf(work->label, sizeof work->label, "round %u of %u", round + 1, blame->rounds);
        for (size_t i = 0; i < count; i++, work->done++) {
            char key[64];
            blame_time_key(work->capture, timed[i], round, key);
            if (!json_object_get(blame->lines, key) && !time_one(work, timed[i], round, err)) return false;
        }
        blame_sum_times(blame, work->capture);
        if (!blame_publish(blame, false, err)) return false;
    }
    return true;
}

/* Makes the reference before the coalitions, because it can take longer than they do. */
static bool find_answer(struct work *work, struct glint_error *err) {
    const float *error;
    name_phase(work, "reference");
    bool ok = work->blame->against.truth;
    work->again.tried = false;
    do
        ok = ok || glint_judge_target(work->judge, GLINT_TARGET_REFERENCE, work->blame->base, &error, progress_report,
                                      work->blame->progress, err);
    while (!ok && again_try(&work->again, err, "reference"));
    return ok;
}

static bool tell_progress(void *user, struct glint_error *err) {
    struct work *work = user;
    return blame_publish(work->blame, false, err);
}

static bool find_shares(struct work *work, struct glint_error *err) {
    struct blame *blame = work->blame;
    const struct glint_game game = {
        .players = blame->count, .values = BLAME_VALUES, .play = play, .update = tell_progress, .user = work};
    const size_t whole = (size_t)1 << blame->count,
                 drawn = 2 * blame->count + 2 + blame->options.permutations * blame->count;
    work->done = 0;
    work->total = blame->count <= blame->options.exact || drawn > whole ? whole : drawn;
    if (!find_answer(work, err)) return false;
    name_phase(work, "pipelines");
    return glint_shapley(&game, &blame->options, &blame->captured[work->capture].shapley, err);
}

/* Frames that are not consecutive, or that follow a cut, have no history. */
static bool open_shot(struct work *work, struct glint_error *err) {
    const struct list *before = &work->blame->before;
    const struct glint_capture *last = NULL;
    if (!(work->before = calloc(before->count + 1, sizeof *work->before)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i <= before->count; i++) {
        if (i < before->count && !(work->before[i] = glint_capture_open(before->items[i], NULL, err))) return false;
        const struct glint_capture *now = i < before->count ? work->before[i] : work->open;
        const struct glint_frame *frame = glint_capture_frame(now);
        const uint64_t number = last ? glint_capture_frame(last)->number + 1u : frame->number;
        if (frame->number != number || (last && frame->cut))
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected frame %llu of the shot, found %s%llu",
                              glint_capture_path(now), (unsigned long long)number, frame->cut ? "a cut at " : "",
                              (unsigned long long)frame->number);
        last = now;
    }
    return true;
}

static bool on_capture(struct blame *blame, size_t c, bool (*task)(struct work *work, struct glint_error *err),
                       struct glint_error *err) {
    struct work work = {.blame = blame, .capture = c};
    struct glint_judge_options options = answer_args_judge(&blame->against, blame->out, c);
    options.truth = true;
    options.all = blame->all;
    options.metrics = blame->metrics;
    work.again = (struct again){&cmd_blame, blame->device, &work.judge, 1, 0, false};
    const bool ok = (work.open = glint_capture_open(blame->captures.items[c], NULL, err)) && open_shot(&work, err) &&
                    (work.judge = glint_judge_create(blame->device, &options, err)) &&
                    glint_judge_load(work.judge, work.open, err) && task(&work, err);
    if (work.judge) glint_judge_destroy(&work.judge);
    for (size_t i = 0; work.before && i < blame->before.count; i++)
        if (work.before[i]) glint_capture_close(&work.before[i]);
    free(work.before);
    if (work.open) glint_capture_close(&work.open);
    return ok;
}

bool blame_find_shares(struct blame *blame, struct glint_error *err) {
    for (size_t c = 0; c < blame->captures.count; c++) {
        if (!on_capture(blame, c, find_shares, err)) return false;
        blame_sum_times(blame, c);
    }
    return true;
}

bool blame_find_times(struct blame *blame, struct glint_error *err) {
    for (size_t c = 0; c < blame->captures.count && blame->rounds; c++)
        if (!on_capture(blame, c, take_turns, err)) return false;
    return true;
}

static bool keep_blame_line(void *user, json_t *line) {
    struct blame *blame = user;
    const json_t *c = json_object_get(line, "capture"), *s = json_object_get(line, "coalition"),
                 *r = json_object_get(line, "round");
    char key[64];
    if (!json_is_integer(c) || !json_is_integer(s)) return false;
    const json_int_t capture = json_integer_value(c), coalition = json_integer_value(s), round = json_integer_value(r);
    if (capture < 0 || capture >= (json_int_t)blame->captures.count || coalition < 0 ||
        coalition >= (json_int_t)1 << blame->count)
        return false;
    if (r && (!json_is_integer(r) || round < 0 || round > UINT32_MAX)) return false;
    if (!r && !json_is_object(json_object_get(line, "errors"))) return false;
    if (r) blame_time_key((size_t)capture, (uint32_t)coalition, (uint32_t)round, key);
    else blame_look_key((size_t)capture, (uint32_t)coalition, key);
    return json_object_set(blame->lines, key, line) == 0;
}

/* Everything that results in the log depend on. The number of permutations does not belong to it, because permutations share coalitions. */
static json_t *define(const struct blame *blame, const struct list *shaders, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(blame->device);
    json_t *captures = captures_json(&blame->captures, false, err), *before = captures_json(&blame->before, false, err),
           *sources = captures && before ? shaders_json(shaders, err) : NULL, *players = json_array();
    for (size_t p = 0; p < blame->count; p++)
        json_array_append_new(players, json_string(glint_player_change(blame->players, p)));
    if (!sources) {
        json_decref(captures);
        json_decref(before);
        json_decref(players);
        return NULL;
    }
    json_t *json = json_pack("{s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:s, s:o, s:I, s:b, s:I, s:[ss]}", "format", 1,
                             "glint", GLINT_VERSION, "effect", blame->against.effect->name, "captures", captures,
                             "before", before, "pipeline", pipeline_json(blame->base), "shaders", sources, "players",
                             players, "reference", blame->against.truth ? "truth" : "computed", "reference_runs",
                             strings_json(blame->against.references.items), "reference_rays",
                             (json_int_t)blame->against.rays, "all", blame->all, "metrics", (json_int_t)blame->metrics,
                             "device", device->name, device->driver_version);
    if (!json) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    return json;
}

bool blame_open(struct blame *blame, const struct list *shaders, struct glint_error *err) {
    blame->lines = json_object();
    blame->captured = calloc(blame->captures.count + 1, sizeof *blame->captured);
    blame->journal = (struct journal){.folder = blame->out, .kind = "blame", .keep = keep_blame_line, .user = blame};
    if (!blame->lines || !blame->captured) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t c = 0; c < blame->captures.count; c++) blame_sum_times(blame, c); /* no time is known yet */
    return (blame->definition = define(blame, shaders, err)) && journal_open(&blame->journal, blame->definition, err);
}
