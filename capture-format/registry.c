/* The registry as C tables, generated from rows/. */
#include "registry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)

/* ---- roles: a list of all channels, and the range of each role in it ---- */

enum {
#define ROLE(id, ...) ROLE_FIRST_##id, ROLE_BEFORE_##id = ROLE_FIRST_##id - 1,
#define CHANNEL(...) CAT(ROLE_ROW_, __LINE__),
#define CHANNEL_OR(...) CAT(ROLE_ROW_, __LINE__),
#define END(id) ROLE_END_##id, ROLE_LAST_##id = ROLE_END_##id - 1,
#include "rows/roles.h"
    ROLE_CHANNELS
};

static const struct glint_role_channel role_channels[] = {
#define ROLE(...)
#define CHANNEL(name, required, unit, encoding, meaning) {name, required, unit, encoding, meaning, (double)NAN},
#define CHANNEL_OR(name, value, unit, encoding, meaning) {name, false, unit, encoding, meaning, value},
#define END(id)
#include "rows/roles.h"
};

static const struct glint_role roles[] = {
#define ROLE(id, name, shape, required, numbered, previous, reserved, meaning)                                         \
    {name,                                                                                                             \
     GLINT_SHAPE_##shape,                                                                                              \
     required,                                                                                                         \
     numbered,                                                                                                         \
     previous,                                                                                                         \
     reserved,                                                                                                         \
     (int)ROLE_END_##id > (int)ROLE_FIRST_##id ? role_channels + ROLE_FIRST_##id : NULL,                               \
     ROLE_END_##id - ROLE_FIRST_##id,                                                                                  \
     meaning},
#define CHANNEL(...)
#define CHANNEL_OR(...)
#define END(id)
#include "rows/roles.h"
};

const struct glint_role *glint_roles(size_t *count) {
    *count = sizeof roles / sizeof *roles;
    return roles;
}

int32_t glint_role_level(const char *part) {
    static const char suffix[] = ".level";
    const char *at = strstr(part, suffix);
    const size_t length = at ? strlen(at) - (sizeof suffix - 1) : 0;
    if (length < 1 || length > 2) return 0;
    at += sizeof suffix - 1;
    if (at[0] < '1' || at[0] > '9' || (length == 2 && (at[1] < '0' || at[1] > '9')))
        return 0; /* a number has one name */
    return length == 1 ? at[0] - '0' : 10 * (at[0] - '0') + at[1] - '0';
}

bool glint_shape_is_cube(enum glint_shape shape) {
    return shape == GLINT_SHAPE_CUBE || shape == GLINT_SHAPE_LEVELS;
}

/* Whether `name` belongs to the role, with its number or free suffix. */
static bool role_matches(const struct glint_role *role, const char *name, int32_t *index) {
    const size_t length = strlen(role->name);
    *index = -1;
    if (strncmp(name, role->name, length)) return false;
    const char *rest = name + length;
    if (role->name[length - 1] == '.') return *rest != 0;
    if (!role->numbered) return *rest == 0;
    const bool level = role->shape == GLINT_SHAPE_LEVELS && glint_role_level(name) > 0;
    if ((strlen(rest) != 4 && !(level && strstr(name, ".level") == rest + 4)) || rest[0] != '.') return false;
    *index = 0;
    for (int i = 1; i < 4; i++) {
        if (rest[i] < '0' || rest[i] > '9') return false;
        *index = *index * 10 + (rest[i] - '0');
    }
    return true;
}

const struct glint_role *glint_role_find(const char *part, int32_t *index, bool *previous) {
    static const char prefix[] = "previous.";
    *previous = !strncmp(part, prefix, sizeof prefix - 1);
    const char *name = *previous ? part + sizeof prefix - 1 : part;
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++)
        if ((!*previous || roles[i].may_be_previous) && role_matches(&roles[i], name, index)) return &roles[i];
    *previous = false;
    *index = -1;
    return NULL;
}

const struct glint_role_channel *glint_role_channel_find(const struct glint_role *role, const char *channel) {
    for (size_t i = 0; role && i < role->channel_count; i++)
        if (!strcmp(role->channels[i].name, channel)) return &role->channels[i];
    return NULL;
}

/* ---- encodings, in the same way ---- */

enum {
#define ENCODING(id, attribute) ENCODING_FIRST_##id, ENCODING_BEFORE_##id = ENCODING_FIRST_##id - 1,
#define VALUE(...) CAT(ENCODING_ROW_, __LINE__),
#define END(id) ENCODING_END_##id, ENCODING_LAST_##id = ENCODING_END_##id - 1,
#include "rows/encodings.h"
    ENCODING_VALUES
};

static const struct glint_encoding_value encoding_values[] = {
#define ENCODING(...)
#define VALUE(name, meaning) {name, meaning},
#define END(id)
#include "rows/encodings.h"
};

static const struct glint_encoding_row encodings[] = {
#define ENCODING(id, attribute)                                                                                        \
    {#id, attribute, offsetof(struct glint_encodings, id), encoding_values + ENCODING_FIRST_##id,                      \
     ENCODING_END_##id - ENCODING_FIRST_##id},
#define VALUE(...)
#define END(id)
#include "rows/encodings.h"
};

const struct glint_encoding_row *glint_encoding_rows(size_t *count) {
    *count = sizeof encodings / sizeof *encodings;
    return encodings;
}

const struct glint_encoding_row *glint_encoding_find(const char *which) {
    for (size_t i = 0; i < sizeof encodings / sizeof *encodings; i++)
        if (!strcmp(encodings[i].which, which)) return &encodings[i];
    return NULL;
}

/* Every enum of glint_encodings has the size of an int: enumerators are small and not negative. */
int glint_encoding_get(const struct glint_encodings *from, const struct glint_encoding_row *row) {
    int value = 0;
    memcpy(&value, (const char *)from + row->offset, sizeof value);
    return value;
}

void glint_encoding_set(struct glint_encodings *to, const struct glint_encoding_row *row, int value) {
    memcpy((char *)to + row->offset, &value, sizeof value);
}

const char *glint_encoding_name(const char *which, int value) {
    const struct glint_encoding_row *row = glint_encoding_find(which);
    return row && value >= 0 && value < row->count ? row->values[value].name : NULL;
}

int glint_encoding_value(const char *which, const char *name) {
    const struct glint_encoding_row *row = glint_encoding_find(which);
    for (int i = 0; row && i < row->count; i++)
        if (!strcmp(row->values[i].name, name)) return i;
    return -1;
}

/* ---- attributes ---- */

#define GROUP_NONE(scope) GLINT_NO_GROUP
#define GROUP_has_previous(scope) offsetof(STRUCT_##scope, has_previous)
#define GROUP_has_lut_stops(scope) offsetof(STRUCT_##scope, has_lut_stops)
#define GROUP_has_player(scope) offsetof(STRUCT_##scope, has_player)
#define GROUP_has_fog(scope) offsetof(STRUCT_##scope, has_fog)
#define GROUP_has_atmosphere(scope) offsetof(STRUCT_##scope, has_atmosphere)
#define GROUP_has_clouds(scope) offsetof(STRUCT_##scope, has_clouds)
#define GROUP_has_ground(scope) offsetof(STRUCT_##scope, has_ground)
#define GROUP_has_roughness(scope) offsetof(STRUCT_##scope, has_roughness)
#define GROUP_has_box(scope) offsetof(STRUCT_##scope, has_box)
#define GROUP_has_material(scope) offsetof(STRUCT_##scope, has_material)
#define GROUP_has_sun(scope) offsetof(STRUCT_##scope, has_sun)
#define GROUP_has_cone(scope) offsetof(STRUCT_##scope, has_cone)
#define GROUP_has_light(scope) offsetof(STRUCT_##scope, has_light)
#define GROUP_has_stencil_class(scope) offsetof(STRUCT_##scope, has_stencil_class)
#define NEED_REQUIRED true
#define NEED_OPTIONAL false

#define STRUCT_FRAME struct glint_frame
#define STRUCT_LIGHT struct glint_light
#define STRUCT_INDIRECT struct glint_indirect
#define STRUCT_SHADOW struct glint_shadow
#define STRUCT_VOLUME struct glint_light_volume
#define STRUCT_FROXELS struct glint_froxels
#define STRUCT_TRUTH_OCCLUSION struct glint_truth
#define STRUCT_TRUTH_SUN struct glint_truth
#define STRUCT_CUBEMAP struct glint_cubemap
#define STRUCT_SKY struct glint_sky
#define STRUCT_PROBE struct glint_probe
#define STRUCT_PLANAR struct glint_planar

static const struct glint_attribute_row attributes[] = {
#define SCOPE(...)
#define PART_SCOPE(...)
#define ATTRIBUTE(scope, name, kind, member, group, need, range, fallback, unit, meaning)                              \
    {GLINT_SCOPE_##scope,                                                                                              \
     name,                                                                                                             \
     GLINT_KIND_##kind,                                                                                                \
     offsetof(STRUCT_##scope, member),                                                                                 \
     GROUP_##group(scope),                                                                                             \
     NEED_##need,                                                                                                      \
     GLINT_RANGE_##range,                                                                                              \
     fallback,                                                                                                         \
     unit,                                                                                                             \
     meaning},
#include "rows/attributes.h"
};

const struct glint_attribute_row *glint_attribute_rows(size_t *count) {
    *count = sizeof attributes / sizeof *attributes;
    return attributes;
}

const struct glint_scope_row *glint_scope_row(enum glint_scope scope) {
    static const struct glint_scope_row rows[] = {
#define SCOPE(id, role, type, place) [GLINT_SCOPE_##id] = {role, place, true, 0, 0, 0},
#define PART_SCOPE(id, role, type, member, place)                                                                      \
    [GLINT_SCOPE_##id] = {role,                                                                                        \
                          place,                                                                                       \
                          false,                                                                                       \
                          offsetof(struct glint_part, member),                                                         \
                          offsetof(struct glint_part_info, has_##member),                                              \
                          offsetof(struct glint_part_info, member)},
#define ATTRIBUTE(...)
#include "rows/attributes.h"
    };
    return &rows[scope];
}

bool glint_scope_is_on(enum glint_scope scope, const struct glint_role *role, bool previous) {
    const struct glint_scope_row *row = glint_scope_row(scope);
    return role && !strcmp(role->name, row->role) && !(row->of_frame && previous);
}

/* ---- names of the attributes of lights ---- */

static const char light[] = "glint.light.";

const char *glint_attribute_name(const struct glint_attribute_row *row, uint32_t number, char name[64]) {
    if (row->scope != GLINT_SCOPE_LIGHT) return row->name;
    snprintf(name, 64, "%s%03u%s", light, number, row->name + sizeof light - 1 + strlen("NNN"));
    return name;
}

bool glint_light_number(const char *name, uint32_t *number) {
    const char *digits = name + sizeof light - 1;
    if (strncmp(name, light, sizeof light - 1) != 0 || strspn(digits, "0123456789") != 3 || digits[3] != '.')
        return false;
    *number = (uint32_t)(100 * (digits[0] - '0') + 10 * (digits[1] - '0') + digits[2] - '0');
    return true;
}

const char *glint_kind_type(enum glint_attribute_kind kind) {
    static const char *const types[] = {[GLINT_KIND_CAMERA_VIEW] = "m44d", [GLINT_KIND_CAMERA_CLIP] = "m44d",
                                        [GLINT_KIND_MATRIX] = "m44d",      [GLINT_KIND_V3] = "v3d",
                                        [GLINT_KIND_DIRECTION] = "v3d",    [GLINT_KIND_V2] = "v2d",
                                        [GLINT_KIND_RANGE] = "v2d",        [GLINT_KIND_DOUBLE] = "double",
                                        [GLINT_KIND_V3FLOAT] = "v3f",      [GLINT_KIND_UINT] = "int",
                                        [GLINT_KIND_BOOL] = "int",         [GLINT_KIND_AXIS] = "string",
                                        [GLINT_KIND_CLIP_Y] = "string",    [GLINT_KIND_CLIP_Z] = "string",
                                        [GLINT_KIND_VOLUME] = "string",    [GLINT_KIND_CLASSES] = "stringvector",
                                        [GLINT_KIND_PLANES] = "m44d",      [GLINT_KIND_PLANE] = "m44d"};
    return types[kind];
}

const char *const *glint_kind_names(enum glint_attribute_kind kind) {
    static const char *const axes[] = {"+y", "+z", "+x", "-y", "-z", "-x", NULL};
    static const char *const clip_y[] = {"up", "down", NULL};
    static const char *const clip_z[] = {"zero_to_one", "minus_one_to_one", NULL};
    static const char *const volumes[] = {"none", "box", "sphere", "hull", NULL};
    switch (kind) {
    case GLINT_KIND_AXIS:
        return axes;
    case GLINT_KIND_CLIP_Y:
        return clip_y;
    case GLINT_KIND_CLIP_Z:
        return clip_z;
    case GLINT_KIND_VOLUME:
        return volumes;
    default:
        return NULL;
    }
}

const char *glint_stored_name(enum glint_stored stored) {
    static const char *const names[] = {
        [GLINT_STORED_HALF] = "half", [GLINT_STORED_FLOAT] = "float", [GLINT_STORED_UINT] = "uint"};
    return names[stored];
}

/* ---- rules ---- */

const struct glint_rule_row *glint_rule_rows(void) {
    static const struct glint_rule_row rows[] = {
#define RULE(id, name, text) {name, text},
#include "rows/rules.h"
    };
    return rows;
}
