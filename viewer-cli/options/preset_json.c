/* A pipeline as the JSON of a preset file. */
#include "options/preset_json.h"

#include <math.h>
#include <stdio.h>

json_t *parameter_value_json(const struct glint_row *row, double value) {
    if (row->choices) return json_string(row->choices[(size_t)value]);
    if (row->type == GLINT_VALUE_BOOL) return json_boolean(value != 0);
    return value == floor(value) && fabs(value) < 1e9 ? json_integer((json_int_t)value) : json_real(value);
}

json_t *preset_json(const struct glint_pipeline *pipeline, const char *name, const char *title) {
    json_t *slots = json_object(), *set = json_object();
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        json_object_set_new(slots, pass->slot, json_string(pass->variant));
        for (size_t r = 0; r < pass->row_count; r++) {
            char key[160];
            const struct glint_row *row = &pass->rows[r];
            if (!glint_row_is_parameter(row)) continue;
            const double value = glint_pipeline_value(pipeline, pass, row);
            snprintf(key, sizeof key, "%s.%s", pass->slot, row->name);
            if (value != row->initial) json_object_set_new(set, key, parameter_value_json(row, value));
        }
    }
    if (glint_pipeline_rays(pipeline) > 1)
        json_object_set_new(set, "pipeline.rays", json_integer(glint_pipeline_rays(pipeline)));
    if (glint_pipeline_first_ray(pipeline))
        json_object_set_new(set, "pipeline.first_ray", json_integer(glint_pipeline_first_ray(pipeline)));
    return json_pack("{s:s, s:s, s:o, s:o}", "name", name, "title", title, "slots", slots, "set", set);
}
