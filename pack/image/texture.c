/* The manifest's textures: which file, which way up, which layer. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pack.h"

void pack_note(const struct pack *pack, enum glint_pack_note kind, const struct node *node, const char *format, ...) {
    char path[512], text[900];
    va_list args;
    if (!pack->options.note) return;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    pack->options.note(pack->options.note_user, kind, node_path(node, path), text);
}

bool textures_prepare(struct pack *pack, struct glint_error *err) {
    const size_t count = json_object_size(pack->textures_node.value);
    pack->textures = calloc(2 * count + 1, sizeof *pack->textures);
    if (!pack->textures) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", pack->manifest.path);
    json_t *all = pack->textures_node.value;
    for (void *at = json_object_iter(all); at; at = json_object_iter_next(all, at)) {
        struct texture *both = &pack->textures[pack->texture_count];
        both[0].node = both[1].node = node_child(&pack->textures_node, json_object_iter_key(at));
        both[1].is_cube = true;
        pack->texture_count += 2;
    }
    return true;
}

void textures_note(const struct pack *pack) {
    size_t unsaid = 0;
    for (size_t i = 0; i < pack->texture_count; i += 2)
        unsaid +=
            (pack->textures[i].is_read || pack->textures[i + 1].is_read) && !node_has(&pack->textures[i].node, "rows");
    if (unsaid)
        pack_note(pack, GLINT_PACK_DEFAULT, &pack->textures_node, "rows not said in %zu of %zu; top_first", unsaid,
                  pack->texture_count / 2);
    for (size_t i = 0; i < pack->texture_count; i += 2)
        if (!pack->textures[i].is_read && !pack->textures[i + 1].is_read)
            pack_note(pack, GLINT_PACK_FOUND, &pack->textures[i].node, "no channel uses it");
}

void textures_finish(struct pack *pack) {
    for (size_t i = 0; i < pack->texture_count; i++)
        for (size_t k = 0; k < pack->textures[i].image_count; k++) image_finish(&pack->textures[i].images[k]);
    free(pack->textures);
    pack->textures = NULL;
    pack->texture_count = 0;
}

size_t texture_name_length(const struct pack *pack, const char *text) {
    size_t longest = 0;
    for (size_t i = 0; i < pack->texture_count; i += 2) {
        const size_t length = strlen(pack->textures[i].node.key);
        if (length > longest && !strncmp(text, pack->textures[i].node.key, length) &&
            (text[length] == '.' || !text[length]))
            longest = length;
    }
    return longest;
}

/* ---- Reading ---- */

static bool read_file(struct texture *texture, const char *name, struct glint_error *err) {
    char *path = file_beside(texture->node.manifest->path, name);
    if (!path) return image_no_memory(&texture->node, err);
    const bool ok = image_read(&texture->images[texture->image_count++], &texture->node, path, texture->is_cube, err);
    free(path);
    return ok;
}

static bool are_alike(const struct image *a, const struct image *b) {
    bool alike = a->width == b->width && a->height == b->height && a->count == b->count && a->layers == b->layers;
    for (size_t i = 0; alike && i < a->count; i++) {
        const struct component *one = &a->sources[i].component, *other = &b->sources[i].component;
        alike = one->letter == other->letter && one->kind == other->kind && one->bits == other->bits &&
                one->first_bit == other->first_bit && !strcmp(a->sources[i].name, b->sources[i].name);
    }
    return alike;
}

static bool read_files(struct texture *texture, struct glint_error *err) {
    const json_t *six = json_object_get(texture->node.value, "files");
    const char *file = node_text(&texture->node, "file");
    if (six && file) return node_fail(&texture->node, err, GLINT_ERROR_FORMAT, "expected file or files, found both");
    if (!six) return read_file(texture, file ? file : texture->node.key, err);
    for (size_t i = 0; i < 6; i++) {
        if (!read_file(texture, json_string_value(json_array_get(six, i)), err)) return false;
        const struct image *first = &texture->images[0], *own = &texture->images[i];
        if (!are_alike(first, own))
            return node_fail(&texture->node, err, GLINT_ERROR_FORMAT,
                             "expected six files of one size and format, found %u x %u of %zu and %u x %u of %zu",
                             first->width, first->height, first->count, own->width, own->height, own->count);
    }
    return true;
}

static bool choose_layer(struct texture *texture, struct glint_error *err) {
    const struct image *image = &texture->images[0];
    const uint64_t layer = node_count(&texture->node, "layer", 0), slice = node_count(&texture->node, "slice", 0);
    const bool faces = texture->is_cube && texture->cube.layout == CUBE_LAYERS;
    const uint64_t first = faces ? 6 * layer : layer + slice, last = first + (faces ? 6 : 1);
    const struct node node = node_child(&texture->node, slice ? "slice" : "layer");
    if (last > image->layers)
        return node_fail(&node, err, GLINT_ERROR_FORMAT, "expected %s within %u layers, found %llu",
                         faces ? "six faces" : "one", image->layers, (unsigned long long)(layer + slice));
    texture->layer = (uint32_t)first;
    return true;
}

static void note_texture(const struct pack *pack, const struct texture *texture) {
    const struct image *image = &texture->images[0];
    const struct node *node = &texture->node;
    pack_note(pack, GLINT_PACK_SAID, node, "%u x %u texels of %s, %zu component%s%s%s", image->width, image->height,
              image->format, image->count, image->count == 1 ? "" : "s",
              texture->bottom_first ? ", bottom row first" : "", texture->is_cube ? ", a cube map" : "");
    const struct node cube = node_child(node, "cube");
    if (texture->is_cube && !node_has(&cube, "layout") && texture->cube.layout != CUBE_FILES)
        pack_note(pack, GLINT_PACK_DEFAULT, &cube, "layout not said; %s, by the shape of %u x %u texels",
                  cube_layout_name(texture->cube.layout), image->width, image->height);
    const struct node transfer = node_child(node, "transfer");
    bool has_srgb = false;
    for (size_t i = 0; i < image->count; i++) has_srgb |= image->sources[i].component.kind == COMPONENT_SRGB;
    if (!transfer.value && (has_srgb || image->is_ambiguous))
        pack_note(pack, GLINT_PACK_DEFAULT, &transfer, "not said; %s",
                  has_srgb ? "srgb, as the format's name has it: decoded to linear"
                           : "linear: numbers are taken as the file has them");
}

/* What the file calls linear is decoded where the manifest says that it is sRGB. */
static void apply_transfer(struct texture *texture) {
    const char *transfer = node_text(&texture->node, "transfer");
    texture->decode_srgb = !transfer || !strcmp(transfer, "srgb");
    if (!transfer || !texture->decode_srgb) return;
    for (size_t k = 0; k < texture->image_count; k++)
        for (size_t i = 0; i < texture->images[k].count; i++) {
            struct component *component = &texture->images[k].sources[i].component;
            if (component->kind == COMPONENT_UNORM && component->letter && strchr("rgb", component->letter))
                component->kind = COMPONENT_SRGB;
        }
}

static bool read_texture(const struct pack *pack, struct texture *texture, struct glint_error *err) {
    const char *rows = node_text(&texture->node, "rows");
    const bool files = node_has(&texture->node, "files");
    texture->is_read = true;
    texture->bottom_first = rows && !strcmp(rows, "bottom_first");
    if (!read_files(texture, err)) return false;
    const struct image *image = &texture->images[0];
    apply_transfer(texture);
    texture->is_cube = texture->is_cube || files || image->is_cube || node_has(&texture->node, "cube");
    if (texture->is_cube &&
        !cube_read(&texture->cube, &texture->node, image->width, image->height, files, image->is_cube, err))
        return false;
    texture->width = texture->is_cube ? texture->cube.size : image->width;
    texture->height = texture->is_cube ? 6 * texture->cube.size : image->height;
    if (!choose_layer(texture, err)) return false;
    note_texture(pack, texture);
    return true;
}

struct texture *texture_find(struct pack *pack, const struct node *user, const char *name, size_t length, bool cube,
                             struct glint_error *err) {
    char wanted[256];
    snprintf(wanted, sizeof wanted, "%.*s", (int)(length < 255 ? length : 255), name);
    struct suggestion near = suggestion_for(wanted);
    for (size_t i = 0; i < pack->texture_count; i += 2) {
        struct texture *texture = &pack->textures[i + cube];
        suggestion_offer(&near, texture->node.key);
        if (strlen(texture->node.key) != length || memcmp(texture->node.key, name, length)) continue;
        if (!texture->is_read && !read_texture(pack, texture, err)) return NULL;
        return texture;
    }
    node_fail(user, err, GLINT_ERROR_FORMAT, "texture \"%.100s\" is not listed%s", wanted, suggestion_text(&near));
    return NULL;
}
