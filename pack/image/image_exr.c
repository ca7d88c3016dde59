/* OpenEXR files: each channel becomes a plane in its own type. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "glint/exr.h"
#include "nearest.h"
#include "readers.h"

static bool find_part(struct glint_exr *exr, const struct node *texture, size_t *found, struct glint_error *err) {
    const char *wanted = node_text(texture, "part");
    const struct node node = node_child(texture, "part");
    struct glint_nearest near = glint_nearest_to(wanted ? wanted : "");
    for (*found = 0; *found < glint_exr_part_count(exr); ++*found) {
        const char *name = glint_exr_part(exr, *found)->name;
        if (!wanted || !strcmp(name, wanted)) return true;
        glint_nearest_offer(&near, name);
    }
    return node_fail(&node, err, GLINT_ERROR_FORMAT, "the file has no part \"%.80s\"%s", wanted ? wanted : "",
                     glint_nearest_text(&near));
}

static bool read_channel(struct image *image, const struct node *texture, struct glint_exr *exr, size_t part, size_t i,
                         size_t *at, struct glint_error *err) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *info = glint_exr_part(exr, part);
    const struct glint_channel_info *channel = &info->channels[i];
    struct source *source = &image->sources[image->count];
    const unsigned bytes = channel->stored == GLINT_STORED_HALF ? 2 : 4;
    const char *name = channel->name;
    *source =
        (struct source){.component = {.bits = (uint8_t)(8 * bytes),
                                      .kind = channel->stored == GLINT_STORED_UINT ? COMPONENT_UINT : COMPONENT_FLOAT},
                        .first = *at,
                        .x_step = bytes,
                        .row_pitch = (size_t)info->width * bytes,
                        .layer_pitch = (size_t)info->width * info->height * bytes,
                        .name = strdup(name)};
    if (!source->name) return node_no_memory(texture, err);
    image->count++;
    /* one letter, as in other files: R, G, B, A, and Y or Z for what stands alone */
    if (strchr("RGBA", name[0]) && !name[1]) source->component.letter = (char)(name[0] - 'A' + 'a');
    if (!glint_exr_read(exr, part, &name, 1, types[channel->stored], image->bytes.data + *at, 0, err))
        return node_wrap(texture, err);
    *at += (size_t)info->width * info->height * bytes;
    return true;
}

static bool read_part(struct image *image, const struct node *texture, struct glint_exr *exr, size_t part,
                      struct glint_error *err) {
    const struct glint_exr_part_info *info = glint_exr_part(exr, part);
    const uint64_t texels = (uint64_t)info->width * info->height;
    uint64_t bytes = 0;
    for (size_t i = 0; i < info->channel_count; i++)
        bytes += texels * (info->channels[i].stored == GLINT_STORED_HALF ? 2 : 4);
    if (!info->channel_count || !bytes || bytes > IMAGE_MAX_BYTES || info->width > IMAGE_MAX_WIDTH ||
        info->height > IMAGE_MAX_HEIGHT)
        return node_fail(texture, err, GLINT_ERROR_LIMIT,
                         "expected channels and at most 4 GiB of pixels, found %zu of %u x %u", info->channel_count,
                         info->width, info->height);
    image->width = info->width;
    image->height = info->height;
    image->layers = 1;
    snprintf(image->format, sizeof image->format, "OpenEXR");
    image->sources = calloc(info->channel_count, sizeof *image->sources);
    image->bytes = (struct bytes){.data = malloc((size_t)bytes), .size = (size_t)bytes};
    if (!image->sources || !image->bytes.data) return node_no_memory(texture, err);
    size_t at = 0;
    for (size_t i = 0; i < info->channel_count; i++)
        if (!read_channel(image, texture, exr, part, i, &at, err)) return false;
    return true;
}

bool image_read_exr(struct image *image, const struct node *texture, const char *path, struct glint_error *err) {
    struct stat about;
    size_t part = 0;
    if (!stat(path, &about) && !S_ISREG(about.st_mode))
        return node_fail(texture, err, GLINT_ERROR_IO, "%s: expected a file, found none", path);
    struct glint_exr *exr = glint_exr_open(path, NULL, err);
    if (!exr) return node_wrap(texture, err);
    const bool ok = find_part(exr, texture, &part, err) && read_part(image, texture, exr, part, err);
    glint_exr_close(&exr);
    return ok;
}
