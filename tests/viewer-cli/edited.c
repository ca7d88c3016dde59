/* Captures for the tests of set, crop and strip, and comparisons of files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka needs these before its own header */
#include <cmocka.h>

#include "../capture-format/fixture.h"
#include "../capture-format/rewrite.h"
#include "edited.h"

/* The fixture with an unknown part, an attribute of an editor's, and engine parts of half and of another size. */
void edited_write(const char *made) {
    static const uint32_t sizes[4][2] = {{FIX_W, FIX_H}, {FIX_W / 2, FIX_H / 2}, {FIX_CUBE, 6 * FIX_CUBE}, {7, 5}};
    static const char *const names[] = {"editor.overlay", "engine.a.half", "engine.a.cube", "engine.a.list"};
    static const struct glint_exr_attribute note = {
        .name = "editor.note", .type = GLINT_EXR_STRING, .string = "as found"};
    static struct fixture f;
    static struct rewrite r;
    struct glint_error err = {0};
    fixture_init(&f);
    if (!fixture_write(&f, made, FIXTURE_PARTS, NULL, &err)) fail_msg("%s", err.message);
    rewrite_load(&r, made);
    for (int i = 0; i < 4; i++) {
        struct rewrite_part *to = &r.parts[r.count++];
        *to = *rewrite_find(&r, "engine.screen_trace.anything");
        snprintf(to->name, sizeof to->name, "%s", names[i]);
        to->part.width = sizes[i][0], to->part.height = sizes[i][1];
        to->attributes[to->part.attribute_count++] = note;
        for (size_t c = 0; c < to->part.channel_count; c++) {
            const size_t bytes = (size_t)FIX_W * FIX_H * 4;
            void *copy = malloc(bytes);
            assert_non_null(copy);
            memcpy(copy, to->data[c], bytes);
            to->channels[c].data = to->data[c] = copy;
        }
    }
    unlink(made);
    rewrite_save(&r, made);
    rewrite_finish(&r);
}

struct glint_exr *edited_open(const char *path) {
    struct glint_error err = {0};
    struct glint_exr *exr = glint_exr_open(path, NULL, &err);
    if (!exr) fail_msg("%s", err.message);
    return exr;
}

size_t edited_part(const struct glint_exr *exr, const char *name) {
    size_t i = 0;
    while (glint_exr_part(exr, i) && strcmp(glint_exr_part(exr, i)->name, name) != 0) i++;
    return i;
}

static void *stored(struct glint_exr *exr, size_t part, const char *channel, enum glint_stored as) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *info = glint_exr_part(exr, part);
    struct glint_error err = {0};
    void *data = malloc((size_t)info->width * info->height * 4 + 1);
    assert_non_null(data);
    if (!glint_exr_read(exr, part, &channel, 1, types[as], data, 0, &err)) fail_msg("%s", err.message);
    return data;
}

static bool same_attribute(const struct glint_exr_attribute *a, const struct glint_exr_attribute *b) {
    if (!b || a->type != b->type || strcmp(a->type_name, b->type_name) != 0 || a->count != b->count) return false;
    if (a->type == GLINT_EXR_STRING) return !strcmp(a->string, b->string);
    for (size_t i = 0; a->type == GLINT_EXR_STRINGS && i < a->count; i++)
        if (strcmp(a->strings[i], b->strings[i]) != 0) return false;
    if (a->type == GLINT_EXR_OPAQUE) return !memcmp(a->bytes, b->bytes, a->count);
    return a->type == GLINT_EXR_STRINGS || !memcmp(a->numbers, b->numbers, a->count * sizeof *a->numbers);
}

/* The standard attributes of OpenEXR follow from the camera (standard_camera checks that they do). */
static bool may_differ(const char *name, const char *but) {
    if (!but) return false;
    const bool follows = !strcmp(name, "worldToCamera") || !strcmp(name, "worldToNDC");
    return strstr(but, name) ||
           (follows && (strstr(but, "worldToView") || strstr(but, "viewToClip") || strstr(but, "clipY")));
}

size_t edited_expect_same(const char *original, const char *copy, uint32_t x0, uint32_t y0, const char *but) {
    return edited_expect_grid(original, copy, (struct edited_grid){x0, y0, 1}, but);
}

size_t edited_expect_grid(const char *original, const char *copy, struct edited_grid grid, const char *but) {
    struct glint_exr *a = edited_open(original), *b = edited_open(copy);
    size_t compared = 0;
    for (size_t p = 0; glint_exr_part(b, p); p++) {
        const struct glint_exr_part_info *to = glint_exr_part(b, p);
        const size_t from_part = edited_part(a, to->name);
        const struct glint_exr_part_info *from = glint_exr_part(a, from_part);
        assert_non_null(from);
        const bool moved = from->width != to->width || from->height != to->height;
        const uint32_t ratio = from->width < FIX_W && from->width > FIX_CUBE ? 2 : 1; /* the engine's half resolution */
        for (size_t i = 0; i < to->attribute_count; i++)
            if (!may_differ(to->attributes[i].name, but))
                if (!same_attribute(&to->attributes[i], glint_exr_attribute(from, to->attributes[i].name)))
                    fail_msg("%s: %s differs", to->name, to->attributes[i].name);
        for (size_t c = 0; c < to->channel_count; c++) {
            const char *name = to->channels[c].name;
            if (but && strstr(but, name)) continue;
            const enum glint_stored as = to->channels[c].stored;
            uint8_t *left = stored(a, from_part, name, as), *right = stored(b, p, name, as);
            const size_t bytes = as == GLINT_STORED_HALF ? 2 : 4;
            const size_t step = moved ? grid.step : 1, middle = (step - 1) / 2;
            const size_t dx = moved ? grid.x0 / ratio + middle : 0, dy = moved ? grid.y0 / ratio + middle : 0;
            for (size_t y = 0; y < to->height; y++)
                for (size_t x = 0; x < to->width; x++)
                    if (memcmp(left + ((y * step + dy) * from->width + x * step + dx) * bytes,
                               right + (y * to->width + x) * bytes, bytes))
                        fail_msg("%s: %s differs in line %zu", to->name, name, y);
            free(left);
            free(right);
            compared++;
        }
    }
    glint_exr_close(&a);
    glint_exr_close(&b);
    return compared;
}

bool edited_has(const char *path, const char *part, const char *channel) {
    struct glint_exr *exr = edited_open(path);
    const struct glint_exr_part_info *info = glint_exr_part(exr, edited_part(exr, part));
    bool found = info && !channel;
    for (size_t c = 0; info && channel && c < info->channel_count; c++)
        found |= !strcmp(info->channels[c].name, channel);
    glint_exr_close(&exr);
    return found;
}
