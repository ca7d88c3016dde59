/* The scene lake: its water is in the plane of the mirror and above the G-buffer's bottom, and the mirrored camera sees points of that
   plane at the same positions as an unjittered camera of the frame. */
#include "support.h"

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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_water_lies_in_the_mirror),
                                       cmocka_unit_test(test_the_map_has_a_size_of_its_own)};
    return cmocka_run_group_tests_name("test_samples_water", tests, folder_make, folder_remove);
}
