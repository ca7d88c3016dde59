/* A G-buffer with packed motion and depth of 16 bits each, and vertex normals in two bytes. It is encoded by inverting the formulas of
   FORMAT.md in double; bounds are half a step of the storage. */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "encoded.h"
#include "unit.h"

enum { COUNT = FIX_W * FIX_H };

static void packed_motion_with_depth(UNUSED void **state) {
    char path[512];
    static float out[3 * COUNT];
    static const char *const names[] = {"motion.X", "motion.Y", "motion.Z"};
    struct glint_frame frame = fixture_frame();
    frame.motion_depth_range = 3;
    const double range[3] = {frame.motion_range, frame.motion_range, frame.motion_depth_range},
                 unit[3] = {1, 1, frame.metres_per_unit};
    for (size_t i = 0; i < COUNT; i++)
        for (int a = 0; a < 3; a++)
            ((uint16_t *)encoded_bits[a])[i] =
                (uint16_t)lround((double)fixture.gbuffer[17 * i + 10 + (size_t)a] / range[a] * 32767 + 32768);
    const struct glint_encodings encodings = {.motion = GLINT_MOTION_PACKED16,
                                              .motion_depth = GLINT_MOTION_DEPTH_PACKED16};
    struct glint_capture *capture = encoded_capture(fixture_path(path, "motion_depth.exr"), "gbuffer", &encodings,
                                                    names, 3, GLINT_U16, NULL, &frame);
    encoded_read(capture, "gbuffer", names, 3, out);
    for (size_t i = 0; i < COUNT; i++)
        for (int a = 0; a < 3; a++) {
            const double moved = (double)fixture.gbuffer[17 * i + 10 + (size_t)a] * unit[a];
            const double bound = range[a] * unit[a] / 65534 * 1.000001 + fabs(moved) * ldexp(1, -23);
            assert_true(fabs((double)out[3 * i + (size_t)a] - moved) <= bound);
        }
    glint_capture_close(&capture);
    unlink(path);
}

/* Normals in two bytes, next to normals in world space. */
static void check_view_xy(double sign, const char *part) {
    char path[512];
    static float out[3 * COUNT];
    static double view[COUNT][3];
    static const char *const names[] = {"vertexNormal.X", "vertexNormal.Y", "vertexNormal.Z"};
    struct glint_frame frame = fixture_frame();
    struct glint_camera *camera = strcmp(part, "gbuffer") ? &frame.previous : &frame.camera;
    camera->view_to_clip[10] *= sign * camera->view_to_clip[14];
    camera->view_to_clip[14] = sign;
    const double *m = camera->world_to_view;
    for (size_t i = 0; i < COUNT; i++) {
        const float *w = fixture.gbuffer + 17 * i + 13;
        for (int a = 0; a < 3; a++)
            view[i][a] = m[4 * a] * (double)w[0] + m[4 * a + 1] * (double)w[1] + m[4 * a + 2] * (double)w[2];
        for (int a = 0; a < 2; a++) ((uint8_t *)encoded_bits[a])[i] = (uint8_t)lround((view[i][a] + 1) / 2 * 255);
    }
    const struct glint_encodings encodings = {.vertex_normal = GLINT_NORMAL_VIEW_XY};
    struct glint_capture *capture =
        encoded_capture(fixture_path(path, "view_xy.exr"), part, &encodings, names, 2, GLINT_UNORM8, NULL, &frame);
    assert_true(glint_part_has_channel(glint_capture_find(capture, part), names[2]));
    encoded_read(capture, part, names, 3, out);
    /* Half a step of 8 bits in half floats: x and y are off by up to δ, so z is between the values of points of the circle up to √2 δ
       away. Normalising normals that 8 bits place outside of the circle moves x and y by another √2 δ. */
    const double delta = 2 * (0.5 / 255 + ldexp(1, -11)) + 4 * ldexp(1, -23);
    size_t away = 0;
    for (size_t i = 0; i < COUNT; i++) {
        double got[3] = {0}, length = 0;
        for (int a = 0; a < 3; a++) {
            for (int k = 0; k < 3; k++) got[a] += m[4 * a + k] * (double)out[3 * i + (size_t)k];
            length += got[a] * got[a];
        }
        assert_true(fabs(length - 1) < 1e-5);
        const double across = hypot(view[i][0], view[i][1]), toward = -sign * got[2];
        const double low = sqrt(fmax(1 - pow(across + sqrt(2) * delta, 2), 0)),
                     high = sqrt(1 - pow(fmax(across - sqrt(2) * delta, 0), 2));
        for (int a = 0; a < 2; a++) assert_true(fabs(got[a] - view[i][a]) <= (1 + sqrt(2)) * delta);
        assert_true(toward >= low - 1e-5 && toward <= high + 1e-5);
        away += view[i][2] * sign > 0; /* the sign cannot be stored */
    }
    assert_true(away > COUNT / 8 && away < COUNT - COUNT / 8);
    glint_capture_close(&capture);
    unlink(path);
}

static void vertex_normals_in_two_bytes(UNUSED void **state) {
    for (double sign = -1; sign <= 1; sign += 2) {
        check_view_xy(sign, "gbuffer");
        check_view_xy(sign, "previous.gbuffer");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_motion_with_depth),
        cmocka_unit_test(vertex_normals_in_two_bytes),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
