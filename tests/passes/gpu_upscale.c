/* upscale/best_match: the texel that a pixel uses; resolve_sharp: the colour of smooth pixels. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 128 };

/* Left half: a nearer surface, stippled in every other pixel. Right half: vertical bars of it, five pixels wide. */
static float depth_at(uint32_t x, uint32_t y) {
    return (x < SIZE / 2 ? (x + y) % 2 : x / 5 % 2) ? 2 : 5;
}
static void two_surfaces(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < plain->width * plain->height; ++i)
        values[i] = depth_at(i % plain->width, i / plain->width);
}

static void load_stripes(struct gpu *gpu, float roughness, bool floor) {
    char path[256];
    plain_capture(gpu_path(gpu, "surfaces", path), &(struct plain){.width = SIZE,
                                                                   .height = SIZE,
                                                                   .roughness = roughness,
                                                                   .fov_y_degrees = 60,
                                                                   .floor = floor,
                                                                   .spoil = floor ? NULL : two_surfaces});
    gpu_load(gpu, "surfaces");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "upscale=best_match");
}

/* Counts pixels whose reflection is from the other surface. */
static int mistaken(struct gpu *gpu) {
    gpu_run(gpu);
    float *color = gpu_floats(gpu, "reflection", NULL, NULL);
    int wrong = 0;
    for (uint32_t i = 0; i < SIZE * SIZE; ++i) wrong += color[4 * i] != depth_at(i % SIZE, i / SIZE);
    free(color);
    return wrong;
}

static void every_pixel_takes_a_sample_of_its_own_surface(void **state) {
    static const char *const worse[] = {"upscale.depth_weight=0", "downsample.tie=near", NULL};
    struct gpu *gpu = *state;
    for (int i = 0; i < 4; ++i) {
        load_stripes(gpu, 0.5f, false);
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=3");
        if (i == 3) gpu_use(gpu, "upscale=bilinear");
        else if (worse[(i + 2) % 3]) gpu_set(gpu, worse[(i + 2) % 3]);
        int wrong = mistaken(gpu);
        print_message("# %s: %d of %d pixels from the other surface\n",
                      i == 3               ? "bilinear"
                      : worse[(i + 2) % 3] ? worse[(i + 2) % 3]
                                           : "defaults",
                      wrong, SIZE * SIZE);
        assert_true(i == 0 ? wrong == 0 : wrong > SIZE * SIZE / 10);
    }
}

/* Catches: an image without the blur or the history of the pipeline. At full resolution every pixel uses its own texel. */
static void the_last_of_the_images_is_taken(void **state) {
    static const char *const steps[] = {NULL, "blur=plus", "temporal=rough"}, *const made[] = {"reflection_half",
                                                                                               "reflection_blurred",
                                                                                               "reflection_temporal"};
    struct gpu *gpu = *state;
    load_stripes(gpu, 0.5f, true);
    gpu_use(gpu, "downsample=none");
    for (int s = 0; s < 3; ++s) {
        if (steps[s]) gpu_use(gpu, steps[s]);
        gpu_run(gpu);
        float *upscaled = gpu_floats(gpu, "reflection", NULL, NULL), *last = gpu_floats(gpu, made[s], NULL, NULL),
              *before = gpu_floats(gpu, made[s ? s - 1 : 0], NULL, NULL);
        int lit = 0, changed = 0;
        for (int i = 0; i < SIZE * SIZE; ++i) {
            for (int k = 0; k < 3; ++k) assert_true(fabsf(upscaled[4 * i + k] - last[4 * i + k]) < 1e-5f);
            lit += last[4 * i] > 0;
            changed += fabsf(last[4 * i] - before[4 * i]) > 1e-3f;
        }
        print_message("# %s: %d of %d texels lit, %d changed\n", made[s], lit, SIZE * SIZE, changed);
        assert_true(lit > SIZE && (changed > SIZE) == (s > 0));
        free(upscaled), free(last), free(before);
    }
}

/* Rays of every pixel, resolved twice, have the same colours. */
static void smooth_pixels_are_resolved_by_their_own_normals(void **state) {
    struct gpu *gpu = *state;
    load_stripes(gpu, 0, true);
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, "resolve_sharp=hit");
    gpu_run(gpu);
    float *upscaled = gpu_floats(gpu, "reflection", NULL, NULL),
          *sharp = gpu_floats(gpu, "reflection_sharp", NULL, NULL);
    uint32_t *source = gpu_uints(gpu, "sharp_source", NULL, NULL);
    int lit = 0;
    for (int i = 0; i < SIZE * SIZE; ++i) {
        for (int k = 0; k < 3; ++k) assert_true(fabs((double)(upscaled[4 * i + k] - sharp[4 * i + k])) < 1e-5);
        lit += upscaled[4 * i] > 0;
        assert_int_equal(source[i], 5);
    }
    assert_true(lit > SIZE);
    free(upscaled), free(sharp), free(source);
}

/* Vertical bars of 2.2 pixels on the wall, with sky between them. The mirror ray of a floor pixel appears to start at the mirror image
   of the camera below, and so hits the wall in the pixel's own column. */
static double per_pixel(void) {
    return 2 * tan(30 * M_PI / 180) / SIZE;
}
static bool is_bar(int x) {
    return (int)(5 * (x + 0.5 - SIZE / 2) * per_pixel() / 0.1 + 1000) % 2 == 1;
}
static void barred_wall(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const bool floor = values[PLAIN_NORMAL_Y * pixels + i] > 0.5f, bar = is_bar((int)(i % SIZE));
        float *normal[3];
        for (uint32_t k = 0; k < 3; ++k) normal[k] = &values[(PLAIN_NORMAL_X + k) * pixels + i];
        if (plain
                ->world_to_view) { /* the transpose turns directions back: y, z, x of the view are x, y, z of the world */
            const float seen[3] = {*normal[0], *normal[1], *normal[2]};
            for (int k = 0; k < 3; ++k) *normal[k] = seen[(k + 1) % 3];
        }
        if (!floor && !bar) values[PLAIN_DEPTH * pixels + i] = INFINITY;
        for (uint32_t k = 0; k < 3; ++k) values[(PLAIN_LIT_R + k) * pixels + i] = floor ? 0 : bar ? 1 : 4;
    }
}
static void bright(UNUSED const double direction[3], float out[3]) {
    for (int k = 0; k < 3; ++k) out[k] = 4;
}
static void nothing_but_sky(uint32_t number, const double direction[3], float out[5]) {
    (void)number, (void)direction;
    const float sky[5] = {4, 4, 4, 0, INFINITY};
    for (int k = 0; k < 5; ++k) out[k] = sky[k];
}

/* Whether a ray of one of the texels around the pixel hit a bar. */
static bool bar_was_hit_around(const float *travelled_m, const uint32_t *finished, int pixel) {
    const int x = pixel % SIZE / 2, y = pixel / SIZE / 2;
    for (int k = 0; k < 9; ++k) {
        const int u = x + k % 3 - 1, v = y + k / 3 - 1;
        if (u < 0 || v < 0 || u >= SIZE / 2 || v >= SIZE / 2) continue;
        if (finished[v * SIZE / 2 + u] && isfinite(travelled_m[v * SIZE / 2 + u])) return true;
    }
    return false;
}

/* The expected colour of each floor pixel is known: that of the wall in its column, at the height where its mirror ray hits. The ray
   that upscale chose may have hit something else. With `neighbours` a pixel misses no bar that a surrounding ray hit, and few pixels
   show a bar that is not there: those around which every ray hit one. All of it is the same in a world with other axes. */
static void the_own_ray_takes_the_hits_around_that_it_meets(void **state) {
    static const double turned[16] = {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    struct gpu *gpu = *state;
    char path[256];
    int missed[3] = {0}, invented[3] = {0}, bars_seen[3] = {0};
    for (int on = 0; on < 3; ++on) {
        plain_capture(gpu_path(gpu, "bars", path), &(struct plain){.width = SIZE,
                                                                   .height = SIZE,
                                                                   .fov_y_degrees = 60,
                                                                   .floor = true,
                                                                   .spoil = barred_wall,
                                                                   .sky = bright,
                                                                   .cube = nothing_but_sky,
                                                                   .cube_size = 8,
                                                                   .cube_count = 1,
                                                                   .world_to_view = on > 1 ? turned : NULL});
        gpu_load(gpu, "bars");
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_use(gpu, "screen_trace=hiz");
        gpu_use(gpu, "hiz=nearest");
        gpu_use(gpu, "upscale=best_match");
        gpu_use(gpu, "resolve_sharp=hit");
        gpu_set(gpu, "resolve_sharp.check_depth=true");
        gpu_set(gpu, on ? "resolve_sharp.neighbours=true" : "resolve_sharp.neighbours=false");
        gpu_run(gpu);
        float *sharp = gpu_floats(gpu, "reflection_sharp", NULL, NULL),
              *travelled_m = gpu_floats(gpu, "travelled", NULL, NULL);
        uint32_t *finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
        for (int i = 0; i < SIZE * SIZE; ++i) {
            if (5 * (i / SIZE + 0.5 - SIZE / 2) * per_pixel() < 1.1) continue; /* the wall, and the floor at its foot */
            const bool shows = fabsf(sharp[4 * i] - 1) < 0.5f, bar = is_bar(i % SIZE);
            missed[on] += bar && !shows && bar_was_hit_around(travelled_m, finished, i);
            invented[on] += !bar && shows;
            bars_seen[on] += bar && shows;
        }
        free(sharp), free(travelled_m), free(finished);
    }
    print_message("# bars hit around and not shown: %d, with neighbours %d; shown and not there: %d, with neighbours "
                  "%d; shown: %d\n",
                  missed[0], missed[1], invented[0], invented[1], bars_seen[1]);
    assert_true(missed[0] > 10 && missed[1] == 0 && 4 * invented[1] < invented[0] && bars_seen[1] > SIZE);
    print_message("# with other axes: not shown %d, not there %d, shown %d\n", missed[2], invented[2], bars_seen[2]);
    assert_true(missed[2] == 0 && 4 * invented[2] < invented[0] && bars_seen[2] > SIZE);
}

/* Rough pixels are not sharpened, and a frame of rough pixels has nothing to resolve again. */
static void rough_pixels_keep_what_was_upscaled(void **state) {
    struct gpu *gpu = *state;
    load_stripes(gpu, 0.3f, true);
    gpu_use(gpu, "resolve_sharp=hit");
    gpu_run(gpu);
    uint32_t *source = gpu_uints(gpu, "sharp_source", NULL, NULL);
    for (int i = 0; i < SIZE * SIZE; ++i) assert_int_equal(source[i], 0);
    assert_null(glint_replay_find_image(gpu->replay, "reflection_sharp"));
    free(source);
}

/* Vertical bars of two roughnesses on a flat wall, five pixels wide: of three texels in a row, each bar contains one. */
static float roughness_at(uint32_t x) {
    return x / 5 % 2 ? 0.25F : 0.75F;
}
static void two_roughnesses(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) values[PLAIN_ROUGHNESS * pixels + i] = roughness_at(i % plain->width);
}

static void load_wall(struct gpu *gpu, void (*spoil)(const struct plain *, float *)) {
    char path[256];
    plain_capture(gpu_path(gpu, "rough", path),
                  &(struct plain){.width = SIZE, .height = SIZE, .fov_y_degrees = 60, .spoil = spoil});
    gpu_load(gpu, "rough");
    gpu_reset(gpu);
    gpu->float_precision = gpu->all = true;
    gpu_use(gpu, "upscale=best_match");
    gpu_shader(gpu, "resolve", "stand_in.comp");
    gpu_set(gpu, "resolve.texel_scale=5");
}

/* If depths and normals are equal, a texel of the pixel's own roughness is used: another one costs 10 · 0.5, and the farthest texel,
   3.5 pixels away along each axis, less than 0.02 · 25. */
static void roughness_alone_tells_surfaces_apart(void **state) {
    struct gpu *gpu = *state;
    for (int blind = 0; blind < 2; ++blind) {
        load_wall(gpu, two_roughnesses);
        if (blind) gpu_set(gpu, "upscale.roughness_weight=0");
        gpu_run(gpu);
        float *color = gpu_floats(gpu, "reflection", NULL, NULL);
        int wrong = 0;
        for (uint32_t i = 0; i < SIZE * SIZE; ++i) wrong += color[4 * i] != roughness_at(i % SIZE);
        print_message("# %s: %d of %d pixels of the other roughness\n", blind ? "blind" : "defaults", wrong,
                      SIZE * SIZE);
        assert_true(blind ? wrong > SIZE : wrong == 0);
        free(color);
    }
}

/* Random eighths, so that any of the surrounding texels may be the best. */
static void any_roughness(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) values[PLAIN_ROUGHNESS * pixels + i] = (float)(i * 2654435761U >> 20 & 7) / 8;
}

/* With `around` off, candidates are the texel of the pixel and those on the pixel's side of its centre, as for bilinear interpolation.
   Each of the four is the best for some pixels. */
static void the_four_nearest_are_those_on_the_pixels_side(void **state) {
    struct gpu *gpu = *state;
    int taken[4] = {0};
    load_wall(gpu, any_roughness);
    gpu_set(gpu, "upscale.around=false");
    gpu_set(gpu, "upscale.sharp_roughness=1");
    gpu_run(gpu);
    uint32_t *source = gpu_uints(gpu, "sharp_source", NULL, NULL);
    for (int i = 0; i < SIZE * SIZE; ++i) {
        assert_in_range(source[i], 1, 9);
        const int x = (int)(source[i] - 1) % 3 - 1, y = (int)(source[i] - 1) / 3 - 1;
        assert_true(x == 0 || x == (i % SIZE % 2 ? 1 : -1));
        assert_true(y == 0 || y == (i / SIZE % 2 ? 1 : -1));
        ++taken[(x != 0) + 2 * (y != 0)];
    }
    for (int k = 0; k < 4; ++k) assert_true(taken[k] > SIZE * SIZE / 20);
    free(source);
}

/* The costs of the texels around a pixel, whose surfaces differ by their roughness alone; infinite beyond the picture. */
static void costs_of(const float *normal, const uint32_t *pick, uint32_t pixel, double distance_weight, double out[9]) {
    const int half = SIZE / 2, x = (int)(pixel % SIZE), y = (int)(pixel / SIZE);
    for (int n = 0; n < 9; ++n) {
        const int tx = x / 2 + n % 3 - 1, ty = y / 2 + n / 3 - 1, t = ty * half + tx;
        out[n] = INFINITY;
        if (tx < 0 || ty < 0 || tx >= half || ty >= half) continue;
        const double rough = fabs((double)normal[4 * t + 3] - (double)(pixel * 2654435761U >> 20 & 7) / 8);
        const double dx = 2 * tx + (int)(pick[t] & 1) - x, dy = 2 * ty + (int)(pick[t] >> 1 & 1) - y;
        out[n] = 10 * rough + distance_weight * (dx * dx + dy * dy);
    }
}

/* The texel is the cheapest one in double: ten times the difference of roughness, which is a multiple of an eighth, and the weighted square of
   the distance in pixels. Where two costs are as good as equal, by 0.001 and the rounding of ten times a roughness, either is taken. */
static void the_cheapest_texel_is_taken(void **state) {
    static const double weights[] = {0.02, 0.37, 2.9};
    struct gpu *gpu = *state;
    for (int w = 0; w < 3; ++w) {
        char word[64];
        load_wall(gpu, any_roughness);
        snprintf(word, sizeof word, "upscale.distance_weight=%g", weights[w]);
        gpu_set(gpu, word);
        gpu_set(gpu, "upscale.sharp_roughness=1");
        gpu_run(gpu);
        uint32_t *source = gpu_uints(gpu, "sharp_source", NULL, NULL), *pick = gpu_uints(gpu, "pick", NULL, NULL);
        float *normal = gpu_floats(gpu, "normal_half", NULL, NULL);
        int sure = 0, beside = 0;
        for (uint32_t i = 0; i < SIZE * SIZE; ++i) {
            double costs[9];
            int best = 0, near = 0;
            costs_of(normal, pick, i, weights[w], costs);
            for (int n = 1; n < 9; ++n) best = costs[n] < costs[best] ? n : best;
            for (int n = 0; n < 9; ++n) near += costs[n] < costs[best] + 2 * (1e-3 + 10.0 / 2048);
            if (near > 1) continue;
            assert_int_equal(source[i], best + 1);
            sure++, beside += best != 4;
        }
        print_message("# weight %g: %d pixels have a cheapest texel, %d of them not their own\n", weights[w], sure,
                      beside);
        assert_true(sure > SIZE * SIZE / 2 && (w == 2 || beside > SIZE * SIZE / 8));
        free(source), free(pick), free(normal);
    }
}

static float by_chance(uint32_t i) {
    return i * 2654435761U >> 20 & 1 ? 1.0F : -1.0F;
}
/* Half a step of a half float, up or down. */
static void rounded_roughness(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) values[PLAIN_ROUGHNESS * pixels + i] += by_chance(i) / 4096;
}
/* Half a step of an 18-bit mantissa. */
static void rounded_depth(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < plain->width * plain->height; ++i) values[i] *= 1 + by_chance(i) / 524288;
}

/* On a flat wall all texels are equally good; which one a pixel uses must not depend on the rounding of roughness or depth. */
static void rounding_chooses_no_other_sample(void **state) {
    struct gpu *gpu = *state;
    void (*const spoils[])(const struct plain *, float *) = {NULL, rounded_roughness, rounded_depth};
    uint32_t *source[3];
    size_t other[3] = {0}, beside = 0;
    for (int i = 0; i < 3; ++i) {
        char path[256];
        plain_capture(gpu_path(gpu, "wall", path),
                      &(struct plain){
                          .width = SIZE, .height = SIZE, .roughness = 0.75F, .fov_y_degrees = 60, .spoil = spoils[i]});
        gpu_load(gpu, "wall");
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_use(gpu, "upscale=best_match");
        gpu_set(gpu, "upscale.sharp_roughness=1");
        if (spoils[i] == rounded_depth) gpu_set(gpu, "upscale.roughness_weight=0");
        gpu_run(gpu);
        source[i] = gpu_uints(gpu, "sharp_source", NULL, NULL);
        for (size_t k = 0; k < SIZE * SIZE; ++k) other[i] += source[0][k] != source[i][k], beside += source[i][k] != 5;
    }
    print_message("# %zu, %zu of %d pixels take another sample\n", other[1], other[2], SIZE * SIZE);
    assert_true(other[1] == 0 && other[2] == 0 && beside > SIZE * SIZE);
    for (int i = 0; i < 3; ++i) free(source[i]);
}

static void sky_above(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const bool is_sky = i / plain->width < SIZE / 2;
        if (is_sky) values[i] = INFINITY;
        values[PLAIN_ROUGHNESS * pixels + i] = is_sky ? 0 : 0.5F;
    }
}

/* The colours are the roughness, which is constant: so is the interpolation of the texels that have rays. */
static void what_has_no_ray_darkens_nothing(void **state) {
    struct gpu *gpu = *state;
    load_wall(gpu, sky_above);
    gpu->all = false;
    gpu_use(gpu, "upscale=bilinear");
    gpu_run(gpu);
    float *color = gpu_floats(gpu, "reflection", NULL, NULL);
    for (uint32_t i = 0; i < SIZE * SIZE; ++i) {
        const double expected = i / SIZE < SIZE / 2 ? 0 : 0.5;
        assert_true(fabs((double)color[4 * i] - expected) <= 8 * 0x1p-24); /* sums of four, and a quotient */
    }
    free(color);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pixel_takes_a_sample_of_its_own_surface),
        cmocka_unit_test(roughness_alone_tells_surfaces_apart),
        cmocka_unit_test(the_four_nearest_are_those_on_the_pixels_side),
        cmocka_unit_test(the_cheapest_texel_is_taken),
        cmocka_unit_test(rounding_chooses_no_other_sample),
        cmocka_unit_test(the_last_of_the_images_is_taken),
        cmocka_unit_test(smooth_pixels_are_resolved_by_their_own_normals),
        cmocka_unit_test(the_own_ray_takes_the_hits_around_that_it_meets),
        cmocka_unit_test(rough_pixels_keep_what_was_upscaled),
        cmocka_unit_test(what_has_no_ray_darkens_nothing),
    };
    return cmocka_run_group_tests_name("gpu_upscale", tests, gpu_set_up, gpu_tear_down);
}
