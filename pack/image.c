/* Images of raw memory, and the choice of the reader for files that describe themselves. */
#include "image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "oiio.h"

bool image_no_memory(const struct node *texture, struct glint_error *err) {
    return node_fail(texture, err, GLINT_ERROR_MEMORY, "out of memory");
}

uint32_t read_u32(const uint8_t *at) {
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

uint64_t read_u64(const uint8_t *at) {
    return read_u32(at) | (uint64_t)read_u32(at + 4) << 32;
}

void image_finish(struct image *image) {
    for (size_t i = 0; image->sources && i < image->count; i++) free(image->sources[i].name);
    free(image->sources);
    free(image->bytes.data);
    *image = (struct image){0};
}

static bool is_letter(const struct source *source, char letter) {
    const char *as = strchr("xrygzbwa", letter);
    const char plain = as && (as - "xrygzbwa") % 2 == 0 ? as[1] : letter;
    return source->component.letter == plain;
}

const struct source *image_source(const struct image *image, const char *name, size_t length) {
    for (size_t i = 0; i < image->count; i++)
        if (strlen(image->sources[i].name) == length && !memcmp(image->sources[i].name, name, length))
            return &image->sources[i];
    for (size_t i = 0; length == 1 && i < image->count; i++)
        if (*name >= 'a' && *name <= 'z' && is_letter(&image->sources[i], *name)) return &image->sources[i];
    return NULL;
}

/* ---- Laying components over memory ---- */

static bool check_size(const struct node *texture, const struct layout *layout, struct glint_error *err) {
    if (!layout->width || !layout->height || layout->width > IMAGE_MAX_WIDTH || layout->height > IMAGE_MAX_HEIGHT ||
        !layout->layers || layout->layers > IMAGE_MAX_LAYERS)
        return node_fail(texture, err, GLINT_ERROR_LIMIT,
                         "expected 1 x 1 to %d x %d texels and at most %d layers, found %u x %u and %u",
                         IMAGE_MAX_WIDTH, IMAGE_MAX_HEIGHT, IMAGE_MAX_LAYERS, layout->width, layout->height,
                         layout->layers);
    if ((layout->row_pitch | layout->layer_pitch | layout->offset) >> 32 ||
        layout->row_pitch * layout->height > IMAGE_MAX_BYTES)
        return node_fail(texture, err, GLINT_ERROR_LIMIT, "expected pitches and an offset within 4 GiB");
    return true;
}

/* The bytes up to the end of the last texel; planes lie behind each other. */
static uint64_t end_of(const struct layout *layout, uint64_t texel, uint64_t row_pitch, uint64_t layer_pitch) {
    return (layout->layers - 1) * layer_pitch + (layout->height - 1) * row_pitch + layout->width * texel;
}

static bool too_short(const struct image *image, const struct node *texture, const struct layout *layout,
                      uint64_t texel, uint64_t row_pitch, uint64_t needed, struct glint_error *err) {
    return node_fail(
        texture, err, GLINT_ERROR_FORMAT,
        "the file has %zu bytes; expected at least %llu (offset %llu, row_pitch %llu, %u rows of %u texels "
        "of %llu bytes, %u layer%s%s)",
        image->bytes.size, (unsigned long long)needed, (unsigned long long)layout->offset,
        (unsigned long long)row_pitch, layout->height, layout->width, (unsigned long long)texel, layout->layers,
        layout->layers == 1 ? "" : "s", layout->planar ? ", the planes one after the other" : "");
}

static bool add_source(struct image *image, const struct node *texture, struct source source, const char *name,
                       struct glint_error *err) {
    source.name = strdup(name);
    if (!source.name) return image_no_memory(texture, err);
    image->sources[image->count++] = source;
    return true;
}

static bool lay_out_planes(struct image *image, const struct node *texture, const struct layout *layout,
                           struct glint_error *err) {
    const struct format *f = layout->format;
    const uint32_t first_bytes = component_plane_bytes(&f->components[0]);
    uint64_t at = layout->offset;
    for (unsigned c = 0; c < f->count; c++) {
        struct component component = f->components[c];
        const uint32_t bytes = component_plane_bytes(&component);
        const uint64_t pitch =
            layout->row_pitch ? layout->row_pitch / first_bytes * bytes : (uint64_t)layout->width * bytes;
        component.first_bit = 0;
        if (component.kind == COMPONENT_SHARED || layout->row_pitch % first_bytes)
            return node_fail(texture, err, GLINT_ERROR_FORMAT,
                             "planar: expected components of their own and a row_pitch of whole elements");
        if (pitch < (uint64_t)layout->width * bytes)
            return node_fail(texture, err, GLINT_ERROR_FORMAT, "row_pitch: expected at least %llu bytes, found %llu",
                             (unsigned long long)layout->width * first_bytes, (unsigned long long)layout->row_pitch);
        const uint64_t plane = layout->layer_pitch ? layout->layer_pitch : pitch * layout->height;
        const uint64_t needed = at + end_of(layout, bytes, pitch, plane);
        if (needed > image->bytes.size) return too_short(image, texture, layout, bytes, pitch, needed, err);
        const char name[2] = {component.letter, '\0'};
        if (!add_source(image, texture,
                        (struct source){.component = component,
                                        .first = (size_t)at,
                                        .x_step = bytes,
                                        .row_pitch = (size_t)pitch,
                                        .layer_pitch = (size_t)plane},
                        name, err))
            return false;
        at += plane * layout->layers;
    }
    return true;
}

bool image_lay_out(struct image *image, const struct node *texture, const struct layout *layout,
                   struct glint_error *err) {
    const struct format *f = layout->format;
    if (!check_size(texture, layout, err)) return false;
    image->width = layout->width;
    image->height = layout->height;
    image->layers = layout->layers;
    format_name(f, image->format);
    image->sources = calloc(4, sizeof *image->sources);
    if (!image->sources) return image_no_memory(texture, err);
    if (layout->planar) return lay_out_planes(image, texture, layout, err);
    const uint64_t tight = (uint64_t)layout->width * f->bytes, pitch = layout->row_pitch ? layout->row_pitch : tight,
                   layer_pitch = layout->layer_pitch ? layout->layer_pitch : pitch * layout->height;
    if (pitch < tight)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "row_pitch: expected at least %llu bytes (%u texels of %u), found %llu",
                         (unsigned long long)tight, layout->width, f->bytes, (unsigned long long)pitch);
    const uint64_t needed = layout->offset + end_of(layout, f->bytes, pitch, layer_pitch);
    if (needed > image->bytes.size) return too_short(image, texture, layout, f->bytes, pitch, needed, err);
    for (unsigned c = 0; c < f->count; c++) {
        const char name[2] = {f->components[c].letter, '\0'};
        if (!add_source(image, texture,
                        (struct source){.component = f->components[c],
                                        .first = (size_t)layout->offset,
                                        .x_step = f->bytes,
                                        .row_pitch = (size_t)pitch,
                                        .layer_pitch = (size_t)layer_pitch},
                        name, err))
            return false;
    }
    return true;
}

bool image_format(const struct node *texture, const struct format **format, struct glint_error *err) {
    const char *name = node_text(texture, "format");
    *format = name ? format_by_name(name) : NULL;
    if (!name || *format) return true;
    const struct node node = node_child(texture, "format");
    const char *advice = format_advice(name);
    struct suggestion near = suggestion_for(name);
    char names[pack_format_count][2][80];
    for (size_t i = 0; i < pack_format_count; i++) {
        snprintf(names[i][0], 80, "VK_FORMAT_%s", pack_formats[i].vulkan);
        snprintf(names[i][1], 80, "DXGI_FORMAT_%s", pack_formats[i].dxgi);
        if (pack_formats[i].vulkan[0]) suggestion_offer(&near, names[i][0]);
        if (pack_formats[i].dxgi[0]) suggestion_offer(&near, names[i][1]);
        if (pack_formats[i].other[0]) suggestion_offer(&near, pack_formats[i].other);
    }
    return node_fail(&node, err, GLINT_ERROR_FORMAT, "there is no format \"%.60s\"%s", name,
                     advice[0] ? advice : suggestion_text(&near));
}

/* ---- Files ---- */

static bool read_raw(struct image *image, const struct node *texture, bool cube, struct glint_error *err) {
    const char *layout_name = node_text(texture, "layout");
    struct layout layout = {.width = (uint32_t)node_count(texture, "width", 0),
                            .height = (uint32_t)node_count(texture, "height", 0),
                            .planar = layout_name && !strcmp(layout_name, "planar"),
                            .offset = node_count(texture, "offset", 0),
                            .row_pitch = node_count(texture, "row_pitch", 0),
                            .layer_pitch = node_count(texture, "layer_pitch", 0)};
    if (!image_format(texture, &layout.format, err)) return false;
    if (!layout.format || !node_has(texture, "width") || !node_has(texture, "height"))
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "raw memory: expected format, width and height, found no %s",
                         !layout.format               ? "format"
                         : node_has(texture, "width") ? "height"
                                                      : "width");
    if (node_count(texture, "mip", 0))
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "mip: raw memory holds one level: give its offset, width and height");
    const uint64_t layers = node_count(texture, "layer", 0) + node_count(texture, "slice", 0) + 1;
    const struct node arranged = node_child(texture, "cube");
    const char *faces = arranged.value ? node_text(&arranged, "layout") : NULL;
    const bool six =
        faces ? !strcmp(faces, "layers") : cube && layout.width == layout.height && !node_has(texture, "files");
    image->is_cube = six;
    layout.layers = layers < IMAGE_MAX_LAYERS ? (uint32_t)layers * (six ? 6 : 1) : UINT32_MAX;
    return image_lay_out(image, texture, &layout, err);
}

static bool read_oiio(struct image *image, const struct node *texture, const char *path, const char *kind,
                      struct glint_error *err) {
    struct oiio_image decoded = {0};
    if (!oiio_decode(path, kind, image->bytes.data, image->bytes.size, IMAGE_MAX_BYTES, &decoded, err))
        return node_wrap(texture, err);
    const struct format *format;
    free(image->bytes.data);
    image->bytes = (struct bytes){.data = decoded.pixels, .size = decoded.size};
    if (!image_format(texture, &format, err)) return false;
    if (!format)
        format = format_of_array(decoded.is_float ? COMPONENT_FLOAT : COMPONENT_UNORM, decoded.bits, decoded.channels);
    if (!format || format->bytes != decoded.channels * decoded.bits / 8)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "format: expected %u bytes a texel, as the file has, found %u",
                         decoded.channels * decoded.bits / 8, format ? format->bytes : 0);
    image->is_ambiguous = !decoded.is_float && !node_has(texture, "format");
    const struct layout layout = {.format = format, .width = decoded.width, .height = decoded.height, .layers = 1};
    return image_lay_out(image, texture, &layout, err);
}

static bool ends_with(const char *path, const char *suffix) {
    const size_t length = strlen(path), tail = strlen(suffix);
    return length > tail && !strcasecmp(path + length - tail, suffix);
}

bool image_read(struct image *image, const struct node *texture, const char *path, bool cube, struct glint_error *err) {
    *image = (struct image){0};
    const char *passes = node_text(texture, "passes");
    if (passes && !strcmp(passes, "blender")) return image_read_blender(image, texture, path, err);
    if (ends_with(path, ".exr")) return image_read_exr(image, texture, path, err);
    if (!file_read(path, IMAGE_MAX_BYTES, &image->bytes, err)) return node_wrap(texture, err);
    if (ends_with(path, ".png")) return read_oiio(image, texture, path, "png", err);
    if (ends_with(path, ".hdr")) return read_oiio(image, texture, path, "hdr", err);
    if (ends_with(path, ".npy")) return image_read_npy(image, texture, err);
    if (ends_with(path, ".ktx2")) return image_read_ktx2(image, texture, err);
    if (ends_with(path, ".dds")) return image_read_dds(image, texture, err);
    return read_raw(image, texture, cube, err);
}
