/* mirror_box compared with its closed forms: the empty box 0..8 x 0..4 x 0..6 m with a mirror as floor and walls that emit (0.55 + 0.35
   sin(1.3x + 0.7y), 0.50 + 0.35 sin(1.1y + 0.9z), 0.55 + 0.35 sin(1.2z - 0.8x)). */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double box[3] = {8, 4, 6};

/* The parameter at which a ray from inside leaves the box, and the axis of the wall. */
static double leaves(const double from[3], const double direction[3], int *wall) {
    double nearest = INFINITY;
    for (int i = 0; i < 3; i++) {
        if (direction[i] == 0) continue;
        double t = ((direction[i] > 0 ? box[i] : 0) - from[i]) / direction[i];
        if (t < nearest) {
            nearest = t;
            *wall = i;
        }
    }
    return nearest;
}

static void pattern(const double p[3], double color[3]) {
    color[0] = 0.55 + 0.35 * sin(1.3 * p[0] + 0.7 * p[1]);
    color[1] = 0.50 + 0.35 * sin(1.1 * p[1] + 0.9 * p[2]);
    color[2] = 0.55 + 0.35 * sin(1.2 * p[2] - 0.8 * p[0]);
}

struct seen {
    double point[3], ray[3]; /* of the pixel */
    double mirrored[3], distance, hit[3];
    int wall, hit_wall;
    bool floor;
};

static struct seen trace_pixel(const struct glint_camera *camera, uint32_t x, uint32_t y, uint32_t width,
                               uint32_t height) {
    struct seen s = {0};
    double eye[3], length = 0;
    camera_eye(camera, eye);
    camera_ray(camera, x, y, width, height, s.ray);
    double t = leaves(eye, s.ray, &s.wall);
    for (int i = 0; i < 3; i++) {
        s.point[i] = eye[i] + t * s.ray[i];
        s.mirrored[i] = i == s.wall ? -s.ray[i] : s.ray[i];
        length += s.ray[i] * s.ray[i];
    }
    s.floor = s.wall == 1 && s.ray[1] < 0;
    s.distance = leaves(s.point, s.mirrored, &s.hit_wall) * sqrt(length);
    for (int i = 0; i < 3; i++) s.hit[i] = s.point[i] + s.distance / sqrt(length) * s.mirrored[i];
    return s;
}

enum { W = 96, H = 54, CUBE = 32 };

static struct glint_sample_options options(void) {
    return (struct glint_sample_options){.width = W,
                                         .height = H,
                                         .cube_size = CUBE,
                                         .truth_samples = 4,
                                         .probes_given = true,
                                         .probes = GLINT_PROBES_PERFECT};
}

static struct glint_capture *box_capture(void **state) {
    const char *path = in_folder(state, "box.exr");
    struct glint_sample_options o = options();
    write_sample("mirror_box", path, &o);
    return open_capture(path);
}

/* Positions are floats below 8: half a unit in the last place is 2.4e-7, and a few operations follow. */
static const double float_m = 5e-6;

static void test_depth_and_normal_of_every_pixel(void **state) {
    struct glint_capture *capture = box_capture(state);
    float *g = read_part(capture, "gbuffer", "depth.Z normal.X normal.Y normal.Z", NULL, NULL);
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            struct seen s = trace_pixel(&glint_capture_frame(capture)->camera, x, y, W, H);
            const float *p = g + 4 * (y * W + x);
            double eye[3], forward;
            camera_eye(&glint_capture_frame(capture)->camera, eye);
            forward = (s.point[0] - eye[0]) / s.ray[0];
            assert_true(fabs((double)p[0] - forward) <= float_m * 8);
            for (int i = 0; i < 3; i++) {
                double expected = i != s.wall ? 0 : s.ray[i] > 0 ? -1 : 1;
                if (fabs((double)p[1 + i] - expected) > 1e-6) { /* at an edge either wall is right */
                    double to_edge = INFINITY;
                    for (int k = 0; k < 3; k++)
                        if (k != s.wall) to_edge = fmin(to_edge, fmin(s.point[k], box[k] - s.point[k]));
                    assert_true(to_edge < 1e-5);
                }
            }
        }
    free(g);
    glint_capture_close(&capture);
}

static void test_lit_is_the_pattern_and_the_floor_is_black(void **state) {
    struct glint_capture *capture = box_capture(state);
    float *lit = read_part(capture, "lit", "R G B", NULL, NULL);
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            struct seen s = trace_pixel(&glint_capture_frame(capture)->camera, x, y, W, H);
            double color[3];
            pattern(s.point, color);
            for (int i = 0; i < 3; i++) /* stored as half floats: 11 bits below 1 */
                assert_true(fabs((double)lit[3 * (y * W + x) + (uint32_t)i] - (s.floor ? 0 : color[i])) <= 5e-4);
        }
    free(lit);
    glint_capture_close(&capture);
}

static void test_mirror_distance_of_every_pixel(void **state) {
    struct glint_capture *capture = box_capture(state);
    const struct glint_camera *camera = &glint_capture_frame(capture)->camera;
    float *mirror = read_part(capture, "truth.mirror", "distance.Z visible", NULL, NULL);
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            struct seen s = trace_pixel(camera, x, y, W, H);
            double length = sqrt(s.ray[0] * s.ray[0] + s.ray[1] * s.ray[1] + s.ray[2] * s.ray[2]), uv[2], eye[3];
            /* the ray starts up to 0.05 mm off the wall and hits the next wall with this cosine */
            double bound = 1e-4 / (fabs(s.ray[s.hit_wall]) / length) + float_m;
            assert_true(fabs((double)mirror[2 * (y * W + x)] - s.distance) <= bound);
            camera_project(camera, s.hit, uv);
            camera_eye(camera, eye);
            double ahead = 0;
            for (int i = 0; i < 3; i++) ahead -= camera->world_to_view[8 + i] * (s.hit[i] - eye[i]);
            double edge = fmin(fmin(uv[0], 1 - uv[0]), fmin(uv[1], 1 - uv[1]));
            if (fabs(edge) < 1e-3 || fabs(ahead) < 1e-2) continue; /* rounding decides there */
            assert_int_equal(mirror[2 * (y * W + x) + 1] > 0.5f, ahead > 0 && edge > 0);
        }
    free(mirror);
    glint_capture_close(&capture);
}

static void test_truth_of_the_mirror_is_what_the_hit_emits(void **state) {
    static const char *const lobes[] = {"truth.reflection.ggx", "truth.reflection.blinn_phong"};
    struct glint_capture *capture = box_capture(state);
    size_t floor_pixels = 0;
    for (int lobe = 0; lobe < 2; lobe++) {
        float *truth = read_part(capture, lobes[lobe], "R G B weight", NULL, NULL);
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) {
                struct seen s = trace_pixel(&glint_capture_frame(capture)->camera, x, y, W, H);
                const float *p = truth + 4 * (y * W + x);
                double color[3];
                if (!s.floor) continue;
                floor_pixels++;
                pattern(s.hit, color);
                for (int i = 0; i < 3;
                     i++) /* the pattern's slope is below 0.6 per metre; the hit moves by less than 1 mm */
                    assert_true(fabs((double)p[i] - color[i]) <= 6e-4);
                assert_true(p[3] == 1);
            }
        free(truth);
    }
    assert_true(floor_pixels > 2 * W * H / 8);
    glint_capture_close(&capture);
}

static void test_cube_distances_and_colours(void **state) {
    struct glint_capture *capture = box_capture(state);
    for (int map = 0; map < 8; map++) {
        char name[32];
        snprintf(name, sizeof name, "cubemap.%03d", map);
        const struct glint_part_info *info = glint_capture_find(capture, name);
        assert_non_null(info);
        float *texels = read_part(capture, name, "R G B A distance.Z", NULL, NULL);
        for (uint32_t face = 0; face < 6; face++)
            for (uint32_t y = 0; y < CUBE; y++)
                for (uint32_t x = 0; x < CUBE; x++) {
                    const float *p = texels + 5 * ((face * CUBE + y) * CUBE + x);
                    double d[3], hit[3], color[3];
                    int wall = 0;
                    vulkan_texel(face, x, y, CUBE, d);
                    double t = leaves(info->cubemap.center, d, &wall);
                    for (int i = 0; i < 3; i++) hit[i] = info->cubemap.center[i] + t * d[i];
                    assert_true(fabs((double)p[4] - t * sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])) <= 2 * float_m);
                    assert_true(p[3] == 1);
                    pattern(hit, color);
                    bool floor = wall == 1 && d[1] < 0;
                    for (int i = 0; i < 3; i++) assert_true(floor || fabs((double)p[i] - color[i]) <= 5e-4);
                }
        free(texels);
    }
    glint_capture_close(&capture);
}

static void test_motion_leads_to_the_previous_frame(void **state) {
    struct glint_capture *capture = box_capture(state);
    const struct glint_frame *frame = glint_capture_frame(capture);
    float *motion = read_part(capture, "gbuffer", "motion.X motion.Y motion.Z", NULL, NULL);
    double largest = 0, nearer = 0;
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            struct seen s = trace_pixel(&frame->camera, x, y, W, H);
            double uv[2], now[2] = {(x + 0.5) / W, (y + 0.5) / H};
            camera_project(&frame->previous, s.point, uv);
            for (int i = 0; i < 2; i++) {
                double expected = uv[i] - now[i];
                largest = fmax(largest, fabs(expected));
                /* stored as half floats: relative 2^-11, absolute 2^-25 */
                assert_true(fabs((double)motion[3 * (y * W + x) + (uint32_t)i] - expected) <=
                            fabs(expected) / 2048 + 1e-6);
            }
            const double *rows[2] = {frame->camera.world_to_view, frame->previous.world_to_view};
            double depth[2];
            for (int k = 0; k < 2; k++)
                depth[k] =
                    -(rows[k][8] * s.point[0] + rows[k][9] * s.point[1] + rows[k][10] * s.point[2] + rows[k][11]);
            nearer = fmax(nearer, fabs(depth[1] - depth[0]));
            assert_true(fabs((double)motion[3 * (y * W + x) + 2] - (depth[1] - depth[0])) <=
                        fabs(depth[1] - depth[0]) / 2048 + 1e-5);
        }
    assert_true(largest > 0.005 && nearer > 0.005); /* the camera did move */
    free(motion);
    glint_capture_close(&capture);
}

static void test_previous_frame_is_the_frame_before(void **state) {
    struct glint_sample_options o = options();
    o.truth_samples = 0;
    const char *one = in_folder(state, "one.exr"), *two = in_folder(state, "two.exr");
    o.first_frame = 4;
    write_sample("mirror_box", one, &o);
    o.first_frame = 5;
    write_sample("mirror_box", two, &o);
    struct glint_capture *a = open_capture(one), *b = open_capture(two);
    float *now = read_part(a, "gbuffer", "depth.Z normal.X motion.X", NULL, NULL);
    float *before = read_part(b, "previous.gbuffer", "depth.Z normal.X motion.X", NULL, NULL);
    assert_memory_equal(now, before, 3 * W * H * sizeof *now);
    assert_memory_equal(&glint_capture_frame(a)->camera, &glint_capture_frame(b)->previous,
                        sizeof(struct glint_camera));
    free(now);
    free(before);
    glint_capture_close(&a);
    glint_capture_close(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_depth_and_normal_of_every_pixel, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_lit_is_the_pattern_and_the_floor_is_black, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_mirror_distance_of_every_pixel, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_truth_of_the_mirror_is_what_the_hit_emits, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_cube_distances_and_colours, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_motion_leads_to_the_previous_frame, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_previous_frame_is_the_frame_before, folder_make, folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
