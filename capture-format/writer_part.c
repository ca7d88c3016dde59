/* A part that the writer keeps until it is written. */
#include "writer_part.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pixels.h"

/* Headers as the reader will find them, so that the writer can use the reader's checks. */
static bool as_read(struct glint_arena *arena, const struct glint_exr_part *file, struct glint_exr_part_info *out) {
    struct glint_channel_info *channels = glint_arena_take(arena, file->channel_count * sizeof *channels);
    for (size_t i = 0; channels && i < file->channel_count; i++) {
        snprintf(channels[i].name, sizeof channels[i].name, "%s", file->channels[i].name);
        channels[i].stored = file->channels[i].stored;
        snprintf(channels[i].storage, sizeof channels[i].storage, "%s", glint_stored_name(channels[i].stored));
    }
    *out = (struct glint_exr_part_info){.name = file->name,
                                        .width = file->width,
                                        .height = file->height,
                                        .channels = channels,
                                        .channel_count = file->channel_count,
                                        .attributes = file->attributes,
                                        .attribute_count = file->attribute_count};
    return channels != NULL;
}

static bool push_storage(struct glint_writer_part *held, const struct glint_part *part) {
    size_t count = 0;
    const char **strings = glint_arena_take(&held->arena, (part->channel_count + 1) * sizeof *strings);
    for (size_t i = 0; strings && i < part->channel_count; i++) {
        const char *storage = part->channels[i].storage;
        if (!storage) storage = glint_pixels_storage(part->channels[i].type);
        char text[384];
        snprintf(text, sizeof text, "%.255s=%.63s", part->channels[i].name, storage);
        strings[count] = glint_arena_string(&held->arena, text);
        if (!strings[count++]) return false;
    }
    struct glint_exr_attribute *a = strings ? glint_attribute_push(&held->arena, &held->attributes) : NULL;
    if (a)
        *a = (struct glint_exr_attribute){.name = GLINT_STORAGE_ATTRIBUTE,
                                          .type = GLINT_EXR_STRINGS,
                                          .type_name = "stringvector",
                                          .strings = strings,
                                          .count = count};
    return a != NULL;
}

/* The encodings that concern this part's channels; normalSpace goes with any normal. */
static bool push_encodings(struct glint_writer_part *held, const struct glint_part *part, const struct glint_role *role,
                           struct glint_error *err) {
    size_t count = 0;
    const struct glint_encoding_row *rows = glint_encoding_rows(&count);
    for (size_t r = 0; r < count; r++) {
        bool concerns = false;
        for (size_t i = 0; i < part->channel_count && !concerns; i++) {
            const struct glint_role_channel *row = glint_role_channel_find(role, part->channels[i].name);
            concerns = row && (!strcmp(row->encoding, rows[r].which) ||
                               (!strcmp(rows[r].which, "normal_space") && strstr(row->encoding, "normal")));
        }
        if (!concerns) continue;
        const int value = glint_encoding_get(&part->encodings, &rows[r]);
        const char *name = glint_encoding_name(rows[r].which, value);
        if (!name)
            return glint_fail(err, GLINT_ERROR_USAGE, "part %s: %s: expected 0 to %d, found %d", part->name,
                              rows[r].attribute, rows[r].count - 1, value);
        if (!glint_attribute_push_string(&held->arena, &held->attributes, rows[r].attribute, name))
            return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    }
    return true;
}

static bool push_foreign(struct glint_writer_part *held, const struct glint_part *part, struct glint_error *err) {
    for (size_t i = 0; i < part->attribute_count; i++) {
        const struct glint_attribute *from = &part->attributes[i];
        if (!from->name || !from->name[0] || strlen(from->name) > 255 || glint_attribute_is_ours(from->name))
            return glint_fail(err, GLINT_ERROR_USAGE,
                              "part %s: expected attribute names of 1 to 255 bytes without glint., found \"%.60s\"",
                              part->name, from->name ? from->name : "");
        struct glint_exr_attribute *to = glint_attribute_push(&held->arena, &held->attributes);
        if (!to) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
        to->name = glint_arena_string(&held->arena, from->name);
        to->count = 1;
        to->numbers = glint_arena_copy(&held->arena, &from->number, sizeof from->number);
        if (from->string) to->string = glint_arena_string(&held->arena, from->string);
        to->type = from->type == GLINT_ATTRIBUTE_STRING ? GLINT_EXR_STRING
                   : from->type == GLINT_ATTRIBUTE_INT  ? GLINT_EXR_INT
                                                        : GLINT_EXR_DOUBLE;
        if (held->arena.exhausted) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
        if (!to->name || !to->numbers || (to->type == GLINT_EXR_STRING && !to->string))
            return glint_fail(err, GLINT_ERROR_USAGE, "part %s: %s: expected a value", part->name, from->name);
    }
    return true;
}

/* What the part was given. An attribute that belongs to another role is found when the part is checked; of truths, each takes its own. */
static bool push_scopes(struct glint_writer_part *held, const struct glint_part *part, const struct glint_role *role,
                        struct glint_error *err) {
    for (int i = 0; i < GLINT_SCOPE_COUNT; i++) {
        const struct glint_scope_row *row = glint_scope_row((enum glint_scope)i);
        const void *from = row->of_frame ? NULL : *(const void *const *)((const char *)part + row->given);
        if (!from || (from == part->truth && !glint_scope_is_on((enum glint_scope)i, role, false))) continue;
        if (!glint_attributes_encode(&held->arena, &held->attributes, (enum glint_scope)i, from))
            return from == part->cubemap && !held->arena.exhausted
                       ? glint_fail(err, GLINT_ERROR_USAGE,
                                    "part %s: expected a volume and at most %d planes, found others", part->name,
                                    GLINT_MAX_PLANES)
                       : glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    }
    return true;
}

static bool push_attributes(struct glint_writer_part *held, const struct glint_part *part,
                            const struct glint_role *role, struct glint_error *err) {
    static const double version = GLINT_FORMAT_VERSION;
    struct glint_exr_attribute *a = glint_attribute_push(&held->arena, &held->attributes);
    if (!a) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    *a = (struct glint_exr_attribute){
        .name = GLINT_VERSION_ATTRIBUTE, .type = GLINT_EXR_INT, .type_name = "int", .numbers = &version, .count = 1};
    if (!push_encodings(held, part, role, err)) return false;
    if (part->channel_count && !push_storage(held, part))
        return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    return push_scopes(held, part, role, err) && push_foreign(held, part, err);
}

/* A part whose pixels are in a sibling: one black pixel a face, so that every tool can open the file. The hash is
   filled in when the file is written. */
static bool hold_sibling(struct glint_writer_part *held, const struct glint_part *part, struct glint_error *err) {
    static const uint16_t black[6];
    static const char *const names[] = {"A", "B", "G", "R"};
    struct glint_exr_channel *channels = glint_arena_take(&held->arena, 4 * sizeof *channels);
    if (part->channel_count)
        return glint_fail(err, GLINT_ERROR_USAGE, "part %s: expected a sibling or channels, found both", part->name);
    for (size_t i = 0; channels && i < 4; i++)
        channels[i] = (struct glint_exr_channel){.name = names[i], .stored = GLINT_STORED_HALF, .data = black};
    held->file.width = 1;
    held->file.height = 6;
    held->file.channels = channels;
    held->file.channel_count = 4;
    if (!channels ||
        !glint_attribute_push_string(&held->arena, &held->attributes, GLINT_SIBLING_ATTRIBUTE, part->sibling) ||
        !glint_attribute_push_string(&held->arena, &held->attributes, GLINT_SIBLING_HASH_ATTRIBUTE,
                                     "00000000000000000000000000000000"))
        return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    return true;
}

static bool hold_pixels(struct glint_writer_part *held, const struct glint_part *part, struct glint_error *err) {
    struct glint_exr_channel *channels = glint_arena_take(&held->arena, part->channel_count * sizeof *channels);
    if (!channels) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    held->file.width = part->width;
    held->file.height = part->height;
    held->file.channels = channels;
    held->file.channel_count = part->channel_count;
    for (size_t i = 0; i < part->channel_count; i++) {
        const struct glint_channel *from = &part->channels[i];
        for (size_t j = 0; j < i; j++)
            if (!strcmp(part->channels[j].name, from->name))
                return glint_fail(err, GLINT_ERROR_USAGE, "part %s: %s: expected one channel of this name, found two",
                                  part->name, from->name);
        channels[i].name = glint_arena_string(&held->arena, from->name);
        channels[i].stored = glint_pixels_stored(from->type);
        void *data = glint_arena_take(&held->arena, (size_t)part->width * part->height *
                                                        (channels[i].stored == GLINT_STORED_HALF ? 2 : 4));
        channels[i].data = data;
        if (!channels[i].name || !data)
            return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
        glint_pixels_copy(from, part->width, part->height, data);
    }
    return true;
}

static bool hold_part(const char *path, struct glint_writer_part *held, const struct glint_part *part,
                      struct glint_error *err) {
    int32_t index = -1;
    bool previous = false;
    const struct glint_role *role = glint_role_find(part->name, &index, &previous);
    held->name = glint_arena_string(&held->arena, part->name);
    if (!held->name) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    held->file.name = held->name;
    if (!push_attributes(held, part, role, err)) return false;
    if (!(part->sibling ? hold_sibling(held, part, err) : hold_pixels(held, part, err))) return false;
    held->file.attributes = held->attributes.all;
    held->file.attribute_count = held->attributes.count;
    if (!as_read(&held->arena, &held->file, &held->as_read))
        return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    struct glint_check check = {.file = path, .err = err};
    if (!glint_part_parse(&check, &held->arena, &held->as_read, true, &held->info)) return false;
    if (part->sibling) held->info.width = held->info.height = 0; /* those of the sibling */
    else if (glint_shape_is_cube(role->shape) && (uint64_t)part->height != 6 * (uint64_t)part->width)
        return glint_violation(&check, GLINT_RULE_SHAPE, part->name, NULL, "expected N x 6N pixels, found %u x %u",
                               part->width, part->height);
    return true;
}

struct glint_writer_part *glint_writer_part_create(const char *path, const struct glint_part *part,
                                                   enum glint_compression compression, struct glint_error *err) {
    struct glint_writer_part *held = calloc(1, sizeof *held);
    if (!held) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        return NULL;
    }
    held->file.compression = compression;
    if (!hold_part(path, held, part, err)) glint_writer_part_destroy(&held);
    return held;
}

void glint_writer_part_destroy(struct glint_writer_part **part) {
    if (!*part) return;
    glint_arena_finish(&(*part)->arena);
    free(*part);
    *part = NULL;
}
