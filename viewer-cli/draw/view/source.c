/* Finds and reads the layer that the user names. */
#include "draw/view/source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "capture/channels.h"
#include "glint/exr.h"
#include "glint/replay.h"
#include "nearest.h"

void source_finish(struct source *source) {
    free(source->texels);
    source->texels = NULL;
}

int source_channel(const struct source *source, const char *name) {
    for (uint32_t i = 0; i < source->components; i++)
        if (!strcmp(source->channels[i], name)) return (int)i;
    return -1;
}

static bool in_layer(const char *channel, const char *layer) {
    size_t length = channel_layer_length(channel);
    return !strcmp(channel, layer) || (length == strlen(layer) && !strncmp(channel, layer, length));
}

/* Chosen channels of one part, with R G B A and X Y Z in that order. */
struct selection {
    const struct glint_channel_info *channels[4];
    size_t count;
};

static void select_layer(struct selection *selection, const struct glint_channel_info *channels, size_t count,
                         const char *layer) {
    selection->count = 0;
    for (int rank = 0; rank < 8; rank++)
        for (size_t i = 0; i < count && selection->count < 4; i++)
            if (channel_rank(channels[i].name) == rank && in_layer(channels[i].name, layer))
                selection->channels[selection->count++] = &channels[i];
}

/* The default is the part's own colour, else albedo, else the first layer. */
static void default_layer(char layer[256], const struct glint_channel_info *channels, size_t count) {
    layer[0] = '\0';
    for (size_t i = 0; i < count; i++)
        if (channel_layer_length(channels[i].name) == 0) return;
    for (size_t i = 0; i < count; i++)
        if (!strcmp(channels[i].name, "albedo.R")) {
            snprintf(layer, 256, "albedo");
            return;
        }
    if (count) snprintf(layer, 256, "%.*s", (int)channel_layer_length(channels[0].name), channels[0].name);
}

static bool no_layer(const char *path, const char *part, const struct glint_channel_info *channels, size_t count,
                     const char *layer, struct glint_error *err) {
    struct glint_nearest near = glint_nearest_to(layer);
    char layers[64][256];
    size_t known = 0;
    for (size_t i = 0; i < count && known < 64; i++) {
        snprintf(layers[known], 256, "%.*s", (int)channel_layer_length(channels[i].name), channels[i].name);
        glint_nearest_offer(&near, layers[known++]);
        glint_nearest_offer(&near, channels[i].name);
    }
    return glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s has no layer or channel %s%s; glint info lists them", path,
                      part, layer, glint_nearest_text(&near));
}

static bool allocate(struct source *source, struct glint_error *err) {
    source->texels = calloc((size_t)source->width * source->height * source->components, sizeof *source->texels);
    return source->texels || glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", source->title);
}

/* Converts integers to floats, which is exact up to 2^24; a picture has far fewer levels. */
static void integers_to_float(struct source *source) {
    size_t count = (size_t)source->width * source->height * source->components;
    for (size_t i = 0; i < count; i++) {
        uint32_t value;
        memcpy(&value, &source->texels[i], sizeof value);
        source->texels[i] = (float)value;
    }
}

static void fill_source(struct source *source, const char *part, const char *layer, uint32_t width, uint32_t height,
                        const struct selection *selection) {
    snprintf(source->title, sizeof source->title, "%.*s%s%.*s", 140, part, *part && *layer ? ":" : "", 140, layer);
    source->width = width;
    source->height = height;
    source->components = (uint32_t)selection->count;
    source->integer = selection->count > 0 && selection->channels[0]->stored == GLINT_STORED_UINT;
    for (size_t i = 0; i < selection->count; i++)
        snprintf(source->channels[i], sizeof source->channels[i], "%s",
                 selection->channels[i]->name + (channel_layer_length(selection->channels[i]->name)
                                                     ? channel_layer_length(selection->channels[i]->name) + 1
                                                     : 0));
}

/* ---- Captures: decoded values ---- */

static const char *role_unit(const struct glint_part_info *part, const char *channel) {
    for (size_t i = 0; part->role && i < part->role->channel_count; i++)
        if (!strcmp(part->role->channels[i].name, channel)) return part->role->channels[i].unit;
    return "";
}

static const struct glint_part_info *find_part(const struct glint_capture *capture, const char *name,
                                               struct glint_error *err) {
    const struct glint_part_info *part = glint_capture_find(capture, name);
    if (part) return part;
    struct glint_nearest near = glint_nearest_to(name);
    for (size_t i = 0; i < glint_capture_part_count(capture); i++)
        glint_nearest_offer(&near, glint_capture_part(capture, i)->name);
    glint_fail(err, GLINT_ERROR_USAGE, "%s: no part %s%s; glint info lists them", glint_capture_path(capture), name,
               glint_nearest_text(&near));
    return NULL;
}

/* Octahedral normals are stored as X Y and decoded to X Y Z. */
static bool read_capture(struct source *source, struct glint_capture *capture, const char *part_name,
                         const char *layer_name, struct glint_error *err) {
    const struct glint_part_info *part = find_part(capture, part_name ? part_name : "lit", err);
    if (!part) return false;
    char layer[256];
    struct selection s;
    struct glint_channel_info z = {.stored = GLINT_STORED_FLOAT};
    if (layer_name) snprintf(layer, sizeof layer, "%s", layer_name);
    else default_layer(layer, part->channels, part->channel_count);
    select_layer(&s, part->channels, part->channel_count, layer);
    if (s.count == 0)
        return no_layer(glint_capture_path(capture), part->name, part->channels, part->channel_count, layer, err);
    if (!strcmp(layer, "normal") && s.count == 2) {
        snprintf(z.name, sizeof z.name, "normal.Z");
        s.channels[s.count++] = &z;
    }
    fill_source(source, part->name, layer, part->width, part->height, &s);
    source->cube = part->width * 6 == part->height && (!part->role || part->role->shape != GLINT_SHAPE_FRAME);
    snprintf(source->unit, sizeof source->unit, "%s", role_unit(part, s.channels[0]->name));
    if (!strncmp(s.channels[0]->name, "motion.", 7)) source->integer = false;
    const char *names[4] = {0};
    for (size_t i = 0; i < s.count; i++) names[i] = s.channels[i]->name;
    if (!allocate(source, err) || !glint_capture_read(capture, part, names, s.count,
                                                      source->integer ? GLINT_U32 : GLINT_F32, source->texels, 0, err))
        return false;
    if (source->integer) integers_to_float(source);
    return true;
}

/* ---- Other EXR files ---- */

static bool find_exr_part(const struct glint_exr *exr, const char *path, const char *name, size_t *found,
                          struct glint_error *err) {
    size_t count = glint_exr_part_count(exr);
    struct glint_nearest near = glint_nearest_to(name ? name : "");
    *found = 0;
    for (size_t i = 0; i < count; i++) {
        const struct glint_exr_part_info *part = glint_exr_part(exr, i);
        bool color = false;
        for (size_t c = 0; c < part->channel_count && !name; c++) color = color || !strcmp(part->channels[c].name, "R");
        if (name ? !strcmp(part->name, name) : color) {
            *found = i;
            return true;
        }
        glint_nearest_offer(&near, part->name);
    }
    if (!name && count) return true; /* no part has colour: the first one */
    return glint_fail(err, GLINT_ERROR_USAGE, "%s: no part %s%s; glint info lists them", path, name ? name : "at all",
                      glint_nearest_text(&near));
}

static bool read_exr(struct source *source, struct glint_exr *exr, const struct source_choice *choice,
                     struct glint_error *err) {
    size_t index = 0;
    if (!find_exr_part(exr, choice->path, choice->part, &index, err)) return false;
    const struct glint_exr_part_info *part = glint_exr_part(exr, index);
    const struct glint_exr_attribute *unit = glint_exr_attribute(part, "glint.unit");
    char layer[256];
    struct selection s;
    if (choice->layer) snprintf(layer, sizeof layer, "%s", choice->layer);
    else default_layer(layer, part->channels, part->channel_count);
    select_layer(&s, part->channels, part->channel_count, layer);
    if (s.count == 0) return no_layer(choice->path, part->name, part->channels, part->channel_count, layer, err);
    fill_source(source, part->name, layer, part->width, part->height, &s);
    if (unit && unit->type == GLINT_EXR_STRING) snprintf(source->unit, sizeof source->unit, "%s", unit->string);
    source->cube = part->height % (6 * part->width) == 0;
    const char *names[4] = {0};
    for (size_t i = 0; i < s.count; i++) names[i] = s.channels[i]->name;
    if (!allocate(source, err) ||
        !glint_exr_read(exr, index, names, s.count, source->integer ? GLINT_U32 : GLINT_F32, source->texels, 0, err))
        return false;
    if (source->integer) integers_to_float(source);
    const struct glint_exr_attribute *color = glint_exr_attribute(part, "glint.color");
    source->display = color && color->type == GLINT_EXR_STRING && glint_encoding_is_display(color->string);
    if (source->display) glint_decode_display(source->texels, (size_t)source->width * source->height, names, s.count);
    return true;
}

/* A file with a G-buffer is a capture and is decoded. */
static bool read_file(struct source *source, const struct source_choice *choice, struct glint_error *err) {
    struct glint_exr *exr = glint_exr_open(choice->path, NULL, err);
    if (!exr) return false;
    bool captured = false, ok = false;
    for (size_t i = 0; i < glint_exr_part_count(exr) && !captured; i++)
        captured = !strcmp(glint_exr_part(exr, i)->name, "gbuffer");
    if (captured) {
        struct glint_capture *capture = glint_capture_open(choice->path, NULL, err);
        ok = capture && read_capture(source, capture, choice->part, choice->layer, err);
        glint_capture_close(&capture);
    } else ok = read_exr(source, exr, choice, err);
    glint_exr_close(&exr);
    return ok;
}

/* ---- Runs ---- */

static bool run_image_is_color(const struct glint_run_image *image) {
    return !strncmp(image->channels, "R G B", 5);
}

static const struct glint_run_image *find_run_image(const struct glint_run *run, const char *path, const char *name,
                                                    struct glint_error *err) {
    const struct glint_run_image *found = NULL;
    struct glint_nearest near = glint_nearest_to(name ? name : "");
    for (size_t i = 0; i < glint_run_image_count(run); i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        if (name ? !strcmp(image->name, name) : run_image_is_color(image)) found = image;
        glint_nearest_offer(&near, image->name);
    }
    if (!found && !name && glint_run_image_count(run)) found = glint_run_image(run, glint_run_image_count(run) - 1);
    if (!found)
        glint_fail(err, GLINT_ERROR_USAGE, "%s: the run has no image %s%s", path, name ? name : "at all",
                   glint_nearest_text(&near));
    return found;
}

static bool read_run(struct source *source, const struct source_choice *choice, struct glint_error *err) {
    struct glint_run *run = glint_run_open(choice->path, err);
    const struct glint_run_image *image =
        run ? find_run_image(run, choice->path, choice->image ? choice->image : choice->part, err) : NULL;
    bool ok = false;
    if (image && image->components > 4)
        glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: image %s has %u channels, but at most 4 can be shown",
                   choice->path, image->name, image->components);
    else if (image) {
        snprintf(source->title, sizeof source->title, "%s", image->name);
        snprintf(source->unit, sizeof source->unit, "%s", image->unit);
        source->width = image->width;
        source->height = image->height;
        source->components = image->components;
        source->integer = image->integer;
        source->cube = image->cube;
        source->display = glint_encoding_is_display(image->encoding);
        const char *name = image->channels;
        for (uint32_t i = 0; i < source->components; i++) {
            size_t length = strcspn(name, " ");
            snprintf(source->channels[i], sizeof source->channels[i], "%.*s", (int)length, name);
            name += name[length] ? length + 1 : length;
        }
        ok = allocate(source, err) && (image->integer ? glint_run_read(run, image, GLINT_U32, source->texels, err)
                                                      : glint_run_read_linear(run, image, source->texels, err));
        if (ok && image->integer) integers_to_float(source);
    }
    glint_run_close(&run);
    return ok;
}

/* ---- Paths ---- */

char *source_split(const char *text, char **part, char **layer) {
    struct stat info;
    char *path = strdup(text);
    *part = *layer = NULL;
    /* A colon separates only if the text before it is an existing path and the whole text is not. */
    for (char *colon = path ? strchr(path, ':') : NULL; colon && stat(text, &info) != 0;
         colon = strchr(colon + 1, ':')) {
        *colon = '\0';
        if (stat(path, &info) == 0) {
            *layer = strchr(colon + 1, ':');
            if (*layer) *(*layer)++ = '\0';
            if (colon[1]) *part = colon + 1;
            break;
        }
        *colon = ':';
    }
    return path;
}

bool source_open(struct source *source, const struct source_choice *choice, struct glint_error *err) {
    struct source_choice c = *choice;
    struct stat info;
    *source = (struct source){0};
    char *part, *layer, *path = source_split(choice->path, &part, &layer);
    if (!path) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (!c.part) c.part = part;
    if (!c.layer) c.layer = layer;
    c.path = path;
    bool folder = stat(path, &info) == 0 && S_ISDIR(info.st_mode);
    if (!folder && c.image && !c.part) c.part = c.image;
    bool ok = folder ? read_run(source, &c, err) : read_file(source, &c, err);
    if (!ok) source_finish(source);
    free(path);
    return ok;
}
