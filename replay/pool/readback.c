/* Reads images back to host memory. */
#include "pool.h"

#include <stdio.h>
#include <string.h>

#include <Imath/half.h>

#include "shared/work_list.h"
#include "timing.h"

static VkDeviceSize align_offset(VkDeviceSize size) {
    return (size + 15) & ~(VkDeviceSize)15;
}

/* Overwrites the unused words of a list, whose contents are undefined, so that they are the same in every run. */
static void clear_unused_words(const struct pooled *image, uint32_t *words) {
    const uint64_t end = (uint64_t)image->image.desc.width * image->image.desc.height;
    for (uint64_t i = (uint64_t)LIST_ITEMS + words[LIST_RANGES + 1] + words[LIST_RANGES + 3]; i < end; i++)
        words[i] = UINT32_MAX;
}

bool pool_readback(struct pool *pool, const struct image_part *parts, size_t count, struct host_buffer *buffer,
                   VkDeviceSize *offsets, struct glint_error *err) {
    double start = glint_now_seconds();
    VkDeviceSize size = 0;
    for (size_t i = 0; i < count; i++) {
        offsets[i] = size;
        size += align_offset(image_bytes(&parts[i].image->image.desc, parts[i].info->level));
    }
    if (buffer->size < size) {
        host_buffer_finish(buffer, pool->gpu);
        if (!host_buffer_init(buffer, pool->gpu, HOST_BUFFER_READBACK, size, "readback", err)) return false;
    }
    if (!device_begin(pool->gpu, err)) return false;
    for (size_t i = 0; i < count; i++)
        image_record_readback(&parts[i].image->image, pool->gpu, buffer, offsets[i], parts[i].info->level);
    record_host_barrier(pool->gpu);
    char what[192];
    snprintf(what, sizeof what, "reading back %s%s", count ? parts[0].info->name : "nothing",
             count > 1 ? " and others" : "");
    bool ok = device_submit(pool->gpu, what, 1, err);
    for (size_t i = 0; ok && i < count; i++)
        if (parts[i].image->image.desc.buffer)
            clear_unused_words(parts[i].image, (uint32_t *)((char *)buffer->map + offsets[i]));
    pool->source->seconds[PHASE_READBACK] += glint_now_seconds() - start;
    return ok;
}

size_t pool_parts(const struct pool *pool, const struct glint_pass *pass, struct image_part *parts, size_t capacity) {
    size_t count = 0;
    for (size_t r = 0; r < pass->row_count; r++)
        for (struct pooled *image = pool->images; image; image = image->next) {
            const struct glint_image *info;
            for (uint32_t i = 0; (info = pooled_shown(image, i)) && count < capacity; i++)
                if (info->pass == pass && info->row == &pass->rows[r])
                    parts[count++] = (struct image_part){image, info};
        }
    return count;
}

bool pool_read_image(struct pool *pool, const struct glint_image *info, enum glint_type type, void *out,
                     struct glint_error *err) {
    struct pooled *image = pool->images;
    for (uint32_t i = 0; image && pooled_shown(image, i) != info;)
        if (!pooled_shown(image, i++)) image = image->next, i = 0;
    if (!image) return glint_fail(err, GLINT_ERROR_USAGE, "the image does not belong to the last run");
    const size_t value_bytes = format_bytes(image->image.desc.format) / info->components;
    const bool uint = glint_format_is_uint(image->image.desc.format);
    const bool same =
        uint ? type == (value_bytes == 1 ? GLINT_U8 : GLINT_U32) : type == (value_bytes == 2 ? GLINT_F16 : GLINT_F32);
    if (!same && type != (uint ? GLINT_U32 : GLINT_F32))
        return glint_fail(err, GLINT_ERROR_USAGE, "image %s is %s: it can be read as its own type or as %s", info->name,
                          format_name(image->image.desc.format), uint ? "uint" : "float");
    struct host_buffer *buffer = &pool->readback; /* kept, as new memory is slow to get */
    VkDeviceSize offset;
    bool ok = pool_readback(pool, &(struct image_part){image, info}, 1, buffer, &offset, err);
    const size_t count = (size_t)info->width * info->height * info->components;
    if (ok && same) memcpy(out, buffer->map, count * value_bytes);
    else if (ok && uint)
        for (size_t i = 0; i < count; i++) ((uint32_t *)out)[i] = ((const uint8_t *)buffer->map)[i];
    else if (ok)
        for (size_t i = 0; i < count; i++) ((float *)out)[i] = imath_half_to_float(((const uint16_t *)buffer->map)[i]);
    enum { KEPT_BYTES = 64 << 20 };
    if (buffer->size > KEPT_BYTES) host_buffer_finish(buffer, pool->gpu);
    return ok;
}
