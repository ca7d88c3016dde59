/* A part: channels, each a plane of floats that is converted to the type of an engine's buffer. */
#include "dump_part.h"

#include <Imath/half.h>
#include <stdlib.h>

void dump_begin(struct dump_part *part, const struct dump *dump, const char *name, uint32_t width, uint32_t height) {
    *part = (struct dump_part){.part = {.name = name, .width = width, .height = height, .encodings = dump->encodings},
                               .pixels = (size_t)width * height};
}

static const size_t type_bytes[] = {
    [GLINT_F16] = 2, [GLINT_F32] = 4, [GLINT_U16] = 2, [GLINT_U32] = 4, [GLINT_UNORM8] = 1, [GLINT_UNORM16] = 2};

static void convert(enum glint_type type, const float *source, size_t stride, size_t count, void *out) {
    uint16_t *words = out;
    uint8_t *bytes = out;
    float *floats = out;
    for (size_t i = 0; i < count; i++) {
        float v = source[i * stride];
        switch (type) {
        case GLINT_F16:
            /* Saturates like a game's buffer: finite values are clamped to the largest half, infinity stays. */
            words[i] = imath_float_to_half(isfinite(v) ? clampf(v, -65504, 65504) : v);
            break;
        case GLINT_U16:
            words[i] = (uint16_t)v;
            break;
        case GLINT_UNORM16:
            words[i] = (uint16_t)(clampf(v, 0, 1) * 65535 + 0.5f);
            break;
        case GLINT_UNORM8:
            bytes[i] = (uint8_t)(clampf(v, 0, 1) * 255 + 0.5f);
            break;
        default:
            floats[i] = v;
        }
    }
}

void dump_channel(struct dump_part *part, const char *name, struct storage storage, const float *source,
                  size_t stride_bytes) {
    size_t i = part->part.channel_count++;
    part->memory[i] = malloc(part->pixels * type_bytes[storage.type]);
    if (!part->memory[i]) {
        part->failed = true;
        return;
    }
    convert(storage.type, source, stride_bytes / sizeof(float), part->pixels, part->memory[i]);
    part->channels[i] =
        (struct glint_channel){.name = name, .type = storage.type, .data = part->memory[i], .storage = storage.name};
}

void dump_channels3(struct dump_part *part, const char *const names[3], struct storage storage, const vec3 *source,
                    size_t stride_bytes) {
    dump_channel(part, names[0], storage, &source->x, stride_bytes);
    dump_channel(part, names[1], storage, &source->y, stride_bytes);
    dump_channel(part, names[2], storage, &source->z, stride_bytes);
}

bool dump_end(struct dump_part *part, const struct dump *dump, struct glint_error *err) {
    const struct glint_attribute settings = {
        .name = "sampleSettings", .type = GLINT_ATTRIBUTE_STRING, .string = dump->settings};
    if (dump->settings && !part->part.attribute_count) {
        part->part.attributes = &settings;
        part->part.attribute_count = 1;
    }
    part->part.channels = part->channels;
    bool ok = part->failed ? glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", part->part.name)
                           : glint_writer_add_part(dump->writer, &part->part, err);
    for (size_t i = 0; i < part->part.channel_count; i++) free(part->memory[i]);
    return ok;
}

static const char *const rgb[3] = {"R", "G", "B"};
const struct storage dump_half = {GLINT_F16, "RGBA16F"}, dump_float = {GLINT_F32, "R32F"};

static vec3 *encoded_colors(const struct dump *dump, const vec3 *first, size_t stride_bytes, size_t count) {
    vec3 *colors = malloc(count * sizeof *colors);
    for (size_t i = 0; colors && i < count; i++) {
        const vec3 *color = (const vec3 *)(const void *)((const char *)first + i * stride_bytes);
        colors[i] = encode_color(dump->encodings.color, dump->pre_exposure, *color);
    }
    return colors;
}

bool dump_colors(struct dump_part *part, const struct dump *dump, const char *name, uint32_t width, uint32_t height,
                 struct storage storage, const vec3 *first, size_t stride_bytes, struct glint_error *err) {
    dump_begin(part, dump, name, width, height);
    vec3 *colors = encoded_colors(dump, first, stride_bytes, part->pixels);
    if (!colors) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", name);
    dump_channels3(part, rgb, storage, colors, sizeof(vec3));
    free(colors);
    return true;
}
