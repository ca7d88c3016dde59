/* blur/mips compared with its definition in double precision: box-filtered levels, between which a pixel's cone selects; and what blur/upscale_blur
   takes from coarser levels where they are narrow or of other surfaces. */
#include <math.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 128, HALF = SIZE / 2, LEVELS = 7 };

/* Stripes of roughness, depths in steps of a third; a corner is sky. */
static void stripes(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const uint32_t x = i % SIZE / 2, y = i / SIZE / 2;
        values[PLAIN_ROUGHNESS * pixels + i] = 0.1f * (float)(x / 4 % 8);
        values[i] = x < 12 && y < 9 ? INFINITY : 3 + (float)(y / 16);
    }
}

static void far_away(UNUSED uint32_t number, const double direction[3], float out[5]) {
    for (int k = 0; k < 4; ++k) out[k] = 1;
    out[4] = direction[0] > 0 ? 40 : INFINITY;
}

/* R and the weight of each level. */
struct chain {
    double texels[LEVELS][HALF * HALF][2];
};

static void build(struct chain *chain, const float *color, const float *depth) {
    for (size_t i = 0; i < HALF * HALF; ++i) {
        const bool usable = isfinite(depth[i]) && isfinite(color[4 * i]);
        chain->texels[0][i][0] = usable ? (double)color[4 * i] : 0;
        chain->texels[0][i][1] = usable;
    }
    for (int l = 1; l < LEVELS; ++l) {
        const size_t width = HALF >> l;
        for (size_t i = 0; i < width * width; ++i)
            for (int k = 0; k < 2; ++k) {
                double sum = 0;
                for (size_t c = 0; c < 4; ++c)
                    sum += chain->texels[l - 1][(2 * (i / width) + c / 2) * 2 * width + 2 * (i % width) + c % 2][k];
                chain->texels[l][i][k] = sum / 4;
            }
    }
}

/* Bilinear interpolation around a position in pixels of level 0, clamped to the border. */
static void tap(const struct chain *chain, int level, double x, double y, double out[2]) {
    const int width = HALF >> level;
    const double u = x / (1 << level) - 0.5, v = y / (1 << level) - 0.5, left = floor(u), top = floor(v);
    out[0] = out[1] = 0;
    for (int c = 0; c < 4; ++c) {
        const int column = (int)fmin(fmax(left + c % 2, 0), width - 1),
                  row = (int)fmin(fmax(top + c / 2, 0), width - 1);
        const double part = (c % 2 ? u - left : 1 - u + left) * (c / 2 ? v - top : 1 - v + top);
        for (int k = 0; k < 2; ++k) out[k] += part * chain->texels[level][row * width + column][k];
    }
}

/* The radius in texels of the cone at the mirrored hit point, which lies behind the surface at the hit distance. */
static double level_of(size_t i, double depth_m, double travelled_m, double cone, uint32_t pick, double widest) {
    const double half = tan(30 * 3.14159265358979323846 / 180);
    const double x = half * ((2 * (2 * (double)(i % HALF) + (pick & 1)) + 1) / SIZE - 1),
                 y = half * ((2 * (2 * (double)(i / HALF) + (pick >> 1)) + 1) / SIZE - 1);
    const double away_m = depth_m * sqrt(1 + x * x + y * y);
    const double part = isfinite(travelled_m) ? travelled_m / (travelled_m + away_m) : 1;
    const double radius = tan(fmin(cone, 1.57)) * part / (2 * half) * HALF;
    return log2(fmax(fmin(radius, 0.5 * widest * HALF), 1));
}

static void a_cone_chooses_between_boxes(void **state) {
    struct gpu *gpu = *state;
    static const double widths[] = {0.25, 0.05};
    for (int w = 0; w < 2; ++w) {
        char path[256];
        plain_capture(gpu_path(gpu, "stripes", path), &(struct plain){.width = SIZE,
                                                                      .height = SIZE,
                                                                      .fov_y_degrees = 60,
                                                                      .spoil = stripes,
                                                                      .cube_size = 8,
                                                                      .cube_count = 1,
                                                                      .cube = far_away});
        gpu_load(gpu, "stripes");
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_set(gpu, "downsample.share=0");
        gpu_use(gpu, "blur=mips");
        gpu_set(gpu, w ? "blur.max_width=0.05" : "blur.max_width=0.25");
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=2");
        gpu_run(gpu);
        float *color = gpu_floats(gpu, "reflection_half", NULL, NULL),
              *depth = gpu_floats(gpu, "depth_half", NULL, NULL), *travelled = gpu_floats(gpu, "travelled", NULL, NULL),
              *cone = gpu_floats(gpu, "cone_half", NULL, NULL),
              *found = gpu_floats(gpu, "reflection_blurred", NULL, NULL);
        uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL);
        static struct chain chain;
        build(&chain, color, depth);
        double worst = 0, sharpest = INFINITY, widest = 0;
        for (size_t i = 0; i < HALF * HALF; ++i) {
            if (!isfinite(depth[i])) {
                assert_true(found[4 * i] == (isfinite(color[4 * i]) ? color[4 * i] : 0));
                continue;
            }
            const double level =
                level_of(i, (double)depth[i], (double)travelled[i], (double)cone[i], pick[i], widths[w]);
            const int fine = (int)floor(level);
            double a[2], b[2], mean[2];
            tap(&chain, fine, (double)(i % HALF) + 0.5, (double)(i / HALF) + 0.5, a);
            tap(&chain, fine + 1, (double)(i % HALF) + 0.5, (double)(i / HALF) + 0.5, b);
            for (int k = 0; k < 2; ++k) mean[k] = a[k] + (level - fine) * (b[k] - a[k]);
            if (mean[1] > 0) worst = fmax(worst, fabs((double)found[4 * i] - mean[0] / mean[1]));
            sharpest = fmin(sharpest, level), widest = fmax(widest, level);
        }
        print_message("# up to %g of the width: levels %.2f to %.2f, worst difference %.4f\n", widths[w], sharpest,
                      widest, worst);
        /* Vulkan allows weights of filters and levels in steps of 1/256: two of them, for colours up to 2, divided by weights of which
           up to a hundredth of the texels are missing. */
        assert_true(worst < 3 * 2.0 / 256 && sharpest == 0 && widest > (w ? 0.6 : 2.9));
        free(color), free(depth), free(travelled), free(cone), free(found), free(pick);
    }
}

static void sharing(struct gpu *gpu, const struct plain *plain, const char *const *settings) {
    char path[256];
    plain_capture(gpu_path(gpu, "sharing", path), plain);
    gpu_load(gpu, "sharing");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "downsample=mips");
    gpu_use(gpu, "blur=upscale_blur");
    for (; *settings; ++settings) gpu_set(gpu, *settings);
    gpu_shader(gpu, "resolve", "stand_in.comp");
    gpu_set(gpu, "resolve.texel_scale=1");
    gpu_run(gpu);
}

/* Texels of another roughness, one in each 8 x 8. */
static void specks(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i)
        values[PLAIN_ROUGHNESS * pixels + i] = i % SIZE / 2 % 8 == 3 && i / SIZE / 2 % 8 == 4 ? 0.9f : 0.5f;
}

/* A texel of whose surface the coarser level has none is interpolated from those around it, if their lobes agree: bilinearly where they all do. */
static void lone_texels_are_interpolated(void **state) {
    static const char *const settings[] = {"blur.width=8", "blur.roughness_part=1", NULL};
    struct gpu *gpu = *state;
    enum { COARSE = HALF / 2 };
    sharing(gpu,
            &(struct plain){.width = SIZE,
                            .height = SIZE,
                            .fov_y_degrees = 60,
                            .spoil = specks,
                            .cube_size = 8,
                            .cube_count = 1,
                            .cube = far_away},
            settings);
    float *coarse = gpu_floats(gpu, "reflection_levels.level1", NULL, NULL),
          *surface = gpu_floats(gpu, "normal_levels.level1", NULL, NULL),
          *fine = gpu_floats(gpu, "reflection_blurred", NULL, NULL);
    int count = 0;
    for (int y = 4; y < HALF; y += 8)
        for (int x = 3; x < HALF; x += 8) {
            double expected = 0;
            for (int i = 0; i < 4;
                 ++i) { /* an even row is nearer to the parents above it, an odd column to those at its right */
                const int at_x = x / 2 + (i & 1), at_y = y / 2 - (i >> 1), at = at_y * COARSE + at_x;
                assert_true(surface[4 * at + 3] < 0.6f);
                expected += (i & 1 ? 0.25 : 0.75) * (i >> 1 ? 0.25 : 0.75) * (double)coarse[4 * at];
            }
            assert_true(fabs((double)fine[4 * (y * HALF + x)] - expected) < 1e-5);
            count++;
        }
    assert_int_equal(count, 64);
    free(coarse), free(surface), free(fine);
}

/* Four pixels wide: both coarser levels are one texel wide. Without blur a texel is the mean of the four, or two, of the finer level. */
static void narrow_levels_are_means(void **state) {
    static const char *const settings[] = {"blur.width=0", "blur.radius=0", NULL};
    static const char *const names[] = {"reflection_levels", "reflection_levels.level1", "reflection_levels.level2"};
    struct gpu *gpu = *state;
    sharing(gpu, &(struct plain){.width = 4, .height = 64, .fov_y_degrees = 60, .roughness = 0.5f}, settings);
    uint32_t width, height, finer_width;
    float *finer = gpu_floats(gpu, names[0], &finer_width, NULL);
    for (int level = 1; level < 3; ++level) {
        float *found = gpu_floats(gpu, names[level], &width, &height);
        assert_true(width == 1 && height == (uint32_t)(32 >> level));
        for (uint32_t y = 0; y < height; ++y) {
            double sum = 0;
            for (uint32_t i = 0; i < 2 * finer_width; ++i) sum += (double)finer[4 * (2 * y * finer_width + i)];
            assert_true(fabs((double)found[4 * y] - sum / (2 * finer_width)) < 1e-6);
        }
        free(finer);
        finer = found, finer_width = width;
    }
    free(finer);
}

/* A Gaussian of σ 1.5 texels within the picture, up to 3 texels to either side, along rows and then along columns. */
static double gaussian(const double *values, int count, int at, int step) {
    double sum = 0, total = 0;
    for (int i = 0; i < count; ++i) {
        const double weight = abs(i - at) > 3 ? 0 : exp(-2.0 / 9 * (i - at) * (i - at));
        sum += weight * values[i * step], total += weight;
    }
    return sum / total;
}
static void the_coarsest_level_is_blurred_within_the_picture(void **state) {
    enum { WIDE = 10, HIGH = 7 };
    static const char *const settings[] = {"blur.width=0", "blur.radius=3", NULL};
    struct gpu *gpu = *state;
    double level[HIGH][WIDE], rows[HIGH][WIDE];
    sharing(gpu, &(struct plain){.width = 8 * WIDE, .height = 8 * HIGH, .fov_y_degrees = 60, .roughness = 0.5f},
            settings);
    float *finer = gpu_floats(gpu, "reflection_levels.level1", NULL, NULL),
          *across = gpu_floats(gpu, "reflection_across", NULL, NULL),
          *both = gpu_floats(gpu, "reflection_levels.level2", NULL, NULL);
    for (int y = 0; y < HIGH; ++y)
        for (int x = 0; x < WIDE; ++x) {
            level[y][x] = 0;
            for (int i = 0; i < 4; ++i)
                level[y][x] += 0.25 * (double)finer[4 * ((2 * y + i / 2) * 2 * WIDE + 2 * x + i % 2)];
        }
    for (int y = 0; y < HIGH; ++y)
        for (int x = 0; x < WIDE; ++x) {
            rows[y][x] = gaussian(level[y], WIDE, x, 1);
            assert_true(fabs((double)across[4 * (y * WIDE + x)] - rows[y][x]) < 1e-5);
        }
    for (int y = 0; y < HIGH; ++y)
        for (int x = 0; x < WIDE; ++x)
            assert_true(fabs((double)both[4 * (y * WIDE + x)] - gaussian(&rows[0][x], HIGH, y, WIDE)) < 1e-5);
    free(finer), free(across), free(both);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cone_chooses_between_boxes), cmocka_unit_test(lone_texels_are_interpolated),
        cmocka_unit_test(narrow_levels_are_means), cmocka_unit_test(the_coarsest_level_is_blurred_within_the_picture)};
    return cmocka_run_group_tests_name("gpu_blur_mips", tests, gpu_set_up, gpu_tear_down);
}
