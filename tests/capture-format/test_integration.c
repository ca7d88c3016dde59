/* The examples for engine programmers, in C and in C++: what they write is valid, correct, and the same.
   usage: test_integration INTEGRATION INTEGRATION_CC (the programs) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "unit.h"

#ifdef _WIN32
#include <process.h>
#endif

enum { WIDTH = 320, HEIGHT = 180, CUBE = 64 };
static const char *programs[2];
static char paths[2][512];

/* The program's exit code. */
static int run(const char *program, const char *path) {
#ifdef _WIN32
    return (int)_spawnl(_P_WAIT, program, program, path, NULL);
#else
    char command[1100];
    snprintf(command, sizeof command, "'%s' '%s' 2>/dev/null", program, path);
    const int status = system(command);
    return status < 0 ? status : status >> 8;
#endif
}

static void both_write_the_same_bytes(UNUSED void **state) {
    char hashes[2][33];
    struct glint_error err = {0};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(run(programs[i], paths[i]), 0);
        struct glint_capture *capture = glint_capture_open(paths[i], NULL, &err);
        if (!capture || !glint_capture_hash(capture, hashes[i], &err)) fail_msg("%s", err.message);
        glint_capture_close(&capture);
    }
    assert_string_equal(hashes[0], hashes[1]);
}

static void print_violation(UNUSED void *user, const char *rule, const char *message) {
    print_error("%s: %s\n", rule, message);
}

static void it_is_valid(UNUSED void **state) {
    struct glint_error err = {0};
    size_t violations = 0;
    if (!glint_capture_validate(paths[0], NULL, print_violation, NULL, &violations, &err)) fail_msg("%s", err.message);
    assert_int_equal(violations, 0);
}

/* Where a pixel of the floor lies in the world, from the decoded depth and the camera of the file: at a height of 0, with the normal
   (0, 1, 0). A point's motion leads to its pixel in the previous camera. */
static void the_floor_is_a_plane(UNUSED void **state) {
    static float out[WIDTH * HEIGHT * 6];
    static const char *const names[] = {"depth.Z", "normal.X", "normal.Y", "normal.Z", "motion.X", "motion.Y"};
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(paths[0], NULL, &err);
    assert_non_null(capture);
    if (!glint_capture_read(capture, glint_capture_find(capture, "gbuffer"), names, 6, GLINT_F32, out, 0, &err))
        fail_msg("%s", err.message);
    const struct glint_frame *frame = glint_capture_frame(capture);
    const double *m = frame->camera.world_to_view, *c = frame->camera.view_to_clip;
    const double *pm = frame->previous.world_to_view, *pc = frame->previous.view_to_clip;
    assert_true(frame->has_previous);
    for (int x = 0; x < WIDTH; x++) {
        const float *pixel = out + ((HEIGHT - 1) * WIDTH + x) * 6;
        const double z = pixel[0], u = (x + 0.5) / WIDTH, v = (HEIGHT - 0.5) / HEIGHT;
        double p[3], q[3],
            back[3] = {z * (2 * u - 1 + c[2]) / c[0] - m[3], z * (1 - 2 * v + c[6]) / c[5] - m[7], -z - m[11]};
        for (int a = 0; a < 3; a++) p[a] = m[a] * back[0] + m[4 + a] * back[1] + m[8 + a] * back[2];
        for (int r = 0; r < 3; r++)
            q[r] = pm[4 * r] * p[0] + pm[4 * r + 1] * p[1] + pm[4 * r + 2] * p[2] + pm[4 * r + 3];
        assert_true(fabs(p[1]) < 1e-5); /* a float's step of 4 m, some roundings */
        assert_true(fabsf(pixel[1]) < 1e-4f && pixel[2] > 0.9999f && fabsf(pixel[3]) < 1e-4f); /* 16 bits */
        assert_true(fabs(0.5 + 0.5 * (pc[0] * q[0] + pc[2] * q[2]) / -q[2] - u - pixel[4]) < 1e-6);
        assert_true(fabs(0.5 - 0.5 * (pc[5] * q[1] + pc[6] * q[2]) / -q[2] - v - pixel[5]) < 1e-6);
    }
    glint_capture_close(&capture);
}

/* The walls are 7 m and 6 m from the middle of the yard, the floor is 1.5 m below each cube map; above is sky. */
static void cube_maps_have_the_distances_of_the_yard(UNUSED void **state) {
    static float out[CUBE * 6 * CUBE * 2];
    static const char *const names[] = {"distance.Z", "A"};
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(paths[0], NULL, &err);
    assert_non_null(capture);
    for (int i = 0; i < 2; i++) {
        char name[16];
        snprintf(name, sizeof name, "cubemap.00%d", i);
        const struct glint_part_info *part = glint_capture_find(capture, name);
        assert_non_null(part);
        if (!glint_capture_read(capture, part, names, 2, GLINT_F32, out, 0, &err)) fail_msg("%s", err.message);
        const double *at = part->cubemap.center;
        /* The texel right and below of a face's middle, half a texel from it. */
        const double off = 1.0 / CUBE, stretch = sqrt(1 + 2 * off * off);
        const double expected[6] = {7 - at[0], 7 + at[0], INFINITY, at[1], 6 - at[2], 6 + at[2]};
        for (int face = 0; face < 6; face++) {
            const float *texel = out + ((face * CUBE + CUBE / 2) * CUBE + CUBE / 2) * 2;
            const bool sky = isinf(expected[face]);
            assert_true(sky ? isinf(texel[0]) : fabs(texel[0] - expected[face] * stretch) < 1e-5);
            assert_true(texel[1] == (sky ? 0 : 1));
        }
    }
    glint_capture_close(&capture);
}

static void a_failure_is_the_exit_code(UNUSED void **state) {
    char path[512];
    fixture_path(path, "nowhere/at-all.exr");
    for (int i = 0; i < 2; i++) {
        assert_int_equal(run(programs[i], path), 1);
        assert_true(access(path, F_OK) != 0);
    }
}

static int setup(UNUSED void **state) {
    fixture_path(paths[0], "integration.exr");
    fixture_path(paths[1], "integration_cc.exr");
    return 0;
}

static int teardown(UNUSED void **state) {
    for (int i = 0; i < 2; i++) unlink(paths[i]);
    return 0;
}

int main(int argc, char **argv) {
    for (int i = 0; i < 2; i++) programs[i] = argc > i + 1 ? argv[i + 1] : "";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_write_the_same_bytes),  cmocka_unit_test(it_is_valid),
        cmocka_unit_test(the_floor_is_a_plane),       cmocka_unit_test(cube_maps_have_the_distances_of_the_yard),
        cmocka_unit_test(a_failure_is_the_exit_code),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
