/* What capture-format's writer does not take: parts that glint does not know, and attributes of rarer types. A second file is written
   from the first, with them added. */
#include "extras.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct extra {
    char *part; /* the part that has the attribute, */
    struct glint_exr_attribute attribute;
    void *memory[4]; /* what the attribute points to */
};

struct unknown {
    struct glint_exr_part part;
    struct glint_exr_channel *channels;
    char *text; /* names, one NUL-terminated after the other */
};

struct extras {
    struct extra *attributes;
    size_t attribute_count, attribute_room;
    struct unknown *parts;
    size_t part_count;
};

struct extras *extras_create(void) {
    return calloc(1, sizeof(struct extras));
}

static void finish_unknown(struct unknown *unknown) {
    for (size_t c = 0; c < unknown->part.channel_count; c++) {
        free((void *)unknown->channels[c].name);
        free((void *)unknown->channels[c].data);
    }
    free(unknown->channels);
    free(unknown->text);
}

void extras_destroy(struct extras **extras) {
    if (!*extras) return;
    for (size_t i = 0; i < (*extras)->attribute_count; i++) {
        struct extra *extra = &(*extras)->attributes[i];
        for (int k = 0; k < 4; k++) free(extra->memory[k]);
        free(extra->part);
    }
    for (size_t i = 0; i < (*extras)->part_count; i++) finish_unknown(&(*extras)->parts[i]);
    free((*extras)->attributes);
    free((*extras)->parts);
    free(*extras);
    *extras = NULL;
}

bool extras_are_empty(const struct extras *extras) {
    return !extras->attribute_count && !extras->part_count;
}

/* ---- Attributes ---- */

static const struct {
    const char *name, *exr;
    enum glint_exr_attribute_type type;
    size_t count; /* numbers; 0: any */
} types[] = {
    {"string", "string", GLINT_EXR_STRING, 0},
    {"int", "int", GLINT_EXR_INT, 1},
    {"float", "float", GLINT_EXR_FLOAT, 1},
    {"double", "double", GLINT_EXR_DOUBLE, 1},
    {"v2d", "v2d", GLINT_EXR_V2D, 2},
    {"v3d", "v3d", GLINT_EXR_V3D, 3},
    {"v3f", "v3f", GLINT_EXR_V3F, 3},
    {"m44d", "m44d", GLINT_EXR_M44D, 16},
    {"floats", "floatvector", GLINT_EXR_FLOATS, 0},
    {"strings", "stringvector", GLINT_EXR_STRINGS, 0},
    {"opaque", "", GLINT_EXR_OPAQUE, 0},
};

static bool expected(const struct node *node, const char *what, struct glint_error *err) {
    return node_fail(node, err, GLINT_ERROR_FORMAT, "value: expected %s, found another value", what);
}

/* Numbers that JSON has not are texts. */
static bool read_number(const json_t *item, double *out) {
    const char *text = json_string_value(item);
    *out = !text                   ? json_number_value(item)
           : !strcmp(text, "nan")  ? (double)NAN
           : !strcmp(text, "inf")  ? (double)INFINITY
           : !strcmp(text, "-inf") ? -(double)INFINITY
                                   : 0;
    return json_is_number(item) || *out != 0;
}

static bool read_numbers(struct extra *extra, const struct node *node, const json_t *value, size_t count,
                         struct glint_error *err) {
    const bool list = json_is_array(value);
    const size_t found = list ? json_array_size(value) : 1;
    char what[64];
    snprintf(what, sizeof what, count ? "%zu number%s" : "a list of numbers", count, count == 1 ? "" : "s");
    if ((count && found != count) || (!count && !list)) return expected(node, what, err);
    double *numbers = calloc(found + 1, sizeof *numbers);
    extra->memory[1] = numbers;
    if (!numbers) return node_no_memory(node, err);
    for (size_t i = 0; i < found; i++) {
        const json_t *item = list ? json_array_get(value, i) : value;
        if (!read_number(item, &numbers[i])) return expected(node, what, err);
    }
    if (extra->attribute.type == GLINT_EXR_INT &&
        (!json_is_integer(value) || numbers[0] < -2147483648.0 || numbers[0] > 2147483647.0))
        return expected(node, "an integer of 32 bits", err);
    extra->attribute.numbers = numbers;
    extra->attribute.count = found;
    return true;
}

static bool read_strings(struct extra *extra, const struct node *node, const json_t *value, struct glint_error *err) {
    const size_t count = json_array_size(value);
    const char **strings = calloc(count + 1, sizeof *strings);
    extra->memory[1] = strings;
    if (!strings) return node_no_memory(node, err);
    if (!json_is_array(value)) return expected(node, "a list of texts", err);
    for (size_t i = 0; i < count; i++) {
        strings[i] = json_string_value(json_array_get(value, i)); /* lives as long as the manifest */
        if (!strings[i]) return expected(node, "a list of texts", err);
    }
    extra->attribute.strings = strings;
    extra->attribute.count = count;
    return true;
}

static int digit_of(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

static bool read_bytes(struct extra *extra, const struct node *node, const json_t *value, struct glint_error *err) {
    const char *text = json_string_value(value), *name = node_text(node, "type_name");
    const size_t digits = text ? strlen(text) : 1;
    if (digits % 2) return expected(node, "hexadecimal bytes", err);
    if (!name || !name[0] || strlen(name) > 255)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "opaque: expected a type_name of 1 to 255 bytes");
    uint8_t *bytes = calloc(digits / 2 + 1, 1);
    extra->memory[1] = bytes;
    if (!bytes) return node_no_memory(node, err);
    for (size_t i = 0; i < digits; i += 2) {
        const int high = digit_of(text[i]), low = digit_of(text[i + 1]);
        if (high < 0 || low < 0) return expected(node, "hexadecimal bytes", err);
        bytes[i / 2] = (uint8_t)(16 * high + low);
    }
    extra->attribute.bytes = bytes;
    extra->attribute.count = digits / 2;
    extra->attribute.type_name = name;
    return true;
}

/* One attribute in the form that glint_exr_write takes. */
static bool read_one(struct extra *extra, const struct node *node, struct glint_error *err) {
    const json_t *value = node->value;
    const char *type = json_is_string(value)    ? "string"
                       : json_is_integer(value) ? "int"
                       : json_is_real(value)    ? "double"
                                                : node_text(node, "type");
    if (json_is_object(value)) value = json_object_get(value, "value");
    size_t row = 0;
    while (strcmp(types[row].name, type)) row++;
    extra->attribute = (struct glint_exr_attribute){
        .name = node->key, .type = types[row].type, .type_name = types[row].exr, .count = 1};
    if (types[row].type == GLINT_EXR_OPAQUE) return read_bytes(extra, node, value, err);
    if (types[row].type == GLINT_EXR_STRINGS) return read_strings(extra, node, value, err);
    if (types[row].type != GLINT_EXR_STRING) return read_numbers(extra, node, value, types[row].count, err);
    extra->attribute.string = json_string_value(value);
    return extra->attribute.string != NULL || expected(node, "a text", err);
}

static bool is_simple(const struct glint_exr_attribute *attribute) {
    return attribute->type == GLINT_EXR_STRING || attribute->type == GLINT_EXR_INT ||
           attribute->type == GLINT_EXR_DOUBLE;
}

/* Names that OpenEXR gives a meaning of its own; a file with two of them, or one of another type, is no OpenEXR file. */
static bool is_reserved(const char *name) {
    static const char *const names[] = {"channels",
                                        "compression",
                                        "dataWindow",
                                        "displayWindow",
                                        "lineOrder",
                                        "pixelAspectRatio",
                                        "screenWindowCenter",
                                        "screenWindowWidth",
                                        "tiles",
                                        "name",
                                        "type",
                                        "version",
                                        "chunkCount",
                                        "view",
                                        "maxSamplesPerPixel"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(name, names[i])) return true;
    return !strncmp(name, "glint.", 6);
}

static struct extra *add_extra(struct extras *extras) {
    if (extras->attribute_count == extras->attribute_room) {
        const size_t room = extras->attribute_room ? 2 * extras->attribute_room : 16;
        struct extra *more = realloc(extras->attributes, room * sizeof *more);
        if (!more) return NULL;
        extras->attributes = more;
        extras->attribute_room = room;
    }
    struct extra *extra = &extras->attributes[extras->attribute_count++];
    *extra = (struct extra){.part = NULL};
    return extra;
}

bool attributes_read(const struct part *part, struct extras *extras, struct glint_attribute **simple, size_t *count,
                     struct glint_error *err) {
    const struct node all = node_child(&part->node, "attributes");
    *count = 0;
    *simple = calloc(json_object_size(all.value) + 1, sizeof **simple);
    if (!*simple) return node_no_memory(&all, err);
    for (void *at = json_object_iter(all.value); at; at = json_object_iter_next(all.value, at)) {
        const struct node node = node_child(&all, json_object_iter_key(at));
        struct extra *extra = add_extra(extras);
        if (!extra) return node_no_memory(&node, err);
        if (!node.key[0] || strlen(node.key) > 255 || is_reserved(node.key))
            return node_fail(&node, err, GLINT_ERROR_FORMAT,
                             "expected a name of 1 to 255 bytes that neither OpenEXR nor glint. reserves");
        if (!read_one(extra, &node, err)) return false;
        if (part->role && is_simple(&extra->attribute)) {
            (*simple)[(*count)++] =
                (struct glint_attribute){.name = node.key,
                                         .type = extra->attribute.type == GLINT_EXR_STRING ? GLINT_ATTRIBUTE_STRING
                                                 : extra->attribute.type == GLINT_EXR_INT  ? GLINT_ATTRIBUTE_INT
                                                                                           : GLINT_ATTRIBUTE_DOUBLE,
                                         .string = extra->attribute.string,
                                         .number = extra->attribute.numbers ? extra->attribute.numbers[0] : 0};
            free(extra->memory[1]);
            extras->attribute_count--;
        } else if (!(extra->part = strdup(part->name))) return node_no_memory(&node, err);
    }
    return true;
}

/* ---- Parts ---- */

bool extras_add_part(struct extras *extras, struct part *part, struct glint_error *err) {
    struct unknown *more = realloc(extras->parts, (extras->part_count + 1) * sizeof *more);
    if (!more) return node_no_memory(&part->node, err);
    extras->parts = more;
    struct unknown *unknown = &more[extras->part_count++];
    *unknown = (struct unknown){.channels = calloc(part->count, sizeof *unknown->channels), .text = strdup(part->name)};
    if (!unknown->channels || !unknown->text) return node_no_memory(&part->node, err);
    unknown->part = (struct glint_exr_part){
        .name = unknown->text, .width = part->width, .height = part->height, .channels = unknown->channels};
    for (size_t i = 0; i < part->count; i++) {
        struct channel *channel = &part->channels[i];
        char *name = strdup(channel->name);
        if (!name) return node_no_memory(&part->node, err);
        unknown->channels[unknown->part.channel_count++] =
            (struct glint_exr_channel){.name = name, .stored = channel->stored, .data = channel->data};
        channel->data = NULL;
    }
    return true;
}

/* ---- The second file ---- */

static bool copy_channels(struct glint_exr *exr, size_t p, struct unknown *copy, struct glint_error *err) {
    static const enum glint_type kinds[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *from = glint_exr_part(exr, p);
    for (size_t c = 0; c < from->channel_count; c++) {
        const enum glint_stored stored = from->channels[c].stored;
        char *name = strdup(from->channels[c].name);
        void *data = malloc((size_t)from->width * from->height * 4 + 1);
        copy->channels[copy->part.channel_count++] =
            (struct glint_exr_channel){.name = name, .stored = stored, .data = data};
        if (!name || !data) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        const char *wanted = name;
        if (!glint_exr_read(exr, p, &wanted, 1, kinds[stored], data, 0, err)) return false;
    }
    return true;
}

/* The part's own attributes, and those that were added to it; in *list, malloc'd. */
static bool join_attributes(const struct extras *extras, const struct glint_exr_attribute *own, size_t own_count,
                            struct glint_exr_part *part, struct glint_exr_attribute **list, struct glint_error *err) {
    *list = calloc(own_count + extras->attribute_count + 1, sizeof **list);
    if (!*list) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (own_count) memcpy(*list, own, own_count * sizeof *own);
    part->attributes = *list;
    part->attribute_count = own_count;
    for (size_t i = 0; i < extras->attribute_count; i++)
        if (!strcmp(extras->attributes[i].part, part->name))
            (*list)[part->attribute_count++] = extras->attributes[i].attribute;
    return true;
}

bool extras_write(const struct extras *extras, const char *from, const char *to, uint32_t threads,
                  struct glint_error *err) {
    struct glint_exr *exr = glint_exr_open(from, NULL, err);
    const size_t known = exr ? glint_exr_part_count(exr) : 0, count = known + extras->part_count;
    struct glint_exr_part *parts = calloc(count + 1, sizeof *parts);
    struct glint_exr_attribute **lists = calloc(count + 1, sizeof *lists);
    struct unknown *copies = calloc(known + 1, sizeof *copies);
    bool ok = exr && ((parts && lists && copies) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory"));
    for (size_t i = 0; ok && i < known; i++) {
        const struct glint_exr_part_info *info = glint_exr_part(exr, i);
        copies[i].channels = calloc(info->channel_count + 1, sizeof *copies[i].channels);
        copies[i].part = (struct glint_exr_part){
            .name = info->name, .width = info->width, .height = info->height, .channels = copies[i].channels};
        ok = (copies[i].channels || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) &&
             copy_channels(exr, i, &copies[i], err);
        parts[i] = copies[i].part;
        ok = ok && join_attributes(extras, info->attributes, info->attribute_count, &parts[i], &lists[i], err);
    }
    for (size_t i = known; ok && i < count; i++) {
        parts[i] = extras->parts[i - known].part;
        ok = join_attributes(extras, NULL, 0, &parts[i], &lists[i], err);
    }
    ok = ok && glint_exr_write(to, parts, count, threads, err);
    for (size_t i = 0; copies && i < known; i++) finish_unknown(&copies[i]);
    for (size_t i = 0; lists && i < count; i++) free(lists[i]);
    free(copies);
    free(lists);
    free(parts);
    glint_exr_close(&exr);
    return ok;
}
