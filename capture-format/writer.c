/* The writer: copies what the engine hands over, checks it by the reader's own rules, and writes it now or on a worker. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attributes.h"
#include "hash.h"
#include "part.h"
#include "pixels.h"

struct held {
    char *name;
    struct glint_exr_part file;
    struct glint_exr_part_info as_read; /* the same, as the reader will find it */
    struct glint_part_info info;
    struct glint_attribute_list attributes;
    struct glint_arena arena;
};

struct glint_writer {
    char *path;
    struct glint_writer_options options;
    struct held **parts;
    size_t count, capacity;
    bool has_frame, finished, started;
    struct glint_frame frame;
    pthread_t worker;
    bool result;
    struct glint_error error;
};

struct glint_writer *glint_writer_create(const char *path, const struct glint_writer_options *options,
                                         struct glint_error *err) {
    if (!path || !path[0] || (options && (unsigned)options->compression > GLINT_RLE)) {
        glint_fail(err, GLINT_ERROR_USAGE, "expected a path and a known compression, found \"%s\", %d",
                   path ? path : "", options ? (int)options->compression : 0);
        return NULL;
    }
    struct glint_writer *writer = calloc(1, sizeof *writer);
    if (writer) writer->path = strdup(path);
    if (!writer || !writer->path) {
        free(writer);
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        return NULL;
    }
    if (options) writer->options = *options;
    glint_fail(&writer->error, GLINT_ERROR_USAGE, "%s: not finished", path);
    return writer;
}

static bool open_for_more(const struct glint_writer *writer, struct glint_error *err) {
    return !writer->finished || glint_fail(err, GLINT_ERROR_USAGE, "%s: expected no call after finish", writer->path);
}

/* Headers as the reader will find them, so that the writer is bound by the very same checks. */
static bool as_read(struct glint_arena *arena, const struct glint_exr_part *file, struct glint_exr_part_info *out) {
    static const char *const names[] = {"half", "float", "uint"};
    struct glint_channel_info *channels = glint_arena_take(arena, file->channel_count * sizeof *channels);
    for (size_t i = 0; channels && i < file->channel_count; i++) {
        snprintf(channels[i].name, sizeof channels[i].name, "%s", file->channels[i].name);
        channels[i].stored = file->channels[i].stored;
        snprintf(channels[i].storage, sizeof channels[i].storage, "%s", names[channels[i].stored]);
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

bool glint_writer_set_frame(struct glint_writer *writer, const struct glint_frame *frame, struct glint_error *err) {
    if (!open_for_more(writer, err)) return false;
    if (writer->has_frame) return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected the frame once", writer->path);
    struct glint_arena arena = {0};
    struct glint_attribute_list list = {0};
    struct glint_check check = {.file = writer->path, .err = err};
    struct glint_frame back = {0};
    bool ok = glint_attributes_encode(&arena, &list, GLINT_SCOPE_FRAME, frame) ||
              glint_fail(err, GLINT_ERROR_USAGE, "%s: part gbuffer: expected enums and counts in range, found others",
                         writer->path);
    const struct glint_exr_part_info part = {.name = "gbuffer", .attributes = list.all, .attribute_count = list.count};
    ok = ok && glint_attributes_decode(&check, &part, GLINT_SCOPE_FRAME, &back);
    glint_arena_finish(&arena);
    if (!ok) return false;
    writer->frame = *frame;
    writer->has_frame = true;
    return true;
}

/* ---- parts ---- */

static bool push_storage(struct held *held, const struct glint_part *part) {
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
static bool push_encodings(struct held *held, const struct glint_part *part, const struct glint_role *role,
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

static bool push_foreign(struct held *held, const struct glint_part *part, struct glint_error *err) {
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
        if (!to->name || !to->numbers || (to->type == GLINT_EXR_STRING && !to->string))
            return glint_fail(err, GLINT_ERROR_USAGE, "part %s: %s: expected a value", part->name, from->name);
    }
    return true;
}

static bool push_attributes(struct held *held, const struct glint_part *part, const struct glint_role *role,
                            struct glint_error *err) {
    static const double version = GLINT_FORMAT_VERSION;
    struct glint_exr_attribute *a = glint_attribute_push(&held->arena, &held->attributes);
    if (!a) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    *a = (struct glint_exr_attribute){
        .name = GLINT_VERSION_ATTRIBUTE, .type = GLINT_EXR_INT, .type_name = "int", .numbers = &version, .count = 1};
    if (!push_encodings(held, part, role, err)) return false;
    if (part->channel_count && !push_storage(held, part))
        return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    if (part->cubemap && !glint_attributes_encode(&held->arena, &held->attributes, GLINT_SCOPE_CUBEMAP, part->cubemap))
        return glint_fail(err, GLINT_ERROR_USAGE, "part %s: expected a volume and at most %d planes, found others",
                          part->name, GLINT_MAX_PLANES);
    if (part->planar && !glint_attributes_encode(&held->arena, &held->attributes, GLINT_SCOPE_PLANAR, part->planar))
        return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    return push_foreign(held, part, err);
}

/* A part whose pixels are in a sibling: one black pixel a face, so that every tool can open the file. The hash is
   filled in when the file is written. */
static bool hold_sibling(struct held *held, const struct glint_part *part, struct glint_error *err) {
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

static bool hold_pixels(struct held *held, const struct glint_part *part, struct glint_error *err) {
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

static bool check_call(const struct glint_writer *writer, const struct glint_part *part, struct glint_error *err) {
    int32_t index = -1;
    bool previous = false;
    const char *name = part->name ? part->name : "";
    if (!name[0] || strlen(name) > 255 || !glint_role_find(name, &index, &previous))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: part \"%.80s\": expected the name of a role, found none",
                          writer->path, name);
    if (!part->sibling &&
        (!part->width || !part->height || part->width > 65536 || part->height > 6u * 65536 || !part->channel_count))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: expected a size and channels, found %u x %u, %zu",
                          writer->path, name, part->width, part->height, part->channel_count);
    for (size_t i = 0; i < part->channel_count; i++) {
        const struct glint_channel *channel = &part->channels[i];
        if (!channel->name || !channel->name[0] || strlen(channel->name) > 255 || !channel->data ||
            (unsigned)channel->type > GLINT_SNORM16)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: channel %zu: expected a name, data and a type",
                              writer->path, name, i);
    }
    for (size_t i = 0; i < writer->count; i++)
        if (!strcmp(writer->parts[i]->name, name))
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: expected one part of this name, found two",
                              writer->path, name);
    return true;
}

static void release(struct held **held) {
    if (!*held) return;
    glint_arena_finish(&(*held)->arena);
    free(*held);
    *held = NULL;
}

static bool hold(struct glint_writer *writer, struct held *held, const struct glint_part *part,
                 struct glint_error *err) {
    int32_t index = -1;
    bool previous = false;
    const struct glint_role *role = glint_role_find(part->name, &index, &previous);
    held->name = glint_arena_string(&held->arena, part->name);
    if (!held->name) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    held->file.name = held->name;
    held->file.compression = writer->options.compression;
    if (!push_attributes(held, part, role, err)) return false;
    if (!(part->sibling ? hold_sibling(held, part, err) : hold_pixels(held, part, err))) return false;
    held->file.attributes = held->attributes.all;
    held->file.attribute_count = held->attributes.count;
    if (!as_read(&held->arena, &held->file, &held->as_read))
        return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    struct glint_check check = {.file = writer->path, .err = err};
    if (!glint_part_parse(&check, &held->arena, &held->as_read, true, &held->info)) return false;
    if (part->sibling) held->info.width = held->info.height = 0; /* the sibling's */
    else if (role->shape == GLINT_SHAPE_CUBE && (uint64_t)part->height != 6 * (uint64_t)part->width)
        return glint_violation(&check, GLINT_RULE_SHAPE, part->name, NULL, "expected N x 6N pixels, found %u x %u",
                               part->width, part->height);
    return true;
}

bool glint_writer_add_part(struct glint_writer *writer, const struct glint_part *part, struct glint_error *err) {
    if (!open_for_more(writer, err) || !check_call(writer, part, err)) return false;
    if (writer->count == writer->capacity) {
        const size_t capacity = writer->capacity ? 2 * writer->capacity : 32;
        struct held **more = realloc(writer->parts, capacity * sizeof *more);
        if (!more) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
        writer->parts = more;
        writer->capacity = capacity;
    }
    struct held *held = calloc(1, sizeof *held);
    if (!held) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
    if (!hold(writer, held, part, err)) {
        release(&held);
        return false;
    }
    writer->parts[writer->count++] = held;
    return true;
}

/* ---- finish ---- */

static int gbuffer_first(const void *a, const void *b) {
    const struct held *const *left = a, *const *right = b;
    const int l = strcmp((*left)->name, "gbuffer") != 0, r = strcmp((*right)->name, "gbuffer") != 0;
    return l != r ? l - r : strcmp((*left)->name, (*right)->name);
}

/* The rules between parts, on the headers as they will be read. */
static bool check_all(struct glint_writer *writer, struct glint_error *err) {
    struct glint_arena arena = {0};
    struct glint_check check = {.file = writer->path, .err = err};
    const struct glint_exr_part_info **files = glint_arena_take(&arena, (writer->count + 1) * sizeof *files);
    struct glint_part_info *parts = glint_arena_take(&arena, (writer->count + 1) * sizeof *parts);
    struct glint_frame frame = {0};
    bool has_frame = false, ok = files && parts;
    if (!ok) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
    for (size_t i = 0; ok && i < writer->count; i++) {
        files[i] = &writer->parts[i]->as_read;
        parts[i] = writer->parts[i]->info;
    }
    ok = ok && glint_parts_check(&check, files, parts, writer->count, &frame, &has_frame);
    glint_arena_finish(&arena);
    return ok;
}

/* Puts the frame's attributes on gbuffer. */
static bool attach_frame(struct glint_writer *writer, struct glint_error *err) {
    struct held *gbuffer = writer->count ? writer->parts[0] : NULL;
    if (!gbuffer || strcmp(gbuffer->name, "gbuffer")) return true; /* check_all says what is missing */
    if (!writer->has_frame)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: part gbuffer: expected glint_writer_set_frame before finish",
                          writer->path);
    if (!glint_attributes_encode(&gbuffer->arena, &gbuffer->attributes, GLINT_SCOPE_FRAME, &writer->frame))
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
    gbuffer->file.attributes = gbuffer->as_read.attributes = gbuffer->attributes.all;
    gbuffer->file.attribute_count = gbuffer->as_read.attribute_count = gbuffer->attributes.count;
    return true;
}

static bool hash_siblings(struct glint_writer *writer, struct glint_error *err) {
    char name[256] = "", hex[33] = "";
    for (size_t i = 0; i < writer->count; i++) {
        struct held *held = writer->parts[i];
        if (!held->info.sibling[0]) continue;
        if (strcmp(name, held->info.sibling)) {
            snprintf(name, sizeof name, "%s", held->info.sibling);
            if (!glint_hash_sibling(writer->path, name, hex, err)) return false;
        }
        for (size_t a = 0; a < held->attributes.count; a++)
            if (!strcmp(held->attributes.all[a].name, GLINT_SIBLING_HASH_ATTRIBUTE))
                held->attributes.all[a].string = glint_arena_string(&held->arena, hex);
    }
    return true;
}

static bool write_now(struct glint_writer *writer, struct glint_error *err) {
    struct glint_exr_part *files = calloc(writer->count, sizeof *files);
    if (!files) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
    bool ok = hash_siblings(writer, err);
    for (size_t i = 0; i < writer->count; i++) files[i] = writer->parts[i]->file;
    ok = ok && glint_exr_write(writer->path, files, writer->count, writer->options.threads, err);
    free(files);
    for (size_t i = 0; i < writer->count; i++) release(&writer->parts[i]);
    writer->count = 0;
    return ok;
}

static void *work(void *user) {
    struct glint_writer *writer = user;
    writer->result = write_now(writer, &writer->error);
    return NULL;
}

bool glint_writer_finish(struct glint_writer *writer, struct glint_error *err) {
    if (!open_for_more(writer, err)) return false;
    writer->finished = true;
    writer->error = (struct glint_error){0};
    if (writer->count) qsort(writer->parts, writer->count, sizeof *writer->parts, gbuffer_first);
    if (!attach_frame(writer, &writer->error) || !check_all(writer, &writer->error)) writer->result = false;
    else if (!writer->options.background || pthread_create(&writer->worker, NULL, work, writer)) work(writer);
    else writer->started = true;
    if (!writer->started && !writer->result && err) *err = writer->error;
    return writer->started || writer->result;
}

bool glint_writer_wait(struct glint_writer *writer, struct glint_error *err) {
    if (writer->started) pthread_join(writer->worker, NULL);
    writer->started = false;
    if (!writer->result && err) *err = writer->error;
    return writer->result;
}

void glint_writer_destroy(struct glint_writer **writer) {
    if (!writer || !*writer) return;
    if ((*writer)->started) pthread_join((*writer)->worker, NULL);
    for (size_t i = 0; i < (*writer)->count; i++) release(&(*writer)->parts[i]);
    free((*writer)->parts);
    free((*writer)->path);
    free(*writer);
    *writer = NULL;
}
