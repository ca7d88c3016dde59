/* The variants of Mafia: Definitive Edition: rays around the mirror direction, levels with edges, sharing at three resolutions, and
   colour of the previous frame. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 128, SPLIT = 37 };
static const double oblique = 0.6;
static double split_depth[2] = {2, 5}; /* on the left and right of SPLIT */

static void tilt(const struct plain *plain, float *values) {
    uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        values[PLAIN_NORMAL_X * pixels + i] = (float)sin(oblique);
        values[PLAIN_NORMAL_Z * pixels + i] = (float)cos(oblique);
    }
}

static void two_walls(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < plain->width * plain->height; ++i)
        values[i] = (float)split_depth[i % plain->width >= SPLIT];
}

/* Everything is at a distance of 100 m. */
static void far_away(uint32_t number, const double direction[3], float out[5]) {
    (void)number, (void)direction;
    for (int k = 0; k < 5; ++k) out[k] = k == 4 ? 100 : 1;
}

static void load_capture(struct gpu *gpu, const struct plain *plain) {
    char path[256];
    struct plain with = *plain;
    with.cube_size = 8;
    with.cube_count = 1;
    with.cube = far_away;
    plain_capture(gpu_path(gpu, "mafia_de", path), &with);
    gpu_load(gpu, "mafia_de");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "downsample=mips");
}

/* ---- rays ---- */

static void rays_lie_evenly_around_the_mirror_direction(void **state) {
    struct gpu *gpu = *state;
    const double alpha = 0.3 * 0.3, mirror[3] = {sin(2 * oblique), 0, cos(2 * oblique)};
    double off[2];
    for (int reflection = 0; reflection < 2; ++reflection) {
        /* The viewer is at +z to within 0.005 rad. */
        load_capture(
            gpu, &(struct plain){
                     .width = 2 * SIZE, .height = 2 * SIZE, .roughness = 0.3f, .fov_y_degrees = 0.5, .spoil = tilt});
        gpu_set(gpu, reflection ? "downsample.lobe=reflection" : "downsample.lobe=half_vector");
        gpu_run(gpu);
        float *normal = gpu_floats(gpu, "normal_jittered", NULL, NULL);
        double mean[3] = {0}, length = 0, across = 0;
        int near = 0;
        for (int i = 0; i < SIZE * SIZE; ++i) {
            const double n[3] = {(double)normal[4 * i], (double)normal[4 * i + 1], (double)normal[4 * i + 2]};
            double ray[3], cosine = 0;
            for (int k = 0; k < 3; ++k) ray[k] = 2 * n[2] * n[k] - (k == 2);
            for (int k = 0; k < 3; ++k) mean[k] += ray[k], cosine += ray[k] * mirror[k];
            near += acos(fmin(cosine, 1)) < 2 * atan(alpha);
        }
        for (int k = 0; k < 3; ++k) length += mean[k] * mean[k], across += mean[k] * mirror[k];
        off[reflection] = acos(across / sqrt(length));
        print_message("# %s: mean ray %.4f rad from the mirror direction, %.3f of the rays within 2 atan alpha\n",
                      reflection ? "reflection" : "half_vector", off[reflection], (double)near / SIZE / SIZE);
        /* tan² of GGX is below t with the probability t/(α² + t): half of the normals are within atan α. Samples below the horizon, at
           most 1 %, are repeated; three deviations of a half for 16384 samples are 0.012. From an oblique direction the lobe of the
           surface is narrower across. */
        const double apart = fabs((double)near / SIZE / SIZE - 0.5);
        assert_true(reflection ? apart < 0.02 : apart > 0.03);
        free(normal);
    }
    /* The mean of 16384 rays that deviate by 0.3 rad is accurate to 0.0024 rad; the viewer's position adds 0.005. */
    assert_true(off[1] < 0.012);
}

static void a_mirror_has_its_own_ray(void **state) {
    struct gpu *gpu = *state;
    load_capture(gpu, &(struct plain){.width = SIZE, .height = SIZE, .fov_y_degrees = 60, .spoil = tilt});
    gpu_set(gpu, "downsample.lobe=reflection");
    gpu_run(gpu);
    float *normal = gpu_floats(gpu, "normal_jittered", NULL, NULL), *own = gpu_floats(gpu, "normal_half", NULL, NULL);
    assert_memory_equal(normal, own, (size_t)SIZE * SIZE * sizeof *normal);
    free(normal), free(own);
}

/* ---- levels ---- */

static uint32_t open_side(uint32_t edges, uint32_t side) {
    return edges >> 2 * side & 3;
}

static void levels_hold_pixels_of_the_picture_and_their_edges(void **state) {
    struct gpu *gpu = *state;
    static const char *const levels[] = {"", ".level1", ".level2"};
    const double half = tan(30 * 3.14159265358979323846 / 180);
    load_capture(gpu, &(struct plain){.width = SIZE + 6, .height = SIZE + 2, .fov_y_degrees = 60, .floor = true});
    gpu_run(gpu);
    for (uint32_t l = 0; l < 3; ++l) {
        char name[64];
        uint32_t width, height, borders = 0;
        snprintf(name, sizeof name, "depth_levels%s", levels[l]);
        float *depth = gpu_floats(gpu, name, &width, &height);
        snprintf(name, sizeof name, "vertex_normal_levels%s", levels[l]);
        float *place = gpu_floats(gpu, name, NULL, NULL);
        snprintf(name, sizeof name, "normal_levels%s", levels[l]);
        float *normal = gpu_floats(gpu, name, NULL, NULL);
        snprintf(name, sizeof name, "edge_levels%s", levels[l]);
        uint32_t *edges = gpu_uints(gpu, name, NULL, NULL);
        assert_int_equal(width, (SIZE + 6) >> (l + 1));
        assert_int_equal(height, (SIZE + 2) >> (l + 1));
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const uint32_t i = y * width + x, offset = (uint32_t)place[4 * i + 3];
                assert_true((offset & 7) < 2U << l && offset >> 3 < 2U << l);
                const double down = (2 * ((y << (l + 1)) + (offset >> 3)) + 1.0) / (SIZE + 2) - 1;
                const double expected = fmin(5, down > 0 ? 1 / (down * half) : 5);
                assert_true(fabs((double)depth[i] - expected) < 1e-5 * expected);
                const bool floor = normal[4 * i + 1] == 1;
                assert_true(floor == (expected < 5));
                if (x + 1 < width) { /* neighbours of one surface, from both sides */
                    assert_int_equal(open_side(edges[i], 1), 3);
                    assert_int_equal(open_side(edges[i + 1], 0), 3);
                } else assert_int_equal(open_side(edges[i], 1), 0);
                if (y + 1 < height) {
                    const bool parted = floor != (normal[4 * (i + width) + 1] == 1);
                    assert_int_equal(open_side(edges[i], 3), parted ? 0 : 3);
                    assert_int_equal(open_side(edges[i + width], 2), parted ? 0 : 3);
                    borders += parted;
                }
            }
        assert_int_equal(borders, width);
        free(depth), free(place), free(normal), free(edges);
    }
}

static void stripes_of_roughness(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i)
        values[PLAIN_ROUGHNESS * pixels + i] = i % plain->width / 8 % 2 ? 0.46f : 0.3f;
}

/* A pair of texels halfway between being one surface and two has a partially open edge: a difference of 0.16 with a limit of 0.2 for
   roughness leaves 0.4, and equal planes and normals do not increase it. */
static void edges_are_open_in_part(void **state) {
    struct gpu *gpu = *state;
    load_capture(gpu,
                 &(struct plain){.width = SIZE, .height = SIZE, .fov_y_degrees = 60, .spoil = stripes_of_roughness});
    gpu_run(gpu);
    uint32_t width, height, *edges = gpu_uints(gpu, "edge_levels", &width, &height);
    for (uint32_t i = 0; i < width * height; ++i) {
        if (i % width + 1 < width) assert_int_equal(open_side(edges[i], 1), i % width % 4 == 3 ? 1 : 3);
        if (i + width < width * height) assert_int_equal(open_side(edges[i], 3), 3);
    }
    free(edges);
}

/* ---- sharing ---- */

static void statistics(struct gpu *gpu, const char *image, double *mean, double *variance) {
    float *color = gpu_floats(gpu, image, NULL, NULL);
    double sum = 0, squares = 0;
    for (size_t i = 0; i < SIZE * SIZE; ++i) sum += (double)color[4 * i], squares += pow((double)color[4 * i], 2);
    *mean = sum / SIZE / SIZE;
    *variance = squares / SIZE / SIZE - *mean * *mean;
    free(color);
}

static void noise_of_rough_surfaces_falls_and_mirrors_keep_theirs(void **state) {
    struct gpu *gpu = *state;
    for (int rough = 0; rough < 2; ++rough) {
        double mean[2], variance[2];
        load_capture(
            gpu, &(struct plain){
                     .width = 2 * SIZE, .height = 2 * SIZE, .roughness = rough ? 0.7f : 0.15f, .fov_y_degrees = 60});
        gpu_use(gpu, "blur=upscale_blur");
        gpu_set(gpu, rough ? "blur.width=1" : "blur.width=0");
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=1");
        gpu_run(gpu);
        statistics(gpu, "reflection_half", &mean[0], &variance[0]);
        statistics(gpu, "reflection_blurred", &mean[1], &variance[1]);
        print_message("# %s: mean %.4f to %.4f, variance %.4f to %.5f\n", rough ? "rough" : "no width", mean[0],
                      mean[1], variance[0], variance[1]);
        /* A texel of the coarsest level is the mean of 16; a Gaussian of σ 1.5 averages 4π 1.5² of these. Interpolation smooths
           further. Pixels at the border have more weight, which moves the mean by its own deviation. */
        if (rough) assert_true(variance[1] < variance[0] / (16 * 4 * 3.1415 * 1.5 * 1.5) * 1.5 && variance[1] > 0);
        else assert_true(variance[1] == variance[0]);
        assert_true(fabs(mean[1] - mean[0]) < 4 * sqrt(variance[0]) / SIZE);
    }
}

/* The colours are the depths, so that leaks are visible. The border between the walls crosses blocks of every level. */
static int leaks(struct gpu *gpu, const char *image, uint32_t shift) {
    uint32_t width, height;
    float *color = gpu_floats(gpu, image, &width, &height), *depth = gpu_floats(gpu, "depth_half", NULL, NULL);
    int count = 0;
    for (uint32_t i = 0; i < width * height; ++i) {
        const double own = shift ? (double)depth[i] : split_depth[i % width >= SPLIT];
        count += fabs((double)color[4 * i] - own) > 1e-3 * own;
    }
    free(color), free(depth);
    return count;
}

static void nothing_leaks_over_edges(void **state) {
    struct gpu *gpu = *state;
    for (int off = 0; off < 2; ++off) {
        load_capture(
            gpu,
            &(struct plain){.width = SIZE, .height = SIZE, .roughness = 0.7f, .fov_y_degrees = 60, .spoil = two_walls});
        gpu_use(gpu, "blur=upscale_blur");
        gpu_use(gpu, "upscale=edges");
        gpu_set(gpu, "blur.width=1");
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=3");
        if (off) gpu_set(gpu, "blur.edges=false");
        gpu_run(gpu);
        int blurred = leaks(gpu, "reflection_blurred", 1);
        print_message("# %s: %d texels leak\n", off ? "blind" : "edges", blurred);
        assert_true(off ? blurred > SIZE : blurred == 0);
        if (off) continue;
        int upscaled = leaks(gpu, "reflection", 0);
        gpu_use(gpu, "upscale=bilinear");
        gpu_run(gpu);
        int bilinear = leaks(gpu, "reflection", 0);
        print_message("# upscaled: %d pixels leak, %d bilinear\n", upscaled, bilinear);
        assert_true(upscaled == 0 && bilinear >= SIZE);
    }
}

static void sharing(struct gpu *gpu, const struct plain *plain, const char *colors) {
    load_capture(gpu, plain);
    gpu_use(gpu, "blur=upscale_blur");
    gpu_set(
        gpu,
        "blur.width=8"); /* lobes are wider than the texels of any level, so that all colours are from coarser ones */
    gpu_shader(gpu, "resolve", "stand_in.comp");
    gpu_set(gpu, colors);
}

/* Without edges, every texel is the bilinear interpolation of the next level: three quarters of the nearest texel along each axis. */
static void blind_levels_are_upscaled_bilinearly(void **state) {
    struct gpu *gpu = *state;
    enum { N = SIZE / 2, COARSE = N / 2 };
    sharing(gpu, &(struct plain){.width = SIZE, .height = SIZE, .roughness = 0.7f, .fov_y_degrees = 60},
            "resolve.texel_scale=1");
    gpu_set(gpu, "blur.edges=false");
    gpu_run(gpu);
    float *coarse = gpu_floats(gpu, "reflection_levels.level1", NULL, NULL),
          *fine = gpu_floats(gpu, "reflection_blurred", NULL, NULL);
    double worst = 0, spread = 0;
    for (int y = 0; y < N; ++y)
        for (int x = 0; x < N; ++x) {
            double expected = 0;
            for (int i = 0; i < 4; ++i) {
                const int cx = x / 2 + (i & 1) * (x % 2 ? 1 : -1), cy = y / 2 + (i >> 1) * (y % 2 ? 1 : -1);
                const int at_x = cx < 0        ? 0
                                 : cx < COARSE ? cx
                                               : COARSE - 1,
                          at_y = cy < 0        ? 0
                                 : cy < COARSE ? cy
                                               : COARSE - 1;
                expected += (i & 1 ? 0.25 : 0.75) * (i >> 1 ? 0.25 : 0.75) * (double)coarse[4 * (at_y * COARSE + at_x)];
            }
            worst = fmax(worst, fabs((double)fine[4 * (y * N + x)] - expected));
            spread = fmax(spread, fabs((double)coarse[4 * (y / 2 * COARSE + x / 2)] - expected));
        }
    print_message("# off by %.2g, the nearest texel by %.2g\n", worst, spread);
    assert_true(worst < 2 * 8 * 0x1p-24 && spread > 1e-3); /* eight roundings of values below 2 */
    free(coarse), free(fine);
}

static void slanted_bars(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i)
        values[PLAIN_ROUGHNESS * pixels + i] = (i % plain->width / 2 + i / plain->width / 2) % 5 ? 0.6f : 0.9f;
}

/* The colours are the roughness. Along bars of one texel there are texels whose parent texel was picked beside the bar, and surrounding
   parent texels that were picked from the bar: these give the colour. */
static void bars_keep_their_colours(void **state) {
    struct gpu *gpu = *state;
    enum { N = SIZE / 2 };
    sharing(gpu, &(struct plain){.width = SIZE, .height = SIZE, .fov_y_degrees = 60, .spoil = slanted_bars},
            "resolve.texel_scale=5");
    gpu_run(gpu);
    float *color = gpu_floats(gpu, "reflection_blurred", NULL, NULL);
    double worst = 0;
    for (int i = 0; i < N * N; ++i) worst = fmax(worst, fabs((double)color[4 * i] - ((i % N + i / N) % 5 ? 0.6 : 0.9)));
    print_message("# off by %.2g\n", worst);
    assert_true(worst < 1e-5); /* means of up to 49 equal values, three times */
    free(color);
}

/* The colours are the normals. Where floor and wall meet, each is close to the other's plane, so that only normals distinguish them. A
   pixel gets the colour of its own surface if one of the four surrounding texels has it. */
static void corners_keep_their_colours(void **state) {
    struct gpu *gpu = *state;
    enum {
        EDGES,
        BLIND_TO_LOBES,
        BILINEAR,
        HEIGHT = SIZE - 4
    }; /* the corner crosses blocks, near a pixel of the floor */
    int wrong[3] = {0}, checked = 0;
    for (int kind = 0; kind < 3; ++kind) {
        load_capture(gpu, &(struct plain){.width = SIZE, .height = HEIGHT, .fov_y_degrees = 60, .floor = true});
        gpu_use(gpu, kind == BILINEAR ? "upscale=bilinear" : "upscale=edges");
        if (kind == BLIND_TO_LOBES) gpu_set(gpu, "upscale.lobes=false");
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=4");
        gpu_run(gpu);
        float *color = gpu_floats(gpu, "reflection", NULL, NULL),
              *full = gpu_part(gpu, "gbuffer", (const char *[]){"normal.Y"}, 1),
              *half = gpu_floats(gpu, "normal_half", NULL, NULL);
        for (int y = 1; y < HEIGHT - 1; ++y)
            for (int x = 1; x < SIZE - 1; ++x) {
                const float own = full[y * SIZE + x];
                const int row = (y - 1) / 2; /* of the upper two of the four texels */
                if (half[4 * (row * SIZE / 2 + x / 2) + 1] != own &&
                    half[4 * ((row + 1) * SIZE / 2 + x / 2) + 1] != own)
                    continue;
                checked += kind == EDGES;
                wrong[kind] += fabsf(color[4 * (y * SIZE + x) + 1] - own) > 1e-3f;
            }
        free(color), free(full), free(half);
    }
    print_message("# of %d pixels %d have the other surface's colour, %d by edges alone, %d bilinear\n", checked,
                  wrong[0], wrong[BLIND_TO_LOBES], wrong[BILINEAR]);
    assert_true(checked > SIZE * (HEIGHT - 8));
    assert_true(wrong[EDGES] == 0 && wrong[BLIND_TO_LOBES] >= SIZE - 2 && wrong[BILINEAR] >= SIZE - 2);
}

/* ---- outliers ---- */

static double luminance(const float *c) {
    return 0.2126 * (double)c[0] + 0.7152 * (double)c[1] + 0.0722 * (double)c[2];
}

static void bright_samples_are_held_at_what_is_around(void **state) {
    struct gpu *gpu = *state;
    enum { N = SIZE / 2 };
    load_capture(gpu, &(struct plain){.width = SIZE, .height = SIZE, .roughness = 0.5f, .fov_y_degrees = 60});
    gpu_use(gpu, "temporal=outliers");
    gpu_shader(gpu, "resolve", "stand_in.comp");
    gpu_set(gpu, "resolve.texel_scale=1");
    gpu_set(gpu, "temporal.outlier=1e6"); /* no limit */
    gpu_run(gpu);
    float *all = gpu_floats(gpu, "reflection_temporal", NULL, NULL);
    gpu_set(gpu, "temporal.outlier=1.25");
    gpu_run(gpu);
    float *in = gpu_floats(gpu, "reflection_half", NULL, NULL),
          *out = gpu_floats(gpu, "reflection_temporal", NULL, NULL);
    int held = 0;
    for (int y = 1; y < N - 1; ++y)
        for (int x = 1; x < N - 1; ++x) {
            const float *own = in + 4 * (y * N + x);
            double most =
                1.25 / 4 * (luminance(own - 4) + luminance(own + 4) + luminance(own - 4 * N) + luminance(own + 4 * N));
            double factor = fmin(1, most / luminance(own));
            held += factor < 1;
            assert_memory_equal(all + 4 * (y * N + x), own, 3 * sizeof *own);
            for (int k = 0; k < 3; ++k)
                assert_true(fabs((double)out[4 * (y * N + x) + k] - factor * (double)own[k]) < 1e-5);
        }
    print_message("# %d of %d held\n", held, (N - 2) * (N - 2));
    assert_true(held > N * N / 10 && held < N * N / 2);
    free(in), free(out), free(all);
}

/* ---- the previous frame ---- */

/* Diffuse light is constant where nothing moves, so that the previous colour of a hit is its current colour. */
static void hits_find_their_colour_in_the_previous_frame(void **state) {
    struct gpu *gpu = *state;
    double found[2][3] = {{0}};
    for (int reject = 1; reject >= 0; --reject) {
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_sample(gpu, "street", "frame",
                   &(struct glint_sample_options){.width = 240,
                                                  .height = 136,
                                                  .cube_size = 16,
                                                  .first_frame = 2,
                                                  .travel_given = true,
                                                  .travel = {0.4, 0, 0}});
        gpu_set(gpu, "resolve.fog=false");
        gpu_set(gpu, "downsample.jitter=false");
        gpu_run(gpu);
        float *now = gpu_floats(gpu, "reflection_half", NULL, NULL);
        gpu_use(gpu, "resolve=previous");
        gpu_set(gpu, "resolve.fog=false");
        gpu_set(gpu, "resolve.hidden=black");
        gpu_set(gpu, reject ? "resolve.reject=true" : "resolve.reject=false");
        gpu_run(gpu);
        float *before = gpu_floats(gpu, "reflection_half", NULL, NULL);
        uint32_t *source = gpu_uints(gpu, "previous_source", NULL, NULL),
                 *finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
        static uint32_t rejected[120 * 68];
        double sum[4] = {0}, count[4] = {0};
        for (int i = 0; i < 120 * 68; ++i) {
            if (reject) rejected[i] = source[i];
            assert_int_equal(source[i] != 0, finished[i] != 0); /* only for rays that end on screen */
            if (!source[i]) continue;
            double apart = fabs(luminance(now + 4 * i) - luminance(before + 4 * i)) /
                           (luminance(now + 4 * i) + luminance(before + 4 * i) + 0.05);
            sum[rejected[i]] += apart;
            count[rejected[i]]++;
            if (reject && source[i] != 1) assert_true(luminance(before + 4 * i) == 0);
        }
        for (int k = 1; k < 4; ++k) found[reject][k - 1] = sum[k] / fmax(count[k], 1);
        print_message("# %s: shown %.0f differ by %.4f; outside %.0f; hidden %.0f differ by %.4f\n",
                      reject ? "rejected" : "all taken", count[1], found[reject][0], count[2], count[3],
                      found[reject][2]);
        assert_true(count[1] > 1000 && count[3] > 20);
        free(now), free(before), free(source), free(finished);
    }
    /* A moved image is resampled, textures have one sample per pixel, and occluded points show something else. */
    assert_true(found[0][2] > 2 * found[0][0] && found[1][0] == found[0][0]);
}

/* The position of an occluded hit is known, and the nearest cube map mostly sees it. */
static void hidden_hits_are_found_in_cube_maps(void **state) {
    struct gpu *gpu = *state;
    double apart[2] = {0};
    int count = 0, black = 0;
    gpu_reset(gpu);
    gpu_load(gpu, "frame");
    gpu_set(gpu, "resolve.fog=false");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_run(gpu);
    float *now = gpu_floats(gpu, "reflection_half", NULL, NULL);
    for (int cubemap = 0; cubemap < 2; ++cubemap) {
        gpu_use(gpu, "resolve=previous");
        gpu_set(gpu, "resolve.fog=false");
        gpu_set(gpu, cubemap ? "resolve.hidden=cubemap" : "resolve.hidden=black");
        gpu_run(gpu);
        float *before = gpu_floats(gpu, "reflection_half", NULL, NULL);
        uint32_t *source = gpu_uints(gpu, "previous_source", NULL, NULL);
        for (int i = 0; i < 120 * 68; ++i) {
            if (source[i] < 2) continue;
            const double a = luminance(now + 4 * i), b = luminance(before + 4 * i);
            apart[cubemap] += fabs(a - b) / (a + b + 0.05);
            if (cubemap) count++, black += b == 0;
        }
        free(before), free(source);
    }
    print_message("# %d hits hidden or outside: black off by %.3f, in cube maps by %.3f; %d stay black\n", count,
                  apart[0] / count, apart[1] / count, black);
    /* the faces of the cube maps are 16 texels wide */
    assert_true(count > 50 && black == 0 && apart[1] < 0.6 * apart[0]);
    free(now);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_lie_evenly_around_the_mirror_direction),
        cmocka_unit_test(a_mirror_has_its_own_ray),
        cmocka_unit_test(levels_hold_pixels_of_the_picture_and_their_edges),
        cmocka_unit_test(edges_are_open_in_part),
        cmocka_unit_test(noise_of_rough_surfaces_falls_and_mirrors_keep_theirs),
        cmocka_unit_test(nothing_leaks_over_edges),
        cmocka_unit_test(blind_levels_are_upscaled_bilinearly),
        cmocka_unit_test(bars_keep_their_colours),
        cmocka_unit_test(corners_keep_their_colours),
        cmocka_unit_test(bright_samples_are_held_at_what_is_around),
        cmocka_unit_test(hits_find_their_colour_in_the_previous_frame),
        cmocka_unit_test(hidden_hits_are_found_in_cube_maps),
    };
    return cmocka_run_group_tests_name("gpu_mafia_de", tests, gpu_set_up, gpu_tear_down);
}
