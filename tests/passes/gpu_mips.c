/* MIP chains of cube maps, sky and screen, compared with filters in double precision. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "end_reason_names.h"
#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

static const double texel_scale = 3.5, threshold = 0.1;

static double dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static float *level_of(struct gpu *gpu, const char *image, uint32_t level, uint32_t *width, uint32_t *height) {
    char name[64];
    snprintf(name, sizeof name, level ? "%s.level%u" : "%s", image, level);
    return gpu_floats(gpu, name, width, height);
}

static uint32_t level_count(uint32_t size) {
    uint32_t count = 1;
    while (size > 1) size /= 2, ++count;
    return count;
}

static void load_capture(struct gpu *gpu, const char *name, const struct plain *plain) {
    char path[256];
    plain_capture(gpu_path(gpu, name, path), plain);
    gpu_load(gpu, name);
    gpu_reset(gpu);
    gpu->float_precision = gpu->all = true; /* mirrors read no coarser level */
    gpu_use(gpu, "cubemap_mips=prefilter");
    gpu_use(gpu, "sky_mips=prefilter");
    gpu_use(gpu, "lit_mips=cone");
}

static struct plain plain_with(uint32_t size, void (*cube)(uint32_t, const double *, float *)) {
    struct plain plain = {
        .width = 20, .height = 12, .fov_y_degrees = 60, .cube_size = size, .cube_count = 1, .cube = cube};
    plain.cubes[0].center[2] = -2;
    return plain;
}

static void gray(UNUSED uint32_t number, UNUSED const double direction[3], float out[5]) {
    const float values[5] = {0.25f, 0.5f, 1.0f, 1.0f, 3.0f};
    memcpy(out, values, sizeof values);
}
static void gray_sky(const double direction[3], float out[3]) {
    float all[5];
    gray(0, direction, all);
    memcpy(out, all, 3 * sizeof *out);
}

static void a_constant_environment_stays_constant(void **state) {
    struct gpu *gpu = *state;
    static const char *const images[] = {"cubemap_color_mips", "sky_mips", "lit_mips", "cubemap_distance_mips"};
    const uint32_t sizes[] = {16, 12, 1}; /* 12: has a level of odd size, 3 */
    for (int s = 0; s < 3; ++s) {
        struct plain plain = plain_with(sizes[s], gray);
        plain.sky = gray_sky;
        load_capture(gpu, "constant", &plain);
        gpu_run(gpu);
        for (int k = 0; k < 4; ++k)
            for (uint32_t level = 0; level < (k == 2 ? 5 : level_count(sizes[s])); ++level) {
                uint32_t width, height;
                float *found = level_of(gpu, images[k], level, &width, &height);
                const float lit[4] = {0.25f, 0.5f, 1.0f, 1.0f}, cube[4] = {0.25f, 0.5f, 1.0f, 1.0f};
                for (uint32_t i = 0; i < width * height; ++i)
                    if (k == 3) assert_true(fabs((double)found[i] / 3 - 1) < 2e-6);
                    else
                        for (uint32_t c = 0; c < 3; ++c) { /* sums of 29 products: a few roundings */
                            double expected = (double)(k == 2 ? lit : cube)[c];
                            if (!(fabs((double)found[4 * i + c] / expected - 1) < 2e-6))
                                fail_msg("%s level %u: %g, expected %g", images[k], level, (double)found[4 * i + c],
                                         expected);
                        }
                free(found);
            }
    }
}

/* Slides, MIP pre-filtering, with the angle that FACTS derives: a level corresponds to a cone of 3.5 of its texels. */
static double cone_tangent(uint32_t level, uint32_t size) {
    return ldexp(texel_scale, (int)level) / (size / 2.0);
}

/* The solid angle of a texel from its centre's direction and its area, accurate for small texels. */
static double solid_angle(double x, double y, uint32_t size) {
    double u = 2 * (x + 0.5) / size - 1, v = 2 * (y + 0.5) / size - 1;
    return 4.0 / size / size / pow(1 + u * u + v * v, 1.5);
}

/* Integrates the lobe cosⁿ over all base texels inside the cone. */
static void integrate(const float *base, uint32_t size, const double axis[3], double tangent, double out[4]) {
    double rim = 1 / sqrt(1 + tangent * tangent), power = log(threshold) / log(rim), total = 0;
    for (int c = 0; c < 4; ++c) out[c] = 0;
    for (uint32_t i = 0; i < 6 * size * size; ++i) {
        double direction[3];
        plain_direction(i / (size * size), i % size, i / size % size, size, direction);
        double cosine = dot3(axis, direction);
        if (cosine < rim) continue;
        double weight = pow(cosine, power) * solid_angle(i % size, i / size % size, size);
        total += weight;
        for (uint32_t c = 0; c < 4; ++c) out[c] += weight * (double)base[4 * i + c];
    }
    for (int c = 0; c < 4; ++c) out[c] /= total;
}

/* Smooth in red, an edge in green, a lamp in blue; the upper half is sky. */
static void varied(UNUSED uint32_t number, const double d[3], float out[5]) {
    double a = d[1] < 0.2 ? 1 : 0;
    out[0] = (float)(a * (1 + 0.4 * d[0] + 0.3 * d[1] * d[2]));
    out[1] = (float)(a * (d[0] > 0.1 ? 1 : 0.2));
    out[2] = (float)(a * (0.05 + 4 * exp(-60 * (1 - (0.6 * d[0] - 0.64 * d[1] + 0.48 * d[2])))));
    out[3] = (float)a;
    out[4] = a > 0 ? (float)(2 + d[0]) : INFINITY;
}

/* The root of the mean squared error of each level over all channels. */
static void errors_of_levels(struct gpu *gpu, uint32_t size, double *errors) {
    uint32_t width, height;
    float *base = level_of(gpu, "cubemap_color_box", 0, &width, &height);
    for (uint32_t level = 1; level < level_count(size); ++level) {
        float *found = level_of(gpu, "cubemap_color_mips", level, &width, &height);
        double sum = 0;
        for (uint32_t i = 0; i < width * height; ++i) {
            double axis[3], expected[4];
            plain_direction(i / (width * width), i % width, i / width % width, width, axis);
            integrate(base, size, axis, cone_tangent(level, size), expected);
            for (int c = 0; c < 4; ++c) sum += pow((double)found[4 * i + (uint32_t)c] - expected[c], 2);
        }
        errors[level] = sqrt(sum / (width * height * 4));
        free(found);
    }
    free(base);
}

static void levels_stand_for_the_lobe_of_their_cone(void **state) {
    struct gpu *gpu = *state;
    enum { SIZE = 32 };
    static const char *const variants[] = {"cubemap_mips.reach=0", "cubemap_mips.reach=3", "cubemap_mips.reach=18"};
    double errors[3][8];
    struct plain plain = plain_with(SIZE, varied);
    load_capture(gpu, "varied", &plain);
    for (int v = 0; v < 3; ++v) {
        gpu_set(gpu, variants[v]);
        gpu_run(gpu);
        errors_of_levels(gpu, SIZE, errors[v]);
    }
    for (uint32_t level = 1; level < level_count(SIZE); ++level) {
        print_message("# level %u against the lobe over all texels, RMSE: box %.4f, 29 taps %.4f, 1009 taps %.4f\n",
                      level, errors[0][level], errors[1][level], errors[2][level]);
        /* the coarsest level has one texel per face, whose box is already wide */
        bool coarsest = level + 1 == level_count(SIZE);
        assert_true(errors[1][level] < (coarsest ? 1 : 0.2) * errors[0][level]);
        assert_true(errors[2][level] < (coarsest ? 1 : 0.2) * errors[1][level]);
        assert_true(errors[1][level] < 0.03 && errors[2][level] < 0.015); /* for an image between 0 and 4 */
    }
}

static void colour_is_weighted_by_what_is_not_sky(void **state) {
    struct gpu *gpu = *state;
    struct plain plain = plain_with(32, varied);
    load_capture(gpu, "varied", &plain);
    gpu_run(gpu);
    for (uint32_t level = 0; level < 6; ++level) {
        uint32_t width, height;
        float *found = level_of(gpu, "cubemap_color_mips", level, &width, &height);
        double mean = 0, total = 0;
        for (uint32_t i = 0; i < width * height; ++i) {
            const float *t = &found[4 * i];
            double weight = solid_angle(i % width, i / width % width, width);
            assert_true(t[3] >= 0 && (double)t[3] <= 1 + 1e-6);
            /* Green is 0.2 or 1 without the sky, whatever the fraction of sky is. */
            assert_true((double)t[1] >= 0.2 * (double)t[3] - 1e-6 && (double)t[1] <= (double)t[3] + 1e-6);
            mean += weight * (double)t[3];
            total += weight;
        }
        /* 60 % of the sphere are below y = 0.2; the solid angles of coarse texels are accurate to a few per cent. */
        assert_true(fabs(mean / total - 0.6) < 0.05);
        free(found);
    }
}

/* Computed directly from the finer level: all texels that a texel covers, with their shares. 12, 6, 3, 1. */
static void distances_join_what_is_not_sky(void **state) {
    struct gpu *gpu = *state;
    static const char *const joins[] = {"mean", "nearest", "farthest"};
    for (int join = 0; join < 3; ++join) {
        struct plain plain = plain_with(12, varied);
        load_capture(gpu, "twelve", &plain);
        char setting[64];
        snprintf(setting, sizeof setting, "cubemap_mips.join=%s", joins[join]);
        gpu_use(gpu, join == 1 ? "cubemap_mips=plain" : "cubemap_mips=prefilter");
        gpu_set(gpu, setting);
        gpu_run(gpu);
        size_t skies = 0;
        for (uint32_t level = 1; level < 4; ++level) {
            uint32_t finer, width, height;
            float *from = level_of(gpu, "cubemap_distance_mips", level - 1, &finer, &height);
            float *found = level_of(gpu, "cubemap_distance_mips", level, &width, &height);
            for (uint32_t i = 0; i < width * height; ++i) {
                uint32_t x = i % width, y = i / width % width, face = i / (width * width);
                double sum = 0, total = 0, least = INFINITY, most = 0;
                for (uint32_t k = 0; k < finer * finer; ++k) {
                    double scale = (double)finer / width, u = k % finer, v = k / finer;
                    double wide = fmin(u + 1, (x + 1) * scale) - fmax(u, x * scale);
                    double high = fmin(v + 1, (y + 1) * scale) - fmax(v, y * scale);
                    double distance = (double)from[face * finer * finer + k];
                    if (!(wide > 1e-9 && high > 1e-9) || isinf(distance)) continue;
                    sum += wide * high * distance;
                    total += wide * high;
                    least = fmin(least, distance);
                    most = fmax(most, distance);
                }
                double expected = total == 0 ? INFINITY : join == 0 ? sum / total : join == 1 ? least : most;
                skies += isinf(expected) != 0;
                if (isinf(expected)) assert_true(isinf(found[i]));
                else assert_true(fabs((double)found[i] / expected - 1) < 1e-6);
            }
            free(from);
            free(found);
        }
        assert_true(skies > 5);
    }
}

static void ramp(const struct plain *plain, float *values) {
    size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; ++i)
        values[PLAIN_LIT_G * pixels + i] = (float)(i * 2654435761u % 1000) / 1000 + (i % plain->width > 20 ? 5 : 0);
}

/* A channel interpolated between texels, clamped to the border. */
static double bilinear(const float *image, uint32_t width, uint32_t height, double u, double v) {
    double x = u * width - 0.5, y = v * height - 0.5, sum = 0;
    for (int k = 0; k < 4; ++k) {
        double cx = floor(x) + k % 2, cy = floor(y) + k / 2, weight = (1 - fabs(x - cx)) * (1 - fabs(y - cy));
        uint32_t ix = (uint32_t)fmin(fmax(cx, 0), width - 1.0), iy = (uint32_t)fmin(fmax(cy, 0), height - 1.0);
        sum += weight * (double)image[4 * (iy * width + ix) + 1];
    }
    return sum;
}

static void the_picture_is_filtered_with_29_taps(void **state) {
    struct gpu *gpu = *state;
    struct plain plain = {.width = 37, .height = 21, .fov_y_degrees = 60, .spoil = ramp};
    load_capture(gpu, "ramp", &plain);
    gpu_run(gpu);
    for (uint32_t level = 1; level < 6; ++level) {
        uint32_t finer_width, finer_height, width, height, taps = 0;
        float *finer = level_of(gpu, "lit_mips", level - 1, &finer_width, &finer_height);
        float *found = level_of(gpu, "lit_mips", level, &width, &height);
        double worst = 0;
        for (uint32_t i = 0; i < width * height; ++i) {
            double sum = 0, total = 0;
            taps = 0;
            for (int y = -9; y <= 9; ++y)
                for (int x = -9; x <= 9; ++x) {
                    if (x * x + y * y > 9) continue;
                    double sharper = level == 1 ? 1 : 1.75; /* the variance that the finer level already has */
                    double weight = pow(threshold, sharper * (x * x + y * y) / (texel_scale * texel_scale));
                    double u = (i % width + 0.5 + x) / width, v = (i / width + 0.5 + y) / height;
                    sum += weight * bilinear(finer, finer_width, finer_height, u, v);
                    total += weight;
                    ++taps;
                }
            worst = fmax(worst, fabs((double)found[4 * i + 1] / (sum / total) - 1));
        }
        print_message("# picture, level %u: worst relative error %.2g\n", level, worst);
        assert_int_equal(taps, 29);
        /* the sampler's weights are multiples of 1/256: 29 lookups have random errors of 1/512 of a contrast of 6 */
        assert_true(worst < 5e-3);
        free(finer);
        free(found);
    }
}

static void dot_of_light(const struct plain *plain, float *values) {
    uint32_t pixels = plain->width * plain->height, middle = plain->height / 2 * plain->width + plain->width / 2;
    for (uint32_t i = 0; i < pixels; ++i)
        for (uint32_t c = 0; c < 3; ++c) values[(PLAIN_LIT_R + c) * pixels + i] = i == middle ? 1000.0f : 0.0f;
}

/* Each level is computed from a finer one; together they must spread light like the lobe threshold^((r/3.5)²), cut at 3.5 texels. */
static void every_level_of_the_picture_is_as_wide_as_its_cone(void **state) {
    struct gpu *gpu = *state;
    enum { SIZE = 128 };
    struct plain plain = {.width = SIZE, .height = SIZE, .fov_y_degrees = 60, .spoil = dot_of_light};
    load_capture(gpu, "dot", &plain);
    gpu_run(gpu);
    double sum = 0, total = 0, step = 0.01;
    for (double r = step / 2; r < texel_scale; r += step) {
        double weight = r * pow(threshold, r * r / (texel_scale * texel_scale));
        sum += weight * r * r / 2, total += weight;
    }
    for (uint32_t level = 1; level < 5; ++level) {
        uint32_t width, height;
        float *found = level_of(gpu, "lit_mips", level, &width, &height);
        double light = 0, spread = 0, mean = 0;
        for (uint32_t i = 0; i < width * height; ++i) {
            double x = i % width;
            light += (double)found[4 * i + 1], mean += (double)found[4 * i + 1] * x,
                spread += (double)found[4 * i + 1] * x * x;
        }
        mean /= light;
        double ratio = sqrt((spread / light - mean * mean) / (sum / total));
        print_message("# picture, level %u: %.3f of the cone's width\n", level, ratio);
        assert_true(ratio > 0.9 && ratio < 1.02); /* the last taps are at 3 of the cone's 3.5 texels: 1.67 of 1.98 */
        free(found);
    }
}

static void spoiled(const struct plain *plain, float *values) {
    size_t pixels = (size_t)plain->width * plain->height;
    values[PLAIN_LIT_R * pixels + 7 * plain->width + 9] = NAN;
    values[PLAIN_LIT_G * pixels + 3 * plain->width + 2] = INFINITY;
}

static void bad_pixels_do_not_spread(void **state) {
    struct gpu *gpu = *state;
    struct plain plain = {.width = 24, .height = 16, .fov_y_degrees = 60, .spoil = spoiled};
    load_capture(gpu, "spoiled", &plain);
    gpu_run(gpu);
    for (uint32_t level = 1; level < 5; ++level) {
        uint32_t width, height;
        float *found = level_of(gpu, "lit_mips", level, &width, &height);
        for (uint32_t i = 0; i < width * height * 4; ++i) assert_true(isfinite(found[i]));
        free(found);
    }
}

/* ---- colours at the ends of wide rays ---- */

/* A floor whose left half is a mirror and whose right half is rough, below a sky that is red in the picture. */
static void red_sky(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const bool floor = values[PLAIN_NORMAL_Y * pixels + i] > 0.5f;
        if (!floor) values[PLAIN_DEPTH * pixels + i] = INFINITY;
        if (i % plain->width >= plain->width / 2) values[PLAIN_ROUGHNESS * pixels + i] = 0.5f;
        for (uint32_t c = 0; c < 3; ++c) values[(PLAIN_LIT_R + c) * pixels + i] = floor ? 0 : c == 0 ? 2 : 0.125f;
    }
}

/* The picture shows a part of the sky, which a wide ray exceeds, so that its colour is that of the sky's cube map; a mirror's is in the picture. */
static void wide_rays_into_the_sky_see_its_cube_map(void **state) {
    static const float sky[3] = {0.25f, 0.5f, 1.0f}, seen[3] = {2, 0.125f, 0.125f};
    struct gpu *gpu = *state;
    struct plain plain = {.width = 64,
                          .height = 48,
                          .fov_y_degrees = 60,
                          .floor = true,
                          .spoil = red_sky,
                          .cube_size = 8,
                          .sky = gray_sky};
    load_capture(gpu, "red", &plain);
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_use(gpu, "screen_trace=dda");
    gpu_run(gpu);
    uint32_t *end = gpu_uints(gpu, "screen_end", NULL, NULL), wide = 0, narrow = 0;
    float *color = gpu_floats(gpu, "reflection_half", NULL, NULL);
    for (uint32_t i = 0; i < 64 * 48; ++i) {
        if (end[i] != END_sky) continue;
        const bool rough = i % 64 >= 32;
        *(rough ? &wide : &narrow) += 1;
        for (uint32_t c = 0; c < 3; ++c) assert_true(fabsf(color[4 * i + c] - (rough ? sky : seen)[c]) < 1e-5f);
    }
    print_message("# %u wide rays, %u narrow ones\n", wide, narrow);
    assert_true(wide > 300 && narrow > 300);
    free(end), free(color);
}

/* Sky, but for a square of 2 x 2 texels of 64 on the face +Z. */
static void small_lamp(UNUSED uint32_t number, const double d[3], float out[5]) {
    const bool lamp = d[2] > 0 && fabs(d[0]) < 0.032 * d[2] && fabs(d[1]) < 0.032 * d[2];
    for (int k = 0; k < 4; ++k) out[k] = lamp ? 1 : 0;
    out[4] = lamp ? 4 : INFINITY;
}

/* Where less than a 64th of a level is surfaces, their colour is not divided by more than that. The ray of the central pixel ends on the lamp. */
static void a_small_share_of_surfaces_is_not_enlarged(void **state) {
    struct gpu *gpu = *state;
    enum { WIDTH = 21, HEIGHT = 13, MIDDLE = HEIGHT / 2 * WIDTH + WIDTH / 2 };
    struct plain plain = plain_with(64, small_lamp);
    plain.width = WIDTH, plain.height = HEIGHT, plain.roughness = 1;
    load_capture(gpu, "lamp", &plain);
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_use(gpu, "cubemap_trace=sphere");
    gpu_set(gpu, "cubemap_trace.default_m=4");
    gpu_run(gpu);
    float *coarsest = level_of(gpu, "cubemap_color_mips", 6, NULL, NULL),
          *color = gpu_floats(gpu, "reflection_half", NULL, NULL);
    const float share = coarsest[4 * 4 + 3], *found = color + 4 * MIDDLE;
    print_message("# of a share of %g: %g\n", (double)share, (double)found[0]);
    assert_true(share > 0 && share < 1.0f / 128);
    for (int c = 0; c < 3; ++c) assert_true(fabsf(found[c] / (64 * share) - 1) < 0.02f); /* weights of 8 bits */
    free(coarsest), free(color);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_environment_stays_constant),
        cmocka_unit_test(levels_stand_for_the_lobe_of_their_cone),
        cmocka_unit_test(colour_is_weighted_by_what_is_not_sky),
        cmocka_unit_test(distances_join_what_is_not_sky),
        cmocka_unit_test(the_picture_is_filtered_with_29_taps),
        cmocka_unit_test(every_level_of_the_picture_is_as_wide_as_its_cone),
        cmocka_unit_test(bad_pixels_do_not_spread),
        cmocka_unit_test(wide_rays_into_the_sky_see_its_cube_map),
        cmocka_unit_test(a_small_share_of_surfaces_is_not_enlarged),
    };
    return cmocka_run_group_tests_name("gpu_mips", tests, gpu_set_up, gpu_tear_down);
}
