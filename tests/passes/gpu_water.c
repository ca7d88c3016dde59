/* Water on the scene lake, compared with the image of its path tracer: Fresnel's equations, with both the reflected and the refracted
   ray traced to their hits. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "lake.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDTH = 192, HEIGHT = 108 };

static void load_lake(struct gpu *gpu) {
    gpu_sample(gpu, "lake", "lake",
               &(struct glint_sample_options){.width = WIDTH,
                                              .height = HEIGHT,
                                              .cube_size = 32,
                                              .light_samples = 8,
                                              .planar_width = 96,
                                              .planar_height = 54});
    gpu_reset(gpu);
    gpu_use(gpu, "planar=lookup");
    gpu_use(gpu, "water=combine");
}

static void every_part_of_it_brings_the_picture_nearer(void **state) {
    struct gpu *gpu = *state;
    static const char *const off[] = {NULL,
                                      "planar.perturb=false",
                                      "planar.near=false",
                                      "water.refraction=false",
                                      "water.depth=false",
                                      "water.fresnel=false",
                                      "water.intensity=0"};
    double errors[7];
    load_lake(gpu);
    float *opacity = gpu_part(gpu, "water", (const char *[]){"opacity"}, 1),
          *scene = gpu_part(gpu, "scene", (const char *[]){"R", "G", "B"}, 3);
    for (int i = 0; i < 7; ++i) {
        load_lake(gpu);
        if (off[i]) gpu_set(gpu, off[i]);
        gpu_run(gpu);
        errors[i] = lake_error(gpu, opacity, scene);
        print_message("# %-24s %.4f\n", off[i] ? off[i] : "all", errors[i]);
        if (i) assert_true(errors[i] > errors[0]);
    }
    gpu_use(gpu, "planar=none");
    gpu_set(gpu, "water.intensity=1");
    gpu_run(gpu);
    double around = lake_error(gpu, opacity, scene);
    print_message("# %-24s %.4f\n", "planar=none", around);
    assert_true(around > errors[0]);
    free(opacity), free(scene);
}

/* Pixels without water, or with an object in front of it, do not change by a bit. */
static void all_else_stays(void **state) {
    struct gpu *gpu = *state;
    load_lake(gpu);
    gpu_run(gpu);
    float *opacity = gpu_part(gpu, "water", (const char *[]){"opacity"}, 1);
    float *finished = gpu_floats(gpu, "composed_water", NULL, NULL),
          *composed = gpu_floats(gpu, "composed", NULL, NULL);
    float *planar = gpu_floats(gpu, "planar_reflection", NULL, NULL);
    size_t dry = 0, wet = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        if (opacity[i] > 0) {
            wet += memcmp(finished + 4 * i, composed + 4 * i, 3 * sizeof(float)) != 0;
            continue;
        }
        dry++;
        assert_memory_equal(finished + 4 * i, composed + 4 * i, 3 * sizeof(float));
        assert_true(planar[4 * i + 3] == 0);
    }
    assert_true(dry > 2000 && wet > 2000);
    free(opacity), free(finished), free(composed), free(planar);
}

/* Without ripples the mirror ray is the one that the map was rendered for: the lookup is at the pixel's own position, since both
   cameras see points of the plane at the same position. */
static void a_flat_mirror_is_looked_up_in_place(void **state) {
    struct gpu *gpu = *state;
    load_lake(gpu);
    gpu_set(gpu, "planar.perturb=false");
    gpu_run(gpu);
    const struct glint_part_info *info = glint_capture_find(gpu->capture, "planar.000");
    const uint32_t w = info->width, h = info->height;
    float *map = gpu_part(gpu, "planar.000", (const char *[]){"R", "G", "B"}, 3),
          *opacity = gpu_part(gpu, "water", (const char *[]){"opacity"}, 1);
    float *planar = gpu_floats(gpu, "planar_reflection", NULL, NULL);
    const double *jitter = glint_capture_frame(gpu->capture)->jitter_px;
    double *errors = malloc(WIDTH * HEIGHT * sizeof *errors);
    assert_non_null(errors);
    size_t count = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        /* of the same aspect ratio, without the jitter of the frame's camera */
        double x = ((double)(i % WIDTH) + 0.5 - jitter[0]) / WIDTH * w - 0.5,
               y = ((double)(i / WIDTH) + 0.5 - jitter[1]) / HEIGHT * h - 0.5;
        if (!(opacity[i] > 0) || x < 0 || y < 0 || x >= w - 1 || y >= h - 1) continue;
        assert_true(planar[4 * i + 3] == 1);
        size_t at = (size_t)y * w + (size_t)x;
        double u = x - floor(x), v = y - floor(y), expected = 0;
        for (size_t k = 0; k < 4; ++k)
            expected += (double)map[3 * (at + k % 2 + k / 2 * w)] * (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v);
        errors[count++] = fabs((double)planar[4 * i] - expected);
    }
    double p99 = quantile(errors, count, 0.99), worst = errors[count - 1];
    print_message("# %zu pixels: off by %.2g (99th percentile), at most %.2g\n", count, p99, worst);
    assert_true(count > 5000);
    assert_true(p99 <=
                4e-3); /* half floats up to 2, and a sampler with weights of 8 bits at edges between sky and firs */
    free(map), free(opacity), free(planar), free(errors);
}

/* Its parts decode to equal values in other encodings. */
static void encodings_change_nothing(void **state) {
    struct gpu *gpu = *state;
    double errors[2];
    for (int i = 0; i < 2; ++i) {
        load_lake(gpu);
        if (i)
            gpu_sample(gpu, "lake", "encoded",
                       &(struct glint_sample_options){.width = WIDTH,
                                                      .height = HEIGHT,
                                                      .cube_size = 32,
                                                      .light_samples = 8,
                                                      .planar_width = 96,
                                                      .planar_height = 54,
                                                      .encodings = {.depth = GLINT_DEPTH_LOGARITHMIC_REVERSED,
                                                                    .normal = GLINT_NORMAL_OCTAHEDRAL,
                                                                    .normal_space = GLINT_SPACE_VIEW,
                                                                    .color = GLINT_COLOR_SRGB}});
        gpu_run(gpu);
        float *opacity = gpu_part(gpu, "water", (const char *[]){"opacity"}, 1),
              *scene = gpu_part(gpu, "scene", (const char *[]){"R", "G", "B"}, 3);
        errors[i] = lake_error(gpu, opacity, scene);
        free(opacity), free(scene);
    }
    print_message("# %.4f, encoded %.4f\n", errors[0], errors[1]);
    /* 16-bit octahedral normals, and colours in sRGB as half floats, both in the image and in the truth: 0.003 of a colour. */
    assert_true(fabs(errors[1] - errors[0]) < 0.003);
}

/* ---- water by closed form ---- */

enum { SIDE = 64 };
static const double half_view = 0.57735026918962576; /* tan 30° */

static void wall_or_sky(UNUSED uint32_t number, const double direction[3], float out[5]) {
    for (int k = 0; k < 4; ++k) out[k] = direction[0] > 0 ? 1 : 0;
    out[4] = 100;
}
static void blue(UNUSED const double direction[3], float out[3]) {
    out[0] = 0.25f, out[1] = 0.5f, out[2] = 2;
}
static void facing(uint32_t x, uint32_t y, float out[9]) {
    const float values[9] = {0, 0, 0, 0.5f, 0, 0, 1, 4, 1};
    (void)x, (void)y;
    memcpy(out, values, sizeof values);
}

static void load_plain(struct gpu *gpu, void (*water)(uint32_t x, uint32_t y, float out[9])) {
    char path[256];
    plain_capture(gpu_path(gpu, "plain", path), &(struct plain){.width = SIDE,
                                                                .height = SIDE,
                                                                .fov_y_degrees = 60,
                                                                .cube_size = 32,
                                                                .cube_count = 1,
                                                                .cube = wall_or_sky,
                                                                .sky = blue,
                                                                .first = true,
                                                                .water = water});
    gpu_load(gpu, "plain");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "water=combine");
}

/* The cube map's alpha covers the sky, which is visible where alpha is 0. */
static void the_sky_is_behind_the_cube_map(void **state) {
    static const float sky[3] = {0.25f, 0.5f, 2};
    struct gpu *gpu = *state;
    load_plain(gpu, facing);
    gpu_set(gpu, "water.fresnel=false"); /* a reflectance of 0.36 at an index of 4, times sixteen */
    gpu_set(gpu, "water.index=4");
    gpu_set(gpu, "water.intensity=16");
    gpu_run(gpu);
    float *seen = gpu_floats(gpu, "composed_water", NULL, NULL);
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const int x = i % SIDE - SIDE / 2;
        if (abs(x) < 8) continue; /* less than 1/8 of a face: between texels, or filtered by the sampler */
        for (int k = 0; k < 3; ++k) assert_true(fabsf(seen[4 * i + k] - (x > 0 ? 1 : sky[k])) < 1e-5f);
    }
    free(seen);
}

/* A metre below the viewer, half a metre of water along every view ray. */
static double down_at(double y) {
    return (2 * (y + 0.5) / SIDE - 1) * half_view;
}
static void lake_at(UNUSED uint32_t x, uint32_t y, float out[9]) {
    const double down = down_at(y);
    const float values[9] = {0, 0, 0, 0.5f, 0, 1, 0, down > 0.1 ? (float)(1 / down) : INFINITY, 0.5f};
    memcpy(out, values, sizeof values);
}

/* The length of the refracted ray until it is as deep as the water at a pixel, and the position on screen of that end in pixels. */
static double refracted_length(const double from[3], const double ray[3], int x, int y, double place[2]) {
    const double at[2] = {(2 * (x + 0.5) / SIDE - 1) * half_view, down_at(y)};
    const double way = 0.5 * at[1] / sqrt(1 + at[0] * at[0] + at[1] * at[1]) / -ray[1];
    const double end[3] = {from[0] + way * ray[0], from[1] + way * ray[1], from[2] + way * ray[2]};
    place[0] = (end[0] / -end[2] / half_view + 1) / 2 * SIDE;
    place[1] = (1 - end[1] / -end[2] / half_view) / 2 * SIDE;
    return way;
}

/* The bottom has constant light, of which half is left after each metre, so that the image shows the length of the refracted ray: for
   the pixel where it ends, after two lookups; outside of the picture, for the nearest pixel. */
static void depth_is_looked_up_at_the_refracted_position(void **state) {
    struct gpu *gpu = *state;
    load_plain(gpu, lake_at);
    gpu_set(gpu, "water.intensity=0");
    gpu_set(gpu, "compose.intensity=0");
    gpu_run(gpu);
    float *seen = gpu_floats(gpu, "composed_water", NULL, NULL);
    int count = 0, beyond = 0;
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const double across = (2 * (i % SIDE + 0.5) / SIDE - 1) * half_view, down = down_at(i / SIDE);
        if (!(down > 0.1)) continue;
        /* Snell's law for a level plane: the component along it is divided by the index. */
        const double length = sqrt(1 + across * across + down * down),
                     flat[2] = {across / length / 1.333, -1 / length / 1.333};
        const double from[3] = {across / down, -1, -1 / down};
        const double ray[3] = {flat[0], -sqrt(1 - flat[0] * flat[0] - flat[1] * flat[1]), flat[1]};
        double place[2], way = refracted_length(from, ray, i % SIDE, i / SIDE, place);
        bool sure = true, left = false;
        for (int k = 0; k < 2 && sure; ++k) {
            int there[2];
            for (int c = 0; c < 2; ++c) { /* rounding may lead to the next pixel; pixels without water are ignored */
                sure = sure && fabs(place[c] - round(place[c])) > 1e-3;
                left = left || place[c] < 0 || place[c] > SIDE;
                there[c] = (int)fmin(fmax(place[c], 0), SIDE - 1);
            }
            sure = sure && down_at(there[1]) > 0.1;
            if (sure) way = refracted_length(from, ray, there[0], there[1], place);
        }
        sure = sure && down_at(fmin(floor(place[1]), SIDE - 1)) > 0.11;
        if (!sure) continue;
        /* pow: 16 ULP of an exponent below 1, and a dozen roundings of the length before */
        assert_true(fabs((double)seen[4 * i + 1] - 0.5 * pow(0.5, way)) < 1e-5);
        ++count, beyond += left;
    }
    print_message("# %d pixels, %d of them with rays that leave the picture\n", count, beyond);
    assert_true(count > SIDE * SIDE / 8 && beyond > SIDE);
    free(seen);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_of_it_brings_the_picture_nearer),
        cmocka_unit_test(all_else_stays),
        cmocka_unit_test(encodings_change_nothing),
        cmocka_unit_test(the_sky_is_behind_the_cube_map),
        cmocka_unit_test(depth_is_looked_up_at_the_refracted_position),
        cmocka_unit_test(a_flat_mirror_is_looked_up_in_place),
    };
    return cmocka_run_group_tests_name("gpu_water", tests, gpu_set_up, gpu_tear_down);
}
