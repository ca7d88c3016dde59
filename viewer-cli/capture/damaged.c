/* Walks the headers of a damaged EXR file byte by byte. Every size is checked against the file before it is believed. */
#include "capture/damaged.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/table.h"
#include "shown.h"

enum { MAGIC = 20000630, MULTI_PART = 0x1000, PARTS_MAX = 1024, ATTRIBUTES_MAX = 4096 };

struct walk {
    FILE *file;
    uint64_t at, size;
    struct damaged *to;
};

GLINT_PRINTF(2, 3)
static bool fault(struct walk *walk, const char *format, ...) {
    va_list args;
    if (walk->to->fault[0]) return false; /* the first one counts */
    va_start(args, format);
    char text[sizeof walk->to->fault];
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    shown_text(walk->to->fault, sizeof walk->to->fault, text);
    return false;
}

/* ---- Bytes ---- */

static bool seek(struct walk *walk, uint64_t at) {
    if (at > walk->size || fseeko(walk->file, (off_t)at, SEEK_SET) != 0) return false;
    walk->at = at;
    return true;
}

static bool take(struct walk *walk, void *bytes, size_t count) {
    if (count > walk->size - walk->at || fread(bytes, 1, count, walk->file) != count) return false;
    walk->at += count;
    return true;
}

/* EXR files are little-endian, as the machines that glint runs on. */
static bool take_int(struct walk *walk, int32_t *value) {
    return take(walk, value, sizeof *value);
}

static bool take_text(struct walk *walk, char text[256]) {
    for (size_t i = 0; i < 256; i++) {
        if (!take(walk, &text[i], 1)) return false;
        if (!text[i]) return true;
    }
    return false;
}

/* ---- Headers ---- */

static bool take_channels(struct walk *walk, struct damaged_part *part) {
    while (part->channel_count < DAMAGED_CHANNELS) {
        struct damaged_channel *channel = &part->channels[part->channel_count];
        uint8_t rest[12];
        char name[sizeof channel->name];
        if (!take_text(walk, name)) return false;
        if (!name[0]) return true;
        shown_text(channel->name, sizeof channel->name, name);
        if (!take(walk, &channel->type, 4) || !take(walk, rest, sizeof rest)) return false;
        part->channel_count++;
    }
    return true;
}

static bool take_value(struct walk *walk, struct damaged_part *part, const char *name, int32_t bytes) {
    int32_t box[4], chunks;
    if (!strcmp(name, "channels")) return take_channels(walk, part);
    if (!strcmp(name, "name") && bytes > 0 && bytes < 256) {
        char text[sizeof part->name] = "";
        if (!take(walk, text, (size_t)bytes)) return false;
        shown_text(part->name, sizeof part->name, text);
    }
    if (!strcmp(name, "dataWindow") && bytes == sizeof box) {
        if (!take(walk, box, sizeof box)) return false;
        part->width = (int64_t)box[2] - box[0] + 1;
        part->height = (int64_t)box[3] - box[1] + 1;
    }
    if (!strcmp(name, "chunkCount") && bytes == sizeof chunks) {
        if (!take_int(walk, &chunks)) return false;
        part->chunks = chunks;
    }
    return true;
}

/* *end: the header has no more attributes. */
static bool take_attribute(struct walk *walk, struct damaged_part *part, bool *end) {
    const uint64_t start = walk->at;
    char name[256], type[256];
    int32_t bytes;
    if (!take_text(walk, name))
        return fault(walk, "the name of an attribute, from byte %llu on, has no end", (unsigned long long)start);
    *end = !name[0];
    if (*end) return true;
    if (!take_text(walk, type) || !take_int(walk, &bytes))
        return fault(walk, "attribute %.60s at byte %llu: its type and size are cut off", name,
                     (unsigned long long)start);
    const uint64_t value = walk->at;
    if (bytes < 0 || (uint64_t)bytes > walk->size - value)
        return fault(
            walk, "attribute %.60s at byte %llu: %d bytes of %.40s from byte %llu on, but the file ends at byte %llu",
            name, (unsigned long long)start, bytes, type, (unsigned long long)value, (unsigned long long)walk->size);
    if (!take_value(walk, part, name, bytes) || walk->at > value + (uint64_t)bytes)
        return fault(walk, "attribute %.60s at byte %llu: its value is damaged", name, (unsigned long long)start);
    part->attribute_count++;
    return seek(walk, value + (uint64_t)bytes);
}

static struct damaged_part *add_part(struct damaged *to) {
    struct damaged_part *larger = realloc(to->parts, (to->count + 1) * sizeof *larger);
    if (!larger) return NULL;
    to->parts = larger;
    larger[to->count] = (struct damaged_part){.chunks = -1};
    return &larger[to->count++];
}

/* *end: an empty header, which closes the list of a multi-part file. */
static bool take_header(struct walk *walk, bool multi_part, bool *end) {
    const uint64_t start = walk->at;
    struct damaged_part *part = add_part(walk->to);
    bool last = false;
    if (!part) return fault(walk, "out of memory");
    part->multi_part = multi_part;
    while (!last) {
        if (part->attribute_count > ATTRIBUTES_MAX)
            return fault(walk, "more than %d attributes in one header", ATTRIBUTES_MAX);
        if (!take_attribute(walk, part, &last)) return false;
    }
    *end = part->attribute_count == 0;
    if (*end) walk->to->count--;
    else part->complete = true;
    part->bytes = (int64_t)(walk->at - start);
    return true;
}

static bool take_headers(struct walk *walk) {
    int32_t magic, version;
    bool end = false;
    if (!take_int(walk, &magic) || !take_int(walk, &version)) return fault(walk, "the first 8 bytes are cut off");
    const bool multi_part = version & MULTI_PART;
    do {
        if (walk->to->count > PARTS_MAX) return fault(walk, "more than %d parts", PARTS_MAX);
        if (!take_header(walk, multi_part, &end)) {
            char text[400];
            snprintf(text, sizeof text, "%.390s", walk->to->fault);
            snprintf(walk->to->fault, sizeof walk->to->fault, "header %zu: %s", walk->to->count, text);
            return false;
        }
    } while (multi_part && !end);
    return true;
}

/* ---- Chunks ---- */

/* Whether a chunk of a multi-part scanline file is in the file: part, line, bytes, and those bytes. */
static bool has_chunk(struct walk *walk, uint64_t offset, size_t part) {
    int32_t head[3];
    return offset && seek(walk, offset) && take(walk, head, sizeof head) && head[0] == (int32_t)part && head[2] >= 0 &&
           (uint64_t)head[2] <= walk->size - walk->at;
}

static void count_chunks(struct walk *walk) {
    uint64_t table = walk->at;
    for (size_t p = 0; p < walk->to->count; p++) {
        struct damaged_part *part = &walk->to->parts[p];
        if (!part->multi_part || part->chunks < 0) return; /* the table's length is not stated */
        for (int64_t c = 0; c < part->chunks; c++) {
            uint64_t offset = 0;
            if (!seek(walk, table + 8 * (uint64_t)c) || !take(walk, &offset, sizeof offset)) {
                fault(walk, "part %.200s: the table of its chunks is cut off at byte %llu", part->name,
                      (unsigned long long)walk->size);
                return;
            }
            if (has_chunk(walk, offset, p)) part->whole++;
            else
                fault(walk,
                      "part %.200s: chunk %lld of %lld, at byte %llu, is not in the file, which ends at byte %llu",
                      part->name, (long long)c, (long long)part->chunks, (unsigned long long)offset,
                      (unsigned long long)walk->size);
        }
        table += 8 * (uint64_t)part->chunks;
    }
}

/* ---- The calls ---- */

bool damaged_read(struct damaged *damaged, const char *path, struct glint_error *err) {
    *damaged = (struct damaged){0};
    struct walk walk = {.file = fopen(path, "rb"), .to = damaged};
    int32_t magic = 0;
    if (!walk.file) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (fseeko(walk.file, 0, SEEK_END) == 0) walk.size = (uint64_t)ftello(walk.file);
    const bool is_exr = seek(&walk, 0) && take_int(&walk, &magic) && magic == MAGIC && seek(&walk, 0);
    if (is_exr && take_headers(&walk)) count_chunks(&walk);
    fclose(walk.file);
    return is_exr || glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected an EXR file, found other bytes", path);
}

void damaged_finish(struct damaged *damaged) {
    free(damaged->parts);
    *damaged = (struct damaged){0};
}

static const char *type_name(uint32_t type) {
    static const char *const names[] = {"uint", "half", "float"};
    return type < 3 ? names[type] : "unknown type";
}

void damaged_print(const struct damaged *damaged) {
    static const char *const titles[] = {"<part", ">size", ">attributes", ">whole chunks", "<channels", NULL};
    struct table *table = table_create(titles);
    for (size_t p = 0; p < damaged->count; p++) {
        const struct damaged_part *part = &damaged->parts[p];
        char channels[400] = "";
        for (size_t c = 0; c < part->channel_count; c++) {
            const bool new_type = c == 0 || part->channels[c].type != part->channels[c - 1].type;
            const size_t used = strlen(channels);
            snprintf(channels + used, sizeof channels - used, "%s%s%s%.80s", c ? " " : "",
                     new_type ? type_name(part->channels[c].type) : "", new_type ? ": " : "", part->channels[c].name);
        }
        table_cell(table, "%s%s", part->name[0] ? part->name : "–", part->complete ? "" : " (its header breaks)");
        if (part->width) table_cell(table, "%lld × %lld", (long long)part->width, (long long)part->height);
        else table_cell(table, "–");
        table_cell(table, "%zu", part->attribute_count);
        if (part->chunks < 0 || !part->complete) table_cell(table, "–");
        else table_cell(table, "%lld of %lld", (long long)part->whole, (long long)part->chunks);
        table_cell(table, "%s", channels);
    }
    table_print(table, stdout);
    table_destroy(&table);
    if (damaged->fault[0]) printf("\nbreaks at: %s\n", damaged->fault);
}

json_t *damaged_json(const struct damaged *damaged) {
    json_t *parts = json_array();
    for (size_t p = 0; p < damaged->count; p++) {
        const struct damaged_part *part = &damaged->parts[p];
        json_t *channels = json_array();
        for (size_t c = 0; c < part->channel_count; c++)
            json_array_append_new(channels, json_pack("{s:s, s:s}", "name", part->channels[c].name, "stored",
                                                      type_name(part->channels[c].type)));
        json_array_append_new(parts, json_pack("{s:s, s:I, s:I, s:b, s:I, s:I, s:I, s:o}", "name", part->name, "width",
                                               (json_int_t)part->width, "height", (json_int_t)part->height,
                                               "header_complete", part->complete, "attributes",
                                               (json_int_t)part->attribute_count, "chunks", (json_int_t)part->chunks,
                                               "whole_chunks", (json_int_t)part->whole, "channels", channels));
    }
    return parts;
}
