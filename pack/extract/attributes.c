/* Attributes of a capture as keys of a manifest. */
#include "attributes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "record.h"
#include "roles.h"

enum kind { NUMBERS, NUMBER, COUNT, FLAG, TEXT, PLANE };

struct row {
    const char *scope, *attribute, *key;
    enum kind kind;
};

/* Which key holds which attribute. The matrices are as the capture has them: row-major, for column vectors, with jitter. */
static const struct row rows[] = {
    {"frame", "glint.worldToView", "world_to_view", NUMBERS},
    {"frame", "glint.viewToClip", "view_to_clip", NUMBERS},
    {"frame", "glint.previousWorldToView", "previous_world_to_view", NUMBERS},
    {"frame", "glint.previousViewToClip", "previous_view_to_clip", NUMBERS},
    {"frame", "glint.frame", "number", COUNT},
    {"frame", "glint.cut", "cut", FLAG},
    {"frame", "glint.player", "player", NUMBERS},
    {"frame", "glint.jitter", "jitter", NUMBERS},
    {"frame", "glint.exposure", "exposure", NUMBER},
    {"frame", "glint.lutStops", "lut_stops", NUMBERS},
    {"frame", "glint.preExposure", "pre_exposure", NUMBER},
    {"frame", "glint.metresPerUnit", "metres_per_unit", NUMBER},
    {"frame", "glint.depthNear", "depth_near", NUMBER},
    {"frame", "glint.depthFar", "depth_far", NUMBER},
    {"frame", "glint.motionRange", "motion_range", NUMBER},
    {"frame", "glint.motionDepthRange", "motion_depth_range", NUMBER},
    {"frame", "glint.up", "up", TEXT},
    {"frame", "glint.clipY", "clip_y", TEXT},
    {"frame", "glint.clipZ", "clip_z", TEXT},
    {"fog", "glint.fogColor", "color", NUMBERS},
    {"fog", "glint.fogDensity", "density", NUMBER},
    {"fog", "glint.fogBase", "base", NUMBER},
    {"fog", "glint.fogScaleHeight", "scale_height", NUMBER},
    {"fog", "glint.fogAdds", "adds", FLAG},
    {"atmosphere", "glint.atmosphere.planetRadius", "planet_radius", NUMBER},
    {"atmosphere", "glint.atmosphere.ground", "ground", NUMBER},
    {"atmosphere", "glint.atmosphere.top", "top", NUMBER},
    {"atmosphere", "glint.atmosphere.irradiance", "irradiance", NUMBERS},
    {"atmosphere", "glint.atmosphere.rayleigh", "rayleigh", NUMBERS},
    {"atmosphere", "glint.atmosphere.rayleighHeight", "rayleigh_height", NUMBER},
    {"atmosphere", "glint.atmosphere.mieScattering", "mie_scattering", NUMBER},
    {"atmosphere", "glint.atmosphere.mieExtinction", "mie_extinction", NUMBER},
    {"atmosphere", "glint.atmosphere.mieHeight", "mie_height", NUMBER},
    {"atmosphere", "glint.atmosphere.mieAsymmetry", "mie_asymmetry", NUMBER},
    {"clouds", "glint.cloudGround", "ground", NUMBER},
    {"clouds", "glint.cloudBottom", "bottom", NUMBER},
    {"clouds", "glint.cloudTop", "top", NUMBER},
    {"clouds", "glint.cloudTile", "tile", NUMBER},
    {"clouds", "glint.cloudNoiseTile", "noise_tile", NUMBER},
    {"clouds", "glint.cloudExtinction", "extinction", NUMBER},
    {"clouds", "glint.cloudErosion", "erosion", NUMBER},
    {"clouds", "glint.cloudOffset", "offset", NUMBERS},
    {"material", "glint.metalReflectance", "metal_reflectance", NUMBER},
    {"material", "glint.roughestReflection", "roughest_reflection", NUMBER},
    {"material", "glint.glossScale", "gloss_scale", NUMBER},
    {"material", "glint.glossOffset", "gloss_offset", NUMBER},
    {"sun", "glint.sunDirection", "direction", NUMBERS},
    {"sun", "glint.sunAngularRadius", "angular_radius", NUMBER},
    {"sun", "glint.sunIrradiance", "irradiance", NUMBERS},
    {"light", "glint.light.NNN.position", "position", NUMBERS},
    {"light", "glint.light.NNN.intensity", "intensity", NUMBERS},
    {"light", "glint.light.NNN.range", "range", NUMBER},
    {"light", "glint.light.NNN.radius", "radius", NUMBER},
    {"light", "glint.light.NNN.axis", "axis", NUMBERS},
    {"light", "glint.light.NNN.coneInner", "cone_inner", NUMBER},
    {"light", "glint.light.NNN.coneOuter", "cone_outer", NUMBER},
    {"indirect", "glint.occluded", "occluded", FLAG},
    {"shadow", "glint.worldToShadow", "world_to_shadow", NUMBERS},
    {"shadow", "glint.shadowRange", "range", NUMBERS},
    {"shadow", "glint.shadowBias", "bias", NUMBER},
    {"shadow", "glint.shadowLight", "light", COUNT},
    {"shadow", "glint.shadowClass", "class", COUNT},
    {"volume", "glint.worldToGrid", "world_to_grid", NUMBERS},
    {"volume", "glint.volumeSlices", "slices", COUNT},
    {"froxels", "glint.froxelSlices", "slices", COUNT},
    {"froxels", "glint.froxelNear", "near", NUMBER},
    {"froxels", "glint.froxelFar", "far", NUMBER},
    {"froxels", "glint.froxelExponential", "exponential", FLAG},
    {"truth", "glint.radius", "radius", NUMBER},
    {"truth", "glint.length", "length", NUMBER},
    {"cubemap", "glint.center", "center", NUMBERS},
    {"cubemap", "glint.outdoor", "outdoor", FLAG},
    {"cubemap", "glint.fade", "fade", NUMBER},
    {"cubemap", "glint.age", "age", COUNT},
    {"cubemap", "glint.inner", "inner", TEXT},
    {"cubemap", "glint.boxMin", "box_min", NUMBERS},
    {"cubemap", "glint.boxMax", "box_max", NUMBERS},
    {"cubemap", "glint.sphereCenter", "sphere_center", NUMBERS},
    {"cubemap", "glint.sphereRadius", "sphere_radius", NUMBER},
    {"sky", "glint.ground", "ground", NUMBER},
    {"probe", "glint.levelRoughness", "roughness", NUMBER},
    {"probe", "glint.ground", "ground", NUMBER},
    {"probe", "glint.center", "center", NUMBERS},
    {"probe", "glint.boxMin", "box_min", NUMBERS},
    {"probe", "glint.boxMax", "box_max", NUMBERS},
    {"planar", "glint.plane", "plane", PLANE},
    {"planar", "glint.worldToView", "world_to_view", NUMBERS},
    {"planar", "glint.viewToClip", "view_to_clip", NUMBERS},
    {"encodings", "glint.depth", "depth", TEXT},
    {"encodings", "glint.normal", "normal", TEXT},
    {"encodings", "glint.vertexNormal", "vertex_normal", TEXT},
    {"encodings", "glint.normalSpace", "normal_space", TEXT},
    {"encodings", "glint.roughness", "roughness", TEXT},
    {"encodings", "glint.motion", "motion", TEXT},
    {"encodings", "glint.motionDepth", "motion_depth", TEXT},
    {"encodings", "glint.color", "color", TEXT},
};
enum { ROWS = sizeof rows / sizeof *rows };

static json_t *number_list(const double *numbers, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) record_append(&list, json_real(numbers[i]));
    return list;
}

/* Whether the attribute is of the type that the row wants. Text that is not UTF-8 is left out, too. */
static bool fits(const struct row *row, const struct glint_exr_attribute *a) {
    if (!a) return false;
    if (row->kind == TEXT) return a->string && record_can_hold(a->string);
    return a->numbers && (row->kind != PLANE || a->count == 16);
}

static json_t *value_of(const struct row *row, const struct glint_exr_attribute *a) {
    switch (row->kind) {
    case TEXT:
        return json_string(a->string);
    case NUMBERS:
        return number_list(a->numbers, a->count);
    case PLANE:
        return number_list(a->numbers, 4);
    case NUMBER:
        return json_real(a->numbers[0]);
    case COUNT:
        return json_integer((uint32_t)(int32_t)a->numbers[0]);
    case FLAG:
        break;
    }
    return json_boolean(a->numbers[0] != 0);
}

/* The name of a row's attribute, with the number of a light in place of NNN. */
static const char *name_of(const struct row *row, unsigned number, char name[64]) {
    const char *numbered = strstr(row->attribute, "NNN");
    if (!numbered) return row->attribute;
    snprintf(name, 64, "%.*s%03u%s", (int)(numbered - row->attribute), row->attribute, number, numbered + 3);
    return name;
}

/* The object that holds a scope's attributes, of lights those of one; empty if the part has none; NULL when out of memory. */
static json_t *numbered_of(const struct glint_exr_part_info *part, const char *scope, unsigned number) {
    json_t *object = json_object();
    char name[64];
    for (size_t i = 0; i < ROWS; i++) {
        const struct glint_exr_attribute *a =
            strcmp(rows[i].scope, scope) ? NULL : glint_exr_attribute(part, name_of(&rows[i], number, name));
        if (fits(&rows[i], a)) record_set(&object, rows[i].key, value_of(&rows[i], a));
    }
    return object;
}

static json_t *scope_of(const struct glint_exr_part_info *part, const char *scope) {
    return numbered_of(part, scope, 0);
}

static json_t *lights_of(const struct glint_exr_part_info *part) {
    json_t *list = json_array();
    for (unsigned i = 0; i < GLINT_MAX_LIGHTS; i++) {
        json_t *light = numbered_of(part, "light", i);
        if (!light || json_object_size(light)) record_append(&list, light);
        else json_decref(light);
    }
    return list;
}

static json_t *classes_of(const struct glint_exr_attribute *a) {
    json_t *list = json_array();
    for (size_t i = 0; i < a->count && a->strings; i++) {
        char *end = NULL;
        const unsigned long value = strtoul(a->strings[i], &end, 10),
                            mask = *end == '/' ? strtoul(end + 1, &end, 10) : 0;
        if (*end == '=')
            record_append(&list, json_pack("{s:s, s:I, s:I}", "name", end + 1, "value", (json_int_t)value, "mask",
                                           (json_int_t)mask));
    }
    return list;
}

/* Adds an object or list unless it is empty. */
static void set_filled(json_t **out, const char *key, json_t *value) {
    if (!value || json_object_size(value) || json_array_size(value)) record_set(out, key, value);
    else json_decref(value);
}

json_t *extract_frame(const struct glint_exr_part_info *gbuffer) {
    static const char *const objects[] = {"fog", "atmosphere", "clouds", "material", "sun"};
    json_t *frame = scope_of(gbuffer, "frame");
    const struct glint_exr_attribute *classes = glint_exr_attribute(gbuffer, "glint.stencilClasses");
    record_set(&frame, "layout", json_string("row_major"));
    record_set(&frame, "vectors", json_string("column"));
    record_set(&frame, "jitter_in_matrix", json_true());
    for (size_t i = 0; i < sizeof objects / sizeof *objects; i++)
        set_filled(&frame, objects[i], scope_of(gbuffer, objects[i]));
    if (classes) record_set(&frame, "stencil_classes", classes_of(classes));
    set_filled(&frame, "lights", lights_of(gbuffer));
    return frame;
}

static json_t *planes_of(const struct glint_exr_part_info *part) {
    json_t *planes = json_array();
    for (unsigned i = 0; i < GLINT_MAX_PLANES; i++) {
        char name[32];
        snprintf(name, sizeof name, "glint.hull.%02u", i / 4);
        const struct glint_exr_attribute *a = glint_exr_attribute(part, name);
        const double *plane = a && a->numbers && a->count == 16 ? a->numbers + 4 * (i % 4) : NULL;
        if (!plane || (plane[0] == 0 && plane[1] == 0 && plane[2] == 0 && plane[3] == 0)) break;
        record_append(&planes, number_list(plane, 4));
    }
    return planes;
}

/* ---- Attributes that glint does not know ---- */

/* A number, or the name of one that JSON has not. */
static json_t *any_number(double number) {
    if (isfinite(number)) return json_real(number);
    return json_string(isnan(number) ? "nan" : number > 0 ? "inf" : "-inf");
}

static json_t *any_numbers(const struct glint_exr_attribute *a) {
    json_t *list = json_array();
    for (size_t i = 0; i < a->count; i++) record_append(&list, any_number(a->numbers[i]));
    return list;
}

static json_t *texts_of(const struct glint_exr_attribute *a) {
    json_t *list = json_array();
    for (size_t i = 0; i < a->count; i++) record_append(&list, json_string(a->strings[i]));
    return list;
}

static json_t *bytes_of(const struct glint_exr_attribute *a) {
    char *text = calloc(2 * a->count + 1, 1);
    for (size_t i = 0; text && i < a->count; i++)
        snprintf(text + 2 * i, 3, "%02x", ((const unsigned char *)a->bytes)[i]);
    json_t *value = text ? json_string(text) : NULL;
    free(text);
    return value;
}

static json_t *typed(const char *type, json_t *value) {
    return json_pack("{s:s, s:o}", "type", type, "value", value);
}

static json_t *unknown_of(const struct glint_exr_attribute *a) {
    json_t *bytes;
    switch (a->type) {
    case GLINT_EXR_STRING:
        return json_string(a->string);
    case GLINT_EXR_INT:
        return json_integer((json_int_t)a->numbers[0]);
    case GLINT_EXR_DOUBLE:
        return isfinite(a->numbers[0]) ? json_real(a->numbers[0]) : typed("double", any_number(a->numbers[0]));
    case GLINT_EXR_FLOAT:
        return typed("float", any_number(a->numbers[0]));
    case GLINT_EXR_V2D:
        return typed("v2d", any_numbers(a));
    case GLINT_EXR_V3D:
        return typed("v3d", any_numbers(a));
    case GLINT_EXR_V3F:
        return typed("v3f", any_numbers(a));
    case GLINT_EXR_M44D:
        return typed("m44d", any_numbers(a));
    case GLINT_EXR_FLOATS:
        return typed("floats", any_numbers(a));
    case GLINT_EXR_STRINGS:
        return typed("strings", texts_of(a));
    case GLINT_EXR_OPAQUE:
        break;
    }
    bytes = typed("opaque", bytes_of(a));
    record_set(&bytes, "type_name", json_string(a->type_name));
    return bytes;
}

/* The standard attributes of OpenEXR that the writer makes from glint's. */
static bool follows_from_camera(const struct glint_exr_part_info *part, const struct glint_exr_attribute *a) {
    return !strcmp(part->name, "gbuffer") && (!strcmp(a->name, "worldToCamera") || !strcmp(a->name, "worldToNDC"));
}

/* Whether all of the attribute's text is UTF-8. */
static bool is_text(const struct glint_exr_attribute *a) {
    bool text = record_can_hold(a->name) && (a->type != GLINT_EXR_STRING || record_can_hold(a->string)) &&
                (a->type != GLINT_EXR_OPAQUE || record_can_hold(a->type_name));
    for (size_t i = 0; text && a->type == GLINT_EXR_STRINGS && i < a->count; i++) text = record_can_hold(a->strings[i]);
    return text;
}

static json_t *unknown_attributes(const struct glint_exr_part_info *part, struct glint_error *err) {
    json_t *unknown = json_object();
    for (size_t i = 0; i < part->attribute_count; i++) {
        const struct glint_exr_attribute *a = &part->attributes[i];
        if (!strncmp(a->name, "glint.", 6) || follows_from_camera(part, a)) continue;
        if (!is_text(a))
            return glint_fail(err, GLINT_ERROR_UNSUPPORTED,
                              "part %s: %.100s: expected text in UTF-8, found other bytes", part->name, a->name),
                   json_decref(unknown), NULL;
        record_set(&unknown, a->name, unknown_of(a));
    }
    if (!unknown) glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    return unknown;
}

bool extract_attributes(const struct glint_exr_part_info *part, json_t *out, struct glint_error *err) {
    static const char *const objects[] = {"cubemap", "planar", "sky",     "probe", "indirect",
                                          "shadow",  "volume", "froxels", "truth"};
    bool previous;
    const struct glint_role *role = role_of(part->name, &previous);
    const char *own = role ? role->name : "";
    json_t *unknown = unknown_attributes(part, err), *said = unknown ? json_object() : NULL;
    if (!unknown) return false;
    if (role) set_filled(&said, "encodings", scope_of(part, "encodings"));
    for (size_t i = 0; i < sizeof objects / sizeof *objects; i++) {
        const size_t length = strcspn(own, "."); /* truth.occlusion, truth.sun */
        if (strncmp(own, objects[i], length) || objects[i][length]) continue;
        json_t *object = scope_of(part, objects[i]);
        if (!strcmp(own, "cubemap")) set_filled(&object, "planes", planes_of(part));
        set_filled(&said, objects[i], object);
    }
    set_filled(&said, "attributes", unknown);
    const bool whole = said && json_object_update(out, said) == 0;
    json_decref(said);
    return whole || glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
}

const char *extract_storage(const struct glint_exr_part_info *part, const struct glint_channel_info *channel,
                            char text[64]) {
    static const char *const own[] = {"half", "float", "uint"};
    const struct glint_exr_attribute *storage = glint_exr_attribute(part, "glint.storage");
    const size_t length = strlen(channel->name);
    for (size_t i = 0; storage && storage->strings && i < storage->count; i++)
        if (!strncmp(storage->strings[i], channel->name, length) && storage->strings[i][length] == '=') {
            snprintf(text, 64, "%.63s", storage->strings[i] + length + 1);
            if (text[0]) return text;
        }
    return own[channel->stored];
}
