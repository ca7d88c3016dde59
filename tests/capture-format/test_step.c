/* The resolution of depth storage, compared with all values of the format, decoded by the formula of FORMAT.md. */
#include <Imath/half.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

/* A capture whose depth is declared like this. The fixture's projection has near at 0.1 and far at 500 units; here a unit is a metre. */
static struct glint_capture *capture_of(enum glint_depth_encoding encoding, const char *storage, char path[512]) {
    struct glint_error err = {0};
    struct glint_frame frame = fixture_frame();
    frame.metres_per_unit = 1;
    struct glint_writer *writer = glint_writer_create(fixture_path(path, "step.exr"), NULL, &err);
    static float depth[FIX_W * FIX_H];
    for (int i = 0; i < FIX_W * FIX_H; i++) depth[i] = 0.5f;
    assert_true(writer && glint_writer_set_frame(writer, &frame, &err));
    for (int i = 0; i < 2; i++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, i ? FIXTURE_LIT : FIXTURE_GBUFFER, &channels);
        part.encodings.depth = encoding;
        for (size_t c = 0; !i && c < part.channel_count; c++)
            if (!strcmp(channels.all[c].name, "depth.Z"))
                channels.all[c] =
                    (struct glint_channel){.name = "depth.Z", .type = GLINT_F32, .data = depth, .storage = storage};
        if (!glint_writer_add_part(writer, &part, &err)) fail_msg("%s", err.message);
    }
    assert_true(glint_writer_finish(writer, &err));
    glint_writer_destroy(&writer);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

static double device_to_metres(double v) {
    return v >= 1 ? (double)INFINITY : 0.1 * 500 / (500 - v * (500 - 0.1));
}

/* The two values of a format around a distance. */
struct around {
    double at, below, above;
};
static void meet(struct around *a, double metres) {
    if (metres <= a->at) a->below = fmax(a->below, metres);
    if (metres > a->at) a->above = fmin(a->above, metres);
}

static void assert_step(const char *storage, enum glint_depth_encoding encoding, double at, double expected) {
    char path[512];
    struct glint_capture *capture = capture_of(encoding, storage, path);
    const double found = glint_depth_step(capture, glint_capture_find(capture, "gbuffer"), at);
    const bool same = isinf(expected) ? isinf(found) : fabs(found - expected) <= 1e-6 * expected;
    if (!same) fail_msg("%s at %g m: expected %.9g, found %.9g", storage, at, expected, found);
    glint_capture_close(&capture);
    unlink(path);
}

static void steps_are_those_between_neighbours(UNUSED void **state) {
    static const double places[] = {0.7, 1, 10, 47, 100, 444};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        struct around half = {places[i], 0, (double)INFINITY}, linear = half, fixed = half;
        for (unsigned h = 0; h < 0x7c00; h++) {
            const double v = (double)imath_half_to_float((uint16_t)h);
            if (v <= 1) meet(&half, device_to_metres(v));
            meet(&linear, v);
        }
        for (int v = 0; v <= 65535; v++) meet(&fixed, device_to_metres(v / 65535.0));
        assert_step("R16F", GLINT_DEPTH_DEVICE, places[i], half.above - half.below);
        assert_step("D16", GLINT_DEPTH_DEVICE, places[i], fixed.above - fixed.below);
        assert_step("R16F", GLINT_DEPTH_VIEW_LINEAR, places[i], linear.above - linear.below);
    }
}

static void what_is_out_of_range_has_no_step(UNUSED void **state) {
    char path[512];
    struct glint_capture *capture = capture_of(GLINT_DEPTH_DEVICE, "D24", path);
    const struct glint_part_info *gbuffer = glint_capture_find(capture, "gbuffer");
    assert_true(isnan(glint_depth_step(capture, gbuffer, 0.05)));
    assert_true(isnan(glint_depth_step(capture, gbuffer, 600)));
    assert_true(isnan(glint_depth_step(capture, glint_capture_find(capture, "lit"), 1)));
    assert_true(glint_channel_step(capture, gbuffer, "nothing", 1) == 0);
    assert_true(glint_channel_step(capture, gbuffer, "stencil.id", 1) == 0);
    glint_capture_close(&capture);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_are_those_between_neighbours),
        cmocka_unit_test(what_is_out_of_range_has_no_step),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
