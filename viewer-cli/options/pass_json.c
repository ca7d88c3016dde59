/* The declarations of passes and effects as JSON, as scripts and the live page read them. */
#include "options/pass_json.h"

#include <stdio.h>
#include <string.h>

#include "options/pass_names.h"

static json_t *image_json(const struct glint_row *row, const char *slot) {
    json_t *image = json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:b}", "name", row->name, "unit", row->unit, "meaning",
                              row->help, "from", slot, "format", format_name(row->format), "size", size_name(row->size),
                              "diagnostic", row->kind == GLINT_ROW_DIAGNOSTIC);
    if (row->channels) json_object_set_new(image, "channels", json_string(row->channels));
    return image;
}

static json_t *parameter_json(const struct glint_pass *pass, const struct glint_row *row) {
    json_t *p = json_pack("{s:s++, s:s, s:s, s:s, s:s}", "name", pass->slot, ".", row->name, "type", row_type(row),
                          "unit", row->unit, "source", row->source, "help", row->help);
    if (glint_pass_assumes(pass, row)) json_object_set_new(p, "assumed", json_true());
    if (row->kind == GLINT_ROW_CHOICE) {
        json_t *choices = json_array();
        for (size_t i = 0; row->choices[i]; i++) json_array_append_new(choices, json_string(row->choices[i]));
        json_object_set_new(p, "choices", choices);
        json_object_set_new(p, "default", json_string(value_text(row, row->initial)));
    } else {
        json_object_set_new(
            p, "default", row->type == GLINT_VALUE_BOOL ? json_boolean(row->initial != 0) : json_number(row->initial));
        json_object_set_new(p, "lowest", json_number(row->lowest));
        json_object_set_new(p, "highest", json_number(row->highest));
    }
    return p;
}

static json_t *reference_json(const struct glint_pass *pass) {
    json_t *json = json_pack("{s:b}", "is", false), *set = json_object(), *with = json_object();
    for (size_t i = 0; i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        if (row->kind == GLINT_ROW_REFERENCE) json_object_set_new(json, "is", json_true());
        else if (row->kind == GLINT_ROW_REFERENCE_NONE) json_object_set_new(json, "left_out", json_string(row->help));
        else if (row->kind == GLINT_ROW_REFERENCE_WITH) json_object_set_new(with, row->name, json_string(row->help));
        else if (row->kind == GLINT_ROW_REFERENCE_SET) {
            char name[160];
            snprintf(name, sizeof name, "%.70s.%.70s", row->image, row->name);
            json_object_set_new(set, name, json_string(row->assigned));
        }
    }
    json_object_set_new(json, "set", set);
    json_object_set_new(json, "with", with);
    return json;
}

json_t *pass_json(const struct glint_pass *pass) {
    json_t *reads = json_array(), *writes = json_array(), *parameters = json_array(), *needs = json_array(),
           *called = json_array();
    for (size_t i = 0; i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        const char *slot = "";
        if (row->kind == GLINT_ROW_READ) {
            const struct glint_row *image = image_find(row->name, &slot);
            json_array_append_new(reads, image ? image_json(image, slot) : json_pack("{s:s}", "name", row->name));
        } else if (glint_row_is_output(row)) json_array_append_new(writes, image_json(row, pass->slot));
        else if (glint_row_is_parameter(row)) json_array_append_new(parameters, parameter_json(pass, row));
        else if (row->kind == GLINT_ROW_NEEDS) json_array_append_new(needs, json_string(row->name));
        else if (row->kind == GLINT_ROW_CALLED_BY)
            json_array_append_new(called, json_pack("{s:s, s:s}", "fact", row->name, "image", row->image));
    }
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:b, s:o, s:o, s:o, s:o, s:o, s:o}", "effect", pass->effect,
                     "slot", pass->slot, "variant", pass->variant, "slot_title", slot_title(pass), "title", pass->title,
                     "source", pass->source, "host", pass->host != NULL, "needs", needs, "called_by", called, "reads",
                     reads, "writes", writes, "parameters", parameters, "reference", reference_json(pass));
}

json_t *effect_json(const struct glint_effect *effect) {
    json_t *results = json_array(), *classes = json_array();
    for (size_t k = 0; k < GLINT_EFFECT_RESULTS && effect->results[k]; k++)
        json_array_append_new(results, json_string(effect->results[k]));
    for (size_t k = 1; k <= glint_effect_class_count(effect); k++)
        json_array_append_new(classes, json_string(glint_effect_class_name(effect, k)));
    return json_pack("{s:s, s:s, s:s, s:o, s:s?, s:s, s:s, s:s, s:o}", "effect", effect->name, "title", effect->title,
                     "about", effect->about, "results", results, "truth", effect->truth, "channels", effect->channels,
                     "called_for_by", effect->fact, "term", effect->term, "classes", classes);
}
