/* A part that the capture does not have. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edit_internal.h"

static bool fail_memory(const struct glint_edit *edit, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", edit->exr->path);
}

/* Parts of known roles carry the version of the others. */
static bool add_version(struct glint_edit *edit, size_t i, struct glint_error *err) {
    const size_t first = glint_edit_find(edit, "gbuffer");
    const struct glint_exr_attribute *version =
        first < i ? glint_exr_attribute(&edit->parts[first].info, "glint.version") : NULL;
    return !version || glint_edit_set(edit, i, version, err);
}

bool glint_edit_add_part(struct glint_edit *edit, const char *name, uint32_t width, uint32_t height,
                         const char *const *channels, size_t count, const float *values, struct glint_error *err) {
    const size_t i = edit->count, texels = (size_t)width * height;
    if (glint_edit_find(edit, name) < i)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: there already", edit->exr->path, name);
    struct glint_edit_part *parts = realloc(edit->parts, (i + 2) * sizeof *parts);
    if (!parts) return fail_memory(edit, err);
    edit->parts = parts;
    struct glint_edit_part *part = &parts[i];
    struct glint_edit_block *block = glint_edit_block(edit, texels * count * sizeof *values, (uint32_t)count);
    *part = (struct glint_edit_part){.full_width = width, .step = 1};
    part->channels = glint_arena_take(&edit->arena, (count + 1) * sizeof *part->channels);
    part->listed = glint_arena_take(&edit->arena, (count + 1) * sizeof *part->listed);
    part->info.name = glint_arena_string(&edit->arena, name);
    if (!block || !part->channels || !part->listed || !part->info.name) return fail_memory(edit, err);
    memcpy(block->data, values, texels * count * sizeof *values);
    for (uint32_t c = 0; c < count; c++) {
        struct glint_edit_channel *channel = &part->channels[c];
        *channel = (struct glint_edit_channel){.block = block, .place = c};
        snprintf(channel->info.name, sizeof channel->info.name, "%s", channels[c]);
        channel->info.stored = GLINT_STORED_FLOAT;
        part->listed[c] = channel->info;
    }
    part->info.width = width;
    part->info.height = height;
    part->info.channels = part->listed;
    part->info.channel_count = count;
    edit->count++;
    return add_version(edit, i, err);
}
