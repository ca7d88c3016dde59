/* The examples for engine programmers, in C and in C++: what they write is valid, correct, and the same.
   usage: test_integration INTEGRATION INTEGRATION_CC INTEGRATION_LIGHT (the programs) */
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
static const char *programs[3]; /* C, C++, light.c */
static char paths[3][512];

/* The program's exit code. */
static int run(const char *program, const char *path) {
#ifdef _WIN32
    return (int)_spawnl(_P_WAIT, program, program, path, NULL);
#else
    char command[1700];
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

static void they_are_valid(UNUSED void **state) {
    struct glint_error err = {0};
    for (int i = 0; i < 3; i += 2) {
        size_t violations = 0;
        if (i) assert_int_equal(run(programs[i], paths[i]), 0);
        if (!glint_capture_validate(paths[i], NULL, print_violation, NULL, &violations, &err))
            fail_msg("%s", err.message);
        assert_int_equal(violations, 0);
    }
}

/* Of each pixel: the world position from depth and camera, its place in the shadow map, and what the picture says: a surface that faces the sun
   has more light than the ambient part where the map shows nothing nearer to the sun, and no more where it does. */
static void shadow_map_and_light_agree(UNUSED void **state) {
    enum { MAP = 512 };
    static float g[WIDTH * HEIGHT * 4], lit[WIDTH * HEIGHT], part[WIDTH * HEIGHT], map[MAP * MAP];
    static const char *const surface[] = {"depth.Z", "normal.X", "normal.Y", "normal.Z"}, *const red[] = {"R"};
    struct glint_error err = {0};
    struct glint_capture *c = glint_capture_open(paths[2], NULL, &err);
    assert_non_null(c);
    const struct glint_part_info *shadow = glint_capture_find(c, "shadow.000");
    assert_true(shadow && shadow->width == MAP && shadow->height == MAP);
    assert_true(glint_capture_read(c, glint_capture_find(c, "gbuffer"), surface, 4, GLINT_F32, g, 0, &err) &&
                glint_capture_read(c, glint_capture_find(c, "lit"), red, 1, GLINT_F32, lit, 0, &err) &&
                glint_capture_read(c, glint_capture_find(c, "indirect"), red, 1, GLINT_F32, part, 0, &err) &&
                glint_capture_read(c, shadow, surface, 1, GLINT_F32, map, 0, &err));
    const struct glint_frame *frame = glint_capture_frame(c);
    const double *m = frame->camera.world_to_view, *p = frame->camera.view_to_clip, *s = shadow->shadow.world_to_shadow,
                 *sun = frame->sun.direction;
    size_t dark = 0, bright = 0, wrong = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double z = (double)g[4 * i], u = ((double)(i % WIDTH) + 0.5) / WIDTH,
                     v = ((double)(i / WIDTH) + 0.5) / HEIGHT;
        const double facing =
            (double)g[4 * i + 1] * sun[0] + (double)g[4 * i + 2] * sun[1] + (double)g[4 * i + 3] * sun[2];
        if (isinf(z)) assert_true(part[i] == 0 && lit[i] > 0);
        if (isinf(z) || facing < 0.5 || part[i] == 0) continue; /* metals have no diffuse light */
        const double back[3] = {z * (2 * u - 1 + p[2]) / p[0] - m[3], z * (1 - 2 * v + p[6]) / p[5] - m[7], -z - m[11]};
        double at[3], q[3];
        for (int a = 0; a < 3; a++) at[a] = m[a] * back[0] + m[4 + a] * back[1] + m[8 + a] * back[2];
        for (int r = 0; r < 3; r++)
            q[r] = s[4 * r] * at[0] + s[4 * r + 1] * at[1] + s[4 * r + 2] * at[2] + s[4 * r + 3];
        const int x = (int)((q[0] + 1) / 2 * MAP), y = (int)((1 - q[1]) / 2 * MAP);
        assert_true(x >= 0 && x < MAP && y >= 0 && y < MAP);
        /* A texel is 47 mm wide, over which the depth of a surface that faces the sun at 0.5 changes by 81 mm, 0.0034 of 24 m. */
        const bool hidden = q[2] > (double)map[y * MAP + x] + 0.004;
        const bool is_dark = lit[i] <= part[i] * 1.002f; /* halves */
        dark += is_dark;
        bright += !is_dark;
        wrong += hidden != is_dark;
    }
    /* at the rims of shadows, and where an occluder is nearer than that */
    assert_true(dark > 500 && bright > 10000);
    if (wrong > (dark + bright) / 20) fail_msg("%zu of %zu and %zu", wrong, dark, bright);
    glint_capture_close(&c);
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
    for (int i = 0; i < 3; i++) {
        assert_int_equal(run(programs[i], path), 1);
        assert_true(access(path, F_OK) != 0);
    }
}

static int setup(UNUSED void **state) {
    fixture_path(paths[0], "integration.exr");
    fixture_path(paths[1], "integration_cc.exr");
    fixture_path(paths[2], "integration_light.exr");
    return 0;
}

static int teardown(UNUSED void **state) {
    for (int i = 0; i < 3; i++) unlink(paths[i]);
    return 0;
}

int main(int argc, char **argv) {
    for (int i = 0; i < 3; i++) programs[i] = argc > i + 1 ? argv[i + 1] : "";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_write_the_same_bytes),
        cmocka_unit_test(they_are_valid),
        cmocka_unit_test(shadow_map_and_light_agree),
        cmocka_unit_test(the_floor_is_a_plane),
        cmocka_unit_test(cube_maps_have_the_distances_of_the_yard),
        cmocka_unit_test(a_failure_is_the_exit_code),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
