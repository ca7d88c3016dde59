/* Converts EXR attributes to the structs of capture.h, by the rows of the registry, and checks them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attributes.h"

struct context {
    struct glint_check *check;
    const struct glint_exr_part_info *part;
    const struct glint_attribute_row *row;
    const char *name; /* the row's, with the number of a light */
};

#define BROKEN(c, rule, ...) glint_violation((c)->check, GLINT_RULE_##rule, (c)->part->name, (c)->name, __VA_ARGS__)
static const double PI = 3.14159265358979324;

bool glint_attribute_is_ours(const char *name) {
    return !strncmp(name, "glint.", 6);
}

static enum glint_exr_attribute_type exr_type(enum glint_attribute_kind kind) {
    static const struct {
        const char *name;
        enum glint_exr_attribute_type type;
    } types[] = {{"m44d", GLINT_EXR_M44D},     {"v3d", GLINT_EXR_V3D},
                 {"v2d", GLINT_EXR_V2D},       {"double", GLINT_EXR_DOUBLE},
                 {"v3f", GLINT_EXR_V3F},       {"int", GLINT_EXR_INT},
                 {"string", GLINT_EXR_STRING}, {"stringvector", GLINT_EXR_STRINGS}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (!strcmp(types[i].name, glint_kind_type(kind))) return types[i].type;
    return GLINT_EXR_OPAQUE;
}

static bool in_range(enum glint_range range, double v) {
    switch (range) {
    case GLINT_RANGE_POSITIVE:
        return v > 0;
    case GLINT_RANGE_NOT_NEGATIVE:
        return v >= 0;
    case GLINT_RANGE_UNIT:
        return v > 0 && v <= 1;
    case GLINT_RANGE_ELEVATION:
        return v >= -90 && v <= 90;
    case GLINT_RANGE_ACUTE:
        return v >= 0 && v < PI / 2;
    case GLINT_RANGE_ANGLE:
        return v >= 0 && v <= PI;
    case GLINT_RANGE_COSINE:
        return v > -1 && v < 1;
    case GLINT_RANGE_ANY:
        break;
    }
    return true;
}

/* ---- matrices ---- */

static bool check_view(struct context *c, const double *m) {
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
        return BROKEN(c, MATRIX, "expected the last row 0 0 0 1, found %g %g %g %g", m[12], m[13], m[14], m[15]);
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            const double dot = m[4 * i] * m[4 * j] + m[4 * i + 1] * m[4 * j + 1] + m[4 * i + 2] * m[4 * j + 2];
            if (!(fabs(dot - (i == j)) <= 1e-3))
                return BROKEN(c, MATRIX, "expected a rotation, found rows %d and %d with the product %g", i, j, dot);
        }
    return true;
}

static bool check_clip(struct context *c, const double *m) {
    static const int zeros[] = {1, 3, 4, 7, 8, 9, 12, 13, 15};
    for (size_t i = 0; i < sizeof zeros / sizeof *zeros; i++)
        if (!(fabs(m[zeros[i]]) <= 1e-9))
            return BROKEN(c, MATRIX, "expected 0 in row %d column %d, found %g", zeros[i] / 4, zeros[i] % 4,
                          m[zeros[i]]);
    if (!(fabs(fabs(m[14]) - 1) <= 1e-9))
        return BROKEN(c, MATRIX, "expected 1 or -1 in row 3 column 2, found %g", m[14]);
    if (m[0] == 0 || m[5] == 0 || m[11] == 0)
        return BROKEN(c, MATRIX, "expected an invertible matrix, found %g, %g and %g for a, b and B", m[0], m[5],
                      m[11]);
    return true;
}

/* By Gauss, with the largest element of a column as the pivot. */
static bool is_singular(const double *matrix) {
    double m[16];
    memcpy(m, matrix, sizeof m);
    for (int k = 0; k < 4; k++) {
        int best = k;
        for (int r = k + 1; r < 4; r++)
            if (fabs(m[4 * r + k]) > fabs(m[4 * best + k])) best = r;
        if (m[4 * best + k] == 0) return true;
        for (int c = 0; c < 4; c++) {
            const double kept = m[4 * k + c];
            m[4 * k + c] = m[4 * best + c];
            m[4 * best + c] = kept;
        }
        for (int r = k + 1; r < 4; r++) {
            const double factor = m[4 * r + k] / m[4 * k + k];
            for (int c = k; c < 4; c++) m[4 * r + c] -= factor * m[4 * k + c];
        }
    }
    return false;
}

static bool decode_direction(struct context *c, const double *n, void *member) {
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(fabs(length - 1) <= 1e-3))
        return BROKEN(c, ATTRIBUTE, "expected a unit vector, found one of length %g", length);
    /* One that was computed in double keeps its bits. */
    const double scale = fabs(length - 1) > 1e-12 ? 1 / length : 1,
                 unit[3] = {scale * n[0], scale * n[1], scale * n[2]};
    memcpy(member, unit, sizeof unit);
    return true;
}

static bool decode_range(struct context *c, const double *n, void *member) {
    memcpy(member, n, 2 * sizeof *n);
    return (n[0] != n[1] && n[0] >= 0 && n[0] <= 1 && n[1] >= 0 && n[1] <= 1) ||
           BROKEN(c, SHADOW, "expected two different depths in [0, 1], found %g and %g", n[0], n[1]);
}

/* ---- lists ---- */

static bool parse_class(const char *text, struct glint_stencil_class *class) {
    unsigned long numbers[2];
    for (int i = 0; i < 2; i++) {
        char *end = NULL;
        if (*text < '0' || *text > '9') return false;
        numbers[i] = strtoul(text, &end, 10);
        if (numbers[i] > UINT32_MAX || *end != (i ? '=' : '/')) return false;
        text = end + 1;
    }
    if (!*text || strlen(text) >= sizeof class->name) return false;
    class->value = (uint32_t)numbers[0];
    class->mask = (uint32_t)numbers[1];
    snprintf(class->name, sizeof class->name, "%s", text);
    return true;
}

static bool decode_classes(struct context *c, const struct glint_exr_attribute *from, struct glint_frame *frame) {
    if (from->count > GLINT_MAX_STENCIL_CLASSES)
        return BROKEN(c, ATTRIBUTE, "expected at most %d classes, found %zu", GLINT_MAX_STENCIL_CLASSES, from->count);
    for (size_t i = 0; i < from->count; i++)
        if (parse_class(from->strings[i], &frame->classes[frame->class_count])) frame->class_count++;
        else if (!BROKEN(c, ATTRIBUTE, "expected value/mask=name, found \"%.60s\"", from->strings[i])) return false;
    return true;
}

static bool is_zero(const double *numbers, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (numbers[i] != 0) return false;
    return true;
}

/* The planes of one attribute. Rows of zeros end the list, so that nothing may follow them: *ended. */
static bool decode_four_planes(struct context *c, const struct glint_exr_attribute *from, struct glint_cubemap *cubemap,
                               bool *ended) {
    for (unsigned r = 0; r < 4; r++) {
        const double *plane = from->numbers + 4 * r;
        if (*ended && !is_zero(plane, 4))
            return BROKEN(c, ATTRIBUTE, "expected no plane after a row of zeros, found one in %s", from->name);
        *ended = is_zero(plane, 4);
        if (*ended) continue;
        if (!isfinite(plane[0]) || !isfinite(plane[1]) || !isfinite(plane[2]) || !isfinite(plane[3]))
            return BROKEN(c, ATTRIBUTE, "expected finite numbers, found %g %g %g %g", plane[0], plane[1], plane[2],
                          plane[3]);
        memcpy(cubemap->planes[cubemap->plane_count++], plane, 4 * sizeof *plane);
    }
    return true;
}

static bool decode_planes(struct context *c, struct glint_cubemap *cubemap) {
    bool ended = false, gap = false;
    for (unsigned i = 0; i < GLINT_MAX_PLANES / 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%02u", c->name, i);
        const struct glint_exr_attribute *from = glint_exr_attribute(c->part, name);
        if (from && gap) return BROKEN(c, ATTRIBUTE, "expected %s after the one before it, found a gap", name);
        gap = !from;
        if (from && from->type != GLINT_EXR_M44D)
            return BROKEN(c, ATTRIBUTE, "expected an m44d attribute, found %s", from->type_name);
        if (from && !decode_four_planes(c, from, cubemap, &ended)) return false;
    }
    return true;
}

static bool check_volume(struct context *c, const struct glint_cubemap *cubemap) {
    if (cubemap->inner == GLINT_VOLUME_BOX)
        for (int i = 0; i < 3; i++)
            if (!(cubemap->box_min[i] < cubemap->box_max[i]))
                return BROKEN(c, VOLUME, "expected boxMin < boxMax, found %g and %g on axis %d", cubemap->box_min[i],
                              cubemap->box_max[i], i);
    if (cubemap->inner == GLINT_VOLUME_SPHERE && !(cubemap->sphere_radius > 0))
        return BROKEN(c, VOLUME, "expected a positive sphereRadius, found %g", cubemap->sphere_radius);
    if (cubemap->inner != GLINT_VOLUME_HULL) return true;
    if (cubemap->plane_count < 4)
        return BROKEN(c, VOLUME, "expected 4 to %d planes, found %u", GLINT_MAX_PLANES, cubemap->plane_count);
    for (uint32_t i = 0; i < cubemap->plane_count; i++)
        if (cubemap->planes[i][0] == 0 && cubemap->planes[i][1] == 0 && cubemap->planes[i][2] == 0)
            return BROKEN(c, VOLUME, "expected a normal that is not zero, found one in plane %u", i);
    return true;
}

/* ---- one attribute ---- */

static bool decode_name(struct context *c, const struct glint_exr_attribute *from, void *member) {
    const char *const *names = glint_kind_names(c->row->kind);
    for (int i = 0; names[i]; i++)
        if (!strcmp(names[i], from->string)) {
            memcpy(member, &i, sizeof i);
            return true;
        }
    return BROKEN(c, ATTRIBUTE, "expected one of its names (\"%s\", …), found \"%.60s\"", names[0], from->string);
}

static bool decode_numbers(struct context *c, const struct glint_exr_attribute *from, void *member) {
    const double *n = from->numbers;
    for (size_t i = 0; i < from->count; i++) {
        if (!isfinite(n[i])) return BROKEN(c, ATTRIBUTE, "expected finite numbers, found %g", n[i]);
        if (!in_range(c->row->range, n[i])) return BROKEN(c, ATTRIBUTE, "expected a value in range, found %g", n[i]);
    }
    switch (c->row->kind) {
    case GLINT_KIND_CAMERA_VIEW:
        memcpy(member, n, 16 * sizeof *n);
        if (!check_view(c, n)) return false;
        glint_camera_make_rigid(member); /* the member is the first of struct glint_camera */
        return true;
    case GLINT_KIND_CAMERA_CLIP:
        memcpy(member, n, 16 * sizeof *n);
        return check_clip(c, n);
    case GLINT_KIND_MATRIX:
        memcpy(member, n, 16 * sizeof *n);
        return !is_singular(n) || BROKEN(c, MATRIX, "expected an invertible matrix, found a singular one");
    case GLINT_KIND_DIRECTION:
        return decode_direction(c, n, member);
    case GLINT_KIND_RANGE:
        return decode_range(c, n, member);
    case GLINT_KIND_PLANE:
        memcpy(member, n, 4 * sizeof *n);
        if (n[0] == 0 && n[1] == 0 && n[2] == 0)
            return BROKEN(c, ATTRIBUTE, "expected a normal that is not zero, found zero");
        return is_zero(n + 4, 12) || BROKEN(c, ATTRIBUTE, "expected zeros below row 0, found other numbers");
    case GLINT_KIND_UINT:
        memcpy(member, &(uint32_t){(uint32_t)(int32_t)n[0]}, 4);
        return true;
    case GLINT_KIND_BOOL:
        memcpy(member, &(bool){n[0] != 0}, sizeof(bool));
        return true;
    case GLINT_KIND_V3FLOAT:
        for (int i = 0; i < 3; i++) memcpy((char *)member + 4 * i, &(float){(float)n[i]}, 4);
        return true;
    default:
        memcpy(member, n, from->count * sizeof *n);
        return true;
    }
}

static bool decode_row(struct context *c, void *to) {
    const struct glint_attribute_row *row = c->row;
    if (row->kind == GLINT_KIND_PLANES) return decode_planes(c, to);
    void *member = (char *)to + row->offset;
    const struct glint_exr_attribute *from = glint_exr_attribute(c->part, c->name);
    if (!from) {
        if (row->kind == GLINT_KIND_RANGE) memcpy(member, (const double[2]){0, 1}, 2 * sizeof(double));
        if (row->kind == GLINT_KIND_DOUBLE && !isnan(row->fallback))
            memcpy(member, &row->fallback, sizeof row->fallback);
        const bool required = row->required && (row->group == GLINT_NO_GROUP || *(bool *)((char *)to + row->group));
        return required ? BROKEN(c, ATTRIBUTE, "missing") : true;
    }
    if (from->type != exr_type(row->kind))
        return BROKEN(c, ATTRIBUTE, "expected type %s, found %s", glint_kind_type(row->kind), from->type_name);
    switch (row->kind) {
    case GLINT_KIND_CLASSES:
        return decode_classes(c, from, to);
    case GLINT_KIND_AXIS:
    case GLINT_KIND_CLIP_Y:
    case GLINT_KIND_CLIP_Z:
    case GLINT_KIND_VOLUME:
        return decode_name(c, from, member);
    default:
        return decode_numbers(c, from, member);
    }
}

static bool decode_scope(struct glint_check *check, const struct glint_exr_part_info *part, enum glint_scope scope,
                         uint32_t number, void *to) {
    char name[64];
    size_t count = 0;
    const struct glint_attribute_row *rows = glint_attribute_rows(&count);
    struct context c = {.check = check, .part = part};
    /* A group exists if one of its attributes does; others that are required are then missing. */
    for (size_t i = 0; i < count; i++)
        if (rows[i].scope == scope && rows[i].group != GLINT_NO_GROUP &&
            glint_exr_attribute(part, glint_attribute_name(&rows[i], number, name)))
            *(bool *)((char *)to + rows[i].group) = true;
    for (size_t i = 0; i < count; i++) {
        if (rows[i].scope != scope) continue;
        c.row = &rows[i];
        c.name = glint_attribute_name(&rows[i], number, name);
        if (!decode_row(&c, to)) return false;
        if (rows[i].kind == GLINT_KIND_PLANES && !check_volume(&c, to)) return false;
    }
    return true;
}

/* ---- lights ---- */

static bool has_light(const struct glint_exr_part_info *part, uint32_t number) {
    uint32_t found;
    for (size_t i = 0; i < part->attribute_count; i++)
        if (glint_light_number(part->attributes[i].name, &found) && found == number) return true;
    return false;
}

static bool decode_lights(struct glint_check *check, const struct glint_exr_part_info *part,
                          struct glint_frame *frame) {
    uint32_t count = 0, number;
    for (; count < GLINT_MAX_LIGHTS && has_light(part, count); count++) {
        struct glint_light *light = &frame->lights[count];
        if (!decode_scope(check, part, GLINT_SCOPE_LIGHT, count, light)) return false;
        if (light->has_cone && !(light->cone.inner_rad <= light->cone.outer_rad && light->cone.outer_rad > 0) &&
            !glint_violation(check, GLINT_RULE_LIGHT, part->name, NULL,
                             "light %03u: expected 0 <= coneInner <= coneOuter, above 0, found %g and %g", count,
                             light->cone.inner_rad, light->cone.outer_rad))
            return false;
    }
    frame->light_count = count;
    for (size_t i = 0; i < part->attribute_count; i++)
        if (glint_light_number(part->attributes[i].name, &number) && number >= count)
            return glint_violation(check, GLINT_RULE_LIGHT, part->name, part->attributes[i].name,
                                   "expected numbers from 000 without a gap, at most %d, found %u lights before it",
                                   GLINT_MAX_LIGHTS, count);
    return true;
}

bool glint_attributes_decode(struct glint_check *check, const struct glint_exr_part_info *part, enum glint_scope scope,
                             void *to) {
    return decode_scope(check, part, scope, 0, to) && (scope != GLINT_SCOPE_FRAME || decode_lights(check, part, to));
}
