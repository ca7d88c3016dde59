/* The neighbours with which reflections are shared, and their weights: blur/plus, and temporal/rough without history. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 96, HALF = SIZE / 2 };

/* A wall in relief: tilted normals, patches of roughness, steps of depth and some sky. Pixels of a 2 x 2 block are equal, so that the
   pick affects only the position. */
static void relief(const struct plain *plain, float *values) {
    uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        uint32_t x = i % plain->width / 2, y = i / plain->width / 2;
        double lean = 0.3 * sin(0.7 * x) * cos(0.5 * y), length = sqrt(1 + lean * lean);
        values[PLAIN_NORMAL_X * pixels + i] = (float)(lean / length);
        values[PLAIN_NORMAL_Z * pixels + i] = (float)(1 / length);
        values[PLAIN_ROUGHNESS * pixels + i] = (float)(0.05 + 0.9 * ((x / 5 * 7 + y / 4 * 3) % 11) / 10);
        values[i] = (x / 9 + y / 7) % 3 == 0 ? 4.5f : 5;
        if (x % 17 == 3 && y % 13 == 4) values[i] = INFINITY;
    }
}

struct images {
    float *depth, *normal, *color;
    uint32_t *pick;
};

static void position(const struct images *in, int x, int y, double out[3]) {
    int i = y * HALF + x;
    double d = (double)in->depth[i], u = (2 * x + (int)(in->pick[i] & 1) + 0.5) / SIZE,
           v = (2 * y + (int)(in->pick[i] >> 1) + 0.5) / SIZE;
    const double focal = 1 / tan(30 * 3.14159265358979323846 / 180); /* 60 degrees, square */
    out[0] = (2 * u - 1) / focal * d, out[1] = (1 - 2 * v) / focal * d, out[2] = -d;
}

/* The value of a lobe by the cosine between normals, 1 at the peak: cosⁿ, or GGX's density. */
static double lobe(bool ggx, double roughness, double cosine) {
    const double a2 = pow(roughness, 4);
    return ggx ? pow(a2 / (1 - cosine * cosine * (1 - a2)), 2) : pow(cosine, 2 / a2 - 2);
}

/* Derived from the slides' rules and the definitions of the parameters; default values. */
static double weight(const struct images *in, bool ggx, int x, int y, int ox, int oy) {
    if (ox < 0 || oy < 0 || ox >= HALF || oy >= HALF) return 0;
    int i = y * HALF + x, o = oy * HALF + ox;
    if (!isfinite(in->depth[o])) return 0;
    double from[3], to[3], off = 0, cosine = 0, lengths[2] = {0, 0};
    position(in, x, y, from);
    position(in, ox, oy, to);
    for (int k = 0; k < 3; ++k) {
        double a = (double)in->normal[4 * i + k], b = (double)in->normal[4 * o + k];
        off += a * (to[k] - from[k]);
        cosine += a * b;
        lengths[0] += a * a, lengths[1] += b * b;
    }
    double rough = (double)in->normal[4 * i + 3], other = (double)in->normal[4 * o + 3];
    if (fabs(off) > 0.01 * (double)in->depth[i] || fabs(rough - other) > 0.1) return 0;
    double fade = fmin(fmax((rough - 0.05) / 0.1, 0), 1);
    return fade * lobe(ggx, rough, fmin(cosine / sqrt(lengths[0] * lengths[1]), 1));
}

static void load_relief(struct gpu *gpu) {
    char path[256];
    plain_capture(
        gpu_path(gpu, "relief", path),
        &(struct plain){.width = SIZE, .height = SIZE, .roughness = 0.5f, .fov_y_degrees = 60, .spoil = relief});
    gpu_load(gpu, "relief");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_shader(gpu, "resolve", "stand_in.comp");
    gpu_set(gpu, "resolve.texel_scale=1");
}

/* The weighted mean over a cross of offsets. */
static void expect_mean(struct gpu *gpu, bool ggx, const char *before, const char *after, const int offsets[4][2]) {
    struct images in = {gpu_floats(gpu, "depth_half", NULL, NULL), gpu_floats(gpu, "normal_half", NULL, NULL),
                        gpu_floats(gpu, before, NULL, NULL), gpu_uints(gpu, "pick", NULL, NULL)};
    float *found = gpu_floats(gpu, after, NULL, NULL);
    double worst = 0;
    int shared = 0, refused = 0;
    for (int y = 0; y < HALF; ++y)
        for (int x = 0; x < HALF; ++x) {
            int i = y * HALF + x;
            double total = 1, sum = (double)in.color[4 * i];
            for (int k = 0; k < 4 && isfinite(in.depth[i]); ++k) {
                int ox = x + offsets[k][0], oy = y + offsets[k][1];
                double w = weight(&in, ggx, x, y, ox, oy);
                shared += w > 0.5, refused += w == 0;
                if (w > 0) sum += w * (double)in.color[4 * (oy * HALF + ox)], total += w;
            }
            worst = fmax(worst, fabs((double)found[4 * i] - sum / total));
        }
    print_message("# %s: %d weights above 0.5, %d are 0, worst error %.3g\n", after, shared, refused, worst);
    assert_true(shared > 500 && refused > 500);
    /* images are floats; steep lobes have no weight, since their neighbours differ by more than the rounding of 6e-8 */
    assert_true(worst < 1e-5);
    free(in.depth), free(in.normal), free(in.color), free(in.pick), free(found);
}

static const int plus[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
static const int centres[4][2] = {{1, 2}, {2, -1}, {-1, -2}, {-2, 1}};

static void a_plus_is_weighted_by_the_lobe(void **state) {
    struct gpu *gpu = *state;
    for (int ggx = 0; ggx < 2; ++ggx) {
        load_relief(gpu);
        gpu_use(gpu, "blur=plus");
        gpu_set(gpu, ggx ? "blur.ndf=ggx" : "blur.ndf=blinn_phong");
        gpu_run(gpu);
        expect_mean(gpu, ggx, "reflection_half", "reflection_blurred", plus);
    }
}

static void without_history_the_centres_around_are_shared_too(void **state) {
    struct gpu *gpu = *state;
    load_relief(gpu);
    gpu_use(gpu, "blur=plus");
    gpu_use(gpu, "temporal=rough");
    gpu_run(gpu);
    expect_mean(gpu, true, "reflection_blurred", "reflection_temporal", centres);
}

/* Any value, including NaN, stays as if the pass did not run. Roughness is at least 0.05, where sharing begins. */
static void what_shares_nothing_keeps_what_it_has(struct gpu *gpu) {
    float *before = gpu_floats(gpu, "reflection_half", NULL, NULL),
          *after = gpu_floats(gpu, "reflection_blurred", NULL, NULL),
          *surface = gpu_floats(gpu, "normal_half", NULL, NULL);
    int bad = 0, kept = 0;
    for (int i = 0; i < HALF * HALF; ++i) {
        if (surface[4 * i + 3] != 0.05f) continue;
        ++kept;
        bad += !isfinite(before[4 * i]);
        for (int k = 0; k < 3; ++k) {
            const float a = before[4 * i + k], b = after[4 * i + k];
            assert_true(a == b || (isnan(a) && isnan(b)));
        }
    }
    assert_true(kept > 100 && bad > 0);
    free(before), free(after), free(surface);
}

static void bad_colours_are_left_out(void **state) {
    struct gpu *gpu = *state;
    for (int mips = 0; mips < 2; ++mips) {
        load_relief(gpu);
        gpu_set(gpu, "resolve.texel_scale=2");
        gpu_use(gpu, mips ? "blur=mips" : "blur=plus");
        if (!mips) gpu_use(gpu, "temporal=rough");
        gpu_run(gpu);
        if (!mips) what_shares_nothing_keeps_what_it_has(gpu);
        float *before = gpu_floats(gpu, "reflection_half", NULL, NULL),
              *after = gpu_floats(gpu, mips ? "reflection_blurred" : "reflection_temporal", NULL, NULL);
        int bad = 0;
        for (int i = 0; i < HALF * HALF; ++i) {
            bad += !isfinite(before[4 * i]);
            assert_true(isfinite(after[4 * i]));
        }
        assert_true(bad > 5);
        free(before), free(after);
    }
}

/* Each block's picked pixel comes from two texels to the right; with `user`, the motion of other pixels is zero. */
static void moves(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height, *pick = plain->user;
    for (uint32_t i = 0; i < pixels; ++i) {
        const uint32_t x = i % SIZE, y = i / SIZE, chosen = pick ? pick[y / 2 * HALF + x / 2] : 0;
        if (!pick || chosen == 2 * (y & 1) + (x & 1)) values[PLAIN_MOTION_X * pixels + i] = 4.0f / SIZE;
    }
}

/* The second of two frames: history and picks. */
static float *second_frame(struct gpu *gpu, const uint32_t *pick) {
    for (uint32_t frame = 1; frame <= 2; ++frame) {
        char path[256], name[16];
        snprintf(name, sizeof name, "%s%u", pick ? "picked" : "all", frame);
        plain_capture(gpu_path(gpu, name, path), &(struct plain){.width = SIZE,
                                                                 .height = SIZE,
                                                                 .roughness = 0.5f,
                                                                 .fov_y_degrees = 60,
                                                                 .frame = frame,
                                                                 .spoil = frame == 2 ? moves : NULL,
                                                                 .user = pick});
        gpu_load(gpu, name);
        gpu_run(gpu);
    }
    return gpu_floats(gpu, "reflection_temporal", NULL, NULL);
}

/* The history of a block is at the previous position of its picked pixel, whatever the motion of its other pixels is. */
static void the_picked_pixel_moves_its_block(void **state) {
    struct gpu *gpu = *state;
    load_relief(gpu);
    gpu_use(gpu, "temporal=rough");
    float *all = second_frame(gpu, NULL);
    uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL), others = 0;
    float *picked = second_frame(gpu, pick), *still = gpu_floats(gpu, "reflection_half", NULL, NULL);
    size_t remember = 0;
    for (int i = 0; i < HALF * HALF; ++i) {
        others += pick[i] != 0;
        for (int k = 0; k < 3; ++k) remember += all[4 * i + k] != still[4 * i + k];
    }
    assert_true(others > 100 && remember > 3 * HALF * HALF / 2);
    assert_memory_equal(all, picked, 4 * HALF * HALF * sizeof *all);
    free(all), free(picked), free(pick), free(still);
}

/* A still picture of bright and dark rays beside each other, and a camera that is turned, so that reprojection has rounding errors: each texel's
   history is its own, of which no bright neighbour has a share. */
static void chequered(UNUSED uint32_t number, const double d[3], float out[5]) {
    const int odd = ((int)floor(40 * d[0]) + (int)floor(40 * d[1])) % 2 != 0;
    for (int k = 0; k < 3; ++k) out[k] = odd ? 30000 : 0.25F;
    out[3] = 1, out[4] = 100;
}
static const double turned[16] = {0.36, 0.48, -0.8, 0, -0.8, 0.6, 0, 0, 0.48, 0.64, 0.6, 0, 0, 0, 0, 1};
static void turned_wall(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < 3 * pixels; ++i) /* the view's +z in the world */
        values[PLAIN_NORMAL_X * pixels + i] = (float)turned[8 + i / pixels];
}
static void a_still_picture_keeps_its_texels(void **state) {
    struct gpu *gpu = *state;
    gpu_reset(gpu);
    gpu->float_precision = true;
    static const char *const words[] = {"downsample.jitter=false", "screen_trace.length_m=0",
                                        "resolve.filter_color=false", "temporal.motion=false", "temporal.extra=false"};
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, "cubemap_trace=lookup");
    gpu_use(gpu, "temporal=rough");
    for (size_t w = 0; w < sizeof words / sizeof *words; ++w) gpu_set(gpu, words[w]);
    for (uint32_t frame = 1; frame <= 2; ++frame) {
        char path[256];
        plain_capture(gpu_path(gpu, "still", path), &(struct plain){.width = HALF,
                                                                    .height = HALF,
                                                                    .roughness = 0.5f,
                                                                    .fov_y_degrees = 60,
                                                                    .frame = frame,
                                                                    .world_to_view = turned,
                                                                    .spoil = turned_wall,
                                                                    .cube_size = 32,
                                                                    .cube_count = 1,
                                                                    .cube = chequered});
        gpu_load(gpu, "still");
        gpu_run(gpu);
    }
    float *now = gpu_floats(gpu, "reflection_half", NULL, NULL),
          *mean = gpu_floats(gpu, "reflection_temporal", NULL, NULL),
          *age = gpu_floats(gpu, "temporal_age", NULL, NULL);
    int dark = 0, old = 0;
    double worst = 0;
    for (int i = 0; i < HALF * HALF; ++i) {
        old += age[i] == 2, dark += now[4 * i] < 1;
        worst = fmax(worst, fabs((double)mean[4 * i] / (double)now[4 * i] - 1));
    }
    print_message("# %d with a history, %d dark, off by at most %g\n", old, dark, worst);
    assert_true(old == HALF * HALF && dark > HALF * HALF / 4 && worst < 1e-6);
    free(now), free(mean), free(age);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plus_is_weighted_by_the_lobe),
        cmocka_unit_test(without_history_the_centres_around_are_shared_too),
        cmocka_unit_test(bad_colours_are_left_out),
        cmocka_unit_test(the_picked_pixel_moves_its_block),
        cmocka_unit_test(a_still_picture_keeps_its_texels),
    };
    return cmocka_run_group_tests_name("gpu_blur_plus", tests, gpu_set_up, gpu_tear_down);
}
