/* What a page says about pixels: their values, which it shows under the pointer, and the key to their colours. */
#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/page/base64.h"
#include "draw/page/page.h"
#include "draw/view/colormap.h"

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

/* The names of values of an image whose values have some, else NULL. */
static json_t *value_names(const struct source *s) {
    json_t *names = json_object();
    const enum kind kind = kind_of(s);
    for (uint32_t i = 0; i < 256; i++) {
        char name[64], key[8];
        snprintf(key, sizeof key, "%u", i);
        if (legend_value_name(kind, i, name)) json_object_set_new(names, key, json_string(name));
    }
    if (json_object_size(names)) return names;
    json_decref(names);
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
    return json_pack("{s:o, s:s, s:I, s:I, s:I, s:o*, s:o}", "channels", channels, "unit", s->unit, "width",
                     (json_int_t)s->width, "height", (json_int_t)s->height, "every", (json_int_t)every, "names",
                     value_names(s), "data", data ? data : json_null());
}

static json_t *color_json(struct rgb color) {
    return json_sprintf("#%02x%02x%02x", color.r, color.g, color.b);
}

static json_t *scale_json(const struct legend *l) {
    enum { STOPS = 16 };
    json_t *colors = json_array();
    for (int i = 0; i <= STOPS; i++) {
        const double t = (double)i / STOPS;
        const uint8_t grey = (uint8_t)(t * 255 + 0.5);
        json_array_append_new(colors,
                              color_json(l->kind == KIND_RAW ? (struct rgb){grey, grey, grey} : colormap_viridis(t)));
    }
    return json_pack("{s:f, s:f, s:b, s:o}", "low", l->low, "high", l->high, "log", l->logarithmic, "colors", colors);
}

json_t *page_key(const struct legend *l) {
    struct legend_items items;
    if (l->kind == KIND_COLOR) return NULL;
    json_t *list = json_array();
    legend_list(l, &items);
    for (size_t i = 0; i < items.count; i++)
        json_array_append_new(list, json_pack("{s:o, s:s, s:o*}", "color", color_json(items.of[i].color), "text",
                                              items.of[i].text, "share",
                                              items.of[i].share < 0 ? NULL : json_real(items.of[i].share)));
    return json_pack("{s:s, s:o*, s:o}", "title", l->title, "scale", legend_has_scale(l) ? scale_json(l) : NULL,
                     "items", list);
}

json_t *page_stage(json_t *blocks, const char *title) {
    json_t *pictures = json_array();
    json_t *block = json_pack("{s:{s:s, s:o}}", "stage", "title", title, "pictures", pictures);
    return json_array_append_new(blocks, block) == 0 ? pictures : NULL;
}
