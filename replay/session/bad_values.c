/* Lists images with invalid values. */
#include "session.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "record.h"

/* An alias shows an image of the capture, whose invalid values were counted when it was uploaded. */
static bool is_captured(const struct image_part *part) {
    return part->info == &part->image->alias;
}

void bad_values_of_texels(const struct image_part *part, const void *texels) {
    const struct glint_image *info = part->info;
    if (is_captured(part)) return;
    const size_t count = (size_t)info->width * info->height * info->components;
    struct bad_values found = {0};
    if (format_bytes(info->format) / info->components == 2) found = bad_halves(info->row, texels, count);
    else if (!glint_format_is_uint(info->format)) found = bad_floats(info->row, texels, count);
    part->image->levels[info->level].bad = found;
    part->image->levels[info->level].bad_key = part->image->key;
}

/* ---- The list ---- */

static bool append_bad(struct glint_replay *replay, const struct image_part *part, struct glint_error *err) {
    const struct glint_image *info = part->info;
    const struct bad_values *bad = &part->image->levels[info->level].bad;
    if (!bad->not_finite && !bad->clamped) return true;
    struct glint_bad_values *list = realloc(replay->results.bad, (replay->results.bad_count + 1) * sizeof *list);
    if (!list) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    replay->results.bad = list;
    list += replay->results.bad_count++;
    const size_t texel = bad->first / info->components;
    *list = (struct glint_bad_values){.image = info->pass ? info->name : info->row->name,
                                      .pass = info->pass,
                                      .x = (uint32_t)(texel % info->width),
                                      .y = (uint32_t)(texel / info->width),
                                      .value = bad->value,
                                      .not_finite = bad->not_finite,
                                      .clamped = bad->clamped};
    struct channel_names names;
    channel_names(&names, info->row->channels ? info->row->channels : info->row->source);
    snprintf(list->channel, sizeof list->channel, "%.47s", names.list[bad->first % info->components]);
    return true;
}

bool bad_values_of_capture(struct glint_replay *replay, const struct run *run, struct glint_error *err) {
    bool ok = true;
    for (size_t i = 0; ok && i < run->graph->image_count; i++)
        if (run->graph->images[i].source == SOURCE_CAPTURE && run->needed[i] && run->images[i])
            ok = append_bad(replay, &(struct image_part){run->images[i], &run->images[i]->levels[0].info}, err);
    replay->results.bad_captured = replay->results.bad_count;
    return ok;
}

bool glint_replay_bad_values(struct glint_replay *replay, const struct glint_bad_values **list, size_t *count,
                             struct glint_error *err) {
    struct host_buffer buffer = {0};
    struct glint_error own = {0};
    bool ok = true;
    replay->results.bad_count = replay->results.bad_captured;
    for (size_t p = 0; ok && p < replay->results.count; p++) {
        struct image_part parts[PASS_PARTS_MAX];
        const size_t images = pool_parts(&replay->pool, replay->results.passes[p].pass, parts, PASS_PARTS_MAX);
        for (size_t i = 0; ok && i < images; i++) {
            VkDeviceSize offset;
            const struct pooled *image = parts[i].image;
            const bool counted = image->key && image->levels[parts[i].info->level].bad_key == image->key;
            if (!counted && !is_captured(&parts[i])) {
                ok = pool_readback(&replay->pool, &parts[i], 1, &buffer, &offset, &own);
                if (ok) bad_values_of_texels(&parts[i], (const char *)buffer.map + offset);
            }
            ok = ok && append_bad(replay, &parts[i], &own);
        }
    }
    if (replay->device) host_buffer_finish(&buffer, replay->pool.gpu);
    *list = replay->results.bad;
    *count = ok ? replay->results.bad_count : 0;
    return ok || session_fail(replay, &own, err);
}

/* JSON has no numbers for NaN and infinity, which become strings. */
static json_t *json_value(float value) {
    return isfinite(value) ? json_real((double)value) : json_string(isnan(value) ? "NaN" : value > 0 ? "inf" : "-inf");
}

json_t *bad_values_record(const struct glint_bad_values *list, size_t count) {
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) {
        const struct glint_bad_values *bad = &list[i];
        record_append(&array, json_pack("{ss ss? ss si si so sI sI}", "image", bad->image, "slot",
                                        bad->pass ? bad->pass->slot : NULL, "channel", bad->channel, "x", (int)bad->x,
                                        "y", (int)bad->y, "value", json_value(bad->value), "not_finite",
                                        (json_int_t)bad->not_finite, "clamped", (json_int_t)bad->clamped));
    }
    return array;
}
