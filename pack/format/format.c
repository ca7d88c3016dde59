/* Looks up formats, and turns bits into values. */
#include "format.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define C(letter, first_bit, bits, kind)                                                                               \
    { letter, first_bit, bits, COMPONENT_##kind }
#define COUNT_OF(...) (sizeof((struct component[]){__VA_ARGS__}) / sizeof(struct component))

const struct format pack_formats[] = {
#define FORMAT(vulkan, vulkan_number, dxgi, dxgi_number, other, bytes, ...)                                            \
    {vulkan, vulkan_number, dxgi, dxgi_number, other, bytes, COUNT_OF(__VA_ARGS__), {__VA_ARGS__}},
#include "formats_rows.h"
};
const size_t pack_format_count = sizeof pack_formats / sizeof *pack_formats;

static const char VULKAN[] = "VK_FORMAT_", DXGI[] = "DXGI_FORMAT_";

const struct format *format_by_name(const char *name) {
    const bool vulkan = !strncmp(name, VULKAN, sizeof VULKAN - 1), dxgi = !strncmp(name, DXGI, sizeof DXGI - 1);
    const char *rest = vulkan ? name + sizeof VULKAN - 1 : dxgi ? name + sizeof DXGI - 1 : name;
    for (size_t i = 0; *rest && i < pack_format_count; i++) {
        const struct format *f = &pack_formats[i];
        if (!strcmp(rest, vulkan ? f->vulkan : dxgi ? f->dxgi : f->other)) return f;
    }
    return NULL;
}

const struct format *format_by_vulkan(uint32_t number) {
    for (size_t i = 0; number && i < pack_format_count; i++)
        if (pack_formats[i].vulkan_number == number) return &pack_formats[i];
    return NULL;
}

const struct format *format_by_dxgi(uint32_t number) {
    for (size_t i = 0; number && i < pack_format_count; i++)
        if (pack_formats[i].dxgi_number == number) return &pack_formats[i];
    return NULL;
}

const struct format *format_of_array(enum component_kind kind, unsigned bits, unsigned count) {
    for (size_t i = 0; i < pack_format_count; i++) {
        const struct format *f = &pack_formats[i];
        bool like = f->vulkan_number && f->count == count && !strstr(f->vulkan, "PACK");
        for (unsigned c = 0; like && c < count; c++)
            like = f->components[c].letter == "rgba"[c] && f->components[c].kind == kind &&
                   f->components[c].bits == bits && f->components[c].first_bit == c * bits;
        if (like) return f;
    }
    return NULL;
}

const char *format_name(const struct format *format, char text[64]) {
    const char *prefix = format->vulkan[0] ? VULKAN : format->dxgi[0] ? DXGI : "";
    const char *name = format->vulkan[0] ? format->vulkan : format->dxgi[0] ? format->dxgi : format->other;
    snprintf(text, 64, "%s%s", prefix, name);
    return text;
}

const char *format_advice(const char *name) {
    if (strstr(name, "TYPELESS"))
        return "; a typeless format does not say how to read its bits: name the view's format, such as …_UNORM or "
               "…_FLOAT";
    if (strstr(name, "_BC") || strstr(name, "ASTC") || strstr(name, "ETC2"))
        return "; compressed blocks are read from .dds files only: decompress the texture first, or save it as .dds";
    if (strncmp(name, VULKAN, sizeof VULKAN - 1) && strncmp(name, DXGI, sizeof DXGI - 1))
        return "; expected a name that begins with VK_FORMAT_ or DXGI_FORMAT_";
    return "";
}

/* ---- Bits and values ---- */

uint64_t component_code(const struct component *component, const uint8_t *texel) {
    const unsigned first = component->kind == COMPONENT_SHARED ? 0 : component->first_bit,
                   bits = component->kind == COMPONENT_SHARED ? 32 : component->bits;
    const unsigned shift = first % 8, bytes = (shift + bits + 7) / 8;
    uint64_t word = 0;
    for (unsigned i = 0; i < bytes; i++) word |= (uint64_t)texel[first / 8 + i] << (8 * i);
    word >>= shift;
    return bits < 64 ? word & ((UINT64_C(1) << bits) - 1) : word;
}

static double small_float(uint64_t code, int exponent_bits, int digits) {
    const int highest = (1 << exponent_bits) - 1, bias = highest / 2;
    const int exponent = (int)(code >> digits) & highest;
    const double mantissa = (double)(code & ((UINT64_C(1) << digits) - 1));
    if (exponent == highest) return mantissa != 0 ? (double)NAN : (double)INFINITY;
    if (exponent == 0) return ldexp(mantissa, 1 - bias - digits);
    return ldexp(mantissa + ldexp(1, digits), exponent - bias - digits);
}

static double float_value(uint64_t code, unsigned bits) {
    double wide;
    float single;
    if (bits == 64) return memcpy(&wide, &code, sizeof wide), wide;
    if (bits == 32) return memcpy(&single, &(uint32_t){(uint32_t)code}, sizeof single), (double)single;
    const double magnitude = small_float(code & 0x7fff, 5, 10);
    return code & 0x8000 ? -magnitude : magnitude;
}

double srgb_to_linear(double value) {
    const double v = fabs(value), linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    return value < 0 ? -linear : linear;
}

static double signed_code(uint64_t code, unsigned bits) {
    const uint64_t sign = UINT64_C(1) << (bits - 1);
    return code & sign ? (double)(int64_t)(code - 2 * sign) : (double)code;
}

double component_value(const struct component *component, uint64_t code, bool decode_srgb) {
    const unsigned bits = component->bits;
    switch (component->kind) {
    case COMPONENT_UINT:
        return (double)code;
    case COMPONENT_SINT:
        return signed_code(code, bits);
    case COMPONENT_SNORM:
        return fmax(-1, signed_code(code, bits) / (ldexp(1, (int)bits - 1) - 1));
    case COMPONENT_FLOAT:
        return float_value(code, bits);
    case COMPONENT_UFLOAT:
        return small_float(code, 5, (int)bits - 5);
    case COMPONENT_SHARED:
        return ldexp((double)(code >> component->first_bit & 511), (int)(code >> 27) - 15 - 9);
    case COMPONENT_UNORM:
    case COMPONENT_SRGB:
        break;
    }
    const double value = (double)code / (ldexp(1, (int)bits) - 1);
    return component->kind == COMPONENT_SRGB && decode_srgb ? srgb_to_linear(value) : value;
}

uint32_t component_plane_bytes(const struct component *component) {
    return component->bits <= 8 ? 1 : component->bits <= 16 ? 2 : component->bits <= 32 ? 4 : 8;
}

bool component_is_integer(const struct component *component) {
    return component->kind == COMPONENT_UINT || component->kind == COMPONENT_SINT;
}
