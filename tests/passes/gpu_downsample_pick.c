/* downsample/pick: the distribution of its normals, and the pixel that it chooses; downsample/mips: its vertex normals;
   downsample/mips_sparse: which texels have a ray. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 256, DRAWS = SIZE * SIZE / 4 };
/* Kolmogorov and Smirnov: one sample in 1,000 is farther from its distribution. */
static const double farthest = 1.95 / 128; /* √DRAWS */

/* Half a degree of view onto a plane: all view directions are close to the normal, and with a power of 30 one of 50,000 samples is
   below the horizon. */
static void load_plane(struct gpu *gpu, float roughness) {
    char path[256], name[32];
    snprintf(name, sizeof name, "plane%.0f", (double)roughness * 100);
    plain_capture(gpu_path(gpu, name, path),
                  &(struct plain){.width = SIZE, .height = SIZE, .roughness = roughness, .fov_y_degrees = 0.5});
    gpu_load(gpu, name);
    gpu_reset(gpu);
    gpu->float_precision = true;
}

/* Cosines to the plane's normal, +z. */
static double *cosines(struct gpu *gpu) {
    gpu_run(gpu);
    uint32_t width, height;
    float *normal = gpu_floats(gpu, "normal_jittered", &width, &height);
    assert_int_equal(width * height, DRAWS);
    double *cosine = malloc(DRAWS * sizeof *cosine), sum[2] = {0, 0};
    assert_non_null(cosine);
    for (size_t i = 0; i < DRAWS; ++i) {
        const float *n = &normal[4 * i];
        cosine[i] = (double)n[2];
        for (int k = 0; k < 2; ++k) sum[k] += (double)n[k];
        assert_true(fabs((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) - 1) < 1e-5);
    }
    /* no direction is preferred: four standard deviations of a mean of values below 1 */
    for (int k = 0; k < 2; ++k) assert_true(fabs(sum[k]) / DRAWS < 4.0 / 128);
    free(normal);
    return cosine;
}

/* The fraction of the lobe whose cosine is below c. */
typedef double distribution(double c);
static double phong(double c) {
    return pow(c, 31);
}
/* Cut at half the angle where c^30 is 0.1, and normalised. */
static double phong_cut(double c) {
    double lowest = pow(cos(0.5 * acos(pow(0.1, 1 / 30.0))), 31);
    return c <= 0 ? 0 : fmax(0, (pow(c, 31) - lowest) / (1 - lowest));
}
/* At normal incidence visible normals have the density D cos: u = tan²/(a² + tan²) lies below. */
static double ggx(double c) {
    double t2 = 1 / (c * c) - 1, a2 = 0.25 * 0.25;
    return 1 - t2 / (a2 + t2);
}
/* The same without half-vectors beyond 45 degrees, whose rays go below the horizon. */
static double ggx_above(double c) {
    return fmax(0, (ggx(c) - ggx(sqrt(0.5))) / (1 - ggx(sqrt(0.5))));
}

static void expect_distribution(double *cosine, distribution *below, const char *what) {
    double most = 0;
    (void)quantile(cosine, DRAWS, 0.5); /* sorts */
    for (int i = 0; i < DRAWS; ++i) most = fmax(most, fabs(below(cosine[i]) - (i + 0.5) / DRAWS));
    print_message("# %s: distribution within %.4f, one in a thousand lies beyond %.4f\n", what, most, farthest);
    assert_true(most < farthest);
    free(cosine);
}

static void blinn_phong_is_the_slides(void **state) {
    struct gpu *gpu = *state;
    load_plane(gpu, 0.5f);
    gpu_set(gpu, "downsample.ndf=blinn_phong");
    expect_distribution(cosines(gpu), phong, "Blinn-Phong, power 30");
}

static void a_share_cuts_the_angle_and_keeps_proportions(void **state) {
    struct gpu *gpu = *state;
    load_plane(gpu, 0.5f);
    gpu_set(gpu, "downsample.ndf=blinn_phong");
    gpu_set(gpu, "downsample.share=0.5");
    double *cosine = cosines(gpu);
    for (int i = 0; i < DRAWS; ++i) assert_true(cosine[i] >= cos(0.387 / 2) - 1e-4);
    expect_distribution(cosine, phong_cut, "half the angle of power 30");
}

static void ggx_is_the_default(void **state) {
    struct gpu *gpu = *state;
    load_plane(gpu, 0.5f);
    expect_distribution(cosines(gpu), ggx_above, "GGX, alpha 0.25");
}

static void roughness_zero_and_no_jitter_are_the_normal(void **state) {
    struct gpu *gpu = *state;
    for (int i = 0; i < 2; ++i) {
        load_plane(gpu, i == 0 ? 0.0f : 0.5f);
        if (i == 1) gpu_set(gpu, "downsample.jitter=0");
        double *cosine = cosines(gpu);
        for (int k = 0; k < DRAWS; ++k) assert_true(cosine[k] == 1);
        free(cosine);
    }
}

/* Faces away from the viewer by 30 degrees. */
static void turned_away(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        values[PLAIN_NORMAL_Y * pixels + i] = (float)sqrt(0.75);
        values[PLAIN_NORMAL_Z * pixels + i] = -0.5F;
    }
}

/* The mean of 1 - cos 2θ over normals of GGX seen along the normal, tan²θ = α² u/(1 - u), for u below `kept`. */
static double spread(double a2, double kept) {
    enum { STEPS = 4096 };
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double u = kept * (i + 0.5) / STEPS, tangent2 = a2 * u / (1 - u);
        sum += 2 * tangent2 / (1 + tangent2);
    }
    return sum / STEPS;
}

/* A surface that faces away is treated like one seen edge-on, since the viewer's cosine is at least 0. The mean cosine of the filter
   cosᵐ, (m + 1)/(m + 2), is the ratio of the mean directions of nine tenths of the lobe and the cut lobe; edge-on the power is doubled.
   The rim of the cone is where the filter falls to a tenth. */
static void a_normal_that_faces_away_has_the_cone_of_an_edge(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    plain_capture(
        gpu_path(gpu, "away", path),
        &(struct plain){.width = 32, .height = 32, .roughness = 0.5f, .fov_y_degrees = 0.5, .spoil = turned_away});
    gpu_load(gpu, "away");
    gpu_reset(gpu);
    gpu->float_precision = gpu->all = true;
    gpu_set(gpu, "downsample.share=0.5");
    gpu_set(gpu, "downsample.horizon=false"); /* none of the lobe is above it */
    gpu_run(gpu);
    const double a2 = 1.0 / 16, angle = 0.5 * asin(sqrt((1 / sqrt(0.1) - 1) / (1 / a2 - 1))), t2 = pow(tan(angle), 2);
    const double whole = spread(a2, 0.9), cut = spread(a2, t2 / (a2 + t2)), lacking = (whole - cut) / (1 - cut);
    const double expected = acos(pow(0.1, 1 / (2 * (1 / lacking - 2))));
    uint32_t width, height;
    float *cone = gpu_floats(gpu, "cone_half", &width, &height);
    /* logarithms and exponentials near 1 in single precision, off by 1e-6 each, of which a tenth remains */
    print_message("# %.6f, expected %.6f\n", (double)cone[0], expected);
    for (uint32_t i = 0; i < width * height; ++i) assert_true(fabs((double)cone[i] - expected) < 1e-4);
    free(cone);
}

static void the_pick_alternates_or_is_the_first(void **state) {
    struct gpu *gpu = *state;
    load_plane(gpu, 0.5f);
    for (int alternate = 1; alternate >= 0; --alternate) {
        gpu_set(gpu, alternate ? "downsample.alternate=1" : "downsample.alternate=0");
        gpu_run(gpu);
        uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL);
        for (int i = 0; i < DRAWS; ++i) assert_int_equal(pick[i], alternate ? 3 : 0); /* frame 1: the diagonal pixel */
        free(pick);
    }
}

/* In block b, the pixels x + 2y whose bits are set in b belong to a nearer surface. */
static void near_by_bits(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < plain->width * plain->height; ++i) {
        uint32_t x = i % plain->width, y = i / plain->width;
        if (x / 2 % 16 >> (x % 2 + 2 * (y % 2)) & 1) values[i] = 2;
    }
}

static void the_minority_of_an_edge_is_discarded(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    plain_capture(
        gpu_path(gpu, "bits", path),
        &(struct plain){.width = 32, .height = 8, .roughness = 0.3f, .fov_y_degrees = 60, .spoil = near_by_bits});
    gpu_load(gpu, "bits");
    for (int edges = 1; edges >= 0; --edges) {
        gpu_reset(gpu);
        gpu_set(gpu, edges ? "downsample.edges=1" : "downsample.edges=0");
        gpu_run(gpu);
        uint32_t width, height, *pick = gpu_uints(gpu, "pick", &width, &height);
        float *depth = gpu_floats(gpu, "depth_half", NULL, NULL);
        for (uint32_t i = 0; i < width * height; ++i) {
            uint32_t bits = i % width % 16, near_pixels = (bits & 1) + (bits >> 1 & 1) + (bits >> 2 & 1) + (bits >> 3);
            /* the nearer of two pairs, alternating blocks for two diagonals, else the pixel that is preferred in this frame */
            bool diagonal = bits == 6 || bits == 9, other = (i % width ^ i / width) & 1;
            bool near = edges ? near_pixels >= 2 && !(diagonal && other) : bits >> 3 & 1;
            assert_true(depth[i] == (near ? 2.0f : 5.0f));
            assert_int_equal(bits >> pick[i] & 1, near); /* a pixel of the block */
        }
        free(pick), free(depth);
    }
}

/* 7 x 3 pixels make 4 x 2 texels, the last of which contain fewer than four pixels. */
static void odd_sizes_pick_inside(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    plain_capture(gpu_path(gpu, "odd", path),
                  &(struct plain){.width = 7, .height = 3, .roughness = 0.3f, .fov_y_degrees = 60});
    gpu_load(gpu, "odd");
    gpu_reset(gpu);
    gpu_run(gpu);
    uint32_t width, height, *pick = gpu_uints(gpu, "pick", &width, &height);
    assert_true(width == 4 && height == 2);
    for (uint32_t i = 0; i < width * height; ++i)
        assert_true(2 * (i % 4) + (pick[i] & 1) < 7 && 2 * (i / 4) + (pick[i] >> 1) < 3);
    free(pick);
}

/* Mirrors along the right and lower borders; all other surfaces have a negligible reflection. */
static bool is_mirror(uint32_t x, uint32_t y) {
    return x == 6 || y == 4;
}
static void mirror_at_the_border(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        values[PLAIN_METALNESS * pixels + i] = 1;
        for (uint32_t k = 0; k < 3; ++k)
            values[(PLAIN_ALBEDO_R + k) * pixels + i] = is_mirror(i % plain->width, i / plain->width) ? 1 : 0.01f;
    }
}

/* The weight of a mixed block's reflection is that of the pixel at its centre; of an odd image's last blocks, which have no such pixel,
   that of the border. */
static void odd_borders_are_worth_what_their_pixels_are(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    plain_capture(gpu_path(gpu, "odd", path),
                  &(struct plain){.width = 7, .height = 5, .fov_y_degrees = 10, .spoil = mirror_at_the_border});
    gpu_load(gpu, "odd");
    gpu_reset(gpu);
    gpu_use(gpu, "downsample=bilinear");
    gpu_set(gpu, "downsample.min_weight=0.5");
    gpu_run(gpu);
    uint32_t width, height, *pick = gpu_uints(gpu, "pick", &width, &height);
    assert_true(width == 4 && height == 3);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const bool worth = is_mirror(x < 3 ? 2 * x + 1 : 6, y < 2 ? 2 * y + 1 : 4);
            assert_int_equal(pick[y * width + x], worth ? 4 : 4 + 8);
        }
    free(pick);
}

/* The colours are the normals that rays are drawn about, which texels without a ray do not have: each has the colour of a coarser texel that shows
   its surface. On a wall every texel of one level has a ray; where wall and floor meet, coarser texels show only one of them. */
static void rough_surfaces_are_traced_at_coarser_levels(void **state) {
    struct gpu *gpu = *state;
    enum { WIDE = 128, N = WIDE / 2, HEIGHT = WIDE - 4 }; /* the corner crosses blocks */
    char path[256];
    static const struct {
        float roughness;
        bool floor;
        int least, most;
    } cases[] = {{0.2f, false, N * N, N * N},
                 {0.5f, false, N * N / 4, N * N / 4},
                 {0.8f, false, N * N / 16, N * N / 16},
                 {0.8f, true, N * N / 16, N * N / 8}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        plain_capture(gpu_path(gpu, "levels", path), &(struct plain){.width = WIDE,
                                                                     .height = cases[c].floor ? HEIGHT : WIDE,
                                                                     .roughness = cases[c].roughness,
                                                                     .fov_y_degrees = 60,
                                                                     .floor = cases[c].floor});
        gpu_load(gpu, "levels");
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_use(gpu, "downsample=mips_sparse");
        gpu_use(gpu, "blur=upscale_blur");
        gpu_set(gpu, "downsample.jitter=false");
        gpu_set(gpu, "blur.width=0");
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=4");
        gpu_run(gpu);
        uint32_t width, height, *untraced = gpu_uints(gpu, "untraced", &width, &height);
        float *color = gpu_floats(gpu, "reflection_blurred", NULL, NULL),
              *normal = gpu_floats(gpu, "normal_half", NULL, NULL);
        int rays = 0;
        for (uint32_t i = 0; i < width * height; ++i) {
            rays += !untraced[i];
            for (uint32_t k = 0; k < 3; ++k) assert_true(fabsf(color[4 * i + k] - normal[4 * i + k]) < 1e-5f);
            assert_true(color[4 * i + 3] == 1);
        }
        print_message("# roughness %.1f%s: %d rays of %u texels\n", (double)cases[c].roughness,
                      cases[c].floor ? ", a floor" : "", rays, width * height);
        assert_in_range(rays, cases[c].least, cases[c].most);
        free(untraced), free(color), free(normal);
    }
}

/* Rays that are drawn from the whole lobe are the same for every share, and the tangents of their cones are proportional to what they leave. */
static void cones_cover_what_rays_leave(void **state) {
    static const char *const shares[] = {"downsample.share=0", "downsample.share=0.5", "downsample.share=1"};
    struct gpu *gpu = *state;
    float *cone[3];
    double widest = 0;
    load_plane(gpu, 0.6F);
    gpu_set(gpu, "downsample.split=solid_angle");
    gpu_set(gpu, "downsample.horizon=false");
    for (int s = 0; s < 3; ++s) {
        gpu_set(gpu, shares[s]);
        gpu_run(gpu);
        cone[s] = gpu_floats(gpu, "cone_half", NULL, NULL);
    }
    for (size_t i = 0; i < DRAWS; ++i) {
        widest = fmax(widest, (double)cone[0][i]);
        assert_true(cone[2][i] == 0);
        if (cone[0][i] > 1.5F) continue; /* whose tangents are above 14 */
        assert_true(fabs(tan((double)cone[1][i]) / tan((double)cone[0][i]) - 0.5) < 1e-4);
    }
    print_message("# cones up to %.3f rad\n", widest);
    assert_true(widest > 0.3);
    for (int s = 0; s < 3; ++s) free(cone[s]);
}

/* The levels of downsample/mips keep the geometric normals of their pixels, which are not those that shade. */
static void turning(const struct plain *plain, uint32_t x, uint32_t y, float out[3]) {
    out[0] = 0.6F * (float)x / (float)plain->width, out[1] = 0.5F * (float)y / (float)plain->height;
    out[2] = sqrtf(1 - out[0] * out[0] - out[1] * out[1]);
}
static void levels_hold_vertex_normals(void **state) {
    static const char *const levels[] = {"", ".level1", ".level2"};
    struct gpu *gpu = *state;
    char path[256];
    const struct plain plain = {.width = 32, .height = 24, .fov_y_degrees = 60, .vertex_normal = turning};
    plain_capture(gpu_path(gpu, "turning", path), &plain);
    gpu_load(gpu, "turning");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "downsample=mips");
    gpu_run(gpu);
    for (uint32_t l = 0; l < 3; ++l) {
        char name[64];
        uint32_t width, height;
        snprintf(name, sizeof name, "vertex_normal_levels%s", levels[l]);
        float *found = gpu_floats(gpu, name, &width, &height);
        for (uint32_t i = 0; i < width * height; ++i) {
            const uint32_t place = (uint32_t)found[4 * i + 3];
            float right[3];
            turning(&plain, (i % width << (l + 1)) + (place & 7), (i / width << (l + 1)) + (place >> 3), right);
            for (uint32_t k = 0; k < 3; ++k) assert_true(fabsf(found[4 * i + k] - right[k]) < 1e-6F);
        }
        free(found);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blinn_phong_is_the_slides),
        cmocka_unit_test(a_share_cuts_the_angle_and_keeps_proportions),
        cmocka_unit_test(ggx_is_the_default),
        cmocka_unit_test(roughness_zero_and_no_jitter_are_the_normal),
        cmocka_unit_test(a_normal_that_faces_away_has_the_cone_of_an_edge),
        cmocka_unit_test(the_pick_alternates_or_is_the_first),
        cmocka_unit_test(the_minority_of_an_edge_is_discarded),
        cmocka_unit_test(odd_sizes_pick_inside),
        cmocka_unit_test(odd_borders_are_worth_what_their_pixels_are),
        cmocka_unit_test(rough_surfaces_are_traced_at_coarser_levels),
        cmocka_unit_test(cones_cover_what_rays_leave),
        cmocka_unit_test(levels_hold_vertex_normals),
    };
    return cmocka_run_group_tests_name("gpu_downsample_pick", tests, gpu_set_up, gpu_tear_down);
}
