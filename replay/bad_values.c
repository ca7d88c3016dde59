/* Values that no image should hold. */
#include "bad_values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <Imath/half.h>

#include "readback.h"

float half_clamped(float value) {
    return isfinite(value) && fabsf(value) > HALF_LARGEST ? copysignf(HALF_LARGEST, value) : value;
}

/* +inf says how far the sky is. */
static bool may_be_infinite(const struct glint_row *row) {
    return row->unit[0] && row->unit[strlen(row->unit) - 1] == 'm';
}

static void found_at(struct bad_values *found, size_t index, float value) {
    if (found->not_finite + found->clamped > 1 && index > found->first) return;
    found->first = index;
    found->value = value;
}

void bad_value(struct bad_values *found, const struct glint_row *row, bool half, size_t index, float value) {
    const bool infinite = isinf(value) != 0, beyond = half && !infinite && fabsf(value) > HALF_LARGEST;
    if (!isnan(value) && !beyond && (!infinite || may_be_infinite(row))) return;
    *(beyond ? &found->clamped : &found->not_finite) += 1;
    found_at(found, index, value);
}

void bad_values_add(struct bad_values *found, const struct bad_values *more) {
    if (!more->not_finite && !more->clamped) return;
    const bool none = !found->not_finite && !found->clamped;
    found->not_finite += more->not_finite;
    found->clamped += more->clamped;
    if (none || more->first < found->first) found->first = more->first, found->value = more->value;
}

/* What the device stored as half's largest was that or more. */
static struct bad_values of_halves(const struct glint_row *row, const uint16_t *texels, size_t count) {
    struct bad_values found = {0};
    for (size_t i = 0; i < count; i++) {
        const uint16_t magnitude = texels[i] & 0x7FFF;
        if (magnitude < 0x7BFF) continue;
        if (magnitude == 0x7BFF) found.clamped++, found_at(&found, i, imath_half_to_float(texels[i]));
        else bad_value(&found, row, true, i, imath_half_to_float(texels[i]));
    }
    return found;
}

static struct bad_values of_floats(const struct glint_row *row, const float *texels, size_t count) {
    struct bad_values found = {0};
    for (size_t i = 0; i < count; i++)
        if (!isfinite(texels[i])) bad_value(&found, row, false, i, texels[i]);
    return found;
}

/* The capture's were counted when they were uploaded, whatever they are shown as. */
static bool is_captured(const struct image_part *part) {
    return part->info == &part->image->as;
}

void bad_values_of_texels(const struct image_part *part, const void *texels) {
    const struct glint_image *info = part->info;
    if (is_captured(part)) return;
    const size_t count = (size_t)info->width * info->height * info->components;
    struct bad_values found = {0};
    if (format_bytes(info->format) / info->components == 2) found = of_halves(info->row, texels, count);
    else if (!format_is_uint(info->format)) found = of_floats(info->row, texels, count);
    part->image->levels[info->level].bad = found;
    part->image->levels[info->level].bad_key = part->image->key;
}

/* ---- The list ---- */

/* The word of a row's channels, such as "X Y Z roughness". */
static void name_channel(const struct glint_row *row, size_t component, char *name, size_t size) {
    const char *word = row->channels ? row->channels : row->source;
    for (; component > 0 && strchr(word, ' '); component--) word = strchr(word, ' ') + 1;
    snprintf(name, size, "%.*s", (int)strcspn(word, " "), word);
}

static bool append(struct glint_replay *replay, const struct image_part *part, struct glint_error *err) {
    const struct glint_image *info = part->info;
    const struct bad_values *bad = &part->image->levels[info->level].bad;
    if (!bad->not_finite && !bad->clamped) return true;
    struct glint_bad_values *list = realloc(replay->bad, (replay->bad_count + 1) * sizeof *list);
    if (!list) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    replay->bad = list;
    list += replay->bad_count++;
    const size_t texel = bad->first / info->components;
    *list = (struct glint_bad_values){.image = info->pass ? info->name : info->row->name,
                                      .pass = info->pass,
                                      .x = (uint32_t)(texel % info->width),
                                      .y = (uint32_t)(texel / info->width),
                                      .value = bad->value,
                                      .not_finite = bad->not_finite,
                                      .clamped = bad->clamped};
    name_channel(info->row, bad->first % info->components, list->channel, sizeof list->channel);
    return true;
}

bool bad_values_of_capture(struct run *run, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    bool ok = true;
    for (size_t i = 0; ok && i < run->graph.image_count; i++)
        if (run->graph.images[i].source == SOURCE_CAPTURE && run->needed[i] && run->images[i])
            ok = append(replay, &(struct image_part){run->images[i], &run->images[i]->levels[0].info}, err);
    replay->bad_captured = replay->bad_count;
    return ok;
}

bool glint_replay_bad_values(struct glint_replay *replay, const struct glint_bad_values **list, size_t *count,
                             struct glint_error *err) {
    struct host_buffer buffer = {0};
    bool ok = true;
    replay->bad_count = replay->bad_captured;
    for (size_t p = 0; ok && p < replay->result_count; p++) {
        struct image_part parts[PASS_PARTS_MAX];
        const size_t images = parts_of_pass(replay, replay->results[p].pass, parts, PASS_PARTS_MAX);
        for (size_t i = 0; ok && i < images; i++) {
            VkDeviceSize offset;
            const struct image *image = parts[i].image;
            const bool counted = image->key && image->levels[parts[i].info->level].bad_key == image->key;
            if (!counted && !is_captured(&parts[i])) {
                ok = readback_images(replay, &parts[i], 1, &buffer, &offset, err);
                if (ok) bad_values_of_texels(&parts[i], (const char *)buffer.map + offset);
            }
            ok = ok && append(replay, &parts[i], err);
        }
    }
    if (replay->device) host_buffer_finish(&buffer, replay->device);
    *list = replay->bad;
    *count = ok ? replay->bad_count : 0;
    return ok;
}

/* JSON has no number for NaN and infinity. */
static json_t *json_value(float value) {
    return isfinite(value) ? json_real((double)value) : json_string(isnan(value) ? "NaN" : value > 0 ? "inf" : "-inf");
}

json_t *bad_values_record(const struct glint_bad_values *list, size_t count) {
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) {
        const struct glint_bad_values *bad = &list[i];
        json_array_append_new(array,
                              json_pack("{ss ss? ss si si so sI sI}", "image", bad->image, "slot",
                                        bad->pass ? bad->pass->slot : NULL, "channel", bad->channel, "x", (int)bad->x,
                                        "y", (int)bad->y, "value", json_value(bad->value), "not_finite",
                                        (json_int_t)bad->not_finite, "clamped", (json_int_t)bad->clamped));
    }
    return array;
}
