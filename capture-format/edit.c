/* Copies a capture with changes. Pixels are read as stored when they are written or changed; a rectangle of them, or every n-th one, is a stride. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edit_internal.h"
#include "hash.h"
#include "sibling.h"

bool glint_edit_fail_memory(const struct glint_edit *edit, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", edit->exr->path);
}

void glint_edit_say(const struct glint_edit *edit, const char *format, ...) {
    char text[512];
    va_list args;
    if (!edit->note) return;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    edit->note(edit->user, text);
}

const struct glint_role *glint_edit_role(const struct glint_edit_part *part) {
    int32_t index;
    bool previous;
    return glint_role_find(part->info.name, &index, &previous);
}

/* ---- Parts ---- */

/* Takes channels and size from a part of a file, and its attributes unless the part has attributes of its own. */
static bool take_part(struct glint_edit *edit, struct glint_edit_part *part, struct glint_exr *exr, size_t index,
                      struct glint_error *err) {
    const struct glint_exr_part_info *from = &exr->parts[index].info;
    const size_t count = from->channel_count;
    part->exr = exr;
    part->index = index;
    part->x = part->y = 0;
    part->step = 1;
    part->full_width = from->width;
    part->channels = glint_arena_take(&edit->arena, (count + 1) * sizeof *part->channels);
    part->listed = glint_arena_take(&edit->arena, (count + 1) * sizeof *part->listed);
    if (!part->channels || !part->listed) return glint_edit_fail_memory(edit, err);
    for (size_t c = 0; c < count; c++) part->channels[c].info = part->listed[c] = from->channels[c];
    part->info.name = from->name;
    part->info.width = from->width;
    part->info.height = from->height;
    part->info.channels = part->listed;
    part->info.channel_count = count;
    return true;
}

static bool init_parts(struct glint_edit *edit, struct glint_error *err) {
    edit->count = edit->exr->part_count;
    edit->parts = calloc(edit->count + 1, sizeof *edit->parts);
    edit->siblings = calloc(edit->count + 1, sizeof *edit->siblings);
    if (!edit->parts || !edit->siblings) return glint_edit_fail_memory(edit, err);
    for (size_t i = 0; i < edit->count; i++) {
        const struct glint_exr_part_info *from = &edit->exr->parts[i].info;
        if (!take_part(edit, &edit->parts[i], edit->exr, i, err)) return false;
        for (size_t a = 0; a < from->attribute_count; a++)
            if (!glint_edit_set(edit, i, &from->attributes[a], err)) return false;
    }
    return true;
}

struct glint_edit *glint_edit_open(const char *path, const struct glint_limits *limits, glint_edit_note note,
                                   void *user, struct glint_error *err) {
    struct glint_edit *edit = calloc(1, sizeof *edit);
    if (!edit) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        return NULL;
    }
    edit->note = note;
    edit->user = user;
    edit->exr = glint_exr_open(path, limits, err);
    if (!edit->exr || !init_parts(edit, err)) glint_edit_close(&edit);
    return edit;
}

void glint_edit_close(struct glint_edit **pointer) {
    struct glint_edit *edit = *pointer;
    *pointer = NULL;
    if (!edit) return;
    for (size_t i = 0; i < edit->block_count; i++) {
        free(edit->blocks[i]->data);
        free(edit->blocks[i]);
    }
    free(edit->blocks);
    for (size_t i = 0; i < edit->sibling_count; i++) glint_exr_close(&edit->siblings[i].exr);
    free(edit->siblings);
    free(edit->parts);
    glint_exr_close(&edit->exr);
    glint_arena_finish(&edit->arena);
    free(edit);
}

const struct glint_exr_part_info *glint_edit_part(const struct glint_edit *edit, size_t part) {
    return part < edit->count ? &edit->parts[part].info : NULL;
}

size_t glint_edit_find(const struct glint_edit *edit, const char *name) {
    size_t i = 0;
    while (i < edit->count && strcmp(edit->parts[i].info.name, name) != 0) i++;
    return i;
}

void glint_edit_drop_part(struct glint_edit *edit, size_t part) {
    memmove(&edit->parts[part], &edit->parts[part + 1], (--edit->count - part) * sizeof *edit->parts);
}

/* ---- Attributes ---- */

static bool copy_strings(struct glint_arena *arena, struct glint_exr_attribute *to) {
    const char **strings = glint_arena_take(arena, (to->count + 1) * sizeof *strings);
    for (size_t i = 0; strings && i < to->count; i++)
        if (!(strings[i] = glint_arena_string(arena, to->strings[i]))) return false;
    to->strings = strings;
    return strings != NULL;
}

static bool copy_attribute(struct glint_arena *arena, struct glint_exr_attribute *to) {
    static const char *const types[] = {[GLINT_EXR_STRING] = "string",
                                        [GLINT_EXR_INT] = "int",
                                        [GLINT_EXR_FLOAT] = "float",
                                        [GLINT_EXR_DOUBLE] = "double",
                                        [GLINT_EXR_V2D] = "v2d",
                                        [GLINT_EXR_V3D] = "v3d",
                                        [GLINT_EXR_V3F] = "v3f",
                                        [GLINT_EXR_M44D] = "m44d",
                                        [GLINT_EXR_FLOATS] = "floatvector",
                                        [GLINT_EXR_STRINGS] = "stringvector"};
    const bool opaque = to->type == GLINT_EXR_OPAQUE;
    to->name = glint_arena_string(arena, to->name);
    to->type_name = glint_arena_string(arena, opaque ? to->type_name : types[to->type]);
    if (to->type == GLINT_EXR_STRING) to->string = glint_arena_string(arena, to->string);
    else if (to->type == GLINT_EXR_STRINGS && !copy_strings(arena, to)) return false;
    else if (to->type != GLINT_EXR_STRINGS && !opaque)
        to->numbers = glint_arena_copy(arena, to->numbers, to->count * sizeof *to->numbers);
    else if (opaque) to->bytes = glint_arena_copy(arena, to->bytes, to->count);
    const void *value = to->type == GLINT_EXR_STRING    ? (const void *)to->string
                        : to->type == GLINT_EXR_STRINGS ? (const void *)to->strings
                        : opaque                        ? to->bytes
                                                        : (const void *)to->numbers;
    return to->name && to->type_name && value;
}

bool glint_edit_set(struct glint_edit *edit, size_t i, const struct glint_exr_attribute *attribute,
                    struct glint_error *err) {
    struct glint_edit_part *part = &edit->parts[i];
    struct glint_exr_attribute copy = *attribute, *to = NULL;
    if (!copy_attribute(&edit->arena, &copy)) return glint_edit_fail_memory(edit, err);
    for (size_t a = 0; a < part->attributes.count && !to; a++)
        if (!strcmp(part->attributes.all[a].name, copy.name)) to = &part->attributes.all[a];
    if (!to) to = glint_attribute_push(&edit->arena, &part->attributes);
    if (!to) return glint_edit_fail_memory(edit, err);
    *to = copy;
    part->info.attributes = part->attributes.all;
    part->info.attribute_count = part->attributes.count;
    return true;
}

bool glint_edit_unset(struct glint_edit *edit, size_t i, const char *name) {
    struct glint_edit_part *part = &edit->parts[i];
    struct glint_attribute_list *list = &part->attributes;
    size_t a = 0;
    while (a < list->count && strcmp(list->all[a].name, name) != 0) a++;
    if (a == list->count) return false;
    memmove(&list->all[a], &list->all[a + 1], (--list->count - a) * sizeof *list->all);
    part->info.attribute_count = list->count;
    return true;
}

/* ---- Siblings ---- */

static struct glint_exr *open_sibling(struct glint_edit *edit, const char *name, const char *expected,
                                      struct glint_error *err) {
    for (size_t i = 0; i < edit->sibling_count; i++)
        if (!strcmp(edit->siblings[i].name, name)) return edit->siblings[i].exr;
    if (!glint_sibling_is_plain(name)) {
        glint_fail(err, GLINT_ERROR_FORMAT,
                   "%s: " GLINT_SIBLING_ATTRIBUTE ": expected a plain file name, found \"%.80s\"", edit->exr->path,
                   name);
        return NULL;
    }
    char hex[33] = "", *path = glint_sibling_path(edit->exr->path, name);
    struct glint_edit_sibling *sibling = &edit->siblings[edit->sibling_count];
    sibling->name = glint_arena_string(&edit->arena, name);
    struct glint_limits limits = edit->exr->limits;
    limits.no_link = true;
    if (path && sibling->name) sibling->exr = glint_exr_open(path, &limits, err);
    else glint_edit_fail_memory(edit, err);
    edit->sibling_count += sibling->exr != NULL;
    bool ok = sibling->exr && glint_hash_file(sibling->exr->stream.file, path, hex, err);
    if (ok && strcmp(hex, expected) != 0)
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: sibling %s: expected the hash %s, found %s", edit->exr->path,
                        name, expected, hex);
    free(path);
    return ok ? sibling->exr : NULL;
}

const char *glint_edit_string(const struct glint_edit_part *part, const char *name) {
    const struct glint_exr_attribute *a = glint_exr_attribute(&part->info, name);
    return a && a->type == GLINT_EXR_STRING ? a->string : NULL;
}

/* Encodings and storage formats describe the pixels, so they come along; the cube map's other attributes stay the capture's. */
static bool adopt(struct glint_edit *edit, struct glint_edit_part *part, const struct glint_exr_part_info *from,
                  struct glint_error *err) {
    const size_t i = (size_t)(part - edit->parts);
    size_t count;
    const struct glint_encoding_row *rows = glint_encoding_rows(&count);
    glint_edit_unset(edit, i, GLINT_SIBLING_ATTRIBUTE);
    glint_edit_unset(edit, i, GLINT_SIBLING_HASH_ATTRIBUTE);
    for (size_t r = 0; r <= count; r++) {
        const char *name = r < count ? rows[r].attribute : GLINT_STORAGE_ATTRIBUTE;
        const struct glint_exr_attribute *a = glint_exr_attribute(from, name);
        glint_edit_unset(edit, i, name);
        if (a && !glint_edit_set(edit, i, a, err)) return false;
    }
    return true;
}

bool glint_edit_resolve(struct glint_edit *edit, struct glint_edit_part *part, struct glint_error *err) {
    const char *name = glint_edit_string(part, GLINT_SIBLING_ATTRIBUTE),
               *hash = glint_edit_string(part, GLINT_SIBLING_HASH_ATTRIBUTE);
    if (!name) return true;
    if (!*name || strpbrk(name, "/\\") || !strcmp(name, ".") || !strcmp(name, ".."))
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: %s: expected a plain file name, found \"%.80s\"",
                          edit->exr->path, part->info.name, GLINT_SIBLING_ATTRIBUTE, name);
    struct glint_exr *exr = open_sibling(edit, name, hash ? hash : "", err);
    for (size_t i = 0; exr && i < exr->part_count; i++)
        if (!strcmp(exr->parts[i].info.name, part->info.name))
            return take_part(edit, part, exr, i, err) && adopt(edit, part, &exr->parts[i].info, err);
    return exr && glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: the sibling has no such part", edit->exr->path,
                             part->info.name);
}

/* ---- Pixels ---- */

struct glint_edit_block *glint_edit_block(struct glint_edit *edit, size_t bytes, uint32_t channels) {
    if (edit->block_count == edit->block_capacity) {
        const size_t capacity = edit->block_capacity ? 2 * edit->block_capacity : 32;
        struct glint_edit_block **more = realloc(edit->blocks, capacity * sizeof *more);
        if (!more) return NULL;
        edit->blocks = more;
        edit->block_capacity = capacity;
    }
    struct glint_edit_block *block = calloc(1, sizeof *block);
    if (!block || !(block->data = malloc(bytes + 1))) {
        free(block);
        return NULL;
    }
    block->channels = channels;
    return edit->blocks[edit->block_count++] = block;
}

/* Reads the channels of one type that are not read yet, together, since a chunk holds the lines of all channels. */
static bool read_type(struct glint_edit *edit, struct glint_edit_part *part, enum glint_stored stored,
                      struct glint_error *err) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *from = &part->exr->parts[part->index].info;
    for (size_t c = 0; c < part->info.channel_count;) {
        const char *names[GLINT_EXR_MAX_WANTED];
        struct glint_edit_channel *taken[GLINT_EXR_MAX_WANTED];
        uint32_t count = 0;
        for (; c < part->info.channel_count && count < GLINT_EXR_MAX_WANTED; c++) {
            struct glint_edit_channel *channel = &part->channels[c];
            if (channel->block || channel->info.stored != stored) continue;
            names[count] = channel->info.name;
            taken[count++] = channel;
        }
        if (!count) return true;
        const size_t bytes = (size_t)from->width * from->height * count * glint_stored_bytes(stored);
        struct glint_edit_block *block = glint_edit_block(edit, bytes, count);
        if (!block) return glint_edit_fail_memory(edit, err);
        if (!glint_exr_read(part->exr, part->index, names, count, types[stored], block->data, 0, err)) return false;
        for (uint32_t i = 0; i < count; i++) {
            taken[i]->block = block;
            taken[i]->place = i;
        }
    }
    return true;
}

bool glint_edit_read(struct glint_edit *edit, struct glint_edit_part *part, struct glint_error *err) {
    if (!part->exr) return true; /* the edit has made it */
    if (!part->exr->parts[part->index].readable)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED,
                          "%s: part %s: tiled, deep or subsampled pixels cannot be copied; leave the part out "
                          "(glint strip --drop %s)",
                          edit->exr->path, part->info.name, part->info.name);
    return read_type(edit, part, GLINT_STORED_HALF, err) && read_type(edit, part, GLINT_STORED_FLOAT, err) &&
           read_type(edit, part, GLINT_STORED_UINT, err);
}

struct glint_edit_pixels glint_edit_pixels_of(const struct glint_edit_part *part,
                                              const struct glint_edit_channel *channel) {
    const size_t bytes = glint_stored_bytes(channel->info.stored), texel = bytes * channel->block->channels;
    const size_t first = (size_t)part->y * part->full_width + part->x;
    return (struct glint_edit_pixels){.data = channel->block->data + first * texel + channel->place * bytes,
                                      .x_stride_bytes = texel * part->step,
                                      .y_stride_bytes = texel * part->step * part->full_width,
                                      .stored = channel->info.stored,
                                      .width = part->info.width,
                                      .height = part->info.height};
}

static struct glint_edit_channel *find_channel(const struct glint_edit *edit, const struct glint_edit_part *part,
                                               const char *name, struct glint_error *err) {
    for (size_t c = 0; c < part->info.channel_count; c++)
        if (!strcmp(part->channels[c].info.name, name)) return &part->channels[c];
    glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: has no channel %s", edit->exr->path, part->info.name, name);
    return NULL;
}

bool glint_edit_pixels(struct glint_edit *edit, size_t i, const char *channel, struct glint_edit_pixels *pixels,
                       struct glint_error *err) {
    struct glint_edit_part *part = &edit->parts[i];
    if (!glint_edit_resolve(edit, part, err)) return false;
    const struct glint_edit_channel *found = find_channel(edit, part, channel, err);
    if (!found || !glint_edit_read(edit, part, err)) return false;
    *pixels = glint_edit_pixels_of(part, found);
    return true;
}

bool glint_edit_replace(struct glint_edit *edit, size_t i, const char *channel, const float *values,
                        struct glint_error *err) {
    struct glint_edit_part *part = &edit->parts[i];
    struct glint_edit_channel *found = find_channel(edit, part, channel, err);
    /* The pixels lie in the block where they do in the file's part. */
    const size_t texels = (size_t)part->full_width * (part->y + (size_t)(part->info.height - 1) * part->step + 1);
    struct glint_edit_block *block = found ? glint_edit_block(edit, texels * sizeof *values, 1) : NULL;
    if (!found) return false;
    if (!block) return glint_edit_fail_memory(edit, err);
    found->block = block;
    found->place = 0;
    found->info.stored = part->listed[found - part->channels].stored = GLINT_STORED_FLOAT;
    const struct glint_edit_pixels to = glint_edit_pixels_of(part, found);
    for (uint32_t y = 0; y < to.height; y++)
        for (uint32_t x = 0; x < to.width; x++)
            memcpy(to.data + y * to.y_stride_bytes + x * to.x_stride_bytes, values++, sizeof *values);
    return true;
}

bool glint_edit_drop_channel(struct glint_edit *edit, size_t i, const char *channel, struct glint_error *err) {
    struct glint_edit_part *part = &edit->parts[i];
    if (!glint_edit_resolve(edit, part, err)) return false;
    const struct glint_edit_channel *found = find_channel(edit, part, channel, err);
    if (!found) return false;
    const size_t c = (size_t)(found - part->channels), rest = --part->info.channel_count - c;
    memmove(&part->channels[c], &part->channels[c + 1], rest * sizeof *part->channels);
    memmove(&part->listed[c], &part->listed[c + 1], rest * sizeof *part->listed);
    return true;
}

bool glint_edit_crop_part(struct glint_edit *edit, size_t i, const struct glint_edit_rectangle *r,
                          struct glint_error *err) {
    struct glint_edit_part *part = &edit->parts[i];
    if (!r->width || !r->height || r->x >= part->info.width || r->width > part->info.width - r->x ||
        r->y >= part->info.height || r->height > part->info.height - r->y)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: part %s: expected a rectangle within %u x %u pixels, found %u,%u,%u,%u", edit->exr->path,
                          part->info.name, part->info.width, part->info.height, r->x, r->y, r->width, r->height);
    part->x += r->x * part->step;
    part->y += r->y * part->step;
    part->info.width = r->width;
    part->info.height = r->height;
    return true;
}
