/* Converts the structs of capture.h to EXR attributes, by the rows of the registry. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "attributes.h"

struct glint_exr_attribute *glint_attribute_push(struct glint_arena *arena, struct glint_attribute_list *list) {
    if (list->count == list->capacity) {
        const size_t capacity = list->capacity ? 2 * list->capacity : 32;
        struct glint_exr_attribute *more = glint_arena_take(arena, capacity * sizeof *more);
        if (!more) return NULL;
        if (list->count) memcpy(more, list->all, list->count * sizeof *more);
        list->all = more;
        list->capacity = capacity;
    }
    return &list->all[list->count++];
}

bool glint_attribute_push_string(struct glint_arena *arena, struct glint_attribute_list *list, const char *name,
                                 const char *value) {
    struct glint_exr_attribute *to = glint_attribute_push(arena, list);
    if (!to) return false;
    to->name = glint_arena_string(arena, name);
    to->type = GLINT_EXR_STRING;
    to->string = glint_arena_string(arena, value);
    return to->name && to->string;
}

static bool push_numbers(struct glint_arena *arena, struct glint_attribute_list *list, const char *name,
                         enum glint_exr_attribute_type type, const double *numbers, size_t count) {
    struct glint_exr_attribute *to = glint_attribute_push(arena, list);
    if (!to) return false;
    to->name = glint_arena_string(arena, name);
    to->type = type;
    to->count = count;
    to->numbers = glint_arena_copy(arena, numbers, count * sizeof *numbers);
    return to->name && to->numbers;
}

static bool push_classes(struct glint_arena *arena, struct glint_attribute_list *list, const char *name,
                         const struct glint_frame *frame) {
    if (frame->class_count > GLINT_MAX_STENCIL_CLASSES) return false;
    if (!frame->class_count) return true;
    const char **strings = glint_arena_take(arena, frame->class_count * sizeof *strings);
    struct glint_exr_attribute *to = glint_attribute_push(arena, list);
    if (!strings || !to) return false;
    for (uint32_t i = 0; i < frame->class_count; i++) {
        const struct glint_stencil_class *class = &frame->classes[i];
        char text[64];
        snprintf(text, sizeof text, "%u/%u=%.31s", class->value, class->mask, class->name);
        strings[i] = glint_arena_string(arena, text);
        if (!strings[i]) return false;
    }
    *to = (struct glint_exr_attribute){
        .name = name, .type = GLINT_EXR_STRINGS, .strings = strings, .count = frame->class_count};
    return true;
}

/* EXR has no attribute type for a list of doubles, so four planes are stored in a matrix. */
static bool push_planes(struct glint_arena *arena, struct glint_attribute_list *list, const char *name,
                        const struct glint_cubemap *cubemap) {
    if (cubemap->inner != GLINT_VOLUME_HULL) return true;
    if (cubemap->plane_count > GLINT_MAX_PLANES) return false;
    for (uint32_t i = 0; i < cubemap->plane_count; i += 4) {
        double rows[16] = {0};
        char full[64];
        const uint32_t left = cubemap->plane_count - i;
        memcpy(rows, cubemap->planes[i], (left < 4 ? left : 4) * sizeof *cubemap->planes);
        snprintf(full, sizeof full, "%s.%02u", name, i / 4);
        if (!push_numbers(arena, list, full, GLINT_EXR_M44D, rows, 16)) return false;
    }
    return true;
}

/* `number`: of a light. */
static bool push_value(struct glint_arena *arena, struct glint_attribute_list *list,
                       const struct glint_attribute_row *row, uint32_t number, const void *from) {
    char text[64];
    const char *name = glint_attribute_name(row, number, text);
    const char *member = (const char *)from + row->offset;
    double numbers[16] = {0};
    float narrow[3];
    uint32_t word = 0;
    bool flag = false;
    switch (row->kind) {
    case GLINT_KIND_CAMERA_VIEW:
    case GLINT_KIND_CAMERA_CLIP:
    case GLINT_KIND_MATRIX:
        memcpy(numbers, member, sizeof numbers);
        return push_numbers(arena, list, name, GLINT_EXR_M44D, numbers, 16);
    case GLINT_KIND_PLANE:
        memcpy(numbers, member, 4 * sizeof *numbers);
        return push_numbers(arena, list, name, GLINT_EXR_M44D, numbers, 16);
    case GLINT_KIND_V3:
    case GLINT_KIND_DIRECTION:
        memcpy(numbers, member, 3 * sizeof *numbers);
        return push_numbers(arena, list, name, GLINT_EXR_V3D, numbers, 3);
    case GLINT_KIND_V2:
        memcpy(numbers, member, 2 * sizeof *numbers);
        return push_numbers(arena, list, name, GLINT_EXR_V2D, numbers, 2);
    case GLINT_KIND_RANGE:
        memcpy(numbers, member, 2 * sizeof *numbers);
        if (numbers[0] == 0 && numbers[1] == 0) numbers[1] = 1;
        return push_numbers(arena, list, name, GLINT_EXR_V2D, numbers, 2);
    case GLINT_KIND_DOUBLE:
        memcpy(numbers, member, sizeof *numbers);
        if (numbers[0] == 0 && !isnan(row->fallback)) numbers[0] = row->fallback;
        return push_numbers(arena, list, name, GLINT_EXR_DOUBLE, numbers, 1);
    case GLINT_KIND_V3FLOAT:
        memcpy(narrow, member, sizeof narrow);
        for (int i = 0; i < 3; i++) numbers[i] = (double)narrow[i];
        return push_numbers(arena, list, name, GLINT_EXR_V3F, numbers, 3);
    case GLINT_KIND_UINT:
        memcpy(&word, member, sizeof word);
        numbers[0] = (int32_t)word;
        return push_numbers(arena, list, name, GLINT_EXR_INT, numbers, 1);
    case GLINT_KIND_BOOL:
        memcpy(&flag, member, sizeof flag);
        numbers[0] = flag;
        return push_numbers(arena, list, name, GLINT_EXR_INT, numbers, 1);
    case GLINT_KIND_AXIS:
    case GLINT_KIND_CLIP_Y:
    case GLINT_KIND_CLIP_Z:
    case GLINT_KIND_VOLUME: {
        const char *const *names = glint_kind_names(row->kind);
        memcpy(&word, member, sizeof word);
        for (uint32_t i = 0; names[i]; i++)
            if (i == word) return glint_attribute_push_string(arena, list, name, names[i]);
        return false;
    }
    case GLINT_KIND_CLASSES:
        return push_classes(arena, list, name, from);
    case GLINT_KIND_PLANES:
        return push_planes(arena, list, name, from);
    }
    return false;
}

static bool encode_scope(struct glint_arena *arena, struct glint_attribute_list *list, enum glint_scope scope,
                         uint32_t number, const void *from) {
    size_t count = 0;
    const struct glint_attribute_row *rows = glint_attribute_rows(&count);
    for (size_t i = 0; i < count; i++) {
        if (rows[i].scope != scope) continue;
        if (rows[i].group != GLINT_NO_GROUP && !*(const bool *)((const char *)from + rows[i].group)) continue;
        if (!push_value(arena, list, &rows[i], number, from)) return false;
    }
    return true;
}

bool glint_attributes_encode(struct glint_arena *arena, struct glint_attribute_list *list, enum glint_scope scope,
                             const void *from) {
    if (!encode_scope(arena, list, scope, 0, from)) return false;
    if (scope != GLINT_SCOPE_FRAME) return true;
    const struct glint_frame *frame = from;
    if (frame->light_count > GLINT_MAX_LIGHTS) return false;
    for (uint32_t i = 0; i < frame->light_count; i++)
        if (!encode_scope(arena, list, GLINT_SCOPE_LIGHT, i, &frame->lights[i])) return false;
    return true;
}

static bool set_m44f(struct glint_arena *arena, struct glint_attribute_list *list, const char *name,
                     const double matrix[16]) {
    float narrow[16];
    struct glint_exr_attribute *to = NULL;
    for (int i = 0; i < 16; i++) narrow[i] = (float)matrix[i];
    for (size_t a = 0; a < list->count && !to; a++)
        if (!strcmp(list->all[a].name, name)) to = &list->all[a];
    if (!to) to = glint_attribute_push(arena, list);
    if (!to) return false;
    *to = (struct glint_exr_attribute){.name = name,
                                       .type = GLINT_EXR_OPAQUE,
                                       .type_name = "m44f",
                                       .bytes = glint_arena_copy(arena, narrow, sizeof narrow),
                                       .count = sizeof narrow};
    return to->bytes != NULL;
}

bool glint_attributes_set_standard(struct glint_arena *arena, struct glint_attribute_list *list,
                                   const struct glint_frame *frame) {
    double to_camera[16], to_ndc[16];
    glint_camera_standard(&frame->camera, frame->clip_y, to_camera, to_ndc);
    return set_m44f(arena, list, "worldToCamera", to_camera) && set_m44f(arena, list, "worldToNDC", to_ndc);
}
