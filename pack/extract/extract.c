/* glint_extract: a manifest and raw textures from a capture. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "attributes.h"
#include "file.h"
#include "format.h"
#include "glint/exr.h"
#include "glint/pack.h"
#include "keys.h"
#include "roles.h"
#include "shown.h"

struct extract {
    const char *capture, *folder;
    const struct glint_pack_options *options;
    struct glint_exr *exr;
    json_t *manifest, *textures, *parts;
    struct written *written;
};

static bool no_memory(const struct extract *x, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", x->capture);
}

static bool report(const struct extract *x, const char *what, double done, struct glint_error *err) {
    const struct glint_pack_options *o = x->options;
    return !o || !o->progress || o->progress(o->progress_user, what, done) ||
           glint_fail(err, GLINT_ERROR_INTERRUPTED, "%s: interrupted", x->folder);
}

static char *path_in(const struct extract *x, const char *name) {
    const size_t length = strlen(x->folder) + strlen(name) + 2;
    char *path = malloc(length);
    if (path) snprintf(path, length, "%s/%s", x->folder, name);
    return path;
}

/* A file that was not there before. */
struct written {
    struct written *before;
    char *path;
};

static bool write_file(struct extract *x, const char *name, const void *data, size_t size, struct glint_error *err) {
    char *path = path_in(x, name);
    struct written *written = malloc(sizeof *written);
    const bool fresh = path && access(path, F_OK) != 0;
    bool ok = (path && written) || no_memory(x, err);
    if (ok && file_same(path, x->capture))
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%s is the capture itself: expected another folder", path);
    ok = ok && file_write(path, data, size, err);
    if (ok && fresh) {
        *written = (struct written){x->written, path};
        x->written = written;
        return true;
    }
    free(written);
    free(path);
    return ok;
}

/* Ends what was written; without `keep`, the files that were not there before are removed. */
static void finish_files(struct extract *x, bool keep) {
    while (x->written) {
        struct written *written = x->written;
        x->written = written->before;
        if (!keep) unlink(written->path);
        free(written->path);
        free(written);
    }
}

/* ---- Textures ---- */

static bool is_taken(const struct extract *x, const char *name) {
    for (void *at = json_object_iter(x->textures); at; at = json_object_iter_next(x->textures, at))
        if (!strcasecmp(json_object_iter_key(at), name)) return true;
    return false;
}

/* A file name of letters, digits, '.', '-' and '_' that no other texture has, also where case does not count. */
static void name_texture(const struct extract *x, const char *part, const char *layer, char out[128]) {
    char plain[96];
    snprintf(plain, sizeof plain, "%.60s%s%.30s", part, layer[0] ? "." : "", layer);
    for (char *c = plain; *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_", *c)) *c = '_';
    if (plain[0] == '.') plain[0] = '_';
    snprintf(out, 128, "%s", plain);
    for (unsigned n = 2; is_taken(x, out); n++) snprintf(out, 128, "%s-%u", plain, n);
}

static size_t layer_length(const char *channel) {
    const char *dot = strrchr(channel, '.');
    return dot ? (size_t)(dot - channel) : 0;
}

/* Channels that go into one texture: of one layer and one type, R G B A and X Y Z in order. */
static size_t group_of(const struct glint_exr_part_info *part, size_t first, const bool *done, size_t out[4]) {
    static const char order[] = "RXGYBZA";
    const struct glint_channel_info *head = &part->channels[first];
    const size_t layer = layer_length(head->name);
    size_t count = 0;
    for (const char *letter = order; *letter && count < 4; letter++)
        for (size_t i = first; i < part->channel_count && count < 4; i++) {
            const struct glint_channel_info *c = &part->channels[i];
            const char *last = c->name + layer + (layer ? 1 : 0);
            if (!done[i] && c->stored == head->stored && layer_length(c->name) == layer &&
                !strncmp(c->name, head->name, layer) && last[0] == *letter && !last[1])
                out[count++] = i;
        }
    bool has_first = false;
    for (size_t i = 0; i < count; i++) has_first = has_first || out[i] == first;
    if (has_first) return count;
    out[0] = first;
    return 1;
}

static bool write_texture(struct extract *x, size_t p, const size_t *group, size_t count, const char *name,
                          struct glint_error *err) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    static const enum component_kind kinds[] = {COMPONENT_FLOAT, COMPONENT_FLOAT, COMPONENT_UINT};
    const struct glint_exr_part_info *part = glint_exr_part(x->exr, p);
    const enum glint_stored stored = part->channels[group[0]].stored;
    const unsigned bytes = stored == GLINT_STORED_HALF ? 2 : 4;
    const struct format *format = format_of_array(kinds[stored], 8 * bytes, (unsigned)count);
    const size_t size = (size_t)part->width * part->height * bytes * count;
    char file[160], format_text[64];
    const char *names[4];
    for (size_t i = 0; i < count; i++) names[i] = part->channels[group[i]].name;
    void *texels = malloc(size + 1);
    if (!texels || !format) return free(texels), no_memory(x, err);
    snprintf(file, sizeof file, "%s.raw", name);
    const uint32_t threads = x->options ? x->options->threads : 0;
    const bool ok = glint_exr_read(x->exr, p, names, count, types[stored], texels, threads, err) &&
                    write_file(x, file, texels, size, err);
    free(texels);
    json_t *texture = json_pack("{s:s, s:s, s:i, s:i, s:s}", "file", file, "format", format_name(format, format_text),
                                "width", (int)part->width, "height", (int)part->height, "rows", "top_first");
    bool previous;
    const struct glint_role *role = role_of(part->name, &previous);
    if (role && glint_shape_is_cube(role->shape))
        json_object_set_new(texture, "cube", json_pack("{s:s}", "layout", "strip_vertical"));
    json_object_set_new(x->textures, name, texture);
    return ok;
}

static bool is_key_of_part(const char *channel) {
    return pack_key(pack_object("part"), channel) || !strcmp(channel, "comment") || !strcmp(channel, "RGB") ||
           !strcmp(channel, "RGBA");
}

/* Adds the channels in the order of glint.storage, in which the engine had them, so that the same bytes can be packed again. */
static bool add_channels(const struct glint_exr_part_info *part, json_t **values, json_t *out,
                         struct glint_error *err) {
    const struct glint_exr_attribute *order = glint_exr_attribute(part, "glint.storage");
    const size_t named = order && order->strings ? order->count : 0;
    bool ok = true;
    for (size_t k = 0; k < named + part->channel_count; k++)
        for (size_t i = 0; i < part->channel_count; i++) {
            const char *name = part->channels[i].name;
            const size_t length = strlen(name);
            if (!values[i] || (k < named ? strncmp(order->strings[k], name, length) || order->strings[k][length] != '='
                                         : k - named != i))
                continue;
            json_t *object = is_key_of_part(name) ? json_object_get(out, "channels") : out;
            if (!object) json_object_set_new(out, "channels", object = json_object());
            ok = !json_object_set_new(object, name, values[i]) && ok;
            values[i] = NULL;
        }
    return ok || glint_fail(err, GLINT_ERROR_UNSUPPORTED,
                            "part %s: expected names of channels in UTF-8, found other bytes", part->name);
}

static json_t *channel_value(const struct glint_exr_part_info *part, size_t channel, const char *texture,
                             char component) {
    char storage[64];
    const char letter[2] = {component, '\0'};
    return json_pack("{s:s, s:s, s:s}", "texture", texture, "channel", letter, "storage",
                     extract_storage(part, &part->channels[channel], storage));
}

static bool extract_channels(struct extract *x, size_t p, json_t *out, struct glint_error *err) {
    const struct glint_exr_part_info *part = glint_exr_part(x->exr, p);
    bool *done = calloc(part->channel_count + 1, sizeof *done);
    json_t **values = calloc(part->channel_count + 1, sizeof *values);
    bool ok = (done && values) || no_memory(x, err);
    for (size_t i = 0; ok && i < part->channel_count; i++) {
        size_t group[4];
        char name[128], layer[256];
        if (done[i]) continue;
        const size_t count = group_of(part, i, done, group), length = layer_length(part->channels[i].name);
        /* a channel alone is called after itself: material.roughness */
        snprintf(layer, sizeof layer, "%.*s", count > 1 ? (int)length : 255, part->channels[i].name);
        name_texture(x, part->name, layer, name);
        ok = write_texture(x, p, group, count, name, err);
        for (size_t k = 0; ok && k < count; k++) {
            done[group[k]] = true;
            values[group[k]] = channel_value(part, group[k], name, "rgba"[k]);
            ok = values[group[k]] != NULL ||
                 glint_fail(err, GLINT_ERROR_UNSUPPORTED, "part %s: expected names in UTF-8, found other bytes",
                            part->name);
        }
    }
    ok = ok && add_channels(part, values, out, err);
    for (size_t i = 0; values && i < part->channel_count; i++) json_decref(values[i]);
    free(values);
    free(done);
    return ok;
}

/* ---- Parts ---- */

static bool extract_sibling(const struct extract *x, const char *name, json_t *out, struct glint_error *err) {
    char *from = file_beside(x->capture, name), *to = path_in(x, name);
    bool ok = (from && to) || no_memory(x, err);
    if (ok && strchr(name, '/'))
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: sibling %s is no file name", x->capture, name);
    if (ok && !file_same(from, to) && !file_equal(from, to)) ok = file_copy(from, to, err);
    json_object_set_new(out, "sibling", json_string(name));
    free(from);
    free(to);
    return ok;
}

static bool extract_part(struct extract *x, size_t p, struct glint_error *err) {
    const struct glint_exr_part_info *part = glint_exr_part(x->exr, p);
    const struct glint_exr_attribute *sibling = glint_exr_attribute(part, "glint.sibling");
    json_t *out = json_object();
    if (!out || json_object_set_new(x->parts, part->name, out))
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: expected names of parts in UTF-8, found other bytes",
                          x->capture);
    if (!strcmp(part->name, "gbuffer")) json_object_set_new(x->manifest, "frame", extract_frame(part));
    return extract_attributes(part, out, err) &&
           (sibling && sibling->string ? extract_sibling(x, sibling->string, out, err)
                                       : extract_channels(x, p, out, err));
}

static bool extract_all(struct extract *x, struct glint_error *err) {
    const size_t count = glint_exr_part_count(x->exr);
    for (size_t p = 0; p < count; p++)
        if (!report(x, glint_exr_part(x->exr, p)->name, (double)p / (double)count, err) || !extract_part(x, p, err))
            return false;
    json_object_set(x->manifest, "textures", x->textures);
    json_object_set(x->manifest, "parts", x->parts);
    char *text = shown_json(json_dumps(x->manifest, JSON_INDENT(1) | JSON_REAL_PRECISION(17)));
    if (!text) return no_memory(x, err);
    const bool ok = write_file(x, "manifest.json", text, strlen(text), err);
    free(text);
    return ok;
}

bool glint_extract(const char *capture, const char *folder, const struct glint_pack_options *options,
                   struct glint_error *err) {
    struct extract x = {.capture = capture,
                        .folder = folder,
                        .options = options,
                        .manifest = json_pack("{s:i}", "glint", 1),
                        .textures = json_object(),
                        .parts = json_object()};
    x.exr = glint_exr_open(capture, NULL, err);
    bool ok = x.exr && ((x.manifest && x.textures && x.parts) || no_memory(&x, err));
    const bool made = access(folder, F_OK) != 0;
    ok = ok && glint_make_folder(folder, err) && extract_all(&x, err);
    finish_files(&x, ok);
    if (!ok && made) rmdir(folder);
    glint_exr_close(&x.exr);
    json_decref(x.manifest);
    json_decref(x.textures);
    json_decref(x.parts);
    return ok;
}
