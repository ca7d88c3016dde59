/* Statistics of the functions in passes/shared/: distributions, nets. glint selftest compares single values. */
#include <math.h>
#include <stdlib.h>

#include "functions_rows.h"
#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

static const double pi = 3.14159265358979323846;

/* The device's table: a row of COLUMNS texels of four floats for each function, followed by random numbers. */
static float *table, *uniform;

static int evaluate(void **state) {
    if (gpu_set_up(state) != 0) return -1;
    struct gpu *gpu = *state;
    char path[256];
    plain_capture(gpu_path(gpu, "plain", path),
                  &(struct plain){.width = 2 * COLUMNS, .height = 2 * ROWS, .roughness = 0.5f, .fov_y_degrees = 60});
    gpu_load(gpu, "plain");
    gpu_shader(gpu, "downsample", "functions.comp");
    gpu->float_precision = true;
    gpu_run(gpu);
    uint32_t width, height;
    table = gpu_floats(gpu, "normal_half", &width, &height);
    uniform = gpu_floats(gpu, "normal_jittered", NULL, NULL);
    return width == COLUMNS && height == ROWS ? 0 : -1;
}

static int release(void **state) {
    free(table);
    free(uniform);
    return gpu_tear_down(state);
}

static const float *texel(int row, int column) {
    return &table[4 * (row * COLUMNS + column)];
}

static void roughness_zero_is_an_exact_mirror(UNUSED void **state) {
    for (int i = 0; i < COLUMNS; ++i)
        for (int k = 0; k < 2; ++k) {
            assert_true(texel(ROW_EXACT_MIRROR, i)[0] == 1.0f);
            assert_true(texel(ROW_EXACT_MIRROR, i)[1] == 1.0f);
            assert_true(texel(ROW_EXACT_MIRROR, i)[2] == 1.0f);
        }
}

static void without_specular_nothing_reflects(UNUSED void **state) {
    assert_true(texel(ROW_GRAZING, 0)[2] == 0.0f);
    assert_true(texel(ROW_GRAZING, 0)[1] == 0.0f);
    assert_true(texel(ROW_GRAZING, 128)[1] == 1.0f); /* ordinary dielectrics: 1 at grazing incidence */
    for (int i = 1; i < COLUMNS; ++i) assert_true(texel(ROW_GRAZING, i)[2] > texel(ROW_GRAZING, i - 1)[2]);
}

/* lit - (1 - kept) ambient + traced albedo - sun albedo (mask - min(mask, shadow)) cosine/pi, and not below 0. A surface that faces away has no
   sun to lose, and a shadow that the mask has, too, takes nothing. */
static void the_picture_is_the_sum_of_its_terms(UNUSED void **state) {
    static const double irradiance[] = {3, 2, 1}, albedo[] = {0.25, 0.5, 0.75};
    double worst = 0;
    size_t shaded = 0;
    for (int i = 0; i < COLUMNS; ++i) {
        const float *found = texel(ROW_TERMS, i), *r = &uniform[4 * (ROW_TERMS * COLUMNS + i)];
        const double x = (double)r[0], kept = (double)r[1], shadow = (double)r[2], cosine = 2 * (double)r[3] - 1,
                     mask = (i % 4) / 3.0, engine = i / 255.0;
        const double ambient[] = {x, 0.5, 1}, traced[] = {i % 3, 0, x};
        const double lost = cosine > 0 && shadow < mask ? (mask - shadow) * cosine / pi : 0;
        for (int k = 0; k < 3; ++k) {
            const double light =
                1 + x - ambient[k] + kept * ambient[k] + albedo[k] * traced[k] - albedo[k] * lost * irradiance[k];
            worst = fmax(worst, fabs((double)found[k] - fmax(light, 0)));
        }
        shaded += lost > 0;
        worst = fmax(worst, fabs((double)found[3] - kept / (engine > 1.0 / 64 ? engine : 1.0 / 64)) / 64);
    }
    print_message("# worst difference %.2e; %zu of %d in a new shadow\n", worst, shaded, COLUMNS);
    assert_true(worst < 1e-6 && shaded > COLUMNS / 8); /* floats below 4, and quotients below 64 */
}

/* Sobol's first two dimensions are a (0, 2)-sequence, also after scrambling: of the first 2^m points, each elementary box of area 2^-m
   contains exactly one. */
static void points_of_a_pixels_rays_are_a_net(UNUSED void **state) {
    for (int first = 0; first < 4; first += 2)
        for (int m = 1; m <= 8; ++m)
            for (int a = 0; a <= m; ++a) {
                bool taken[256] = {false};
                for (int i = 0; i < 1 << m; ++i) {
                    const float *p = texel(ROW_POINTS, i) + first;
                    assert_true(p[0] > 0 && p[0] < 1 && p[1] > 0 && p[1] < 1);
                    const int box = (int)(p[0] * (float)(1 << a)) << (m - a) | (int)(p[1] * (float)(1 << (m - a)));
                    assert_false(taken[box]);
                    taken[box] = true;
                }
            }
    /* Both stretches are scrambled separately: as many pairs coincide as of independent numbers. */
    int same = 0;
    for (int i = 0; i < 256; ++i) same += (int)(texel(ROW_POINTS, i)[0] * 16) == (int)(texel(ROW_POINTS, i)[2] * 16);
    assert_true(same < 64); /* 16 ± 4 expected; 256 if they are one sequence */
}

/* The density of visible GGX normals: G1(v) max(v·h, 0) D(h) / cos v. */
static double visible_density(double x, UNUSED double y, double z) {
    double a2 = VISIBLE_ALPHA * VISIBLE_ALPHA, vx = sin(VISIBLE_ANGLE), vz = cos(VISIBLE_ANGLE);
    double d = z * z * (a2 - 1) + 1, ggx = a2 / (pi * d * d), vh = vx * x + vz * z;
    double masking = 2 / (1 + sqrt(1 + a2 * (vx * vx) / (vz * vz)));
    return vh > 0 ? masking * vh * ggx / vz : 0;
}

enum { RINGS = 6, SLICES = 8, DRAWS = 32 * COLUMNS };
/* Rings of equal weight of D cos: tan² = a² u/(1 - u). */
static int bin_of(double x, double y, double z) {
    double t2 = 1 / (z * z) - 1, u = t2 / (VISIBLE_ALPHA * VISIBLE_ALPHA + t2);
    int ring = (int)(u * RINGS), slice = (int)((atan2(y, x) / (2 * pi) + 0.5) * SLICES);
    return (ring < RINGS ? ring : RINGS - 1) * SLICES + (slice < SLICES ? slice : SLICES - 1);
}

static void visible_normals_follow_their_density(UNUSED void **state) {
    double expected[RINGS * SLICES] = {0}, found[RINGS * SLICES] = {0}, total = 0;
    enum { FINE = 1000 };
    for (int i = 0; i < FINE; ++i)
        for (int j = 0; j < FINE; ++j) {
            double z = (i + 0.5) / FINE, phi = 2 * pi * (j + 0.5) / FINE, s = sqrt(1 - z * z);
            double part = visible_density(s * cos(phi), s * sin(phi), z) * 2 * pi / FINE / FINE;
            expected[bin_of(s * cos(phi), s * sin(phi), z)] += part;
            total += part;
        }
    assert_true(fabs(total - 1) < 1e-3); /* the reference is a density */
    for (int k = 0; k < DRAWS; ++k) {
        const float *h = texel(ROW_VISIBLE + k / COLUMNS, k % COLUMNS);
        found[bin_of((double)h[0], (double)h[1], (double)h[2])] += 1.0 / DRAWS;
    }
    /* four standard deviations of independent samples; stratified ones vary less */
    for (int i = 0; i < RINGS * SLICES; ++i)
        if (!(fabs(found[i] - expected[i]) <= 4 * sqrt(expected[i] / DRAWS) + 1.0 / DRAWS))
            fail_msg("bin %d: %g, expected %g", i, found[i], expected[i]);
}

static void random_numbers_are_uniform_and_inside(UNUSED void **state) {
    for (int k = 0; k < 4; ++k) {
        double bins[32] = {0};
        for (int i = 0; i < ROWS * COLUMNS; ++i) {
            double u = (double)uniform[4 * i + k];
            assert_true(u > 0 && u < 1);
            bins[(int)(u * 32)] += 1;
        }
        double chi2 = 0, expected = ROWS * COLUMNS / 32.0;
        for (int i = 0; i < 32; ++i) chi2 += (bins[i] - expected) * (bins[i] - expected) / expected;
        assert_true(chi2 < 61.1); /* 31 degrees of freedom: 1 in 1,000 */
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_picture_is_the_sum_of_its_terms),  cmocka_unit_test(roughness_zero_is_an_exact_mirror),
        cmocka_unit_test(without_specular_nothing_reflects),    cmocka_unit_test(points_of_a_pixels_rays_are_a_net),
        cmocka_unit_test(visible_normals_follow_their_density), cmocka_unit_test(random_numbers_are_uniform_and_inside),
    };
    return cmocka_run_group_tests_name("gpu_functions", tests, evaluate, release);
}
