/* The uniform block compared with matrix products in double: random cameras, mirrored ones, both clip conventions. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "frame_block.h"
#include "uniform.h"
#include "unit.h"

static void transform(const double m[16], const double in[4], double out[4]) {
    for (int r = 0; r < 4; r++)
        out[r] = m[4 * r] * in[0] + m[4 * r + 1] * in[1] + m[4 * r + 2] * in[2] + m[4 * r + 3] * in[3];
}

static void apply(const mat4 *m, const double in[4], double out[4]) {
    for (int r = 0; r < 4; r++) {
        out[r] = 0;
        for (int c = 0; c < 4; c++) out[r] += (double)m->column[c][r] * in[c];
    }
}

/* A rotation from a random quaternion, optionally with a mirrored axis, and a random eye. */
static void random_camera(uint64_t *state, bool mirror, double front, double far_from_origin,
                          struct glint_camera *camera, double eye[3]) {
    double q[4], length = 0;
    for (int i = 0; i < 4; i++) q[i] = uniform(state) - 0.5, length += q[i] * q[i];
    for (int i = 0; i < 4; i++) q[i] /= sqrt(length);
    const double w = q[0], x = q[1], y = q[2], z = q[3], flip = mirror ? -1 : 1;
    const double rotation[9] = {
        flip * (1 - 2 * (y * y + z * z)), flip * 2 * (x * y - w * z), flip * 2 * (x * z + w * y), 2 * (x * y + w * z),
        1 - 2 * (x * x + z * z),          2 * (y * z - w * x),        2 * (x * z - w * y),        2 * (y * z + w * x),
        1 - 2 * (x * x + y * y)};
    memset(camera, 0, sizeof *camera);
    for (int i = 0; i < 3; i++) eye[i] = far_from_origin + 10 * (uniform(state) - 0.5);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) camera->world_to_view[4 * r + c] = rotation[3 * r + c];
        for (int c = 0; c < 3; c++) camera->world_to_view[4 * r + 3] -= rotation[3 * r + c] * eye[c];
    }
    camera->world_to_view[15] = 1;
    camera->view_to_clip[0] = 0.5 + uniform(state);
    camera->view_to_clip[2] = 0.1 * (uniform(state) - 0.5);
    camera->view_to_clip[5] = 0.5 + uniform(state);
    camera->view_to_clip[6] = 0.1 * (uniform(state) - 0.5);
    camera->view_to_clip[10] = front, camera->view_to_clip[11] = -0.1, camera->view_to_clip[14] = front;
}

static void fill_block(struct frame_block *block, const struct glint_frame *frame) {
    const struct frame_sizes sizes = {.full = {100, 50}, .half = {50, 25}, .active = 3, .chain = 2, .cube_face = 16};
    frame_block_fill(block, frame, &sizes);
}

/* uv by the definition of captures: clip = view_to_clip · world_to_view · world. */
static bool project(const struct glint_camera *camera, enum glint_clip_y clip_y, const double world[3], double uv[2]) {
    const double point[4] = {world[0], world[1], world[2], 1};
    double view[4], clip[4];
    transform(camera->world_to_view, point, view);
    transform(camera->view_to_clip, view, clip);
    if (clip[3] < 0.05) return false;
    uv[0] = (clip[0] / clip[3] + 1) / 2;
    uv[1] = clip_y == GLINT_CLIP_Y_UP ? (1 - clip[1] / clip[3]) / 2 : (clip[1] / clip[3] + 1) / 2;
    return true;
}

static void the_mirror_projects_as_its_camera_says(UNUSED void **unused) {
    uint64_t state = 2;
    int checked = 0;
    for (int n = 0; n < 200; n++) {
        struct glint_frame frame = {.metres_per_unit = n & 1 ? 0.01 : 1,
                                    .clip_y = n & 2 ? GLINT_CLIP_Y_DOWN : GLINT_CLIP_Y_UP};
        struct glint_planar planar = {.plane = {0, 3, 4, 0}};
        struct frame_block block;
        double eye[3], mirrored[3], world[3], uv[2], clip[4], view[4];
        random_camera(&state, n & 4, n & 8 ? 1 : -1, 0, &frame.camera, eye);
        random_camera(&state, n & 4, n & 8 ? 1 : -1, 0, &planar.camera, mirrored);
        planar.plane[3] = -3 * eye[1] - 4 * eye[2] + 10; /* two units from the eye */
        fill_block(&block, &frame);
        assert_true(block.mirror_plane.x == 0 && block.mirror_uv_from_world.column[3][3] == 0);
        frame_block_mirror(&block, &frame, &planar);
        assert_true(fabs((double)block.mirror_plane.w - 2 * frame.metres_per_unit) < 1e-5 &&
                    fabs((double)block.mirror_plane.y - 0.6) < 1e-6);
        for (int i = 0; i < 3; i++) world[i] = mirrored[i] + 8 * (uniform(&state) - 0.5);
        if (!project(&planar.camera, frame.clip_y, world, uv)) continue;
        const double relative[4] = {(world[0] - eye[0]) * frame.metres_per_unit,
                                    (world[1] - eye[1]) * frame.metres_per_unit,
                                    (world[2] - eye[2]) * frame.metres_per_unit, 1};
        const double point[4] = {world[0], world[1], world[2], 1};
        apply(&block.mirror_uv_from_world, relative, clip);
        transform(planar.camera.world_to_view, point, view);
        const double depth = fabs(view[2]) * frame.metres_per_unit;
        /* floats of coordinates below 100, divided by depth */
        assert_true(fabs(clip[3] - depth) < 1e-5 && clip[2] == clip[3]);
        assert_true(fabs(clip[0] / clip[3] - uv[0]) < 1e-5 * (1 + fabs(uv[0])) / fmin(1, depth));
        assert_true(fabs(clip[1] / clip[3] - uv[1]) < 1e-5 * (1 + fabs(uv[1])) / fmin(1, depth));
        checked++;
    }
    assert_true(checked > 50);
}

static void points_project_as_the_matrices_say(UNUSED void **unused) {
    uint64_t state = 1;
    int checked = 0;
    for (int n = 0; n < 400; n++) {
        struct glint_frame frame = {.metres_per_unit = n & 1 ? 0.01 : 1,
                                    .clip_y = n & 2 ? GLINT_CLIP_Y_DOWN : GLINT_CLIP_Y_UP,
                                    .has_previous = true};
        struct frame_block block;
        double eye[3], previous_eye[3], world[3], uv[2], previous_uv[2];
        const double distance = n & 16 ? 1e6 : 0;
        random_camera(&state, n & 4, n & 8 ? 1 : -1, distance, &frame.camera, eye);
        random_camera(&state, n & 4, n & 8 ? 1 : -1, distance, &frame.previous, previous_eye);
        fill_block(&block, &frame);
        for (int i = 0; i < 3; i++) world[i] = eye[i] + 8 * (uniform(&state) - 0.5);
        const double relative[4] = {(world[0] - eye[0]) * frame.metres_per_unit,
                                    (world[1] - eye[1]) * frame.metres_per_unit,
                                    (world[2] - eye[2]) * frame.metres_per_unit, 1};
        double view[4], back[4];
        apply(&block.view_from_world, relative, view);
        apply(&block.world_from_view, view, back);
        /* floats of the block have a precision of 6e-8, and lengths and coordinates here are below 100 */
        for (int i = 0; i < 3; i++) assert_true(fabs(back[i] - relative[i]) < 1e-5);
        if (project(&frame.camera, frame.clip_y, world, uv)) {
            const double depth = view[2] * (double)block.depth_range.z;
            assert_true(depth > 0);
            assert_true(fabs(view[0] / depth * (double)block.uv_from_view.x + (double)block.uv_from_view.z - uv[0]) <
                        1e-5 * (1 + fabs(uv[0])));
            assert_true(fabs(view[1] / depth * (double)block.uv_from_view.y + (double)block.uv_from_view.w - uv[1]) <
                        1e-5 * (1 + fabs(uv[1])));
            assert_true(fabs((uv[0] * (double)block.view_from_uv.x + (double)block.view_from_uv.z) * depth - view[0]) <
                        1e-5 * (1 + fabs(uv[0])) * (1 + depth));
            assert_true(fabs((uv[1] * (double)block.view_from_uv.y + (double)block.view_from_uv.w) * depth - view[1]) <
                        1e-5 * (1 + fabs(uv[1])) * (1 + depth));
            checked++;
        }
        if (project(&frame.previous, frame.clip_y, world, previous_uv)) {
            apply(&block.previous_view_from_world, relative, view);
            const double depth = view[2] * (double)block.depth_range.w;
            assert_true(fabs(view[0] / depth * (double)block.previous_uv_from_view.x +
                             (double)block.previous_uv_from_view.z - previous_uv[0]) <
                        1e-4 * (1 + fabs(previous_uv[0])));
            assert_true(fabs(view[1] / depth * (double)block.previous_uv_from_view.y +
                             (double)block.previous_uv_from_view.w - previous_uv[1]) <
                        1e-4 * (1 + fabs(previous_uv[1])));
        }
    }
    assert_true(checked > 100);
}

static void the_depth_range_is_that_of_the_projection(UNUSED void **unused) {
    const double n = 0.25, f = 400;
    const struct {
        enum glint_clip_z z;
        double a, b, near, far;
    } cases[] = {
        {GLINT_CLIP_Z_ZERO_TO_ONE, f / (f - n), -n * f / (f - n), n, f},
        {GLINT_CLIP_Z_ZERO_TO_ONE, -n / (f - n), n * f / (f - n), n, f}, /* reversed */
        {GLINT_CLIP_Z_ZERO_TO_ONE, 0, n, n, INFINITY},                   /* reversed, infinite */
        {GLINT_CLIP_Z_ZERO_TO_ONE, 1, -n, n, INFINITY},
        {GLINT_CLIP_Z_MINUS_ONE_TO_ONE, (f + n) / (f - n), -2 * n * f / (f - n), n, f},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int front = -1; front <= 1; front += 2) {
            struct glint_frame frame = {.clip_z = cases[i].z, .metres_per_unit = 0.5};
            struct frame_block block;
            frame.camera.world_to_view[0] = frame.camera.world_to_view[5] = frame.camera.world_to_view[10] = 1;
            frame.camera.view_to_clip[0] = frame.camera.view_to_clip[5] = 1;
            frame.camera.view_to_clip[10] = cases[i].a * front;
            frame.camera.view_to_clip[11] = cases[i].b;
            frame.camera.view_to_clip[14] = front;
            fill_block(&block, &frame);
            assert_true(fabs((double)block.depth_range.x - cases[i].near / 2) < 1e-6);
            if (isinf(cases[i].far)) assert_true(isinf(block.depth_range.y));
            else assert_true(fabs((double)block.depth_range.y - cases[i].far / 2) < 1e-3);
            assert_true((int)block.depth_range.z == front);
        }
}

static void a_frame_far_from_the_origin_has_the_same_block(UNUSED void **unused) {
    uint64_t one = 5, other = 5;
    struct glint_frame near = {.has_previous = true,
                               .has_fog = true,
                               .fog = {.density = 0.1, .base = 1, .scale_height = 30}},
                       far = near;
    struct frame_block a, b;
    double eye[3];
    random_camera(&one, false, -1, 0, &near.camera, eye), random_camera(&one, false, -1, 0, &near.previous, eye);
    random_camera(&other, false, -1, 1e6, &far.camera, eye), random_camera(&other, false, -1, 1e6, &far.previous, eye);
    far.fog.base += 1e6;
    fill_block(&a, &near), fill_block(&b, &far);
    const float *x = (const float *)&a, *y = (const float *)&b;
    for (size_t i = 0; i < offsetof(struct frame_block, size) / sizeof(float); i++)
        if (x[i] != y[i])
            assert_true(fabsf(x[i] - y[i]) <= 1e-6f * (1 + fabsf(x[i]))); /* 1e6 in double has a precision of 1e-10 */
}

/* An engine's matrices with rotations in floats, which are orthonormal to 1e-7 only: the previous position of a static point follows
   from these matrices, although the world is 1,000 km wide. */
static void rotations_in_floats_do_not_move_the_camera(UNUSED void **unused) {
    uint64_t state = 9;
    for (int n = 0; n < 60; n++) {
        static const double distances[] = {0, 1e5, 1e6};
        struct glint_frame frame = {.has_previous = true};
        double eye[3], previous_eye[3], view[4], exact[4];
        random_camera(&state, n & 1, -1, distances[n % 3], &frame.camera, eye);
        frame.previous = frame.camera;
        for (int i = 0; i < 3; i++) previous_eye[i] = eye[i] + uniform(&state) - 0.5;
        struct glint_camera *const cameras[] = {&frame.camera, &frame.previous};
        for (int c = 0; c < 2; c++)
            for (int i = 0; i < 3; i++) {
                double *row = cameras[c]->world_to_view + 4 * i;
                for (int k = 0; k < 3; k++) row[k] = (double)(float)row[k];
                row[3] = 0;
                for (int k = 0; k < 3; k++) row[3] -= row[k] * (c ? previous_eye : eye)[k];
            }
        struct frame_block block;
        fill_block(&block, &frame);
        for (int p = 0; p < 20; p++) {
            const double relative[4] = {8 * uniform(&state) - 4, 8 * uniform(&state) - 4, 8 * uniform(&state) - 4, 1};
            const double world[4] = {relative[0] + eye[0], relative[1] + eye[1], relative[2] + eye[2], 1};
            transform(frame.previous.world_to_view, world, exact);
            apply(&block.previous_view_from_world, relative, view);
            /* lengths below 8 m in floats; a camera moved by 12 mm is off by that much */
            for (int i = 0; i < 3; i++) assert_true(fabs(view[i] - exact[i]) < 4e-6);
        }
    }
}

static void fog_and_up_are_in_metres(UNUSED void **unused) {
    struct glint_frame frame = {.metres_per_unit = 0.01,
                                .up = GLINT_AXIS_NEG_Z,
                                .has_fog = true,
                                .fog = {.color = {1, 2, 3}, .density = 0.0002, .base = 100, .scale_height = 5000}};
    struct frame_block block;
    frame.camera.world_to_view[0] = frame.camera.world_to_view[5] = frame.camera.world_to_view[10] = 1;
    frame.camera.world_to_view[11] = 700; /* the eye is at z = -700, at a height of 700 */
    frame.camera.view_to_clip[0] = frame.camera.view_to_clip[5] = frame.camera.view_to_clip[14] = 1;
    fill_block(&block, &frame);
    assert_true(block.up.z == -1 && block.up.x == 0 && block.up.y == 0);
    assert_true(fabsf(block.fog_color.w - 0.02f) < 1e-7f);
    assert_true(fabsf(block.fog_height.x - 6) < 1e-5f);
    assert_true(fabsf(block.fog_height.y - 50) < 1e-4f);
}

/* The world's axes and units of light are the block's; without a sun, what a capture's struct holds otherwise does not count. */
static void the_sun_is_as_the_capture_says(UNUSED void **unused) {
    struct glint_frame frame = {
        .metres_per_unit = 0.01,
        .sun = {.direction = {0.48, 0.6, -0.64}, .angular_radius_rad = 0.25, .irradiance = {3, 2, 1}}};
    struct frame_block block;
    for (int i = 0; i < 3; i++)
        frame.camera.world_to_view[4 * i + (i + 1) % 3] = 1; /* a third of a turn about the diagonal */
    frame.camera.view_to_clip[0] = frame.camera.view_to_clip[5] = frame.camera.view_to_clip[14] = 1;
    fill_block(&block, &frame);
    assert_true(block.sun_direction.x == 0 && block.sun_direction.w == 0 && block.sun_irradiance.x == 0);
    frame.has_sun = true;
    fill_block(&block, &frame);
    assert_true(block.sun_direction.x == 0.48f && block.sun_direction.y == 0.6f && block.sun_direction.z == -0.64f);
    assert_true(block.sun_direction.w == 0.25f);
    assert_true(block.sun_irradiance.x == 3 && block.sun_irradiance.y == 2 && block.sun_irradiance.z == 1);
}

/* Altitudes count along the axis that points up from the ground, which is in units; the wind moves clouds along the other two. Their places keep
   millimetres at 1,000 km from the origin. */
static void air_is_where_the_world_says(UNUSED void **unused) {
    static const struct {
        enum glint_axis up;
        int axis, across[2];
        double sign;
    } ups[] = {{GLINT_AXIS_X, 0, {1, 2}, 1},      {GLINT_AXIS_Y, 1, {0, 2}, 1},      {GLINT_AXIS_Z, 2, {0, 1}, 1},
               {GLINT_AXIS_NEG_X, 0, {1, 2}, -1}, {GLINT_AXIS_NEG_Y, 1, {0, 2}, -1}, {GLINT_AXIS_NEG_Z, 2, {0, 1}, -1}};
    const double eye[3] = {1e8 + 12.5, -1e8 - 700, 1e8 + 33}; /* cm */
    for (size_t i = 0; i < sizeof ups / sizeof *ups; i++) {
        struct glint_frame frame = {
            .metres_per_unit = 0.01, .up = ups[i].up, .has_atmosphere = true, .has_clouds = true};
        struct frame_block block;
        for (int k = 0; k < 3; k++)
            frame.camera.world_to_view[5 * k] = 1, frame.camera.world_to_view[4 * k + 3] = -eye[k];
        frame.camera.world_to_view[15] = 1;
        frame.camera.view_to_clip[0] = frame.camera.view_to_clip[5] = 1, frame.camera.view_to_clip[14] = -1;
        frame.camera.view_to_clip[10] = -1, frame.camera.view_to_clip[11] = -0.1;
        const double along = ups[i].sign * eye[ups[i].axis];
        frame.atmosphere = (struct glint_atmosphere){.planet_radius = 6e6,
                                                     .ground = along - 200,
                                                     .top = 5e4,
                                                     .irradiance = {1, 2, 3},
                                                     .rayleigh = {4, 5, 6},
                                                     .mie = 7};
        frame.clouds = (struct glint_clouds){.ground = along - 300,
                                             .bottom = 1000,
                                             .top = 1500,
                                             .tile = 7000,
                                             .extinction = 0.5,
                                             .offset = {12345, -54321}};
        fill_block(&block, &frame);
        assert_true(block.atmosphere.x == 6e6F && block.atmosphere.y == 5e4F && fabsf(block.atmosphere.z - 2) < 1e-5F);
        assert_true(block.sun_above.z == 3 && block.rayleigh.y == 5 && block.rayleigh.w == 8000);
        assert_true(block.mie.x == 7 && block.mie.y == 0 && block.mie.z == 1200 && block.mie.w == 0);
        assert_true(block.cloud_layer.x == 1000 && block.cloud_layer.y == 1500 &&
                    fabsf(block.cloud_layer.z - 3) < 1e-5F);
        assert_true(block.cloud_layer.w == 0.5F && block.cloud_tile.x == 7000 && block.cloud_tile.y == 1000);
        const float found[4] = {block.cloud_place.x, block.cloud_place.y, block.cloud_place.z, block.cloud_place.w};
        for (int k = 0; k < 4; k++) {
            const double side = k < 2 ? 7000 : 1000,
                         place = 0.01 * eye[ups[i].across[k % 2]] - frame.clouds.offset[k % 2],
                         away = remainder(place - (double)found[k] * side, side);
            assert_true(found[k] >= 0 && found[k] <= 1 && fabs(away) < 1e-3);
        }
    }
}

/* Catches: a class whose value and mask change places, or are taken for one another; a mask of 0 compares the whole id. */
static void classes_have_a_value_and_a_mask(UNUSED void **unused) {
    const struct glint_frame frame = {
        .metres_per_unit = 1,
        .classes = {{1, 2, "other"}, {4, 6, "foreground"}, {16, 0x30, "decal"}, {9, 0, "skin"}},
        .class_count = 4};
    struct frame_block block;
    fill_block(&block, &frame);
    const uvec4 found[] = {block.foreground, block.overlaid, block.skin};
    static const uint32_t expected[3][4] = {{4, 6, 1, 0}, {16, 0x30, 1, 0}, {9, UINT32_MAX, 1, 0}};
    for (int k = 0; k < 3; k++) {
        const uint32_t values[4] = {found[k].x, found[k].y, found[k].z, found[k].w};
        assert_memory_equal(values, expected[k], sizeof values);
    }
}

/* std140 as in the shader: offsets in a block of 16-byte members. */
static void the_layout_is_std140(UNUSED void **unused) {
    assert_int_equal(offsetof(struct frame_block, world_from_view), 64);
    assert_int_equal(offsetof(struct frame_block, view_from_uv), 192);
    assert_int_equal(sizeof(struct frame_block) % 16, 0);
}

/* Catches: rows of another map counted, a map beyond the last row, lamps before the sun, maps in the order of the parts. */
static void maps_are_chosen_by_their_rows(void **state) {
    (void)state;
    static const struct {
        uint32_t heights[4]; /* of the maps 3, 2, 1, 0, of which the first two are a lamp's */
        size_t chosen;
    } cases[] = {{{10000, 1, 1, 4096}, 4}, {{2287, 1, 10000, 4096}, 4}, {{2288, 1, 10000, 4096}, 3}, /* 16385 rows */
                 {{1, 16384, 1, 1}, 2},    {{1, 1, 16384, 1}, 3}, /* without the sun's second one, with the lamp's */
                 {{1, 1, 1, 16385}, 2}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct glint_part_info infos[4];
        const struct glint_part_info *parts[4], *maps[SHADOW_MAPS];
        memset(infos, 0, sizeof infos);
        for (int i = 0; i < 4; i++) {
            infos[i].index = 3 - i;
            infos[i].height = cases[c].heights[i];
            infos[i].shadow.has_light = i < 2;
            parts[i] = &infos[i];
        }
        const size_t chosen = frame_choose_maps(parts, 4, maps);
        if (chosen != cases[c].chosen) fail_msg("case %zu: %zu maps", c, chosen);
        uint64_t rows = 0;
        for (size_t k = 0; k < chosen; k++) {
            rows += maps[k]->height;
            assert_true(
                k == 0 || maps[k]->shadow.has_light > maps[k - 1]->shadow.has_light ||
                (maps[k]->shadow.has_light == maps[k - 1]->shadow.has_light && maps[k]->index > maps[k - 1]->index));
        }
        assert_true(rows <= SHADOW_ROWS);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mirror_projects_as_its_camera_says),
        cmocka_unit_test(points_project_as_the_matrices_say),
        cmocka_unit_test(the_depth_range_is_that_of_the_projection),
        cmocka_unit_test(a_frame_far_from_the_origin_has_the_same_block),
        cmocka_unit_test(rotations_in_floats_do_not_move_the_camera),
        cmocka_unit_test(fog_and_up_are_in_metres),
        cmocka_unit_test(the_sun_is_as_the_capture_says),
        cmocka_unit_test(air_is_where_the_world_says),
        cmocka_unit_test(maps_are_chosen_by_their_rows),
        cmocka_unit_test(classes_have_a_value_and_a_mask),
        cmocka_unit_test(the_layout_is_std140),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
