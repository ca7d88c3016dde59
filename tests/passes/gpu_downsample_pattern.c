/* The stratification of downsample's normals, and their density in a cut lobe. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIZE = 256, DRAWS = SIZE * SIZE, WIDE = 1024 };
static const double pi = 3.14159265358979323846, roughness = 0.5, threshold = 0.1, share = 0.5;
/* Angle between view and normal: 0, or oblique. */
static const double oblique = 1.1;

static void tilt(const struct plain *plain, float *values) {
    uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        values[PLAIN_NORMAL_X * pixels + i] = (float)sin(oblique);
        values[PLAIN_NORMAL_Z * pixels + i] = (float)cos(oblique);
    }
}

/* Samples a half-vector for each pixel, in the frame of the normal with x towards the viewer. */
static double (*draws(struct gpu *gpu, bool tilted, const char *ndf, const char *pattern, uint32_t size))[3] {
    char path[256], setting[64];
    const char *name = tilted ? "tilted" : "flat";
    plain_capture(gpu_path(gpu, name, path), &(struct plain){.width = size,
                                                             .height = size,
                                                             .roughness = (float)roughness,
                                                             .fov_y_degrees = 0.5,
                                                             .spoil = tilted ? tilt : NULL});
    gpu_load(gpu, name);
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.share=0.5");
    snprintf(setting, sizeof setting, "downsample.ndf=%s", ndf);
    gpu_set(gpu, setting);
    snprintf(setting, sizeof setting, "downsample.pattern=%s", pattern);
    gpu_set(gpu, setting);
    gpu_run(gpu);
    uint32_t width, height;
    float *normal = gpu_floats(gpu, "normal_jittered", &width, &height);
    assert_true(width == size && height == size); /* `none` traces every pixel */
    double(*h)[3] = malloc(size * size * sizeof *h), c = cos(tilted ? oblique : 0), s = sin(tilted ? oblique : 0);
    assert_non_null(h);
    for (size_t i = 0; i < size * size; ++i) {
        double x = (double)normal[4 * i], y = (double)normal[4 * i + 1], z = (double)normal[4 * i + 2];
        h[i][0] = s * z - c * x, h[i][1] = y, h[i][2] = s * x + c * z;
    }
    free(normal);
    return h;
}

static void every_plus_holds_all_five_fifths(void **state) {
    double(*h)[3] = draws(*state, false, "blinn_phong", "plus", SIZE);
    static const int around[5] = {0, 1, -1, SIZE, -SIZE};
    double most = 0, *turn = malloc(DRAWS * sizeof *turn);
    assert_non_null(turn);
    for (int i = 0; i < DRAWS; ++i) turn[i] = atan2(h[i][1], h[i][0]) / (2 * pi) + 0.5;
    for (int y = 1; y < SIZE - 1; ++y)
        for (int x = 1; x < SIZE - 1; ++x) {
            unsigned seen = 0;
            /* The frame of the normal may be rotated: by half a turn relative to draws(). */
            for (int k = 0; k < 5; ++k) seen |= 1u << (int)(5 * fmod(turn[y * SIZE + x + around[k]] + 1, 1));
            assert_int_equal(seen, 31);
        }
    (void)quantile(turn, DRAWS, 0.5); /* sorts; together they cover the circle evenly */
    for (int i = 0; i < DRAWS; ++i) most = fmax(most, fabs(turn[i] - (i + 0.5) / DRAWS));
    assert_true(most < 1.95 / SIZE); /* Kolmogorov and Smirnov, 1 in 1,000 for independent draws */
    free(turn), free(h);
}

static double cut_angle(bool ggx) {
    if (!ggx) return share * acos(pow(threshold, 1 / 30.0));
    const double a2 = pow(roughness, 4); /* (cos² + sin²/a²)² = 1/threshold */
    return share * asin(sqrt((1 / sqrt(threshold) - 1) / (1 / a2 - 1)));
}

/* The fraction of GGX's visible cap within the cut: that of the normals seen along the surface normal whose tan² is below t², t²/(α² +
   t²). */
static double kept_part(void) {
    double t2 = pow(tan(cut_angle(true)), 2);
    return t2 / (pow(roughness, 4) + t2);
}

/* The distance of the mirrored view direction from the centre of the cap, stretched to a sphere: 1 - cos, relative to the maximum.
   Visible normals are uniform on the cap (Dupuy and Benyoub). */
static double place_in_cap(double x, double y, double z) {
    const double alpha = roughness * roughness;
    double vx = alpha * sin(oblique), vz = cos(oblique), v = sqrt(vx * vx + vz * vz);
    double mx = x / alpha, my = y / alpha, m = sqrt(mx * mx + my * my + z * z);
    vx /= v, vz /= v;
    return (1 - (2 * (vx * mx + vz * z) / m * z / m - vz)) / (1 + vz);
}

/* Not normalised. Blinn-Phong: by half-vector; GGX: visible normals of the oblique view. Rays below the surface are repeated. */
static double density(bool ggx, double x, double y, double z) {
    double v_h = sin(oblique) * x + cos(oblique) * z;
    bool cut = ggx ? place_in_cap(x, y, z) > kept_part() : acos(fmin(z, 1)) > cut_angle(false);
    if (cut || 2 * v_h * z <= cos(oblique)) return 0;
    if (!ggx) return pow(z, 30);
    const double a2 = pow(roughness, 4);
    return fmax(v_h, 0) / pow(z * z + (1 - z * z) / a2, 2);
}

enum { RINGS = 8, SLICES = 10 };
static int bin_of(double cut, double x, double y, double z) {
    int ring = (int)(RINGS * (1 - fmin(z, 1)) / (1 - cos(cut))), slice = (int)(SLICES * (atan2(y, x) / (2 * pi) + 0.5));
    return (ring < RINGS ? ring : RINGS - 1) * SLICES + (slice < SLICES ? slice : SLICES - 1);
}

/* The index of the interval that contains a number; -1 if the rounding of a normal may have moved it across a border. */
static int part_of(double u, int parts) {
    const double place = u * parts;
    return fabs(place - round(place)) < 1e-3 ? -1 : (int)place;
}

/* Of the 25 pixels around one, in five pluses: each plus covers each fifth of both numbers, and all together each of 5 x 5 cells. */
static void strata_hold_every_cell(void **state) {
    static const int centres[5][2] = {{0, 0}, {1, 2}, {2, -1}, {-1, -2}, {-2, 1}},
                     plus[5][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    double(*h)[3] = draws(*state, false, "blinn_phong", "strata", SIZE), lowest = pow(cos(cut_angle(false)), 31);
    int tested = 0;
    for (int y = 3; y < SIZE - 3; ++y)
        for (int x = 3; x < SIZE - 3; ++x) {
            unsigned cells = 0;
            bool known = true;
            for (int c = 0; c < 5; ++c) {
                unsigned turns = 0, angles = 0;
                for (int k = 0; k < 5; ++k) {
                    const double *at = h[(y + centres[c][1] + plus[k][1]) * SIZE + x + centres[c][0] + plus[k][0]];
                    const int turn = part_of(fmod(atan2(at[1], at[0]) / (2 * pi) + 1.5, 1), 5),
                              angle = part_of((pow(at[2], 31) - lowest) / (1 - lowest), 5);
                    if (turn < 0 || angle < 0) known = false;
                    else turns |= 1u << turn, angles |= 1u << angle, cells |= 1u << (5 * turn + angle);
                }
                if (known) assert_true(turns == 31 && angles == 31);
            }
            if (!known) continue;
            assert_int_equal(cells, (1u << 25) - 1);
            ++tested;
        }
    assert_true(tested > DRAWS / 2);
    free(h);
}

static void draws_follow_the_cut_density(void **state) {
    static const char *const patterns[] = {"plus", "white", "blue", "sobol", "strata"};
    for (int run = 0; run < 10; ++run) {
        bool ggx = run % 2;
        uint32_t size = run < 2 ? WIDE : SIZE;
        /* GGX's cap is tilted; its rim stays below this angle. */
        double cut = (ggx ? 2 : 1) * cut_angle(ggx), expected[RINGS * SLICES] = {0}, found[RINGS * SLICES] = {0},
               total = 0, chi2 = 0;
        enum { FINE = 800 };
        for (int i = 0; i < FINE; ++i)
            for (int j = 0; j < FINE; ++j) {
                double z = 1 - (1 - cos(cut)) * (i + 0.5) / FINE, phi = 2 * pi * (j + 0.5) / FINE, s = sqrt(1 - z * z);
                double d = density(ggx, s * cos(phi), s * sin(phi), z);
                expected[bin_of(cut, s * cos(phi), s * sin(phi), z)] += d;
                total += d;
            }
        double(*h)[3] = draws(*state, true, ggx ? "ggx" : "blinn_phong", patterns[run / 2], size);
        for (uint32_t i = 0; i < size * size; ++i) {
            assert_true(h[i][2] > cos(cut) - 1e-6);
            /* the view turns by 0.25° to either side of the picture */
            if (ggx) assert_true(place_in_cap(h[i][0], h[i][1], h[i][2]) < kept_part() + 4e-3);
            found[bin_of(cut, h[i][0], h[i][1], h[i][2])] += 1;
        }
        int bins = 0;
        for (int i = 0; i < RINGS * SLICES; ++i) {
            double e = expected[i] / total * (size * size);
            if (e < 5) continue;
            chi2 += (found[i] - e) * (found[i] - e) / e;
            ++bins;
        }
        /* Independent samples exceed this once in 1,000 (Wilson and Hilferty); stratified ones vary less. */
        double k = bins - 1, limit = k * pow(1 - 2 / (9 * k) + 3.09 * sqrt(2 / (9 * k)), 3);
        print_message("# %s %s: chi² %.1f over %d bins, limit %.1f\n", patterns[run / 2], ggx ? "ggx" : "blinn_phong",
                      chi2, bins, limit);
        assert_true(chi2 < limit);
        free(h);
    }
}

/* The variance of the mean over quads of pixels, divided by a fourth of a pixel's variance: 1 for independent numbers. */
static double quad_variance(const double *u) {
    double quad = 0, one = 0;
    for (int y = 0; y < SIZE; y += 2)
        for (int x = 0; x < SIZE; x += 2) {
            const double *at = &u[y * SIZE + x];
            quad += pow((at[0] + at[1] + at[SIZE] + at[SIZE + 1]) / 4 - 0.5, 2) / (DRAWS / 4);
        }
    for (int i = 0; i < DRAWS; ++i) one += pow(u[i] - 0.5, 2) / DRAWS;
    return quad / (one / 4);
}

static void blue_noise_evens_out_over_neighbours(void **state) {
    double lowest = pow(cos(cut_angle(false)), 31), *u = malloc(DRAWS * sizeof *u), *v = malloc(DRAWS * sizeof *v);
    assert_true(u && v);
    for (int blue = 0; blue < 2; ++blue) {
        double(*h)[3] = draws(*state, false, "blinn_phong", blue ? "blue" : "white", SIZE);
        for (int i = 0; i < DRAWS; ++i) {
            u[i] = (pow(h[i][2], 31) - lowest) / (1 - lowest);
            v[i] = atan2(h[i][1], h[i][0]) / (2 * pi) + 0.5;
        }
        print_message("# %s: variance of quads %.3f and %.3f of independent numbers'\n", blue ? "blue" : "white",
                      quad_variance(u), quad_variance(v));
        for (int k = 0; k < 2; ++k) {
            double part = quad_variance(k ? v : u);
            assert_true(blue ? part < 0.5 : fabs(part - 1) < 0.1);
        }
        free(h);
    }
    free(u), free(v);
}

/* The mean of 1 - cos 2θ over half-vectors below `cut`, by midpoints: density cosⁿ or D cos per solid angle. */
static double spread(bool ggx, double r, double cut) {
    enum { FINE = 4000 };
    double sum = 0, total = 0, n = 2 / pow(r, 4) - 2, a2 = pow(r, 4);
    for (int i = 0; i < FINE; ++i) {
        double t = cut * (i + 0.5) / FINE, c = cos(t);
        double d = sin(t) * (ggx ? c / pow(c * c + (1 - c * c) / a2, 2) : pow(c, n));
        sum += d * (1 - cos(2 * t)), total += d;
    }
    return sum / total;
}

static double lobe_angle(bool ggx, double r) {
    double a2 = pow(r, 4), n = 2 / a2 - 2;
    if (!ggx) return acos(pow(threshold, 1 / n));
    double sine2 = (1 / sqrt(threshold) - 1) / (1 / a2 - 1);
    return sine2 < 1 ? asin(sqrt(sine2)) : pi / 2;
}

/* The limit of the lobe that rays and cones cover: the horizon for a view along the normal, and for GGX nine tenths of the normals,
   tan² = α² 0.9/0.1. */
static double held_angle(bool ggx, double r) {
    return ggx ? fmin(pi / 4, atan(3 * r * r)) : pi / 4;
}

/* Convolution with a filter multiplies the mean direction by the filter's mean cosine, (m + 1)/(m + 2) for cosᵐ; a cone of angle a is
   filtered with cosᵐ a = threshold. */
static void the_cone_gives_back_what_the_cut_took(void **state) {
    static const double shares[] = {0.25, 0.5, 0.75}, roughnesses[] = {0.05, 0.2, 0.4, 0.5, 0.6};
    struct gpu *gpu = *state;
    double worst = 0;
    for (int i = 0; i < 30; ++i) {
        bool ggx = i % 2;
        double part = shares[i / 2 % 3], r = (double)(float)roughnesses[i / 6], end = held_angle(ggx, r);
        char path[256], setting[64];
        plain_capture(gpu_path(gpu, "cone", path),
                      &(struct plain){.width = 16, .height = 16, .roughness = (float)r, .fov_y_degrees = 0.5});
        gpu_load(gpu, "cone");
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_set(gpu, ggx ? "downsample.ndf=ggx" : "downsample.ndf=blinn_phong");
        gpu_set(gpu, "downsample.horizon=false");
        snprintf(setting, sizeof setting, "downsample.share=%g", part);
        gpu_set(gpu, setting);
        gpu_run(gpu);
        float *cone = gpu_floats(gpu, "cone_half", NULL, NULL);
        double power = log(threshold) / log(cos((double)cone[0]));
        double rays = 1 - spread(ggx, r, fmin(part * lobe_angle(ggx, r), end)), lobe = 1 - spread(ggx, r, end);
        double mean = cone[0] > 0 ? rays * (power + 1) / (power + 2) : rays;
        /* relative to the largest difference; a cone of 0 is right if the cut is outside of the lobe */
        worst = fmax(worst, fabs(mean - lobe) / (1 - lobe));
        free(cone);
    }
    print_message("# spread of rays and cone: within %.2f %% of the lobe's\n", 100 * worst);
    assert_true(worst < 2e-3); /* the midpoints' steps of 1/4000, and 0.1° of view across the picture */
}

static void bilinear_is_the_mean_of_the_block(void **state) {
    struct gpu *gpu = *state;
    free(draws(gpu, false, "ggx", "plus", SIZE));
    gpu_use(gpu, "downsample=bilinear");
    gpu_run(gpu);
    uint32_t width, height;
    float *depth = gpu_floats(gpu, "depth_half", &width, &height);
    assert_true(width == SIZE / 2 && height == SIZE / 2 && depth[0] == 5.0f);
    free(depth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_plus_holds_all_five_fifths),      cmocka_unit_test(strata_hold_every_cell),
        cmocka_unit_test(draws_follow_the_cut_density),          cmocka_unit_test(blue_noise_evens_out_over_neighbours),
        cmocka_unit_test(the_cone_gives_back_what_the_cut_took), cmocka_unit_test(bilinear_is_the_mean_of_the_block),
    };
    return cmocka_run_group_tests_name("gpu_downsample_pattern", tests, gpu_set_up, gpu_tear_down);
}
