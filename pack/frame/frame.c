/* The manifest's frame: conventions, jitter, and what stands beside the cameras. */
#include "frame.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "air.h"
#include "keys.h"
#include "light.h"

static int choice_of(const struct node *node, const char *key, const char *const *names) {
    const char *text = node_text(node, key);
    int i = 0;
    while (text && strcmp(names[i], text)) i++;
    return i;
}

/* Says which keys of the frame were not said, and what holds in their place. */
static void note_defaults(const struct node *frame_node) {
    static const char *const told[] = {
        "clip_y", "clip_z",   "up",  "metres_per_unit", "jitter", "exposure", "pre_exposure", "player", "number",
        "fog",    "material", "cut", "stencil_classes", "sun",    "lights"};
    const struct object *object = pack_object("frame");
    for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
        const struct node node = node_child(frame_node, told[i]);
        if (!node.value) node_note(&node, GLINT_PACK_DEFAULT, "not said; %s", pack_key(object, told[i])->fallback);
    }
}

static bool read_positive(const struct node *frame, const char *key, double *out, struct glint_error *err) {
    const struct node node = node_child(frame, key);
    *out = node_number(frame, key, 0);
    return !node.value || *out > 0 ||
           node_fail(&node, err, GLINT_ERROR_FORMAT, "expected a number above 0, found %g", *out);
}

static bool read_classes(const struct node *list, struct glint_frame *frame, struct glint_error *err) {
    for (size_t i = 0; i < json_array_size(list->value); i++) {
        const struct node item = node_item(list, i);
        const char *name = node_text(&item, "name");
        if (i == GLINT_MAX_STENCIL_CLASSES)
            return node_fail(list, err, GLINT_ERROR_LIMIT, "expected at most %d classes", GLINT_MAX_STENCIL_CLASSES);
        struct glint_stencil_class *class = &frame->classes[frame->class_count++];
        if (!name[0] || strlen(name) >= sizeof class->name)
            return node_fail(&item, err, GLINT_ERROR_FORMAT, "expected a name of 1 to 31 bytes, found \"%.60s\"", name);
        class->value = (uint32_t)node_count(&item, "value", 0);
        class->mask = (uint32_t)node_count(&item, "mask", 0);
        snprintf(class->name, sizeof class->name, "%s", name);
    }
    return true;
}

static bool read_fog(const struct node *fog, struct glint_frame *frame, struct glint_error *err) {
    double color[3];
    if (!fog->value) return true;
    node_numbers(fog, "color", color);
    for (int i = 0; i < 3; i++) frame->fog.color[i] = (float)color[i];
    frame->has_fog = true;
    frame->fog.density = node_number(fog, "density", 0);
    frame->fog.base = node_number(fog, "base", 0);
    frame->fog.scale_height = node_number(fog, "scale_height", 0);
    frame->fog.adds = node_bool(fog, "adds", false);
    if (color[0] < 0 || color[1] < 0 || color[2] < 0 || frame->fog.density < 0 || frame->fog.scale_height < 0)
        return node_fail(fog, err, GLINT_ERROR_FORMAT, "expected no negative color, density and scale_height");
    return true;
}

static bool read_material(const struct node *material, struct glint_frame *frame, struct glint_error *err) {
    struct glint_material_model *m = &frame->material;
    frame->has_material = material->value != NULL;
    m->metal_reflectance = node_number(material, "metal_reflectance", 1);
    m->roughest_reflection = node_number(material, "roughest_reflection", 0);
    m->gloss_scale = node_number(material, "gloss_scale", 10);
    m->gloss_offset = node_number(material, "gloss_offset", 1);
    if (!(m->metal_reflectance > 0) || !(m->gloss_scale > 0) || !(m->roughest_reflection >= 0))
        return node_fail(material, err, GLINT_ERROR_FORMAT,
                         "expected metal_reflectance and gloss_scale above 0 and roughest_reflection from 0");
    return true;
}

static bool read_values(const struct node *node, struct glint_frame *frame, struct glint_error *err) {
    static const char *const ups[] = {"+y", "+z", "+x", "-y", "-z", "-x"}, *const ys[] = {"up", "down"},
                             *const zs[] = {"zero_to_one", "minus_one_to_one"};
    const struct node fog = node_child(node, "fog"), material = node_child(node, "material"),
                      classes = node_child(node, "stencil_classes");
    frame->up = (enum glint_axis)choice_of(node, "up", ups);
    frame->clip_y = (enum glint_clip_y)choice_of(node, "clip_y", ys);
    frame->clip_z = (enum glint_clip_z)choice_of(node, "clip_z", zs);
    frame->cut = node_bool(node, "cut", false);
    frame->has_player = node_numbers(node, "player", frame->player);
    frame->number = (uint32_t)node_count(node, "number", 0);
    frame->depth_near = node_number(node, "depth_near", 0);
    frame->depth_far = node_number(node, "depth_far", 0);
    frame->has_lut_stops = node_numbers(node, "lut_stops", frame->lut_stops);
    node_numbers(node, "jitter", frame->jitter_px);
    air_read(node, frame);
    return read_positive(node, "exposure", &frame->exposure, err) &&
           read_positive(node, "pre_exposure", &frame->pre_exposure, err) &&
           read_positive(node, "metres_per_unit", &frame->metres_per_unit, err) &&
           read_positive(node, "motion_range", &frame->motion_range, err) &&
           read_positive(node, "motion_depth_range", &frame->motion_depth_range, err) && read_fog(&fog, frame, err) &&
           read_material(&material, frame, err) && read_classes(&classes, frame, err) && lights_read(node, frame, err);
}

/* ---- Cameras ---- */

/* Moves the picture by pixels: NDC moves by 2/size a pixel, and clip by that times w. */
static void add_jitter(double clip[16], const double px[2], enum glint_clip_y clip_y, uint32_t width, uint32_t height) {
    clip[2] += 2 * px[0] / width * clip[14];
    clip[6] += (clip_y == GLINT_CLIP_Y_DOWN ? 2 : -2) * px[1] / height * clip[14];
}

/* 1: the world is right-handed. A view of x right, y up on screen is right-handed if it looks along -z. */
static int handedness_of(const struct glint_camera *camera, enum glint_clip_y clip_y) {
    const double *m = camera->world_to_view, *p = camera->view_to_clip;
    const double det =
        m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
    const bool mirrored = (det < 0) != (p[0] < 0), down = (p[5] < 0) != (clip_y == GLINT_CLIP_Y_DOWN);
    const bool right = (p[14] < 0) != (mirrored != down);
    return right ? 1 : -1;
}

static bool check_handedness(const struct node *frame_node, const struct glint_frame *frame, struct glint_error *err) {
    const struct node node = node_child(frame_node, "handedness");
    const char *said = json_string_value(node.value),
               *found = handedness_of(&frame->camera, frame->clip_y) > 0 ? "right" : "left";
    if (!said) node_note(&node, GLINT_PACK_FOUND, "not said; %s, as the matrices have it", found);
    else if (strcmp(said, found))
        return node_fail(
            &node, err, GLINT_ERROR_FORMAT,
            "\"%s\" contradicts the matrices and clip_y, by which the world is %s-handed (or the picture is "
            "mirrored)",
            said, found);
    return true;
}

static void note_projection(const struct node *frame_node, const struct glint_frame *frame) {
    const struct projection p = projection_of(frame->camera.view_to_clip, frame->clip_z);
    const bool matrix = node_has(frame_node, "view_to_clip");
    const struct node node = node_child(frame_node, matrix ? "view_to_clip" : "camera");
    char far[64];
    snprintf(far, sizeof far, "far at %.6g units", p.far);
    node_note(&node, GLINT_PACK_FOUND, "a %sprojection %s, near at %.6g units", p.is_reversed ? "reversed " : "",
              p.is_infinite ? "without a far plane" : far, p.near);
}

static bool read_previous(const struct node *node, struct glint_frame *frame, const struct matrix_order *order,
                          uint32_t width, uint32_t height, const double unjittered[16], struct glint_error *err) {
    const bool has_view = node_has(node, "previous_world_to_view") || node_has(node, "previous_view_to_world");
    frame->has_previous = has_view || node_has(node, "previous_view_to_clip") || node_has(node, "previous_camera");
    if (!frame->has_previous) return true;
    if (!has_view || node_has(node, "previous_view_to_clip") || node_has(node, "previous_camera"))
        return camera_read(node, node, "previous_", order, width, height, &frame->previous, err);
    const struct node clip = node_child(node, "previous_view_to_clip");
    memcpy(frame->previous.view_to_clip, unjittered, 16 * sizeof(double));
    node_note(&clip, GLINT_PACK_DEFAULT, "not said; view_to_clip without this frame's jitter");
    bool found;
    return view_read(node, "previous_", order, frame->previous.world_to_view, &found, err);
}

bool frame_read(const struct node *node, struct glint_frame *frame, uint32_t width, uint32_t height,
                struct glint_error *err) {
    struct matrix_order order;
    double unjittered[16], previous_jitter[2] = {0, 0}, back[2];
    const bool has_jitter = node_has(node, "jitter");
    const bool included = node_bool(node, "jitter_in_matrix", !node_has(node, "camera"));
    if (!read_values(node, frame, err) || !matrix_order_read(node, &order, err)) return false;
    note_defaults(node);
    if (!camera_read(node, node, "", &order, width, height, &frame->camera, err)) return false;
    for (int i = 0; i < 2; i++) back[i] = included ? -frame->jitter_px[i] : 0;
    memcpy(unjittered, frame->camera.view_to_clip, sizeof unjittered);
    add_jitter(unjittered, back, frame->clip_y, width, height);
    if (!read_previous(node, frame, &order, width, height, unjittered, err)) return false;
    if (!included) {
        node_numbers(node, "previous_jitter", previous_jitter);
        add_jitter(frame->camera.view_to_clip, frame->jitter_px, frame->clip_y, width, height);
        if (frame->has_previous)
            add_jitter(frame->previous.view_to_clip, previous_jitter, frame->clip_y, width, height);
    }
    const struct node said = node_child(node, "jitter_in_matrix");
    if (has_jitter && !said.value)
        node_note(&said, GLINT_PACK_DEFAULT, "not said; %s", included ? "true" : "false: pack adds the jitter");
    note_projection(node, frame);
    return check_handedness(node, frame, err);
}

/* ---- What parts carry ---- */

bool planar_read(const struct node *frame_node, const struct node *part, struct glint_planar *planar,
                 struct glint_error *err) {
    const struct node node = node_child(part, "planar");
    struct matrix_order order = {.is_transposed = false};
    if (!matrix_order_read(frame_node, &order, err)) return false;
    node_numbers(&node, "plane", planar->plane);
    return camera_read(frame_node, &node, "", &order, 0, 0, &planar->camera, err);
}

bool cubemap_read(const struct node *part, struct glint_cubemap *cubemap, struct glint_error *err) {
    static const char *const volumes[] = {"none", "box", "sphere", "hull"};
    const struct node node = node_child(part, "cubemap"), planes = node_child(&node, "planes");
    const struct node fade = node_child(&node, "fade");
    node_numbers(&node, "center", cubemap->center);
    cubemap->outdoor = node_bool(&node, "outdoor", false);
    cubemap->fade = node_number(&node, "fade", 1);
    if (!(cubemap->fade > 0 && cubemap->fade <= 1))
        return node_fail(&fade, err, GLINT_ERROR_FORMAT, "expected a weight above 0 and at most 1, found %g",
                         cubemap->fade);
    cubemap->age_frames = (uint32_t)node_count(&node, "age", 0);
    node_numbers(&node, "box_min", cubemap->box_min);
    node_numbers(&node, "box_max", cubemap->box_max);
    node_numbers(&node, "sphere_center", cubemap->sphere_center);
    cubemap->sphere_radius = node_number(&node, "sphere_radius", 0);
    cubemap->plane_count = (uint32_t)json_array_size(planes.value);
    node_numbers(&node, "planes", cubemap->planes[0]);
    cubemap->inner = (enum glint_volume)choice_of(&node, "inner", volumes);
    if (!node_has(&node, "inner"))
        cubemap->inner = node_has(&node, "box_min")         ? GLINT_VOLUME_BOX
                         : node_has(&node, "sphere_radius") ? GLINT_VOLUME_SPHERE
                         : planes.value                     ? GLINT_VOLUME_HULL
                                                            : GLINT_VOLUME_NONE;
    return true;
}

void sky_read(const struct node *part, struct glint_sky *sky) {
    const struct node node = node_child(part, "sky");
    sky->has_ground = node_has(&node, "ground");
    sky->ground = node_number(&node, "ground", 0);
}

bool probe_read(const struct node *part, struct glint_probe *probe, struct glint_error *err) {
    static const char *const box[] = {"center", "box_min", "box_max"};
    const struct node node = node_child(part, "probe");
    double *const members[] = {probe->box.center, probe->box.min, probe->box.max};
    probe->has_roughness = node_has(&node, "roughness");
    probe->roughness = node_number(&node, "roughness", 0);
    probe->has_ground = node_has(&node, "ground");
    probe->ground = node_number(&node, "ground", 0);
    for (int i = 0; i < 3; i++) {
        probe->has_box |= node_has(&node, box[i]);
        node_numbers(&node, box[i], members[i]);
    }
    for (int i = 0; probe->has_box && i < 3; i++)
        if (!node_has(&node, box[i]))
            return node_fail(&node, err, GLINT_ERROR_FORMAT, "a box needs center, box_min and box_max, found no %s",
                             box[i]);
    return true;
}
