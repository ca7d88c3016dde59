/* The values of a part's channels: their types, their storage formats, and every texel. */
#include "convert.h"

#include <Imath/half.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "threads.h"

/* ---- Types and storage ---- */

static bool is_packed(const struct part *part, const struct glint_role_channel *row) {
    return (!strcmp(row->encoding, "motion") && part->encodings.motion == GLINT_MOTION_PACKED16) ||
           (!strcmp(row->encoding, "motion_depth") && part->encodings.motion_depth == GLINT_MOTION_DEPTH_PACKED16);
}

/* Whether the capture holds integers in this channel. */
static bool wants_integers(const struct part *part, const struct channel *channel) {
    const struct glint_role_channel *row = role_channel(part->role, channel->name);
    if (row) return !strcmp(row->name, "stencil.id") || is_packed(part, row);
    if (channel->is_typed) return channel->stored == GLINT_STORED_UINT;
    return channel->texture && !channel->is_scaled && channel->sources[0]->component.kind == COMPONENT_UINT;
}

/* Whether sRGB codes are decoded: not where the part declares that it holds them. */
static bool decodes_srgb(const struct part *part, const struct channel *channel) {
    const struct glint_role_channel *row = role_channel(part->role, channel->name);
    const bool declared = row && !strcmp(row->encoding, "color") && part->encodings.color == GLINT_COLOR_SRGB;
    return channel->texture->decode_srgb && !declared;
}

static enum glint_stored type_of(const struct part *part, const struct channel *channel) {
    const struct component *component = &channel->sources[0]->component;
    if (channel->is_scaled) return GLINT_STORED_FLOAT;
    switch (component->kind) {
    case COMPONENT_FLOAT:
        return component->bits == 16 ? GLINT_STORED_HALF : GLINT_STORED_FLOAT;
    case COMPONENT_UFLOAT:
    case COMPONENT_SHARED:
        return GLINT_STORED_HALF;
    case COMPONENT_UNORM:
    case COMPONENT_SNORM:
        return component->bits <= 8 ? GLINT_STORED_HALF : GLINT_STORED_FLOAT;
    case COMPONENT_SRGB:
        return decodes_srgb(part, channel) || component->bits > 8 ? GLINT_STORED_FLOAT : GLINT_STORED_HALF;
    case COMPONENT_UINT:
    case COMPONENT_SINT:
        break;
    }
    return GLINT_STORED_FLOAT;
}

/* The step of a fixed-point or integer component after scaling; 0 for floats. */
static double step_of(const struct channel *channel) {
    const struct component *c = &channel->sources[0]->component;
    if (component_is_integer(c)) return fabs(channel->scale);
    if (c->kind == COMPONENT_UNORM) return fabs(channel->scale) / (ldexp(1, c->bits) - 1);
    if (c->kind == COMPONENT_SNORM) return fabs(channel->scale) / (ldexp(1, c->bits - 1) - 1);
    return 0;
}

static bool is_own_letter(const struct channel *channel, char letter) {
    const char *dot = strrchr(channel->name, '.'), *last = dot ? dot + 1 : channel->name;
    const char *as = last[0] && !last[1] ? strchr("RGBXYZ", last[0]) : NULL;
    return as && "rgbrgb"[as - "RGBXYZ"] == letter;
}

static void name_float(struct channel *channel) {
    const struct component *c = &channel->sources[0]->component;
    char *out = channel->storage;
    const size_t size = sizeof channel->storage;
    if (c->kind == COMPONENT_SHARED) snprintf(out, size, "R9G9B9E5");
    else if (c->kind == COMPONENT_UFLOAT && is_own_letter(channel, c->letter)) snprintf(out, size, "R11G11B10");
    else if (c->kind == COMPONENT_UFLOAT) snprintf(out, size, "R%uF", c->bits);
    else if (c->letter == 'd') snprintf(out, size, "D32F");
    else snprintf(out, size, c->bits == 16 ? "half" : "float");
}

/* Fixed point whose step is nearest to the scaled one. */
static void name_scaled(struct channel *channel) {
    const double step = step_of(channel);
    const long bits = step > 0 && step <= 1 ? lround(log2(1 / step + 1)) : 0;
    if (bits >= 1 && bits <= 32) snprintf(channel->storage, sizeof channel->storage, "unorm%ld", bits);
    else snprintf(channel->storage, sizeof channel->storage, "float");
}

static void name_storage(const struct part *part, struct channel *channel) {
    const struct component *c = &channel->sources[0]->component;
    char *out = channel->storage;
    const size_t size = sizeof channel->storage;
    if (channel->is_integer) {
        if (c->bits <= 16) snprintf(out, size, c->bits <= 8 ? "uint8" : "uint16");
        else snprintf(out, size, "uint");
    } else if (c->kind == COMPONENT_FLOAT || c->kind == COMPONENT_UFLOAT || c->kind == COMPONENT_SHARED)
        name_float(channel);
    else if (c->kind == COMPONENT_SRGB && decodes_srgb(part, channel)) snprintf(out, size, "R%u_SRGB", c->bits);
    else if (channel->is_scaled || component_is_integer(c)) name_scaled(channel);
    else if (c->letter == 'd') snprintf(out, size, "D%u", c->bits);
    else snprintf(out, size, "%snorm%u", c->kind == COMPONENT_SNORM ? "s" : "u", c->bits);
}

static bool is_half(double value) {
    return (double)imath_half_to_float(imath_float_to_half((float)value)) == value;
}

static bool choose_constant(struct channel *channel, struct glint_error *err) {
    const double value = channel->scale * channel->value + channel->offset;
    if (channel->is_integer && !(value >= 0 && value <= (double)UINT32_MAX && value == floor(value)))
        return node_fail(&channel->node, err, GLINT_ERROR_FORMAT, "expected an integer of 32 bits, found %.17g", value);
    if (channel->is_integer) channel->stored = GLINT_STORED_UINT;
    else if (!channel->is_typed) channel->stored = is_half(value) ? GLINT_STORED_HALF : GLINT_STORED_FLOAT;
    if (!channel->storage[0])
        snprintf(channel->storage, sizeof channel->storage,
                 channel->is_integer                    ? "uint"
                 : channel->stored == GLINT_STORED_HALF ? "half"
                                                        : "float");
    return true;
}

static bool choose_one(const struct part *part, struct channel *channel, struct glint_error *err) {
    const struct glint_role_channel *row = role_channel(part->role, channel->name);
    channel->is_integer = wants_integers(part, channel);
    if (row && channel->is_typed && channel->is_integer != (channel->stored == GLINT_STORED_UINT))
        return node_fail(&channel->node, err, GLINT_ERROR_FORMAT, "type: expected %s",
                         channel->is_integer ? "uint" : "half or float");
    if (!channel->texture) return choose_constant(channel, err);
    const struct component *component = &channel->sources[0]->component;
    const struct image *image = &channel->texture->images[0];
    if (channel->is_integer && !component_is_integer(component) && component->kind != COMPONENT_FLOAT &&
        !image->is_ambiguous)
        return node_fail(&channel->node, err, GLINT_ERROR_FORMAT,
                         "expected integers, found %s, which stands for [0, 1]: name the format …_UINT", image->format);
    if (channel->is_integer) channel->stored = GLINT_STORED_UINT;
    else if (!channel->is_typed) channel->stored = type_of(part, channel);
    if (!channel->storage[0]) name_storage(part, channel);
    return true;
}

bool channels_choose(struct part *part, struct glint_error *err) {
    static const char *const types[] = {"half", "float", "uint"};
    for (size_t i = 0; i < part->count; i++) {
        struct channel *channel = &part->channels[i];
        if (!choose_one(part, channel, err)) return false;
        const struct node node = node_child(&part->node, channel->name);
        if (channel->texture)
            node_note(&node, GLINT_PACK_SAID, "%s.%s%s, stored as %s, precise as %s", channel->texture->node.key,
                      channel->sources[0]->name, channel->is_scaled ? ", scaled" : "", types[channel->stored],
                      channel->storage);
        else
            node_note(&node, GLINT_PACK_SAID, "%.9g for all texels, stored as %s",
                      channel->scale * channel->value + channel->offset, types[channel->stored]);
    }
    return true;
}

/* ---- Texels ---- */

struct job {
    const struct part *part;
    const struct channel *channel;
    bool decode_srgb;
};

static const uint8_t *texel_at(const struct channel *channel, uint32_t x, uint32_t y) {
    const struct texture *texture = channel->texture;
    struct place place = {.x = x, .y = texture->bottom_first ? texture->height - 1 - y : y};
    if (texture->is_cube) place = cube_place(&texture->cube, (int)(y / texture->cube.size), x, y % texture->cube.size);
    const struct source *source = channel->sources[place.image];
    return texture->images[place.image].bytes.data + source->first +
           (size_t)(texture->layer + place.layer) * source->layer_pitch + (size_t)place.y * source->row_pitch +
           (size_t)place.x * source->x_step;
}

/* Half and float are kept bit for bit, also NaNs. */
static bool is_copied(const struct channel *channel) {
    const struct component *c = &channel->sources[0]->component;
    return !channel->is_scaled && c->kind == COMPONENT_FLOAT &&
           ((c->bits == 16 && channel->stored == GLINT_STORED_HALF) ||
            (c->bits == 32 && channel->stored == GLINT_STORED_FLOAT));
}

static bool store_integer(const struct channel *channel, const struct component *component, uint64_t code, size_t at,
                          double *bad) {
    double value = component->kind == COMPONENT_FLOAT || component->kind == COMPONENT_SINT
                       ? component_value(component, code, false)
                       : (double)code;
    value = channel->scale * value + channel->offset;
    if (!(value >= 0 && value <= (double)UINT32_MAX && value == floor(value))) return *bad = value, false;
    ((uint32_t *)channel->data)[at] = (uint32_t)value;
    return true;
}

static void store_number(const struct job *job, const struct component *component, uint64_t code, size_t at) {
    const struct channel *channel = job->channel;
    double value = component_value(component, code, job->decode_srgb);
    if (channel->is_scaled) value = channel->scale * value + channel->offset;
    if (channel->stored == GLINT_STORED_FLOAT) ((float *)channel->data)[at] = (float)value;
    else ((uint16_t *)channel->data)[at] = imath_float_to_half((float)value);
}

static bool convert_row(void *user, uint32_t worker, size_t row) {
    const struct job *job = user;
    const struct channel *channel = job->channel;
    const uint32_t width = job->part->width;
    const struct component *component = channel->texture ? &channel->sources[0]->component : NULL;
    const bool copied = channel->texture && is_copied(channel);
    double bad;
    (void)worker;
    for (uint32_t x = 0; x < width; x++) {
        const size_t at = row * width + x;
        if (!component) {
            const double value = channel->scale * channel->value + channel->offset;
            if (channel->is_integer) ((uint32_t *)channel->data)[at] = (uint32_t)value;
            else if (channel->stored == GLINT_STORED_FLOAT) ((float *)channel->data)[at] = (float)value;
            else ((uint16_t *)channel->data)[at] = imath_float_to_half((float)value);
            continue;
        }
        const uint8_t *texel = texel_at(channel, x, (uint32_t)row);
        const uint64_t code = component_code(component, texel);
        if (channel->is_integer) {
            if (!store_integer(channel, component, code, at, &bad)) return false;
        } else if (copied && component->bits == 16) ((uint16_t *)channel->data)[at] = (uint16_t)code;
        else if (copied) memcpy((float *)channel->data + at, &(uint32_t){(uint32_t)code}, 4);
        else store_number(job, component, code, at);
    }
    return true;
}

/* The first texel that is no integer, for the message. */
static bool not_integers(const struct part *part, const struct channel *channel, struct glint_error *err) {
    const struct component *component = &channel->sources[0]->component;
    for (uint32_t y = 0; y < part->height; y++)
        for (uint32_t x = 0; x < part->width; x++) {
            double bad;
            if (!store_integer(channel, component, component_code(component, texel_at(channel, x, y)), 0, &bad))
                return node_fail(&channel->node, err, GLINT_ERROR_FORMAT,
                                 "expected integers of 32 bits, found %.9g at %u, %u", bad, x, y);
        }
    return node_fail(&channel->node, err, GLINT_ERROR_FORMAT, "expected integers of 32 bits");
}

bool channels_convert(struct part *part, struct glint_error *err) {
    for (size_t i = 0; i < part->count; i++) {
        struct channel *channel = &part->channels[i];
        struct job job = {part, channel, channel->texture && decodes_srgb(part, channel)};
        const size_t bytes = channel->stored == GLINT_STORED_HALF ? 2 : 4;
        channel->data = malloc((size_t)part->width * part->height * bytes);
        if (!channel->data) return node_no_memory(&channel->node, err);
        if (!glint_loop(part->height, glint_loop_workers(part->height, part->threads), convert_row, &job))
            return not_integers(part, channel, err);
    }
    return true;
}
