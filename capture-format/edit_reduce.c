/* Reduces a frame to every n-th pixel in both directions. */
#include <string.h>

#include "edit_frame.h"

/* Keeps every step-th pixel from the map's first one on, as many as the given size. */
static void thin(const struct glint_edit_map *map, size_t p, const uint32_t first[2], const uint32_t count[2]) {
    struct glint_edit_part *part = &map->edit->parts[p];
    part->x += first[0] * part->step;
    part->y += first[1] * part->step;
    part->step *= map->step;
    part->info.width = count[0];
    part->info.height = count[1];
}

/* An image whose texels are r pixels wide: as large as such an image of the new frame would be, rounded as it was. */
static bool fits(const struct glint_edit_map *map, const struct glint_exr_part_info *part, uint32_t r, bool up,
                 uint32_t count[2]) {
    const uint32_t size[2] = {part->width, part->height};
    for (int i = 0; i < 2; i++) {
        count[i] = up ? (map->count[i] + r - 1) / r : map->count[i] / r;
        if (!count[i] || map->first[i] + (uint64_t)(count[i] - 1) * map->step >= size[i]) return false;
    }
    return true;
}

static bool is_exact(const struct glint_edit_map *map, const struct glint_exr_part_info *part, uint32_t r) {
    return map->size[0] == part->width * r && map->size[1] == part->height * r;
}

/* False: it does not fit. */
static bool reduce_other(const struct glint_edit_map *map, size_t p) {
    const struct glint_exr_part_info *part = glint_edit_part(map->edit, p);
    uint32_t count[2];
    bool up;
    if (part->width == 1 && part->height == 1) return true;
    const uint32_t r = glint_edit_map_ratio(map, part, &up);
    if (!r) return true;
    if (!fits(map, part, r, up, count) && !(is_exact(map, part, r) && fits(map, part, r, false, count))) return false;
    thin(map, p, map->first, count);
    return true;
}

/* A cell of the view frustum stays where it is, but for the part of a pixel by which the picture's borders move: at most an eighth of a cell. */
static bool froxels_stay(const struct glint_edit_map *map, const struct glint_exr_part_info *part) {
    const struct glint_exr_attribute *slices = glint_exr_attribute(part, "glint.froxelSlices");
    const double cells[2] = {part->width, slices && slices->numbers[0] > 0 ? part->height / slices->numbers[0] : 0};
    for (int i = 0; i < 2; i++) {
        const double begin = glint_edit_map_begin(map, i), end = begin + glint_edit_map_covered(map, i) - map->size[i];
        const double most = map->size[i] / cells[i] / 8;
        if (!(begin >= -most && begin <= most && end >= -most && end <= most)) return false;
    }
    return true;
}

static bool reduce_part(const struct glint_edit_map *map, size_t p) {
    const struct glint_role *role = glint_edit_role(&map->edit->parts[p]);
    if (!role || role->shape != GLINT_SHAPE_FRAME) return true;
    thin(map, p, map->first, map->count);
    return glint_edit_map_part(map, p);
}

/* Why a part cannot come along; NULL if it can. */
static const char *refuse(const struct glint_edit_map *map, size_t p) {
    const struct glint_edit_part *part = &map->edit->parts[p];
    const struct glint_role *role = glint_edit_role(part);
    if (!role || !strcmp(role->name, "engine."))
        return reduce_other(map, p) ? NULL : "its texels are larger than what is left of the frame";
    if (!strcmp(role->name, "stipple") && map->step % 2 == 0)
        return "of a checkerboard every second pixel is no pattern";
    if (!strcmp(role->name, "froxels") && !froxels_stay(map, &part->info))
        return "their cells are of the whole view frustum, and the picture's borders have moved";
    return NULL;
}

static void reduce_or_drop_others(const struct glint_edit_map *map) {
    for (size_t p = 0; p < map->edit->count;) {
        const char *why = refuse(map, p);
        if (why) {
            glint_edit_say(map->edit, "%s: left out; %s", glint_edit_part(map->edit, p)->name, why);
            glint_edit_drop_part(map->edit, p);
        } else p++;
    }
}

bool glint_edit_reduce(struct glint_edit *edit, uint32_t factor, struct glint_error *err) {
    struct glint_edit_map map;
    if (!glint_edit_map_open(&map, edit, err)) return false;
    const uint32_t least = map.size[0] < map.size[1] ? map.size[0] : map.size[1];
    bool ok = factor >= 1 && factor <= least;
    if (!ok)
        glint_fail(err, GLINT_ERROR_USAGE,
                   "%s: expected every n-th pixel of a frame of %u x %u, n from 1 to %u; found %u", edit->exr->path,
                   map.size[0], map.size[1], least, factor);
    for (int i = 0; ok && i < 2; i++) {
        map.step = factor;
        map.first[i] = (factor - 1) / 2; /* the one nearest to the middle of its block */
        map.count[i] = (map.size[i] - map.first[i] + factor - 1) / factor;
    }
    if (ok && factor > 1) {
        reduce_or_drop_others(&map);
        ok = glint_edit_map_parts(&map, reduce_part) && glint_edit_map_cameras(&map) && glint_edit_map_range(&map);
    }
    glint_edit_map_close(&map);
    return ok;
}
