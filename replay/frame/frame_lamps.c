/* The lamps of the uniform block, and the rectangles of the screen that hold all that they light. */
#include <math.h>
#include <string.h>

#include "frame_block.h"

_Static_assert(LAMPS >= GLINT_MAX_LIGHTS, "passes see all lamps of a capture");

/* A ball in view space, in metres: x, y, and the distance along the view axis. */
struct ball {
    double x, y, depth, radius;
};

/* Where along an axis of the picture a ball lies, as x or y divided by the depth; false behind the camera. */
static bool extent(double across, double depth, double radius, double range[2]) {
    const double distance = hypot(across, depth), quarter = 1.57079632679489662;
    range[0] = -INFINITY, range[1] = INFINITY;
    if (!(distance > radius)) return true;
    const double middle = atan2(across, depth), half = asin(radius / distance);
    if (middle - half >= quarter || middle + half <= -quarter) return false;
    if (middle - half > -quarter) range[0] = tan(middle - half);
    if (middle + half < quarter) range[1] = tan(middle + half);
    return true;
}

/* Pixels on which [from, to] lies, and one more at each side for the rounding of places; scale and shift lead to uv. */
static bool clip_pixels(const double range[2], double scale, double shift, uint32_t size, uint32_t *from,
                        uint32_t *to) {
    const double a = (range[0] * scale + shift) * size, b = (range[1] * scale + shift) * size;
    const double low = fmax(floor(fmin(a, b)) - 1, 0), high = fmin(ceil(fmax(a, b)) + 1, size);
    if (!(low < high)) return false;
    *from = (uint32_t)fmax(*from, low), *to = (uint32_t)fmin(*to, high);
    return *from < *to;
}

/* Shrinks the bounds to what the ball covers. */
static bool clip_ball(const struct frame_block *block, const struct ball *ball, uvec4 *bounds) {
    const vec4 uv = block->uv_from_view;
    double x[2], y[2];
    return ball->depth + ball->radius > 0 && extent(ball->x, ball->depth, ball->radius, x) &&
           extent(ball->y, ball->depth, ball->radius, y) &&
           clip_pixels(x, (double)uv.x, (double)uv.z, block->size.x, &bounds->x, &bounds->z) &&
           clip_pixels(y, (double)uv.y, (double)uv.w, block->size.y, &bounds->y, &bounds->w);
}

static struct ball ball_at(const struct frame_block *block, const double place[3], double radius) {
    double view[3];
    for (int row = 0; row < 3; row++) {
        view[row] = 0;
        for (int c = 0; c < 3; c++) view[row] += (double)block->view_from_world.column[c][row] * place[c];
    }
    return (struct ball){view[0], view[1], (double)block->depth_range.z * view[2], radius * (1 + 1e-5) + 1e-6};
}

/* All that the lamp lights lies in the ball of its range, and, in a cone, in the ball through its apex and its rim. */
static uvec4 bounds_of(const struct frame_block *block, const struct glint_light *light, const double place[3],
                       double range) {
    uvec4 bounds = {0, 0, block->size.x, block->size.y};
    const uvec4 nothing = {0, 0, 0, 0};
    if (!(range < INFINITY)) return bounds;
    const struct ball all = ball_at(block, place, range);
    if (!clip_ball(block, &all, &bounds)) return nothing;
    if (!light->has_cone || !(cos(light->cone.outer_rad) > 0)) return bounds;
    const double cosine = cos(light->cone.outer_rad), sine = sin(light->cone.outer_rad);
    const bool narrow = cosine > sine;
    const double ahead = range * (narrow ? 0.5 / cosine : cosine), radius = range * (narrow ? 0.5 / cosine : sine);
    const double middle[3] = {place[0] + ahead * light->cone.axis[0], place[1] + ahead * light->cone.axis[1],
                              place[2] + ahead * light->cone.axis[2]};
    const struct ball cone = ball_at(block, middle, radius);
    return clip_ball(block, &cone, &bounds) ? bounds : nothing;
}

static uint64_t covered(uvec4 bounds) {
    return (uint64_t)(bounds.z - bounds.x) * (bounds.w - bounds.y);
}

static void set_lamp(struct frame_block *block, uint32_t at, const struct glint_light *light, const double place[3],
                     double range, double metres) {
    const struct glint_cone *cone = &light->cone;
    block->lamp_place[at] = (vec4){(float)place[0], (float)place[1], (float)place[2], (float)range};
    block->lamp_light[at] =
        (vec4){light->intensity[0], light->intensity[1], light->intensity[2], (float)(light->radius * metres)};
    block->lamp_axis[at] = (vec4){0, 0, 0, -1};
    block->lamp_cone[at] = (vec4){-2, -2, 0, 0};
    if (!light->has_cone) return;
    block->lamp_axis[at] = (vec4){(float)cone->axis[0], (float)cone->axis[1], (float)cone->axis[2], -1};
    block->lamp_cone[at] = (vec4){(float)cos(cone->inner_rad), (float)cos(cone->outer_rad), 0, 0};
}

void frame_block_lamps(struct frame_block *block, const struct glint_frame *frame, uint32_t number[LAMPS]) {
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    double eye[3], place[LAMPS][3], range[LAMPS];
    uvec4 bounds[LAMPS];
    uint32_t order[LAMPS];
    const uint32_t count = frame->light_count;
    glint_camera_position(&frame->camera, eye);
    for (uint32_t i = 0; i < count; i++) {
        const struct glint_light *light = &frame->lights[i];
        for (int c = 0; c < 3; c++) place[i][c] = (light->position[c] - eye[c]) * metres;
        range[i] = light->range > 0 ? light->range * metres : INFINITY;
        bounds[i] = bounds_of(block, light, place[i], range[i]);
        uint32_t at = i;
        for (; at > 0 && covered(bounds[order[at - 1]]) < covered(bounds[i]); at--) order[at] = order[at - 1];
        order[at] = i;
    }
    for (uint32_t at = 0; at < count; at++) {
        const uint32_t i = order[at];
        set_lamp(block, at, &frame->lights[i], place[i], range[i], metres);
        block->lamp_bounds[at] = bounds[i];
        number[i] = at;
    }
    block->lamps.x = count;
}
