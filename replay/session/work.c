/* Counts work that only images show: items of lists, and rays by their end reasons. */
#include "session.h"

#include <string.h>

/* The number of items of a list, without padding. */
static uint64_t count_items(const uint32_t *words, uint32_t width, uint64_t count) {
    uint64_t items = 0;
    for (uint64_t i = 0; i < words[3] && width + i < count; i++) items += words[width + i] != UINT32_MAX;
    return items;
}

static uint64_t count_rays(const uint8_t *reasons, uint64_t count) {
    uint64_t rays = 0;
    for (uint64_t i = 0; i < count; i++) rays += reasons[i] != 0;
    return rays;
}

/* The number of items or rays in an image of the last run; false if the image is no longer available. */
static bool count_image(struct glint_replay *replay, const char *name, uint64_t *found, struct glint_error *err) {
    struct host_buffer buffer = {0};
    VkDeviceSize offset;
    struct pooled *image = replay->pool.images;
    while (image && !(image->used && strcmp(image->image.name, name) == 0)) image = image->next;
    if (!image ||
        !pool_readback(&replay->pool, &(struct image_part){image, &image->levels[0].info}, 1, &buffer, &offset, err))
        return false;
    const uint64_t texels = (uint64_t)image->image.desc.width * image->image.desc.height;
    *found = image->image.desc.buffer ? count_items(buffer.map, image->image.desc.width, texels)
                                      : count_rays(buffer.map, texels);
    host_buffer_finish(&buffer, replay->pool.gpu);
    return true;
}

static const char *end_reasons_of(const struct glint_pass *pass) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_DIAGNOSTIC && strcmp(pass->rows[r].unit, "end reason") == 0)
            return pass->rows[r].name;
    return NULL;
}

bool replay_count_work(struct glint_replay *replay, json_t *root, struct glint_error *err) {
    const bool diagnostics = json_is_true(json_object_get(root, "diagnostics"));
    for (size_t p = 0; p < replay->results.count; p++) {
        json_t *work = json_object_get(json_array_get(json_object_get(root, "passes"), p), "work"), *items;
        json_t *lists = json_object_get(work, "lists");
        json_int_t texels = json_integer_value(json_object_get(work, "texels"));
        const char *name, *reasons = end_reasons_of(replay->results.passes[p].pass);
        uint64_t found;
        struct glint_error own = {0};
        json_object_foreach(lists, name, items) {
            if (count_image(replay, name, &found, &own))
                json_object_set_new(lists, name, json_integer((json_int_t)found));
            if (own.code == GLINT_OK) texels += (json_int_t)found;
        }
        if (work && lists) json_object_set_new(work, "texels", json_integer(texels));
        if (diagnostics && reasons && replay->results.passes[p].ran && count_image(replay, reasons, &found, &own))
            json_object_set_new(work, "rays", json_integer((json_int_t)found));
        if (own.code != GLINT_OK) return glint_fail(err, own.code, "%s", own.message);
    }
    return true;
}
