/* Clouds of the stand-in engine: their shadows in its picture, and textures that repeat. */
#include "support.h"

#include <math.h>
#include <stdlib.h>

enum { W = 48, H = 27 };

static struct glint_capture *sample(void **state, const char *name, uint32_t also) {
    const struct glint_sample_options options = {
        .width = W, .height = H, .cube_size = 8, .light_samples = 2, .unjittered = true, .also = also};
    write_sample("meadow", in_folder(state, name), &options);
    return open_capture(in_folder(state, name));
}

/* In the sun a surface loses of the sun's light, which is what neither the sky nor itself sends, the part that clouds keep; nothing else changes. Albedo
   in gbuffer has 8 bits, and colours are halves. */
static void test_clouds_shade_the_picture(void **state) {
    struct glint_capture *with = sample(state, "with.exr", GLINT_ALSO_SKY | GLINT_ALSO_SUN),
                         *without = sample(state, "without.exr", GLINT_ALSO_SUN);
    float *lit = read_part(with, "lit", "R G B", NULL, NULL), *bright = read_part(without, "lit", "R G B", NULL, NULL),
          *indirect = read_part(without, "indirect", "R G B", NULL, NULL),
          *same = read_part(with, "indirect", "R G B", NULL, NULL),
          *clouds = read_part(with, "sun", "clouds", NULL, NULL),
          *sun = read_part(with, "sun", "visibility", NULL, NULL),
          *depth = read_part(with, "gbuffer", "depth.Z", NULL, NULL);
    size_t shaded = 0, sky = 0;
    for (size_t i = 0; i < W * H; i++) {
        assert_true(clouds[i] >= 0 && clouds[i] <= 1 && (clouds[i] == 1 || depth[i] < INFINITY));
        for (size_t k = 3 * i; k < 3 * i + 3; k++) {
            assert_true(indirect[k] == same[k]);
            sky += isinf(depth[i]) && lit[k] != bright[k];
            if (isinf(depth[i])) continue;
            const double direct = sun[i] > 0 ? (double)bright[k] - (double)indirect[k] : 0,
                         right = (double)bright[k] - (1 - (double)clouds[i]) * direct;
            assert_true(fabs((double)lit[k] - right) <= 0.004 * (double)bright[k] + 1e-5 + direct / 255);
            shaded += right < 0.7 * (double)bright[k];
        }
    }
    assert_true(shaded > 300 && sky > 1000);
    assert_null(glint_capture_find(without, "stars"));
    assert_false(glint_capture_frame(without)->has_atmosphere || glint_capture_frame(without)->has_clouds);
    free(lit), free(bright), free(indirect), free(same), free(clouds), free(sun), free(depth);
    glint_capture_close(&with);
    glint_capture_close(&without);
}

/* Neighbours over the border differ as those within do, and the noise's first and last slice, too. */
static void test_clouds_repeat(void **state) {
    static const char *const parts[] = {"cloud.density", "cloud.height", "cloud.noise"}, *const names[] = {"density",
                                                                                                           "height",
                                                                                                           "noise"};
    struct glint_capture *capture = sample(state, "tiles.exr", GLINT_ALSO_SKY);
    for (int p = 0; p < 3; p++) {
        uint32_t side, rows;
        float *values = read_part(capture, parts[p], names[p], &side, &rows);
        double inside = 0, across = 0, border = 0;
        const uint32_t slices = rows / side;
        for (uint32_t i = 0; i < side * rows; i++) {
            const uint32_t x = i % side, y = i / side % side, k = i / side / side, right = (i - x) + (x + 1) % side,
                           down = (k * side + (y + 1) % side) * side + x, up = ((k + 1) % slices * side + y) * side + x;
            *(x + 1 < side ? &inside : &border) +=
                fabs((double)values[right] - (double)values[i]) / (x + 1 < side ? side - 1 : 1);
            *(y + 1 < side ? &inside : &border) +=
                fabs((double)values[down] - (double)values[i]) / (y + 1 < side ? side - 1 : 1);
            if (p == 2)
                across += (k + 1 < slices ? -1.0 / (slices - 1) : 1) * fabs((double)values[up] - (double)values[i]);
        }
        print_message("# %s: %.3f over the border, %.3f within\n", parts[p], border, inside);
        assert_true(border < 1.5 * inside && inside > 0 && across < 0.25 * inside);
        free(values);
    }
    glint_capture_close(&capture);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_clouds_shade_the_picture),
                                       cmocka_unit_test(test_clouds_repeat)};
    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
