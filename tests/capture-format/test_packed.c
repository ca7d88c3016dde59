/* A G-buffer with packed motion and depth of 16 bits each, and vertex normals in two bytes. It is encoded by inverting the formulas of
   FORMAT.md in double; bounds are half a step of the storage. */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

enum { COUNT = FIX_W * FIX_H };
static struct fixture fixture;
static double bits[3][COUNT]; /* large enough for any type */

/* A capture whose part has these channels instead of its own. Vectors without Z have no Z channel. */
static struct glint_capture *dump(const char *path, const char *part_name, const struct glint_encodings *encodings,
                                  const char *const *names, size_t count, enum glint_type type,
                                  const struct glint_frame *frame) {
    struct glint_error err = {0};
    struct glint_writer *writer = glint_writer_create(path, NULL, &err);
    bool ok = writer && glint_writer_set_frame(writer, frame, &err);
    for (int p = 0; ok && p <= FIXTURE_PREVIOUS_GBUFFER; p++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        size_t kept = 0;
        bool replaced = !strcmp(part.name, part_name);
        if (replaced) part.encodings = *encodings;
        for (size_t c = 0; c < part.channel_count; c++) {
            for (size_t i = 0; replaced && i < count; i++)
                if (!strcmp(channels.all[c].name, names[i]))
                    channels.all[c] = (struct glint_channel){.name = names[i], .type = type, .data = bits[i]};
            if (replaced && count == 2 && !strcmp(channels.all[c].name, names[2])) continue;
            channels.all[kept++] = channels.all[c];
        }
        part.channel_count = kept;
        ok = glint_writer_add_part(writer, &part, &err);
    }
    ok = ok && glint_writer_finish(writer, &err);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = ok ? glint_capture_open(path, NULL, &err) : NULL;
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

static void decoded(struct glint_capture *capture, const char *part, const char *const *names, size_t count,
                    float *out) {
    struct glint_error err = {0};
    if (!glint_capture_read(capture, glint_capture_find(capture, part), names, count, GLINT_F32, out, 0, &err))
        fail_msg("%s", err.message);
}

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
            ((uint16_t *)bits[a])[i] =
                (uint16_t)lround((double)fixture.gbuffer[17 * i + 10 + (size_t)a] / range[a] * 32767 + 32768);
    const struct glint_encodings encodings = {.motion = GLINT_MOTION_PACKED16,
                                              .motion_depth = GLINT_MOTION_DEPTH_PACKED16};
    struct glint_capture *capture =
        dump(fixture_path(path, "motion_depth.exr"), "gbuffer", &encodings, names, 3, GLINT_U16, &frame);
    decoded(capture, "gbuffer", names, 3, out);
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
        for (int a = 0; a < 2; a++) ((uint8_t *)bits[a])[i] = (uint8_t)lround((view[i][a] + 1) / 2 * 255);
    }
    const struct glint_encodings encodings = {.vertex_normal = GLINT_NORMAL_VIEW_XY};
    struct glint_capture *capture =
        dump(fixture_path(path, "view_xy.exr"), part, &encodings, names, 2, GLINT_UNORM8, &frame);
    assert_true(glint_part_has_channel(glint_capture_find(capture, part), names[2]));
    decoded(capture, part, names, 3, out);
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

static int set_up(UNUSED void **state) {
    fixture_init(&fixture);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_motion_with_depth),
        cmocka_unit_test(vertex_normals_in_two_bytes),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
