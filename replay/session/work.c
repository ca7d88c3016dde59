/* Counts work that only images show: rays by their end reasons. */
#include "session.h"

#include <string.h>

static const char *end_reasons_of(const struct glint_pass *pass) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_DIAGNOSTIC && strcmp(pass->rows[r].unit, "end reason") == 0)
            return pass->rows[r].name;
    return NULL;
}

/* Adds the number of rays in an image of end reasons of the last run to `work`, unless the image is no longer available. */
static bool count_rays(struct glint_replay *replay, const char *name, json_t *work, struct glint_error *err) {
    struct host_buffer buffer = {0};
    VkDeviceSize offset;
    struct pooled *image = replay->pool.images;
    while (image && !(image->used && strcmp(image->image.name, name) == 0)) image = image->next;
    if (!image) return true;
    if (!pool_readback(&replay->pool, &(struct image_part){image, &image->levels[0].info}, 1, &buffer, &offset, err))
        return false;
    const size_t texels = (size_t)image->image.desc.width * image->image.desc.height;
    json_int_t rays = 0;
    for (size_t i = 0; i < texels; i++) rays += ((const uint8_t *)buffer.map)[i] != 0;
    host_buffer_finish(&buffer, replay->pool.gpu);
    return json_object_set_new(work, "rays", json_integer(rays)) == 0 ||
           glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

bool replay_count_work(struct glint_replay *replay, json_t *root, struct glint_error *err) {
    for (size_t p = 0; json_is_true(json_object_get(root, "diagnostics")) && p < replay->results.count; p++) {
        json_t *work = json_object_get(json_array_get(json_object_get(root, "passes"), p), "work");
        const char *reasons = end_reasons_of(replay->results.passes[p].pass);
        if (reasons && replay->results.passes[p].ran && !count_rays(replay, reasons, work, err)) return false;
    }
    return true;
}
