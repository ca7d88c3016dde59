/* Converts Assimp's materials to looks. Each image is decoded once for each use as colour or data. */
#include "gltf_material.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"
#include "inside.h"
#include "texture.h"

enum { MAX_IMAGE_FILE = 1 << 28 };
#define MAX_TEXEL_BYTES ((size_t)1 << 30)

struct source {
    const struct aiScene *file;
    const char *path;
    struct scene *scene;
    struct glint_error *err;
};

/* The contents of an image file that the glTF file names; release with free(). */
static uint8_t *read_bytes(const char *beside, const char *name, size_t *size, struct glint_error *err) {
    glint_file file;
    uint64_t bytes = 0;
    char *path = inside_beside(beside, name, err);
    const bool open = path && inside_open(&file, path, MAX_IMAGE_FILE, &bytes, err);
    uint8_t *contents = open ? malloc((size_t)bytes + 1) : NULL;
    if (open && (!contents || !glint_file_read(file, contents, (size_t)bytes, 0, size))) {
        glint_fail(err, contents ? GLINT_ERROR_IO : GLINT_ERROR_MEMORY, "%s: cannot be read", path);
        free(contents);
        contents = NULL;
    }
    if (open) glint_file_close(file);
    free(path);
    return contents;
}

static uint8_t *pixels_of(const struct source *s, const char *name, uint32_t *width, uint32_t *height) {
    char where[4096];
    const char *slash = strrchr(s->path, '/');
    if (name[0] == '*') { /* embedded in the glTF file */
        unsigned index = (unsigned)strtoul(name + 1, NULL, 10);
        snprintf(where, sizeof where, "%s: image %u", s->path, index);
        const struct aiTexture *inside = index < s->file->mNumTextures ? s->file->mTextures[index] : NULL;
        if (inside && !inside->mHeight && inside->pcData)
            return image_decode(where, (const uint8_t *)inside->pcData, inside->mWidth, width, height, s->err);
        glint_fail(s->err, GLINT_ERROR_FORMAT, "%s: not there", where);
        return NULL;
    }
    snprintf(where, sizeof where, "%.*s%s", slash ? (int)(slash + 1 - s->path) : 0, s->path, name);
    size_t size;
    uint8_t *bytes = read_bytes(s->path, name, &size, s->err), *pixels = NULL;
    if (bytes) pixels = image_decode(where, bytes, size, width, height, s->err);
    free(bytes);
    return pixels;
}

static bool load_texture(const struct source *s, const char *name, bool srgb, const struct texture **out) {
    size_t held = 0;
    for (uint32_t i = 0; i < s->scene->texture_count; i++) {
        const struct texture *t = s->scene->textures[i];
        *out = t;
        if (t->srgb == srgb && !strcmp(t->name, name)) return true;
        held += (size_t)t->width * t->height * 16 / 3;
    }
    uint32_t width, height;
    uint8_t *pixels = pixels_of(s, name, &width, &height);
    if (!pixels) return false;
    if (held + (size_t)width * height * 16 / 3 > MAX_TEXEL_BYTES) {
        free(pixels);
        return glint_fail(s->err, GLINT_ERROR_LIMIT, "%s: its textures take more than 1 GiB", s->path);
    }
    struct texture texture = texture_make(pixels, width, height, srgb);
    texture.name = malloc(strlen(name) + 1);
    if (texture.levels && texture.name) {
        strcpy(texture.name, name);
        if ((*out = scene_texture(s->scene, &texture))) return true;
    }
    free(texture.name);
    free(texture.texels);
    return glint_fail(s->err, GLINT_ERROR_MEMORY, "%s: no memory for its textures", s->path);
}

static enum wrap wrap_of(enum aiTextureMapMode mode) {
    return mode == aiTextureMapMode_Clamp ? WRAP_CLAMP : mode == aiTextureMapMode_Mirror ? WRAP_MIRROR : WRAP_REPEAT;
}

static bool is_identity(const struct aiUVTransform *t) {
    return fabsf(t->mTranslation.x) < 1e-6f && fabsf(t->mTranslation.y) < 1e-6f && fabsf(t->mRotation) < 1e-6f &&
           fabsf(t->mScaling.x - 1) < 1e-6f && fabsf(t->mScaling.y - 1) < 1e-6f;
}

static bool read_map(const struct source *s, const struct aiMaterial *from, enum aiTextureType type, bool srgb,
                     struct map *map) {
    struct aiString name;
    unsigned set = 0;
    enum aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    struct aiUVTransform transform;
    if (aiGetMaterialTexture(from, type, 0, &name, NULL, &set, NULL, NULL, modes, NULL) != aiReturn_SUCCESS)
        return true;
    if (set)
        return glint_fail(s->err, GLINT_ERROR_UNSUPPORTED, "%s: a texture uses TEXCOORD_%u, expected 0", s->path, set);
    if (aiGetMaterialUVTransform(from, AI_MATKEY_UVTRANSFORM(type, 0), &transform) == aiReturn_SUCCESS &&
        !is_identity(&transform))
        return glint_fail(s->err, GLINT_ERROR_UNSUPPORTED, "%s: KHR_texture_transform is not read", s->path);
    *map = (struct map){NULL, wrap_of(modes[0]), wrap_of(modes[1])};
    return load_texture(s, name.data, srgb, &map->texture);
}

static vec3 color_of(const struct aiMaterial *from, const char *key, vec3 fallback, float high, float *alpha) {
    struct aiColor4D c;
    if (aiGetMaterialColor(from, key, 0, 0, &c) != aiReturn_SUCCESS) return fallback;
    if (alpha) *alpha = clampf(c.a, 0, 1);
    return v3(clampf(c.r, 0, high), clampf(c.g, 0, high), clampf(c.b, 0, high));
}

static float number_of(const struct aiMaterial *from, const char *key, unsigned type, float fallback, float high) {
    float number;
    return aiGetMaterialFloat(from, key, type, 0, &number) == aiReturn_SUCCESS ? clampf(number, 0, high) : fallback;
}

/* Baked light uses the average of the look. */
static void set_averages(struct material *material) {
    const struct look *look = material->look;
    float color[4], emission[4], surface[4], all = 1e9f;
    texture_sample(&look->color, 0, 0, all, color);
    texture_sample(&look->emission, 0, 0, all, emission);
    texture_sample(&look->surface, 0, 0, all, surface);
    material->albedo = times(look->color_factor, v3(color[0], color[1], color[2]));
    material->emission = times(look->emission_factor, v3(emission[0], emission[1], emission[2]));
    material->roughness = look->roughness_factor * surface[1];
    material->metalness = look->metalness_factor * surface[2];
}

bool gltf_material(const struct aiScene *file, const struct aiMaterial *from, const char *path, struct scene *scene,
                   struct material *material, struct glint_error *err) {
    const struct source s = {file, path, scene, err};
    struct look look = {.alpha_factor = 1};
    struct aiString mode;
    look.color_factor = color_of(from, "$clr.base", gray(1), 1, &look.alpha_factor);
    look.emission_factor = color_of(from, "$clr.emissive", gray(0), 1e4f, NULL);
    look.metalness_factor = number_of(from, "$mat.metallicFactor", 0, 1, 1);
    look.roughness_factor = number_of(from, "$mat.roughnessFactor", 0, 1, 1);
    look.normal_scale = number_of(from, _AI_MATKEY_GLTF_SCALE_BASE, aiTextureType_NORMALS, 1, 100);
    if (aiGetMaterialString(from, AI_MATKEY_GLTF_ALPHAMODE, &mode) == aiReturn_SUCCESS && !strcmp(mode.data, "MASK"))
        look.cutoff = number_of(from, "$mat.gltf.alphaCutoff", 0, 0.5f, 1);
    if (!read_map(&s, from, aiTextureType_BASE_COLOR, true, &look.color) ||
        !read_map(&s, from, aiTextureType_EMISSIVE, true, &look.emission) ||
        !read_map(&s, from, aiTextureType_UNKNOWN, false, &look.surface) ||
        !read_map(&s, from, aiTextureType_NORMALS, false, &look.normal))
        return false;
    *material = (struct material){.specular = 0.5f, .stencil = STENCIL_WORLD, .look = scene_look(scene, &look)};
    if (!material->look) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: no memory for its materials", path);
    set_averages(material);
    return true;
}
