/* The registry as C tables: roles, encodings, attributes and rules, made from rows/. */
#ifndef GLINT_REGISTRY_H
#define GLINT_REGISTRY_H

#include "glint/capture.h"

/* ---- roles ---- */

/* The L of a part's name that ends in .levelL; 0 for others. */
int32_t glint_role_level(const char *part);
const struct glint_role_channel *glint_role_channel_find(const struct glint_role *role, const char *channel);

/* ---- encodings ---- */

struct glint_encoding_value {
    const char *name, *meaning;
};
struct glint_encoding_row {
    const char *which;     /* "depth" */
    const char *attribute; /* "glint.depth" */
    size_t offset;         /* of the enum in glint_encodings */
    const struct glint_encoding_value *values;
    int count;
};
const struct glint_encoding_row *glint_encoding_rows(size_t *count);
const struct glint_encoding_row *glint_encoding_find(const char *which);
int glint_encoding_get(const struct glint_encodings *encodings, const struct glint_encoding_row *row);
void glint_encoding_set(struct glint_encodings *encodings, const struct glint_encoding_row *row, int value);

/* ---- attributes ---- */

enum glint_attribute_kind {
    GLINT_KIND_CAMERA_VIEW,
    GLINT_KIND_CAMERA_CLIP,
    GLINT_KIND_MATRIX,
    GLINT_KIND_V3,
    GLINT_KIND_DIRECTION,
    GLINT_KIND_V2,
    GLINT_KIND_RANGE,
    GLINT_KIND_DOUBLE,
    GLINT_KIND_V3FLOAT,
    GLINT_KIND_UINT,
    GLINT_KIND_BOOL,
    GLINT_KIND_AXIS,
    GLINT_KIND_CLIP_Y,
    GLINT_KIND_CLIP_Z,
    GLINT_KIND_VOLUME,
    GLINT_KIND_CLASSES,
    GLINT_KIND_PLANES,
    GLINT_KIND_PLANE
};
enum glint_range {
    GLINT_RANGE_ANY,
    GLINT_RANGE_POSITIVE,
    GLINT_RANGE_NOT_NEGATIVE,
    GLINT_RANGE_UNIT,
    GLINT_RANGE_ELEVATION,
    GLINT_RANGE_ACUTE,
    GLINT_RANGE_ANGLE,
    GLINT_RANGE_COSINE
};
enum glint_scope {
#define SCOPE(id, role, type, place) GLINT_SCOPE_##id,
#define PART_SCOPE(id, role, type, member, place) GLINT_SCOPE_##id,
#define ATTRIBUTE(...)
#include "rows/attributes.h"
    GLINT_SCOPE_COUNT
};
struct glint_scope_row {
    const char *role;  /* whose parts carry the attributes */
    const char *place; /* "on each `cubemap.NNN`" */
    bool of_frame;     /* on gbuffer itself, not on a previous one; the offsets below are of parts' structs alone */
    size_t given;      /* in glint_part: the pointer to the struct */
    size_t has, found; /* in glint_part_info: whether the part is one of the role, and the struct */
};
const struct glint_scope_row *glint_scope_row(enum glint_scope scope);
/* Whether a part of this role carries a scope's attributes. */
bool glint_scope_is_on(enum glint_scope scope, const struct glint_role *role, bool previous);
#define GLINT_NO_GROUP ((size_t)-1)
struct glint_attribute_row {
    enum glint_scope scope;
    const char *name;
    enum glint_attribute_kind kind;
    size_t offset; /* of the member in the scope's struct */
    size_t group;  /* of the bool that says whether the engine has it */
    bool required;
    enum glint_range range;
    double fallback; /* NaN: none */
    const char *unit, *meaning;
};
const struct glint_attribute_row *glint_attribute_rows(size_t *count);
/* The row's name, with the number of a light in place of NNN. */
const char *glint_attribute_name(const struct glint_attribute_row *row, uint32_t number, char name[64]);
/* The number after `glint.light.`; false if the name is none of a light. */
bool glint_light_number(const char *name, uint32_t *number);
/* EXR's word for how a kind is stored. */
const char *glint_kind_type(enum glint_attribute_kind kind);
/* Names of the values of AXIS, CLIP_Y, CLIP_Z and VOLUME, NULL-terminated; NULL for the other kinds. */
const char *const *glint_kind_names(enum glint_attribute_kind kind);

/* ---- how channels are stored ---- */

/* EXR's words: "half", "float", "uint". */
const char *glint_stored_name(enum glint_stored stored);

/* ---- rules ---- */

enum glint_rule {
#define RULE(id, name, text) GLINT_RULE_##id,
#include "rows/rules.h"
    GLINT_RULE_COUNT
};
struct glint_rule_row {
    const char *name, *text;
};
const struct glint_rule_row *glint_rule_rows(void);

#endif
