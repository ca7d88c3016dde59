/* Crops a frame to a rectangle. */
#include <string.h>

#include "edit_frame.h"

/* The rectangle in an image whose texels are r pixels wide. It must begin at a texel, and end at one or at the frame's end. */
static bool rectangle_in(const struct glint_edit_map *map, const char *part, uint32_t r, bool up, uint32_t width,
                         uint32_t height, struct glint_edit_rectangle *out) {
    const uint32_t *from = map->first, *size = map->count;
    const uint32_t image[2] = {width, height};
    uint32_t first[2], count[2], fit[4];
    bool fits = true;
    for (int i = 0; i < 2; i++) {
        const uint32_t end = from[i] + size[i], last = end == map->size[i] ? end : (end + r - 1) / r * r;
        fit[i] = from[i] / r * r;
        fit[2 + i] = (last < map->size[i] ? last : map->size[i]) - fit[i];
        fits = fits && fit[i] == from[i] && fit[2 + i] == size[i];
        first[i] = from[i] / r;
        count[i] = up ? (size[i] + r - 1) / r : size[i] / r;
        fits = fits && count[i] && first[i] + count[i] <= image[i];
    }
    *out = (struct glint_edit_rectangle){first[0], first[1], count[0], count[1]};
    if (fits) return true;
    return glint_fail(map->err, GLINT_ERROR_USAGE,
                      "part %s: one of its texels covers %u x %u pixels, some inside and some outside the rectangle; "
                      "crop %u,%u,%u,%u, or leave the part out first (glint strip --drop %s)",
                      part, r, r, fit[0], fit[1], fit[2], fit[3], part);
}

static bool crop_other(const struct glint_edit_map *map, size_t p) {
    const struct glint_exr_part_info *part = glint_edit_part(map->edit, p);
    struct glint_edit_rectangle own;
    bool up;
    const uint32_t r = glint_edit_map_ratio(map, part, &up);
    return !r || (rectangle_in(map, part->name, r, up, part->width, part->height, &own) &&
                  glint_edit_crop_part(map->edit, p, &own, map->err));
}

static bool crop_part(const struct glint_edit_map *map, size_t p) {
    const struct glint_role *role = glint_edit_role(&map->edit->parts[p]);
    if (!role || !strcmp(role->name, "engine.")) return crop_other(map, p);
    if (role->shape != GLINT_SHAPE_FRAME) return true; /* cube maps see everything, planar maps have their own camera */
    const struct glint_edit_rectangle own = {map->first[0], map->first[1], map->count[0], map->count[1]};
    return glint_edit_crop_part(map->edit, p, &own, map->err) && glint_edit_map_part(map, p);
}

bool glint_edit_crop(struct glint_edit *edit, const struct glint_edit_rectangle *rectangle, struct glint_error *err) {
    struct glint_edit_map map;
    if (!glint_edit_map_open(&map, edit, err)) return false;
    map.step = 1;
    map.first[0] = rectangle->x, map.first[1] = rectangle->y;
    map.count[0] = rectangle->width, map.count[1] = rectangle->height;
    bool ok = glint_edit_map_parts(&map, crop_part); /* the gbuffer checks the rectangle */
    const size_t froxels = glint_edit_find(edit, "froxels");
    if (ok && froxels < edit->count) {
        glint_edit_say(edit, "froxels: left out; their cells are of the whole view frustum");
        glint_edit_drop_part(edit, froxels);
    }
    ok = ok && glint_edit_map_cameras(&map) && glint_edit_map_range(&map);
    glint_edit_map_close(&map);
    return ok;
}
