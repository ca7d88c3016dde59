/* Cameras whose rotation an engine stored as floats, at the origin and far from it: the intended position is recovered, rotations are
   orthonormal, and notes contain only effects that are visible. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

/* An engine's matrix: the rotation in floats, and the translation computed from it in double. */
static struct glint_camera camera_in_floats(const double eye[3], bool mirrored) {
    struct glint_camera camera = fixture_camera(eye, 0.1, 500);
    double *m = camera.world_to_view;
    for (int i = 0; i < 3; i++) {
        float row[3];
        for (int k = 0; k < 3; k++) row[k] = (float)(mirrored && i == 0 ? -m[k] : m[4 * i + k]);
        for (int k = 0; k < 3; k++) m[4 * i + k] = (double)row[k];
        m[4 * i + 3] = -(m[4 * i] * eye[0] + m[4 * i + 1] * eye[1] + m[4 * i + 2] * eye[2]);
    }
    return camera;
}

static struct glint_frame read_back(const struct glint_frame *frame, const char *name) {
    char path[512];
    struct glint_error err = {0};
    struct glint_writer *writer = glint_writer_create(fixture_path(path, name), NULL, &err);
    struct fixture_channels channels;
    assert_non_null(writer);
    assert_true(glint_writer_set_frame(writer, frame, &err));
    for (int i = 0; i <= FIXTURE_LIT; i++) {
        const struct glint_part part = fixture_part(&fixture, (enum fixture_part)i, &channels);
        assert_true(glint_writer_add_part(writer, &part, &err));
    }
    if (!glint_writer_finish(writer, &err)) fail_msg("%s", err.message);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    const struct glint_frame found = *glint_capture_frame(capture);
    glint_capture_close(&capture);
    unlink(path);
    return found;
}

static double distance(const double a[3], const double b[3]) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static double off_rotation(const double *m) {
    double largest = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            largest = fmax(largest, fabs(m[4 * i] * m[4 * j] + m[4 * i + 1] * m[4 * j + 1] +
                                         m[4 * i + 2] * m[4 * j + 2] - (i == j)));
    return largest;
}

static void cameras_stand_where_the_engine_put_them(UNUSED void **unused) {
    static const double kilometres[] = {0, 100, 1000};
    for (size_t k = 0; k < sizeof kilometres / sizeof *kilometres; k++)
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            const double far = 1000 * kilometres[k], eye[3] = {far + 1, 2 - 0.25 * far, 3 + 0.5 * far};
            const double previous[3] = {eye[0] - 0.125, eye[1], eye[2] + 0.25};
            struct glint_frame frame = fixture_frame();
            frame.metres_per_unit = 1;
            frame.camera = camera_in_floats(eye, mirrored), frame.previous = camera_in_floats(previous, mirrored);
            const struct glint_frame found = read_back(&frame, "camera.exr");
            const struct glint_camera *const cameras[] = {&found.camera, &found.previous};
            for (int i = 0; i < 2; i++) {
                const double *m = cameras[i]->world_to_view, *place = i ? previous : eye;
                double solved[3], transposed[3];
                /* a double near 1e6 m has a precision of 1e-10 m, and products with a rotation one of 1e-9 m */
                glint_camera_position(cameras[i], solved);
                assert_true(distance(solved, place) < 1e-8);
                for (int c = 0; c < 3; c++) transposed[c] = -(m[c] * m[3] + m[4 + c] * m[7] + m[8 + c] * m[11]);
                assert_true(distance(transposed, place) < 1e-8);
                assert_true(off_rotation(m) < 1e-15 * 8);
                /* the nearest rotation is no farther from the stored matrix than the stored matrix is from the true rotation */
                for (int n = 0; n < 12; n++)
                    if (n % 4 != 3)
                        assert_true(fabs(m[n] - (i ? &frame.previous : &frame.camera)->world_to_view[n]) < 1.2e-7);
                assert_true(cameras[i]->rotation_error > 1e-9 && cameras[i]->rotation_error < 4 * (double)FLT_EPSILON);
            }
        }
}

static void a_precise_camera_keeps_its_bits(UNUSED void **unused) {
    struct glint_frame frame = fixture_frame();
    frame.camera = fixture_camera((const double[3]){1e6, -2e6, 3}, 0.1, 500);
    const struct glint_frame found = read_back(&frame, "precise.exr");
    char notes[GLINT_NOTES][GLINT_NOTE_LENGTH];
    assert_memory_equal(found.camera.world_to_view, frame.camera.world_to_view, sizeof found.camera.world_to_view);
    assert_int_equal(glint_frame_notes(&found, notes), 0);
}

/* Near the origin floats are as precise as doubles, so there are no notes. */
static void visible_effects_are_noted(UNUSED void **unused) {
    char notes[GLINT_NOTES][GLINT_NOTE_LENGTH];
    struct glint_frame frame = fixture_frame();
    frame.metres_per_unit = 1;
    frame.camera = camera_in_floats((const double[3]){10, 20, 30}, false), frame.previous = frame.camera;
    struct glint_frame found = read_back(&frame, "near.exr");
    assert_int_equal(glint_frame_notes(&found, notes), 0);
    frame.camera = camera_in_floats((const double[3]){1e6, 20, 30}, false);
    found = read_back(&frame, "far.exr");
    assert_int_equal(glint_frame_notes(&found, notes), 1);
    assert_non_null(strstr(notes[0], "gbuffer: glint.worldToView: expected a rotation in double precision, found"));
    assert_non_null(strstr(notes[0], "1000 km from the origin"));
    frame.previous = frame.camera;
    frame.metres_per_unit = 0.01; /* 10 km */
    found = read_back(&frame, "centimetres.exr");
    assert_int_equal(glint_frame_notes(&found, notes), 2);
    assert_non_null(strstr(notes[1], "glint.previousWorldToView"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cameras_stand_where_the_engine_put_them),
        cmocka_unit_test(a_precise_camera_keeps_its_bits),
        cmocka_unit_test(visible_effects_are_noted),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
