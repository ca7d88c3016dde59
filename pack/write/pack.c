/* glint_pack: reads a manifest and its textures, and writes the capture. */
#include "glint/pack.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "channels.h"
#include "convert.h"
#include "encodings.h"
#include "blender.h"
#include "extras.h"
#include "frame.h"
#include "keys.h"
#include "light.h"
#include "manifest.h"
#include "system.h"

struct pack {
    struct manifest manifest;
    struct node root, parts_node, frame_node;
    struct glint_pack_options options;
    struct textures textures;
    bool has_frame;
    struct glint_frame frame;
    struct faults faults;
};

static bool report(const struct pack *pack, const char *what, double done, struct glint_error *err) {
    if (!pack->options.progress || pack->options.progress(pack->options.progress_user, what, done)) return true;
    return glint_fail(err, GLINT_ERROR_INTERRUPTED, "%s: interrupted", pack->manifest.path);
}

/* ---- Siblings ---- */

/* Puts the file beside the capture, unless it lies there already. */
static bool place_sibling(const struct part *part, const char *out, const char *from, const char *name,
                          struct glint_error *err) {
    const struct node node = node_child(&part->node, "sibling");
    char *target = file_beside(out, name);
    if (!target) return node_no_memory(&node, err);
    bool ok = true;
    if (file_same(from, target)) ok = true;
    else if (!access(target, F_OK)) {
        if (!file_equal(from, target))
            ok = node_fail(&node, err, GLINT_ERROR_IO, "%s is there already, and holds something else than %s", target,
                           from);
    } else if (!file_copy(from, target, err)) ok = node_wrap(&node, err);
    free(target);
    return ok;
}

static bool read_sibling(const struct part *part, const char *out, const char **name, struct glint_error *err) {
    const char *path = node_text(&part->node, "sibling"), *slash = path ? strrchr(path, '/') : NULL;
    const struct node node = node_child(&part->node, "sibling");
    *name = slash ? slash + 1 : path;
    if (!path) return true;
    if (!**name || !strcmp(*name, ".") || !strcmp(*name, "..") || strchr(*name, '\\') || strlen(*name) > 255)
        return node_fail(&node, err, GLINT_ERROR_FORMAT, "expected the path of a file, found \"%.100s\"", path);
    char *from = manifest_file(&node, path, err);
    if (!from) return false;
    struct glint_file_info info;
    bool ok = glint_path_describe(from, &info) && info.kind == GLINT_FILE_REGULAR;
    if (!ok) node_fail(&node, err, GLINT_ERROR_IO, "%s cannot be read as a file", from);
    ok = ok && (!out || place_sibling(part, out, from, *name, err));
    free(from);
    return ok;
}

/* ---- Parts ---- */

static struct part part_of(struct pack *pack, const char *name) {
    struct part part = {.textures = &pack->textures,
                        .frame = pack->has_frame ? &pack->frame : NULL,
                        .threads = pack->options.threads,
                        .node = node_child(&pack->parts_node, name),
                        .name = name};
    part.role = role_of(name, &part.is_previous);
    part.is_cube = part.role && glint_shape_is_cube(part.role->shape);
    return part;
}

static bool check_part(const struct part *part, uint32_t width, uint32_t height, struct glint_error *err) {
    const struct node *node = &part->node;
    static const struct {
        const char *role, *key, *what; /* what: required */
    } objects[] = {{"cubemap", "cubemap", "a cubemap with its center"},
                   {"planar", "planar", "a planar with its plane and camera"},
                   {"sky", "sky", NULL},
                   {"probe", "probe", NULL},
                   {"indirect", "indirect", NULL},
                   {"shadow", "shadow", "a shadow with its matrix"},
                   {"volume", "volume", "a volume with its matrix and slices"},
                   {"froxels", "froxels", "froxels with their slices, near and far"},
                   {"truth.occlusion", "truth", "a truth with its radius"},
                   {"truth.sun", "truth", "a truth with its length"}};
    if (!part->name[0] || strlen(part->name) > 255)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected a part's name of 1 to 255 bytes");
    if (part->role && part->role->reserved)
        return node_fail(node, err, GLINT_ERROR_FORMAT, "the role is reserved: %s", part->role->meaning);
    for (size_t i = 0; i < sizeof objects / sizeof *objects; i++) {
        const char *name = objects[i].key;
        const bool own = part->role && !strcmp(part->role->name, objects[i].role), has = node_has(node, name);
        if (own && !has && objects[i].what)
            return node_fail(node, err, GLINT_ERROR_FORMAT, "expected %s, found none", objects[i].what);
        const bool truth = part->role && !strcmp(name, "truth") &&
                           (!strcmp(part->role->name, "truth.occlusion") || !strcmp(part->role->name, "truth.sun"));
        if (has && !own && !truth)
            return node_fail(node, err, GLINT_ERROR_FORMAT, "expected no %s, which belongs to parts of that role alone",
                             name);
    }
    if (part->role && part->role->shape == GLINT_SHAPE_FRAME && width &&
        (part->width != width || part->height != height))
        return node_fail(node, err, GLINT_ERROR_FORMAT, "expected %u x %u texels, as in gbuffer, found %u x %u", width,
                         height, part->width, part->height);
    return true;
}

static bool hand_over(struct glint_writer *writer, const struct part *part, struct glint_part *file,
                      struct glint_error *err) {
    struct glint_channel *channels = calloc(part->count + 1, sizeof *channels);
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    if (!channels) return node_no_memory(&part->node, err);
    for (size_t i = 0; i < part->count; i++)
        channels[i] = (struct glint_channel){.name = part->channels[i].name,
                                             .type = types[part->channels[i].stored],
                                             .data = part->channels[i].data,
                                             .storage = part->channels[i].storage};
    file->channels = channels;
    file->channel_count = part->count;
    const bool ok = glint_writer_add_part(writer, file, err) || node_wrap(&part->node, err);
    free(channels);
    return ok;
}

/* What the manifest says of a part beside its channels. */
struct carried {
    struct glint_cubemap cubemap;
    struct glint_planar planar;
    struct glint_sky sky;
    struct glint_probe probe;
    struct glint_indirect indirect;
    struct glint_shadow shadow;
    struct glint_light_volume volume;
    struct glint_froxels froxels;
    struct glint_truth truth;
};

static bool carried_read(const struct pack *pack, const struct node *node, struct carried *c, struct glint_part *file,
                         struct glint_error *err) {
    if (node_has(node, "cubemap")) file->cubemap = &c->cubemap;
    if (node_has(node, "planar")) file->planar = &c->planar;
    if (node_has(node, "sky")) file->sky = &c->sky;
    if (node_has(node, "probe")) file->probe = &c->probe;
    if (node_has(node, "indirect")) file->indirect = &c->indirect;
    if (node_has(node, "shadow")) file->shadow = &c->shadow;
    if (node_has(node, "volume")) file->volume = &c->volume;
    if (node_has(node, "froxels")) file->froxels = &c->froxels;
    if (node_has(node, "truth")) file->truth = &c->truth;
    if (file->sky) sky_read(node, &c->sky);
    if (file->indirect) indirect_read(node, &c->indirect);
    if (file->froxels) froxels_read(node, &c->froxels);
    if (file->truth) truth_read(node, &c->truth);
    return (!file->cubemap || cubemap_read(node, &c->cubemap, err)) &&
           (!file->planar || planar_read(&pack->frame_node, node, &c->planar, err)) &&
           (!file->probe || probe_read(node, &c->probe, err)) &&
           (!file->shadow || shadow_read(&pack->frame_node, node, &c->shadow, err)) &&
           (!file->volume || volume_read(&pack->frame_node, node, &c->volume, err));
}

static bool add_part(struct pack *pack, struct part *part, struct glint_writer *writer, struct extras *extras,
                     const char *out, struct glint_error *err) {
    struct carried carried = {.sky = {.has_ground = false}};
    struct glint_part file = {.name = part->name};
    struct glint_attribute *simple = NULL;
    const struct glint_camera *camera = !pack->has_frame                  ? NULL
                                        : node_has(&part->node, "planar") ? &carried.planar.camera
                                        : !part->is_previous              ? &pack->frame.camera
                                        : pack->frame.has_previous        ? &pack->frame.previous
                                                                          : NULL;
    if (!carried_read(pack, &part->node, &carried, &file, err) || !encodings_read(part, camera, err) ||
        !channels_choose(part, err) || !read_sibling(part, out, &file.sibling, err) || !channels_convert(part, err))
        return false;
    bool ok = attributes_read(part, extras, &simple, &file.attribute_count, err);
    file.width = part->width;
    file.height = part->height;
    file.encodings = part->encodings;
    file.attributes = simple;
    ok = ok && (part->role ? hand_over(writer, part, &file, err) : extras_add_part(extras, part, err));
    free(simple);
    return ok;
}

/* Moves a part; what points to its nodes follows. */
static void take_part(struct part *to, struct part *from) {
    *to = *from;
    to->more.parent = &to->node;
    for (size_t i = 0; i < to->count; i++)
        to->channels[i].node.parent = to->channels[i].node.parent == &from->more ? &to->more : &to->node;
    *from = (struct part){.width = from->width, .height = from->height};
}

static bool add_parts(struct pack *pack, struct part *gbuffer, struct glint_writer *writer, struct extras *extras,
                      const char *out, struct glint_error *err) {
    const size_t count = json_object_size(pack->parts_node.value);
    size_t done = 0;
    json_t *all = pack->parts_node.value;
    for (void *at = json_object_iter(all); at; at = json_object_iter_next(all, at)) {
        struct part part = part_of(pack, json_object_iter_key(at));
        const bool first = !strcmp(part.name, "gbuffer"), broken = pack->faults.count > 0;
        bool ok = report(pack, part.name, 0.9 * (double)done++ / (double)count, err);
        if (first) take_part(&part, gbuffer);
        else ok = ok && channels_read(&part, err);
        /* after an error the others are only looked for */
        ok = ok && check_part(&part, gbuffer->width, gbuffer->height, err) &&
             (broken || add_part(pack, &part, writer, extras, out, err));
        channels_finish(&part);
        if (!ok && !node_keep(&part.node, err)) return false;
    }
    return pack->faults.count == 0;
}

/* ---- The whole ---- */

/* Parts that must be there, by the registry. A manifest without a frame makes a file of cube maps. */
static bool check_roles(const struct pack *pack, struct glint_error *err) {
    size_t count = 0;
    const struct glint_role *roles = glint_roles(&count);
    bool frame = node_has(&pack->root, "frame");
    json_t *all = pack->parts_node.value;
    for (void *at = json_object_iter(all); !frame && at; at = json_object_iter_next(all, at)) {
        const struct node node = node_child(&pack->parts_node, json_object_iter_key(at));
        if (strncmp(node.key, "cubemap.", 8))
            return node_fail(&pack->root, err, GLINT_ERROR_FORMAT,
                             "frame is missing, which only a file of cube maps does without: %s",
                             pack_key(pack_objects, "frame")->meaning);
    }
    for (size_t i = 0; frame && i < count; i++)
        if (roles[i].required && !node_has(&pack->parts_node, roles[i].name))
            return node_fail(&pack->parts_node, err, GLINT_ERROR_FORMAT, "%s is missing: %s", roles[i].name,
                             roles[i].meaning);
    return json_object_size(all) > 0 ||
           node_fail(&pack->parts_node, err, GLINT_ERROR_FORMAT, "expected parts, found none");
}

/* OpenEXR refuses files whose parts differ in these. */
static bool check_shared(const struct pack *pack, struct glint_error *err) {
    static const char *const names[] = {"chromaticities", "timeCode"};
    json_t *all = pack->parts_node.value, *first = NULL;
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        for (void *at = json_object_iter(all); at; at = json_object_iter_next(all, at)) {
            const struct node part = node_child(&pack->parts_node, json_object_iter_key(at)),
                              attributes = node_child(&part, "attributes");
            json_t *own = json_object_get(attributes.value, names[n]);
            if (at == json_object_iter(all)) first = own;
            if (own != first && (!own || !first || !json_equal(own, first)))
                return node_fail(&attributes, err, GLINT_ERROR_FORMAT,
                                 "expected the same %s in all parts, as OpenEXR wants it, found another or none",
                                 names[n]);
        }
    return true;
}

/* Whether something is there that the writer does not take. */
static bool needs_extras(const struct pack *pack) {
    json_t *parts = pack->parts_node.value;
    bool previous;
    for (void *at = json_object_iter(parts); at; at = json_object_iter_next(parts, at)) {
        json_t *attributes = json_object_get(json_object_iter_value(at), "attributes");
        if (!role_of(json_object_iter_key(at), &previous)) return true;
        for (void *a = json_object_iter(attributes); a; a = json_object_iter_next(attributes, a))
            if (json_is_object(json_object_iter_value(a))) return true;
    }
    return false;
}

static bool is_input(const struct pack *pack, const char *out, const char *name) {
    char *path = file_beside(pack->manifest.path, name);
    const bool same = path && file_same(path, out);
    free(path);
    return same;
}

static bool check_output(const struct pack *pack, const char *out, struct glint_error *err) {
    json_t *textures = json_object_get(pack->root.value, "textures"), *parts = pack->parts_node.value;
    bool same = file_same(pack->manifest.path, out);
    for (void *at = json_object_iter(textures); at; at = json_object_iter_next(textures, at)) {
        const json_t *texture = json_object_iter_value(at), *files = json_object_get(texture, "files"),
                     *file = json_object_get(texture, "file");
        for (size_t i = 0; i < json_array_size(files); i++)
            same = same || is_input(pack, out, json_string_value(json_array_get(files, i)));
        if (!files) same = same || is_input(pack, out, file ? json_string_value(file) : json_object_iter_key(at));
    }
    for (void *at = json_object_iter(parts); at; at = json_object_iter_next(parts, at)) {
        const char *sibling = json_string_value(json_object_get(json_object_iter_value(at), "sibling"));
        same = same || (sibling && is_input(pack, out, sibling));
    }
    return !same || glint_fail(err, GLINT_ERROR_USAGE, "%s is an input: expected another output", out);
}

static bool write_all(struct pack *pack, struct part *gbuffer, const char *out, struct glint_error *err) {
    const bool twice = needs_extras(pack);
    const size_t length = out ? strlen(out) + 40 : 40;
    char *first = malloc(length);
    struct extras *extras = extras_create();
    if (first) snprintf(first, length, twice ? "%s.first-%ld" : "%s", out ? out : "capture", (long)getpid());
    const struct glint_writer_options options = {.threads = pack->options.threads};
    struct glint_writer *writer = first && extras ? glint_writer_create(first, &options, err) : NULL;
    bool ok = writer || (first && extras) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok && writer && pack->has_frame && !pack->faults.count)
        ok = glint_writer_set_frame(writer, &pack->frame, err) || node_wrap(&pack->frame_node, err);
    ok = ok && writer && add_parts(pack, gbuffer, writer, extras, out, err);
    if (ok) textures_note(&pack->textures);
    if (ok && out) {
        ok = report(pack, "write", 0.9, err) &&
             (glint_writer_finish(writer, err) || node_wrap(&pack->parts_node, err)) &&
             (!twice || extras_write(extras, first, out, pack->options.threads, err));
        if (twice) unlink(first);
    }
    glint_writer_destroy(&writer);
    extras_destroy(&extras);
    free(first);
    return ok;
}

static bool pack_opened(struct pack *pack, const char *out, struct glint_error *err) {
    pack->root = node_root(&pack->manifest);
    pack->parts_node = node_child(&pack->root, "parts");
    pack->frame_node = node_child(&pack->root, "frame");
    if (!check_roles(pack, err) || !check_shared(pack, err) || (out && !check_output(pack, out, err)) ||
        !textures_prepare(&pack->textures, &pack->root, err))
        return false;
    pack->has_frame = pack->frame_node.value != NULL;
    struct part gbuffer = part_of(pack, "gbuffer");
    bool ok = !pack->has_frame || channels_read(&gbuffer, err) || node_keep(&gbuffer.node, err);
    if (ok && pack->has_frame && gbuffer.width)
        ok = frame_read(&pack->frame_node, &pack->frame, gbuffer.width, gbuffer.height, err) ||
             node_keep(&pack->frame_node, err);
    ok = ok && write_all(pack, &gbuffer, out, err);
    channels_finish(&gbuffer);
    return ok;
}

static bool pack_file(const char *manifest, const char *blender, const char *out,
                      const struct glint_pack_options *options, struct glint_error *err) {
    struct pack pack = {.has_frame = false};
    struct glint_error own = {0};
    if (!err) err = &own; /* messages of what lies below are put together with lines */
    if (options) pack.options = *options;
    bool ok = manifest_open(&pack.manifest, manifest, &pack.options, &pack.faults, err);
    pack.manifest.own = blender;
    ok = ok && (!blender || blender_add(&pack.manifest, blender, err)) && pack_opened(&pack, out, err);
    ok = faults_none(&pack.faults, &pack.options, err) && ok;
    faults_finish(&pack.faults);
    textures_finish(&pack.textures);
    manifest_close(&pack.manifest);
    return ok;
}

bool glint_pack(const char *manifest, const char *out, const struct glint_pack_options *options,
                struct glint_error *err) {
    return pack_file(manifest, NULL, out, options, err);
}

bool glint_pack_blender(const char *blender, const char *manifest, const char *out,
                        const struct glint_pack_options *options, struct glint_error *err) {
    return pack_file(manifest, blender, out, options, err);
}
