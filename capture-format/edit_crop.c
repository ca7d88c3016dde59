/* Crops a frame. A pixel keeps its ray, because the projections are changed by the same affine map as the pixels:
   NDC x of the rectangle = NDC x · W / w + (W - 2 x0 - w) / w. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture_internal.h"
#include "edit_internal.h"

struct crop {
    struct glint_edit *edit;
    struct glint_capture *capture;
    const struct glint_frame *frame;
    struct glint_edit_rectangle to;
    uint32_t size[2]; /* of the frame */
    double scale[2];  /* frame / rectangle, of x and y */
    struct glint_error *err;
};

static bool fail_memory(const struct crop *crop) {
    return glint_fail(crop->err, GLINT_ERROR_MEMORY, "%s: out of memory", glint_capture_path(crop->capture));
}

/* ---- Cameras ---- */

static bool crop_camera(const struct crop *crop, const char *attribute) {
    const size_t gbuffer = glint_edit_find(crop->edit, "gbuffer");
    const struct glint_exr_attribute *a = glint_exr_attribute(glint_edit_part(crop->edit, gbuffer), attribute);
    double m[16];
    if (!a) return true;
    memcpy(m, a->numbers, sizeof m);
    const double from[2] = {crop->to.x, crop->to.y}, to[2] = {crop->to.width, crop->to.height};
    for (int axis = 0; axis < 2; axis++) {
        const double shift = (crop->size[axis] - 2 * from[axis] - to[axis]) / to[axis];
        const double down = axis == 0 || crop->frame->clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1;
        double *row = m + 4 * axis;
        for (int i = 0; i < 4; i++) row[i] = row[i] * crop->size[axis] / to[axis] + down * shift * m[12 + i];
    }
    const struct glint_exr_attribute changed = {.name = attribute, .type = GLINT_EXR_M44D, .numbers = m, .count = 16};
    return glint_edit_set(crop->edit, gbuffer, &changed, crop->err);
}

/* ---- Motion, which is relative to the size of the picture unless it is in pixels ---- */

static bool has_channel(const struct glint_exr_part_info *part, const char *name) {
    return glint_exr_channel(part, name) >= 0;
}

/* Floats do not add to the precision that the engine had, so a channel that was stored as half says so. */
static bool keep_storage(const struct crop *crop, size_t p, const char *channel, enum glint_stored stored) {
    const struct glint_exr_attribute *old =
        glint_exr_attribute(glint_edit_part(crop->edit, p), GLINT_STORAGE_ATTRIBUTE);
    char entry[64];
    const bool listed = old && old->type == GLINT_EXR_STRINGS;
    for (size_t i = 0; listed && i < old->count; i++)
        if (!strncmp(old->strings[i], channel, strlen(channel)) && old->strings[i][strlen(channel)] == '=') return true;
    if (stored != GLINT_STORED_HALF) return true;
    snprintf(entry, sizeof entry, "%s=half", channel);
    return glint_edit_assign(crop->edit, glint_edit_part(crop->edit, p)->name, "storage", entry, crop->err);
}

/* `packed`: the range of packed values, which become uv; 0: the values are scaled. */
static bool scale_channel(const struct crop *crop, size_t p, int axis, double packed) {
    const char *channel = axis ? "motion.Y" : "motion.X";
    struct glint_edit_pixels from;
    if (!glint_edit_pixels(crop->edit, p, channel, &from, crop->err)) return false;
    float *values = malloc(((size_t)from.width * from.height + 1) * sizeof *values);
    if (!values) return fail_memory(crop);
    for (uint32_t y = 0; y < from.height; y++)
        for (uint32_t x = 0; x < from.width; x++) {
            const uint8_t *at = from.data + y * from.y_stride_bytes + x * from.x_stride_bytes;
            float *to = &values[(size_t)y * from.width + x];
            uint32_t code;
            if (from.stored == GLINT_STORED_UINT) {
                memcpy(&code, at, sizeof code);
                *to = (float)(((double)code - 32768) / 32767 * packed * crop->scale[axis]);
            } else {
                glint_decode_widen(from.stored, at, 1, to);
                *to = (float)((double)*to * crop->scale[axis]);
            }
        }
    const bool ok =
        glint_edit_replace(crop->edit, p, channel, values, crop->err) && keep_storage(crop, p, channel, from.stored);
    free(values);
    return ok;
}

static bool has_packed_motion(const struct crop *crop) {
    for (size_t i = 0; i < glint_capture_part_count(crop->capture); i++) {
        const struct glint_part_info *part = glint_capture_part(crop->capture, i);
        if (part->role && part->encodings.motion == GLINT_MOTION_PACKED16 && glint_part_has_channel(part, "motion.X"))
            return true;
    }
    return false;
}

/* Packed codes stay if one new range fits both axes. */
static bool crop_range(const struct crop *crop) {
    const double range = crop->frame->motion_range > 0 ? crop->frame->motion_range : 1, scaled = range * crop->scale[0];
    const struct glint_exr_attribute changed = {
        .name = "glint.motionRange", .type = GLINT_EXR_DOUBLE, .numbers = &scaled, .count = 1};
    if (crop->scale[0] != crop->scale[1] || !has_packed_motion(crop)) return true;
    return glint_edit_set(crop->edit, glint_edit_find(crop->edit, "gbuffer"), &changed, crop->err);
}

static bool crop_motion(const struct crop *crop, size_t p, const struct glint_part_info *part) {
    const enum glint_motion_encoding encoding = part->encodings.motion;
    const bool packed = encoding == GLINT_MOTION_PACKED16;
    const double range = crop->frame->motion_range > 0 ? crop->frame->motion_range : 1;
    if (!has_channel(glint_edit_part(crop->edit, p), "motion.X") || encoding == GLINT_MOTION_PIXELS) return true;
    if (packed && crop->scale[0] == crop->scale[1]) return true;
    for (int axis = 0; axis < 2; axis++)
        if ((packed || crop->scale[axis] != 1) && !scale_channel(crop, p, axis, range)) return false;
    if (!packed) return true;
    glint_edit_say(crop->edit, "%s: packed motion became uv, because one range no longer fits both axes", part->name);
    return glint_edit_assign(crop->edit, part->name, "motion", "uv", crop->err);
}

/* ---- The truth's mirror rays ---- */

struct view {
    double a, b, c, d, front, rotation[9];
};

static struct view view_of(const struct glint_frame *frame) {
    const double *p = frame->camera.view_to_clip, front = p[14] < 0 ? -1 : 1;
    struct view view = {p[0], p[5], p[2] * front, p[6] * front, front, {0}};
    for (int i = 0; i < 9; i++) view.rotation[i] = frame->camera.world_to_view[4 * (i / 3) + i % 3];
    return view;
}

/* The pixel of the frame, y down, at which the mirror ray of a pixel hits; false behind the camera. */
static bool mirror_hit(const struct crop *crop, const struct view *v, uint32_t x, uint32_t y, const float *surface,
                       double travelled_m, double hit[2]) {
    const double down = crop->frame->clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1, depth = (double)surface[0];
    const double ndc[2] = {2 * (x + 0.5) / crop->size[0] - 1, down * (2 * (y + 0.5) / crop->size[1] - 1)};
    double p[3] = {(ndc[0] - v->c) / v->a * depth, (ndc[1] - v->d) / v->b * depth, v->front * depth}, n[3], dot = 0;
    const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int i = 0; i < 3; i++) {
        n[i] = 0;
        for (int k = 0; k < 3; k++) n[i] += v->rotation[3 * i + k] * (double)surface[1 + k];
        dot += n[i] * p[i] / length;
    }
    for (int i = 0; i < 3; i++) p[i] += travelled_m * (p[i] / length - 2 * dot * n[i]);
    const double to = v->front * p[2];
    hit[0] = (v->a * p[0] / to + v->c + 1) / 2 * crop->size[0];
    hit[1] = (down * (v->b * p[1] / to + v->d) + 1) / 2 * crop->size[1];
    return to > 0;
}

/* `visible` says that the hit is on screen, which is now the rectangle. */
static bool crop_visible(const struct crop *crop, size_t p, const struct glint_part_info *part) {
    static const char *const surface_names[] = {"depth.Z", "normal.X", "normal.Y", "normal.Z"};
    static const char *const truth_names[] = {"distance.Z", "visible"};
    const struct glint_part_info *gbuffer = glint_capture_find(crop->capture, "gbuffer");
    const size_t pixels = (size_t)crop->size[0] * crop->size[1];
    const struct view view = view_of(crop->frame);
    const struct glint_edit_rectangle *to = &crop->to;
    float *surface = malloc(pixels * 4 * sizeof *surface + 1), *truth = malloc(pixels * 2 * sizeof *truth + 1);
    struct glint_edit_pixels visible;
    size_t hidden = 0;
    bool ok = (surface && truth) || fail_memory(crop);
    ok = ok && glint_capture_read(crop->capture, gbuffer, surface_names, 4, GLINT_F32, surface, 0, crop->err) &&
         glint_capture_read(crop->capture, part, truth_names, 2, GLINT_F32, truth, 0, crop->err) &&
         glint_edit_pixels(crop->edit, p, "visible", &visible, crop->err);
    for (uint32_t y = 0; ok && y < to->height; y++)
        for (uint32_t x = 0; x < to->width; x++) {
            const size_t i = (size_t)(to->y + y) * crop->size[0] + to->x + x;
            double hit[2];
            if (truth[2 * i + 1] == 0) continue;
            if (mirror_hit(crop, &view, to->x + x, to->y + y, surface + 4 * i, (double)truth[2 * i], hit) &&
                hit[0] >= to->x && hit[0] < (double)to->x + to->width && hit[1] >= to->y &&
                hit[1] < (double)to->y + to->height)
                continue;
            memset(visible.data + y * visible.y_stride_bytes + x * visible.x_stride_bytes, 0,
                   glint_stored_bytes(visible.stored));
            hidden++;
        }
    free(surface);
    free(truth);
    if (ok && hidden)
        glint_edit_say(crop->edit, "%s: %zu hits are outside the rectangle, no longer visible", part->name, hidden);
    return ok;
}

/* ---- Parts of other sizes ---- */

/* How many times smaller than the frame a part is, with sizes rounded up or down; 0: no whole number of times. */
static uint32_t ratio_of(const struct crop *crop, uint32_t width, uint32_t height, bool *up) {
    for (uint32_t r = 1; r <= crop->size[0] && r <= crop->size[1]; r++) {
        *up = (crop->size[0] + r - 1) / r == width && (crop->size[1] + r - 1) / r == height;
        if (*up || (crop->size[0] / r == width && crop->size[1] / r == height)) return r;
    }
    return 0;
}

/* The rectangle in an image whose texels are r pixels wide. It must begin at a texel, and end at one or at the frame's end. */
static bool reduce(const struct crop *crop, const char *part, uint32_t r, bool up, uint32_t width, uint32_t height,
                   struct glint_edit_rectangle *out) {
    const uint32_t from[2] = {crop->to.x, crop->to.y}, size[2] = {crop->to.width, crop->to.height};
    const uint32_t image[2] = {width, height};
    uint32_t first[2], count[2], fit[4];
    bool fits = true;
    for (int i = 0; i < 2; i++) {
        const uint32_t end = from[i] + size[i], last = end == crop->size[i] ? end : (end + r - 1) / r * r;
        fit[i] = from[i] / r * r;
        fit[2 + i] = (last < crop->size[i] ? last : crop->size[i]) - fit[i];
        fits = fits && fit[i] == from[i] && fit[2 + i] == size[i];
        first[i] = from[i] / r;
        count[i] = up ? (size[i] + r - 1) / r : size[i] / r;
        fits = fits && count[i] && first[i] + count[i] <= image[i];
    }
    *out = (struct glint_edit_rectangle){first[0], first[1], count[0], count[1]};
    if (fits) return true;
    return glint_fail(crop->err, GLINT_ERROR_USAGE,
                      "part %s: one of its texels covers %u x %u pixels, some inside and some outside the rectangle; "
                      "crop %u,%u,%u,%u, or leave the part out first (glint strip --drop %s)",
                      part, r, r, fit[0], fit[1], fit[2], fit[3], part);
}

static bool crop_other(const struct crop *crop, size_t p, const struct glint_part_info *part) {
    struct glint_edit_rectangle own;
    bool up = false;
    const bool cube = part->width > 1 && part->height == 6 * part->width;
    const uint32_t r = cube ? 0 : ratio_of(crop, part->width, part->height, &up);
    if (!r) {
        if (!cube)
            glint_edit_say(crop->edit,
                           "%s: kept whole; its %u x %u pixels are no whole number of times fewer than the frame's",
                           part->name, part->width, part->height);
        return true;
    }
    return reduce(crop, part->name, r, up, part->width, part->height, &own) &&
           glint_edit_crop_part(crop->edit, p, &own, crop->err);
}

static bool crop_part(const struct crop *crop, size_t p) {
    const struct glint_part_info *part = glint_capture_find(crop->capture, glint_edit_part(crop->edit, p)->name);
    if (!part) return true;
    if (!part->role || !strcmp(part->role->name, "engine.")) return crop_other(crop, p, part);
    if (part->role->shape != GLINT_SHAPE_FRAME)
        return true; /* cube maps see everything, planar maps have their own camera */
    if (!glint_edit_crop_part(crop->edit, p, &crop->to, crop->err) || !crop_motion(crop, p, part)) return false;
    return strcmp(part->name, "truth.mirror") != 0 || crop_visible(crop, p, part);
}

bool glint_edit_crop(struct glint_edit *edit, const struct glint_edit_rectangle *rectangle, struct glint_error *err) {
    struct glint_capture *capture = glint_capture_open(edit->exr->path, &edit->exr->limits, err);
    const struct glint_part_info *gbuffer = capture ? glint_capture_find(capture, "gbuffer") : NULL;
    if (!capture) return false;
    struct crop crop = {
        .edit = edit,
        .capture = capture,
        .frame = glint_capture_frame(capture),
        .to = *rectangle,
        .size = {gbuffer->width, gbuffer->height},
        .scale = {(double)gbuffer->width / rectangle->width, (double)gbuffer->height / rectangle->height},
        .err = err};
    bool ok = true;
    for (size_t p = glint_edit_find(edit, "gbuffer"), i = 0; ok && i < edit->count;
         i++) /* checks the rectangle first */
        ok = crop_part(&crop, i == 0 ? p : i - (i <= p));
    const size_t froxels = glint_edit_find(edit, "froxels");
    if (ok && froxels < edit->count) {
        glint_edit_say(edit, "froxels: left out; their cells are of the whole view frustum");
        glint_edit_drop_part(edit, froxels);
    }
    ok = ok && crop_camera(&crop, "glint.viewToClip") && crop_camera(&crop, "glint.previousViewToClip") &&
         crop_range(&crop);
    glint_capture_close(&capture);
    return ok;
}
