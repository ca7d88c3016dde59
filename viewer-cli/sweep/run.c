/* Evaluates and times every point, unless the results are in the log already. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "draw/view/pixels.h"
#include "journal/again.h"
#include "journal/drawing.h"
#include "options/capture_set.h"
#include "sweep/sweep.h"

/* State of the work on one capture. */
struct work {
    struct sweep *sweep;
    size_t capture;
    struct glint_judge *judge;
    struct again again;
    bool begun;         /* the capture is read, and what errors are measured against is there */
    size_t done, total; /* number of results in this call, over all captures */
    char label[64];
};

static bool report(void *user, const char *what, double done) {
    const struct work *work = user;
    (void)what;
    return progress_report(work->sweep->progress, work->label,
                           work->total ? ((double)work->done + done) / (double)work->total : 0);
}

/* "scene.exr, points" */
static void name_phase(const struct work *work, const char *phase) {
    progress_phase(work->sweep->progress, "%.24s, %s", base_name(work->sweep->captures.items[work->capture]), phase);
}

static void label(struct work *work, const char *what, size_t i) {
    snprintf(work->label, sizeof work->label, "%s %zu", what, i);
}

void sweep_picture_name(const char *what, size_t capture, size_t point, char name[96]) {
    snprintf(name, 96, "pictures/%s-%zu-%04zu.png", what, capture, point);
}
void sweep_change_name(size_t capture, size_t from, size_t to, char name[96]) {
    snprintf(name, 96, "pictures/change-%zu-%04zu-%04zu.png", capture, from, to);
}

/* Draws the composed image of the last evaluated point. */
static bool draw_point(const struct work *work, size_t point, struct glint_error *err) {
    char name[96];
    sweep_picture_name("picture", work->capture, point, name);
    return drawing_write_picture(work->judge, work->sweep->out, name, err);
}

static json_t *look_json(const struct sweep *sweep, const struct glint_verdict *v, double picture_seconds) {
    json_t *errors = json_object(), *executed = json_array();
    uint64_t invalid = 0;
    for (int k = 0; k < GLINT_TARGET_COUNT; k++) {
        if (!v->errors[k].count) continue;
        json_object_set_new(errors, glint_target_name((enum glint_target)k),
                            errors_json(&v->errors[k], sweep->metrics));
        invalid += v->errors[k].invalid_found + v->errors[k].invalid_truth;
    }
    for (size_t i = 0; i < v->pass_count; i++)
        if (v->passes[i].executed) json_array_append_new(executed, json_string(v->passes[i].pass->slot));
    return json_pack("{s:o, s:I, s:I, s:f, s:f, s:f, s:f, s:o, s:f, s:f, s:f}", "errors", errors, "invalid",
                     (json_int_t)invalid, "rays", (json_int_t)v->ends.rays, "steps", v->ends.steps, "fetches",
                     v->ends.fetches, "steps_px", v->steps_px, "fetches_px", v->fetches_px, "executed", executed,
                     "run_seconds", v->run_seconds, "metric_seconds", v->metric_seconds, "picture_seconds",
                     picture_seconds);
}

static bool place_line(const struct work *work, size_t point, json_t *line, struct glint_error *err) {
    if (!line) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    json_object_set_new(line, "capture", json_integer((json_int_t)work->capture));
    json_object_set_new(line, "point", json_integer((json_int_t)point));
    return journal_append(&work->sweep->journal, line, err);
}

/* Whether a failure ends the sweep; other failures are recorded in the point's row. */
static bool fail_point(const struct work *work, size_t point, const struct glint_error *own, struct glint_error *err) {
    if (own->code == GLINT_ERROR_INTERRUPTED || own->code == GLINT_ERROR_MEMORY || own->code == GLINT_ERROR_IO ||
        glint_device_lost(work->sweep->device))
        return glint_fail(err, own->code, "%s", own->message);
    return place_line(work, point, json_pack("{s:s}", "failed", own->message), err);
}

static double now_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool measure_point(struct work *work, size_t point, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_space_pipeline(work->sweep->space, point, err);
    struct glint_verdict verdict = {0};
    struct glint_error own = {0};
    const bool draws =
        work->sweep->pictures && !sweep_is_large(work->sweep); /* of many, the worst are drawn at the end */
    if (!pipeline) return false;
    label(work, "point", point + 1);
    double start = 0;
    bool ok;
    work->again.tried = false;
    do {
        glint_verdict_finish(&verdict);
        ok = glint_judge_evaluate(work->judge, pipeline, 0, &verdict, report, work, &own);
        start = now_seconds();
        ok = ok && (!draws || draw_point(work, point, &own));
    } while (!ok && again_try(&work->again, &own, "point %zu", point + 1));
    if (ok) missing_add(&work->sweep->missing, glint_judge_replay(work->judge));
    if (ok && work->sweep->against.truth && verdict.no_truth.code != GLINT_OK) /* the truth is missing for all points */
        ok = glint_fail(err, verdict.no_truth.code, "%s", verdict.no_truth.message);
    else if (ok) ok = place_line(work, point, look_json(work->sweep, &verdict, now_seconds() - start), err);
    else ok = fail_point(work, point, &own, err);
    glint_verdict_finish(&verdict);
    glint_pipeline_destroy(&pipeline);
    work->done++;
    return ok;
}

static bool time_point(struct work *work, size_t point, uint32_t round, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_space_pipeline(work->sweep->space, point, err);
    struct glint_cost cost;
    if (!pipeline) return false;
    label(work, "times, round", round + 1);
    bool ok;
    work->again.tried = false;
    do ok = glint_judge_time(work->judge, pipeline, 0, work->sweep->whole, &cost, report, work, err);
    while (!ok && again_try(&work->again, err, "point %zu, round %u", point + 1, round + 1));
    if (ok) {
        ok = place_line(work, point, cost_json(&cost, round), err);
        glint_cost_finish(&cost);
    }
    glint_pipeline_destroy(&pipeline);
    work->done++;
    return ok;
}

static size_t missing_of(const struct sweep *sweep, size_t capture, size_t point) {
    const enum sweep_state state = sweep_row(sweep, capture, point)->state;
    size_t missing = state == SWEEP_MISSING;
    if (!sweep_works_on(sweep, capture, point) || state >= SWEEP_FAILED) return 0;
    for (uint32_t r = 0; r < sweep->rounds; r++) missing += !sweep_rounds(sweep, capture, point)[r].known;
    return missing;
}

static size_t count_missing(const struct sweep *sweep, size_t capture) {
    size_t missing = 0;
    for (size_t p = 0; p < sweep->points; p++) missing += missing_of(sweep, capture, p);
    return missing;
}

/* Makes the reference before the points, because it can take longer than they do. */
static bool find_answer(struct work *work, struct glint_error *err) {
    struct sweep *sweep = work->sweep;
    const float *error;
    const enum glint_target answer = answer_args_kind(&sweep->against);
    struct glint_pipeline *pipeline = glint_space_pipeline(sweep->space, 0, err);
    if (answer == GLINT_TARGET_REFERENCE) name_phase(work, "reference");
    bool ok;
    work->again.tried = false;
    do
        ok = pipeline &&
             glint_judge_target(work->judge, answer, pipeline, &error, progress_report, sweep->progress, err);
    while (!ok && again_try(&work->again, err, "%s", glint_target_name(answer)));
    if (pipeline) glint_pipeline_destroy(&pipeline);
    name_phase(work, "points");
    return ok;
}

/* Times points in the order A B C A B C …, so that slow changes, such as of the device's clock, affect all equally. */
static bool take_turns(struct work *work, struct glint_error *err) {
    struct sweep *sweep = work->sweep;
    for (size_t p = 0; p < sweep->points; p++)
        if (sweep_works_on(sweep, work->capture, p) && sweep_row(sweep, work->capture, p)->state == SWEEP_MISSING &&
            !measure_point(work, p, err))
            return false;
    for (uint32_t round = 0; round < sweep->rounds; round++) {
        glint_judge_next_round(work->judge);
        for (size_t p = 0; p < sweep->points; p++) {
            const bool known = sweep_rounds(sweep, work->capture, p)[round].known,
                       failed = sweep_row(sweep, work->capture, p)->state >= SWEEP_FAILED;
            if (sweep_works_on(sweep, work->capture, p) && !known && !failed && !time_point(work, p, round, err))
                return false;
        }
    }
    return true;
}

typedef bool (*task)(struct work *work, struct glint_error *err);

static bool on_capture(struct work *work, size_t c, task task, struct glint_error *err) {
    struct sweep *sweep = work->sweep;
    struct glint_judge_options options = answer_args_judge(&sweep->against, sweep->out, c);
    options.truth = true;
    options.all = sweep->all;
    options.metrics = sweep->metrics;
    struct glint_capture *capture = glint_capture_open(sweep->captures.items[c], NULL, err);
    work->capture = c;
    work->again = (struct again){&cmd_sweep, sweep->device, &work->judge, 1, 0, false};
    bool ok = capture && capture_set_check_open(&sweep->captures, c, capture, err) &&
              (work->judge = glint_judge_create(sweep->device, &options, err)) &&
              glint_judge_load(work->judge, capture, err) && find_answer(work, err);
    work->begun = ok;
    ok = ok && task(work, err);
    if (work->judge) glint_judge_destroy(&work->judge);
    if (capture) glint_capture_close(&capture);
    return ok;
}

static bool sweep_capture(struct work *work, size_t c, struct glint_error *err) {
    struct sweep *sweep = work->sweep;
    struct glint_error own = {0};
    work->begun = false;
    if (on_capture(work, c, take_turns, &own)) return true;
    bool ok = sweep->captures.count > 1 && !work->begun && capture_set_fails_alone(&sweep->captures, c, &own);
    if (!ok) *err = own;
    for (size_t p = 0; ok && p < sweep->points; p++)
        if (sweep_works_on(sweep, c, p))
            ok = place_line(work, p, json_pack("{s:s, s:b}", "failed", own.message, "broken", true), err);
    return ok;
}

bool sweep_run(struct sweep *sweep, struct glint_error *err) {
    struct work work = {.sweep = sweep};
    char path[4096];
    for (size_t c = 0; c < sweep->captures.count; c++) work.total += count_missing(sweep, c);
    if (!sweep_path(sweep, "pictures", path, err) || !glint_make_folder(path, err)) return false;
    for (size_t c = 0; c < sweep->captures.count; c++)
        if (count_missing(sweep, c) && !sweep_capture(&work, c, err)) return false;
    return true;
}

static bool on_front(const struct sweep *sweep, size_t point) {
    for (size_t f = 0; f < sweep->front_count; f++)
        if (sweep->fronts[f].on[point]) return true;
    return false;
}

/* Computes the results of all points on fronts; those of other points stay empty. */
static bool draw_changes(const struct work *work, const struct glint_pixels *results, struct glint_error *err) {
    const struct sweep *sweep = work->sweep;
    for (size_t f = 0; f < sweep->front_count; f++)
        for (size_t i = 0; i + 1 < sweep->fronts[f].count; i++) {
            const size_t from = sweep->fronts[f].points[i], to = sweep->fronts[f].points[i + 1];
            struct glint_pixels change = {0};
            char name[96], title[96];
            sweep_change_name(work->capture, from, to, name);
            snprintf(title, sizeof title, "difference between %zu and %zu", from, to);
            const bool ok =
                pixels_difference(&results[from], &results[to], NULL, glint_judge_labels(work->judge), &change, err) &&
                drawing_write(sweep->out, name, &change, title, err);
            glint_pixels_finish(&change);
            if (!ok) return false;
        }
    return true;
}

/* The error of a point, and of many captures also what it shows. */
static bool draw_error(struct work *work, size_t p, struct glint_verdict *verdict, struct glint_error *err) {
    struct sweep *sweep = work->sweep;
    struct glint_pipeline *pipeline = glint_space_pipeline(sweep->space, p, err);
    char name[96];
    label(work, "picture", p + 1);
    sweep_picture_name("error", work->capture, p, name);
    bool ok;
    work->again.tried = false;
    do ok = pipeline && glint_judge_evaluate(work->judge, pipeline, 0, verdict, report, work, err);
    while (!ok && again_try(&work->again, err, "picture of point %zu", p + 1));
    ok = ok && (!sweep_is_large(sweep) || draw_point(work, p, err)) &&
         drawing_write_error(work->judge, answer_args_kind(&sweep->against), pipeline, &verdict->result, sweep->out,
                             name, "error", err);
    if (pipeline) glint_pipeline_destroy(&pipeline);
    work->done++;
    return ok;
}

static bool draw_errors(struct work *work, struct glint_pixels *results, struct glint_error *err) {
    bool ok = true;
    for (size_t p = 0; ok && p < work->sweep->points; p++) {
        struct glint_verdict verdict = {0};
        if (!on_front(work->sweep, p)) continue;
        ok = draw_error(work, p, &verdict, err);
        results[p] = verdict.result;
        verdict.result = (struct glint_pixels){0};
        glint_verdict_finish(&verdict);
    }
    return ok;
}

static bool draw_front(struct work *work, struct glint_error *err) {
    const size_t points = work->sweep->points;
    struct glint_pixels *results = calloc(points + 1, sizeof *results);
    name_phase(work, "pictures");
    const bool ok = (results || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) &&
                    draw_errors(work, results, err) && draw_changes(work, results, err);
    for (size_t p = 0; results && p < points; p++) glint_pixels_finish(&results[p]);
    free(results);
    return ok;
}

bool sweep_draw_fronts(struct sweep *sweep, struct glint_error *err) {
    struct work work = {.sweep = sweep};
    const struct sweep_overall *o = &sweep->overall;
    for (size_t p = 0; p < sweep->points; p++) work.total += on_front(sweep, p) * o->shown_count;
    for (size_t i = 0; i < o->shown_count && work.total && sweep->pictures; i++)
        if (!on_capture(&work, o->shown[i], draw_front, err)) return false;
    return true;
}
