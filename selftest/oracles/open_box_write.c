/* The box as a capture. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracles/open_box_internal.h"

enum { CHANNELS = 16 };

/* One part's planes: what `at` says of each of its pixels, stored as floats, or as integers where the encoding has them. */
struct layer {
    const char *name;
    const char *channels[CHANNELS];
    size_t count;
    size_t first_integer, end_integer;
    uint32_t width, height;
    const struct glint_cubemap *cubemap;
    void (*at)(const struct open_box *c, const struct layer *layer, uint32_t x, uint32_t y, double *out);
};

static bool add_layer(struct glint_writer *writer, const struct open_box *c, const struct layer *layer,
                      struct glint_error *err) {
    const size_t pixels = (size_t)layer->width * layer->height;
    float *planes = malloc(pixels * layer->count * sizeof *planes);
    uint32_t *integers = malloc(pixels * (layer->end_integer - layer->first_integer + 1) * sizeof *integers);
    struct glint_channel channels[CHANNELS] = {{0}};
    bool ok = (planes && integers) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; ok && i < pixels; i++) {
        double values[CHANNELS] = {0};
        layer->at(c, layer, (uint32_t)(i % layer->width), (uint32_t)(i / layer->width), values);
        for (size_t k = 0; k < layer->count; k++) planes[k * pixels + i] = (float)values[k];
    }
    for (size_t k = 0; ok && k < layer->count; k++) {
        float *plane = planes + k * pixels;
        if (c->change) c->change(c->user, layer->name, layer->channels[k], plane, layer->width, layer->height);
        channels[k] = (struct glint_channel){.name = layer->channels[k], .type = GLINT_F32, .data = plane};
        if (k < layer->first_integer || k >= layer->end_integer) continue;
        uint32_t *whole = integers + (k - layer->first_integer) * pixels;
        for (size_t i = 0; i < pixels; i++) whole[i] = (uint32_t)plane[i];
        channels[k].type = GLINT_U32, channels[k].data = whole;
    }
    const struct glint_part part = {.name = layer->name,
                                    .width = layer->width,
                                    .height = layer->height,
                                    .channels = channels,
                                    .channel_count = layer->count,
                                    .encodings = c->encodings,
                                    .cubemap = layer->cubemap};
    ok = ok && glint_writer_add_part(writer, &part, err);
    free(planes);
    free(integers);
    return ok;
}

/* ---- The picture ---- */

static void at_gbuffer(const struct open_box *c, const struct layer *layer, uint32_t x, uint32_t y, double *out) {
    static const double normals[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    const double place[2] = {x + 0.5, y + 0.5};
    double point[3], before[2], depth, depth_before, normal[3], motion[3] = {0};
    int face;
    const enum open_box_surface seen = open_box_view_hit(c, place, &depth, point, &face);
    const bool floor = seen == OPEN_BOX_FLOOR;
    *out++ = (double)open_box_encode_depth(c, depth);
    open_box_encode_normal(c, normals[face], normal);
    for (size_t k = 0; k < 3; k++)
        if (strncmp(layer->channels[1 + k], "normal.", 7) == 0) *out++ = normal[k];
    *out++ = open_box_encode_roughness(c, (double)c->roughness);
    *out++ = floor;                                          /* metalness */
    *out++ = floor ? 1 : 0;                                  /* specular: walls and sky reflect nothing */
    for (int k = 0; k < 3; k++) *out++ = floor ? 0.95 : 0.5; /* albedo */
    if (c->still) return;
    open_box_project_point(c, true, point, seen == OPEN_BOX_SKY ? 0 : 1, before, &depth_before);
    const double uv[2] = {(before[0] - place[0]) / c->width, (before[1] - place[1]) / c->height};
    open_box_encode_motion(c, uv, seen == OPEN_BOX_SKY ? 0 : depth_before - depth, motion);
    for (int k = 0; k < 3; k++) *out++ = motion[k];
}

static void light_of(const struct open_box *c, enum open_box_surface seen, const double point[3], double rgb[3]) {
    if (seen == OPEN_BOX_SKY) open_box_sky(c, point, rgb);
    else if (seen == OPEN_BOX_WALL) open_box_light(c, point, rgb);
    else rgb[0] = rgb[1] = rgb[2] = 0;
}

static void at_lit(const struct open_box *c, const struct layer *layer, uint32_t x, uint32_t y, double *out) {
    (void)layer;
    double point[3], depth;
    int face;
    const enum open_box_surface seen = open_box_view_hit(c, (double[2]){x + 0.5, y + 0.5}, &depth, point, &face);
    light_of(c, seen, point, out);
    open_box_encode_color(c, out);
}

static bool add_picture(struct glint_writer *writer, const struct open_box *c, struct glint_error *err) {
    static const char *const rest[] = {"material.roughness", "material.metalness", "material.specular",
                                       "albedo.R",           "albedo.G",           "albedo.B",
                                       "motion.X",           "motion.Y",           "motion.Z"};
    const bool two = c->encodings.normal >= GLINT_NORMAL_OCTAHEDRAL; /* without Z */
    struct layer layer = {.name = "gbuffer",
                          .channels = {"depth.Z", "normal.X", "normal.Y", "normal.Z"},
                          .count = two ? 3 : 4,
                          .width = c->width,
                          .height = c->height,
                          .at = at_gbuffer};
    for (size_t k = 0; k < (c->still ? 6u : 9u); k++) layer.channels[layer.count++] = rest[k];
    layer.first_integer = layer.count - (c->encodings.motion == GLINT_MOTION_PACKED16 ? 3 : 1);
    layer.end_integer = layer.count - (c->encodings.motion_depth == GLINT_MOTION_DEPTH_PACKED16 ? 0 : 1);
    if (c->still) layer.end_integer = layer.first_integer;
    bool ok = add_layer(writer, c, &layer, err);
    const char *const colors[] = {"lit", "scene"};
    for (size_t i = 0; ok && i < 2; i++)
        ok = add_layer(writer, c,
                       &(struct layer){.name = colors[i],
                                       .channels = {"R", "G", "B"},
                                       .count = 3,
                                       .width = c->width,
                                       .height = c->height,
                                       .at = at_lit},
                       err);
    return ok;
}

/* ---- Cube maps ---- */

static const double centers[OPEN_BOX_CUBES][3] = {{2.1, 1.3, 1.6}, {5.8, 1.4, 1.7}, {2.2, 1.5, 4.4}, {5.9, 1.2, 4.3}};

void open_box_center(const struct open_box *c, const char *part, double center[3]) {
    const int number = atoi(strchr(part, '.') + 1);
    memcpy(center, centers[c->cubes_reversed ? OPEN_BOX_CUBES - 1 - number : number], sizeof centers[0]);
}

/* In the box's axes; faces and their orientation are the engine's. */
static void cube_direction(const struct open_box *c, uint32_t size, uint32_t x, uint32_t y, double out[3]) {
    const double u = 2 * (x + 0.5) / size - 1, v = 2 * (y % size + 0.5) / size - 1;
    const double faces[6][3] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
    const double *d = faces[y / size];
    for (int k = 0; k < 3; k++) out[k] = c->axes[k] < 0 ? -d[-c->axes[k] - 1] : d[c->axes[k] - 1];
}

static void at_cube(const struct open_box *c, const struct layer *layer, uint32_t x, uint32_t y, double *out) {
    double from[3], direction[3], point[3], length = 0;
    int face;
    open_box_center(c, layer->name, from);
    cube_direction(c, layer->width, x, y, direction);
    const double t = open_box_exit(from, direction, &face);
    for (int k = 0; k < 3; k++) {
        point[k] = from[k] + t * direction[k];
        length += direction[k] * direction[k];
    }
    const enum open_box_surface seen = open_box_surface_of(face);
    if (seen != OPEN_BOX_SKY) light_of(c, seen, point, out); /* the sky is black here, so that levels can be made */
    open_box_encode_color(c, out);
    out[3] = seen != OPEN_BOX_SKY;
    out[4] = seen == OPEN_BOX_SKY ? INFINITY : t * sqrt(length) * c->scale / c->metres_per_unit;
}

static void at_sky(const struct open_box *c, const struct layer *layer, uint32_t x, uint32_t y, double *out) {
    double direction[3];
    cube_direction(c, layer->width, x, y, direction);
    open_box_sky(c, direction, out);
    open_box_encode_color(c, out);
}

/* Of the box to a place in the engine's world. */
static void place_in_world(const struct open_box *c, const double p[3], double out[3]) {
    open_box_to_engine(c, p, out);
    for (int k = 0; k < 3; k++) out[k] = (out[k] * c->scale + c->offset_m[k]) / c->metres_per_unit;
}

static bool add_cube(struct glint_writer *writer, const struct open_box *c, int number, struct glint_error *err) {
    struct glint_cubemap cube = {.inner = GLINT_VOLUME_BOX};
    double center[3], corners[2][3], out[2][3];
    char name[32];
    snprintf(name, sizeof name, "cubemap.%03d", number);
    open_box_center(c, name, center);
    for (int k = 0; k < 3; k++) corners[0][k] = -1, corners[1][k] = 1; /* all around is air */
    place_in_world(c, center, cube.center);
    for (int i = 0; i < 2; i++) open_box_to_engine(c, corners[i], out[i]);
    for (int k = 0; k < 3; k++) {
        cube.box_min[k] = fmin(out[0][k], out[1][k]) * c->scale / c->metres_per_unit;
        cube.box_max[k] = fmax(out[0][k], out[1][k]) * c->scale / c->metres_per_unit;
    }
    return add_layer(writer, c,
                     &(struct layer){.name = name,
                                     .channels = {"R", "G", "B", "A", "distance.Z"},
                                     .count = 5,
                                     .width = c->cube_size,
                                     .height = 6 * c->cube_size,
                                     .cubemap = &cube,
                                     .at = at_cube},
                     err);
}

/* ---- The frame ---- */

static void fill_camera(const struct open_box *c, bool previous, struct glint_camera *camera) {
    const struct open_box_projection p = open_box_project(c);
    const double front = c->depth_grows ? 1 : -1, unit = c->scale / c->metres_per_unit;
    const double down = c->clip_y == GLINT_CLIP_Y_DOWN ? -1 : 1;
    double rows[3][3], eye[3], at[3], a, b;
    open_box_view_rows(c, rows);
    open_box_eye(c, previous, eye);
    place_in_world(c, eye, at);
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) {
            camera->world_to_view[4 * r + k] = rows[r][k];
            camera->world_to_view[4 * r + 3] -= rows[r][k] * at[k];
        }
    camera->world_to_view[15] = 1;
    open_box_clip_depth(c, &a, &b);
    double *m = camera->view_to_clip;
    m[0] = p.scale[0] * (c->x_left ? -1 : 1);
    m[2] = p.shift[0] * front;
    m[5] = p.scale[1] * (c->y_down ? -1 : 1) * down;
    m[6] = p.shift[1] * front * down;
    m[10] = a * front;
    m[11] = b * unit;
    m[14] = front;
}

static struct glint_frame frame_of(const struct open_box *c) {
    static const enum glint_axis ups[2][3] = {{GLINT_AXIS_X, GLINT_AXIS_Y, GLINT_AXIS_Z},
                                              {GLINT_AXIS_NEG_X, GLINT_AXIS_NEG_Y, GLINT_AXIS_NEG_Z}};
    const double unit = c->scale / c->metres_per_unit;
    struct glint_frame frame = {.has_previous = !c->still,
                                .jitter_px = {c->jitter_px[0], c->jitter_px[1]},
                                .pre_exposure = c->pre_exposure,
                                .metres_per_unit = c->metres_per_unit,
                                .depth_near = c->near_m * unit,
                                .depth_far = c->far_m < INFINITY ? c->far_m * unit : 0,
                                .number = c->frame,
                                .cut = c->cut,
                                .up = ups[c->axes[1] < 0][abs(c->axes[1]) - 1],
                                .clip_y = c->clip_y,
                                .clip_z = c->clip_z};
    fill_camera(c, false, &frame.camera);
    fill_camera(c, true, &frame.previous);
    return frame;
}

bool open_box_write(const struct open_box *box, const char *path, struct glint_error *err) {
    const struct open_box c = open_box_filled(box);
    const struct glint_frame frame = frame_of(&c);
    remove(path);
    struct glint_writer *writer =
        glint_writer_create(path, &(struct glint_writer_options){.compression = GLINT_NONE, .threads = 1}, err);
    bool ok = writer && glint_writer_set_frame(writer, &frame, err) && add_picture(writer, &c, err);
    for (int i = 0; ok && i < OPEN_BOX_CUBES; i++) ok = add_cube(writer, &c, i, err);
    ok = ok &&
         add_layer(writer, &c,
                   &(struct layer){.name = "sky",
                                   .channels = {"R", "G", "B"},
                                   .count = 3,
                                   .width = c.cube_size,
                                   .height = 6 * c.cube_size,
                                   .at = at_sky},
                   err) &&
         glint_writer_finish(writer, err);
    glint_writer_destroy(&writer);
    return ok;
}
