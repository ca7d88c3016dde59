/* Cube maps resampled to another size, compared with closed forms: planes stay planes, and edges stay in place. */
#include <math.h>
#include <stdlib.h>

#include "channels.h"
#include "unit.h"

enum { CHANNELS = 3 }; /* a colour, a constant, a distance */

/* The contents of a texel at (a, b) on a face of [-1, 1]². */
typedef void (*shows)(int face, double a, double b, float out[CHANNELS]);

static float *texels(uint32_t size, shows shows) {
    float *all = malloc(6 * (size_t)size * size * CHANNELS * sizeof *all), *to = all;
    assert_non_null(all);
    for (uint32_t y = 0; y < 6 * size; y++)
        for (uint32_t x = 0; x < size; x++, to += CHANNELS)
            shows((int)(y / size), (2 * x + 1.0) / size - 1, (2 * (y % size) + 1.0) / size - 1, to);
    return all;
}

static float *enlarged(uint32_t own, uint32_t face, shows shows) {
    static const char *names[CHANNELS] = {"R", "G", "distance.Z"};
    const struct glint_part_info part = {.name = "cubemap.000", .width = own, .height = 6 * own};
    struct channels channels = {.part = &part, .names = names, .count = CHANNELS, .data = texels(own, shows)};
    struct glint_error err = {0};
    if (!channels_enlarge(&channels, face, &err)) fail_msg("%s", err.message);
    return channels.data;
}

/* Planes at 2 m, tilted differently behind each face; a gradient of colour. */
static void planes(int face, double a, double b, float out[CHANNELS]) {
    const double along = 2 / (1 + 0.05 * face * a - 0.1 * b);
    out[0] = (float)(2 + a - b), out[1] = 7, out[2] = (float)(along * sqrt(1 + a * a + b * b));
}

static void planes_stay_planes_and_ramps_ramps(UNUSED void **state) {
    static const uint32_t sizes[][2] = {{8, 24}, {10, 24}, {17, 128}, {96, 128}, {24, 24}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const uint32_t own = sizes[s][0], face = sizes[s][1];
        float *found = enlarged(own, face, planes), *wanted = texels(face, planes);
        for (size_t i = 0; i < 6 * (size_t)face * face; i++) {
            const float *f = found + CHANNELS * i, *w = wanted + CHANNELS * i;
            const double a = (2.0 * (double)(i % face) + 1) / face - 1,
                         b = (2.0 * (double)(i / face % face) + 1) / face - 1;
            const bool border = fmax(fabs(a), fabs(b)) > 1 - 1.0 / own;
            /* a few roundings of float, doubled by the differences beyond the borders */
            assert_true(fabs(f[2] / w[2] - 1.0) < 1e-6);
            assert_true(border || fabs(f[0] - w[0]) < 1e-6 * 4);
            assert_true(f[1] == 7);
        }
        free(found), free(wanted);
    }
}

/* A wall that ends in front of another one, and of the sky. */
static void edges(int face, double a, double b, float out[CHANNELS]) {
    out[0] = out[1] = 1;
    out[2] = a + 0.3 * b < 0.1 ? 1 : face % 2 ? 3 : INFINITY;
}

static void nothing_is_seen_between_two_surfaces(UNUSED void **state) {
    enum { OWN = 12, FACE = 32 };
    float *found = enlarged(OWN, FACE, edges), *own = texels(OWN, edges);
    size_t near = 0;
    for (size_t i = 0; i < 6 * FACE * FACE; i++) {
        const size_t x = (2 * (i % FACE) + 1) * OWN / (2 * FACE), y = (2 * (i / FACE) + 1) * OWN / (2 * FACE);
        const float nearest = own[CHANNELS * (y * OWN + x) + 2], f = found[CHANNELS * i + 2];
        /* equal distances are not a plane: beyond the centres of the outermost texels a line is off by 3/8 of the square of a texel's
           width, on either axis */
        assert_true(isinf(nearest) ? isinf(f) : fabsf(f / nearest - 1) < 2 * 3 / 8.0F / 36);
        near += nearest == 1;
    }
    assert_true(near > 6 * FACE * FACE / 3 && near < 4 * FACE * FACE);
    free(found), free(own);
}

/* Two metres along the axis of each face, or sky. */
static void walls(int face, double a, double b, float out[CHANNELS]) {
    out[0] = out[1] = 1, out[2] = face == 2 ? INFINITY : (float)(2 * sqrt(1 + a * a + b * b));
}

static void a_single_texel_is_a_wall(UNUSED void **state) {
    float *found = enlarged(1, 5, walls), *wanted = texels(5, walls);
    for (size_t i = 0; i < 6 * 25 * CHANNELS; i++) assert_true(found[i] == wanted[i]);
    free(found), free(wanted);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_stay_planes_and_ramps_ramps),
        cmocka_unit_test(nothing_is_seen_between_two_surfaces),
        cmocka_unit_test(a_single_texel_is_a_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
