/* A frame whose pixels are a grid within the old one's. A pixel keeps its ray, because the projections are changed by the same affine map as the
   pixels: NDC x of the grid = NDC x · W / w + (W - 2 x0 - w) / w, where the grid's picture begins at x0 and is w wide, in pixels of the old frame. */
#include "edit_frame.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture_internal.h"

static bool fail_memory(const struct glint_edit_map *map) {
    return glint_fail(map->err, GLINT_ERROR_MEMORY, "%s: out of memory", glint_capture_path(map->capture));
}

bool glint_edit_map_open(struct glint_edit_map *map, struct glint_edit *edit, struct glint_error *err) {
    *map = (struct glint_edit_map){.edit = edit, .err = err};
    map->capture = glint_capture_open(edit->exr->path, &edit->exr->limits, err);
    const struct glint_exr_part_info *gbuffer = glint_edit_part(edit, glint_edit_find(edit, "gbuffer"));
    if (!map->capture) return false;
    if (!gbuffer) {
        glint_edit_map_close(map);
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: part gbuffer is left out; its frame cannot change",
                          edit->exr->path);
    }
    map->size[0] = gbuffer->width;
    map->size[1] = gbuffer->height;
    return true;
}

void glint_edit_map_close(struct glint_edit_map *map) {
    glint_capture_close(&map->capture);
}

bool glint_edit_map_parts(const struct glint_edit_map *map, glint_edit_map_change change) {
    const size_t gbuffer = glint_edit_find(map->edit, "gbuffer");
    bool ok = change(map, gbuffer);
    for (size_t p = 0; ok && p < map->edit->count; p++) ok = p == gbuffer || change(map, p);
    return ok;
}

/* A pixel of the grid is `step` pixels wide and lies about the centre of the pixel that it keeps. */
double glint_edit_map_begin(const struct glint_edit_map *map, int axis) {
    return map->first[axis] + 0.5 - map->step / 2.0;
}

double glint_edit_map_covered(const struct glint_edit_map *map, int axis) {
    return (double)map->step * map->count[axis];
}

static double scale_of(const struct glint_edit_map *map, int axis) {
    return map->size[axis] / glint_edit_map_covered(map, axis);
}

/* ---- Cameras ---- */

static bool is_down(const struct glint_edit_map *map) {
    return glint_capture_frame(map->capture)->clip_y == GLINT_CLIP_Y_DOWN;
}

static bool change_camera(const struct glint_edit_map *map, const char *attribute) {
    const size_t gbuffer = glint_edit_find(map->edit, "gbuffer");
    const struct glint_exr_attribute *a = glint_exr_attribute(glint_edit_part(map->edit, gbuffer), attribute);
    double m[16];
    if (!a) return true;
    memcpy(m, a->numbers, sizeof m);
    for (int axis = 0; axis < 2; axis++) {
        const double from = glint_edit_map_begin(map, axis), to = glint_edit_map_covered(map, axis);
        const double shift = (map->size[axis] - 2 * from - to) / to;
        const double down = axis == 0 || is_down(map) ? 1 : -1;
        double *row = m + 4 * axis;
        for (int i = 0; i < 4; i++) row[i] = row[i] * map->size[axis] / to + down * shift * m[12 + i];
    }
    const struct glint_exr_attribute changed = {.name = attribute, .type = GLINT_EXR_M44D, .numbers = m, .count = 16};
    return glint_edit_set(map->edit, gbuffer, &changed, map->err);
}

static bool change_jitter(const struct glint_edit_map *map) {
    const size_t gbuffer = glint_edit_find(map->edit, "gbuffer");
    const struct glint_exr_attribute *a = glint_exr_attribute(glint_edit_part(map->edit, gbuffer), "glint.jitter");
    if (!a || map->step == 1) return true;
    const double jitter[2] = {a->numbers[0] / map->step, a->numbers[1] / map->step};
    const struct glint_exr_attribute changed = {
        .name = "glint.jitter", .type = GLINT_EXR_V2D, .numbers = jitter, .count = 2};
    return glint_edit_set(map->edit, gbuffer, &changed, map->err);
}

bool glint_edit_map_cameras(const struct glint_edit_map *map) {
    return change_camera(map, "glint.viewToClip") && change_camera(map, "glint.previousViewToClip") &&
           change_jitter(map);
}

/* ---- Motion, which is relative to the size of the picture unless it is in pixels ---- */

static bool has_channel(const struct glint_exr_part_info *part, const char *name) {
    return glint_exr_channel(part, name) >= 0;
}

/* Floats do not add to the precision that the engine had, so a channel that was stored as half says so. */
static bool keep_storage(const struct glint_edit_map *map, size_t p, const char *channel, enum glint_stored stored) {
    const struct glint_exr_attribute *old = glint_exr_attribute(glint_edit_part(map->edit, p), GLINT_STORAGE_ATTRIBUTE);
    char entry[64];
    const bool listed = old && old->type == GLINT_EXR_STRINGS;
    for (size_t i = 0; listed && i < old->count; i++)
        if (!strncmp(old->strings[i], channel, strlen(channel)) && old->strings[i][strlen(channel)] == '=') return true;
    if (stored != GLINT_STORED_HALF) return true;
    snprintf(entry, sizeof entry, "%s=half", channel);
    return glint_edit_assign(map->edit, glint_edit_part(map->edit, p)->name, "storage", entry, map->err);
}

/* `packed`: the range of packed values, which become uv; 0: the values are scaled. */
static bool scale_channel(const struct glint_edit_map *map, size_t p, int axis, double scale, double packed) {
    const char *channel = axis ? "motion.Y" : "motion.X";
    struct glint_edit_pixels from;
    if (!glint_edit_pixels(map->edit, p, channel, &from, map->err)) return false;
    float *values = malloc(((size_t)from.width * from.height + 1) * sizeof *values);
    if (!values) return fail_memory(map);
    for (uint32_t y = 0; y < from.height; y++)
        for (uint32_t x = 0; x < from.width; x++) {
            const uint8_t *at = from.data + y * from.y_stride_bytes + x * from.x_stride_bytes;
            float *to = &values[(size_t)y * from.width + x];
            uint32_t code;
            if (from.stored == GLINT_STORED_UINT) {
                memcpy(&code, at, sizeof code);
                *to = (float)(((double)code - 32768) / 32767 * packed * scale);
            } else {
                glint_decode_widen(from.stored, at, 1, to);
                *to = (float)((double)*to * scale);
            }
        }
    const bool ok =
        glint_edit_replace(map->edit, p, channel, values, map->err) && keep_storage(map, p, channel, from.stored);
    free(values);
    return ok;
}

static enum glint_motion_encoding motion_encoding(const struct glint_exr_part_info *part) {
    const struct glint_exr_attribute *a = glint_exr_attribute(part, "glint.motion");
    const int value = a && a->type == GLINT_EXR_STRING ? glint_encoding_value("motion", a->string) : 0;
    return value > 0 ? (enum glint_motion_encoding)value : GLINT_MOTION_UV;
}

static bool has_packed_motion(const struct glint_edit *edit) {
    for (size_t i = 0; i < edit->count; i++) {
        const struct glint_exr_part_info *part = &edit->parts[i].info;
        if (glint_edit_role(&edit->parts[i]) && motion_encoding(part) == GLINT_MOTION_PACKED16 &&
            has_channel(part, "motion.X"))
            return true;
    }
    return false;
}

static double motion_range(const struct glint_edit *edit) {
    const struct glint_exr_attribute *a =
        glint_exr_attribute(glint_edit_part(edit, glint_edit_find(edit, "gbuffer")), "glint.motionRange");
    return a ? a->numbers[0] : 1;
}

/* Packed codes stay if one new range fits both axes. */
bool glint_edit_map_range(const struct glint_edit_map *map) {
    const double scale = scale_of(map, 0), scaled = motion_range(map->edit) * scale;
    const struct glint_exr_attribute changed = {
        .name = "glint.motionRange", .type = GLINT_EXR_DOUBLE, .numbers = &scaled, .count = 1};
    if (scale != scale_of(map, 1) || scale == 1 || !has_packed_motion(map->edit)) return true;
    return glint_edit_set(map->edit, glint_edit_find(map->edit, "gbuffer"), &changed, map->err);
}

static bool change_motion(const struct glint_edit_map *map, size_t p) {
    const struct glint_exr_part_info *part = glint_edit_part(map->edit, p);
    const enum glint_motion_encoding encoding = motion_encoding(part);
    const bool packed = encoding == GLINT_MOTION_PACKED16, pixels = encoding == GLINT_MOTION_PIXELS;
    if (!has_channel(part, "motion.X") || (packed && scale_of(map, 0) == scale_of(map, 1))) return true;
    for (int axis = 0; axis < 2; axis++) {
        const double scale = pixels ? 1.0 / map->step : scale_of(map, axis);
        if ((packed || scale != 1) && !scale_channel(map, p, axis, scale, motion_range(map->edit))) return false;
    }
    if (!packed) return true;
    glint_edit_say(map->edit, "%s: packed motion became uv, because one range no longer fits both axes", part->name);
    return glint_edit_assign(map->edit, part->name, "motion", "uv", map->err);
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

/* The place in the file's picture, in [0, 1], y down, at which the mirror ray of a place in it hits; false behind the camera. */
static bool mirror_hit(const struct view *v, double down, const double uv[2], const float *surface, double travelled_m,
                       double hit[2]) {
    const double ndc[2] = {2 * uv[0] - 1, down * (2 * uv[1] - 1)}, depth = (double)surface[0];
    double p[3] = {(ndc[0] - v->c) / v->a * depth, (ndc[1] - v->d) / v->b * depth, v->front * depth}, n[3], dot = 0;
    const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int i = 0; i < 3; i++) {
        n[i] = 0;
        for (int k = 0; k < 3; k++) n[i] += v->rotation[3 * i + k] * (double)surface[1 + k];
        dot += n[i] * p[i] / length;
    }
    for (int i = 0; i < 3; i++) p[i] += travelled_m * (p[i] / length - 2 * dot * n[i]);
    const double to = v->front * p[2];
    hit[0] = (v->a * p[0] / to + v->c + 1) / 2;
    hit[1] = (down * (v->b * p[1] / to + v->d) + 1) / 2;
    return to > 0;
}

/* What the mirror rays of the whole file are compared with: the new picture, which is a grid of the file's pixels. */
struct mirror {
    struct view view;
    double down;
    uint32_t size[2];            /* of the file's frame */
    double begin[2], covered[2]; /* of the new picture, in pixels of the file's */
    float *surface, *truth;      /* depth and normal; distance and visible; of the file's frame */
};

static bool is_visible(const struct mirror *m, uint32_t x, uint32_t y) {
    const size_t i = (size_t)y * m->size[0] + x;
    const double uv[2] = {(x + 0.5) / m->size[0], (y + 0.5) / m->size[1]};
    double hit[2];
    if (!mirror_hit(&m->view, m->down, uv, m->surface + 4 * i, (double)m->truth[2 * i], hit)) return false;
    for (int a = 0; a < 2; a++) {
        const double at = hit[a] * m->size[a];
        if (!(at >= m->begin[a] && at < m->begin[a] + m->covered[a])) return false;
    }
    return true;
}

static bool read_mirror(const struct glint_edit_map *map, const char *truth, struct mirror *m) {
    static const char *const surface_names[] = {"depth.Z", "normal.X", "normal.Y", "normal.Z"};
    static const char *const truth_names[] = {"distance.Z", "visible"};
    const struct glint_part_info *gbuffer = glint_capture_find(map->capture, "gbuffer");
    const size_t pixels = (size_t)gbuffer->width * gbuffer->height;
    m->surface = malloc(pixels * 4 * sizeof *m->surface + 1);
    m->truth = malloc(pixels * 2 * sizeof *m->truth + 1);
    if (!m->surface || !m->truth) return fail_memory(map);
    return glint_capture_read(map->capture, gbuffer, surface_names, 4, GLINT_F32, m->surface, 0, map->err) &&
           glint_capture_read(map->capture, glint_capture_find(map->capture, truth), truth_names, 2, GLINT_F32,
                              m->truth, 0, map->err);
}

/* `visible` says that the hit is on screen, which is now the new picture. */
static bool change_visible(const struct glint_edit_map *map, size_t p) {
    const struct glint_edit_part *part = &map->edit->parts[p];
    const struct glint_part_info *gbuffer = glint_capture_find(map->capture, "gbuffer");
    const double half = part->step / 2.0;
    struct mirror m = {.view = view_of(glint_capture_frame(map->capture)),
                       .down = is_down(map) ? 1 : -1,
                       .size = {gbuffer->width, gbuffer->height},
                       .begin = {part->x + 0.5 - half, part->y + 0.5 - half},
                       .covered = {(double)part->step * part->info.width, (double)part->step * part->info.height}};
    struct glint_edit_pixels visible = {0};
    const bool ok =
        read_mirror(map, part->info.name, &m) && glint_edit_pixels(map->edit, p, "visible", &visible, map->err);
    size_t hidden = 0;
    for (uint32_t y = 0; ok && y < visible.height; y++)
        for (uint32_t x = 0; x < visible.width; x++) {
            const uint32_t from[2] = {part->x + x * part->step, part->y + y * part->step};
            if (m.truth[2 * ((size_t)from[1] * m.size[0] + from[0]) + 1] == 0 || is_visible(&m, from[0], from[1]))
                continue;
            memset(visible.data + y * visible.y_stride_bytes + x * visible.x_stride_bytes, 0,
                   glint_stored_bytes(visible.stored));
            hidden++;
        }
    free(m.surface);
    free(m.truth);
    if (hidden)
        glint_edit_say(map->edit, "%s: %zu hits are outside the copy's picture, no longer visible", part->info.name,
                       hidden);
    return ok;
}

bool glint_edit_map_part(const struct glint_edit_map *map, size_t p) {
    const bool mirror = !strcmp(glint_edit_part(map->edit, p)->name, "truth.mirror");
    return change_motion(map, p) && (!mirror || change_visible(map, p));
}

/* ---- Parts of other sizes ---- */

uint32_t glint_edit_map_ratio(const struct glint_edit_map *map, const struct glint_exr_part_info *part, bool *up) {
    *up = false;
    if (part->width > 1 && part->height == 6 * part->width) return 0; /* a cube map */
    const uint32_t exact = map->size[0] / part->width;
    if (exact && map->size[0] == exact * part->width && map->size[1] == exact * part->height) {
        *up = true;
        return exact;
    }
    for (uint32_t r = 1; r <= map->size[0] && r <= map->size[1]; r++) {
        *up = (map->size[0] + r - 1) / r == part->width && (map->size[1] + r - 1) / r == part->height;
        if (*up || (map->size[0] / r == part->width && map->size[1] / r == part->height)) return r;
    }
    glint_edit_say(map->edit, "%s: kept whole; its %u x %u pixels are no whole number of times fewer than the frame's",
                   part->name, part->width, part->height);
    return 0;
}
