/* The manifest's lights, and what parts of light and shadow carry. Ranges are checked by the writer, by FORMAT.md's rules. */
#include "light.h"

static void read_floats(const struct node *node, const char *key, float out[3]) {
    double numbers[3] = {0};
    node_numbers(node, key, numbers);
    for (int i = 0; i < 3; i++) out[i] = (float)numbers[i];
}

static void read_sun(const struct node *node, struct glint_frame *frame) {
    frame->has_sun = node->value != NULL;
    if (!frame->has_sun) return;
    node_numbers(node, "direction", frame->sun.direction);
    frame->sun.angular_radius_rad = node_number(node, "angular_radius", 0);
    read_floats(node, "irradiance", frame->sun.irradiance);
}

static bool read_light(const struct node *node, struct glint_light *light, struct glint_error *err) {
    node_numbers(node, "position", light->position);
    read_floats(node, "intensity", light->intensity);
    light->range = node_number(node, "range", 0);
    light->radius = node_number(node, "radius", 0);
    light->has_cone = node_has(node, "axis") || node_has(node, "cone_outer") || node_has(node, "cone_inner");
    if (!light->has_cone) return true;
    if (!node_numbers(node, "axis", light->cone.axis) || !node_has(node, "cone_outer"))
        return node_fail(node, err, GLINT_ERROR_FORMAT, "a spot light needs axis and cone_outer, found no %s",
                         node_has(node, "axis") ? "cone_outer" : "axis");
    light->cone.inner_rad = node_number(node, "cone_inner", 0);
    light->cone.outer_rad = node_number(node, "cone_outer", 0);
    return true;
}

bool lights_read(const struct node *frame_node, struct glint_frame *frame, struct glint_error *err) {
    const struct node sun = node_child(frame_node, "sun"), lights = node_child(frame_node, "lights");
    read_sun(&sun, frame);
    for (size_t i = 0; i < json_array_size(lights.value); i++) {
        const struct node light = node_item(&lights, i);
        if (i == GLINT_MAX_LIGHTS)
            return node_fail(&lights, err, GLINT_ERROR_LIMIT, "expected at most %d lights", GLINT_MAX_LIGHTS);
        if (!read_light(&light, &frame->lights[frame->light_count++], err)) return false;
    }
    return true;
}

void indirect_read(const struct node *part, struct glint_indirect *indirect) {
    const struct node node = node_child(part, "indirect");
    indirect->occluded = node_bool(&node, "occluded", false);
}

bool shadow_read(const struct node *frame, const struct node *part, struct glint_shadow *shadow,
                 struct glint_error *err) {
    const struct node node = node_child(part, "shadow");
    node_numbers(&node, "range", shadow->range);
    shadow->bias = node_number(&node, "bias", 0);
    shadow->has_light = node_has(&node, "light");
    shadow->light = (uint32_t)node_count(&node, "light", 0);
    shadow->has_stencil_class = node_has(&node, "class");
    shadow->stencil_class = (uint32_t)node_count(&node, "class", 0);
    return matrix_read(frame, &node, "world_to_shadow", shadow->world_to_shadow, err);
}

bool volume_read(const struct node *frame, const struct node *part, struct glint_light_volume *volume,
                 struct glint_error *err) {
    const struct node node = node_child(part, "volume");
    volume->slices = (uint32_t)node_count(&node, "slices", 0);
    return matrix_read(frame, &node, "world_to_grid", volume->world_to_grid, err);
}

void froxels_read(const struct node *part, struct glint_froxels *froxels) {
    const struct node node = node_child(part, "froxels");
    froxels->slices = (uint32_t)node_count(&node, "slices", 0);
    froxels->near_depth = node_number(&node, "near", 0);
    froxels->far_depth = node_number(&node, "far", 0);
    froxels->exponential = node_bool(&node, "exponential", false);
}

void truth_read(const struct node *part, struct glint_truth *truth) {
    const struct node node = node_child(part, "truth");
    truth->radius = node_number(&node, "radius", 0);
    truth->length = node_number(&node, "length", 0);
}
