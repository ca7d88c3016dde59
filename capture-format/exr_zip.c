/* OpenEXR's ZIP chunks through libdeflate, which is three times as fast as zlib. */
#include <libdeflate.h>

#include "exr_internal.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

static void split_parity(const uint8_t *in, size_t bytes, uint8_t *out) {
    const size_t even = (bytes + 1) / 2, odd = bytes / 2;
    uint8_t *second = out + even;
    size_t i = 0;
#ifdef __SSE2__
    const __m128i low = _mm_set1_epi16(0xff);
    for (; i + 16 <= odd; i += 16) {
        const __m128i a = _mm_loadu_si128((const __m128i *)(const void *)(in + 2 * i));
        const __m128i b = _mm_loadu_si128((const __m128i *)(const void *)(in + 2 * i + 16));
        _mm_storeu_si128((__m128i *)(void *)(out + i), _mm_packus_epi16(_mm_and_si128(a, low), _mm_and_si128(b, low)));
        _mm_storeu_si128((__m128i *)(void *)(second + i), _mm_packus_epi16(_mm_srli_epi16(a, 8), _mm_srli_epi16(b, 8)));
    }
#endif
    for (; i < odd; i++) {
        out[i] = in[2 * i];
        second[i] = in[2 * i + 1];
    }
    if (even > odd) out[odd] = in[2 * odd];
}

static void join_parity(const uint8_t *in, size_t bytes, uint8_t *out) {
    const size_t even = (bytes + 1) / 2, odd = bytes / 2;
    const uint8_t *second = in + even;
    size_t i = 0;
#ifdef __SSE2__
    for (; i + 16 <= odd; i += 16) {
        const __m128i a = _mm_loadu_si128((const __m128i *)(const void *)(in + i));
        const __m128i b = _mm_loadu_si128((const __m128i *)(const void *)(second + i));
        _mm_storeu_si128((__m128i *)(void *)(out + 2 * i), _mm_unpacklo_epi8(a, b));
        _mm_storeu_si128((__m128i *)(void *)(out + 2 * i + 16), _mm_unpackhi_epi8(a, b));
    }
#endif
    for (; i < odd; i++) {
        out[2 * i] = in[i];
        out[2 * i + 1] = second[i];
    }
    if (even > odd) out[2 * odd] = in[odd];
}

/* To the difference of each byte from the one before, biased by 128, in place. */
static void take_differences(uint8_t *data, size_t bytes) {
    size_t i = 1;
    uint8_t before = data[0];
#ifdef __SSE2__
    const __m128i bias = _mm_set1_epi8(-128);
    __m128i last = _mm_slli_si128(_mm_cvtsi32_si128(before), 15); /* the bytes before those of `now` */
    for (; i + 16 <= bytes; i += 16) {
        const __m128i now = _mm_loadu_si128((const __m128i *)(const void *)(data + i));
        const __m128i shifted = _mm_or_si128(_mm_slli_si128(now, 1), _mm_srli_si128(last, 15));
        _mm_storeu_si128((__m128i *)(void *)(data + i), _mm_add_epi8(_mm_sub_epi8(now, shifted), bias));
        last = now;
    }
    before = (uint8_t)(_mm_extract_epi16(last, 7) >> 8);
#endif
    for (; i < bytes; i++) {
        const uint8_t now = data[i];
        data[i] = (uint8_t)(now - before + 128);
        before = now;
    }
}

/* From differences (biased by 128) back to bytes: a running sum, 16 at a time where the machine can. */
static void sum_differences(uint8_t *data, size_t bytes) {
    size_t i = 1;
#ifdef __SSE2__
    const __m128i bias = _mm_set1_epi8(-128);
    __m128i before = _mm_setzero_si128();
    data[0] =
        (uint8_t)(data[0] + 128); /* the first byte is not a difference, but the loop subtracts the bias from all */
    for (i = 0; i + 16 <= bytes; i += 16) {
        __m128i sum = _mm_sub_epi8(_mm_loadu_si128((const __m128i *)(const void *)(data + i)), bias);
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
        sum = _mm_add_epi8(sum, before);
        _mm_storeu_si128((__m128i *)(void *)(data + i), sum);
        before = _mm_set1_epi8((char)(_mm_extract_epi16(sum, 7) >> 8));
    }
    if (i == 0) data[0] = (uint8_t)(data[0] - 128), i = 1;
#endif
    for (; i < bytes; i++) data[i] = (uint8_t)(data[i - 1] + data[i] - 128);
}

size_t glint_zip_pack(struct libdeflate_compressor *zip, const uint8_t *in, size_t bytes, uint8_t *scratch,
                      uint8_t *out) {
    split_parity(in, bytes, scratch);
    take_differences(scratch, bytes);
    return libdeflate_zlib_compress(zip, scratch, bytes, out, bytes - 1);
}

bool glint_zip_unpack(struct libdeflate_decompressor *zip, const uint8_t *in, size_t in_bytes, uint8_t *scratch,
                      uint8_t *out, size_t bytes) {
    size_t got = 0;
    if (libdeflate_zlib_decompress(zip, in, in_bytes, scratch, bytes, &got) != LIBDEFLATE_SUCCESS) return false;
    if (got != bytes) return false;
    sum_differences(scratch, bytes);
    join_parity(scratch, bytes, out);
    return true;
}
