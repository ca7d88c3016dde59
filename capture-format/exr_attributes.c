/* Converts attributes between OpenEXRCore and glint. Types unknown to glint are passed on as bytes. */
#include <string.h>

#include "exr_internal.h"

/* Attributes that OpenEXR itself uses, which are written with each part. */
static const char *const own[] = {"channels",
                                  "chunkCount",
                                  "compression",
                                  "dataWindow",
                                  "displayWindow",
                                  "lineOrder",
                                  "maxSamplesPerPixel",
                                  "name",
                                  "pixelAspectRatio",
                                  "screenWindowCenter",
                                  "screenWindowWidth",
                                  "tiles",
                                  "type",
                                  "version"};

/* Sizes of plain types whose bytes are passed on. */
static size_t plain_bytes(exr_attribute_type_t type) {
    switch (type) {
    case EXR_ATTR_BOX2I:
        return sizeof(exr_attr_box2i_t);
    case EXR_ATTR_BOX2F:
        return sizeof(exr_attr_box2f_t);
    case EXR_ATTR_CHROMATICITIES:
        return sizeof(exr_attr_chromaticities_t);
    case EXR_ATTR_KEYCODE:
        return sizeof(exr_attr_keycode_t);
    case EXR_ATTR_M33F:
        return sizeof(exr_attr_m33f_t);
    case EXR_ATTR_M33D:
        return sizeof(exr_attr_m33d_t);
    case EXR_ATTR_M44F:
        return sizeof(exr_attr_m44f_t);
    case EXR_ATTR_RATIONAL:
        return sizeof(exr_attr_rational_t);
    case EXR_ATTR_TILEDESC:
        return sizeof(exr_attr_tiledesc_t);
    case EXR_ATTR_TIMECODE:
        return sizeof(exr_attr_timecode_t);
    case EXR_ATTR_V2I:
        return sizeof(exr_attr_v2i_t);
    case EXR_ATTR_V2F:
        return sizeof(exr_attr_v2f_t);
    case EXR_ATTR_V3I:
        return sizeof(exr_attr_v3i_t);
    default:
        return 0;
    }
}

static const double *numbers_from(struct glint_arena *arena, const void *data, size_t count, bool is_double) {
    double *numbers = glint_arena_take(arena, count * sizeof *numbers);
    for (size_t i = 0; numbers && i < count; i++) {
        float narrow = 0;
        if (is_double) memcpy(&numbers[i], (const char *)data + i * 8, 8);
        else {
            memcpy(&narrow, (const char *)data + i * 4, 4);
            numbers[i] = (double)narrow;
        }
    }
    return numbers;
}

static bool set_numbers(struct glint_arena *arena, struct glint_exr_attribute *out, enum glint_exr_attribute_type type,
                        const void *data, size_t count, bool is_double) {
    out->type = type;
    out->count = count;
    out->numbers = numbers_from(arena, data, count, is_double);
    return out->numbers != NULL;
}

static bool get_strings(struct glint_arena *arena, const exr_attr_string_vector_t *from,
                        struct glint_exr_attribute *out) {
    const size_t count = from->n_strings > 0 ? (size_t)from->n_strings : 0;
    const char **strings = glint_arena_take(arena, count * sizeof *strings);
    for (size_t i = 0; strings && i < count; i++) {
        const exr_attr_string_t *s = &from->strings[i];
        char *copy = glint_arena_take(arena, s->length > 0 ? (size_t)s->length + 1 : 1);
        if (!copy) return false;
        if (s->length > 0) memcpy(copy, s->str, (size_t)s->length);
        strings[i] = copy;
    }
    out->type = GLINT_EXR_STRINGS;
    out->strings = strings;
    out->count = count;
    return strings != NULL;
}

static bool get_bytes(struct glint_arena *arena, const void *data, size_t bytes, struct glint_exr_attribute *out) {
    out->type = GLINT_EXR_OPAQUE;
    out->bytes = glint_arena_copy(arena, data, bytes);
    out->count = bytes;
    return out->bytes != NULL;
}

static bool get_value(struct glint_arena *arena, const exr_attribute_t *from, struct glint_exr_attribute *out) {
    double number = 0;
    switch (from->type) {
    case EXR_ATTR_STRING: {
        char *copy = glint_arena_take(arena, from->string->length > 0 ? (size_t)from->string->length + 1 : 1);
        if (copy && from->string->length > 0) memcpy(copy, from->string->str, (size_t)from->string->length);
        out->type = GLINT_EXR_STRING;
        out->string = copy;
        return copy != NULL;
    }
    case EXR_ATTR_INT:
        number = from->i;
        return set_numbers(arena, out, GLINT_EXR_INT, &number, 1, true);
    case EXR_ATTR_FLOAT:
        return set_numbers(arena, out, GLINT_EXR_FLOAT, &from->f, 1, false);
    case EXR_ATTR_DOUBLE:
        return set_numbers(arena, out, GLINT_EXR_DOUBLE, &from->d, 1, true);
    case EXR_ATTR_V2D:
        return set_numbers(arena, out, GLINT_EXR_V2D, from->v2d, 2, true);
    case EXR_ATTR_V3D:
        return set_numbers(arena, out, GLINT_EXR_V3D, from->v3d, 3, true);
    case EXR_ATTR_V3F:
        return set_numbers(arena, out, GLINT_EXR_V3F, from->v3f, 3, false);
    case EXR_ATTR_M44D:
        return set_numbers(arena, out, GLINT_EXR_M44D, from->m44d, 16, true);
    case EXR_ATTR_FLOAT_VECTOR:
        return set_numbers(arena, out, GLINT_EXR_FLOATS, from->floatvector->arr,
                           from->floatvector->length > 0 ? (size_t)from->floatvector->length : 0, false);
    case EXR_ATTR_STRING_VECTOR:
        return get_strings(arena, from->stringvector, out);
    case EXR_ATTR_COMPRESSION:
    case EXR_ATTR_ENVMAP:
    case EXR_ATTR_LINEORDER:
        return get_bytes(arena, &from->uc, 1, out);
    case EXR_ATTR_PREVIEW:
        return get_bytes(arena, from->preview->rgba, (size_t)4 * from->preview->width * from->preview->height, out);
    case EXR_ATTR_OPAQUE:
        return get_bytes(arena, from->opaque->packed_data, from->opaque->size > 0 ? (size_t)from->opaque->size : 0,
                         out);
    default:
        return get_bytes(arena, plain_bytes(from->type) ? from->rawptr : NULL, plain_bytes(from->type), out);
    }
}

static bool is_own(const char *name) {
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (!strcmp(own[i], name)) return true;
    return false;
}

bool glint_exr_attributes_get(struct glint_exr *exr, size_t part, struct glint_error *err) {
    int32_t count = 0;
    exr_get_attribute_count(exr->context, (int)part, &count);
    struct glint_exr_attribute *all = glint_arena_take(&exr->arena, (size_t)(count > 0 ? count : 0) * sizeof *all);
    if (!all) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory for %d attributes", exr->path, count);
    struct glint_exr_part_info *info = &exr->parts[part].info;
    info->attributes = all;
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *from = NULL;
        if (exr_get_attribute_by_index(exr->context, (int)part, EXR_ATTR_LIST_FILE_ORDER, i, &from) || !from)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: attribute %d cannot be read", exr->path,
                              info->name, i);
        if (is_own(from->name)) continue;
        struct glint_exr_attribute *out = &all[info->attribute_count++];
        out->name = glint_arena_string(&exr->arena, from->name);
        out->type_name = glint_arena_string(&exr->arena, from->type_name);
        if (!out->name || !out->type_name || !get_value(&exr->arena, from, out))
            return glint_fail(err, GLINT_ERROR_MEMORY, "%s: part %s: out of memory for attribute %s", exr->path,
                              info->name, from->name);
    }
    return true;
}

static exr_result_t set_opaque(exr_context_t context, int part, const struct glint_exr_attribute *a) {
    exr_attribute_t *made = NULL;
    if (!strcmp(a->type_name, "preview")) return EXR_ERR_SUCCESS; /* it would show the old pixels */
    if (!strcmp(a->type_name, "envmap"))
        return exr_attr_set_envmap(context, part, a->name, (exr_envmap_t) * (const uint8_t *)a->bytes);
    exr_result_t rv = exr_attr_declare_by_type(context, part, a->name, a->type_name, &made);
    if (rv == EXR_ERR_SUCCESS && made->type != EXR_ATTR_OPAQUE) {
        const bool is_byte = made->type == EXR_ATTR_COMPRESSION || made->type == EXR_ATTR_LINEORDER;
        if ((is_byte ? 1 : plain_bytes(made->type)) != a->count) return EXR_ERR_ATTR_SIZE_MISMATCH;
        if (is_byte) made->uc = *(const uint8_t *)a->bytes;
        else if (a->count) memcpy(made->rawptr, a->bytes, a->count);
        return rv;
    }
    return rv ? rv : exr_attr_set_user(context, part, a->name, a->type_name, (int32_t)a->count, a->bytes);
}

static exr_result_t set_floats(exr_context_t context, int part, const struct glint_exr_attribute *a) {
    float *values = glint_exr_memory_take(a->count * sizeof *values);
    for (size_t i = 0; values && i < a->count; i++) values[i] = (float)a->numbers[i];
    const exr_result_t rv =
        values ? exr_attr_set_float_vector(context, part, a->name, (int32_t)a->count, values) : EXR_ERR_OUT_OF_MEMORY;
    glint_exr_memory_free(values);
    return rv;
}

static exr_result_t set_strings(exr_context_t context, int part, const struct glint_exr_attribute *a) {
    const char **copy = glint_exr_memory_take(a->count * sizeof *copy);
    for (size_t i = 0; copy && i < a->count; i++) copy[i] = a->strings[i];
    const exr_result_t rv =
        copy ? exr_attr_set_string_vector(context, part, a->name, (int32_t)a->count, copy) : EXR_ERR_OUT_OF_MEMORY;
    glint_exr_memory_free(copy);
    return rv;
}

bool glint_exr_attribute_set(exr_context_t context, int part, const struct glint_exr_attribute *a) {
    exr_attr_v2d_t v2;
    exr_attr_v3d_t v3;
    exr_attr_m44d_t m44;
    exr_attr_v3f_t v3f;
    exr_result_t rv = EXR_ERR_INVALID_ARGUMENT;
    switch (a->type) {
    case GLINT_EXR_STRING:
        rv = exr_attr_set_string(context, part, a->name, a->string);
        break;
    case GLINT_EXR_INT:
        rv = exr_attr_set_int(context, part, a->name, (int32_t)a->numbers[0]);
        break;
    case GLINT_EXR_FLOAT:
        rv = exr_attr_set_float(context, part, a->name, (float)a->numbers[0]);
        break;
    case GLINT_EXR_DOUBLE:
        rv = exr_attr_set_double(context, part, a->name, a->numbers[0]);
        break;
    case GLINT_EXR_V2D:
        memcpy(v2.arr, a->numbers, sizeof v2.arr);
        rv = exr_attr_set_v2d(context, part, a->name, &v2);
        break;
    case GLINT_EXR_V3D:
        memcpy(v3.arr, a->numbers, sizeof v3.arr);
        rv = exr_attr_set_v3d(context, part, a->name, &v3);
        break;
    case GLINT_EXR_V3F:
        for (int i = 0; i < 3; i++) v3f.arr[i] = (float)a->numbers[i];
        rv = exr_attr_set_v3f(context, part, a->name, &v3f);
        break;
    case GLINT_EXR_M44D:
        memcpy(m44.m, a->numbers, sizeof m44.m);
        rv = exr_attr_set_m44d(context, part, a->name, &m44);
        break;
    case GLINT_EXR_FLOATS:
        rv = set_floats(context, part, a);
        break;
    case GLINT_EXR_STRINGS:
        rv = set_strings(context, part, a);
        break;
    case GLINT_EXR_OPAQUE:
        rv = set_opaque(context, part, a);
        break;
    }
    return rv == EXR_ERR_SUCCESS;
}

const struct glint_exr_attribute *glint_exr_attribute(const struct glint_exr_part_info *part, const char *name) {
    for (size_t i = 0; i < part->attribute_count; i++)
        if (!strcmp(part->attributes[i].name, name)) return &part->attributes[i];
    return NULL;
}
