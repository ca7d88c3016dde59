/* The references of the self-test, each compared with its inverse or with an independent computation. */
#include <math.h>

#include "oracles/noise.h"
#include "oracles/open_box.h"
#include "oracles/plain_capture.h"
#include "unit.h"

/* Stored values decode to the depth within half a step; the last bit of a float, 6e-8, is negligible. */
static void stored_depth_decodes_to_itself(UNUSED void **state) {
    static const uint32_t bits[] = {0, 24};
    for (int encoding = GLINT_DEPTH_VIEW_LINEAR; encoding <= GLINT_DEPTH_LOGARITHMIC_REVERSED; encoding++)
        for (size_t b = 0; b < (encoding == GLINT_DEPTH_VIEW_LINEAR ? 1 : 2); b++)
            for (double depth = 0.2; depth < 500; depth *= 1.7) {
                const struct open_box box = {.encodings.depth = (enum glint_depth_encoding)encoding,
                                             .depth_bits = bits[b]};
                const double stored = (double)open_box_encode_depth(&box, depth);
                const double step = open_box_depth_step(&box, depth);
                assert_true(fabs(open_box_decode_depth(&box, stored) - depth) <= 2 * step + 6e-8 * depth);
            }
}

static double cross_length(const double a[3], const double b[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        sum += pow(a[i] * b[j] - a[j] * b[i], 2);
    }
    return sqrt(sum);
}

/* A mirror ray starts at its pixel, and the camera's ray through the screen position of its end passes through that end. */
static void mirror_rays_start_and_end_where_they_are_seen(UNUSED void **state) {
    const struct open_box box = open_box_filled(&(struct open_box){0});
    size_t rays = 0;
    for (uint32_t i = 0; i < box.width * box.height; i++) {
        const double place[2] = {i % box.width + 0.5, i / box.width + 0.5};
        double seen[2], ray[3], eye[3] = {1.2, 1.7, 5.2}, to_end[3];
        struct open_box_ray mirror;
        if (!open_box_reflect(&box, place, &mirror)) continue;
        assert_true(open_box_seen_at(&box, mirror.start, seen));
        assert_true(hypot(seen[0] - place[0], seen[1] - place[1]) < 1e-9 * box.width);
        if (!mirror.in_front || !isfinite(mirror.distance)) continue;
        open_box_view_ray(&box, mirror.end_px, ray);
        for (int k = 0; k < 3; k++) to_end[k] = mirror.end[k] - eye[k];
        assert_true(cross_length(ray, to_end) < 1e-9 * hypot(hypot(ray[0], ray[1]), ray[2]) * 10); /* 10 m across */
        rays++;
    }
    assert_true(rays > 500);
}

/* Directions of a face have unit length, and their largest component is along the axis of the face. */
static void directions_lie_on_their_faces(UNUSED void **state) {
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t texel = 0; texel < 64; texel++) {
            double d[3], length = 0;
            plain_direction(face, texel % 8, texel / 8, 8, d);
            for (int k = 0; k < 3; k++) length += d[k] * d[k];
            assert_true(fabs(length - 1) < 1e-14);
            for (uint32_t k = 0; k < 3; k++) assert_true(fabs(d[k]) <= (face % 2 ? -d[face / 2] : d[face / 2]));
        }
}

/* 10^6 numbers: five standard deviations of a mean are 5/sqrt(12 10^6). */
static void noise_is_even(UNUSED void **state) {
    double sum = 0;
    for (uint32_t i = 0; i < 1000000; i++) {
        const double value = noise(7, i);
        assert_true(value >= 0 && value < 1);
        sum += value;
    }
    assert_true(fabs(sum / 1e6 - 0.5) < 1.5e-3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stored_depth_decodes_to_itself),
        cmocka_unit_test(mirror_rays_start_and_end_where_they_are_seen),
        cmocka_unit_test(directions_lie_on_their_faces),
        cmocka_unit_test(noise_is_even),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
