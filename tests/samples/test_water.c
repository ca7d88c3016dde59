/* The scene lake: its water is in the plane of the mirror and above the G-buffer's bottom, and the mirrored camera sees points of that
   plane at the same positions as an unjittered camera of the frame. */
#include "support.h"
#include "water.h"

#include <math.h>
#include <stdlib.h>

enum { W = 96, H = 54 };

static void test_water_lies_in_the_mirror(void **state) {
    for (int moved = 0; moved < 2; moved++) {
        struct glint_sample_options o = {.width = W,
                                         .height = H,
                                         .cube_size = 16,
                                         .light_samples = 4,
                                         .unjittered = true,
                                         .planar_width = 32,
                                         .planar_height = 18};
        if (moved) o.offset[0] = 1e6, o.offset[1] = 250, o.encodings.depth = GLINT_DEPTH_LOGARITHMIC_REVERSED;
        const char *path = in_folder(state, moved ? "moved.exr" : "lake.exr");
        write_sample("lake", path, &o);
        struct glint_capture *capture = open_capture(path);
        const struct glint_planar *planar = &glint_capture_find(capture, "planar.000")->planar;
        const struct glint_frame *frame = glint_capture_frame(capture);
        float *water = read_part(capture, "water", "opacity depth.Z thickness.Z normal.Y", NULL, NULL);
        float *depth = read_part(capture, "gbuffer", "depth.Z", NULL, NULL);
        double eye[3];
        size_t wet = 0, dry = 0;
        camera_eye(&frame->camera, eye);
        for (uint32_t i = 0; i < W * H; i++) {
            const float *w = water + 4 * (size_t)i;
            if (!(w[0] > 0)) {
                dry++;
                assert_true(isinf(w[1]) && w[2] == 0);
                continue;
            }
            wet++;
            double ray[3], point[3], uv[2], length = 0, off = planar->plane[3];
            camera_ray(&frame->camera, i % W, i / W, W, H, ray);
            for (int k = 0; k < 3; k++) {
                point[k] = eye[k] + (double)w[1] * ray[k];
                length += ray[k] * ray[k];
                off += planar->plane[k] * point[k];
            }
            /* at most 80 m away; logarithmic depth of 4000 to 1 in 32 bits has a precision of 1e-6, as a float */
            assert_true(fabs(off) < 1e-4);
            assert_true(w[1] < depth[i] && w[3] > 0.9f);
            if (depth[i] < 1000) /* thickness is a half float */
                assert_true(fabs((double)w[2] - (double)(depth[i] - w[1]) * sqrt(length)) < 1e-3 * (double)w[2] + 1e-3);
            camera_project(&planar->camera, point, uv);
            assert_true(fabs(uv[0] - (i % W + 0.5) / W) < 1e-5 && fabs(uv[1] - (i / W + 0.5) / H) < 1e-5);
        }
        assert_true(wet > W * H / 4 && dry > W * H / 4);
        free(water), free(depth);
        glint_capture_close(&capture);
    }
}

/* A map of another size shows the same, and a scene without water has none of these parts. */
static void test_the_map_has_a_size_of_its_own(void **state) {
    struct glint_sample_options o = {.width = W, .height = H, .cube_size = 16, .light_samples = 4};
    write_sample("lake", in_folder(state, "default.exr"), &o);
    write_sample("matte", in_folder(state, "matte.exr"), &o);
    struct glint_capture *lake = open_capture(in_folder(state, "default.exr")),
                         *matte = open_capture(in_folder(state, "matte.exr"));
    assert_int_equal(glint_capture_find(lake, "planar.000")->width, 240);
    assert_int_equal(glint_capture_find(lake, "planar.000")->height, 120);
    assert_non_null(glint_capture_find(lake, "scene"));
    assert_null(glint_capture_find(matte, "planar.000"));
    assert_null(glint_capture_find(matte, "water"));
    glint_capture_close(&lake);
    glint_capture_close(&matte);
}

/* How much more of the sun's light arrives at a point of the bottom than under a level surface: rays that enter the water on a fine grid are refracted,
   and counted where they come nearer to the point than RADIUS. */
static double counted(const struct water *water, const double sun[3], const double point[3]) {
    enum { GRID = 600 };
    const double RADIUS = 0.03, STEP = 0.001, eta = 1 / 1.333;
    const double sine = eta * hypot(sun[0], sun[2]), deep = -point[1], back = deep / sqrt(1 - sine * sine) * eta;
    double hits = 0;
    for (int i = 0; i < GRID * GRID; i++) { /* about where the ray through the point enters level water */
        const double x = point[0] + back * sun[0] + STEP * (i % GRID - GRID / 2),
                     z = point[2] + back * sun[2] + STEP * (i / GRID - GRID / 2);
        const vec3 n = water_normal(water, v3((float)x, 0, (float)z));
        const double normal[3] = {(double)n.x, (double)n.y, (double)n.z};
        const double in = sun[0] * normal[0] + sun[1] * normal[1] + sun[2] * normal[2];
        const double bent = eta * in - sqrt(1 - eta * eta * (1 - in * in));
        double ray[3];
        for (int k = 0; k < 3; k++) ray[k] = bent * normal[k] - eta * sun[k];
        hits += hypot(x + deep * ray[0] / -ray[1] - point[0], z + deep * ray[2] / -ray[1] - point[2]) < RADIUS;
    }
    return hits * STEP * STEP / (acos(-1) * RADIUS * RADIUS);
}

/* A disc of 2,827 grid points is off by about the number on its rim, 2 %; over its 3 cm the light of waves of up to 14 rad/m changes by a fortieth of its
   variation. Half floats add 2^-11 of the albedo and of the light. The surface bends light by little, so that no disc is reached from far away. */
static void test_caustics_are_focused_light(void **state) {
    const struct water water = {.there = true, .ripple = 0.03F}; /* as lake has it, at the height 0 */
    struct glint_sample_options o = {
        .width = W, .height = H, .cube_size = 16, .light_samples = 4, .also = GLINT_ALSO_CAUSTICS | GLINT_ALSO_SUN};
    const char *path = in_folder(state, "caustics.exr");
    write_sample("lake", path, &o);
    struct glint_capture *capture = open_capture(path);
    const struct glint_frame *frame = glint_capture_frame(capture);
    float *light = read_part(capture, "water.caustics", "G", NULL, NULL),
          *surface = read_part(capture, "gbuffer", "depth.Z normal.X normal.Y normal.Z albedo.G", NULL, NULL),
          *wet = read_part(capture, "water", "opacity", NULL, NULL),
          *sun = read_part(capture, "sun", "visibility", NULL, NULL);
    double eye[3], worst = 0;
    int bright = 0, dark = 0;
    camera_eye(&frame->camera, eye);
    for (uint32_t i = 0; i < W * H; i++) {
        const float *s = surface + 5 * (size_t)i;
        if (!(wet[i] > 0)) assert_true(light[i] == 0 || s[0] < INFINITY);
        if (sun[i] == 0) assert_true(light[i] == 0);
        if (!(wet[i] > 0 && sun[i] > 0) || i % 37 != 0 || bright + dark == 24) continue;
        double ray[3], point[3], cosine = 0;
        camera_ray(&frame->camera, i % W, i / W, W, H, ray);
        for (int k = 0; k < 3; k++) point[k] = eye[k] + (double)s[0] * ray[k];
        for (int k = 0; k < 3; k++) cosine += (double)s[1 + k] * frame->sun.direction[k];
        if (point[1] > -0.3 || !(cosine > 0.1)) continue;
        const double whole = (double)s[4] * (double)frame->sun.irradiance[1] * cosine / acos(-1);
        const double more = counted(&water, frame->sun.direction, point) - 1;
        worst = fmax(worst, fabs((double)light[i] / whole - fmax(more, 0)));
        bright += more > 0.1, dark += more < -0.05;
        assert_true(fabs((double)light[i] / whole - fmax(more, 0)) < 0.04 + 0.025 * fabs(more));
    }
    print_message("# %d places brighter and %d darker than under level water, off by %.3f at most\n", bright, dark,
                  worst);
    assert_true(bright > 4 && dark > 4);
    free(light), free(surface), free(wet), free(sun);
    glint_capture_close(&capture);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_water_lies_in_the_mirror),
                                       cmocka_unit_test(test_the_map_has_a_size_of_its_own),
                                       cmocka_unit_test(test_caustics_are_focused_light)};
    return cmocka_run_group_tests_name("test_samples_water", tests, folder_make, folder_remove);
}
