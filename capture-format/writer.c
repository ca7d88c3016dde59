/* The writer: copies the engine's data, checks it by the reader's rules, and writes it at once or on a worker thread. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exr_internal.h"
#include "sibling.h"
#include "system.h"
#include "writer_part.h"

struct glint_writer {
    char *path;
    struct glint_writer_options options;
    struct glint_writer_part **parts;
    size_t count, capacity;
    bool has_frame, finished, started;
    struct glint_frame frame, as_read;
    struct glint_thread worker;
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

bool glint_writer_set_frame(struct glint_writer *writer, const struct glint_frame *frame, struct glint_error *err) {
    if (!open_for_more(writer, err)) return false;
    if (writer->has_frame) return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected the frame once", writer->path);
    struct glint_arena arena = {0};
    struct glint_attribute_list list = {0};
    struct glint_check check = {.file = writer->path, .err = err};
    bool ok = glint_attributes_encode(&arena, &list, GLINT_SCOPE_FRAME, frame);
    if (!ok && arena.exhausted) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
    else if (!ok)
        glint_fail(err, GLINT_ERROR_USAGE, "%s: part gbuffer: expected enums and counts in range, found others",
                   writer->path);
    const struct glint_exr_part_info part = {.name = "gbuffer", .attributes = list.all, .attribute_count = list.count};
    writer->as_read = (struct glint_frame){0};
    ok = ok && glint_attributes_decode(&check, &part, GLINT_SCOPE_FRAME, &writer->as_read);
    glint_arena_finish(&arena);
    if (!ok) return false;
    writer->frame = *frame;
    writer->has_frame = true;
    return true;
}

/* ---- parts ---- */

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

bool glint_writer_add_part(struct glint_writer *writer, const struct glint_part *part, struct glint_error *err) {
    if (!open_for_more(writer, err) || !check_call(writer, part, err)) return false;
    if (writer->count == writer->capacity) {
        const size_t capacity = writer->capacity ? 2 * writer->capacity : 32;
        struct glint_writer_part **more = realloc(writer->parts, capacity * sizeof *more);
        if (!more) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
        writer->parts = more;
        writer->capacity = capacity;
    }
    struct glint_writer_part *held = glint_writer_part_create(writer->path, part, writer->options.compression, err);
    if (!held) return false;
    writer->parts[writer->count++] = held;
    return true;
}

/* ---- finish ---- */

static int gbuffer_first(const void *a, const void *b) {
    const struct glint_writer_part *const *left = a, *const *right = b;
    const int l = strcmp((*left)->name, "gbuffer") != 0, r = strcmp((*right)->name, "gbuffer") != 0;
    return l != r ? l - r : strcmp((*left)->name, (*right)->name);
}

/* Checks the rules between parts on the headers as they will be read. */
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

/* Adds the frame's attributes to gbuffer. */
static bool attach_frame(struct glint_writer *writer, struct glint_error *err) {
    struct glint_writer_part *gbuffer = writer->count ? writer->parts[0] : NULL;
    if (!gbuffer || strcmp(gbuffer->name, "gbuffer")) return true; /* check_all reports the missing part */
    if (!writer->has_frame)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: part gbuffer: expected glint_writer_set_frame before finish",
                          writer->path);
    if (!glint_attributes_encode(&gbuffer->arena, &gbuffer->attributes, GLINT_SCOPE_FRAME, &writer->frame) ||
        !glint_attributes_set_standard(&gbuffer->arena, &gbuffer->attributes, &writer->as_read))
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", writer->path);
    gbuffer->file.attributes = gbuffer->as_read.attributes = gbuffer->attributes.all;
    gbuffer->file.attribute_count = gbuffer->as_read.attribute_count = gbuffer->attributes.count;
    return true;
}

static bool hash_siblings(struct glint_writer *writer, struct glint_error *err) {
    char name[256] = "", hex[33] = "";
    for (size_t i = 0; i < writer->count; i++) {
        struct glint_writer_part *held = writer->parts[i];
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
    const struct glint_exr_write_options options = {.threads = writer->options.threads, .durable = true};
    ok = ok && glint_exr_write_file(writer->path, files, writer->count, &options, err);
    free(files);
    for (size_t i = 0; i < writer->count; i++) glint_writer_part_destroy(&writer->parts[i]);
    writer->count = 0;
    return ok;
}

static void run_worker(void *user) {
    struct glint_writer *writer = user;
    writer->result = write_now(writer, &writer->error);
}

bool glint_writer_finish(struct glint_writer *writer, struct glint_error *err) {
    if (!open_for_more(writer, err)) return false;
    writer->finished = true;
    writer->error = (struct glint_error){0};
    if (writer->count) qsort(writer->parts, writer->count, sizeof *writer->parts, gbuffer_first);
    if (!attach_frame(writer, &writer->error) || !check_all(writer, &writer->error)) writer->result = false;
    else if (!writer->options.background || !glint_thread_start(&writer->worker, run_worker, writer))
        run_worker(writer);
    else writer->started = true;
    if (!writer->started && !writer->result && err) *err = writer->error;
    return writer->started || writer->result;
}

bool glint_writer_wait(struct glint_writer *writer, struct glint_error *err) {
    if (writer->started) glint_thread_join(&writer->worker);
    writer->started = false;
    if (!writer->result && err) *err = writer->error;
    return writer->result;
}

void glint_writer_destroy(struct glint_writer **writer) {
    if (!writer || !*writer) return;
    if ((*writer)->started) glint_thread_join(&(*writer)->worker);
    for (size_t i = 0; i < (*writer)->count; i++) glint_writer_part_destroy(&(*writer)->parts[i]);
    free((*writer)->parts);
    free((*writer)->path);
    free(*writer);
    *writer = NULL;
}
