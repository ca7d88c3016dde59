/* Evaluates coalitions and times some of them, unless the results are in the log already. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blame/blame.h"
#include "journal/again.h"
#include "journal/drawing.h"
#include "options/capture_set.h"

/* State of the work on one capture, which is opened when something is to be measured. */
struct work {
    struct blame *blame;
    size_t capture;
    struct glint_judge *judge;
    struct again again;
    struct glint_capture *open, **before; /* blame->before.count of them */
    bool loaded;                          /* the capture is */
    bool begun;                           /* what errors are measured against is there, too */
    uint32_t coalition;                   /* that is evaluated */
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

/* "point": the line's place among those of the capture, by which shards are merged; "phase": times come after the errors of all captures. */
static bool place_line(const struct work *work, uint32_t coalition, size_t point, bool time, json_t *line,
                       struct glint_error *err) {
    if (!line) return fail_memory(err);
    if (time) json_object_set_new(line, "phase", json_integer(1));
    json_object_set_new(line, "capture", json_integer((json_int_t)work->capture));
    json_object_set_new(line, "coalition", json_integer((json_int_t)coalition));
    json_object_set_new(line, "point", json_integer((json_int_t)point));
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
    for (int k = 0; ok && k < GLINT_TARGET_COUNT; k++)
        ok = !verdict.errors[k].count ||
             glint_metrics_valid(&verdict.errors[k], glint_target_name((enum glint_target)k), &own);
    if (ok) ok = place_line(work, coalition, work->done, false, look_json(work->blame, &verdict), err);
    else if (own.code == GLINT_ERROR_INTERRUPTED || glint_device_lost(work->again.device)) *err = own; /* names it */
    else glint_fail(err, own.code, "%s: %s", name_step(work, coalition).text, own.message);
    glint_verdict_finish(&verdict);
    glint_pipeline_destroy(&pipeline);
    return ok;
}

/* Makes the reference before the coalitions, because it can take longer than they do; a capture without the truth fails here. */
static bool find_answer(struct work *work, struct glint_error *err) {
    const enum glint_target answer = answer_args_kind(&work->blame->against);
    const float *error;
    bool ok;
    if (answer == GLINT_TARGET_REFERENCE) name_phase(work, "reference");
    work->again.tried = false;
    do
        ok = glint_judge_target(work->judge, answer, work->blame->base, &error, progress_report, work->blame->progress,
                                err) != NULL;
    while (!ok && again_try(&work->again, err, "%s", glint_target_name(answer)));
    return ok;
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

/* ---- The capture ---- */

static bool load(struct work *work, struct glint_error *err) {
    struct blame *blame = work->blame;
    struct glint_judge_options options = answer_args_judge(&blame->against, blame->out, work->capture);
    if (work->loaded) return true;
    options.truth = true;
    options.all = blame->all;
    options.metrics = blame->metrics;
    work->again = (struct again){&cmd_blame, blame->device, &work->judge, 1, 0, false};
    work->loaded = (work->open = glint_capture_open(blame->captures.items[work->capture], NULL, err)) &&
                   capture_set_check_open(&blame->captures, work->capture, work->open, err) && open_shot(work, err) &&
                   (work->judge = glint_judge_create(blame->device, &options, err)) &&
                   glint_judge_load(work->judge, work->open, err);
    return work->loaded;
}

static bool begin(struct work *work, struct glint_error *err) {
    if (work->begun) return true;
    work->begun = load(work, err) && find_answer(work, err);
    name_phase(work, "pipelines");
    return work->begun;
}

static void close_work(struct work *work) {
    if (work->judge) glint_judge_destroy(&work->judge);
    for (size_t i = 0; work->before && i < work->blame->before.count; i++)
        if (work->before[i]) glint_capture_close(&work->before[i]);
    free(work->before);
    if (work->open) glint_capture_close(&work->open);
}

/* Whether a failure is that of one of several captures, which then has no results. */
static bool fails_alone(const struct work *work, const struct glint_error *own) {
    const struct blame *blame = work->blame;
    if (blame->captures.count == 1) return false;
    if (!work->begun) return capture_set_fails_alone(&blame->captures, work->capture, own);
    return own->code != GLINT_ERROR_INTERRUPTED && own->code != GLINT_ERROR_MEMORY && own->code != GLINT_ERROR_IO &&
           !glint_device_lost(blame->device);
}

/* Of a capture that is divided between shards, that with the first coalition says that it cannot be read. */
static bool place_failure(const struct work *work, const struct glint_error *own, struct glint_error *err) {
    const uint32_t coalition = work->begun ? work->coalition : 0;
    work->blame->of[work->capture].failed = true;
    return !blame_works_on(work->blame, work->capture, coalition) ||
           place_line(work, coalition, work->begun ? work->done : 0, false, json_pack("{s:s}", "failed", own->message),
                      err);
}

static bool measure(struct blame *blame, size_t c, bool (*task)(struct work *work, struct glint_error *err),
                    struct glint_error *err) {
    struct work work = {.blame = blame, .capture = c};
    struct glint_error own = {0};
    bool ok = blame->of[c].failed || task(&work, &own);
    if (!ok && fails_alone(&work, &own)) ok = place_failure(&work, &own, err);
    else if (!ok) *err = own;
    close_work(&work);
    return ok;
}

/* ---- Errors ---- */

static bool look_up(const struct work *work, int64_t at, double *values, struct glint_error *err) {
    json_t *line = journal_read(&work->blame->journal, at, err);
    if (!line) return false;
    blame_values(work->blame, line, values);
    json_decref(line);
    return true;
}

/* Evaluates a coalition that is not in the journal yet. */
static bool look(struct work *work, uint32_t coalition, struct glint_error *err) {
    work->coalition = coalition;
    if (blame_found(work->blame, work->capture, coalition) >= 0) return true;
    snprintf(work->label, sizeof work->label, "%zu of %zu", work->done + 1, work->total);
    return begin(work, err) && replay_coalition(work, coalition, err);
}

static bool play(void *user, uint32_t coalition, double *values, struct glint_error *err) {
    struct work *work = user;
    if (!look(work, coalition, err)) return false;
    work->done++;
    return look_up(work, blame_found(work->blame, work->capture, coalition), values, err);
}

static bool tell_progress(void *user, struct glint_error *err) {
    struct work *work = user;
    return blame_publish(work->blame, false, err);
}

static bool find_shares(struct work *work, struct glint_error *err) {
    struct blame *blame = work->blame;
    const struct glint_game game = {
        .players = blame->count, .values = BLAME_VALUES, .play = play, .update = tell_progress, .user = work};
    struct glint_shapley *shapley = &blame->of[work->capture].sum.shapley;
    work->total = blame_looks(blame);
    const bool ok = glint_shapley(&game, &blame->options, shapley, err);
    if (ok) blame_forget_looks(&blame->of[work->capture]);
    return ok;
}

/* A shard's coalitions of a capture, in the order of one process. */
static bool find_part(struct work *work, struct glint_error *err) {
    struct blame *blame = work->blame;
    uint32_t *order = malloc((sizeof *order) << blame->count);
    work->total = (size_t)1 << blame->count;
    if (!order) return fail_memory(err);
    glint_shapley_order(blame->count, order);
    bool ok = true;
    for (work->done = 0; ok && work->done < work->total; work->done++)
        ok = !blame_works_on(blame, work->capture, order[work->done]) || look(work, order[work->done], err);
    free(order);
    return ok;
}

bool blame_find_shares(struct blame *blame, struct glint_error *err) {
    const bool part = blame->shard.count && blame->divided;
    for (size_t c = 0; c < blame->captures.count; c++) {
        if (!part && !blame_works_on(blame, c, 0)) continue;
        if (!measure(blame, c, part ? find_part : find_shares, err)) return false;
        blame_sum_times(blame, c);
    }
    return true;
}

/* ---- Times ---- */

static bool time_one(struct work *work, size_t at, uint32_t round, struct glint_error *err) {
    const uint32_t coalition = work->blame->timed[at];
    struct glint_pipeline *pipeline = glint_players_pipeline(work->blame->players, coalition, err);
    struct glint_cost cost;
    bool ok;
    work->again.tried = false;
    do
        ok = pipeline && run_before(work, pipeline, err) &&
             glint_judge_time(work->judge, pipeline, 0, work->blame->shot, &cost, report, work, err);
    while (!ok && again_try(&work->again, err, "%s, round %u", name_step(work, coalition).text, round + 1));
    if (ok) {
        ok = place_line(work, coalition, at, true, cost_json(&cost, round), err);
        glint_cost_finish(&cost);
    }
    if (pipeline) glint_pipeline_destroy(&pipeline);
    return ok;
}

/* Times pipelines in the order A B C A B C …, so that slow changes, such as of the device's clock, affect all equally. */
static bool take_turns(struct work *work, struct glint_error *err) {
    struct blame *blame = work->blame;
    struct blame_round *rounds = blame_rounds(blame, work->capture);
    if (!rounds) return fail_memory(err);
    work->total = blame->timed_count * blame->rounds;
    for (uint32_t round = 0; round < blame->rounds; round++) {
        if (work->judge) glint_judge_next_round(work->judge);
        snprintf(work->label, sizeof work->label, "round %u of %u", round + 1, blame->rounds);
        for (size_t i = 0; i < blame->timed_count; i++, work->done++) {
            if (rounds[round * blame->timed_count + i].known || !blame_works_on(blame, work->capture, blame->timed[i]))
                continue;
            if (!work->loaded) name_phase(work, "times");
            if (!load(work, err) || !time_one(work, i, round, err)) return false;
        }
        blame_sum_times(blame, work->capture);
        if (!blame_publish(blame, false, err)) return false;
    }
    return true;
}

bool blame_find_times(struct blame *blame, struct glint_error *err) {
    for (size_t c = 0; c < blame->captures.count && blame->rounds; c++)
        if (!measure(blame, c, take_turns, err)) return false;
    return true;
}

/* ---- Pictures ---- */

void blame_picture_name(const char *what, size_t capture, char name[64]) {
    snprintf(name, 64, "pictures/%s-%zu.png", what, capture);
}

static bool draw_coalition(struct work *work, uint32_t coalition, const char *what, const char *title,
                           struct glint_error *err) {
    const struct blame *blame = work->blame;
    struct glint_pipeline *pipeline = glint_players_pipeline(blame->players, coalition, err);
    struct glint_verdict verdict = {0};
    char error[64], picture[64];
    blame_picture_name(what, work->capture, error);
    blame_picture_name("picture", work->capture, picture);
    bool ok;
    work->again.tried = false;
    do
        ok = pipeline && run_before(work, pipeline, err) &&
             glint_judge_evaluate(work->judge, pipeline, 0, &verdict, report, work, err) &&
             (coalition || drawing_write_picture(work->judge, blame->out, picture, err)) &&
             drawing_write_error(work->judge, answer_args_kind(&blame->against), pipeline, &verdict.result, blame->out,
                                 error, title, err);
    while (!ok && again_try(&work->again, err, "%s, picture", name_step(work, coalition).text));
    glint_verdict_finish(&verdict);
    if (pipeline) glint_pipeline_destroy(&pipeline);
    work->done++;
    return ok;
}

static bool draw(struct work *work, struct glint_error *err) {
    const struct blame *blame = work->blame;
    const size_t largest = blame_largest(blame, &blame->of[work->capture].sum, blame_value(0, 0));
    char title[200];
    snprintf(title, sizeof title, "error, %.100s ideal", glint_player_name(blame->players, largest));
    work->total = 2;
    if (!begin(work, err)) return false;
    name_phase(work, "pictures");
    return draw_coalition(work, 0, "error", "error", err) && draw_coalition(work, 1u << largest, "ideal", title, err);
}

bool blame_draw(struct blame *blame, struct glint_error *err) {
    char path[4096];
    if (!blame->out) return true;
    bool ok = journal_path(blame->out, "pictures", path, err) && glint_make_folder(path, err);
    for (size_t i = 0; ok && i < blame->overall.shown_count; i++) {
        struct work work = {.blame = blame, .capture = blame->overall.shown[i]};
        ok = draw(&work, err);
        close_work(&work);
    }
    blame->drawn = ok;
    return ok;
}
