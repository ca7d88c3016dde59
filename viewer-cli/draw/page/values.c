/* Encodes the values of pixels for pages, which show those under the pointer. */
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

#include "draw/page/base64.h"
#include "draw/page/page.h"

/* Takes every `every`-th texel and stores bytes of equal significance together, each as the difference to its left
   neighbour. Smooth images, and floats that were stored as half, then compress well. */
static void split_planes(uint8_t *planes, const struct source *s, uint32_t every, uint32_t width, uint32_t height) {
    const size_t plane = (size_t)width * height;
    for (uint32_t k = 0; k < s->components; k++)
        for (uint32_t y = 0; y < height; y++) {
            uint8_t before[4] = {0};
            for (uint32_t x = 0; x < width; x++) {
                uint32_t bits;
                memcpy(&bits, &s->texels[((size_t)y * every * s->width + x * every) * s->components + k], sizeof bits);
                for (uint32_t b = 0; b < 4; b++) {
                    const uint8_t byte = (uint8_t)(bits >> 8 * b);
                    planes[(4 * k + b) * plane + (size_t)y * width + x] = (uint8_t)(byte - before[b]);
                    before[b] = byte;
                }
            }
        }
}

/* Compresses the texels, malloc'd; NULL when out of memory. */
static uint8_t *pack(const struct source *s, uint32_t every, uint32_t width, uint32_t height, size_t *size) {
    const size_t bytes = 4 * (size_t)width * height * s->components;
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
    const size_t room = compressor ? libdeflate_zlib_compress_bound(compressor, bytes) : 0;
    uint8_t *planes = malloc(bytes), *packed = malloc(room + 1);
    *size = 0;
    if (planes && packed && compressor) {
        split_planes(planes, s, every, width, height);
        *size = libdeflate_zlib_compress(compressor, planes, bytes, packed, room);
    }
    libdeflate_free_compressor(compressor);
    free(planes);
    if (*size) return packed;
    free(packed);
    return NULL;
}

json_t *page_values(const struct source *s, size_t bytes) {
    enum { COARSEST = 64 };
    uint32_t every = 1;
    json_t *channels = json_array(), *data = NULL;
    for (uint32_t k = 0; k < s->components; k++) json_array_append_new(channels, json_string(s->channels[k]));
    for (;; every *= 2) {
        size_t size = 0;
        uint8_t *packed = pack(s, every, (s->width + every - 1) / every, (s->height + every - 1) / every, &size);
        const bool fits = packed && (size / 3 * 4 <= bytes || every == COARSEST);
        if (fits) data = base64_json("", packed, size);
        free(packed);
        if (fits || !packed) break;
    }
    return json_pack("{s:o, s:s, s:I, s:I, s:I, s:o}", "channels", channels, "unit", s->unit, "width",
                     (json_int_t)s->width, "height", (json_int_t)s->height, "every", (json_int_t)every, "data",
                     data ? data : json_null());
}

json_t *page_stage(json_t *blocks, const char *title) {
    json_t *pictures = json_array();
    json_t *block = json_pack("{s:{s:s, s:o}}", "stage", "title", title, "pictures", pictures);
    return json_array_append_new(blocks, block) == 0 ? pictures : NULL;
}
