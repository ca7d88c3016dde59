/* The rules of FORMAT.md for a file's own headers, which the EXR library accepts in other forms, too. */
#include <string.h>

#include "capture_internal.h"
#include "registry.h"

#define BROKEN(rule, ...) glint_violation(check, GLINT_RULE_##rule, part->info.name, NULL, __VA_ARGS__)

static bool check_storage(struct glint_check *check, const struct glint_exr *exr, size_t p) {
    const struct glint_exr_part_file *part = &exr->parts[p];
    exr_lineorder_t order = EXR_LINEORDER_INCREASING_Y;
    int32_t index;
    bool previous;
    if (!glint_role_find(part->info.name, &index, &previous)) return true;
    if (part->compression == EXR_COMPRESSION_B44A && !BROKEN(STORAGE, "expected another compression, found B44A"))
        return false;
    return exr_get_lineorder(exr->context, (int)p, &order) || order == EXR_LINEORDER_INCREASING_Y ||
           BROKEN(STORAGE, "expected lines in increasing y, found another order");
}

static bool check_window(struct glint_check *check, const struct glint_exr *exr, size_t p) {
    const struct glint_exr_part_file *part = &exr->parts[p];
    exr_attr_box2i_t first, own;
    float first_aspect, own_aspect;
    if (exr_get_display_window(exr->context, 0, &first) || exr_get_display_window(exr->context, (int)p, &own) ||
        exr_get_pixel_aspect_ratio(exr->context, 0, &first_aspect) ||
        exr_get_pixel_aspect_ratio(exr->context, (int)p, &own_aspect))
        return true;
    if (memcmp(&first, &own, sizeof own) != 0)
        return BROKEN(WINDOW, "expected the displayWindow of %s, (%d, %d) to (%d, %d), found (%d, %d) to (%d, %d)",
                      exr->parts[0].info.name, first.min.x, first.min.y, first.max.x, first.max.y, own.min.x, own.min.y,
                      own.max.x, own.max.y);
    if (first_aspect < own_aspect || first_aspect > own_aspect)
        return BROKEN(WINDOW, "expected the pixelAspectRatio of %s, %g, found %g", exr->parts[0].info.name,
                      (double)first_aspect, (double)own_aspect);
    return true;
}

bool glint_container_check(struct glint_check *check, const struct glint_exr *exr) {
    for (size_t p = 0; p < exr->part_count; p++)
        if (!check_storage(check, exr, p) || !check_window(check, exr, p)) return false;
    return true;
}
