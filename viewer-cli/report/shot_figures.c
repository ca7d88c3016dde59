/* Error and flicker of a shot's frames: what is read, measured and drawn. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/pipeline_args.h"
#include "report/shot.h"

/* ---- Reading ---- */

void shot_pixels_finish(struct shot_pixels *p) {
    glint_pixels_finish(&p->found);
    glint_pixels_finish(&p->truth);
    free(p->error);
    free(p->mask);
    *p = (struct shot_pixels){.error = NULL};
}

/* A pipeline with the value of the parameter by which the effect's truth is chosen, which is all that this needs. */
static struct glint_pipeline *pipeline_of(const struct glint_effect *effect, const json_t *run,
                                          struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia3", err);
    const char *name;
    const struct glint_pass *pass = effect->truth_has_choices ? glint_pass_with_role(effect->truth_by, &name) : NULL;
    if (!pass) return pipeline;
    const json_t *parameters = json_object_get(report_pass(run, pass->slot), "parameters");
    const char *choice = report_text(parameters, name);
    char text[256];
    snprintf(text, sizeof text, "%.100s.%.50s=%.50s", pass->slot, name, choice);
    if (pipeline && *choice && !glint_pipeline_set(pipeline, text, err)) glint_pipeline_destroy(&pipeline);
    return pipeline;
}

static bool has_fog(const json_t *run, const struct glint_capture *capture) {
    size_t i;
    json_t *pass;
    bool fog = false;
    json_array_foreach(json_object_get(run, "passes"), i, pass) fog |=
        report_ran(pass) && json_is_true(json_object_get(json_object_get(pass, "parameters"), "fog"));
    return fog && glint_capture_frame(capture)->has_fog;
}

/* The capture of a run, if it is still what was replayed. */
static struct glint_capture *open_capture(const json_t *run, struct glint_error *err) {
    const json_t *record = json_object_get(run, "capture");
    const char *path = report_text(record, "path"), *made_of = report_text(record, "xxh3_128");
    char hash[33];
    struct glint_capture *capture = glint_capture_open(path, NULL, err);
    if (!capture || (glint_capture_hash(capture, hash, err) && !strcmp(hash, made_of))) return capture;
    glint_capture_close(&capture);
    glint_fail(err, GLINT_ERROR_FORMAT, "%s: is not the file that was replayed", path);
    return NULL;
}

static bool read_truth(const struct glint_effect *effect, struct shot_frame *frame, struct shot_pixels *p,
                       struct glint_error *err) {
    struct glint_capture *capture = open_capture(frame->run, err);
    struct glint_pipeline *pipeline = capture ? pipeline_of(effect, frame->run, err) : NULL;
    bool ok = pipeline && glint_study_truth(capture, effect, pipeline, &p->truth, &p->error, err) &&
              (p->mask = glint_study_labels(capture, effect, err)) != NULL;
    if (ok && (p->truth.width != p->found.width || p->truth.height != p->found.height))
        ok =
            glint_fail(err, GLINT_ERROR_FORMAT, "%s: the truth is %u x %u, the %s %u x %u", glint_capture_path(capture),
                       p->truth.width, p->truth.height, effect->noun, p->found.width, p->found.height);
    if (ok) frame->fogged = has_fog(frame->run, capture);
    else {
        glint_pixels_finish(&p->truth);
        free(p->error);
        p->error = NULL;
    }
    glint_pipeline_destroy(&pipeline);
    glint_capture_close(&capture);
    return ok;
}

bool shot_read(struct shot_report *shot, size_t frame, struct shot_pixels *p, struct glint_error *err) {
    struct glint_run *run = glint_run_open(shot->frames[frame].folder, err);
    struct glint_error missing = {0};
    if (!run) return false;
    const bool found = glint_study_run_result(run, shot->effect, &p->found, &missing);
    glint_run_close(&run);
    if (!(found && read_truth(shot->effect, &shot->frames[frame], p, &missing)) && !shot->no_truth[0])
        snprintf(shot->no_truth, sizeof shot->no_truth, "%.200s: %.800s", shot->frames[frame].name, missing.message);
    return missing.code != GLINT_ERROR_MEMORY || glint_fail(err, missing.code, "%s", missing.message);
}

/* ---- Measuring ---- */

static bool measure_error(const struct glint_effect *effect, struct shot_frame *frame, const struct shot_pixels *p,
                          struct glint_error *err) {
    const char *channels;
    glint_effect_channels(effect, &channels);
    const struct glint_metric_options options = {.metrics = 1u << GLINT_METRIC_RMSE | 1u << GLINT_METRIC_CLEAN_RMSE |
                                                            1u << GLINT_METRIC_SYMMETRIC,
                                                 .found_channels = channels,
                                                 .truth_channels = channels,
                                                 .mask = p->mask,
                                                 .truth_error = p->error};
    struct glint_metric_table table = {0};
    const bool ok = glint_metrics_compare(&p->found, &p->truth, &options, &table, err);
    if (ok) {
        frame->rmse = table.rows[0].of[GLINT_METRIC_RMSE].value;
        frame->clean_rmse = table.rows[0].of[GLINT_METRIC_CLEAN_RMSE].value;
        frame->symmetric = table.rows[0].of[GLINT_METRIC_SYMMETRIC].value;
    }
    glint_metric_table_finish(&table);
    return ok;
}

bool shot_measure(const struct shot_report *shot, struct shot_frame *frame, const struct shot_pixels *before,
                  const struct shot_pixels *now, struct glint_error *err) {
    frame->rmse = frame->clean_rmse = frame->symmetric = (double)NAN;
    if (now->truth.values && !measure_error(shot->effect, frame, now, err)) return false;
    if (!before || !before->found.values || !now->found.values) return true;
    if (before->found.width != now->found.width || before->found.height != now->found.height) return true;
    const bool both = before->truth.values && now->truth.values;
    const struct glint_pixels found[2] = {before->found, now->found}, truth[2] = {before->truth, now->truth};
    const float *const errors[2] = {before->error, now->error};
    const uint8_t *const masks[2] = {before->mask, now->mask};
    frame->has_change = true;
    return glint_study_flicker(found, both ? truth : NULL, errors, masks, &frame->flicker, err);
}

static double figure_of(const struct shot_frame *frame, int figure) {
    if (figure == SHOT_BY_ERROR) return frame->clean_rmse;
    return frame->has_change ? frame->flicker.clean : (double)NAN;
}

void shot_find_worst(struct shot_report *shot) {
    for (int figure = 0; figure < SHOT_FIGURES; figure++) {
        shot->worst[figure] = shot->count;
        for (size_t i = 0; i < shot->count; i++) {
            const size_t worst = shot->worst[figure];
            const double value = figure_of(&shot->frames[i], figure);
            if (isfinite(value) && (worst == shot->count || value > figure_of(&shot->frames[worst], figure)))
                shot->worst[figure] = i;
        }
    }
}

/* ---- Charts ---- */

json_t *shot_frame_name(const struct shot_frame *frame) {
    return json_sprintf("frame %lld", frame->number);
}

/* Figures of a frame; NAN where a frame has none. */
struct column {
    const char *name;
    double (*of)(const struct shot_frame *frame);
};
static double of_error(const struct shot_frame *f) {
    return f->clean_rmse;
}
static double of_rmse(const struct shot_frame *f) {
    return f->rmse;
}
static double of_symmetric(const struct shot_frame *f) {
    return f->symmetric;
}
static double of_flicker(const struct shot_frame *f) {
    return f->has_change ? f->flicker.clean : (double)NAN;
}
static double of_beside(const struct shot_frame *f) {
    return f->has_change ? f->flicker.beside : (double)NAN;
}
static double of_picture(const struct shot_frame *f) {
    return f->has_change ? f->flicker.picture : (double)NAN;
}
static double of_truth(const struct shot_frame *f) {
    return f->has_change ? f->flicker.truth : (double)NAN;
}
static const struct column columns[] = {{"error", of_error},
                                        {"error with the truth's noise", of_rmse},
                                        {"symmetric error", of_symmetric},
                                        {"flicker", of_flicker},
                                        {"flicker with the truth's noise", of_beside},
                                        {"change of the picture", of_picture},
                                        {"change of the truth", of_truth}};
enum {
    ERROR_COLUMN,
    RMSE_COLUMN,
    SYMMETRIC_COLUMN,
    FLICKER_COLUMN,
    BESIDE_COLUMN,
    PICTURE_COLUMN,
    TRUTH_COLUMN,
    COLUMNS
};

static json_t *series_of(const struct shot_report *shot, const struct column *column, bool muted) {
    json_t *points = json_array();
    for (size_t i = 0; i < shot->count; i++) {
        const struct shot_frame *frame = &shot->frames[i];
        const double y = column->of(frame);
        if (!isfinite(y)) continue;
        json_t *point =
            json_pack("{s:I, s:f, s:o}", "x", (json_int_t)frame->number, "y", y, "name", shot_frame_name(frame));
        if (json_array_size(shot->tracks[SHOT_FINAL]))
            json_object_set_new(point, "pictures", json_pack("[O]", json_array_get(shot->tracks[SHOT_FINAL], i)));
        json_array_append_new(points, point);
    }
    return json_pack("{s:s, s:s, s:b, s:o}", "name", column->name, "kind", "line", "muted", muted, "points", points);
}

/* The first of the columns decides about the worst frame, which is marked. */
static void add_chart(const struct shot_report *shot, json_t *blocks, const char *title, size_t worst,
                      const int *shown) {
    enum { MOST_TICKS = 12 };
    json_t *series = json_array(), *marks = json_array(), *ticks = json_array();
    for (int k = 0; shown[k] < COLUMNS; k++)
        json_array_append_new(series, series_of(shot, &columns[shown[k]], shown[k] == RMSE_COLUMN));
    if (worst < shot->count) {
        const struct shot_frame *frame = &shot->frames[worst];
        json_array_append_new(marks, json_pack("{s:I, s:f, s:o}", "x", (json_int_t)frame->number, "y",
                                               columns[shown[0]].of(frame), "label",
                                               json_sprintf("worst: %lld", frame->number)));
    }
    for (size_t i = 0; i < shot->count; i += (shot->count + MOST_TICKS - 1) / MOST_TICKS)
        json_array_append_new(ticks, json_integer(shot->frames[i].number));
    page_chart(blocks, json_pack("{s:s, s:{s:s, s:o}, s:{s:s, s:s, s:i}, s:o, s:o}", "title", title, "x", "name",
                                 "frame", "ticks", ticks, "y", "name", "root mean square", "unit", "radiance", "min", 0,
                                 "series", series, "marks", marks));
}

static void add_table(const struct shot_report *shot, json_t *blocks, bool with_truth) {
    json_t *table = page_table(blocks);
    page_column(table, "frame", "");
    page_column(table, "run", "");
    for (int k = 0; k < COLUMNS; k++)
        if (with_truth || k == PICTURE_COLUMN)
            page_column(table, columns[k].name, k == SYMMETRIC_COLUMN ? "0 to 1" : "radiance");
    page_column(table, "", "");
    for (size_t i = 0; i < shot->count; i++) {
        json_t *row = json_pack("[I, s]", (json_int_t)shot->frames[i].number, shot->frames[i].name);
        for (int k = 0; k < COLUMNS; k++)
            if (with_truth || k == PICTURE_COLUMN)
                json_array_append_new(row, json_number(columns[k].of(&shot->frames[i])));
        const bool error = shot->worst[SHOT_BY_ERROR] == i, flicker = shot->worst[SHOT_BY_FLICKER] == i;
        json_array_append_new(row, json_sprintf("%s%s%s", error ? "largest error" : "", error && flicker ? ", " : "",
                                                flicker ? "largest flicker" : ""));
        page_row(table, row);
    }
}

void shot_charts(const struct shot_report *shot) {
    static const int errors[] = {ERROR_COLUMN, RMSE_COLUMN, COLUMNS},
                     flicker[] = {FLICKER_COLUMN, PICTURE_COLUMN, TRUTH_COLUMN, COLUMNS},
                     change[] = {PICTURE_COLUMN, COLUMNS};
    json_t *blocks = page_section(shot->document, "Error and flicker");
    const bool with_truth = shot->worst[SHOT_BY_ERROR] < shot->count;
    bool fogged = false;
    for (size_t i = 0; i < shot->count; i++) fogged |= shot->frames[i].fogged;
    if (shot->no_truth[0]) {
        char text[1200];
        snprintf(text, sizeof text, "Not all frames have a truth to compare with: %s", shot->no_truth);
        page_text(blocks, "note", text);
    }
    if (fogged)
        page_text(blocks, "note",
                  "The runs have fog, the truth has none. glint replay --against truth leaves fog out.");
    char text[600];
    snprintf(text, sizeof text,
             with_truth ? "Of the %s, over the pixels where it is judged. Error: off the truth of the "
                          "frame. Flicker: the change of the picture since the frame before, less that of the truth, "
                          "so that errors that stay where they are do not count. The truth's own noise is taken off "
                          "both."
                        : "How much the %s changes from one frame to the next. Without a truth, nothing says how much "
                          "of that is right.",
             shot->effect->noun);
    page_text(blocks, "text", text);
    if (with_truth) {
        add_chart(shot, blocks, "Error of each frame", shot->worst[SHOT_BY_ERROR], errors);
        add_chart(shot, blocks, "Flicker: change since the frame before", shot->worst[SHOT_BY_FLICKER], flicker);
    } else add_chart(shot, blocks, "Change since the frame before", shot->count, change);
    add_table(shot, blocks, with_truth);
}
