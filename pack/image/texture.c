/* The manifest's textures: which file, which way up, which layer. */
#include "texture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "manifest.h"
#include "nearest.h"
#include "read.h"

bool textures_prepare(struct textures *textures, const struct node *root, struct glint_error *err) {
    textures->node = node_child(root, "textures");
    const size_t count = json_object_size(textures->node.value);
    textures->all = calloc(2 * count + 1, sizeof *textures->all);
    if (!textures->all) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", root->manifest->path);
    json_t *all = textures->node.value;
    for (void *at = json_object_iter(all); at; at = json_object_iter_next(all, at)) {
        struct texture *both = &textures->all[textures->count];
        both[0].node = both[1].node = node_child(&textures->node, json_object_iter_key(at));
        both[1].is_cube = true;
        textures->count += 2;
    }
    return true;
}

void textures_note(const struct textures *textures) {
    size_t unsaid = 0;
    for (size_t i = 0; i < textures->count; i += 2)
        unsaid +=
            (textures->all[i].is_read || textures->all[i + 1].is_read) && !node_has(&textures->all[i].node, "rows");
    if (unsaid)
        node_note(&textures->node, GLINT_PACK_DEFAULT, "rows not said in %zu of %zu; top_first", unsaid,
                  textures->count / 2);
    for (size_t i = 0; i < textures->count; i += 2)
        if (!textures->all[i].is_read && !textures->all[i + 1].is_read)
            node_note(&textures->all[i].node, GLINT_PACK_FOUND, "no channel uses it");
}

void textures_finish(struct textures *textures) {
    for (size_t i = 0; i < textures->count; i++)
        for (size_t k = 0; k < textures->all[i].image_count; k++) image_finish(&textures->all[i].images[k]);
    free(textures->all);
    textures->all = NULL;
    textures->count = 0;
}

size_t texture_name_length(const struct textures *textures, const char *text) {
    size_t longest = 0;
    for (size_t i = 0; i < textures->count; i += 2) {
        const size_t length = strlen(textures->all[i].node.key);
        if (length > longest && !strncmp(text, textures->all[i].node.key, length) &&
            (text[length] == '.' || !text[length]))
            longest = length;
    }
    return longest;
}

/* ---- Reading ---- */

static bool read_file(struct texture *texture, const char *name, struct glint_error *err) {
    char *path = manifest_file(&texture->node, name, err);
    if (!path) return false;
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

static void note_texture(const struct texture *texture) {
    const struct image *image = &texture->images[0];
    const struct node *node = &texture->node;
    node_note(node, GLINT_PACK_SAID, "%u x %u texels of %s, %zu component%s%s%s", image->width, image->height,
              image->format, image->count, image->count == 1 ? "" : "s",
              texture->bottom_first ? ", bottom row first" : "", texture->is_cube ? ", a cube map" : "");
    const struct node cube = node_child(node, "cube");
    if (texture->is_cube && !node_has(&cube, "layout") && texture->cube.layout != CUBE_FILES)
        node_note(&cube, GLINT_PACK_DEFAULT, "layout not said; %s, by the shape of %u x %u texels",
                  cube_layout_name(texture->cube.layout), image->width, image->height);
    const struct node transfer = node_child(node, "transfer");
    bool has_srgb = false;
    for (size_t i = 0; i < image->count; i++) has_srgb |= image->sources[i].component.kind == COMPONENT_SRGB;
    if (!transfer.value && (has_srgb || image->is_ambiguous))
        node_note(&transfer, GLINT_PACK_DEFAULT, "not said; %s",
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

static bool read_texture(struct texture *texture, struct glint_error *err) {
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
    note_texture(texture);
    return true;
}

struct texture *texture_find(struct textures *textures, const struct node *user, const char *name, size_t length,
                             bool cube, struct glint_error *err) {
    char wanted[256];
    snprintf(wanted, sizeof wanted, "%.*s", (int)(length < 255 ? length : 255), name);
    struct glint_nearest near = glint_nearest_to(wanted);
    for (size_t i = 0; i < textures->count; i += 2) {
        struct texture *texture = &textures->all[i + cube];
        glint_nearest_offer(&near, texture->node.key);
        if (strlen(texture->node.key) != length || memcmp(texture->node.key, name, length)) continue;
        if (!texture->is_read && !read_texture(texture, err)) texture->fault = *err;
        if (texture->fault.code == GLINT_OK) return texture;
        *err = texture->fault;
        return NULL;
    }
    node_fail(user, err, GLINT_ERROR_FORMAT, "texture \"%.100s\" is not listed%s", wanted, glint_nearest_text(&near));
    return NULL;
}
