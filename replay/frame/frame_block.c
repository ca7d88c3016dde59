/* Fills the uniform block. World positions are made relative to the camera in double before they become floats. */
#include "frame_block.h"

#include <math.h>
#include <string.h>

#include "glint/replay.h"

int up_axis(enum glint_axis up, double *sign) {
    static const struct {
        int axis;
        double sign;
    } axes[] = {[GLINT_AXIS_X] = {0, 1},      [GLINT_AXIS_Y] = {1, 1},      [GLINT_AXIS_Z] = {2, 1},
                [GLINT_AXIS_NEG_X] = {0, -1}, [GLINT_AXIS_NEG_Y] = {1, -1}, [GLINT_AXIS_NEG_Z] = {2, -1}};
    *sign = axes[up].sign;
    return axes[up].axis;
}

static void fill_rotation(mat4 *view_from_world, mat4 *world_from_view, const double m[16]) {
    memset(view_from_world, 0, sizeof *view_from_world);
    memset(world_from_view, 0, sizeof *world_from_view);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            view_from_world->column[column][row] = (float)m[4 * row + column];
            world_from_view->column[row][column] = (float)m[4 * row + column];
        }
    view_from_world->column[3][3] = world_from_view->column[3][3] = 1;
}

/* For a point p relative to this camera in metres: previous view = R'·(p/u + eye) + t', times u metres a unit. */
static void fill_previous(mat4 *out, const double previous[16], const double eye[3], double metres) {
    memset(out, 0, sizeof *out);
    for (int row = 0; row < 3; row++) {
        const double *m = previous + 4 * row;
        for (int column = 0; column < 3; column++) out->column[column][row] = (float)m[column];
        out->column[3][row] = (float)((m[0] * eye[0] + m[1] * eye[1] + m[2] * eye[2] + m[3]) * metres);
    }
    out->column[3][3] = 1;
}

struct projection {
    double a, b, c, d, front;
};

/* In front of the camera clip w = front · view z is positive, so depth = front · view z and NDC x = a · view.x / depth + c · front. */
static struct projection projection_of(const struct glint_camera *camera) {
    const double *p = camera->view_to_clip;
    double front = p[14] < 0 ? -1 : 1;
    return (struct projection){p[0], p[5], p[2] * front, p[6] * front, front};
}

/* uv = view.xy / depth · scale + offset: u = (NDC x + 1)/2, v = (1 ∓ NDC y)/2 with v = 0 at the top. */
static vec4 uv_from_view(const struct projection *p, enum glint_clip_y clip_y) {
    double down = clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1;
    return (vec4){(float)(p->a / 2), (float)(down * p->b / 2), (float)((1 + p->c) / 2), (float)((1 + down * p->d) / 2)};
}

static vec4 view_from_uv(const struct projection *p, enum glint_clip_y clip_y) {
    double down = clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1;
    return (vec4){(float)(2 / p->a), (float)(down * 2 / p->b), (float)(-(1 + p->c) / p->a),
                  (float)(-(down + p->d) / p->b)};
}

/* Depth at which NDC z is `ndc`: (A·s·d + B)/d = ndc. */
static double depth_at(const struct glint_camera *camera, double front, double ndc) {
    double slope = ndc - camera->view_to_clip[10] * front, depth = camera->view_to_clip[11] / slope;
    return fabs(slope) < 1e-12 || depth < 0 || depth > 1e9 ? INFINITY : depth;
}

static void fill_fog(struct frame_block *block, const struct glint_frame *frame, const double eye[3], double metres) {
    double sign;
    int axis = up_axis(frame->up, &sign);
    float up[3] = {0};
    up[axis] = (float)sign;
    block->up = (vec4){up[0], up[1], up[2], 0};
    const double scale = frame->material.metal_reflectance;
    block->material =
        (vec4){frame->has_material && scale > 0 ? (float)scale : 1, frame->has_fog && frame->fog.adds, 0, 0};
    if (!frame->has_fog) return;
    const struct glint_fog *fog = &frame->fog;
    block->fog_color = (vec4){fog->color[0], fog->color[1], fog->color[2], (float)(fog->density / metres)};
    block->fog_height =
        (vec4){(float)((eye[axis] * sign - fog->base) * metres), (float)(fog->scale_height * metres), 0, 0};
}

/* The matrix maps a point p relative to this camera, in metres, to uv · depth and depth of the mirrored camera, whose view position is
   R'·(p/u + eye) + t', times u metres a unit. */
void frame_block_mirror(struct frame_block *block, const struct glint_frame *frame, const struct glint_planar *planar) {
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    const struct projection p = projection_of(&planar->camera);
    const vec4 uv = uv_from_view(&p, frame->clip_y);
    double eye[3], offset = planar->plane[3], length = 0;
    glint_camera_position(&frame->camera, eye);
    mat4 view;
    fill_previous(&view, planar->camera.world_to_view, eye, metres);
    for (int c = 0; c < 4; c++) {
        const float depth = (float)p.front * view.column[c][2];
        block->mirror_uv_from_world.column[c][0] = uv.x * view.column[c][0] + uv.z * depth;
        block->mirror_uv_from_world.column[c][1] = uv.y * view.column[c][1] + uv.w * depth;
        block->mirror_uv_from_world.column[c][2] = block->mirror_uv_from_world.column[c][3] = depth;
    }
    for (int i = 0; i < 3; i++) offset += planar->plane[i] * eye[i], length += planar->plane[i] * planar->plane[i];
    length = sqrt(length);
    block->mirror_plane = (vec4){(float)(planar->plane[0] / length), (float)(planar->plane[1] / length),
                                 (float)(planar->plane[2] / length), (float)(offset / length * metres)};
}

/* As shaders compare ids with a class: (id & y) == x. */
static uvec4 class_ids(const struct glint_stencil_class *class) {
    return (uvec4){class->value, class->mask ? class->mask : UINT32_MAX, 1, 0};
}

/* The map of the sun, or of any lamp, with the lowest number from `number` on. */
static const struct glint_part_info *next_map(const struct glint_part_info *const parts[], size_t count, bool of_lamp,
                                              int32_t number) {
    const struct glint_part_info *found = NULL;
    for (size_t i = 0; i < count; i++)
        if (parts[i]->shadow.has_light == of_lamp && parts[i]->index >= number &&
            (!found || parts[i]->index < found->index))
            found = parts[i];
    return found;
}

size_t frame_choose_maps(const struct glint_part_info *const parts[], size_t count,
                         const struct glint_part_info *maps[SHADOW_MAPS]) {
    size_t chosen = 0, rows = 0;
    for (int of_lamp = 0; of_lamp < 2; of_lamp++) {
        const size_t most = of_lamp ? SHADOW_MAPS : SUN_MAPS;
        const struct glint_part_info *map = next_map(parts, count, of_lamp, 0);
        for (; map && chosen < most && rows + map->height <= SHADOW_ROWS;
             map = next_map(parts, count, of_lamp, map->index + 1)) {
            rows += map->height;
            maps[chosen++] = map;
        }
    }
    return chosen;
}

size_t frame_shadow_maps(const struct glint_capture *capture, const struct glint_part_info *maps[SHADOW_MAPS]) {
    enum { MOST = 1024 }; /* parts are numbered to 999 */
    const struct glint_part_info *parts[MOST];
    size_t count = 0;
    for (size_t i = 0; i < glint_capture_part_count(capture) && count < MOST; i++) {
        parts[count] = glint_capture_part(capture, i);
        count += parts[count]->has_shadow;
    }
    return frame_choose_maps(parts, count, maps);
}

/* A point p in metres, relative to this camera, is at eye + p/u in the world. The map's x and y are in [-1, 1]. */
static void fill_shadow(struct frame_block *block, size_t k, const struct glint_frame *frame,
                        const struct glint_shadow *shadow) {
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    const double down = frame->clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1, *m = shadow->world_to_shadow;
    double eye[3];
    glint_camera_position(&frame->camera, eye);
    for (int c = 0; c < 4; c++) {
        double of[4];
        for (int r = 0; r < 4; r++)
            of[r] = c < 3 ? m[4 * r + c] / metres
                          : m[4 * r] * eye[0] + m[4 * r + 1] * eye[1] + m[4 * r + 2] * eye[2] + m[4 * r + 3];
        float *column = block->shadow_uv_from_world[k].column[c];
        column[0] = (float)(0.5 * (of[3] + of[0]));
        column[1] = (float)(0.5 * (of[3] + down * of[1]));
        column[2] = (float)of[2];
        column[3] = (float)of[3];
    }
    const bool falls = shadow->range[0] > shadow->range[1];
    block->shadow_depth[k] = (vec4){falls ? -1 : 1, (float)shadow->bias, 0, 0};
}

void frame_block_shadows(struct frame_block *block, const struct glint_capture *capture, const uint32_t number[LAMPS]) {
    const struct glint_part_info *maps[SHADOW_MAPS];
    const struct glint_frame *frame = glint_capture_frame(capture);
    const size_t count = frame_shadow_maps(capture, maps);
    uint32_t row = 0;
    for (size_t k = 0; k < count; row += maps[k++]->height) {
        const struct glint_shadow *shadow = &maps[k]->shadow;
        fill_shadow(block, k, frame, shadow);
        block->shadow_place[k] = (uvec4){0, row, maps[k]->width, maps[k]->height};
        if (shadow->has_stencil_class) block->shadow_class[k] = class_ids(&frame->classes[shadow->stencil_class]);
        if (!shadow->has_light) continue;
        const uint32_t lamp = number[shadow->light];
        block->shadow_class[k].w = 1 + lamp;
        if (block->lamp_axis[lamp].w < 0) block->lamp_axis[lamp].w = (float)k;
    }
}

static vec4 metres_of(const double units[3], const double from[3], double metres) {
    return (vec4){(float)((units[0] - from[0]) * metres), (float)((units[1] - from[1]) * metres),
                  (float)((units[2] - from[2]) * metres), 0};
}

void frame_block_captured_light(struct frame_block *block, const struct glint_capture *capture) {
    const struct glint_part_info *part = glint_capture_find(capture, GLINT_PART_INDIRECT);
    block->captured_light.x = part && part->has_indirect && part->indirect.occluded;
    const struct glint_frame *frame = glint_capture_frame(capture);
    if (frame->has_lut_stops) block->lut_stops = (vec4){(float)frame->lut_stops[0], (float)frame->lut_stops[1], 1, 0};
    block->captured_light.y = (float)frame->exposure;
}

void frame_block_far(struct frame_block *block, const struct glint_capture *capture) {
    static const double RADIANS = 3.14159265358979324 / 180, origin[3];
    const struct glint_frame *frame = glint_capture_frame(capture);
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    const struct glint_part_info *sky = glint_capture_find(capture, GLINT_PART_SKY), *levels[GLINT_MAX_LEVELS];
    double roughness[GLINT_MAX_LEVELS], eye[3];
    const size_t count = glint_capture_probe(capture, 0, levels, roughness);
    const struct glint_probe *probe = count ? &levels[0]->probe : NULL;
    const bool has_ground = probe ? probe->has_ground : sky && sky->sky.has_ground;
    const double ground = probe ? probe->ground : sky ? sky->sky.ground : 0;
    block->far_light = (vec4){(float)count, probe && probe->has_box, has_ground ? (float)sin(ground * RADIANS) : -2, 0};
    if (!probe) return;
    for (size_t l = 0; l < count; l++) block->probe_roughness.column[l / 4][l % 4] = (float)roughness[l];
    if (!probe->has_box && !block->counts.w) block->counts.w = levels[0]->width;
    if (!probe->has_box) return;
    glint_camera_position(&frame->camera, eye);
    block->probe_center = metres_of(probe->box.center, eye, metres);
    block->probe_low = metres_of(probe->box.min, origin, metres);
    block->probe_high = metres_of(probe->box.max, origin, metres);
}

void frame_block_grid(struct frame_block *block, const struct glint_frame *frame,
                      const struct glint_part_info *volume) {
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    block->grid = (uvec4){GRID_CELLS, GRID_CELLS, GRID_CELLS, 0};
    if (!volume) return;
    const double *to_grid = volume->volume.world_to_grid;
    double eye[3];
    glint_camera_position(&frame->camera, eye);
    for (int r = 0; r < 4; r++) {
        double at_eye = to_grid[4 * r + 3];
        for (int c = 0; c < 3; c++) {
            block->grid_from_world.column[c][r] = (float)(to_grid[4 * r + c] / metres);
            at_eye += to_grid[4 * r + c] * eye[c];
        }
        block->grid_from_world.column[3][r] = (float)at_eye;
    }
    block->grid = (uvec4){volume->width, volume->height / volume->volume.slices, volume->volume.slices, 1};
}

void frame_block_froxels(struct frame_block *block, const struct glint_frame *frame,
                         const struct glint_part_info *froxels) {
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    if (!froxels) return;
    const struct glint_froxels *slices = &froxels->froxels;
    block->froxels = (uvec4){froxels->width, froxels->height / slices->slices, slices->slices, 1};
    block->froxel_range =
        (vec4){(float)(slices->near_depth * metres), (float)(slices->far_depth * metres), slices->exponential, 0};
}

static void fill_sun(struct frame_block *block, const struct glint_frame *frame) {
    const struct glint_sun *sun = &frame->sun;
    if (!frame->has_sun) return;
    block->sun_direction = (vec4){(float)sun->direction[0], (float)sun->direction[1], (float)sun->direction[2],
                                  (float)sun->angular_radius_rad};
    block->sun_irradiance = (vec4){sun->irradiance[0], sun->irradiance[1], sun->irradiance[2], 0};
}

static double part_of(double place_m, double side_m) {
    return place_m / side_m - floor(place_m / side_m);
}

/* Atmosphere and clouds. Clouds repeat, so that a camera far from the origin is somewhere in a square near it. */
static void fill_air(struct frame_block *block, const struct glint_frame *frame, const double eye[3], double metres) {
    const struct glint_atmosphere *air = &frame->atmosphere;
    const struct glint_clouds *clouds = &frame->clouds;
    double sign, across[2];
    const int axis = up_axis(frame->up, &sign);
    if (frame->has_atmosphere) {
        const float *sun = air->irradiance, *r = air->rayleigh;
        const double height = air->rayleigh_height > 0 ? air->rayleigh_height : 8000;
        block->atmosphere =
            (vec4){(float)air->planet_radius, (float)air->top, (float)((eye[axis] * sign - air->ground) * metres), 0};
        block->sun_above = (vec4){sun[0], sun[1], sun[2], 0};
        block->rayleigh = (vec4){r[0], r[1], r[2], (float)height};
        block->mie = (vec4){(float)air->mie, (float)air->mie_extinction,
                            (float)(air->mie_height > 0 ? air->mie_height : 1200), (float)air->mie_asymmetry};
    }
    if (!frame->has_clouds) return;
    const double noise = clouds->noise_tile > 0 ? clouds->noise_tile : 1000;
    for (int i = 0, k = 0; i < 3; i++)
        if (i != axis) across[k] = eye[i] * metres - clouds->offset[k], k++;
    block->cloud_layer = (vec4){(float)clouds->bottom, (float)clouds->top,
                                (float)((eye[axis] * sign - clouds->ground) * metres), (float)clouds->extinction};
    block->cloud_tile = (vec4){(float)clouds->tile, (float)noise, (float)clouds->erosion, 0};
    block->cloud_place = (vec4){(float)part_of(across[0], clouds->tile), (float)part_of(across[1], clouds->tile),
                                (float)part_of(across[0], noise), (float)part_of(across[1], noise)};
}

static uvec4 class_of(const struct glint_frame *frame, const char *name) {
    for (uint32_t i = 0; i < frame->class_count; i++)
        if (strcmp(frame->classes[i].name, name) == 0) return class_ids(&frame->classes[i]);
    return (uvec4){0, 0, 0, 0};
}

void frame_block_fill(struct frame_block *block, const struct glint_frame *frame, const struct frame_sizes *sizes) {
    const double metres = frame->metres_per_unit > 0 ? frame->metres_per_unit : 1;
    double eye[3];
    memset(block, 0, sizeof *block); /* padding included, since the block is hashed */
    glint_camera_position(&frame->camera, eye);
    fill_rotation(&block->view_from_world, &block->world_from_view, frame->camera.world_to_view);
    const struct projection p = projection_of(&frame->camera);
    block->view_from_uv = view_from_uv(&p, frame->clip_y);
    block->uv_from_view = uv_from_view(&p, frame->clip_y);
    const struct glint_camera *previous = frame->has_previous ? &frame->previous : &frame->camera;
    const struct projection q = projection_of(previous);
    fill_previous(&block->previous_view_from_world, previous->world_to_view, eye, metres);
    block->previous_uv_from_view = uv_from_view(&q, frame->clip_y);
    double lowest = frame->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? -1 : 0;
    double one = depth_at(&frame->camera, p.front, lowest), other = depth_at(&frame->camera, p.front, 1);
    block->depth_range =
        (vec4){(float)(fmin(one, other) * metres), (float)(fmax(one, other) * metres), (float)p.front, (float)q.front};
    fill_fog(block, frame, eye, metres);
    fill_sun(block, frame);
    fill_air(block, frame, eye, metres);
    block->size = (uvec4){sizes->full[0], sizes->full[1], sizes->half[0], sizes->half[1]};
    block->counts = (uvec4){sizes->active, frame->number, sizes->cube_face, sizes->sky_face};
    block->flags = (uvec4){sizes->history, frame->cut, sizes->chain, 0};
    block->foreground = class_of(frame, "foreground");
    block->overlaid = class_of(frame, "decal");
    block->skin = class_of(frame, "skin");
    block->jitter = (vec4){(float)frame->jitter_px[0], (float)frame->jitter_px[1], 0, 0};
}

void glint_frame_directions(const struct glint_frame *frame, double matrix[3][3]) {
    struct frame_block block;
    frame_block_fill(&block, frame, &(struct frame_sizes){0});
    const vec4 view = block.view_from_uv;
    const double from_uv[3][3] = {
        {(double)view.x, 0, (double)view.z}, {0, (double)view.y, (double)view.w}, {0, 0, (double)block.depth_range.z}};
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            matrix[row][column] = 0;
            for (int k = 0; k < 3; k++)
                matrix[row][column] += (double)block.world_from_view.column[k][row] * from_uv[k][column];
        }
}
