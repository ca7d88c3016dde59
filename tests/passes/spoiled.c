#include "spoiled.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

const char *const spoiled_names[SPOILED_KINDS] = {"colour",  "depth",   "normal", "material", "motion",    "cube map",
                                                  "history", "overlay", "air",    "other",    "attribute", "any"};

static uint32_t draw(uint32_t *state, uint32_t below) {
    uint32_t x = *state += 0x9E3779B9u; /* the finalizer of MurmurHash3: seeds next to each other draw other numbers */
    x = (x ^ x >> 16) * 0x85EBCA6Bu;
    x = (x ^ x >> 13) * 0xC2B2AE35u;
    return (uint32_t)((uint64_t)(x ^ x >> 16) * below >> 32);
}

/* ---- Values ---- */

static const float floats[] = {NAN,     INFINITY, -INFINITY, 3.4e38f, -3.4e38f, 3e38f, 1e30f,  -1e30f,   1e20f,  -1e20f,
                               65536,   -65536,   65504,     -65504,  1e6f,     -1e6f, 1e-20f, 1e-30f,   1e-38f, 1e-40f,
                               -1e-40f, 1.4e-45f, -0.0f,     0,       -1,       1,     2,      0.99999f, 300,    1e-6f};
static const uint16_t halves[] = {0x7E00, 0xFE00, 0x7C00, 0xFC00, 0x7BFF, 0xFBFF, 0x7BFF, 0x0001,
                                  0x8001, 0x03FF, 0x0400, 0x8000, 0x0000, 0xBC00, 0x3C00, 0x4000};
static const uint32_t whole[] = {0, 1, 127, 128, 255, 256, 65535, UINT32_MAX};

union value {
    float f;
    uint16_t h;
    uint32_t u;
};
static union value any_value(enum glint_stored stored, uint32_t *state) {
    union value value = {.u = 0};
    if (stored == GLINT_STORED_FLOAT) value.f = floats[draw(state, sizeof floats / sizeof *floats)];
    else if (stored == GLINT_STORED_HALF) value.h = halves[draw(state, sizeof halves / sizeof *halves)];
    else value.u = whole[draw(state, sizeof whole / sizeof *whole)];
    return value;
}

static bool is_finite(enum glint_stored stored, union value value) {
    return stored == GLINT_STORED_UINT ||
           (stored == GLINT_STORED_HALF ? (value.h & 0x7C00) != 0x7C00 : isfinite(value.f));
}

static double number_of(enum glint_stored stored, union value value) {
    if (stored == GLINT_STORED_FLOAT) return (double)value.f;
    if (stored == GLINT_STORED_UINT) return value.u;
    const double part = value.h & 0x3FF, sign = value.h >> 15 ? -1 : 1;
    const int exponent = value.h >> 10 & 31;
    if (exponent == 31) return part > 0 ? (double)NAN : sign * (double)INFINITY;
    return sign * (exponent ? ldexp(1024 + part, exponent - 25) : ldexp(part, -24));
}

/* ---- Channels ---- */

static bool begins(const char *text, const char *with) {
    return strncmp(text, with, strlen(with)) == 0;
}

static enum spoiled_kind kind_of(const char *part, const char *channel) {
    static const struct {
        const char *part, *channel;
        enum spoiled_kind kind;
    } kinds[] = {
        {"gbuffer", "depth", SPOILED_DEPTH},
        {"gbuffer", "normal", SPOILED_NORMAL},
        {"gbuffer", "vertexNormal", SPOILED_NORMAL},
        {"gbuffer", "motion", SPOILED_MOTION},
        {"gbuffer", "", SPOILED_MATERIAL},
        {"lit", "", SPOILED_COLOUR},
        {"scene", "", SPOILED_COLOUR},
        {"indirect", "", SPOILED_COLOUR},
        {"lamps", "", SPOILED_COLOUR},
        {"emissive", "", SPOILED_COLOUR},
        {"cubemap", "", SPOILED_CUBE},
        {"probe", "", SPOILED_CUBE},
        {"planar", "", SPOILED_CUBE},
        {"previous", "", SPOILED_HISTORY},
        {"water", "", SPOILED_OVERLAY},
        {"transparent", "", SPOILED_OVERLAY},
        {"sky", "", SPOILED_AIR},
        {"froxels", "", SPOILED_AIR},
        {"stars", "", SPOILED_AIR},
        {"cloud", "", SPOILED_AIR},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (begins(part, kinds[i].part) && begins(channel, kinds[i].channel)) return kinds[i].kind;
    return begins(part, "truth") || begins(part, "frame") ? SPOILED_KINDS : SPOILED_OTHER;
}

/* The part and channel with this number among those of the kind; their count where there is none. */
static size_t find_channel(struct rewrite *r, enum spoiled_kind kind, size_t number, size_t at[2]) {
    size_t count = 0;
    for (size_t p = 0; p < r->count; p++)
        for (size_t c = 0; c < r->parts[p].part.channel_count; c++) {
            const enum spoiled_kind found = kind_of(r->parts[p].name, r->parts[p].channels[c].name);
            if (found == SPOILED_KINDS || (kind != SPOILED_ANY && found != kind)) continue;
            if (count++ == number) at[0] = p, at[1] = c;
        }
    return count;
}

/* The channel in 32 bits, which hold more than halves. Its memory has room for them. */
static void widen(struct rewrite_part *part, size_t c) {
    uint32_t *texels = part->data[c];
    for (size_t i = (size_t)part->part.width * part->part.height;
         i-- > 0;) { /* the last one first, as each takes the place of two */
        union value half = {.u = 0}, wide;
        memcpy(&half.h, (const uint16_t *)part->data[c] + i, sizeof half.h);
        wide.f = (float)number_of(GLINT_STORED_HALF, half);
        memcpy(&texels[i], &wide.f, sizeof wide.f);
    }
    part->channels[c].stored = GLINT_STORED_FLOAT;
}

static void note(struct spoiled *out, const char *part, const char *channel, const char *where, double value) {
    const size_t length = strlen(out->what);
    snprintf(out->what + length, sizeof out->what - length, "%s%s %s %s %g", length ? ", " : "", part, channel, where,
             value);
}

static void set_texel(const struct rewrite_part *part, size_t c, size_t texel, union value value, bool bad,
                      struct spoiled *out) {
    const bool half = part->channels[c].stored == GLINT_STORED_HALF;
    if (half) ((uint16_t *)part->data[c])[texel] = value.h;
    else ((uint32_t *)part->data[c])[texel] = value.u;
    if (bad && part->part.width == out->width && part->part.height == out->height) out->not_finite[texel] = true;
}

/* A rectangle: one texel, a few, or all of them. */
static void spoil_channel(struct rewrite_part *part, size_t c, uint32_t *state, struct spoiled *out) {
    static const char *const sizes[] = {"at a texel", "in a block", "everywhere", "here and there"};
    const struct glint_exr_channel *channel = &part->channels[c];
    if (channel->stored == GLINT_STORED_HALF && draw(state, 3)) widen(part, c);
    const union value value = any_value(channel->stored, state);
    const uint32_t w = part->part.width, h = part->part.height, size = draw(state, 8) % 7 % 4;
    const bool infinite =
        number_of(channel->stored, value) > 1e300 && strchr(channel->name, 'Z') && !strstr(channel->name, "ormal");
    const bool bad = !is_finite(channel->stored, value) && !infinite;
    const uint32_t side = size == 1 ? 2 + draw(state, 7) : 1, repeats = size == 3 ? 8 : 1;
    for (uint32_t k = 0; k < repeats; k++) {
        const uint32_t x0 = size == 2 ? 0 : draw(state, w), y0 = size == 2 ? 0 : draw(state, h);
        for (uint32_t y = y0; y < h && (size == 2 || y < y0 + side); y++)
            for (uint32_t x = x0; x < w && (size == 2 || x < x0 + side); x++)
                set_texel(part, c, (size_t)y * w + x, value, bad, out);
    }
    note(out, part->name, channel->name, sizes[size], number_of(channel->stored, value));
}

/* ---- Attributes ---- */

static bool is_number(const struct glint_exr_attribute *a) {
    return a->type >= GLINT_EXR_FLOAT && a->type <= GLINT_EXR_FLOATS && a->count < 64 && begins(a->name, "glint.");
}

static size_t find_attribute(struct rewrite *r, size_t number, size_t at[2]) {
    size_t count = 0;
    for (size_t p = 0; p < r->count; p++)
        for (size_t a = 0; a < r->parts[p].part.attribute_count; a++)
            if (is_number(&r->parts[p].attributes[a]) && count++ == number) at[0] = p, at[1] = a;
    return count;
}

static size_t numbers_of(const struct glint_exr_attribute *a) {
    static const size_t counts[] = {[GLINT_EXR_FLOAT] = 1, [GLINT_EXR_DOUBLE] = 1, [GLINT_EXR_V2D] = 2,
                                    [GLINT_EXR_V3D] = 3,   [GLINT_EXR_V3F] = 3,    [GLINT_EXR_M44D] = 16};
    return a->type == GLINT_EXR_FLOATS ? a->count : counts[a->type];
}

static void spoil_attribute(struct rewrite *r, size_t number, uint32_t *state, struct spoiled *out) {
    static const double values[] = {1e300, 3.4e38, -3.4e38, 1e30, -1e30, 1e10, 1e-10, 1e-30, 1e-40, 1e-300, 0, -1, 1};
    size_t at[2] = {0, 0};
    find_attribute(r, number, at);
    const struct glint_exr_attribute *a = &r->parts[at[0]].attributes[at[1]];
    const size_t which = draw(state, (uint32_t)numbers_of(a));
    double *numbers = (double *)(uintptr_t)a->numbers; /* of the file in memory, which is the caller's */
    const double value = values[draw(state, sizeof values / sizeof *values)];
    /* Half of the time a factor, which more often leaves a frame that can be opened. */
    numbers[which] = draw(state, 2) ? value : numbers[which] * value;
    note(out, r->parts[at[0]].name, a->name, "as", numbers[which]);
}

bool spoil(struct rewrite *r, enum spoiled_kind kind, uint32_t seed, struct spoiled *out) {
    uint32_t state = seed * 2654435761u;
    const struct rewrite_part *gbuffer = rewrite_find(r, "gbuffer");
    *out = (struct spoiled){.width = gbuffer->part.width, .height = gbuffer->part.height};
    out->not_finite = calloc((size_t)out->width * out->height, sizeof *out->not_finite);
    assert_non_null(out->not_finite);
    size_t at[2] = {0, 0};
    const bool attribute = kind == SPOILED_ATTRIBUTE;
    const uint32_t count =
        (uint32_t)(attribute ? find_attribute(r, SIZE_MAX, at) : find_channel(r, kind, SIZE_MAX, at));
    const uint32_t changes = attribute ? 1 : kind == SPOILED_ANY ? 1 + draw(&state, 12) : 1 + draw(&state, 5);
    for (uint32_t i = 0; count && i < changes; i++) {
        const uint32_t number = draw(&state, count);
        if (attribute) {
            spoil_attribute(r, number, &state, out);
            continue;
        }
        find_channel(r, kind, number, at);
        spoil_channel(&r->parts[at[0]], at[1], &state, out);
    }
    return count > 0;
}
