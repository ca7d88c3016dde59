/* A run's images in one EXR file. Parts: each image is a part of its own size. Layers: one part, in which every picture has the size of the
   composed one, and channels are IMAGE.CHANNEL. */
#include "export/export.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/declarations.h"
#include "glint/exr.h"
#include "nearest.h"

enum { CHANNELS = 4, NAME_SIZE = 512, TEXTS = 6 };

/* An image, with the memory that the file needs until it is written. */
struct exported {
    const struct glint_run_image *image;
    bool picture; /* of what the camera sees, so that it can be enlarged to the size of the composed one */
    bool half;
    uint32_t width, height; /* in the file */
    char *texels;
    char names[CHANNELS][NAME_SIZE];
    struct glint_exr_channel channels[CHANNELS];
    struct glint_exr_attribute attributes[TEXTS + 2];
    char layer[NAME_SIZE], about[2 * NAME_SIZE]; /* the attribute of a layer */
};

struct job {
    const struct export_options *options;
    struct glint_run *run;
    json_t *json;
    struct exported *images;
    size_t count;
    uint32_t full[2];
    float to_camera[16], to_ndc[16];
    struct glint_exr_attribute standard[2];
    size_t standard_count;
};

static bool fail_job(const struct job *job, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", job->options->out);
}

/* ---- Camera ---- */

static bool read_matrix(const json_t *list, double matrix[16]) {
    if (json_array_size(list) != 16) return false;
    for (size_t i = 0; i < 16; i++) matrix[i] = json_number_value(json_array_get(list, i));
    return true;
}

static void read_camera(struct job *job) {
    const json_t *from = json_object_get(job->json, "camera");
    const char *clip_y = json_string_value(json_object_get(from, "clip_y"));
    struct glint_camera camera = {0};
    double matrices[2][16];
    if (!clip_y || !read_matrix(json_object_get(from, "world_to_view"), camera.world_to_view) ||
        !read_matrix(json_object_get(from, "view_to_clip"), camera.view_to_clip))
        return;
    glint_camera_standard(&camera, !strcmp(clip_y, "down") ? GLINT_CLIP_Y_DOWN : GLINT_CLIP_Y_UP, matrices[0],
                          matrices[1]);
    static const char *const names[] = {"worldToCamera", "worldToNDC"};
    float *const to[] = {job->to_camera, job->to_ndc};
    for (size_t m = 0; m < 2; m++) {
        for (size_t i = 0; i < 16; i++) to[m][i] = (float)matrices[m][i];
        job->standard[m] = (struct glint_exr_attribute){.name = names[m],
                                                        .type = GLINT_EXR_OPAQUE,
                                                        .type_name = "m44f",
                                                        .bytes = to[m],
                                                        .count = sizeof job->to_camera};
    }
    job->standard_count = 2;
}

/* ---- Images ---- */

static bool stored_as_half(const struct job *job, const char *name) {
    const json_t *pass, *image;
    size_t p, i;
    json_array_foreach(json_object_get(job->json, "passes"), p, pass) {
        json_array_foreach(json_object_get(pass, "images"), i, image) {
            const char *found = json_string_value(json_object_get(image, "name"));
            const char *format = json_string_value(json_object_get(image, "format"));
            if (found && !strcmp(found, name)) return format && strstr(format, "16F");
        }
    }
    return false;
}

/* By its declaration; an image of an unknown pass by its size. */
static bool is_picture(const struct job *job, const struct glint_run_image *image) {
    const struct glint_pass *pass = glint_pass_find(image->slot, image->variant);
    const char *level = strstr(image->name, ".level");
    char name[NAME_SIZE];
    if (image->width > job->full[0] || image->height > job->full[1]) return false;
    snprintf(name, sizeof name, "%.*s", level ? (int)(level - image->name) : NAME_SIZE - 1, image->name);
    const struct glint_row *row = pass ? glint_pass_output(pass, name) : NULL;
    if (!row) return !image->cube && image->width == job->full[0] && image->height == job->full[1];
    return glint_size_is_picture(row->size);
}

static bool is_named(const struct list *names, const char *name) {
    for (size_t i = 0; i < names->count; i++)
        if (!strcmp(names->items[i], name)) return true;
    return !names->count;
}

static bool check_names(const struct job *job, struct glint_error *err) {
    const struct list *names = &job->options->images;
    for (size_t i = 0; i < names->count; i++) {
        if (glint_run_find(job->run, names->items[i])) continue;
        struct glint_nearest near = glint_nearest_to(names->items[i]);
        for (size_t k = 0; k < glint_run_image_count(job->run); k++)
            glint_nearest_offer(&near, glint_run_image(job->run, k)->name);
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: the run has no image %s%s; glint info lists them",
                          job->options->run, names->items[i], glint_nearest_text(&near));
    }
    return true;
}

/* Pictures of the composed size come first, since the first part's size is that of the display window. */
static int larger_first(const void *a, const void *b) {
    const struct exported *left = a, *right = b;
    if (left->picture != right->picture) return left->picture ? -1 : 1;
    if (left->image->width != right->image->width && left->picture)
        return left->image->width > right->image->width ? -1 : 1;
    return left->image < right->image ? -1 : left->image > right->image;
}

static bool choose_images(struct job *job, struct export_counts *counts, struct glint_error *err) {
    const size_t all = glint_run_image_count(job->run);
    job->images = calloc(all + 1, sizeof *job->images);
    if (!job->images) return fail_job(job, err);
    if (!check_names(job, err)) return false;
    for (size_t i = 0; i < all; i++) {
        const struct glint_run_image *image = glint_run_image(job->run, i);
        if (!is_named(&job->options->images, image->name)) continue;
        struct exported *to = &job->images[job->count];
        *to = (struct exported){
            .image = image, .picture = is_picture(job, image), .half = stored_as_half(job, image->name)};
        const bool coarser = strstr(image->name, ".level") && !job->options->images.count;
        if (job->options->multilayer && (!to->picture || coarser)) counts->left_out++;
        else job->count++;
    }
    qsort(job->images, job->count, sizeof *job->images, larger_first);
    counts->written = job->count;
    return job->count || glint_fail(err, GLINT_ERROR_USAGE,
                                    "%s: none of the images is a picture of what the camera sees; "
                                    "without --multilayer they are parts of their own",
                                    job->options->run);
}

/* ---- Texels ---- */

/* Which texel covers a pixel. Sizes are halved again and again, rounded up or down: a texel covers a power of two of pixels, but for the last one. */
static uint32_t texel_of(uint32_t pixel, uint32_t texels, uint32_t pixels) {
    const uint32_t at = pixel >> lround(log2((double)pixels / texels));
    return at < texels ? at : texels - 1;
}

static void enlarge(const struct exported *e, const char *from, size_t texel, char *to) {
    for (uint32_t y = 0; y < e->height; y++) {
        const char *line = from + (size_t)texel_of(y, e->image->height, e->height) * e->image->width * texel;
        for (uint32_t x = 0; x < e->width; x++, to += texel)
            memcpy(to, line + texel_of(x, e->image->width, e->width) * texel, texel);
    }
}

static bool read_texels(struct job *job, struct exported *e, struct glint_error *err) {
    const struct glint_run_image *image = e->image;
    const size_t texel = (e->half ? 2u : 4u) * image->components;
    const bool resized = e->width != image->width || e->height != image->height;
    char *texels = malloc((size_t)image->width * image->height * texel);
    e->texels = texels;
    if (!texels) return fail_job(job, err);
    if (!glint_run_read(job->run, image, image->integer ? GLINT_U32 : e->half ? GLINT_F16 : GLINT_F32, texels, err))
        return false;
    if (!resized) return true;
    if (!(e->texels = malloc((size_t)e->width * e->height * texel))) {
        free(texels);
        return fail_job(job, err);
    }
    enlarge(e, texels, texel, e->texels);
    free(texels);
    return true;
}

/* Blender shows channels of one letter. One that is named by a word is a layer of its own, with the channel V. */
static void layer_channel(char name[NAME_SIZE], const struct glint_run_image *image, const char *channel, int length) {
    if (length == 1) snprintf(name, NAME_SIZE, "%.250s.%.*s", image->name, length, channel);
    else if (image->components == 1) snprintf(name, NAME_SIZE, "%.250s.V", image->name);
    else snprintf(name, NAME_SIZE, "%.250s.%.*s.V", image->name, length, channel);
}

static void fill_channels(const struct job *job, struct exported *e) {
    const size_t bytes = e->half ? 2 : 4;
    const char *channel = e->image->channels;
    for (uint32_t c = 0; c < e->image->components; c++) {
        const int length = (int)strcspn(channel, " ");
        if (job->options->multilayer) layer_channel(e->names[c], e->image, channel, length);
        else snprintf(e->names[c], NAME_SIZE, "%.*s", length, channel);
        channel += length + (channel[length] == ' ');
        e->channels[c] = (struct glint_exr_channel){.name = e->names[c],
                                                    .stored = e->image->integer ? GLINT_STORED_UINT
                                                              : e->half         ? GLINT_STORED_HALF
                                                                                : GLINT_STORED_FLOAT,
                                                    .data = e->texels + c * bytes,
                                                    .x_stride_bytes = bytes * e->image->components,
                                                    .y_stride_bytes = bytes * e->image->components * e->width};
    }
}

/* ---- The file ---- */

static struct glint_exr_attribute text_attribute(const char *name, const char *text) {
    return (struct glint_exr_attribute){.name = name, .type = GLINT_EXR_STRING, .string = text, .count = 1};
}

static struct glint_exr_part image_part(const struct job *job, struct exported *e) {
    const struct glint_run_image *image = e->image;
    size_t n = 0;
    e->attributes[n++] = text_attribute("glint.image", image->name);
    e->attributes[n++] = text_attribute("glint.slot", image->slot);
    e->attributes[n++] = text_attribute("glint.variant", image->variant);
    e->attributes[n++] = text_attribute("glint.unit", image->unit);
    e->attributes[n++] = text_attribute("glint.meaning", image->meaning);
    e->attributes[n++] = text_attribute("glint.channels", image->channels);
    for (size_t i = 0; e->picture && i < job->standard_count; i++) e->attributes[n++] = job->standard[i];
    return (struct glint_exr_part){.name = image->name,
                                   .width = e->width,
                                   .height = e->height,
                                   .channels = e->channels,
                                   .channel_count = image->components,
                                   .attributes = e->attributes,
                                   .attribute_count = n};
}

static bool write_parts(struct job *job, struct glint_error *err) {
    struct glint_exr_part *parts = calloc(job->count, sizeof *parts);
    if (!parts) return fail_job(job, err);
    for (size_t i = 0; i < job->count; i++) parts[i] = image_part(job, &job->images[i]);
    const bool ok = glint_exr_write(job->options->out, parts, job->count, 0, err);
    free(parts);
    return ok;
}

static struct glint_exr_attribute layer_attribute(struct exported *e) {
    char resized[128] = "";
    if (e->image->width != e->width || e->image->height != e->height)
        snprintf(resized, sizeof resized, "%u x %u texels, each repeated to fill %u x %u; ", e->image->width,
                 e->image->height, e->width, e->height);
    snprintf(e->layer, NAME_SIZE, "glint.%.250s", e->image->name);
    snprintf(e->about, sizeof e->about, "%.60s; %s%.700s", e->image->unit, resized, e->image->meaning);
    return text_attribute(e->layer, e->about);
}

static bool write_layers(struct job *job, struct glint_error *err) {
    struct glint_exr_channel *channels = calloc(job->count * CHANNELS, sizeof *channels);
    struct glint_exr_attribute *attributes = calloc(job->count + 2, sizeof *attributes);
    struct glint_exr_part part = {.name = "layers",
                                  .width = job->full[0],
                                  .height = job->full[1],
                                  .channels = channels,
                                  .attributes = attributes};
    for (size_t i = 0; channels && attributes && i < job->count; i++) {
        struct exported *e = &job->images[i];
        memcpy(channels + part.channel_count, e->channels, e->image->components * sizeof *channels);
        part.channel_count += e->image->components;
        attributes[part.attribute_count++] = layer_attribute(e);
    }
    for (size_t i = 0; attributes && i < job->standard_count; i++)
        attributes[part.attribute_count++] = job->standard[i];
    const bool ok = channels && attributes ? glint_exr_write(job->options->out, &part, 1, 0, err) : fail_job(job, err);
    free(channels);
    free(attributes);
    return ok;
}

static bool read_run(struct job *job, struct glint_error *err) {
    job->run = glint_run_open(job->options->run, err);
    if (!job->run) return false;
    job->json = json_loads(glint_run_json(job->run), 0, NULL);
    const json_t *full = json_object_get(json_object_get(job->json, "resolution"), "full");
    for (size_t i = 0; i < 2; i++) {
        const json_int_t size = json_integer_value(json_array_get(full, i));
        if (size < 1 || size > 1 << 16)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s/run.json: resolution.full: expected two sizes, found others",
                              job->options->run);
        job->full[i] = (uint32_t)size;
    }
    read_camera(job);
    return true;
}

bool export_run(const struct export_options *options, struct export_counts *counts, struct glint_error *err) {
    struct job job = {.options = options};
    *counts = (struct export_counts){0};
    bool ok = read_run(&job, err) && choose_images(&job, counts, err);
    for (size_t i = 0; ok && i < job.count; i++) {
        struct exported *e = &job.images[i];
        e->width = options->multilayer ? job.full[0] : e->image->width;
        e->height = options->multilayer ? job.full[1] : e->image->height;
        counts->enlarged += e->width != e->image->width || e->height != e->image->height;
        ok = read_texels(&job, e, err);
        fill_channels(&job, e);
    }
    ok = ok && (options->multilayer ? write_layers : write_parts)(&job, err);
    counts->width = job.full[0];
    counts->height = job.full[1];
    counts->camera = job.standard_count > 0;
    for (size_t i = 0; i < job.count; i++) free(job.images[i].texels);
    free(job.images);
    json_decref(job.json);
    glint_run_close(&job.run);
    return ok;
}
