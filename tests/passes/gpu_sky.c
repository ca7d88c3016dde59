/* The sky against integrals and closed forms in double precision: the air along view rays, a homogeneous atmosphere, what lies before what, and the
   sky that the stand-in engine draws of the same formulas by code of its own. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sky_frames.h"
#include "unit.h"

static const struct glint_atmosphere earth = {.planet_radius = 6360e3,
                                              .top = 60e3,
                                              .irradiance = {10, 11, 12},
                                              .rayleigh = {5.802e-6F, 13.558e-6F, 33.1e-6F},
                                              .rayleigh_height = 8000,
                                              .mie = 3.996e-6,
                                              .mie_extinction = 4.44e-6,
                                              .mie_height = 1200,
                                              .mie_asymmetry = 0.76};

/* Distance to a sphere about the planet's middle, or -1; from inside, and from outside the nearer one. */
static double sphere(double from, double slope, double radius, bool inside) {
    const double b = from * slope, inner = b * b - (from - radius) * (from + radius);
    return inner < 0 ? -1 : -b + (inside ? 1 : -1) * sqrt(inner);
}
static double altitude(const struct glint_atmosphere *air, double high, double slope, double t) {
    const double from = air->planet_radius + high;
    return sqrt(from * from + t * (t + 2 * from * slope)) - air->planet_radius;
}

/* ---- the air ---- */

/* By the trapezoidal rule in each step of the shader, of what there is at a scale height. bound: the shader takes the density between the ends of a
   step to fall exponentially, as it does along a chord of the ray's altitude. That is convex, with a second derivative of 1/planet_radius at most:
   over a step of s metres the chord is above it by at most s²/8 of that, and the density there by that part of a scale height too small. */
static double integral(const struct glint_atmosphere *air, double high, double slope, double far, int steps,
                       double scale, double *bound) {
    enum { FINE = 400 };
    double sum = 0;
    *bound = 0;
    for (int i = 0; i < steps; i++) {
        const double a = far * i * i / ((double)steps * steps), s = far * (2 * i + 1) / ((double)steps * steps);
        double step = 0;
        for (int k = 0; k <= FINE; k++)
            step += (k % FINE ? 1 : 0.5) * s / FINE * exp(-altitude(air, high, slope, a + s * k / FINE) / scale);
        sum += step;
        *bound += step * -expm1(-s * s / (8 * air->planet_radius * scale));
    }
    return sum;
}

/* The air along horizontal, rising, falling and vertical rays, from the ground and from 10 km. */
static void the_air_is_integrated(void **state) {
    static const char *const coarse[] = {"sky_scatter.steps=8", NULL}, *const fine[] = {"sky_scatter.steps=32", NULL};
    struct gpu *gpu = *state;
    for (int kind = 0; kind < 6; kind++) {
        const double *view = kind & 1 ? sky_upwards : NULL, high = kind < 4 ? 2 : 10e3;
        const int steps = kind < 2 ? 8 : 32;
        struct glint_atmosphere air = earth;
        air.ground = -high;
        const struct plain plain = sky_plain(&air, NULL, view);
        sky_run(gpu, &plain, kind < 2 ? coarse : fine);
        float *found = gpu_floats(gpu, "sky_passed", NULL, NULL);
        double worst = 0, most = 0;
        for (uint32_t i = 0; i < LOW_WIDE * LOW_HIGH; i++) {
            double d[3], bounds[2];
            sky_ray((i % LOW_WIDE + 0.5) / LOW_WIDE, (i / LOW_WIDE + 0.5) / LOW_HIGH, view, d);
            const double from = air.planet_radius + high, ground = sphere(from, d[1], air.planet_radius, false),
                         far = ground > 0 ? ground : sphere(from, d[1], air.planet_radius + air.top, true);
            const double molecules = integral(&air, high, d[1], far, steps, air.rayleigh_height, &bounds[0]),
                         particles = integral(&air, high, d[1], far, steps, air.mie_height, &bounds[1]);
            assert_true(found[4 * i + 3] == (ground > 0 ? 0 : 1));
            for (uint32_t k = 0; k < 3; k++) {
                const double depth = (double)air.rayleigh[k] * molecules + air.mie_extinction * particles,
                             low = (double)air.rayleigh[k] * bounds[0] + air.mie_extinction * bounds[1],
                             right = exp(-depth), error = (double)found[4 * i + k] - right;
                /* Each step rounds an exponential and a product. Altitudes and slopes are floats; a slope of 2^-24 more changes the air along a horizontal ray by 2^-24 · sqrt(R / H), R the
                   radius and H the scale height of particles, at most 73. */
                const double rounding = right * (depth * ldexp(1, -16) + 2 * steps * ldexp(1, -24)),
                             bound = right * expm1(low) + rounding;
                worst = fmax(worst, fabs(error)), most = fmax(most, fabs(error) / bound);
                if (!(error <= bound && error >= -rounding))
                    fail_msg("kind %d texel %u channel %u: %g, expected %g within %g", kind, i, k,
                             (double)found[4 * i + k], right, bound);
            }
        }
        print_message("# %d steps, %s, %g m: worst difference %.2g, at most %.2f of the bound\n", steps,
                      view ? "up" : "ahead", high, worst, most);
        free(found);
    }
}

static void an_even_atmosphere_scatters(void **state) {
    static const char *const words[] = {"sky_scatter.steps=24", NULL};
    struct gpu *gpu = *state;
    const struct plain plain = sky_plain(&sky_even, NULL, sky_upwards);
    sky_run(gpu, &plain, words);
    float *found = gpu_floats(gpu, "sky_rayleigh", NULL, NULL);
    double worst = 0, most = 0;
    for (uint32_t i = 0; i < LOW_WIDE * LOW_HIGH; i++) {
        double d[3], error;
        sky_ray((i % LOW_WIDE + 0.5) / LOW_WIDE, (i / LOW_WIDE + 0.5) / LOW_HIGH, sky_upwards, d);
        for (uint32_t k = 0; k < 3; k++) {
            const double b = (double)sky_even.rayleigh[k],
                         right = (double)sky_even.irradiance[k] * sky_slab_light(b, b, d[1] / sky_sun.direction[1],
                                                                                 sky_even.top / d[1],
                                                                                 sky_even.top / d[1], 24, true, &error),
                         difference = fabs((double)found[4 * i + k] - right);
            /* Sums of 24 floats, and 24 times the sum of 12. */
            const double bound = (double)sky_even.irradiance[k] * error + right * ldexp(1, -17);
            worst = fmax(worst, difference / right), most = fmax(most, difference / bound);
            if (!(difference <= bound))
                fail_msg("texel %u channel %u: %g, expected %g within %g", i, k, (double)found[4 * i + k], right,
                         bound);
        }
    }
    print_message("# worst relative difference %.2g, at most %.2f of the bound\n", worst, most);
    free(found);
}

/* After sunset the ground's shadow lies in the air up to where the sun's rays pass the planet. Hardly anything is scattered, and nothing absorbed, so that
   what is left is the air in the sun. A step counts as a whole, by its middle. */
static void the_planet_shades_the_air(void **state) {
    enum { STEPS = 64, FINE = 200 };
    static const char *const words[] = {"sky_scatter.steps=64", NULL};
    static const struct glint_sun dusk = {.direction = {0, -0.1, -0.99498743710662}, .irradiance = {1, 1, 1}};
    struct gpu *gpu = *state;
    struct glint_atmosphere air = earth;
    double least = 1, worst = 0;
    for (int k = 0; k < 3; k++) air.irradiance[k] = 1e12F, air.rayleigh[k] = 1e-12F;
    air.mie = air.mie_extinction = 0, air.ground = -2;
    struct plain plain = sky_plain(&air, NULL, NULL);
    plain.sun = &dusk;
    float *found = sky_image(gpu, &plain, "sky_rayleigh", words);
    for (uint32_t i = 0; i < LOW_WIDE * LOW_HIGH; i++) {
        double d[3], lit = 0, all = 0, bound = 0;
        sky_ray((i % LOW_WIDE + 0.5) / LOW_WIDE, (i / LOW_WIDE + 0.5) / LOW_HIGH, NULL, d);
        const double from = air.planet_radius + 2, ground = sphere(from, d[1], air.planet_radius, false),
                     far = ground > 0 ? ground : sphere(from, d[1], air.planet_radius + air.top, true);
        for (int n = 0; n < STEPS; n++) {
            const double a = far * n * n / ((double)STEPS * STEPS), s = far * (2 * n + 1) / ((double)STEPS * STEPS);
            double step = 0, bright = 0;
            for (int k = 0; k < FINE; k++) {
                const double t = a + s * (k + 0.5) / FINE, y = from + t * d[1],
                             ahead = y * dusk.direction[1] + t * d[2] * dusk.direction[2],
                             beside = t * t * (1 - d[1] * d[1]) + y * y - ahead * ahead,
                             part = s / FINE * exp(-altitude(&air, 2, d[1], t) / air.rayleigh_height);
                step += part;
                if (ahead >= 0 || beside > air.planet_radius * air.planet_radius) bright += part;
            }
            lit += bright, all += step;
            bound += bright > 0 && bright < step
                         ? step
                         : -step * expm1(-s * s / (8 * air.planet_radius * air.rayleigh_height));
        }
        bound += 1e-4 * lit + 1e-3; /* sums of floats, and the midpoints of the fine parts */
        least = fmin(least, lit / all), worst = fmax(worst, fabs((double)found[4 * i] - lit) / bound);
        if (!(fabs((double)found[4 * i] - lit) <= bound))
            fail_msg("texel %u: %g m of air in the sun, expected %g within %g", i, (double)found[4 * i], lit, bound);
    }
    print_message("# at most %.2f of the bound; least part in the sun %.3f\n", worst, least);
    assert_true(least < 0.5);
    free(found);
}

/* ---- the picture ---- */

/* Without molecules and with particles that absorb alone, nothing but stars is seen, and none through a cloud that absorbs everything. */
static void dark_air_shows_stars_alone(void **state) {
    static const char *const starless[] = {"sky_compose.starry=false", "sky_compose.clouds=false", NULL},
                             *const starry[] = {"sky_compose.clouds=false", NULL},
                             *const black[] = {"cloud_map.albedo=0", "halves", NULL};
    struct gpu *gpu = *state;
    sky_fill_evenly(1);
    struct glint_atmosphere dark = sky_even;
    memset(dark.rayleigh, 0, sizeof dark.rayleigh);
    dark.mie_extinction = 1e-5;
    const struct plain plain = sky_plain(&dark, &sky_solid, sky_upwards);
    float *none = sky_image(gpu, &plain, "composed_sky", starless),
          *seen = sky_image(gpu, NULL, "composed_sky", starry), *lit = gpu_floats(gpu, "composed", NULL, NULL),
          *passed = gpu_floats(gpu, "sky_passed", NULL, NULL), *hidden = sky_image(gpu, NULL, "composed_sky", black),
          *mask = gpu_floats(gpu, "cloud_map", NULL, NULL), *halved = gpu_floats(gpu, "composed", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t k = 0; k < 3; k++) {
            if (!sky_shows(i)) { /* surfaces keep every bit */
                assert_true(none[4 * i + k] == lit[4 * i + k] && seen[4 * i + k] == lit[4 * i + k]);
                assert_true(hidden[4 * i + k] == halved[4 * i + k]);
                continue;
            }
            assert_true(none[4 * i + k] == 0);
            assert_true(mask[4 * i] == 1 && hidden[4 * i + k] == 0);
            /* Between texels of a quarter of the resolution: lower than the rays beside it, higher than half of them. */
            assert_true(seen[4 * i + k] > 0 && seen[4 * i + k] < (float)(k + 1));
        }
    /* In the middle of a texel of the quarter: pixel (4x + 2, 4y + 2)'s corner, so that the four around it mix to it within the rays' spread. */
    for (uint32_t y = 1; y + 2 < LOW_HIGH; y++)
        for (uint32_t x = 1; x + 1 < LOW_WIDE; x++) {
            double mean = 0;
            for (uint32_t c = 0; c < 4; c++)
                mean += 0.25 * (double)seen[4 * ((4 * y + 1 + c / 2) * WIDE + 4 * x + 1 + c % 2)];
            const double own = (double)passed[4 * (y * LOW_WIDE + x)],
                         left = (double)passed[4 * (y * LOW_WIDE + x - 1)],
                         right = (double)passed[4 * (y * LOW_WIDE + x + 1)],
                         above = (double)passed[4 * ((y - 1) * LOW_WIDE + x)],
                         under = (double)passed[4 * ((y + 1) * LOW_WIDE + x)];
            /* Each pixel is an eighth of a texel beside its middle along both axes: 49/64 of the texel, 7/64 of two neighbours, 1/64 of a third. */
            const double low = fmin(fmin(left, right), fmin(fmin(above, under), own)),
                         mixed = own + (left + right + above + under - 4 * own) / 16;
            assert_true(fabs(mean - mixed) <= (own - low) / 16 + 1e-5);
        }
    free(none), free(seen), free(lit), free(passed), free(hidden), free(mask), free(halved);
}

/* Without air they are where the cube map's texels say, between four of them. */
static void stars_lie_on_their_faces(void **state) {
    static const char *const words[] = {NULL};
    struct gpu *gpu = *state;
    bool faces[7] = {false};
    sky_fill_stars();
    struct glint_atmosphere none = sky_even;
    memset(none.rayleigh, 0, sizeof none.rayleigh);
    for (int kind = 0; kind < 2; kind++) {
        const double *view = kind ? sky_upwards : NULL;
        const struct plain plain = sky_plain(&none, NULL, view);
        float *found = sky_image(gpu, &plain, "composed_sky", words);
        for (uint32_t i = 0; i < PIXELS; i++) {
            double d[3], star[3];
            sky_pixel_ray(i, view, d);
            const float *at = found + 4 * i;
            if (!sky_shows(i) || d[1] < 0.3) continue; /* others may be mixed with rays that meet the ground */
            const uint32_t face = (uint32_t)(at[0] + 0.5F);
            assert_true(face >= 1 && face <= 6 && fabsf(at[0] - (float)face) < 1e-5F);
            faces[face] = true;
            if (at[1] <= 0 || at[2] <= 0 || at[1] >= SIDE - 1 || at[2] >= SIDE - 1)
                continue; /* nothing beyond the rim */
            plain_direction(face - 1, (double)at[1], (double)at[2], SIDE, star);
            for (int k = 0; k < 3; k++) assert_true(fabs(star[k] - d[k]) < 1e-5);
        }
        free(found);
    }
    for (int face = 1; face <= 6; face++) assert_true(faces[face] == (face != 4)); /* none below */
}

/* Molecules and particles by themselves make both together; each has its phase function. */
static void scattering_has_switches(void **state) {
    static const char *const both[] = {"sky_compose.starry=false", NULL},
                             *const molecules[] = {"sky_compose.starry=false", "sky_compose.mie=false", NULL},
                             *const particles[] = {"sky_compose.starry=false", "sky_compose.rayleigh=false", NULL},
                             *const neither[] = {"sky_compose.starry=false", "sky_compose.rayleigh=false",
                                                 "sky_compose.mie=false", NULL};
    struct gpu *gpu = *state;
    struct glint_atmosphere air = sky_even;
    air.mie = air.mie_extinction = 2e-5, air.mie_asymmetry = 0.6;
    const struct plain plain = sky_plain(&air, NULL, sky_upwards);
    float *sum = sky_image(gpu, &plain, "composed_sky", both), *r = sky_image(gpu, NULL, "composed_sky", molecules),
          *m = sky_image(gpu, NULL, "composed_sky", particles), *none = sky_image(gpu, NULL, "composed_sky", neither);
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        if (!sky_shows(i)) continue;
        sky_pixel_ray(i, sky_upwards, d);
        const double cosine = sky_cosine(d), pi = acos(-1), rayleigh = 3 / (16 * pi) * (1 + cosine * cosine),
                     mie = (1 - 0.36) / (4 * pi * pow(1.36 - 1.2 * cosine, 1.5));
        for (uint32_t k = 0; k < 3; k++) {
            assert_true(none[4 * i + k] == 0);
            assert_true(fabs((double)sum[4 * i + k] - (double)r[4 * i + k] - (double)m[4 * i + k]) <=
                        1e-6 * (double)sum[4 * i + k]);
            /* Both are the same integral here but for coefficients, as the air has one density. */
            const double ratio = (double)r[4 * i + k] / (double)m[4 * i + k],
                         right = (double)air.rayleigh[k] / air.mie * rayleigh / mie;
            if (!(fabs(ratio - right) <= 1e-5 * right)) fail_msg("pixel %u: ratio %g, expected %g", i, ratio, right);
        }
    }
    free(sum), free(r), free(m), free(none);
}

/* ---- when there is nothing to do, and what comes next ---- */

static void without_sky_there_is_no_pass(void **state) {
    static const char *const none[] = {NULL}, *const slots[] = {"sky_scatter", "cloud_map", "sky_compose"};
    static const struct {
        bool air, clouds, wall, runs[3];
        const char *reasons[3];
    } cases[] = {{false, false, false, {false}, {"no atmosphere", "no clouds", "no atmosphere and no clouds"}},
                 {true,
                  true,
                  true,
                  {false},
                  {"0 of 1536 pixels are sky", "0 of 1536 pixels are sky", "0 of 1536 pixels are sky"}},
                 {true, false, false, {true, false, true}, {NULL, "no clouds", NULL}},
                 {false, true, false, {false, true, true}, {"no atmosphere", NULL, NULL}},
                 {true, true, false, {true, true, true}, {NULL, NULL, NULL}}};
    struct gpu *gpu = *state;
    sky_fill_evenly(0.5F);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct plain plain = sky_plain(cases[i].air ? &earth : NULL, cases[i].clouds ? &sky_slab : NULL, sky_upwards);
        plain.user = cases[i].wall ? &sky_slab : NULL;
        sky_run(gpu, &plain, none);
        for (uint32_t k = 0; k < 3; k++) {
            const struct glint_pass_result *result = gpu_result(gpu, slots[k]);
            assert_true(result->ran == cases[i].runs[k]);
            if (!result->ran) assert_string_equal(result->reason, cases[i].reasons[k]);
        }
    }
}

/* Passes that are told to run change nothing then, neither without an atmosphere nor with clouds that have no textures. */
static void without_air_all_passes_change_nothing(void **state) {
    static const char *const all[] = {"whole", "all", NULL};
    struct gpu *gpu = *state;
    for (int kind = 0; kind < 2; kind++) {
        struct plain plain = sky_plain(NULL, kind ? &sky_slab : NULL, NULL);
        plain.part = NULL;
        float *found = sky_image(gpu, &plain, "composed_sky", all), *composed = gpu_floats(gpu, "composed", NULL, NULL);
        assert_memory_equal(found, composed, 4 * PIXELS * sizeof *found);
        float *map = gpu_floats(gpu, "cloud_map", NULL, NULL), *passed = gpu_floats(gpu, "sky_passed", NULL, NULL),
              *light = gpu_floats(gpu, "sky_rayleigh", NULL, NULL);
        for (uint32_t i = 0; i < 4 * PIXELS; i++) assert_true(map[i] == 0);
        for (uint32_t i = 0; i < 4 * LOW_WIDE * LOW_HIGH; i++)
            assert_true(light[i] == 0 && (i % 4 == 3 || passed[i] == 1));
        free(found), free(composed), free(map), free(passed), free(light);
    }
}

/* Particles that end a few metres above the ground, seen from 10 km: exponents of their density do not overflow. */
static void haze_may_be_thin(void **state) {
    static const char *const none[] = {NULL};
    struct gpu *gpu = *state;
    for (int height = 1; height < 100; height *= 3) {
        struct glint_atmosphere thin = earth;
        thin.mie_height = height;
        thin.ground = -1e4;
        struct plain plain = sky_plain(&thin, &sky_slab, NULL);
        float *found = sky_image(gpu, &plain, "composed_sky", none);
        for (uint32_t i = 0; i < 4 * PIXELS; i++)
            if (!isfinite(found[i])) fail_msg("%d m: value %u is %g", height, i, (double)found[i]);
        free(found);
    }
}

/* Fog leaves the sky as it is, or covers it where it is told to; what is planned is what all passes make. */
static void fog_comes_after_the_sky(void **state) {
    static const struct glint_fog fog = {.color = {0.5F, 0.75F, 1}, .density = 0.15, .base = 0, .scale_height = 10};
    static const char *const before[] = {"fog=height", "whole", NULL},
                             *const over[] = {"fog=height", "fog.sky=true", NULL},
                             *const all[] = {"fog=height", "whole", "all", NULL};
    struct gpu *gpu = *state;
    sky_fill_unevenly();
    struct plain plain = sky_plain(&earth, &sky_slab, NULL);
    plain.fog = &fog;
    sky_run(gpu, &plain, before);
    float *sky = gpu_floats(gpu, "composed_sky", NULL, NULL), *kept = gpu_floats(gpu, "composed_fog", NULL, NULL),
          *covered = sky_image(gpu, NULL, "composed_fog", over), *every = sky_image(gpu, NULL, "composed_fog", all),
          *lit = gpu_floats(gpu, "composed", NULL, NULL);
    uint32_t changed = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        sky_pixel_ray(i, NULL, d);
        const double passes = d[1] > 0 ? exp(-fog.density * fog.scale_height / d[1]) : 0;
        for (uint32_t k = 0; k < 3; k++) {
            assert_true(every[4 * i + k] == kept[4 * i + k]);
            if (!sky_shows(i)) {
                assert_true(sky[4 * i + k] == lit[4 * i + k]);
                continue;
            }
            assert_true(kept[4 * i + k] == sky[4 * i + k]);
            changed += sky[4 * i + k] != lit[4 * i + k];
            const double right = passes * (double)sky[4 * i + k] + (1 - passes) * (double)fog.color[k];
            assert_true(fabs((double)covered[4 * i + k] - right) <= 1e-4 * right);
        }
    }
    assert_true(changed > 3 * PIXELS / 2);
    free(sky), free(kept), free(covered), free(every), free(lit);
}

static void at_wall(UNUSED uint32_t number, UNUSED const double direction[3], float out[5]) {
    for (int k = 0; k < 4; k++) out[k] = 1;
    out[4] = 100;
}
/* Panes in the left third, water in the right one. */
static void pane_at(uint32_t x, UNUSED uint32_t y, float out[9]) {
    const float values[9] = {0.25F, 0.5F, 0.75F, 0.5F, 0, 0, 1, x < WIDE / 3 ? 2 : INFINITY, 0.5F};
    memcpy(out, values, sizeof values);
}
static void water_at(uint32_t x, UNUSED uint32_t y, float out[9]) {
    const float values[9] = {0, 0.125F, 0.25F, 0.5F, 0, 0, 1, x >= 2 * WIDE / 3 ? 2 : INFINITY, 1};
    memcpy(out, values, sizeof values);
}

/* Water before the sky hides it, panes lie over it, and what is displayed shows it. */
static void the_sky_is_behind_all(void **state) {
    static const char *const words[] = {"whole",
                                        "water=combine",
                                        "transparent_downsample=nearest",
                                        "transparent_screen_trace=linear",
                                        "transparent_cubemap_trace=march",
                                        "transparent_resolve=hit",
                                        "transparency=trace",
                                        "transparency.intensity=0",
                                        "exposure=stops",
                                        NULL},
                             *const bare[] = {"whole", "exposure=stops", NULL};
    struct gpu *gpu = *state;
    sky_fill_unevenly();
    struct plain plain = sky_plain(&earth, &sky_slab, NULL);
    plain.cube_size = 8, plain.cube_count = 1, plain.cube = at_wall, plain.pane = pane_at, plain.water = water_at;
    float *sky = sky_image(gpu, &plain, "composed_sky", words), *water = gpu_floats(gpu, "composed_water", NULL, NULL),
          *panes = gpu_floats(gpu, "composed_transparent", NULL, NULL), *shown = gpu_floats(gpu, "exposed", NULL, NULL);
    plain.pane = plain.water = NULL;
    float *alone = sky_image(gpu, &plain, "composed_sky", bare), *exposed = gpu_floats(gpu, "exposed", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const bool pane = i % WIDE < WIDE / 3, wet = i % WIDE >= 2 * WIDE / 3;
        for (uint32_t k = 0; k < 3; k++) {
            const float own = 0.25F * (float)(k + 1), below = sky[4 * i + k];
            if (sky_shows(i)) assert_true(below == (wet ? water : alone)[4 * i + k]);
            else assert_true(below == water[4 * i + k]);
            assert_true(fabsf(panes[4 * i + k] - (pane ? 0.5F * (below + own) : below)) <= 1e-6F * (below + own));
            assert_true(shown[4 * i + k] == panes[4 * i + k] && exposed[4 * i + k] == alone[4 * i + k]);
        }
    }
    free(sky), free(water), free(panes), free(shown), free(alone), free(exposed);
}

/* ---- the engine's own picture ---- */

static double mean_error(struct gpu *gpu, const float *engine, const float *depth, size_t pixels) {
    float *found = gpu_floats(gpu, "composed_sky", NULL, NULL);
    double sum = 0, of = 0;
    for (size_t i = 0; i < pixels; i++)
        if (isinf(depth[i]))
            for (uint32_t k = 0; k < 3; k++) {
                sum += fabs((double)found[4 * i + k] - (double)engine[3 * i + k]);
                of += (double)engine[3 * i + k];
            }
    free(found);
    return sum / of;
}

static void the_engine_draws_the_same_sky(void **state) {
    static const char *const usual[] = {"whole", NULL},
                             *const coarse[] = {"whole", "cloud_map.steps=12", "cloud_map.light_steps=2", NULL},
                             *const fine[] = {"whole",
                                              "downsample=none",
                                              "cloud_map.steps=160",
                                              "cloud_map.light_steps=12",
                                              "cloud_map.jitter=false",
                                              "sky_scatter.steps=48",
                                              "sky_scatter.light_steps=24",
                                              NULL};
    static const char *const rgb[] = {"R", "G", "B"}, *const z[] = {"depth.Z"};
    struct gpu *gpu = *state;
    const struct glint_sample_options options = {
        .width = 96, .height = 54, .cube_size = 8, .also = GLINT_ALSO_SKY, .light_samples = 1, .unjittered = true};
    gpu_sample(gpu, "meadow", "meadow", &options);
    float *engine = gpu_part(gpu, "lit", rgb, 3), *depth = gpu_part(gpu, "gbuffer", z, 1);
    double errors[3];
    sky_run(gpu, NULL, coarse);
    errors[0] = mean_error(gpu, engine, depth, 96 * 54);
    sky_run(gpu, NULL, usual);
    errors[1] = mean_error(gpu, engine, depth, 96 * 54);
    sky_run(gpu, NULL, fine);
    errors[2] = mean_error(gpu, engine, depth, 96 * 54);
    print_message("# mean difference to the engine's sky: %.4f, %.4f by default, %.4f of it\n", errors[0], errors[1],
                  errors[2]);
    assert_true(errors[2] < 0.005 && errors[1] < 0.1 && errors[0] > 3 * errors[1]);
    free(engine);
    free(depth);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_air_is_integrated),
                                       cmocka_unit_test(an_even_atmosphere_scatters),
                                       cmocka_unit_test(the_planet_shades_the_air),
                                       cmocka_unit_test(dark_air_shows_stars_alone),
                                       cmocka_unit_test(stars_lie_on_their_faces),
                                       cmocka_unit_test(scattering_has_switches),
                                       cmocka_unit_test(without_sky_there_is_no_pass),
                                       cmocka_unit_test(without_air_all_passes_change_nothing),
                                       cmocka_unit_test(haze_may_be_thin),
                                       cmocka_unit_test(fog_comes_after_the_sky),
                                       cmocka_unit_test(the_sky_is_behind_all),
                                       cmocka_unit_test(the_engine_draws_the_same_sky)};
    return cmocka_run_group_tests_name("gpu_sky", tests, gpu_set_up, gpu_tear_down);
}
