/* Evaluates and times every point, unless the results are in the log already. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "draw/view/pixels.h"
#include "draw/view/png_file.h"
#include "journal/again.h"
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

static bool draw_picture(const struct sweep *sweep, const char *name, const struct glint_pixels *pixels,
                         const char *title, struct glint_error *err) {
    char path[4096];
    struct picture picture = {0};
    const bool ok = sweep_path(sweep, name, path, err) && pixels_draw(&picture, pixels, title, NULL, err) &&
                    png_file_write(path, &picture, err);
    picture_finish(&picture);
    return ok;
}

/* Draws the composed image of the last evaluated point. */
static bool draw_point(const struct work *work, size_t point, struct glint_error *err) {
    char name[96];
    struct glint_replay *replay = glint_judge_replay(work->judge);
    const struct glint_image *image = glint_study_picture(replay);
    struct glint_pixels pixels = {0};
    if (!work->sweep->pictures || !image) return true;
    sweep_picture_name("picture", work->capture, point, name);
    const bool ok = pixels_read(replay, image, &pixels, err) && draw_picture(work->sweep, name, &pixels, "", err);
    glint_pixels_finish(&pixels);
    return ok;
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
    if (!pipeline) return false;
    label(work, "point", point + 1);
    double start = 0;
    bool ok;
    work->again.tried = false;
    do {
        glint_verdict_finish(&verdict);
        ok = glint_judge_evaluate(work->judge, pipeline, 0, &verdict, report, work, &own);
        start = now_seconds();
        ok = ok && draw_point(work, point, &own);
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

static bool failed(const struct sweep_row *row) {
    return row->look && json_object_get(row->look, "failed");
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

static size_t count_missing(const struct sweep *sweep) {
    size_t missing = 0;
    for (size_t i = sweep->begin; i < sweep->end; i++) {
        const struct sweep_row *row = &sweep->rows[i];
        missing += !row->look;
        for (uint32_t r = 0; r < sweep->rounds && !failed(row); r++) missing += !row->rounds[r];
    }
    return missing;
}

static bool misses(const struct sweep *sweep, size_t capture) {
    for (size_t p = 0; p < sweep->points; p++) {
        const struct sweep_row *row = sweep_row(sweep, capture, p);
        if (!sweep_works_on(sweep, capture, p)) continue;
        for (uint32_t r = 0; r < sweep->rounds && !failed(row); r++)
            if (!row->rounds[r]) return true;
        if (!row->look) return true;
    }
    return false;
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
        if (sweep_works_on(sweep, work->capture, p) && !sweep_row(sweep, work->capture, p)->look &&
            !measure_point(work, p, err))
            return false;
    for (uint32_t round = 0; round < sweep->rounds; round++) {
        glint_judge_next_round(work->judge);
        for (size_t p = 0; p < sweep->points; p++) {
            const struct sweep_row *row = sweep_row(sweep, work->capture, p);
            if (sweep_works_on(sweep, work->capture, p) && !row->rounds[round] && !failed(row) &&
                !time_point(work, p, round, err))
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
    struct work work = {.sweep = sweep, .total = count_missing(sweep)};
    char path[4096];
    if (!sweep_path(sweep, "pictures", path, err) || !glint_make_folder(path, err)) return false;
    for (size_t c = 0; c < sweep->captures.count; c++)
        if (misses(sweep, c) && !sweep_capture(&work, c, err)) return false;
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
                draw_picture(sweep, name, &change, title, err);
            glint_pixels_finish(&change);
            if (!ok) return false;
        }
    return true;
}

static bool draw_errors(struct work *work, struct glint_pixels *results, struct glint_error *err) {
    struct sweep *sweep = work->sweep;
    for (size_t p = 0; p < sweep->points; p++) {
        if (!on_front(sweep, p)) continue;
        struct glint_pipeline *pipeline = glint_space_pipeline(sweep->space, p, err);
        const enum glint_target kind = answer_args_kind(&sweep->against);
        struct glint_verdict verdict = {0};
        struct glint_pixels error = {0};
        const float *noise;
        const struct glint_pixels *answer;
        char name[96];
        label(work, "picture", p + 1);
        sweep_picture_name("error", work->capture, p, name);
        bool ok;
        work->again.tried = false;
        do ok = pipeline && glint_judge_evaluate(work->judge, pipeline, 0, &verdict, report, work, err);
        while (!ok && again_try(&work->again, err, "picture of point %zu", p + 1));
        ok = ok && (answer = glint_judge_target(work->judge, kind, pipeline, &noise, NULL, NULL, err)) &&
             pixels_difference(&verdict.result, answer, noise, glint_judge_labels(work->judge), &error, err) &&
             draw_picture(sweep, name, &error, "error", err);
        results[p] = verdict.result;
        verdict.result = (struct glint_pixels){0};
        glint_pixels_finish(&error);
        glint_verdict_finish(&verdict);
        if (pipeline) glint_pipeline_destroy(&pipeline);
        if (!ok) return false;
        work->done++;
    }
    return true;
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
    for (size_t p = 0; p < sweep->points; p++) work.total += on_front(sweep, p) * sweep->captures.count;
    for (size_t c = 0; c < sweep->captures.count && work.total && sweep->pictures; c++)
        if (!sweep_broken(sweep, c) && !on_capture(&work, c, draw_front, err)) return false;
    return true;
}
