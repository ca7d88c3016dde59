/* Sets attributes of a capture from text, by the rows of the registry. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edit_internal.h"

#define PREFIX "glint."

/* ---- Keys: the attribute rows, then the encodings, then the storage formats ---- */

struct row {
    const struct glint_attribute_row *attribute;
    const struct glint_encoding_row *encoding;
    bool storage;
    char numbered[64]; /* the name of a light's attribute, with its number */
};

static bool row_at(size_t i, struct row *row) {
    size_t attributes, encodings;
    const struct glint_attribute_row *a = glint_attribute_rows(&attributes);
    const struct glint_encoding_row *e = glint_encoding_rows(&encodings);
    *row = (struct row){0};
    if (i < attributes) row->attribute = &a[i];
    else if (i - attributes < encodings) row->encoding = &e[i - attributes];
    else row->storage = i == attributes + encodings;
    return row->attribute || row->encoding || row->storage;
}

static const char *attribute_of(const struct row *row) {
    if (row->numbered[0]) return row->numbered;
    return row->attribute ? row->attribute->name : row->encoding ? row->encoding->attribute : GLINT_STORAGE_ATTRIBUTE;
}

/* Whether a key without "glint." means the row; the number of a light is kept. */
static bool row_is(struct row *row, const char *key) {
    char name[256];
    uint32_t number;
    snprintf(name, sizeof name, PREFIX "%s", key);
    if (row->attribute && row->attribute->scope == GLINT_SCOPE_LIGHT && glint_light_number(name, &number))
        glint_attribute_name(row->attribute, number, row->numbered);
    return !strcmp(attribute_of(row), name) && !strstr(name, ".NNN.");
}

/* How many numbers the text of a kind has; 0: it is no list of numbers. */
static size_t number_count(enum glint_attribute_kind kind) {
    switch (kind) {
    case GLINT_KIND_CAMERA_VIEW:
    case GLINT_KIND_CAMERA_CLIP:
    case GLINT_KIND_MATRIX:
        return 16;
    case GLINT_KIND_PLANE:
        return 4;
    case GLINT_KIND_V3:
    case GLINT_KIND_V3FLOAT:
    case GLINT_KIND_DIRECTION:
        return 3;
    case GLINT_KIND_V2:
    case GLINT_KIND_RANGE:
        return 2;
    case GLINT_KIND_DOUBLE:
    case GLINT_KIND_UINT:
    case GLINT_KIND_BOOL:
        return 1;
    default:
        return 0;
    }
}

static const char *form_of(const struct row *row) {
    if (row->storage) return "channel=format, …";
    if (row->encoding) return "a name";
    switch (row->attribute->kind) {
    case GLINT_KIND_CAMERA_VIEW:
    case GLINT_KIND_CAMERA_CLIP:
    case GLINT_KIND_MATRIX:
        return "16 numbers, row by row";
    case GLINT_KIND_PLANE:
        return "4 numbers";
    case GLINT_KIND_PLANES:
        return "4 numbers for each plane";
    case GLINT_KIND_V3:
    case GLINT_KIND_V3FLOAT:
    case GLINT_KIND_DIRECTION:
        return "3 numbers";
    case GLINT_KIND_V2:
    case GLINT_KIND_RANGE:
        return "2 numbers";
    case GLINT_KIND_UINT:
        return "a whole number";
    case GLINT_KIND_BOOL:
        return "0 or 1";
    case GLINT_KIND_CLASSES:
        return "value/mask=name, …";
    case GLINT_KIND_DOUBLE:
        return "a number";
    default:
        return "a name";
    }
}

bool glint_edit_key(size_t i, struct glint_edit_key *key) {
    static const enum glint_edit_scope scopes[] = {
        [GLINT_SCOPE_FRAME] = GLINT_EDIT_FRAME,       [GLINT_SCOPE_LIGHT] = GLINT_EDIT_FRAME,
        [GLINT_SCOPE_INDIRECT] = GLINT_EDIT_INDIRECT, [GLINT_SCOPE_SHADOW] = GLINT_EDIT_SHADOW,
        [GLINT_SCOPE_VOLUME] = GLINT_EDIT_VOLUME,     [GLINT_SCOPE_TRUTH_OCCLUSION] = GLINT_EDIT_TRUTH,
        [GLINT_SCOPE_FROXELS] = GLINT_EDIT_FROXELS,   [GLINT_SCOPE_TRUTH_SUN] = GLINT_EDIT_TRUTH,
        [GLINT_SCOPE_CUBEMAP] = GLINT_EDIT_CUBEMAP,   [GLINT_SCOPE_SKY] = GLINT_EDIT_SKY,
        [GLINT_SCOPE_PROBE] = GLINT_EDIT_PROBE,       [GLINT_SCOPE_PLANAR] = GLINT_EDIT_PLANAR};
    struct row row;
    if (!row_at(i, &row)) return false;
    const struct glint_attribute_row *a = row.attribute;
    *key = (struct glint_edit_key){.name = attribute_of(&row) + strlen(PREFIX),
                                   .scope = a              ? scopes[a->scope]
                                            : row.encoding ? GLINT_EDIT_ENCODING
                                                           : GLINT_EDIT_STORAGE,
                                   .form = form_of(&row),
                                   .required = a && a->required,
                                   .unit = a ? a->unit : "",
                                   .meaning = a              ? a->meaning
                                              : row.encoding ? "how the channels are stored"
                                                             : "the engine's own format of each channel"};
    return true;
}

static const char *name_at(const struct row *row, size_t k) {
    const char *const *names = row->attribute ? glint_kind_names(row->attribute->kind) : NULL;
    if (row->encoding) return k < (size_t)row->encoding->count ? row->encoding->values[k].name : NULL;
    for (size_t i = 0; names && names[i]; i++)
        if (i == k) return names[i];
    return NULL;
}

const char *glint_edit_value_name(size_t i, size_t k) {
    struct row row;
    return row_at(i, &row) ? name_at(&row, k) : NULL;
}

/* ---- Values ---- */

struct value {
    struct glint_edit *edit;
    const char *key, *text;
    struct glint_error *err;
};

static bool refuse(const struct value *v, const char *expected) {
    return glint_fail(v->err, GLINT_ERROR_USAGE, "%s: expected %s, found \"%.80s\"", v->key, expected, v->text);
}

/* Numbers that are separated by commas; the count, or 0 if the text is anything else or has more than `capacity`. */
static size_t parse_numbers(const char *text, double *numbers, size_t capacity) {
    for (size_t count = 0; count < capacity;) {
        char *end;
        numbers[count++] = strtod(text, &end);
        if (end == text) return 0;
        if (!*end) return count;
        if (*end != ',') return 0;
        text = end + 1;
    }
    return 0;
}

static bool parse_names(const struct value *v, const struct row *row) {
    char known[300] = "one of";
    const char *name;
    for (size_t k = 0; (name = name_at(row, k)) != NULL; k++) {
        if (!strcmp(name, v->text)) return true;
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s %s", k ? "," : "", name);
    }
    return refuse(v, known);
}

static bool set_numbers(const struct value *v, size_t part, const char *name, const char *type, const double *numbers,
                        size_t count) {
    static const struct {
        const char *name;
        enum glint_exr_attribute_type type;
    } types[] = {{"m44d", GLINT_EXR_M44D},  {"v3d", GLINT_EXR_V3D}, {"v2d", GLINT_EXR_V2D},
                 {"v3f", GLINT_EXR_V3F},    {"int", GLINT_EXR_INT}, {"double", GLINT_EXR_DOUBLE},
                 {"float", GLINT_EXR_FLOAT}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (!strcmp(types[i].name, type))
            return glint_edit_set(
                v->edit, part,
                &(struct glint_exr_attribute){.name = name, .type = types[i].type, .numbers = numbers, .count = count},
                v->err);
    return refuse(v, "an attribute of a simple type");
}

static bool set_string(const struct value *v, size_t part, const char *name) {
    return glint_edit_set(v->edit, part,
                          &(struct glint_exr_attribute){.name = name, .type = GLINT_EXR_STRING, .string = v->text},
                          v->err);
}

static bool set_numeric(const struct value *v, size_t part, const char *name, const struct glint_attribute_row *row) {
    double numbers[17] = {0};
    const size_t wanted = number_count(row->kind), count = parse_numbers(v->text, numbers, 17);
    const bool whole = row->kind == GLINT_KIND_UINT || row->kind == GLINT_KIND_BOOL;
    const double limit = row->kind == GLINT_KIND_BOOL ? 1 : UINT32_MAX;
    if (count != wanted) return refuse(v, form_of(&(struct row){.attribute = row}));
    if (whole && !(numbers[0] >= 0 && numbers[0] <= limit && numbers[0] == (double)(uint32_t)numbers[0]))
        return refuse(v, form_of(&(struct row){.attribute = row}));
    if (whole) numbers[0] = (int32_t)(uint32_t)numbers[0]; /* EXR has no unsigned attributes */
    return set_numbers(v, part, name, glint_kind_type(row->kind), numbers, row->kind == GLINT_KIND_PLANE ? 16 : wanted);
}

static void plane_name(char name[64], const char *attribute, unsigned i) {
    snprintf(name, 64, "%.60s.%02u", attribute, i);
}

/* A hull is stored four planes an attribute. */
static bool set_planes(const struct value *v, size_t part, const char *attribute) {
    double numbers[4 * GLINT_MAX_PLANES + 1] = {0};
    char name[64];
    const size_t count = *v->text ? parse_numbers(v->text, numbers, 4 * GLINT_MAX_PLANES + 1) : 0;
    if (*v->text && (count == 0 || count % 4 != 0 || count > 4 * GLINT_MAX_PLANES))
        return refuse(v, "4 numbers for each of up to 64 planes");
    for (unsigned i = 0; i < GLINT_MAX_PLANES / 4; i++) {
        plane_name(name, attribute, i);
        if (16 * i >= count) glint_edit_unset(v->edit, part, name);
        else if (!set_numbers(v, part, name, "m44d", numbers + 16 * i, 16)) return false;
    }
    return true;
}

/* The items of a list that is separated by commas, in the edit's arena; NULL if memory is exhausted. */
static const char **split(const struct value *v, size_t *count) {
    char *copy = glint_arena_string(&v->edit->arena, v->text);
    const char **items = glint_arena_take(&v->edit->arena, (strlen(v->text) + 1) * sizeof *items);
    *count = 0;
    if (!copy || !items) {
        glint_fail(v->err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    for (char *comma; copy; copy = comma) {
        items[(*count)++] = copy;
        comma = strchr(copy, ',');
        if (comma) *comma++ = 0;
    }
    return items;
}

static bool set_strings(const struct value *v, size_t part, const char *name, const char **items, size_t count) {
    return glint_edit_set(
        v->edit, part,
        &(struct glint_exr_attribute){.name = name, .type = GLINT_EXR_STRINGS, .strings = items, .count = count},
        v->err);
}

static bool set_classes(const struct value *v, size_t part, const char *name) {
    size_t count;
    const char **items = split(v, &count);
    return items && set_strings(v, part, name, items, count);
}

static bool same_channel(const char *a, const char *b) {
    const size_t length = strcspn(a, "=");
    return strcspn(b, "=") == length && !strncmp(a, b, length);
}

/* Entries of the named channels are replaced, those of other channels stay. */
static bool set_storage(const struct value *v, size_t part) {
    const struct glint_exr_part_info *info = &v->edit->parts[part].info;
    const struct glint_exr_attribute *old = glint_exr_attribute(info, GLINT_STORAGE_ATTRIBUTE);
    size_t count, kept = 0;
    const char **items = split(v, &count);
    const char **all = glint_arena_take(&v->edit->arena, (count + (old ? old->count : 0) + 1) * sizeof *all);
    if (!items || !all) return glint_fail(v->err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t k = 0; k < count; k++) {
        bool found = false;
        for (size_t c = 0; c < info->channel_count; c++) found |= same_channel(items[k], info->channels[c].name);
        if (!strchr(items[k], '=') || !strchr(items[k], '=')[1] || !found)
            return refuse(v, "channel=format with channels of the part");
    }
    for (size_t i = 0; old && old->type == GLINT_EXR_STRINGS && i < old->count; i++) {
        bool replaced = false;
        for (size_t k = 0; k < count; k++) replaced |= same_channel(items[k], old->strings[i]);
        if (!replaced) all[kept++] = old->strings[i];
    }
    memcpy(all + kept, items, count * sizeof *items);
    return set_strings(v, part, GLINT_STORAGE_ATTRIBUTE, all, kept + count);
}

/* ---- One part ---- */

static bool set_row(const struct value *v, size_t part, const struct row *row) {
    const char *name = attribute_of(row);
    const struct glint_attribute_row *a = row->attribute;
    if (!a && !glint_edit_resolve(v->edit, &v->edit->parts[part], v->err)) return false;
    if (a && a->kind == GLINT_KIND_PLANES) return set_planes(v, part, a->name);
    if (!*v->text) return glint_edit_unset(v->edit, part, name), true;
    if (row->storage) return set_storage(v, part);
    if (a && a->kind == GLINT_KIND_CLASSES) return set_classes(v, part, name);
    if (a && number_count(a->kind)) return set_numeric(v, part, name, a);
    return parse_names(v, row) && set_string(v, part, name);
}

/* An attribute that glint does not know keeps its type. */
static bool set_foreign(const struct value *v, size_t part, const struct glint_exr_attribute *old) {
    double numbers[17] = {0};
    if (!*v->text) return glint_edit_unset(v->edit, part, old->name), true;
    if (old->type == GLINT_EXR_STRING) return set_string(v, part, old->name);
    if (old->type == GLINT_EXR_STRINGS || old->type == GLINT_EXR_OPAQUE || old->type == GLINT_EXR_FLOATS)
        return refuse(v, "an attribute of numbers or one string");
    if (parse_numbers(v->text, numbers, 17) != old->count) return refuse(v, "as many numbers as the attribute has");
    return set_numbers(v, part, old->name, old->type_name, numbers, old->count);
}

static bool has_encoding(const struct glint_edit_part *part, const char *which) {
    const struct glint_role *role = glint_edit_role(part);
    const bool space = !strcmp(which, "normal_space");
    for (size_t c = 0; role && c < part->info.channel_count; c++) {
        const struct glint_role_channel *channel = glint_role_channel_find(role, part->info.channels[c].name);
        if (channel && (!strcmp(channel->encoding, which) || (space && strstr(channel->encoding, "normal"))))
            return true;
    }
    return false;
}

static bool applies(const struct glint_edit_part *part, const struct row *row, const char *value) {
    const struct glint_role *role = glint_edit_role(part);
    if (!role) return false;
    if (row->encoding) return has_encoding(part, row->encoding->which);
    if (row->attribute)
        return glint_scope_is_on(row->attribute->scope, role, !strncmp(part->info.name, "previous.", 9));
    for (size_t c = 0; c < part->info.channel_count; c++)
        if (!*value || same_channel(value, part->info.channels[c].name)) return true;
    return false;
}

/* Whether the filter means the part: its name, or, where no part has it, the beginning of its name. */
static bool is_named(const struct glint_edit *edit, size_t p, const char *filter) {
    const char *part = edit->parts[p].info.name;
    const size_t length = filter ? strlen(filter) : 0;
    if (!filter || !strcmp(part, filter)) return true;
    for (size_t i = 0; i < edit->count; i++)
        if (!strcmp(edit->parts[i].info.name, filter)) return false;
    return !strncmp(part, filter, length) && part[length] == '.';
}

static void say_set(const struct value *v, size_t part, const char *name) {
    if (*v->text) glint_edit_say(v->edit, "%s: %s is %.200s", v->edit->parts[part].info.name, name, v->text);
    else glint_edit_say(v->edit, "%s: %s is removed", v->edit->parts[part].info.name, name);
}

/* Sets the key of one row on each part that it applies to; *count receives their number. */
static bool assign_row(const struct value *v, const char *filter, const struct row *row, size_t *count) {
    for (size_t p = 0; p < v->edit->count; p++) {
        if (!is_named(v->edit, p, filter) || !applies(&v->edit->parts[p], row, v->text)) continue;
        if (!set_row(v, p, row)) return false;
        say_set(v, p, attribute_of(row));
        ++*count;
    }
    return true;
}

/* Sets attributes of others. What only the format may have is removed where it may not be or is misspelt, so that the file can be mended. */
static bool assign_other(const struct value *v, const char *filter, const char *name, size_t *count) {
    if (glint_attribute_is_ours(name) && *v->text) return true;
    for (size_t p = 0; p < v->edit->count; p++) {
        const struct glint_exr_attribute *old = glint_exr_attribute(&v->edit->parts[p].info, name);
        if (!old || !is_named(v->edit, p, filter)) continue;
        if (!set_foreign(v, p, old)) return false;
        say_set(v, p, name);
        ++*count;
    }
    return true;
}

bool glint_edit_assign(struct glint_edit *edit, const char *filter, const char *key, const char *text,
                       struct glint_error *err) {
    const struct value v = {edit, key, text, err};
    const char *name = strncmp(key, PREFIX, strlen(PREFIX)) ? key : key + strlen(PREFIX);
    bool known = false;
    size_t count = 0;
    struct row row;
    char full[256];
    /* Cameras have the same names on gbuffer and on planar maps; the frame's row comes first. */
    for (size_t i = 0; row_at(i, &row) && !count; i++) {
        if (!row_is(&row, name)) continue;
        known = true;
        snprintf(full, sizeof full, "%s", attribute_of(&row));
        if (!assign_row(&v, filter, &row, &count)) return false;
    }
    if (!count && !assign_other(&v, filter, known ? full : key, &count)) return false;
    return count ||
           glint_fail(err, GLINT_ERROR_USAGE, known ? "%s: no part%s%s of %s takes it" : "%s: no such key%s%s in %s",
                      key, filter ? " " : "", filter ? filter : "", edit->exr->path);
}
