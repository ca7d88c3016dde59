/* Loads an EXR file into memory to change and rewrite it. */
#include "rewrite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

/* Reads all channels of one stored type at once: each call decodes the whole part. */
static void read_channels(struct rewrite *r, size_t part, struct rewrite_part *to, enum glint_stored stored) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const char *names[REWRITE_CHANNELS];
    size_t count = 0, at[REWRITE_CHANNELS];
    struct glint_error err = {0};
    for (size_t c = 0; c < to->part.channel_count; c++)
        if (to->channels[c].stored == stored) at[count] = c, names[count++] = to->channels[c].name;
    const size_t bytes = types[stored] == GLINT_F16 ? 2 : 4, pixels = (size_t)to->part.width * to->part.height;
    char *all = malloc(pixels * count * bytes + 1);
    assert_non_null(all);
    if (count && !glint_exr_read(r->exr, part, names, count, types[stored], all, 0, &err)) fail_msg("%s", err.message);
    for (size_t i = 0; i < count; i++)
        for (size_t p = 0; p < pixels; p++)
            memcpy((char *)to->data[at[i]] + p * bytes, all + (p * count + i) * bytes, bytes);
    free(all);
}

void rewrite_load(struct rewrite *r, const char *path) {
    struct glint_error err = {0};
    memset(r, 0, sizeof *r);
    r->exr = glint_exr_open(path, NULL, &err);
    if (!r->exr) fail_msg("%s", err.message);
    for (; r->count < glint_exr_part_count(r->exr); r->count++) {
        const struct glint_exr_part_info *from = glint_exr_part(r->exr, r->count);
        struct rewrite_part *to = &r->parts[r->count];
        assert_true(r->count < REWRITE_PARTS && from->attribute_count < REWRITE_ATTRIBUTES - 2);
        assert_true(from->channel_count <= REWRITE_CHANNELS);
        snprintf(to->name, sizeof to->name, "%s", from->name);
        memcpy(to->attributes, from->attributes, from->attribute_count * sizeof *from->attributes);
        to->part = (struct glint_exr_part){.name = to->name,
                                           .width = from->width,
                                           .height = from->height,
                                           .channels = to->channels,
                                           .channel_count = from->channel_count,
                                           .attributes = to->attributes,
                                           .attribute_count = from->attribute_count,
                                           .compression = GLINT_NONE};
        for (size_t c = 0; c < from->channel_count; c++) {
            to->data[c] = malloc((size_t)from->width * from->height * 4);
            assert_non_null(to->data[c]);
            to->channels[c] = (struct glint_exr_channel){
                .name = from->channels[c].name, .stored = from->channels[c].stored, .data = to->data[c]};
        }
        for (int stored = GLINT_STORED_HALF; stored <= GLINT_STORED_UINT; stored++)
            read_channels(r, r->count, to, (enum glint_stored)stored);
    }
}

void rewrite_save(const struct rewrite *r, const char *path) {
    struct glint_error err = {0};
    struct glint_exr_part parts[REWRITE_PARTS];
    for (size_t i = 0; i < r->count; i++) {
        parts[i] = r->parts[i].part;
        parts[i].name = r->parts[i].name;
        parts[i].channels = r->parts[i].channels;
        parts[i].attributes = r->parts[i].attributes;
    }
    if (!glint_exr_write(path, parts, r->count, 0, &err)) fail_msg("%s", err.message);
}

void rewrite_finish(struct rewrite *r) {
    for (size_t i = 0; i < REWRITE_PARTS; i++)
        for (size_t c = 0; c < REWRITE_CHANNELS; c++) free(r->parts[i].data[c]);
    glint_exr_close(&r->exr);
    memset(r, 0, sizeof *r);
}

struct rewrite_part *rewrite_find(struct rewrite *r, const char *part) {
    for (size_t i = 0; i < r->count; i++)
        if (!strcmp(r->parts[i].name, part)) return &r->parts[i];
    fail_msg("no part %s", part);
    return NULL;
}

struct glint_exr_attribute *rewrite_attribute(struct rewrite *r, const char *part, const char *name) {
    struct rewrite_part *p = rewrite_find(r, part);
    for (size_t i = 0; i < p->part.attribute_count; i++)
        if (!strcmp(p->attributes[i].name, name)) return &p->attributes[i];
    fail_msg("no attribute %s on %s", name, part);
    return NULL;
}

void rewrite_remove_attribute(struct rewrite *r, const char *part, const char *name) {
    struct rewrite_part *p = rewrite_find(r, part);
    struct glint_exr_attribute *a = rewrite_attribute(r, part, name);
    *a = p->attributes[--p->part.attribute_count];
}

static size_t channel_at(struct rewrite_part *p, const char *name) {
    for (size_t c = 0; c < p->part.channel_count; c++)
        if (!strcmp(p->channels[c].name, name)) return c;
    fail_msg("no channel %s on %s", name, p->name);
    return 0;
}

void rewrite_remove_channel(struct rewrite *r, const char *part, const char *name) {
    struct rewrite_part *p = rewrite_find(r, part);
    const size_t c = channel_at(p, name), last = --p->part.channel_count;
    free(p->data[c]);
    p->data[c] = p->data[last];
    p->channels[c] = p->channels[last];
    p->data[last] = NULL;
}

void rewrite_remove_part(struct rewrite *r, const char *part) {
    struct rewrite_part *p = rewrite_find(r, part);
    for (size_t c = 0; c < REWRITE_CHANNELS; c++) free(p->data[c]);
    *p = r->parts[--r->count];
    memset(&r->parts[r->count], 0, sizeof r->parts[0]);
}

void *rewrite_pixels(struct rewrite *r, const char *part, const char *channel) {
    struct rewrite_part *p = rewrite_find(r, part);
    return p->data[channel_at(p, channel)];
}
