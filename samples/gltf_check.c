/* Checks container, buffers, views, accessors and the references between them, because importers do not verify the sizes that a glTF
   file declares. Nothing else is checked here. */
#include "gltf_check.h"

#include "inside.h"

#include <jansson.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_FILE ((uint64_t)1 << 31)
enum { MAX_NESTED = 1000 };

struct check {
    const char *path;
    struct glint_error *err;
    json_t *root;
    const unsigned char *chunk; /* binary chunk of a .glb */
    uint64_t chunk_bytes;
    bool binary;
};

static bool bad(const struct check *c, const char *what, size_t index, const char *rule) {
    return glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: %s %zu: %s", c->path, what, index, rule);
}

static bool ends_in(const char *text, const char *end) {
    size_t n = strlen(text), k = strlen(end);
    return n > k && !strcmp(text + n - k, end);
}

static uint32_t little_endian(const unsigned char *b) {
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static unsigned char *read_file(const char *path, size_t *bytes, struct glint_error *err) {
    FILE *file = fopen(path, "rb");
    long end = -1;
    if (file && !fseek(file, 0, SEEK_END)) end = ftell(file);
    unsigned char *data = NULL;
    if (!file || end < 0 || fseek(file, 0, SEEK_SET)) glint_fail(err, GLINT_ERROR_IO, "%s: cannot be read", path);
    else if ((uint64_t)end > MAX_FILE) glint_fail(err, GLINT_ERROR_LIMIT, "%s: larger than 2 GiB", path);
    else if (!(data = malloc((size_t)end + 1))) glint_fail(err, GLINT_ERROR_MEMORY, "%s: no memory", path);
    else if (fread(data, 1, (size_t)end, file) != (size_t)end) {
        glint_fail(err, GLINT_ERROR_IO, "%s: cannot be read to its end", path);
        free(data);
        data = NULL;
    }
    *bytes = end < 0 ? 0 : (size_t)end;
    if (file) fclose(file);
    return data;
}

/* Finds the JSON: the whole of a .gltf, the first chunk of a .glb. */
static bool find_text(struct check *c, const unsigned char *data, size_t bytes, const char **text, size_t *length) {
    *text = (const char *)data;
    *length = bytes;
    if (!c->binary) return true;
    if (bytes < 20 || memcmp(data, "glTF", 4))
        return glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: not a binary glTF file", c->path);
    if (little_endian(data + 4) != 2)
        return glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: glTF version %u, expected 2", c->path,
                          little_endian(data + 4));
    uint32_t total = little_endian(data + 8), first = little_endian(data + 12);
    if (total != bytes)
        return glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: %zu bytes long, its header says %u", c->path, bytes, total);
    if (little_endian(data + 16) != 0x4e4f534a || first > bytes - 20)
        return glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: no complete JSON chunk", c->path);
    *text = (const char *)data + 20;
    *length = first;
    size_t at = 20 + (size_t)first;
    if (at == bytes) return true;
    if (bytes - at < 8 || little_endian(data + at) > bytes - at - 8)
        return glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: its binary chunk is cut short", c->path);
    c->chunk = data + at + 8;
    c->chunk_bytes = little_endian(data + at);
    return true;
}

/* Reads a count or offset, or `fallback` if absent. Anything but a number from 0 to 2^31 is an error. */
static bool get_number(const json_t *object, const char *key, uint64_t fallback, uint64_t *value) {
    const json_t *found = json_object_get(object, key);
    *value = fallback;
    if (!found) return true;
    if (!json_is_integer(found)) return false;
    json_int_t n = json_integer_value(found);
    *value = n < 0 ? 0 : (uint64_t)n;
    return n >= 0 && *value <= MAX_FILE;
}

/* An optional index into the array `into` of the root. */
static bool check_reference(const struct check *c, const json_t *object, const char *key, const char *into) {
    uint64_t index;
    if (!json_object_get(object, key)) return true;
    return get_number(object, key, 0, &index) && index < json_array_size(json_object_get(c->root, into));
}

/* Whether a path stays below the file's folder. */
static bool stays_inside(const char *uri) {
    if (!*uri || *uri == '/' || strchr(uri, '\\') || strchr(uri, ':') || strlen(uri) > 1000) return false;
    for (const char *at = uri; at; at = strchr(at, '/') ? strchr(at, '/') + 1 : NULL)
        if (!strncmp(at, "..", 2) && (at[2] == '/' || !at[2])) return false;
    return true;
}

static bool open_beside(const struct check *c, const char *uri, glint_file *file, uint64_t *bytes,
                        struct glint_error *err) {
    char *path = inside_beside(c->path, uri, err);
    const bool ok = path && inside_open(file, path, MAX_FILE, bytes, err);
    free(path);
    return ok;
}

static bool check_buffer(const struct check *c, size_t i, const json_t *buffer) {
    uint64_t bytes, there = 0;
    const char *uri = json_string_value(json_object_get(buffer, "uri"));
    if (!get_number(buffer, "byteLength", 0, &bytes)) return bad(c, "buffer", i, "byteLength is not a size");
    if (!uri) there = c->binary && i == 0 ? c->chunk_bytes : 0;
    else if (!strncmp(uri, "data:", 5)) {
        const char *comma = strchr(uri, ',');
        there = comma ? strlen(comma + 1) / 4 * 3 : 0;
    } else {
        if (!stays_inside(uri)) return bad(c, "buffer", i, "its file must lie in the glTF file's folder or below");
        struct glint_error why = {0};
        glint_file file;
        if (!open_beside(c, uri, &file, &there, &why)) return bad(c, "buffer", i, why.message);
        glint_file_close(file);
    }
    return bytes <= there || bad(c, "buffer", i, "shorter than its byteLength");
}

static bool check_view(const struct check *c, size_t i, const json_t *view) {
    uint64_t buffer, offset, bytes, stride, room;
    const json_t *buffers = json_object_get(c->root, "buffers");
    if (!get_number(view, "buffer", UINT64_MAX, &buffer) || buffer >= json_array_size(buffers))
        return bad(c, "bufferView", i, "no such buffer");
    if (!get_number(view, "byteOffset", 0, &offset) || !get_number(view, "byteLength", 0, &bytes) ||
        !get_number(view, "byteStride", 0, &stride) || stride > 252 ||
        !get_number(json_array_get(buffers, (size_t)buffer), "byteLength", 0, &room))
        return bad(c, "bufferView", i, "a size or offset is out of range");
    return offset + bytes <= room || bad(c, "bufferView", i, "ends behind its buffer");
}

static uint64_t element_bytes(const json_t *accessor) {
    static const struct {
        const char *name;
        uint64_t count;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    const char *type = json_string_value(json_object_get(accessor, "type"));
    uint64_t component, size = 0;
    if (!type || !get_number(accessor, "componentType", 0, &component)) return 0;
    if (component == 5120 || component == 5121) size = 1;
    if (component == 5122 || component == 5123) size = 2;
    if (component == 5125 || component == 5126) size = 4;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (!strcmp(type, types[i].name)) return size * types[i].count;
    return 0;
}

/* Reads part of a buffer; data: URIs are not read. */
static bool read_buffer(const struct check *c, uint64_t buffer, uint64_t offset, unsigned char *out, size_t bytes) {
    const json_t *found = json_array_get(json_object_get(c->root, "buffers"), (size_t)buffer);
    const char *uri = json_string_value(json_object_get(found, "uri"));
    if (!uri) {
        if (!c->chunk || buffer || offset + bytes > c->chunk_bytes) return false;
        memcpy(out, c->chunk + offset, bytes);
        return true;
    }
    glint_file file;
    uint64_t there;
    size_t got = 0;
    if (!strncmp(uri, "data:", 5) || !open_beside(c, uri, &file, &there, NULL)) return false;
    const bool ok = glint_file_read(file, out, bytes, offset, &got) && got == bytes;
    glint_file_close(file);
    return ok;
}

/* The position of a sparse accessor's indices or values in their buffer; false unless all of them lie inside. */
static bool locate_sparse(const struct check *c, const json_t *what, uint64_t bytes, uint64_t *buffer, uint64_t *at) {
    uint64_t index, offset, start, room;
    if (!get_number(what, "bufferView", UINT64_MAX, &index) || !get_number(what, "byteOffset", 0, &offset))
        return false;
    const json_t *view = json_array_get(json_object_get(c->root, "bufferViews"), (size_t)index);
    if (!view || json_object_get(view, "byteStride") || !get_number(view, "buffer", 0, buffer) ||
        !get_number(view, "byteOffset", 0, &start) || !get_number(view, "byteLength", 0, &room))
        return false;
    *at = start + offset;
    return offset + bytes <= room;
}

static bool indices_below(const unsigned char *bytes, uint64_t count, uint64_t size, uint64_t limit) {
    uint64_t last = 0;
    for (uint64_t k = 0; k < count; k++) {
        uint64_t index = 0;
        for (uint64_t b = 0; b < size; b++) index |= (uint64_t)bytes[k * size + b] << 8 * b;
        if (index >= limit || (k && index <= last)) return false;
        last = index;
    }
    return true;
}

/* The importer writes to the elements of these indices without checking them. */
static bool check_sparse(const struct check *c, size_t i, const json_t *accessor, uint64_t element) {
    const uint64_t most = (uint64_t)1 << 28;
    const json_t *sparse = json_object_get(accessor, "sparse"), *indices = json_object_get(sparse, "indices");
    uint64_t all, count, component, view, stride, buffer, at;
    if (!get_number(accessor, "count", 0, &all) || !get_number(sparse, "count", 0, &count) || !count || count > all ||
        all * element > most)
        return bad(c, "accessor", i, "its sparse count is out of range");
    if (!get_number(accessor, "bufferView", UINT64_MAX - 1, &view) ||
        !get_number(indices, "componentType", 0, &component))
        return bad(c, "accessor", i, "a sparse index is out of range");
    const json_t *base = json_array_get(json_object_get(c->root, "bufferViews"), (size_t)view);
    if (!get_number(base, "byteStride", element, &stride) || stride != element)
        return bad(c, "accessor", i, "sparse over interleaved elements is not supported");
    uint64_t size = component == 5121 ? 1 : component == 5123 ? 2 : component == 5125 ? 4 : 0;
    if (!size || !locate_sparse(c, json_object_get(sparse, "values"), count * element, &buffer, &at) ||
        !locate_sparse(c, indices, count * size, &buffer, &at))
        return bad(c, "accessor", i, "its sparse indices or values are not there");
    unsigned char *bytes = malloc((size_t)(count * size));
    bool ok =
        bytes && read_buffer(c, buffer, at, bytes, (size_t)(count * size)) && indices_below(bytes, count, size, all);
    free(bytes);
    return ok ||
           bad(c, "accessor", i, "its sparse indices are not ascending or not below its count (or are in a data: URI)");
}

static bool check_accessor(const struct check *c, size_t i, const json_t *accessor) {
    uint64_t view, offset, count, stride, room, size = element_bytes(accessor);
    const json_t *views = json_object_get(c->root, "bufferViews");
    if (!size) return bad(c, "accessor", i, "unknown type or componentType");
    if (json_object_get(accessor, "sparse") && !check_sparse(c, i, accessor, size)) return false;
    if (json_object_get(accessor, "sparse") && !json_object_get(accessor, "bufferView")) return true;
    if (!get_number(accessor, "bufferView", UINT64_MAX, &view) || view >= json_array_size(views))
        return bad(c, "accessor", i, "no such bufferView");
    const json_t *found = json_array_get(views, (size_t)view);
    if (!get_number(accessor, "byteOffset", 0, &offset) || !get_number(accessor, "count", 0, &count) || !count ||
        !get_number(found, "byteStride", 0, &stride) || !get_number(found, "byteLength", 0, &room))
        return bad(c, "accessor", i, "a count or offset is out of range");
    if (stride && stride < size) return bad(c, "accessor", i, "elements overlap");
    return offset + (count - 1) * (stride ? stride : size) + size <= room ||
           bad(c, "accessor", i, "ends behind its bufferView");
}

/* The accessor with this index, or NULL. */
static const json_t *accessor_at(const struct check *c, const json_t *index) {
    const json_t *accessors = json_object_get(c->root, "accessors");
    if (!json_is_integer(index) || json_integer_value(index) < 0) return NULL;
    return json_array_get(accessors, (size_t)json_integer_value(index));
}

static bool is_type(const json_t *accessor, const char *type) {
    const char *found = json_string_value(json_object_get(accessor, "type"));
    return found && !strcmp(found, type);
}

/* All attributes of a primitive and of its morph targets must have the same count. */
static bool attributes_match(const struct check *c, const json_t *attributes, uint64_t vertices) {
    const char *key;
    json_t *index;
    json_object_foreach((json_t *)(uintptr_t)attributes, key, index) {
        const json_t *accessor = accessor_at(c, index);
        uint64_t count;
        if (!accessor || !get_number(accessor, "count", 0, &count) || count != vertices) return false;
        if ((!strcmp(key, "NORMAL") || !strcmp(key, "POSITION")) && !is_type(accessor, "VEC3")) return false;
    }
    return true;
}

static bool check_image(const struct check *c, size_t i, const json_t *image) {
    const char *uri = json_string_value(json_object_get(image, "uri"));
    if (!uri && !json_object_get(image, "bufferView")) return bad(c, "image", i, "has neither uri nor bufferView");
    if (!check_reference(c, image, "bufferView", "bufferViews")) return bad(c, "image", i, "no such bufferView");
    /* the importer reads the text behind the slash */
    const char *kind = json_string_value(json_object_get(image, "mimeType"));
    if (kind && strcmp(kind, "image/png") && strcmp(kind, "image/jpeg"))
        return bad(c, "image", i, "mimeType is neither image/png nor image/jpeg");
    if (uri && !strncmp(uri, "data:", 5) && strncmp(uri, "data:image/png;base64,", 22) &&
        strncmp(uri, "data:image/jpeg;base64,", 23))
        return bad(c, "image", i, "its data: URI is neither image/png nor image/jpeg in base64");
    if (uri && strncmp(uri, "data:", 5) && !stays_inside(uri))
        return bad(c, "image", i, "its file must lie in the glTF file's folder or below");
    return true;
}

static bool check_texture(const struct check *c, size_t i, const json_t *texture) {
    return (check_reference(c, texture, "source", "images") && check_reference(c, texture, "sampler", "samplers")) ||
           bad(c, "texture", i, "no such image or sampler");
}

static bool check_material(const struct check *c, size_t i, const json_t *material) {
    const json_t *pbr = json_object_get(material, "pbrMetallicRoughness");
    const json_t *uses[] = {json_object_get(pbr, "baseColorTexture"), json_object_get(pbr, "metallicRoughnessTexture"),
                            json_object_get(material, "normalTexture"), json_object_get(material, "emissiveTexture"),
                            json_object_get(material, "occlusionTexture")};
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
        if (uses[k] && !check_reference(c, uses[k], "index", "textures"))
            return bad(c, "material", i, "no such texture");
    return true;
}

static bool check_mesh(const struct check *c, size_t i, const json_t *mesh) {
    size_t k, t;
    json_t *primitive, *target;
    json_array_foreach(json_object_get(mesh, "primitives"), k, primitive) {
        const json_t *attributes = json_object_get(primitive, "attributes"), *indices;
        const json_t *positions = accessor_at(c, json_object_get(attributes, "POSITION"));
        uint64_t vertices, mode;
        if (!get_number(primitive, "mode", 4, &mode) || mode > 6) return bad(c, "mesh", i, "unknown mode");
        /* the importer closes a loop with its first line, also where it has left that out because a vertex is not there */
        if (mode == 2) return bad(c, "mesh", i, "loops of lines are not supported");
        if (!positions || !get_number(positions, "count", 0, &vertices)) return bad(c, "mesh", i, "no POSITION");
        if (!attributes_match(c, attributes, vertices))
            return bad(c, "mesh", i, "an attribute does not match POSITION");
        json_array_foreach(
            json_object_get(primitive, "targets"), t,
            target) if (!attributes_match(c, target, vertices)) return bad(c, "mesh", i,
                                                                           "a morph target does not match POSITION");
        indices = json_object_get(primitive, "indices");
        if (indices && !(accessor_at(c, indices) && is_type(accessor_at(c, indices), "SCALAR")))
            return bad(c, "mesh", i, "indices are not SCALAR");
        if (!check_reference(c, primitive, "material", "materials")) return bad(c, "mesh", i, "no such material");
    }
    return true;
}

static bool check_node(const struct check *c, size_t i, const json_t *node) {
    size_t k, nodes = json_array_size(json_object_get(c->root, "nodes"));
    json_t *child;
    if (!check_reference(c, node, "mesh", "meshes") || !check_reference(c, node, "camera", "cameras") ||
        !check_reference(c, node, "skin", "skins"))
        return bad(c, "node", i, "no such mesh, camera or skin");
    json_array_foreach(json_object_get(node, "children"), k,
                       child) if (!json_is_integer(child) || json_integer_value(child) < 0 ||
                                  (size_t)json_integer_value(child) >= nodes) return bad(c, "node", i, "no such child");
    return true;
}

/* Nodes must be a forest: each has at most one parent, and there are no cycles. */
static bool check_tree(const struct check *c) {
    const json_t *nodes = json_object_get(c->root, "nodes");
    size_t count = json_array_size(nodes), i, k;
    size_t *parents = calloc(count + 1, sizeof *parents);
    json_t *child;
    if (!parents) return glint_fail(c->err, GLINT_ERROR_MEMORY, "%s: no memory", c->path);
    bool ok = true;
    for (i = 0; i < count && ok; i++)
        json_array_foreach(json_object_get(json_array_get(nodes, i), "children"), k, child) {
            size_t index = (size_t)json_integer_value(child);
            if (parents[index]) ok = bad(c, "node", index, "has two parents");
            parents[index] = i + 1;
        }
    for (i = 0; i < count && ok; i++) {
        size_t steps = 0;
        for (size_t at = i + 1; at && steps <= MAX_NESTED; at = parents[at - 1]) steps++;
        if (steps > MAX_NESTED) ok = bad(c, "node", i, "is its own ancestor, or has more than 1000 of them");
    }
    free(parents);
    return ok;
}

static uint64_t number_of(const json_t *object, const char *key) {
    uint64_t number = 0;
    return get_number(object, key, 0, &number) ? number : 0;
}

/* What the importer makes of all elements of these accessors: it unpacks an accessor again for each use. */
static uint64_t unpacked_attributes(const struct check *c, const json_t *attributes) {
    enum { ELEMENT_BYTES = 16 };
    const char *key;
    json_t *index;
    uint64_t sum = 0;
    json_object_foreach((json_t *)(uintptr_t)attributes, key, index) sum +=
        number_of(accessor_at(c, index), "count") * ELEMENT_BYTES;
    return sum;
}

static uint64_t unpacked_mesh(const struct check *c, const json_t *mesh) {
    enum { INDEX_BYTES = 16 };
    size_t k, t;
    json_t *primitive, *target;
    uint64_t sum = 0;
    json_array_foreach(json_object_get(mesh, "primitives"), k, primitive) {
        sum += unpacked_attributes(c, json_object_get(primitive, "attributes"));
        sum += number_of(accessor_at(c, json_object_get(primitive, "indices")), "count") * INDEX_BYTES;
        json_array_foreach(json_object_get(primitive, "targets"), t, target) sum += unpacked_attributes(c, target);
    }
    return sum;
}

static uint64_t unpacked_animation(const struct check *c, const json_t *animation) {
    size_t k;
    json_t *channel;
    uint64_t sum = 0;
    json_array_foreach(json_object_get(animation, "channels"), k, channel) {
        const json_t *sampler =
            json_array_get(json_object_get(animation, "samplers"), (size_t)number_of(channel, "sampler"));
        sum += number_of(accessor_at(c, json_object_get(sampler, "input")), "count") * 32;
    }
    return sum;
}

/* A small file can name the same data many times, and takes as many times its memory when it is imported. */
static bool check_unpacked(const struct check *c) {
    uint64_t sum = 0;
    size_t i;
    json_t *item;
    json_array_foreach(json_object_get(c->root, "buffers"), i, item) sum += number_of(item, "byteLength");
    json_array_foreach(json_object_get(c->root, "accessors"), i, item) if (json_object_get(item, "sparse")) sum +=
        number_of(item, "count") * element_bytes(item);
    json_array_foreach(json_object_get(c->root, "images"), i, item) sum += number_of(
        json_array_get(json_object_get(c->root, "bufferViews"), (size_t)number_of(item, "bufferView")), "byteLength");
    json_array_foreach(json_object_get(c->root, "meshes"), i, item) sum += unpacked_mesh(c, item);
    json_array_foreach(json_object_get(c->root, "animations"), i, item) sum += unpacked_animation(c, item);
    return sum <= MAX_FILE ||
           glint_fail(c->err, GLINT_ERROR_LIMIT, "%s: %llu bytes when it is unpacked, the limit is 2 GiB", c->path,
                      (unsigned long long)sum);
}

static uint64_t count_triangles(const struct check *c) {
    size_t i, k;
    json_t *mesh, *primitive;
    uint64_t sum = 0;
    json_array_foreach(json_object_get(c->root, "meshes"), i, mesh)
        json_array_foreach(json_object_get(mesh, "primitives"), k, primitive) {
        const json_t *indices = json_object_get(primitive, "indices");
        const json_t *position = json_object_get(json_object_get(primitive, "attributes"), "POSITION");
        uint64_t count = 0, mode = 4;
        get_number(accessor_at(c, indices ? indices : position), "count", 0, &count);
        get_number(primitive, "mode", 4, &mode);
        if (mode == 4) sum += count / 3;
        if (mode > 4 && count > 2) sum += count - 2; /* strips and fans */
    }
    return sum;
}

static bool check_scenes(const struct check *c, size_t i, const json_t *scene) {
    size_t k, nodes = json_array_size(json_object_get(c->root, "nodes"));
    json_t *node;
    json_array_foreach(json_object_get(scene, "nodes"), k,
                       node) if (!json_is_integer(node) || json_integer_value(node) < 0 ||
                                 (size_t)json_integer_value(node) >= nodes) return bad(c, "scene", i, "no such node");
    return true;
}

static bool check_all(const struct check *c) {
    static const struct {
        const char *array;
        bool (*check)(const struct check *, size_t, const json_t *);
    } parts[] = {{"buffers", check_buffer}, {"bufferViews", check_view}, {"accessors", check_accessor},
                 {"images", check_image},   {"textures", check_texture}, {"materials", check_material},
                 {"meshes", check_mesh},    {"nodes", check_node},       {"scenes", check_scenes}};
    const char *version = json_string_value(json_object_get(json_object_get(c->root, "asset"), "version"));
    if (!version || version[0] != '2')
        return glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: glTF version %s, expected 2.0", c->path,
                          version ? version : "missing");
    for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
        size_t i;
        json_t *element;
        json_array_foreach(json_object_get(c->root, parts[p].array), i,
                           element) if (!parts[p].check(c, i, element)) return false;
    }
    return (check_reference(c, c->root, "scene", "scenes") ||
            glint_fail(c->err, GLINT_ERROR_FORMAT, "%s: no such scene", c->path)) &&
           check_tree(c) && check_unpacked(c);
}

bool gltf_check(const char *path, struct gltf_facts *facts, struct glint_error *err) {
    struct check c = {.path = path, .err = err, .binary = ends_in(path, ".glb")};
    if (!c.binary && !ends_in(path, ".gltf"))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: neither a built-in scene nor a .gltf or .glb file", path);
    size_t bytes, length;
    const char *text;
    json_error_t fault;
    bool ok = false;
    unsigned char *data = read_file(path, &bytes, err);
    if (!data || !find_text(&c, data, bytes, &text, &length) || !inside_json_fits(path, text, length, err)) goto done;
    c.root = json_loadb(text, length, JSON_REJECT_DUPLICATES, &fault);
    if (!c.root) {
        glint_fail(err, GLINT_ERROR_FORMAT, "%s: line %d: %s", path, fault.line, fault.text);
        goto done;
    }
    ok = check_all(&c);
    if (ok) {
        const json_t *camera = json_array_get(json_object_get(c.root, "cameras"), 0);
        facts->triangles = count_triangles(&c);
        facts->fov_y_rad = json_number_value(json_object_get(json_object_get(camera, "perspective"), "yfov"));
    }
done:
    json_decref(c.root);
    free(data);
    return ok;
}
