/* The tables and JSON of a capture's light. */
#include "capture/info_light.h"

#include <stdio.h>

#include "command.h"
#include "io/table.h"
#include "options/args.h"

static void print_shadows(const struct glint_capture *capture) {
    static const char *const titles[] = {"<shadow map", ">size", "<of", "<surfaces", ">near", ">far", ">bias", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (!part->has_shadow) continue;
        table_cell(table, "%s", part->name);
        table_cell(table, "%u × %u", part->width, part->height);
        if (part->shadow.has_light) table_cell(table, "light %03u", part->shadow.light);
        else table_cell(table, "the sun");
        table_cell(table, "%s",
                   part->shadow.has_stencil_class
                       ? glint_capture_frame(capture)->classes[part->shadow.stencil_class].name
                       : "all");
        for (int k = 0; k < 2; k++) table_cell(table, "%s", number_text(part->shadow.range[k]));
        table_cell(table, "%s", number_text(part->shadow.bias));
    }
    if (!table_is_empty(table)) {
        putchar('\n');
        table_print(table, stdout);
    }
    table_destroy(&table);
}

void info_print_light(const struct glint_capture *capture) {
    const struct glint_frame *frame = glint_capture_frame(capture);
    const struct glint_sun *sun = &frame->sun;
    if (frame->has_sun)
        printf("\nsun towards (%.3f, %.3f, %.3f), angular radius %s rad, irradiance %s %s %s\n", sun->direction[0],
               sun->direction[1], sun->direction[2], number_text(sun->angular_radius_rad),
               number_text((double)sun->irradiance[0]), number_text((double)sun->irradiance[1]),
               number_text((double)sun->irradiance[2]));
    if (frame->light_count)
        printf("%s%u point and spot light%s\n", frame->has_sun ? "" : "\n", frame->light_count,
               frame->light_count == 1 ? "" : "s");
    print_shadows(capture);
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (part->has_volume && part->volume.slices)
            printf("\n%s: %u × %u × %u cells of light\n", name_text(part->name), part->width,
                   part->height / part->volume.slices, part->volume.slices);
        if (part->has_froxels)
            printf("\n%s: %u × %u × %u cells of light in the air, slices %s from %s to %s units\n",
                   name_text(part->name), part->width, part->height / part->froxels.slices, part->froxels.slices,
                   part->froxels.exponential ? "exponential" : "linear", number_text(part->froxels.near_depth),
                   number_text(part->froxels.far_depth));
    }
}

static json_t *floats_json(const float from[3]) {
    return json_numbers((const double[]){(double)from[0], (double)from[1], (double)from[2]}, 3);
}

json_t *sun_json(const struct glint_frame *frame) {
    if (!frame->has_sun) return NULL;
    return json_pack("{s:o, s:f, s:o}", "direction", json_numbers(frame->sun.direction, 3), "angular_radius_rad",
                     frame->sun.angular_radius_rad, "irradiance", floats_json(frame->sun.irradiance));
}

json_t *lights_json(const struct glint_frame *frame) {
    json_t *all = json_array();
    for (uint32_t i = 0; i < frame->light_count; i++) {
        const struct glint_light *light = &frame->lights[i];
        json_t *json = json_pack("{s:o, s:o, s:f, s:f}", "position", json_numbers(light->position, 3), "intensity",
                                 floats_json(light->intensity), "range", light->range, "radius", light->radius);
        if (light->has_cone)
            json_object_update_new(json,
                                   json_pack("{s:o, s:f, s:f}", "axis", json_numbers(light->cone.axis, 3), "inner_rad",
                                             light->cone.inner_rad, "outer_rad", light->cone.outer_rad));
        json_array_append_new(all, json);
    }
    return all;
}

void light_part_json(const struct glint_part_info *part, json_t *json) {
    if (part->has_indirect) json_object_set_new(json, "occluded", json_boolean(part->indirect.occluded));
    if (part->has_shadow) {
        json_t *shadow = json_pack("{s:o, s:o, s:f}", "world_to_shadow", json_numbers(part->shadow.world_to_shadow, 16),
                                   "range", json_numbers(part->shadow.range, 2), "bias", part->shadow.bias);
        if (part->shadow.has_light) json_object_set_new(shadow, "light", json_integer(part->shadow.light));
        if (part->shadow.has_stencil_class)
            json_object_set_new(shadow, "class", json_integer(part->shadow.stencil_class));
        json_object_set_new(json, "shadow", shadow);
    }
    if (part->has_volume)
        json_object_set_new(json, "volume",
                            json_pack("{s:o, s:I}", "world_to_grid", json_numbers(part->volume.world_to_grid, 16),
                                      "slices", (json_int_t)part->volume.slices));
    if (part->has_froxels)
        json_object_set_new(json, "froxels",
                            json_pack("{s:I, s:f, s:f, s:b}", "slices", (json_int_t)part->froxels.slices, "near",
                                      part->froxels.near_depth, "far", part->froxels.far_depth, "exponential",
                                      part->froxels.exponential));
    if (part->truth.radius > 0) json_object_set_new(json, "radius", json_real(part->truth.radius));
    if (part->truth.length > 0) json_object_set_new(json, "length", json_real(part->truth.length));
}
