/* Multilayer EXR files that Blender wrote: their passes by Blender's names become the channels of G-buffer, light and finished picture. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "blender.h"
#include "glint/exr.h"
#include "readers.h"

#define NEEDED true
#define OPTIONAL false
static const struct row {
    const char *part, *channel, *passes;
    int scale;
    bool needed;
    const char *without;
} rows[] = {
#define CHANNEL(part, channel, passes, scale, need, without) {part, channel, passes, scale, need, without},
#include "blender_rows.h"
};
enum { ROWS = sizeof rows / sizeof *rows };
/* lit: terms beside DiffDir, in the order in which they are read. */
static const char *const light[] = {"DiffInd", "DiffCol", "Emit", "Env"};
enum { LIGHTS = 1 + sizeof light / sizeof *light };
static const float sky_depth = 1e9f; /* Cycles writes 1e10 where it sees the world */
static const char texture_name[] = "blender";

struct file {
    struct glint_exr *exr;
    const struct glint_exr_part_info *part;
    char layer[256]; /* the view layer, with a dot behind it */
    const char *found[ROWS];
};

static const char *find_channel(const struct file *file, const char *pass, size_t length) {
    const size_t layer = strlen(file->layer);
    for (size_t i = 0; i < file->part->channel_count; i++) {
        const char *name = file->part->channels[i].name;
        if (!strncmp(name, file->layer, layer) && strlen(name) == layer + length &&
            !strncasecmp(name + layer, pass, length))
            return name;
    }
    return NULL;
}

static const char *find_row(const struct file *file, const struct row *row) {
    for (const char *pass = row->passes; *pass;) {
        const size_t length = strcspn(pass, " ");
        const char *name = find_channel(file, pass, length);
        if (name) return name;
        pass += length + strspn(pass + length, " ");
    }
    return NULL;
}

/* The first view layer that has a depth. */
static bool find_layer(struct file *file, const struct node *texture, const char *path, struct glint_error *err) {
    static const char depth[] = ".Depth.Z";
    for (size_t i = 0; i < file->part->channel_count; i++) {
        const char *name = file->part->channels[i].name;
        const size_t length = strlen(name), tail = sizeof depth - 1;
        if (length <= tail || length - tail + 2 > sizeof file->layer || strcmp(name + length - tail, depth)) continue;
        snprintf(file->layer, sizeof file->layer, "%.*s", (int)(length - tail + 1), name);
        return true;
    }
    return node_fail(
        texture, err, GLINT_ERROR_FORMAT,
        "%s: expected a multilayer EXR file of Blender with a channel VIEWLAYER.Depth.Z, found none: switch "
        "on the pass Z",
        path);
}

static bool file_open(struct file *file, const struct node *texture, const char *path, struct glint_error *err) {
    *file = (struct file){.exr = glint_exr_open(path, NULL, err)};
    if (!file->exr) return node_wrap(texture, err);
    file->part = glint_exr_part(file->exr, 0);
    if (!find_layer(file, texture, path, err)) return false;
    for (size_t i = 0; i < ROWS; i++) file->found[i] = find_row(file, &rows[i]);
    return true;
}

/* ---- Reading ---- */

/* The terms of lit of one colour, interleaved as in `light`; terms that the file lacks are 0, or 1 where they are factors. */
static void add_light(float *values, const float *terms, size_t texels, bool has_color) {
    for (size_t i = 0; i < texels; i++) {
        const float *t = terms + i * LIGHTS, sum = t[0] + t[1];
        values[i] = fmaxf(0, (has_color ? sum * t[2] : sum) + t[3] + t[4]);
    }
}

static bool read_light(const struct file *file, const struct node *texture, const struct row *row, float *values,
                       struct glint_error *err) {
    const size_t texels = (size_t)file->part->width * file->part->height;
    const char *names[LIGHTS] = {find_row(file, row)};
    for (size_t i = 1; i < LIGHTS; i++) {
        char pass[32];
        const int length = snprintf(pass, sizeof pass, "%s.%s", light[i - 1], row->channel);
        names[i] = find_channel(file, pass, (size_t)length);
    }
    float *terms = malloc(texels * LIGHTS * sizeof *terms);
    if (!terms) return node_no_memory(texture, err);
    const bool ok = glint_exr_read(file->exr, 0, names, LIGHTS, GLINT_F32, terms, 0, err) || node_wrap(texture, err);
    if (ok) add_light(values, terms, texels, names[2] != NULL);
    free(terms);
    return ok;
}

static bool read_row(const struct file *file, const struct node *texture, size_t row, float *values,
                     struct glint_error *err) {
    const size_t texels = (size_t)file->part->width * file->part->height;
    if (!strcmp(rows[row].part, "lit")) return read_light(file, texture, &rows[row], values, err);
    if (!glint_exr_read(file->exr, 0, &file->found[row], 1, GLINT_F32, values, 0, err)) return node_wrap(texture, err);
    const bool depth = !strcmp(rows[row].channel, "depth.Z"), scene = !strcmp(rows[row].part, "scene");
    for (size_t i = 0; i < texels; i++)
        values[i] = depth && values[i] >= sky_depth ? INFINITY
                    : scene                         ? fmaxf(0, values[i])
                                                    : (float)rows[row].scale * values[i];
    return true;
}

/* Blender averages the normals of a pixel's samples: their directions are kept. */
static void make_unit(float *normal, size_t texels) {
    for (size_t i = 0; i < texels; i++) {
        float *x = &normal[i], *y = x + texels, *z = y + texels;
        const float length = sqrtf(*x * *x + *y * *y + *z * *z);
        if (!(length > 0)) *z = 1; /* the sky has none */
        else *x /= length, *y /= length, *z /= length;
    }
}

static bool read_all(struct image *image, const struct node *texture, const struct file *file,
                     struct glint_error *err) {
    const size_t texels = (size_t)image->width * image->height, plane = texels * sizeof(float);
    for (size_t i = 0; i < ROWS; i++) {
        if (!file->found[i]) continue;
        char name[64];
        snprintf(name, sizeof name, "%s.%s", rows[i].part, rows[i].channel);
        struct source *source = &image->sources[image->count];
        *source = (struct source){.component = {.bits = 32, .kind = COMPONENT_FLOAT},
                                  .first = image->count * plane,
                                  .x_step = sizeof(float),
                                  .row_pitch = image->width * sizeof(float),
                                  .layer_pitch = plane,
                                  .name = strdup(name)};
        if (!source->name) return node_no_memory(texture, err);
        image->count++;
        float *values = (float *)(void *)(image->bytes.data + source->first);
        if (!read_row(file, texture, i, values, err)) return false;
        if (!strcmp(rows[i].channel, "normal.Z") && file->found[i - 1] && file->found[i - 2])
            make_unit(values - 2 * texels, texels);
    }
    return true;
}

bool image_read_blender(struct image *image, const struct node *texture, const char *path, struct glint_error *err) {
    struct file file;
    bool ok = file_open(&file, texture, path, err);
    const uint64_t bytes = ok ? (uint64_t)file.part->width * file.part->height * sizeof(float) * ROWS : 0;
    if (ok && (!bytes || bytes > IMAGE_MAX_BYTES || file.part->width > IMAGE_MAX_WIDTH ||
               file.part->height > IMAGE_MAX_HEIGHT))
        ok = node_fail(texture, err, GLINT_ERROR_LIMIT, "%s: expected at most 4 GiB of pixels, found %u x %u", path,
                       file.part->width, file.part->height);
    if (ok) {
        image->width = file.part->width;
        image->height = file.part->height;
        image->layers = 1;
        snprintf(image->format, sizeof image->format, "OpenEXR");
        image->sources = calloc(ROWS, sizeof *image->sources);
        image->bytes = (struct bytes){.data = malloc((size_t)bytes), .size = (size_t)bytes};
        ok = (image->sources && image->bytes.data) || node_no_memory(texture, err);
    }
    ok = ok && read_all(image, texture, &file, err);
    glint_exr_close(&file.exr);
    return ok;
}

/* ---- A manifest for the file ---- */

/* Whether the manifest says the channel, by its name, its layer's or its letters'. */
static bool is_said(json_t *part, const char *channel) {
    char layer[64];
    snprintf(layer, sizeof layer, "%.*s", (int)strcspn(channel, "."), channel);
    json_t *more = json_object_get(part, "channels");
    return json_object_get(part, channel) || json_object_get(more, channel) || json_object_get(part, "sibling") ||
           (strchr(channel, '.') ? json_object_get(part, layer) : json_object_get(part, "RGB")) != NULL;
}

/* Which terms lit is made of, and which of them the file lacks. */
static void note_light(const struct node *channel, const struct file *file, const char *first) {
    char text[400], missing[200] = "";
    size_t length = (size_t)snprintf(text, sizeof text, "(%s", first);
    static const char *const before[] = {" + ", ") · ", " + ", " + "};
    for (size_t i = 0; i < LIGHTS - 1; i++) {
        char pass[32];
        const int bytes = snprintf(pass, sizeof pass, "%s.%s", light[i], channel->key);
        const bool found = find_channel(file, pass, (size_t)bytes) != NULL;
        const size_t used = strlen(missing);
        if (!found) snprintf(missing + used, sizeof missing - used, "%s%s", used ? ", " : "", light[i]);
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%s", before[i],
                                   found    ? light[i]
                                   : i == 1 ? "1"
                                            : "0");
    }
    node_note(channel, GLINT_PACK_FOUND, "%s", text);
    if (missing[0]) node_note(channel, GLINT_PACK_DEFAULT, "no pass %s; the light that it holds is missing", missing);
}

static bool add_row(const struct manifest *manifest, const struct file *file, size_t row, struct glint_error *err) {
    const struct node root = node_root(manifest), parts = node_child(&root, "parts");
    const struct row *r = &rows[row];
    const struct node part = node_child(&parts, r->part), channel = node_child(&part, r->channel);
    if (is_said(part.value, r->channel)) return true;
    const bool is_diffuse = file->found[row] && strstr(file->found[row], ".DiffCol.");
    if (!file->found[row] && r->needed)
        return node_fail(&channel, err, GLINT_ERROR_FORMAT, "the file has no channel %s%.*s: %s", file->layer,
                         (int)strcspn(r->passes, " "), r->passes, r->without);
    if (!file->found[row]) {
        if (r->without[0]) node_note(&channel, GLINT_PACK_DEFAULT, "%s", r->without);
        return true;
    }
    if (!strcmp(r->part, "lit")) note_light(&channel, file, file->found[row]);
    else
        node_note(&channel, GLINT_PACK_FOUND, "%s%s%s", r->scale < 0 ? "-" : "", file->found[row],
                  is_diffuse ? "; it is black where a metal is, an AOV albedo is not" : "");
    char name[64];
    snprintf(name, sizeof name, "%s.%s", r->part, r->channel);
    json_t *said = part.value ? json_incref(part.value) : json_object();
    const bool ok =
        said && !json_object_set_new(said, r->channel, json_pack("{ssss}", "texture", texture_name, "channel", name)) &&
        !json_object_set(parts.value, r->part, said);
    json_decref(said);
    return ok || node_no_memory(&channel, err);
}

static bool add_encodings(const struct manifest *manifest, struct glint_error *err) {
    static const char *const all[][2] = {{"depth", "view_linear"}, {"normal", "signed"}, {"motion", "pixels"}};
    const struct node root = node_root(manifest), parts = node_child(&root, "parts"),
                      part = node_child(&parts, "gbuffer");
    json_t *said = json_object_get(part.value, "encodings"), *made = said ? json_incref(said) : json_object();
    bool ok = made != NULL;
    for (size_t i = 0; ok && i < sizeof all / sizeof *all; i++)
        if (!json_object_get(made, all[i][0]) && (i < 2 || json_object_get(part.value, "motion.X")))
            ok = !json_object_set_new(made, all[i][0], json_string(all[i][1]));
    ok = ok && !json_object_set(part.value, "encodings", made);
    json_decref(made);
    return ok || node_no_memory(&part, err);
}

/* The file is named as whoever called sees it, and not relative to the manifest. */
static bool add_texture(const struct manifest *manifest, const char *path, struct glint_error *err) {
    const struct node root = node_root(manifest);
    json_t *textures = json_object_get(root.value, "textures");
    char *whole = realpath(path, NULL);
    bool ok = textures || !json_object_set_new(root.value, "textures", json_object());
    textures = json_object_get(root.value, "textures");
    if (whole && json_object_get(textures, texture_name)) {
        free(whole);
        const struct node node = node_child(&root, "textures"), taken = node_child(&node, texture_name);
        return node_fail(&taken, err, GLINT_ERROR_FORMAT,
                         "expected another name: this one stands for the file of Blender");
    }
    if (!whole) return glint_fail(err, GLINT_ERROR_IO, "%s: there is no such file", path);
    ok = ok && !json_object_set_new(textures, texture_name, json_pack("{ssss}", "file", whole, "passes", "blender"));
    free(whole);
    return ok || node_no_memory(&root, err);
}

bool blender_add(const struct manifest *manifest, const char *path, struct glint_error *err) {
    struct file file = {0};
    const struct node root = node_root(manifest), textures = node_child(&root, "textures");
    bool ok = add_texture(manifest, path, err) && file_open(&file, &textures, path, err);
    for (size_t i = 0; ok && i < ROWS; i++) ok = add_row(manifest, &file, i, err);
    ok = ok && add_encodings(manifest, err);
    glint_exr_close(&file.exr);
    return ok;
}
