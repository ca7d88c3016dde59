/* Mutates OpenEXR files as what they are made of: attributes of parts, and chunks of pixels. What comes out has right sizes and offsets for the
   most part, so that readers get past the headers. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mutate.h"

enum { PARTS = 48, ATTRIBUTES = 2048, CHUNKS = 4096, NAME = 256 };

struct attribute {
    char name[NAME], type[NAME];
    const uint8_t *value;
    uint32_t size;
    size_t part;
};
struct chunk {
    const uint8_t *bytes;
    size_t size, part;
};
struct file {
    uint32_t version;
    size_t parts;
    struct attribute attributes[ATTRIBUTES];
    size_t count;
    struct chunk chunks[CHUNKS];
    size_t chunk_count;
    size_t chunks_of[PARTS];
};
static struct file file;
static uint8_t *original; /* what the file was, to which attributes and chunks point */
static size_t original_room;
static uint8_t changed[1 << 16];

static uint32_t number(const uint8_t *at) {
    uint32_t value;
    memcpy(&value, at, sizeof value);
    return value;
}

/* ---- Reading ---- */

static bool is_multipart(void) {
    return file.version & 0x1000;
}

static bool read_name(const uint8_t **at, const uint8_t *end, char name[NAME]) {
    const uint8_t *zero = memchr(*at, 0, (size_t)(end - *at));
    if (!zero || zero - *at >= NAME) return false;
    memcpy(name, *at, (size_t)(zero - *at) + 1);
    *at = zero + 1;
    return true;
}

static bool read_header(const uint8_t **at, const uint8_t *end) {
    file.chunks_of[file.parts] = 0;
    while (*at < end && **at) {
        struct attribute *a = &file.attributes[file.count];
        if (file.count == ATTRIBUTES || !read_name(at, end, a->name) || !read_name(at, end, a->type) || end - *at < 4)
            return false;
        a->size = number(*at);
        a->value = *at += 4;
        a->part = file.parts;
        if ((size_t)(end - *at) < a->size) return false;
        *at += a->size;
        if (!strcmp(a->name, "chunkCount") && a->size == 4) file.chunks_of[file.parts] = number(a->value);
        /* one part: a chunk a line, as it is not compressed */
        if (!strcmp(a->name, "dataWindow") && a->size == 16 && !is_multipart())
            file.chunks_of[file.parts] = (size_t)number(a->value + 12) - number(a->value + 4) + 1;
        file.count++;
    }
    if (*at == end) return false;
    ++*at;
    file.parts++;
    return true;
}

static void read_chunk(const uint8_t *start, const uint8_t *end, uint64_t offset, size_t part) {
    const size_t head = is_multipart() ? 12 : 8;
    if (file.chunk_count == CHUNKS || offset > (uint64_t)(end - start) || (uint64_t)(end - start) - offset < head)
        return;
    const uint8_t *at = start + offset;
    const size_t size = number(at + head - 4);
    if (size <= (size_t)(end - at) - head) file.chunks[file.chunk_count++] = (struct chunk){at, head + size, part};
}

/* False for what does not look like a file of parts in scan lines. */
static bool read_file(const uint8_t *data, size_t size) {
    const uint8_t *at = data + 8, *end = data + size;
    if (size < 16 || number(data) != 20000630) return false;
    file = (struct file){.version = number(data + 4)};
    do {
        if (file.parts == PARTS || !read_header(&at, end)) return false;
    } while (is_multipart() && at < end && *at);
    if (is_multipart()) at++;
    for (size_t part = 0; part < file.parts; part++)
        for (size_t i = 0; i < file.chunks_of[part]; i++, at += 8) {
            if (at > end || end - at < 8) return true;
            uint64_t offset;
            memcpy(&offset, at, sizeof offset);
            read_chunk(data, end, offset, part);
        }
    return true;
}

/* ---- Writing ---- */

struct out {
    uint8_t *data;
    size_t size, most;
};

static void write_bytes(struct out *out, const void *bytes, size_t size) {
    if (out->size <= out->most && size <= out->most - out->size) memcpy(out->data + out->size, bytes, size);
    out->size += size;
}

static size_t write_headers(struct out *out) {
    const uint32_t magic = 20000630;
    write_bytes(out, &magic, 4);
    write_bytes(out, &file.version, 4);
    for (size_t part = 0; part < file.parts; part++) {
        for (size_t i = 0; i < file.count; i++) {
            const struct attribute *a = &file.attributes[i];
            if (a->part != part) continue;
            write_bytes(out, a->name, strlen(a->name) + 1);
            write_bytes(out, a->type, strlen(a->type) + 1);
            write_bytes(out, &a->size, 4);
            write_bytes(out, a->value, a->size);
        }
        write_bytes(out, "", 1);
    }
    if (is_multipart()) write_bytes(out, "", 1);
    return out->size;
}

/* The file's new size; 0 if there is no room for it. */
static size_t write_file(uint8_t *data, size_t most) {
    struct out out = {data, 0, most};
    uint64_t offset = write_headers(&out) + 8 * file.chunk_count;
    for (size_t i = 0; i < file.chunk_count; offset += file.chunks[i++].size) write_bytes(&out, &offset, 8);
    for (size_t i = 0; i < file.chunk_count; i++) {
        const size_t at = out.size;
        const uint32_t part = (uint32_t)file.chunks[i].part;
        write_bytes(&out, file.chunks[i].bytes, file.chunks[i].size);
        if (is_multipart() && out.size <= most) memcpy(data + at, &part, 4);
    }
    return out.size <= most ? out.size : 0;
}

/* ---- Changes ---- */

/* Bytes that replace others come from here, one after the other. */
static uint8_t *room_for(size_t size) {
    static size_t used;
    if (size > sizeof changed) return NULL;
    if (used + size > sizeof changed) used = 0;
    used += size;
    return changed + used - size;
}

static void odd_number(uint8_t *at, size_t width, uint64_t *state) {
    static const float floats[] = {0,        -0.f,      1,   -1,    1e-40f, 3.4e38f, -3.4e38f,
                                   INFINITY, -INFINITY, NAN, 65504, 65536,  0.5f};
    static const uint64_t words[] = {0, 1, UINT64_MAX, 0x7fffffff, 0x80000000u, 0x7fffffffffffffff, 255, 65535, 32768};
    const float real = floats[draw(state, sizeof floats / sizeof *floats)];
    const double precise = draw(state, 4) ? (double)real : 1e308;
    const uint64_t word = words[draw(state, sizeof words / sizeof *words)];
    if (draw(state, 2)) memcpy(at, &word, width);
    else if (width == 8) memcpy(at, &precise, 8);
    else if (width == 4) memcpy(at, &real, 4);
    else memcpy(at, (const uint8_t *)&real + 2, width < 2 ? width : 2);
}

static void change_value(struct attribute *a, uint64_t *state) {
    const size_t most = a->size + 64;
    uint8_t *value = most <= 8192 ? room_for(most) : NULL;
    if (!value) return;
    memcpy(value, a->value, a->size);
    if (draw(state, 2) && a->size >= 4) {
        const size_t width = a->size % 8 == 0 && draw(state, 4) ? 8 : 4;
        odd_number(value + width * draw(state, a->size / width), width, state);
    } else a->size = (uint32_t)LLVMFuzzerMutate(value, a->size, draw(state, 4) ? a->size : most);
    a->value = value;
}

static void change_name(char name[NAME]) {
    uint8_t bytes[NAME] = {0};
    memcpy(bytes, name, strlen(name));
    const size_t size = LLVMFuzzerMutate(bytes, strlen(name), NAME - 1);
    bytes[size] = 0;
    if (bytes[0]) memcpy(name, bytes, strlen((const char *)bytes) + 1);
}

static void add_attribute(size_t from, size_t part) {
    if (file.count == ATTRIBUTES) return;
    file.attributes[file.count] = file.attributes[from];
    file.attributes[file.count++].part = part;
}

static void remove_attribute(size_t i) {
    memmove(&file.attributes[i], &file.attributes[i + 1], (file.count - i - 1) * sizeof file.attributes[0]);
    file.count--;
}

static void remove_part(size_t part) {
    for (size_t i = file.count; i-- > 0;)
        if (file.attributes[i].part == part) remove_attribute(i);
        else file.attributes[i].part -= file.attributes[i].part > part;
    size_t kept = 0;
    for (size_t i = 0; i < file.chunk_count; i++) {
        if (file.chunks[i].part == part) continue;
        file.chunks[kept] = file.chunks[i];
        file.chunks[kept++].part -= file.chunks[i].part > part;
    }
    file.chunk_count = kept;
    file.parts--;
}

static void change_chunk(struct chunk *chunk, uint64_t *state) {
    uint8_t *bytes = chunk->size <= sizeof changed / 4 ? room_for(chunk->size) : NULL;
    const size_t head = is_multipart() ? 12 : 8;
    if (!bytes || chunk->size <= head) return;
    memcpy(bytes, chunk->bytes, chunk->size);
    for (size_t i = 1 + draw(state, 8); i > 0; i--) {
        const size_t width = (size_t)1 << draw(state, 3), places = (chunk->size - head) / width;
        if (places) odd_number(bytes + head + width * draw(state, places), width, state);
    }
    if (!draw(state, 4)) LLVMFuzzerMutate(bytes, chunk->size, chunk->size);
    chunk->bytes = bytes;
}

static void change_file(uint64_t *state) {
    const size_t at = draw(state, file.count), other = draw(state, file.count), part = draw(state, file.parts);
    struct attribute *a = &file.attributes[at], *b = &file.attributes[other];
    switch (draw(state, 16)) {
    case 0:
        remove_attribute(at);
        break;
    case 1:
        add_attribute(at, part);
        break;
    case 2:
        memcpy(a->name, b->name, NAME);
        break;
    case 3:
        memcpy(a->type, b->type, NAME);
        break;
    case 4:
        change_name(draw(state, 4) ? a->name : a->type);
        break;
    case 5:
        a->value = b->value;
        a->size = b->size;
        break;
    case 6:
        if (file.parts > 1 && is_multipart()) remove_part(part);
        break;
    case 7:
    case 8:
    case 9:
        if (file.chunk_count) change_chunk(&file.chunks[draw(state, file.chunk_count)], state);
        break;
    default:
        change_value(a, state);
    }
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed) {
    uint64_t state = seed;
    if (size > original_room) {
        free(original);
        original = malloc(original_room = 2 * size);
    }
    if (!original || !size || !draw(&state, 8)) return LLVMFuzzerMutate(data, size, most);
    memcpy(original, data, size);
    if (!read_file(original, size)) return LLVMFuzzerMutate(data, size, most);
    for (size_t i = 1 + draw(&state, 3); i > 0 && file.count; i--) change_file(&state);
    const size_t written = write_file(data, most);
    return written ? written : LLVMFuzzerMutate(data, size, most);
}
