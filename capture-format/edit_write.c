/* Writes the copy of an edited capture. Parts whose pixels do not change are copied as they are compressed. */
#include <stdlib.h>
#include <string.h>

#include "edit_internal.h"
#include "sibling.h"

/* The input's identity counts, since links and other spellings of its path lead to the same bytes. */
static bool check_target(const struct glint_edit *edit, const char *path, struct glint_error *err) {
    struct glint_file_info target, file;
    if (!glint_path_describe(path, &target)) return true;
    if (glint_file_describe(edit->exr->stream.file, &file) && glint_file_same(&target, &file))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: is the input %s itself; expected another file for the copy",
                          path, edit->exr->path);
    for (size_t i = 0; i < edit->exr->part_count; i++) {
        const struct glint_exr_attribute *a = glint_exr_attribute(&edit->exr->parts[i].info, GLINT_SIBLING_ATTRIBUTE);
        char *sibling = a && a->type == GLINT_EXR_STRING ? glint_sibling_path(edit->exr->path, a->string) : NULL;
        const bool same = sibling && glint_path_describe(sibling, &file) && glint_file_same(&target, &file);
        free(sibling);
        if (same)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: holds cube maps of the input; expected another file", path);
    }
    return true;
}

static bool in_same_folder(const struct glint_edit *edit, const char *path) {
    struct glint_file_info from, to;
    char *folders[2] = {glint_sibling_path(edit->exr->path, "."), glint_sibling_path(path, ".")};
    const bool same = folders[0] && folders[1] && glint_path_describe(folders[0], &from) &&
                      glint_path_describe(folders[1], &to) && glint_file_same(&from, &to);
    free(folders[0]);
    free(folders[1]);
    return same;
}

static bool resolve_all(struct glint_edit *edit, struct glint_error *err) {
    size_t taken = 0;
    for (size_t i = 0; i < edit->count; i++) {
        const bool placeholder = glint_edit_string(&edit->parts[i], GLINT_SIBLING_ATTRIBUTE) != NULL;
        if (placeholder && !glint_edit_resolve(edit, &edit->parts[i], err)) return false;
        taken += placeholder;
    }
    if (taken)
        glint_edit_say(edit, "%zu cube map%s of another file are in the copy itself", taken, taken > 1 ? "s" : "");
    return true;
}

/* Applies the reader's rules to the headers as they will be written. */
static bool check_headers(const struct glint_edit *edit, const char *path, struct glint_error *err) {
    struct glint_arena arena = {0};
    struct glint_check check = {.file = path, .err = err};
    const struct glint_exr_part_info **files = glint_arena_take(&arena, (edit->count + 1) * sizeof *files);
    struct glint_part_info *parts = glint_arena_take(&arena, (edit->count + 1) * sizeof *parts);
    struct glint_frame *frame = glint_arena_take(&arena, sizeof *frame);
    bool has_frame = false, ok = (files && parts && frame) || glint_edit_fail_memory(edit, err);
    for (size_t i = 0; ok && i < edit->count; i++) {
        const struct glint_edit_part *part = &edit->parts[i];
        files[i] = &part->info;
        ok = part->info.channel_count
                 ? glint_part_parse(&check, &arena, files[i], !part->exr || part->exr->parts[part->index].readable,
                                    &parts[i])
                 : glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: no channel is left", path, part->info.name);
        if (parts[i].sibling[0]) parts[i].width = parts[i].height = 0;
    }
    ok = ok && glint_parts_check(&check, files, parts, edit->count, frame, &has_frame);
    glint_arena_finish(&arena);
    return ok;
}

/* The camera for other programs follows from glint's attributes, which may have changed. */
static bool renew_standard(struct glint_edit *edit, const char *path, struct glint_error *err) {
    const size_t i = glint_edit_find(edit, "gbuffer");
    if (i == edit->count) return true;
    struct glint_edit_part *part = &edit->parts[i];
    struct glint_frame frame = {0};
    struct glint_check check = {.file = path, .err = err};
    if (!glint_attributes_decode(&check, &part->info, GLINT_SCOPE_FRAME, &frame)) return false;
    if (!glint_attributes_set_standard(&edit->arena, &part->attributes, &frame))
        return glint_edit_fail_memory(edit, err);
    part->info.attributes = part->attributes.all;
    part->info.attribute_count = part->attributes.count;
    return true;
}

/* All that the file's part has, and nothing else: its chunks can be copied. */
static bool is_whole(const struct glint_edit_part *part) {
    if (!part->exr || !glint_exr_can_keep(part->exr, part->index)) return false;
    const struct glint_exr_part_info *from = &part->exr->parts[part->index].info;
    for (size_t c = 0; c < part->info.channel_count; c++)
        if (part->channels[c].block) return false;
    return part->info.width == from->width && part->info.height == from->height && part->step == 1 &&
           part->info.channel_count == from->channel_count;
}

static bool fill_part(struct glint_edit *edit, size_t i, struct glint_exr_part *to, struct glint_exr_kept *kept,
                      struct glint_error *err) {
    struct glint_edit_part *part = &edit->parts[i];
    const bool whole = is_whole(part);
    struct glint_exr_channel *channels =
        glint_arena_take(&edit->arena, (part->info.channel_count + 1) * sizeof *channels);
    if (!channels) return glint_edit_fail_memory(edit, err);
    if (whole) *kept = (struct glint_exr_kept){part->exr, part->index};
    else if (!glint_edit_read(edit, part, err)) return false;
    for (size_t c = 0; c < part->info.channel_count; c++) {
        const struct glint_edit_channel *channel = &part->channels[c];
        const struct glint_edit_pixels pixels =
            whole ? (struct glint_edit_pixels){.stored = channel->info.stored} : glint_edit_pixels_of(part, channel);
        channels[c] = (struct glint_exr_channel){.name = channel->info.name,
                                                 .stored = pixels.stored,
                                                 .data = pixels.data,
                                                 .x_stride_bytes = pixels.x_stride_bytes,
                                                 .y_stride_bytes = pixels.y_stride_bytes};
    }
    *to = (struct glint_exr_part){.name = part->info.name,
                                  .width = part->info.width,
                                  .height = part->info.height,
                                  .channels = channels,
                                  .channel_count = part->info.channel_count,
                                  .attributes = part->info.attributes,
                                  .attribute_count = part->info.attribute_count};
    return true;
}

bool glint_edit_write(struct glint_edit *edit, const char *path, struct glint_error *err) {
    if (!check_target(edit, path, err) || (!in_same_folder(edit, path) && !resolve_all(edit, err)) ||
        !check_headers(edit, path, err) || !renew_standard(edit, path, err))
        return false;
    struct glint_exr_part *parts = calloc(edit->count + 1, sizeof *parts);
    struct glint_exr_kept *kept = calloc(edit->count + 1, sizeof *kept);
    const struct glint_exr_write_options options = {.kept = kept};
    bool ok = (parts && kept) || glint_edit_fail_memory(edit, err);
    for (size_t i = 0; ok && i < edit->count; i++) ok = fill_part(edit, i, &parts[i], &kept[i], err);
    ok = ok && glint_exr_write_file(path, parts, edit->count, &options, err);
    free(parts);
    free(kept);
    return ok;
}
