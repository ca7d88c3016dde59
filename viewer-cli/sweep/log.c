/* The definition and results of a sweep on disk, from which an interrupted sweep resumes. */
#include "sweep/sweep.h"

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
    struct sweep_row *row = sweep_row(sweep, (size_t)capture, (size_t)point);
    json_t **place = r ? &row->rounds[round] : &row->look;
    json_decref(*place);
    *place = json_incref(line);
    return true;
}

static bool make_rows(struct sweep *sweep, struct glint_error *err) {
    const size_t rows = sweep->captures.count * sweep->points;
    sweep->rows = calloc(rows + 1, sizeof *sweep->rows);
    for (size_t i = 0; sweep->rows && i < rows; i++)
        if (!(sweep->rows[i].rounds = calloc(sweep->rounds + 1, sizeof(json_t *)))) return fail_memory(err);
    return sweep->rows || fail_memory(err);
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
    sweep->journal = (struct journal){.folder = sweep->out, .kind = "sweep", .keep = keep_sweep_line, .user = sweep};
    return make_rows(sweep, err) && (sweep->definition = define(sweep, axes, sample, shaders, err)) &&
           journal_open(&sweep->journal, sweep->definition, err);
}

void sweep_finish(struct sweep *sweep) {
    for (size_t i = 0; sweep->rows && i < sweep->captures.count * sweep->points; i++) {
        json_decref(sweep->rows[i].look);
        for (uint32_t r = 0; sweep->rows[i].rounds && r < sweep->rounds; r++) json_decref(sweep->rows[i].rounds[r]);
        free(sweep->rows[i].rounds);
    }
    free(sweep->rows);
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
