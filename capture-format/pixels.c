/* Converts channels from the caller's type to the stored type. */
#include "pixels.h"

#include <Imath/half.h>
#include <string.h>

static size_t type_bytes(enum glint_type type) {
    switch (type) {
    case GLINT_U8:
    case GLINT_UNORM8:
    case GLINT_SNORM8:
        return 1;
    case GLINT_F32:
    case GLINT_U32:
        return 4;
    case GLINT_F16:
    case GLINT_U16:
    case GLINT_UNORM16:
    case GLINT_SNORM16:
        break;
    }
    return 2;
}

enum glint_stored glint_pixels_stored(enum glint_type type) {
    switch (type) {
    case GLINT_F16:
    case GLINT_UNORM8:
    case GLINT_SNORM8:
        return GLINT_STORED_HALF;
    case GLINT_U8:
    case GLINT_U16:
    case GLINT_U32:
        return GLINT_STORED_UINT;
    case GLINT_F32:
    case GLINT_UNORM16:
    case GLINT_SNORM16:
        break;
    }
    return GLINT_STORED_FLOAT;
}

const char *glint_pixels_storage(enum glint_type type) {
    switch (type) {
    case GLINT_F16:
        return "half";
    case GLINT_F32:
        return "float";
    case GLINT_U8:
        return "uint8";
    case GLINT_U16:
        return "uint16";
    case GLINT_U32:
        return "uint";
    case GLINT_UNORM8:
        return "unorm8";
    case GLINT_UNORM16:
        return "unorm16";
    case GLINT_SNORM8:
        return "snorm8";
    case GLINT_SNORM16:
        return "snorm16";
    }
    return "";
}

/* The two lowest values of an snorm both mean -1, as in Vulkan and Direct3D. */
static float decode_snorm(int value, int top) {
    return value < -top ? -1.0f : (float)value / (float)top;
}

static void copy_line(enum glint_type type, const uint8_t *in, size_t step, uint32_t width, uint8_t *out) {
    uint16_t wide = 0;
    switch (type) {
    case GLINT_F16:
        for (uint32_t x = 0; x < width; x++) memcpy(out + 2 * x, in + x * step, 2);
        break;
    case GLINT_F32:
    case GLINT_U32:
        for (uint32_t x = 0; x < width; x++) memcpy(out + 4 * x, in + x * step, 4);
        break;
    case GLINT_U8:
        for (uint32_t x = 0; x < width; x++) memcpy(out + 4 * x, &(uint32_t){in[x * step]}, 4);
        break;
    case GLINT_U16:
        for (uint32_t x = 0; x < width; x++) {
            memcpy(&wide, in + x * step, 2);
            memcpy(out + 4 * x, &(uint32_t){wide}, 4);
        }
        break;
    case GLINT_UNORM8:
        for (uint32_t x = 0; x < width; x++)
            memcpy(out + 2 * x, &(uint16_t){imath_float_to_half((float)in[x * step] / 255)}, 2);
        break;
    case GLINT_SNORM8:
        for (uint32_t x = 0; x < width; x++)
            memcpy(out + 2 * x, &(uint16_t){imath_float_to_half(decode_snorm((int8_t)in[x * step], 127))}, 2);
        break;
    case GLINT_UNORM16:
        for (uint32_t x = 0; x < width; x++) {
            memcpy(&wide, in + x * step, 2);
            memcpy(out + 4 * x, &(float){(float)wide / 65535}, 4);
        }
        break;
    case GLINT_SNORM16:
        for (uint32_t x = 0; x < width; x++) {
            memcpy(&wide, in + x * step, 2);
            memcpy(out + 4 * x, &(float){decode_snorm((int16_t)wide, 32767)}, 4);
        }
        break;
    }
}

void glint_pixels_copy(const struct glint_channel *from, uint32_t width, uint32_t height, void *out) {
    const size_t step = from->x_stride_bytes ? from->x_stride_bytes : type_bytes(from->type);
    const size_t line = from->y_stride_bytes ? from->y_stride_bytes : step * width;
    const size_t out_line = (glint_pixels_stored(from->type) == GLINT_STORED_HALF ? 2u : 4u) * (size_t)width;
    for (uint32_t y = 0; y < height; y++)
        copy_line(from->type, (const uint8_t *)from->data + y * line, step, width, (uint8_t *)out + y * out_line);
}
