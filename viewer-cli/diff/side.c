/* The images of one side of a comparison: of a file, of a run, or the engine's intermediates in a capture. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "diff/diff.h"
#include "capture/channels.h"
#include "draw/view/source.h"
#include "nearest.h"

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static void image_finish(struct diff_image *image) {
    for (size_t i = 0; image->run && i < image->channel_count; i++) free((char *)image->channels[i]);
    free(image->name);
    free(image->channels);
    free(image->stored);
    free(image->integers);
}

void diff_side_finish(struct diff_side *side) {
    for (size_t i = 0; i < side->count; i++) image_finish(&side->images[i]);
    free(side->images);
    if (side->exr) glint_exr_close(&side->exr);
    glint_run_close(&side->run);
    glint_capture_close(&side->capture);
    json_decref(side->json);
    free(side->path);
    *side = (struct diff_side){0};
}

/* Appends an empty image with room for its name and channels. */
static struct diff_image *add_image(struct diff_side *side, const char *name, size_t channels,
                                    struct glint_error *err) {
    struct diff_image *larger = realloc(side->images, (side->count + 1) * sizeof *larger);
    if (larger) side->images = larger;
    struct diff_image image = {.name = strdup(name),
                               .slot = "",
                               .variant = "",
                               .unit = "",
                               .channels = calloc(channels + 1, sizeof *image.channels),
                               .stored = calloc(channels + 1, sizeof *image.stored),
                               .integers = calloc(channels + 1, sizeof *image.integers)};
    if (!larger || !image.name || !image.channels || !image.stored || !image.integers) {
        image_finish(&image);
        no_memory(err);
        return NULL;
    }
    side->images[side->count] = image;
    return &side->images[side->count++];
}

static void set_size(struct diff_image *image, uint32_t width, uint32_t height) {
    image->width = image->own_width = width;
    image->height = image->own_height = height;
}

/* ---- Files ---- */

static bool in_layer(const struct diff_side *side, const char *channel) {
    const size_t length = channel_layer_length(channel);
    return !side->layer || !strcmp(channel, side->layer) ||
           (length == strlen(side->layer) && !strncmp(channel, side->layer, length));
}

static bool add_part(struct diff_side *side, size_t p, const char *name, struct glint_error *err) {
    const struct glint_exr_part_info *part = glint_exr_part(side->exr, p);
    if (part->channel_count > DIFF_CHANNELS)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: part %s: expected at most %d channels, found %zu", side->text,
                          part->name, DIFF_CHANNELS, part->channel_count);
    struct diff_image *image = add_image(side, name, part->channel_count, err);
    if (!image) return false;
    image->part = p;
    const struct glint_exr_attribute *color = side->is_capture ? NULL : glint_exr_attribute(part, "glint.color");
    image->display = color && color->type == GLINT_EXR_STRING && glint_encoding_is_display(color->string);
    set_size(image, part->width, part->height);
    for (size_t c = 0; c < part->channel_count; c++) {
        if (!in_layer(side, part->channels[c].name)) continue;
        image->integers[image->channel_count] = part->channels[c].stored == GLINT_STORED_UINT;
        image->channels[image->channel_count++] = part->channels[c].name;
    }
    return true;
}

static bool list_file(struct diff_side *side, struct glint_error *err) {
    for (size_t p = 0; p < glint_exr_part_count(side->exr); p++) {
        const char *name = glint_exr_part(side->exr, p)->name;
        if ((!side->part || !strcmp(side->part, name)) && !add_part(side, p, name, err)) return false;
    }
    return true;
}

/* ---- Captures ---- */

static const struct glint_part_info *find_captured(const struct diff_side *side, struct glint_error *err) {
    const struct glint_part_info *part = glint_capture_find(side->capture, side->part);
    struct glint_nearest near = glint_nearest_to(side->part);
    for (size_t i = 0; i < glint_capture_part_count(side->capture); i++)
        glint_nearest_offer(&near, glint_capture_part(side->capture, i)->name);
    if (!part)
        glint_fail(err, GLINT_ERROR_USAGE, "%s: no part %s%s", side->path, side->part, glint_nearest_text(&near));
    return part;
}

static const char *unit_of(const struct glint_part_info *part, const char *channel) {
    for (size_t i = 0; part->role && i < part->role->channel_count; i++)
        if (!strcmp(part->role->channels[i].name, channel)) return part->role->channels[i].unit;
    return "";
}

/* One part, decoded as a replay reads it. The channels of a layer are named as those of an image: Z of depth. */
static bool list_captured(struct diff_side *side, struct glint_error *err) {
    if (!(side->capture = glint_capture_open(side->path, NULL, err))) return false;
    const struct glint_part_info *part = find_captured(side, err);
    struct diff_image *image = part ? add_image(side, part->name, part->channel_count, err) : NULL;
    if (!image) return false;
    image->captured = part;
    set_size(image, part->width, part->height);
    for (size_t c = 0; c < part->channel_count && image->channel_count < DIFF_CHANNELS; c++) {
        const char *name = part->channels[c].name;
        const size_t layer = side->layer ? channel_layer_length(name) : 0;
        if (!in_layer(side, name)) continue;
        if (!image->channel_count) image->unit = unit_of(part, name);
        image->integers[image->channel_count] =
            part->channels[c].stored == GLINT_STORED_UINT && strncmp(name, "motion.", 7) != 0;
        image->stored[image->channel_count] = name;
        image->channels[image->channel_count++] = name + (layer ? layer + 1 : 0);
    }
    return image->channel_count || glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s has no layer or channel %s",
                                              side->path, part->name, side->layer);
}

/* Engine intermediates are named "engine.SLOT.IMAGE". */
static bool list_engine(struct diff_side *side, struct glint_error *err) {
    static const char prefix[] = "engine.";
    for (size_t p = 0; p < glint_exr_part_count(side->exr); p++) {
        const char *name = glint_exr_part(side->exr, p)->name;
        const char *dot = strncmp(name, prefix, strlen(prefix)) ? NULL : strchr(name + strlen(prefix), '.');
        if (dot && (!side->part || !strcmp(side->part, dot + 1)) && !add_part(side, p, dot + 1, err)) return false;
    }
    if (side->count) return true;
    return side->part ? list_captured(side, err)
                      : glint_fail(err, GLINT_ERROR_FORMAT,
                                   "%s: expected intermediates of the engine to compare a run with, parts "
                                   "engine.SLOT.IMAGE, found none; %s:PART compares an image with that part",
                                   side->text, side->text);
}

/* ---- Runs ---- */

static bool list_run(struct diff_side *side, struct glint_error *err) {
    for (size_t i = 0; i < glint_run_image_count(side->run); i++) {
        const struct glint_run_image *info = glint_run_image(side->run, i);
        if (side->part && strcmp(side->part, info->name) != 0) continue;
        struct diff_image *image = add_image(side, info->name, info->components, err);
        if (!image) return false;
        image->run = info;
        image->slot = info->slot;
        image->variant = info->variant;
        image->unit = info->unit;
        image->display = glint_encoding_is_display(info->encoding);
        set_size(image, info->width, info->height);
        for (const char *at = info->channels; *at && image->channel_count < info->components;) {
            const size_t length = strcspn(at, " ");
            image->integers[image->channel_count] = info->integer;
            if (!(image->channels[image->channel_count] = strndup(at, length))) return no_memory(err);
            image->channel_count++;
            at += length + (at[length] == ' ');
        }
    }
    return true;
}

/* ---- Both ---- */

static bool open_side(struct diff_side *side, const char *text, struct glint_error *err) {
    struct stat info;
    side->text = text;
    if (!(side->path = source_split(text, &side->part, &side->layer))) return no_memory(err);
    if (stat(side->path, &info) == 0 && S_ISDIR(info.st_mode)) {
        if (!(side->run = glint_run_open(side->path, err))) return false;
        return (side->json = json_loads(glint_run_json(side->run), 0, NULL)) || no_memory(err);
    }
    if (!(side->exr = glint_exr_open(side->path, NULL, err))) return false;
    for (size_t p = 0; p < glint_exr_part_count(side->exr); p++)
        side->is_capture |= !strcmp(glint_exr_part(side->exr, p)->name, "gbuffer");
    return true;
}

bool diff_sides_open(struct diff_side sides[2], const char *const paths[2], struct glint_error *err) {
    for (int k = 0; k < 2; k++)
        if (!open_side(&sides[k], paths[k], err)) return false;
    for (int k = 0; k < 2; k++) {
        struct diff_side *side = &sides[k];
        const bool engine = side->is_capture && sides[1 - k].run;
        if (!(side->run ? list_run(side, err) : engine ? list_engine(side, err) : list_file(side, err))) return false;
        if (!side->count)
            return glint_fail(err, side->part ? GLINT_ERROR_USAGE : GLINT_ERROR_FORMAT,
                              "%s: expected an image%s%s, found none", side->text, side->part ? " of the name " : "",
                              side->part ? side->part : "");
    }
    return true;
}

static bool read_run(struct diff_side *side, const struct diff_image *image, const char *const *channels, size_t count,
                     bool integers, void *out, struct glint_error *err) {
    const size_t pixels = (size_t)image->own_width * image->own_height, components = image->channel_count;
    uint32_t *all = malloc(pixels * components * sizeof *all), *to = out;
    bool ok = (all || no_memory(err)) && (integers ? glint_run_read(side->run, image->run, GLINT_U32, all, err)
                                                   : glint_run_read_linear(side->run, image->run, (float *)all, err));
    for (size_t k = 0; ok && k < count; k++) {
        size_t from = 0;
        while (from < components && strcmp(image->channels[from], channels[k]) != 0) from++;
        for (size_t i = 0; i < pixels; i++) to[i * count + k] = all[i * components + from];
    }
    free(all);
    return ok;
}

const struct diff_image *diff_side_image(const struct diff_side *side, const char *name) {
    for (size_t i = 0; i < side->count; i++)
        if (!strcmp(side->images[i].name, name)) return &side->images[i];
    return NULL;
}

static bool read_captured(struct diff_side *side, const struct diff_image *image, const char *const *channels,
                          size_t count, bool integers, void *out, struct glint_error *err) {
    const char *stored[DIFF_CHANNELS];
    for (size_t k = 0; k < count; k++) {
        size_t from = 0;
        while (from < image->channel_count && strcmp(image->channels[from], channels[k]) != 0) from++;
        stored[k] = image->stored[from];
    }
    return glint_capture_read(side->capture, image->captured, stored, count, integers ? GLINT_U32 : GLINT_F32, out, 0,
                              err);
}

static bool read_own(struct diff_side *side, const struct diff_image *image, const char *const *channels, size_t count,
                     bool integers, void *out, struct glint_error *err) {
    if (side->run) return read_run(side, image, channels, count, integers, out, err);
    if (image->captured) return read_captured(side, image, channels, count, integers, out, err);
    if (!glint_exr_read(side->exr, image->part, channels, count, integers ? GLINT_U32 : GLINT_F32, out, 0, err))
        return false;
    if (image->display && !integers)
        glint_decode_display(out, (size_t)image->own_width * image->own_height, channels, count);
    return true;
}

bool diff_side_read(struct diff_side *side, const struct diff_image *image, const char *const *channels, size_t count,
                    bool integers, void *out, struct glint_error *err) {
    const struct diff_size own = {image->own_width, image->own_height}, to = {image->width, image->height};
    if (own.width == to.width && own.height == to.height)
        return read_own(side, image, channels, count, integers, out, err);
    uint32_t *values = malloc((size_t)own.width * own.height * count * sizeof *values);
    const bool ok = (values || no_memory(err)) && read_own(side, image, channels, count, integers, values, err);
    if (ok) diff_resample(values, own, out, to, count, integers);
    free(values);
    return ok;
}
