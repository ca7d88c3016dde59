/* The functions of passes/shared/ on the device, against double precision and closed forms. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "functions_rows.h"
#include "gpu.h"
#include "plain_capture.h"

static const double pi = 3.14159265358979323846, threshold = 0.1;

/* The device's table: a row of COLUMNS texels of four floats for each function; after it, random numbers. */
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

static double worst;
static void start_worst(void) {
    worst = 0;
}
/* Keeps the worst relative error; a NaN stays. */
static void compare(double found, double expected) {
    double error = found == expected ? 0 : fabs(found - expected) / fabs(expected);
    if (!(error <= worst)) worst = error;
}
static void expect_worst_below(const char *what, double bound) {
    print_message("# %s: worst relative error %.3g, bound %.3g\n", what, worst, bound);
    if (!(worst <= bound)) fail_msg("%s: %g > %g", what, worst, bound);
}

/* exp and log themselves may be 3 ULP + 5e-7 off (Vulkan's precision of exp2 and log2, with the factor to base e). */
static const double elementary = 4e-6;

static void expm1_and_log1p_lose_nothing_near_zero(void **state) {
    (void)state;
    start_worst();
    for (int i = 0; i < COLUMNS; ++i) compare((double)texel(ROW_EXPM1, i)[1], expm1((double)texel(ROW_EXPM1, i)[0]));
    expect_worst_below("expm1", elementary);
    start_worst();
    for (int i = 0; i < COLUMNS; ++i) compare((double)texel(ROW_LOG1P, i)[1], log1p((double)texel(ROW_LOG1P, i)[0]));
    expect_worst_below("log1p", elementary);
}

static double power_of(double roughness) {
    return 2 / pow(roughness, 4) - 2;
}
/* acos(x^(1/n)) by its sine, which does not cancel. */
static double angle_of(double roughness) {
    double n = power_of(roughness);
    return n <= 0 ? pi / 2 : asin(sqrt(-expm1(2 * log(threshold) / n)));
}

static void power_and_angle_follow_the_slides(void **state) {
    (void)state;
    assert_float_equal(power_of(0.5), 30, 1e-12);     /* the slides' example, */
    assert_float_equal(angle_of(0.5), 0.387, 0.0005); /* which this reference */
    start_worst();                                    /* and the device must meet */
    for (int i = 0; i < COLUMNS; ++i) {
        double roughness = (double)texel(ROW_LOBE, i)[0];
        compare((double)texel(ROW_LOBE, i)[1], angle_of(roughness));
        if (roughness < 0.9)
            compare((double)texel(ROW_LOBE, i)[2], power_of(roughness)); /* 0 at 1: no relative error */
    }
    expect_worst_below("angle and power, roughness 6e-5 to 1", 2 * elementary);
}

/* Sine of the sampled angle: u is scaled into [lowest, 1), cosine = u^(1/(n+1)). */
static double phong_sine(double roughness, double u, double share) {
    double n = power_of(roughness);
    double lowest = share < 1 ? exp((n + 1) * log1p(-2 * pow(sin(share * angle_of(roughness) / 2), 2))) : 0;
    return sqrt(-expm1(2 * log(lowest + (1 - lowest) * u) / (n + 1)));
}

static void blinn_phong_angles_are_right_for_any_power(void **state) {
    (void)state;
    for (int row = ROW_BLINN_PHONG; row <= ROW_BLINN_PHONG_CUT; ++row) {
        start_worst();
        for (int i = 0; i < COLUMNS; ++i) {
            const float *t = texel(row, i);
            compare((double)t[2], phong_sine((double)t[0], (double)t[1], row == ROW_BLINN_PHONG ? 1 : 0.5));
            assert_true(fabs((double)t[2] * (double)t[2] + (double)t[3] * (double)t[3] - 1) < 1e-6);
        }
        expect_worst_below(row == ROW_BLINN_PHONG ? "sine, whole lobe" : "sine, half the angle", 2 * elementary);
    }
}

static void ggx_cut_follows_its_closed_form(void **state) {
    (void)state;
    start_worst();
    for (int i = 0; i < COLUMNS; ++i) {
        const float *t = texel(ROW_GGX_CUT, i);
        double a2 = (double)t[0] * (double)t[0];
        /* D falls to the threshold where cos² + sin²/a² = threshold^-1/2. */
        double s2 = a2 < 1 ? fmin((1 / sqrt(threshold) - 1) / (1 / a2 - 1), 1) : 1;
        double cut = tan(0.5 * asin(sqrt(s2))), x = (double)t[1] * cut * cut / (a2 + cut * cut);
        double tangent2 = a2 * x / (1 - x);
        compare((double)t[2], sqrt(tangent2 / (1 + tangent2)));
    }
    expect_worst_below("ggx_cut sine", 1e-5); /* asin and tan of the device: 2^-11 of an ULP-scaled 4e-6, twice */
}

/* Sum of `count` steps of ratio k and first step 1. */
static double series(double k, double count) {
    double x = log(k);
    return fabs(x) < 1e-12 ? count : expm1(count * x) / expm1(x);
}

static void geometric_ratios_reach_their_sum(void **state) {
    (void)state;
    for (int row = ROW_RATIO; row <= ROW_RATIO_NEAR_ONE; ++row) {
        start_worst();
        for (int i = 0; i < COLUMNS; ++i) {
            const float *t = texel(row, i);
            compare(series((double)t[2], (double)t[1]), (double)t[0]);
        }
        /* The ratio is a float: half an ULP of it moves the sum of 257 steps by 257 · 6e-8 = 1.5e-5; exp adds 3 ULP. */
        expect_worst_below("sum of the series with the derived ratio", 1.2e-4);
    }
}

static void first_steps_make_the_series_sum_to_the_length(void **state) {
    (void)state;
    start_worst();
    for (int i = 0; i < COLUMNS; ++i) {
        const float *t = texel(ROW_FIRST_STEP, i);
        compare((double)t[2] * series((double)t[0], (double)t[1]), 300);
    }
    expect_worst_below("first step times series", 3e-5); /* the exponent is up to 45, and carries its rounding */
}

static void fog_is_the_integral_along_the_ray(void **state) {
    (void)state;
    start_worst();
    for (int i = 0; i < COLUMNS; ++i) {
        const float *t = texel(ROW_FOG, i);
        double slope = (double)t[0], height = (double)t[1];
        double all = 0.02 * exp(-height / 5) * 5 / slope;
        compare((double)t[2], all * -expm1(-slope * 40 / 5));
        if (slope > 0) compare((double)t[3], all);
        else assert_true(t[3] > 1e30f); /* down for ever */
    }
    expect_worst_below("optical depth, slopes 2e-7 to 1, up and down", 2 * elementary);
}

/* Vulkan specification, Cube Map Face Selection: major axis, then s and t. */
static void vulkan_face(const double d[3], double out[3]) {
    double x = d[0], y = d[1], z = d[2], ax = fabs(x), ay = fabs(y), az = fabs(z), s, t, major;
    if (az >= ax && az >= ay) {
        out[2] = z > 0 ? 4 : 5;
        s = z > 0 ? x : -x;
        t = -y;
        major = az;
    } else if (ay >= ax) {
        out[2] = y > 0 ? 2 : 3;
        s = x;
        t = y > 0 ? z : -z;
        major = ay;
    } else {
        out[2] = x > 0 ? 0 : 1;
        s = x > 0 ? -z : z;
        t = -y;
        major = ax;
    }
    out[0] = 0.5 * (s / major + 1);
    out[1] = 0.5 * (t / major + 1);
}

static void cube_faces_are_vulkans(void **state) {
    (void)state;
    double error = 0;
    for (int i = 0; i < COLUMNS; ++i) {
        const float *found = texel(ROW_FACE, i), *d = texel(ROW_FACE_DIRECTION, i), *back = texel(ROW_FACE_BACK, i);
        const double direction[3] = {(double)d[0], (double)d[1], (double)d[2]};
        double expected[3], largest = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
        vulkan_face(direction, expected);
        assert_true((double)found[2] == expected[2]);
        for (int k = 0; k < 2; ++k) error = fmax(error, fabs((double)found[k] - expected[k]));
        for (int k = 0; k < 3; ++k) error = fmax(error, fabs((double)back[k] - direction[k] / largest));
        /* Two points half a texel left and right of the place, as the centre sees them (at the axes, where it is widest). */
        double norm = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
        assert_true(fabs((double)found[3] / (2.0 / 256 * largest / norm) - 1) < 1e-5);
    }
    print_message("# face coordinates: worst error %.3g\n", error);
    assert_true(error < 5e-7); /* a division of 2.5 ULP and two roundings, in [-1, 1] */
}

/* Split sum of GGX with Smith's height-correlated masking and Schlick's Fresnel: x scales F0, y the rest. Midpoints in
   u over visible normals, whose weight is G2/G1. */
static void integrate_brdf(double roughness, double cosine, double out[2]) {
    enum { N = 48 };
    double alpha = fmax(roughness * roughness, 1e-4), a2 = alpha * alpha, sine = sqrt(1 - cosine * cosine);
    out[0] = out[1] = 0;
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) {
            double u = (i + 0.5) / N, phi = 2 * pi * (j + 0.5) / N;
            /* Heitz 2018: half discs as the stretched view sees them; the device's sampler uses spherical caps. */
            double vx = alpha * sine, vz = cosine, vl = hypot(vx, vz);
            vx /= vl, vz /= vl;
            double p1 = sqrt(u) * cos(phi), p2 = sqrt(u) * sin(phi), s = 0.5 * (1 + vz);
            p2 = (1 - s) * sqrt(1 - p1 * p1) + s * p2;
            double p3 = sqrt(fmax(0, 1 - p1 * p1 - p2 * p2));
            double hx = alpha * (-vz * p2 + vx * p3), hy = alpha * p1, hz = fmax(0, vx * p2 + vz * p3);
            double hl = sqrt(hx * hx + hy * hy + hz * hz);
            hx /= hl, hz /= hl;
            double vh = sine * hx + cosine * hz, lz = 2 * vh * hz - cosine;
            if (lz <= 0) continue;
            double lambda_v = 0.5 * (sqrt(1 + a2 * (1 / (cosine * cosine) - 1)) - 1);
            double lambda_l = 0.5 * (sqrt(1 + a2 * (1 / (lz * lz) - 1)) - 1);
            double weight = (1 + lambda_v) / (1 + lambda_v + lambda_l) / (N * N), fresnel = pow(1 - vh, 5);
            out[0] += weight * (1 - fresnel);
            out[1] += weight * fresnel;
        }
}

static void environment_brdf_stays_near_the_integral(void **state) {
    (void)state;
    double most[2] = {0, 0}, sum = 0;
    for (int i = 0; i < COLUMNS; ++i) {
        const float *t = texel(ROW_BRDF, i);
        double expected[2];
        integrate_brdf((double)t[0], (double)t[1], expected);
        for (int k = 0; k < 2; ++k) most[k] = fmax(most[k], fabs((double)t[2 + k] - expected[k]));
        sum += fabs(0.04 * ((double)t[2] - expected[0]) + (double)t[3] - expected[1]);
    }
    print_message("# environment BRDF against its integral: F0's scale within %.3f, F90's within %.3f, F0 = 0.04 %.4f "
                  "in the mean\n",
                  most[0], most[1], sum / COLUMNS);
    assert_true(most[0] < 0.025 && most[1] < 0.016);
}

static void tangent_frames_are_orthonormal_and_right_handed(void **state) {
    (void)state;
    for (int i = 0; i < COLUMNS; ++i) {
        const float *t = texel(ROW_FRAME, i);
        for (int k = 0; k < 3; ++k) assert_true(fabs((double)t[k]) < 2e-6);
        assert_true(fabs((double)t[3] - 1) < 2e-6);
    }
}

static void roughness_zero_is_an_exact_mirror(void **state) {
    (void)state;
    for (int i = 0; i < COLUMNS; ++i)
        for (int k = 0; k < 2; ++k) {
            assert_true(texel(ROW_EXACT_MIRROR, i)[0] == 1.0f);
            assert_true(texel(ROW_EXACT_MIRROR, i)[1] == 1.0f);
            assert_true(texel(ROW_EXACT_MIRROR, i)[2] == 1.0f);
        }
}

static void without_specular_nothing_reflects(void **state) {
    (void)state;
    assert_true(texel(ROW_GRAZING, 0)[2] == 0.0f);
    assert_true(texel(ROW_GRAZING, 0)[1] == 0.0f);
    assert_true(texel(ROW_GRAZING, 128)[1] == 1.0f); /* ordinary dielectrics: 1 at grazing incidence */
    for (int i = 1; i < COLUMNS; ++i) assert_true(texel(ROW_GRAZING, i)[2] > texel(ROW_GRAZING, i - 1)[2]);
}

/* Sobol's first two dimensions make a (0, 2)-sequence, and scrambling keeps it one: of the first 2^m points each box of the
   area 2^-m, however long, holds exactly one. */
static void points_of_a_pixels_rays_are_a_net(void **state) {
    (void)state;
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
    /* Both stretches are scrambled by themselves: of independent numbers as many pairs fall together. */
    int same = 0;
    for (int i = 0; i < 256; ++i) same += (int)(texel(ROW_POINTS, i)[0] * 16) == (int)(texel(ROW_POINTS, i)[2] * 16);
    assert_true(same < 64); /* 16 ± 4, and 256 where they are one sequence */
}

/* Density of visible GGX normals: G1(v) max(v·h, 0) D(h) / cos v. */
static double visible_density(double x, double y, double z) {
    double a2 = VISIBLE_ALPHA * VISIBLE_ALPHA, vx = sin(VISIBLE_ANGLE), vz = cos(VISIBLE_ANGLE);
    double d = z * z * (a2 - 1) + 1, ggx = a2 / (pi * d * d), vh = vx * x + vz * z;
    double masking = 2 / (1 + sqrt(1 + a2 * (vx * vx) / (vz * vz)));
    (void)y;
    return vh > 0 ? masking * vh * ggx / vz : 0;
}

enum { RINGS = 6, SLICES = 8, DRAWS = 32 * COLUMNS };
/* Rings of equal weight of D cos: tan² = a² u/(1 - u). */
static int bin_of(double x, double y, double z) {
    double t2 = 1 / (z * z) - 1, u = t2 / (VISIBLE_ALPHA * VISIBLE_ALPHA + t2);
    int ring = (int)(u * RINGS), slice = (int)((atan2(y, x) / (2 * pi) + 0.5) * SLICES);
    return (ring < RINGS ? ring : RINGS - 1) * SLICES + (slice < SLICES ? slice : SLICES - 1);
}

static void visible_normals_follow_their_density(void **state) {
    (void)state;
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
    /* Four standard deviations of independent draws; these are stratified and scatter less. */
    for (int i = 0; i < RINGS * SLICES; ++i)
        if (!(fabs(found[i] - expected[i]) <= 4 * sqrt(expected[i] / DRAWS) + 1.0 / DRAWS))
            fail_msg("bin %d: %g, expected %g", i, found[i], expected[i]);
}

static void random_numbers_are_uniform_and_inside(void **state) {
    (void)state;
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

/* Slides, Computing MIP level in resolve shader; `spread` is radius at a distance of one over the tangent. */
static double cone_level(double angle, double travelled, double end, double texels_at_1m, double most) {
    double spread = isinf(travelled) ? INFINITY : travelled == 0 ? 0 : travelled / end;
    double radius = angle == 0 || spread == 0 ? 0 : tan(angle) * spread;
    return log2(fmin(fmax(1, radius * texels_at_1m / 3.5), most));
}

static void cones_have_the_slides_levels(void **state) {
    (void)state;
    double error = 0;
    size_t between = 0;
    for (int i = 0; i < COLUMNS; ++i) {
        const float *t = texel(ROW_CONE_ANGLE, i);
        double angle = (double)t[0] > 1.57 ? pi / 2 : (double)t[0], travelled = (double)t[1], end = (double)t[2];
        double cube =
            isinf(travelled) ? cone_level(angle, 1, 1, 256, 512) : cone_level(angle, travelled, end, 256, 512);
        double screen = cone_level(angle, travelled, end, 935.3, 1024);
        error = fmax(error, fabs((double)texel(ROW_CONE_CUBE, i)[0] - cube));
        error = fmax(error, fabs((double)texel(ROW_CONE_SCREEN, i)[0] - screen));
        between += cube > 0 && cube < 9;
    }
    print_message("# levels of cones: worst error %.3g; %zu lie between the ends\n", error, between);
    assert_true(between > 50);
    assert_true(error < 2e-5); /* tan's 4096 ULP where it is steep, and log2's 3 ULP of 9 */
}

static void a_cones_power_falls_to_the_threshold_at_its_rim(void **state) {
    (void)state;
    for (int i = 0; i < COLUMNS; ++i) {
        const float *t = texel(ROW_CONE_POWER, i);
        double radius_px = ldexp(1.0 + i / 10, i % 10), angle = atan(radius_px / (512 / 2));
        assert_true(fabs((double)t[0] / (radius_px / 256) - 1) < 1e-6);
        assert_true(fabs(pow(cos(angle), (double)t[1]) / threshold - 1) <
                    2e-5); /* log and log1p: 4e-6, times log 0.1 */
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(expm1_and_log1p_lose_nothing_near_zero),
        cmocka_unit_test(power_and_angle_follow_the_slides),
        cmocka_unit_test(blinn_phong_angles_are_right_for_any_power),
        cmocka_unit_test(ggx_cut_follows_its_closed_form),
        cmocka_unit_test(cones_have_the_slides_levels),
        cmocka_unit_test(a_cones_power_falls_to_the_threshold_at_its_rim),
        cmocka_unit_test(geometric_ratios_reach_their_sum),
        cmocka_unit_test(first_steps_make_the_series_sum_to_the_length),
        cmocka_unit_test(fog_is_the_integral_along_the_ray),
        cmocka_unit_test(cube_faces_are_vulkans),
        cmocka_unit_test(environment_brdf_stays_near_the_integral),
        cmocka_unit_test(tangent_frames_are_orthonormal_and_right_handed),
        cmocka_unit_test(roughness_zero_is_an_exact_mirror),
        cmocka_unit_test(without_specular_nothing_reflects),
        cmocka_unit_test(points_of_a_pixels_rays_are_a_net),
        cmocka_unit_test(visible_normals_follow_their_density),
        cmocka_unit_test(random_numbers_are_uniform_and_inside),
    };
    return cmocka_run_group_tests_name("gpu_functions", tests, evaluate, release);
}
