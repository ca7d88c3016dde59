/* Writes the result as a preset with a record of how it was found, and everything as JSON. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/preset_json.h"
#include "io/output.h"
#include "record.h"
#include "tune/overall.h"
#include "tune/tune.h"

static json_t *limit_json(const struct tune *tune) {
    return json_pack("{s:s, s:f, s:f, s:s, s:o, s:o}", "of", tune->by_error ? "error" : "cost", "value", tune->asked,
                     "within", tune->within, "unit",
                     tune->by_error ? glint_metric(tune->metric)->name : tune_cost_unit(tune), "part_of_start",
                     tune->part ? json_real(tune->limit) : json_null(), "slots",
                     tune->slots.count ? strings_json(tune->slots.items) : json_null());
}

/* null for a capture that could not be read. NULL if one of the others cannot be read any more. */
static json_t *hash_of(const struct tune *tune, const json_t *hashes, size_t i, bool held_out,
                       struct glint_error *err) {
    const json_t *hash = json_array_get(hashes, i);
    if (json_is_string(hash)) return json_incref((json_t *)hash);
    if (tune->subjects[i + (held_out ? tune->captures.count : 0)].broken) return json_null();
    glint_fail(err, GLINT_ERROR_IO, "%s", json_string_value(json_object_get(hash, "failed")));
    return NULL;
}

static json_t *captures_list(const struct tune *tune, struct glint_error *err) {
    json_t *list = json_array(), *hashes;
    for (int held_out = 0; held_out < 2; held_out++) {
        const struct list *captures = held_out ? &tune->held_out : &tune->captures;
        if (!(hashes = captures_json(captures, true, err))) return json_decref(list), NULL;
        *err = (struct glint_error){0};
        for (size_t i = 0; i < captures->count && !err->code; i++)
            json_array_append_new(list, json_pack("{s:s, s:o, s:b}", "path", captures->items[i], "xxh3_128",
                                                  hash_of(tune, hashes, i, held_out, err), "held_out", held_out));
        json_decref(hashes);
    }
    if (!err->code) return list;
    json_decref(list);
    return NULL;
}

static json_t *moved_json(const struct tune *tune) {
    json_t *moved = json_array();
    const double *values = tune->found.points[tune->chosen].values;
    for (size_t a = 0; a < tune->axis_count; a++) {
        char from[TUNE_TEXT], to[TUNE_TEXT];
        tune_value_text(&tune->axes[a], tune->axes[a].axis.start, from);
        tune_value_text(&tune->axes[a], values[a], to);
        if (strcmp(from, to) != 0)
            json_array_append_new(moved,
                                  json_pack("{s:s, s:s, s:s}", "name", tune->axes[a].name, "from", from, "to", to));
    }
    return moved;
}

static json_t *median_json(struct tune_median median) {
    return json_pack("{s:o, s:o, s:o}", "median", json_number(median.value), "low", json_number(median.low), "high",
                     json_number(median.high));
}

static json_t *part_json(const struct tune_median *part) {
    json_t *json = median_json(*part);
    json_object_set_new(json, "verdict", isnan(part->value) ? json_null() : json_string(tune_part_verdict(part)));
    return json;
}

static json_t *errors_of(const struct tune *tune, const struct glint_metric_table *table) {
    json_t *classes = json_object();
    for (size_t r = 0; r < table->count; r++)
        if (table->rows[r].pixels)
            json_object_set_new(classes, table->rows[r].name, figure_json(&table->rows[r].of[tune->metric]));
    return classes;
}

static json_t *differences_of(const struct tune *tune, size_t s, int a, int b) {
    json_t *classes = json_object();
    const struct glint_metric_table *table = &tune->measured[s * TUNE_CONTENDERS + TUNE_TUNED].errors;
    for (size_t r = 0; r < table->count; r++) {
        struct glint_figure difference;
        if (!tune_difference(tune, s, a, b, r, &difference)) continue;
        json_t *json = figure_json(&difference);
        json_object_set_new(json, "verdict", json_string(tune_verdict(&difference)));
        json_object_set_new(classes, table->rows[r].name, json);
    }
    return classes;
}

static json_t *confirmed_json(const struct tune *tune) {
    json_t *list = json_array();
    for (size_t s = 0; tune->confirmed && s < tune->subject_count; s++) {
        const struct tune_subject *subject = &tune->subjects[s];
        if (subject->broken) {
            json_array_append_new(list, json_pack("{s:s, s:b, s:s}", "capture", subject->path, "held_out",
                                                  subject->held_out, "broken", subject->broken));
            continue;
        }
        json_t *contenders = json_object();
        for (int k = 0; k < TUNE_CONTENDERS; k++) {
            const struct tune_measured *m = &tune->measured[s * TUNE_CONTENDERS + (size_t)k];
            if (tune->contenders[k])
                json_object_set_new(contenders, tune_contenders[k],
                                    json_pack("{s:o, s:f, s:f, s:o, s:o}", "errors", errors_of(tune, &m->errors),
                                              "steps_px", m->steps_px, "fetches_px", m->fetches_px, "ms",
                                              median_json(m->ms), "tuned_takes", part_json(&m->part)));
        }
        if (tune->contenders[TUNE_SCALED])
            json_object_set_new(json_object_get(contenders, "scaled"), "factor", json_real(tune->subjects[s].factor));
        json_array_append_new(list, json_pack("{s:s, s:b, s:o, s:o, s:o}", "capture", subject->path, "held_out",
                                              subject->held_out, "contenders", contenders, "tuned_less_start",
                                              differences_of(tune, s, TUNE_START, TUNE_TUNED), "tuned_less_scaled",
                                              differences_of(tune, s, TUNE_SCALED, TUNE_TUNED)));
    }
    return list;
}

static json_t *references_json(const struct tune *tune) {
    if (tune->against.truth) return json_string("truth");
    if (tune->against.references.count) return strings_json(tune->against.references.items);
    return json_pack("{s:I}", "rays", (json_int_t)tune->against.rays);
}

static json_t *provenance_json(const struct tune *tune, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(tune->device);
    const struct glint_search_figures *found = &tune->found.points[tune->chosen].figures;
    return json_pack(
        "{s:s, s:s, s:s, s:o, s:s, s:[ss], s:I, s:I, s:o, s:o, s:s, s:o, s:f, s:f, s:b, s:o}", "tool",
        "glint tune " GLINT_VERSION, "command", tune->command_line, "start", glint_pipeline_name(tune->base),
        "captures", captures_list(tune, err), "over", tune->worst ? "worst" : "mean", "device", device->name,
        device->driver_version, "seed", (json_int_t)tune->seed, "points", (json_int_t)tune->found.count, "limit",
        limit_json(tune), "against", references_json(tune), "metric", glint_metric(tune->metric)->name, "shaders",
        strings_json(tune->shaders->items), "error", tune->by_error ? found->constraint : found->objective, "cost",
        tune->by_error ? found->objective : found->constraint, "confirmed", tune->confirmed, "moved", moved_json(tune));
}

bool tune_write_preset(struct tune *tune, struct glint_error *err) {
    char name[128], title[300];
    const char *base = strrchr(tune->out, '/') ? strrchr(tune->out, '/') + 1 : tune->out;
    snprintf(name, sizeof name, "%.*s", (int)(strlen(base) - strlen(".json")), base);
    snprintf(title, sizeof title, "%.100s, tuned to %.4g %s at most", glint_pipeline_name(tune->base), tune->within,
             tune->by_error ? glint_metric(tune->metric)->title : tune_cost_unit(tune));
    struct glint_error unread = {0};
    json_decref(tune->provenance);
    if (!(tune->provenance = provenance_json(tune, &unread)))
        return unread.code ? glint_fail(err, unread.code, "%s", unread.message) : fail_memory(err);
    struct glint_pipeline *pipeline = tune_pipeline(tune, tune->found.points[tune->chosen].values, err);
    if (!pipeline) return false;
    json_t *json = preset_json(pipeline, name, title);
    json_object_set(json, "provenance", tune->provenance);
    char *text = record_text(json, JSON_INDENT(4));
    const bool ok = text ? output_text(tune->out, text, err) : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    free(text);
    json_decref(json);
    glint_pipeline_destroy(&pipeline);
    return ok;
}

static json_t *left_json(const struct tune *tune) {
    json_t *left = json_array();
    for (size_t i = 0; i < tune->left_count; i++)
        json_array_append_new(left, json_pack("{s:s, s:s}", "name", tune->left[i].name, "why", tune->left[i].why));
    for (size_t a = 0; a < tune->axis_count; a++)
        if (!tune->found.matters[a])
            json_array_append_new(left, json_pack("{s:s, s:s}", "name", tune->axes[a].name, "why", TUNE_NO_EFFECT));
    return left;
}

json_t *tune_json(const struct tune *tune) {
    json_t *scaled = !tune->contenders[TUNE_SCALED]
                         ? json_null()
                         : json_pack("{s:f, s:f, s:f, s:b}", "factor", tune->factor, "error", tune->scaled.error,
                                     "cost", tune->scaled.cost, "within", tune->scaled_within);
    return json_pack("{s:s, s:O, s:{s:f, s:f}, s:b, s:I, s:o, s:o, s:o, s:o}", "preset", tune->out, "provenance",
                     tune->provenance, "start", "error", tune->start.error, "cost", tune->start.cost, "within",
                     tune->confirmed_within, "fresh", (json_int_t)tune->fresh, "left", left_json(tune), "scaled",
                     scaled, "confirmed", confirmed_json(tune), "overall", tune_overall_json(tune));
}
