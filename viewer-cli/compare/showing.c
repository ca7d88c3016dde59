/* The results of a preset on a capture as JSON, and back. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/compare.h"

double showing_coverage(const struct showing *s, size_t k) {
    return s->judged[k] ? (double)s->given[k] / (double)s->judged[k] : 0;
}

void showing_finish(struct showing *showing) {
    free(showing->notes);
    free(showing->frame_ms);
    free(showing->cubemaps_ms);
    json_decref(showing->passes);
    json_decref(showing->kept);
    *showing = (struct showing){0};
}

/* ---- To JSON ---- */

static json_t *surfaces_json(const struct glint_effect *effect, const struct showing *s) {
    json_t *rows = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_image_error *own = &s->own.of[k], *shared = &s->shared.of[k];
        if (s->judged[k] == 0) continue;
        json_t *row = json_pack("{s:s, s:I, s:I, s:o}", "surfaces", glint_effect_class_name(effect, k), "pixels",
                                (json_int_t)s->judged[k], "given", (json_int_t)s->given[k], "coverage",
                                json_number(showing_coverage(s, k)));
        if (s->compared && own->pixels)
            json_object_update_new(row,
                                   json_pack("{s:o, s:o, s:o, s:o, s:I, s:I}", "symmetric", json_number(own->symmetric),
                                             "rmse", json_number(own->rmse), "relative_mse",
                                             json_number(own->relative_mse), "mean_error", json_number(own->mean),
                                             "compared", (json_int_t)own->pixels, "invalid", (json_int_t)own->invalid));
        if (s->compared && shared->pixels)
            json_object_set_new(row, "shared",
                                json_pack("{s:I, s:o, s:o}", "pixels", (json_int_t)shared->pixels, "symmetric",
                                          json_number(shared->symmetric), "rmse", json_number(shared->rmse)));
        json_array_append_new(rows, row);
    }
    return rows;
}

static json_t *ends_json(const struct showing *s) {
    json_t *rows = json_array();
    for (size_t i = 0; i < s->ends.count; i++) {
        const struct glint_end_row *r = &s->ends.rows[i];
        json_array_append_new(rows,
                              json_pack("{s:s, s:s, s:s, s:I, s:o, s:I, s:o}", "tracer", r->tracer, "reason", r->reason,
                                        "text", r->text, "rays", (json_int_t)r->rays, "share", json_number(r->share),
                                        "pixels", (json_int_t)r->pixels, "error", json_number(r->error)));
    }
    return rows;
}

static json_t *over_json(const struct showing *s) {
    json_t *rows = json_array();
    for (int k = 0; k < CONTEST_OVER; k++) {
        const struct glint_image_error *e = &s->over[k].error;
        if (e->pixels)
            json_array_append_new(rows, json_pack("{s:s, s:b, s:I, s:o, s:o}", "part", contest_over[k], "drawn",
                                                  s->over[k].drawn, "pixels", (json_int_t)e->pixels, "symmetric",
                                                  json_number(e->symmetric), "rmse", json_number(e->rmse)));
    }
    return rows;
}

static json_t *time_json(const struct contest_time *time) {
    return time->n ? json_pack("{s:I, s:f, s:f, s:f}", "n", (json_int_t)time->n, "min", time->min, "median",
                               time->median, "max", time->max)
                   : json_null();
}

json_t *showing_json(const struct glint_effect *effect, const char *label, const struct showing *s) {
    json_t *json = json_pack("{s:s, s:b, s:s}", "preset", label, "ran", s->ran, "notes", s->notes ? s->notes : "");
    if (s->failure[0]) json_object_set_new(json, s->ran ? "not_compared" : "failure", json_string(s->failure));
    if (!s->ran) return json;
    json_object_update_new(
        json, json_pack("{s:o, s:o, s:o, s:I, s:f, s:f, s:f, s:f, s:o, s:o, s:O}", "surfaces", surfaces_json(effect, s),
                        "over", over_json(s), "ends", ends_json(s), "rays", (json_int_t)s->ends.rays, "steps",
                        s->ends.steps, "fetches", s->ends.fetches, "steps_px", s->steps_px, "fetches_px", s->fetches_px,
                        "frame_ms", time_json(&s->frame), "cubemaps_ms", time_json(&s->cubemaps), "passes", s->passes));
    return json;
}

/* ---- From JSON, which may come from anybody: what is not there, or of another type, is 0, NAN or "" ---- */

static const char *text_of(const json_t *json, const char *key) {
    const char *text = json_string_value(json_object_get(json, key));
    return text ? text : "";
}

static double number_of(const json_t *json, const char *key) {
    const json_t *value = json_object_get(json, key);
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

static uint64_t count_of(const json_t *json, const char *key) {
    const json_int_t value = json_integer_value(json_object_get(json, key));
    return value > 0 ? (uint64_t)value : 0;
}

static void read_surfaces(const struct glint_effect *effect, const json_t *row, struct showing *s) {
    size_t k = 0;
    const size_t classes = glint_effect_class_count(effect);
    while (k <= classes && strcmp(glint_effect_class_name(effect, k), text_of(row, "surfaces")) != 0) k++;
    if (k > classes) return;
    const json_t *shared = json_object_get(row, "shared");
    s->judged[k] = count_of(row, "pixels");
    s->given[k] = count_of(row, "given");
    s->own.of[k] = (struct glint_image_error){.pixels = count_of(row, "compared"),
                                              .invalid = count_of(row, "invalid"),
                                              .symmetric = number_of(row, "symmetric"),
                                              .rmse = number_of(row, "rmse"),
                                              .relative_mse = number_of(row, "relative_mse"),
                                              .mean = number_of(row, "mean_error")};
    s->shared.of[k] = (struct glint_image_error){.pixels = count_of(shared, "pixels"),
                                                 .symmetric = number_of(shared, "symmetric"),
                                                 .rmse = number_of(shared, "rmse")};
}

static void read_over(const json_t *row, struct showing *s) {
    for (int k = 0; k < CONTEST_OVER; k++) {
        if (strcmp(contest_over[k], text_of(row, "part")) != 0) continue;
        s->over[k].drawn = json_is_true(json_object_get(row, "drawn"));
        s->over[k].error = (struct glint_image_error){.pixels = count_of(row, "pixels"),
                                                      .symmetric = number_of(row, "symmetric"),
                                                      .rmse = number_of(row, "rmse")};
    }
}

static void read_end(const json_t *row, struct showing *s) {
    if (s->ends.count == sizeof s->ends.rows / sizeof *s->ends.rows) return;
    s->ends.rows[s->ends.count++] = (struct glint_end_row){.tracer = text_of(row, "tracer"),
                                                           .reason = text_of(row, "reason"),
                                                           .text = text_of(row, "text"),
                                                           .rays = count_of(row, "rays"),
                                                           .pixels = count_of(row, "pixels"),
                                                           .share = number_of(row, "share"),
                                                           .error = number_of(row, "error")};
}

static struct contest_time read_time(const json_t *time) {
    return (struct contest_time){(uint32_t)count_of(time, "n"), number_of(time, "min"), number_of(time, "median"),
                                 number_of(time, "max")};
}

bool showing_read(const struct glint_effect *effect, json_t *json, struct showing *s, struct glint_error *err) {
    const json_t *row;
    size_t i;
    *s = (struct showing){.kept = json_incref(json), .ran = json_is_true(json_object_get(json, "ran"))};
    const char *failure = text_of(json, s->ran ? "not_compared" : "failure");
    snprintf(s->failure, sizeof s->failure, "%s", failure);
    if (!(s->notes = strdup(text_of(json, "notes")))) return fail_memory(err);
    if (!s->ran) return true;
    s->compared = !json_object_get(json, "not_compared");
    json_array_foreach(json_object_get(json, "surfaces"), i, row) read_surfaces(effect, row, s);
    json_array_foreach(json_object_get(json, "over"), i, row) read_over(row, s);
    json_array_foreach(json_object_get(json, "ends"), i, row) read_end(row, s);
    s->ends.rays = count_of(json, "rays");
    s->ends.steps = number_of(json, "steps");
    s->ends.fetches = number_of(json, "fetches");
    s->steps_px = number_of(json, "steps_px");
    s->fetches_px = number_of(json, "fetches_px");
    s->frame = read_time(json_object_get(json, "frame_ms"));
    s->cubemaps = read_time(json_object_get(json, "cubemaps_ms"));
    s->passes = json_incref(json_object_get(json, "passes"));
    return true;
}
