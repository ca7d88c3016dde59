/* Formats of raw memory: formats_rows.h as data, and the values of their components. */
#ifndef GLINT_PACK_FORMAT_H
#define GLINT_PACK_FORMAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum component_kind {
    COMPONENT_UNORM,
    COMPONENT_SNORM,
    COMPONENT_UINT,
    COMPONENT_SINT,
    COMPONENT_SRGB,   /* UNORM after sRGB's transfer curve */
    COMPONENT_FLOAT,  /* 16, 32 or 64 bits */
    COMPONENT_UFLOAT, /* 10 or 11 bits */
    COMPONENT_SHARED  /* 9 bits, with the exponent in the texel's highest five of 32 bits */
};

struct component {
    char letter; /* r g b a d s */
    uint8_t first_bit, bits;
    enum component_kind kind;
};

struct format {
    const char *vulkan; /* without VK_FORMAT_; "": none */
    uint32_t vulkan_number;
    const char *dxgi; /* without DXGI_FORMAT_; "": none */
    uint32_t dxgi_number;
    const char *other; /* a name of another API, whole; "": none */
    uint32_t bytes;    /* of a texel */
    unsigned count;
    struct component components[4];
};

extern const struct format pack_formats[];
extern const size_t pack_format_count;

/* NULL if no format has this name (VK_FORMAT_…, DXGI_FORMAT_…, GL_…), or number. */
const struct format *format_by_name(const char *name);
const struct format *format_by_vulkan(uint32_t number);
const struct format *format_by_dxgi(uint32_t number);
/* The format of `count` like components of `bits` bits in an array, as VK_FORMAT_R8G8B8_UNORM. */
const struct format *format_of_array(enum component_kind kind, unsigned bits, unsigned count);
/* The first name that the format has, with its prefix. In `text`. */
const char *format_name(const struct format *format, char text[64]);
/* How to go on when there is no such format; "" if nothing better is known than a suggestion. */
const char *format_advice(const char *name);

/* The bits of a component of the texel at `texel`. Reads no byte that the component's bits are not in, but a SHARED one reads 4. */
uint64_t component_code(const struct component *component, const uint8_t *texel);
/* The value that the code stands for. `decode_srgb` false leaves COMPONENT_SRGB as UNORM. */
double component_value(const struct component *component, uint64_t code, bool decode_srgb);
/* Bytes of one element of a plane that holds only this component. */
uint32_t component_plane_bytes(const struct component *component);
bool component_is_integer(const struct component *component);
double srgb_to_linear(double value);

#endif
