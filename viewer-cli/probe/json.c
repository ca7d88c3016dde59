/* The recorded steps of a pixel as JSON. */
#include <string.h>

#include "options/args.h"
#include "probe/probe.h"

/* The position along the ray, by the last record of its origin and direction. */
static json_t *position(const struct glint_probe_record *ray, const struct glint_probe_record *step) {
    static const char *const from[] = {"x", "y", "z"}, *const along[] = {"direction_x", "direction_y", "direction_z"};
    double at[3];
    const double t = (double)glint_probe_value(step, "travelled_m");
    for (int k = 0; k < 3; k++)
        at[k] = (double)glint_probe_value(ray, from[k]) + t * (double)glint_probe_value(ray, along[k]);
    return json_numbers(at, 3);
}

static json_t *record_json(const struct probe_side *side, const struct glint_probe_record *record,
                           const struct glint_probe_record *ray) {
    json_t *object = json_pack("{ss}", "kind", record->kind->name);
    if (record->ray) json_object_set_new(object, "ray", json_integer(record->ray));
    for (size_t i = 0; i < glint_probe_count(record->kind); i++) {
        const struct glint_probe_row *row = &record->kind[1 + i];
        const double value = (double)record->values[i];
        const struct glint_probe_label word = glint_probe_label(row->unit, record->values[i]);
        json_object_set_new(object, row->name, word.name ? json_string(word.name) : json_number(value));
        if (strcmp(row->unit, "index") == 0)
            json_object_set_new(object, "cubemap", json_string(probe_cubemap(side, value)));
    }
    const bool step = glint_probe_is(record, "screen_texel") || glint_probe_is(record, "screen_cell") ||
                      glint_probe_is(record, "cubemap_texel");
    if (ray && step) json_object_set_new(object, "position_m", position(ray, record));
    return object;
}

static json_t *images_json(const struct probe_side *side, const struct glint_pass *pass) {
    json_t *list = json_array();
    for (size_t i = 0; i < side->value_count; i++) {
        const struct probe_value *value = &side->values[i];
        if (value->pass != pass) continue;
        json_t *object = json_pack("{ssss}", "name", value->row->name, "unit", value->row->unit);
        if (value->row->channels) json_object_set_new(object, "channels", json_string(value->row->channels));
        json_object_set_new(object, "values", json_numbers(value->values, value->count));
        json_array_append_new(list, object);
    }
    return list;
}

static json_t *side_json(const struct probe_side *side) {
    json_t *passes = json_array();
    for (size_t p = 0; p < side->pass_count; p++) {
        const struct glint_pass *pass = side->passes[p].pass;
        if (!side->passes[p].shown) continue;
        json_t *steps = json_array();
        const struct glint_probe_record *ray = NULL;
        for (size_t i = 0; i < side->trace.count; i++) {
            const struct glint_probe_record *record = &side->trace.records[i];
            if (record->pass != pass) continue;
            if (glint_probe_is(record, "screen_ray") || glint_probe_is(record, "cubemap_ray")) ray = record;
            json_array_append_new(steps, record_json(side, record, ray));
        }
        json_array_append_new(passes, json_pack("{sssssoso}", "slot", pass->slot, "variant", pass->variant, "steps",
                                                steps, "images", images_json(side, pass)));
    }
    return json_pack("{soso}", "capture", images_json(side, NULL), "passes", passes);
}

json_t *probe_json(const struct probe *probe) {
    json_t *root = json_pack("{sss[ii]s[ii]s[ii]s[ii]ssss}", "capture", probe->capture, "pixel", (int)probe->pixel[0],
                             (int)probe->pixel[1], "texel", (int)probe->texel[0], (int)probe->texel[1], "full",
                             (int)probe->full[0], (int)probe->full[1], "half", (int)probe->half[0], (int)probe->half[1],
                             "preset", probe->preset, "device", probe->device);
    json_object_set_new(root, "pipeline", side_json(&probe->own));
    if (probe->own.trace.dropped)
        json_object_set_new(root, "dropped_steps", json_integer((json_int_t)probe->own.trace.dropped));
    if (probe->has_reference) json_object_set_new(root, "reference", side_json(&probe->reference));
    return root;
}
