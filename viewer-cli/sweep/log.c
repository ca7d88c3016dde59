/* The definition and results of a sweep on disk, from which an interrupted sweep resumes. */
#include "sweep/sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Everything that the results depend on. */
static json_t *define(const struct sweep *sweep, const char *const *axes, const char *sample,
                      const struct list *shaders, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(sweep->device);
    json_t *captures = captures_json(&sweep->captures, sweep->captures.count > 1, err),
           *sources = captures ? shaders_json(shaders, err) : NULL;
    if (!sources) {
        json_decref(captures);
        return NULL;
    }
    json_t *json = json_pack(
        "{s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:s, s:s, s:o, s:I, s:I, s:b, s:b, s:I, s:[ss]}", "format", 1, "glint",
        GLINT_VERSION, "effect", sweep->against.effect->name, "captures", captures, "pipeline",
        pipeline_json(sweep->base), "shaders", sources, "vary", strings_json(axes), "sample", sample, "reference",
        sweep->against.truth ? "truth" : "computed", "reference_runs", strings_json(sweep->against.references.items),
        "reference_rays", (json_int_t)sweep->against.rays, "repeat", (json_int_t)sweep->rounds, "whole", sweep->whole,
        "all", sweep->all, "metrics", (json_int_t)sweep->metrics, "device", device->name, device->driver_version);
    if (!json) fail_memory(err);
    return json;
}

static void keep_look(struct sweep *sweep, struct sweep_row *row, const json_t *line) {
    static const char *const seconds[] = {"run_seconds", "metric_seconds", "picture_seconds"};
    const bool failed = json_is_string(json_object_get(line, "failed"));
    *row = (struct sweep_row){
        .state = !failed                                         ? SWEEP_DONE
                 : json_is_true(json_object_get(line, "broken")) ? SWEEP_BROKEN
                                                                 : SWEEP_FAILED,
        .at = sweep->journal.at,
        .error = sweep_error(line, glint_target_name(answer_args_kind(&sweep->against)), "all", sweep->metric),
        .invalid = sweep_number(line, "invalid"),
        .steps_px = sweep_number(line, "steps_px"),
        .fetches_px = sweep_number(line, "fetches_px")};
    for (int k = 0; k < 3; k++) {
        const double value = sweep_number(line, seconds[k]);
        sweep->seconds[k] += isfinite(value) ? value : 0;
    }
}

/* Puts a line into its row; false when it does not belong to this sweep. */
static bool keep_sweep_line(void *user, json_t *line) {
    struct sweep *sweep = user;
    const json_t *c = json_object_get(line, "capture"), *p = json_object_get(line, "point"),
                 *r = json_object_get(line, "round");
    if (!json_is_integer(c) || !json_is_integer(p)) return false;
    const json_int_t capture = json_integer_value(c), point = json_integer_value(p), round = json_integer_value(r);
    if (capture < 0 || capture >= (json_int_t)sweep->captures.count || point < 0 ||
        point >= (json_int_t)sweep->points ||
        (r && (!json_is_integer(r) || round < 0 || round >= (json_int_t)sweep->rounds)))
        return false;
    if (r)
        sweep_rounds(sweep, (size_t)capture, (size_t)point)[round] = (struct sweep_round){
            true, sweep->journal.at, {sweep_number(line, "frame_ms"), sweep_number(line, "cubemaps_ms")}};
    else keep_look(sweep, sweep_row(sweep, (size_t)capture, (size_t)point), line);
    return true;
}

static bool make_rows(struct sweep *sweep, struct glint_error *err) {
    static const struct sweep_row none = {.error = NAN, .invalid = NAN, .steps_px = NAN, .fetches_px = NAN};
    const size_t rows = sweep->captures.count * sweep->points;
    sweep->rows = calloc(rows + 1, sizeof *sweep->rows);
    sweep->timed = calloc(rows * sweep->rounds + 1, sizeof *sweep->timed);
    for (size_t i = 0; sweep->rows && i < rows; i++) sweep->rows[i] = none;
    return (sweep->rows && sweep->timed) || fail_memory(err);
}

static json_t *read_line(const struct sweep *sweep, int64_t at) {
    struct sweep *own = (struct sweep *)sweep; /* whose place in the file is no state of it */
    return journal_read(&own->journal, at, &own->fault);
}

struct sweep_lines sweep_read(const struct sweep *sweep, size_t c, size_t p) {
    const struct sweep_row *row = sweep_row(sweep, c, p);
    struct sweep_lines lines = {.rounds = calloc(sweep->rounds + 1, sizeof *lines.rounds)};
    if (row->state != SWEEP_MISSING) lines.look = read_line(sweep, row->at);
    for (uint32_t r = 0; lines.rounds && r < sweep->rounds; r++)
        if (sweep_rounds(sweep, c, p)[r].known) lines.rounds[r] = read_line(sweep, sweep_rounds(sweep, c, p)[r].at);
    return lines;
}

void sweep_release(const struct sweep *sweep, struct sweep_lines *lines) {
    json_decref(lines->look);
    for (uint32_t r = 0; lines->rounds && r < sweep->rounds; r++) json_decref(lines->rounds[r]);
    free(lines->rounds);
    *lines = (struct sweep_lines){0};
}

bool sweep_path(const struct sweep *sweep, const char *name, char path[4096], struct glint_error *err) {
    return journal_path(sweep->out, name, path, err);
}

/* A reference is traced with many rays by fine passes; a point has one look and the timed rounds. */
bool sweep_cut(struct sweep *sweep, struct glint_error *err) {
    const size_t count = sweep->captures.count;
    const bool traces = !sweep->against.truth && !sweep->against.references.count;
    const double rays = sweep->against.rays ? sweep->against.rays : GLINT_JUDGE_RAYS;
    struct shard_cost *costs = calloc(count + 1, sizeof *costs);
    bool ok = costs || fail_memory(err);
    for (size_t c = 0; ok && sweep->shard.count && c < count; c++) {
        double pixels;
        ok = shard_pixels(sweep->captures.items[c], &pixels, err);
        costs[c] = (struct shard_cost){traces ? rays * pixels : pixels, (1. + sweep->rounds) * pixels};
    }
    if (ok) shard_cut(&sweep->shard, costs, count, sweep->points, &sweep->begin, &sweep->end);
    free(costs);
    return ok;
}

bool sweep_open(struct sweep *sweep, const char *const *axes, const char *sample, const struct list *shaders,
                struct glint_error *err) {
    sweep->journal =
        (struct journal){.folder = sweep->out, .kind = "sweep", .reread = true, .keep = keep_sweep_line, .user = sweep};
    return make_rows(sweep, err) && (sweep->definition = define(sweep, axes, sample, shaders, err)) &&
           journal_open(&sweep->journal, sweep->definition, err);
}

void sweep_finish(struct sweep *sweep) {
    free(sweep->rows);
    free(sweep->timed);
    sweep_overall_finish(&sweep->overall);
    for (size_t f = 0; f < sweep->front_count; f++) {
        free(sweep->fronts[f].on);
        free(sweep->fronts[f].points);
    }
    free(sweep->sums);
    json_decref(sweep->definition);
    journal_close(&sweep->journal);
    if (sweep->space) glint_space_destroy(&sweep->space);
    if (sweep->base) glint_pipeline_destroy(&sweep->base);
    list_free(&sweep->captures);
    answer_args_finish(&sweep->against);
}

char *sweep_point_text(const struct sweep *sweep, size_t point) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (size_t a = 0; out && a < glint_space_axis_count(sweep->space); a++) {
        const char *value = glint_space_value(sweep->space, point, a);
        if (value[0]) fprintf(out, "%s%s=%s", ftell(out) > 0 ? " " : "", glint_space_axis(sweep->space, a), value);
    }
    if (out) fclose(out);
    return text;
}
