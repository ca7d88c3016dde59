/* OpenEXR's ZIP chunks through libdeflate, which does in a third of the time what zlib does. */
#include <libdeflate.h>

#include "exr_internal.h"

static void split(const uint8_t *in, size_t bytes, uint8_t *out) {
    const size_t even = (bytes + 1) / 2, odd = bytes / 2;
    uint8_t *second = out + even;
    for (size_t i = 0; i < odd; i++) {
        out[i] = in[2 * i];
        second[i] = in[2 * i + 1];
    }
    if (even > odd) out[odd] = in[2 * odd];
}

static void join(const uint8_t *in, size_t bytes, uint8_t *out) {
    const size_t even = (bytes + 1) / 2, odd = bytes / 2;
    const uint8_t *second = in + even;
    for (size_t i = 0; i < odd; i++) {
        out[2 * i] = in[i];
        out[2 * i + 1] = second[i];
    }
    if (even > odd) out[2 * odd] = in[odd];
}

size_t glint_zip_pack(struct libdeflate_compressor *zip, const uint8_t *in, size_t bytes, uint8_t *scratch,
                      uint8_t *out) {
    split(in, bytes, scratch);
    uint8_t before = scratch[0];
    for (size_t i = 1; i < bytes; i++) {
        const uint8_t now = scratch[i];
        scratch[i] = (uint8_t)(now - before + 128);
        before = now;
    }
    return libdeflate_zlib_compress(zip, scratch, bytes, out, bytes - 1);
}

bool glint_zip_unpack(struct libdeflate_decompressor *zip, const uint8_t *in, size_t in_bytes, uint8_t *scratch,
                      uint8_t *out, size_t bytes) {
    size_t got = 0;
    if (libdeflate_zlib_decompress(zip, in, in_bytes, scratch, bytes, &got) != LIBDEFLATE_SUCCESS) return false;
    if (got != bytes) return false;
    for (size_t i = 1; i < bytes; i++) scratch[i] = (uint8_t)(scratch[i - 1] + scratch[i] - 128);
    join(scratch, bytes, out);
    return true;
}
