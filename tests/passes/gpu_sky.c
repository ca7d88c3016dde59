/* The sky against integrals and closed forms in double precision: the air along view rays, a homogeneous atmosphere, slabs of cloud; what lies before
   what; and the sky that the stand-in engine draws of the same formulas by code of its own. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDE = 48, HIGH = 32, PIXELS = WIDE * HIGH, LOW_WIDE = 12, LOW_HIGH = 8, SURFACE_ROWS = 4, SIDE = 8 };
static const double FOV = 100;

/* ---- captures ---- */

/* Towards +y, with +z at the top of the picture. */
static const double looking_up[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
/* Straight ahead in a world whose z points up. */
static const double upright_z[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1};

static const struct glint_sun low_sun = {.direction = {0, 0.6, -0.8}, .irradiance = {2, 3, 4}};
static const struct glint_atmosphere earth = {.planet_radius = 6360e3,
                                              .top = 60e3,
                                              .irradiance = {10, 11, 12},
                                              .rayleigh = {5.802e-6F, 13.558e-6F, 33.1e-6F},
                                              .rayleigh_height = 8000,
                                              .mie = 3.996e-6,
                                              .mie_extinction = 4.44e-6,
                                              .mie_height = 1200,
                                              .mie_asymmetry = 0.76};
/* As good as flat, and of one density. */
static const struct glint_atmosphere even = {.planet_radius = 1e13,
                                             .top = 10e3,
                                             .irradiance = {10, 11, 12},
                                             .rayleigh = {2e-5F, 5e-5F, 1e-4F},
                                             .rayleigh_height = 1e15,
                                             .mie_height = 1e15};
static const struct glint_clouds slab = {.bottom = 1000, .top = 1500, .tile = 900, .extinction = 2e-3};
static const struct glint_clouds solid = {.bottom = 1000, .top = 1500, .tile = 900, .extinction = 0.1};

static float density[8 * SIDE * SIDE], height[8 * SIDE * SIDE], noise[SIDE * SIDE * SIDE], stars[3][6 * SIDE * SIDE];
static const struct glint_channel channels[] = {{.name = "density", .type = GLINT_F32, .data = density},
                                                {.name = "height", .type = GLINT_F32, .data = height},
                                                {.name = "noise", .type = GLINT_F32, .data = noise},
                                                {.name = "R", .type = GLINT_F32, .data = stars[0]},
                                                {.name = "G", .type = GLINT_F32, .data = stars[1]},
                                                {.name = "B", .type = GLINT_F32, .data = stars[2]}};
static const struct glint_part parts[] = {
    {.name = "stars", .width = SIDE, .height = 6 * SIDE, .channels = &channels[3], .channel_count = 3},
    {.name = "cloud.density", .width = SIDE, .height = 8 * SIDE, .channels = &channels[0], .channel_count = 1},
    {.name = "cloud.height", .width = SIDE, .height = 8 * SIDE, .channels = &channels[1], .channel_count = 1},
    {.name = "cloud.noise", .width = SIDE, .height = SIDE * SIDE, .channels = &channels[2], .channel_count = 1}};

static void fill(float *values, size_t count, float value) {
    for (size_t i = 0; i < count; i++) values[i] = value;
}
/* Clouds of one density, stars of one colour. */
static void fill_evenly(float cloud) {
    fill(density, 8 * SIDE * SIDE, cloud);
    fill(height, 8 * SIDE * SIDE, 1);
    fill(noise, SIDE * SIDE * SIDE, 0);
    for (uint32_t k = 0; k < 3; k++) fill(stars[k], 6 * SIDE * SIDE, (float)(k + 1));
}
static void fill_unevenly(void) {
    for (uint32_t i = 0; i < 8 * SIDE * SIDE; i++) {
        density[i] = (float)(i * 37 % 61) / 60;
        height[i] = 0.3F + 0.7F * (float)(i * 23 % 53) / 52;
        noise[i % (SIDE * SIDE * SIDE)] = (float)(i * 29 % 47) / 46;
    }
}

/* The lowest rows are the wall, the others the sky; with `user` all are the wall. */
static void spoil_sky(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < PIXELS; i++) {
        values[PLAIN_SPECULAR * PIXELS + i] = 0;
        if (i / WIDE < HIGH - SURFACE_ROWS && !plain->user) values[PLAIN_DEPTH * PIXELS + i] = INFINITY;
        for (uint32_t k = 0; k < 3; k++) values[(PLAIN_LIT_R + k) * PIXELS + i] = (float)(i * (5 + k) % 61) / 32;
    }
}
static bool is_sky(uint32_t pixel) {
    return pixel / WIDE < HIGH - SURFACE_ROWS;
}

static struct plain plain_of(const struct glint_atmosphere *air, const struct glint_clouds *clouds, const double *view) {
    return (struct plain){.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.5F,
                          .fov_y_degrees = FOV,
                          .spoil = spoil_sky,
                          .sun = &low_sun,
                          .atmosphere = air,
                          .clouds = clouds,
                          .world_to_view = view,
                          .part = parts,
                          .part_count = clouds ? 4 : 1};
}

/* With images in full floats, unless a word is "halves", and without reflections, unless one is "whole". */
static void run(struct gpu *gpu, const struct plain *plain, const char *const *words) {
    static const char *const slots[] = {
        "screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    char path[256];
    if (plain) {
        plain_capture(gpu_path(gpu, "sky", path), plain);
        gpu_load(gpu, "sky");
    }
    gpu_reset(gpu);
    bool whole = false;
    for (size_t i = 0; words[i]; i++) whole |= !strcmp(words[i], "whole");
    if (!whole) gpu_without(gpu, slots);
    gpu_use(gpu, "cloud_map=march");
    gpu_use(gpu, "sky_scatter=single");
    gpu_use(gpu, "sky_compose=layers");
    gpu->float_precision = true;
    for (; *words; words++)
        if (!strcmp(*words, "halves")) gpu->float_precision = false;
        else if (!strcmp(*words, "all")) gpu->all = true;
        else if (!strcmp(*words, "whole")) continue;
        else (strchr(*words, '.') ? gpu_set : gpu_use)(gpu, *words);
    gpu_run(gpu);
}

/* ---- rays ---- */

/* The unit direction through a place of the picture in the world. */
static void ray_of(double u, double v, const double *view, double d[3]) {
    const double t = tan(FOV / 2 * acos(-1) / 180), x = t * WIDE / HIGH * (2 * u - 1), y = t * (1 - 2 * v),
                 length = sqrt(x * x + y * y + 1), in_view[3] = {x / length, y / length, -1 / length};
    for (int i = 0; i < 3; i++)
        d[i] = view ? view[i] * in_view[0] + view[4 + i] * in_view[1] + view[8 + i] * in_view[2] : in_view[i];
}
static void pixel_ray(uint32_t pixel, const double *view, double d[3]) {
    ray_of((pixel % WIDE + 0.5) / WIDE, (pixel / WIDE + 0.5) / HIGH, view, d);
}
static double cosine_to_sun(const double d[3]) {
    return d[0] * low_sun.direction[0] + d[1] * low_sun.direction[1] + d[2] * low_sun.direction[2];
}

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
static double integral(const struct glint_atmosphere *air, double high, double slope, double far, int steps, double scale,
                       double *bound) {
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
        const double *view = kind & 1 ? looking_up : NULL, high = kind < 4 ? 2 : 10e3;
        const int steps = kind < 2 ? 8 : 32;
        struct glint_atmosphere air = earth;
        air.ground = -high;
        const struct plain plain = plain_of(&air, NULL, view);
        run(gpu, &plain, kind < 2 ? coarse : fine);
        float *found = gpu_floats(gpu, "sky_passed", NULL, NULL);
        double worst = 0, most = 0;
        for (uint32_t i = 0; i < LOW_WIDE * LOW_HIGH; i++) {
            double d[3], bounds[2];
            ray_of((i % LOW_WIDE + 0.5) / LOW_WIDE, (i / LOW_WIDE + 0.5) / LOW_HIGH, view, d);
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
                const double rounding = right * (depth * ldexp(1, -16) + 2 * steps * ldexp(1, -24)), bound = right * expm1(low) + rounding;
                worst = fmax(worst, fabs(error)), most = fmax(most, fabs(error) / bound);
                if (!(error <= bound && error >= -rounding))
                    fail_msg("kind %d texel %u channel %u: %g, expected %g within %g", kind, i, k, (double)found[4 * i + k],
                             right, bound);
            }
        }
        print_message("# %d steps, %s, %g m: worst difference %.2g, at most %.2f of the bound\n", steps,
                      view ? "up" : "ahead", high, worst, most);
        free(found);
    }
}

/* Light scattered once by a slab of one density, seen from below: the integral over t, from 0 to the length of the ray, of
   extinction · exp(-extinction · t) · exp(-towards · (whole - t) · rise), with whole the length of the ray through all of the slab, `towards` the extinction on the way to the sun and rise the metres of
   that way in a metre of the ray. error: what a march errs by that takes the way to the sun in the middle of each step, for which both the
   integral over a step and its value with that way have closed forms. end(i): where step i begins. */
static double slab_light(double extinction, double towards, double rise, double length, double whole, int steps, bool squares, double *error) {
    const double k = towards * rise;
    double sum = 0;
    *error = 0;
    for (int i = 0; i < steps; i++) {
        const double p = (double)i / steps, q = (i + 1.0) / steps, a = length * (squares ? p * p : p),
                     s = length * (squares ? q * q : q) - a, rate = k - extinction,
                     begin = exp(-extinction * a - k * (whole - a)),
                     right = begin * extinction * (fabs(rate * s) < 1e-9 ? s : expm1(rate * s) / rate),
                     marched = begin * exp(k * s / 2) * -expm1(-extinction * s);
        sum += right, *error += fabs(marched - right);
    }
    return sum;
}

static void an_even_atmosphere_scatters(void **state) {
    static const char *const words[] = {"sky_scatter.steps=24", NULL};
    struct gpu *gpu = *state;
    const struct plain plain = plain_of(&even, NULL, looking_up);
    run(gpu, &plain, words);
    float *found = gpu_floats(gpu, "sky_rayleigh", NULL, NULL);
    double worst = 0, most = 0;
    for (uint32_t i = 0; i < LOW_WIDE * LOW_HIGH; i++) {
        double d[3], error;
        ray_of((i % LOW_WIDE + 0.5) / LOW_WIDE, (i / LOW_WIDE + 0.5) / LOW_HIGH, looking_up, d);
        for (uint32_t k = 0; k < 3; k++) {
            const double b = (double)even.rayleigh[k],
                         right = (double)even.irradiance[k] * slab_light(b, b, d[1] / low_sun.direction[1], even.top / d[1], even.top / d[1], 24, true, &error),
                         difference = fabs((double)found[4 * i + k] - right);
            /* Sums of 24 floats, and 24 times the sum of 12. */
            const double bound = (double)even.irradiance[k] * error + right * ldexp(1, -17);
            worst = fmax(worst, difference / right), most = fmax(most, difference / bound);
            if (!(difference <= bound))
                fail_msg("texel %u channel %u: %g, expected %g within %g", i, k, (double)found[4 * i + k], right, bound);
        }
    }
    print_message("# worst relative difference %.2g, at most %.2f of the bound\n", worst, most);
    free(found);
}

/* ---- clouds ---- */

static double lobes(double cosine, double part) {
    const double a = 0.8 * part, b = 0.3 * part, pi = acos(-1);
    return (0.7 * (1 - a * a) / pow(1 + a * a - 2 * a * cosine, 1.5) + 0.3 * (1 - b * b) / pow(1 + b * b + 2 * b * cosine, 1.5)) /
           (4 * pi);
}

static void a_slab_of_cloud_hides_and_scatters(void **state) {
    enum { STEPS = 16, OCTAVES = 3 };
    static const char *const words[][8] = {
        {"cloud_map.steps=16", "cloud_map.light_m=1e6", "cloud_map.octaves=3", "cloud_map.jitter=false", "cloud_map.length_m=1e6", NULL},
        {"cloud_map.steps=16", "cloud_map.light_m=1e6", "cloud_map.octaves=0", "cloud_map.jitter=true", "cloud_map.length_m=1e6",
         "cloud_map.albedo=0.5", NULL}};
    struct gpu *gpu = *state;
    fill_evenly(0.75F);
    for (int kind = 0; kind < 3; kind++) { /* ahead; ahead with jitter, half of it absorbed; up */
        const double *view = kind == 2 ? looking_up : NULL, extinction = 0.75 * slab.extinction, deep = slab.top - slab.bottom;
        const struct plain plain = plain_of(NULL, &slab, view);
        run(gpu, &plain, words[kind == 1]);
        float *found = gpu_floats(gpu, "cloud_map", NULL, NULL);
        double worst[3] = {0, 0, 0}, most = 0;
        for (uint32_t i = 0; i < PIXELS; i++) {
            double d[3], right[3] = {0}, bound[3], error;
            pixel_ray(i, view, d);
            if (!is_sky(i) || d[1] <= 0.01) { /* the flattest of these rays rises by 1/32 · tan 50° */
                for (uint32_t c = 0; c < 4; c++) assert_true(found[4 * i + c] == 0);
                continue;
            }
            const double length = deep / d[1], rise = d[1] / low_sun.direction[1], cosine = cosine_to_sun(d);
            right[0] = -expm1(-extinction * length);
            bound[0] = ldexp(1, -12) + ldexp(1, -18); /* less is left: all is hidden; and 16 products */
            right[1] = lobes(cosine, 1) * slab_light(extinction, extinction, rise, length, length, STEPS, false, &error);
            bound[1] = lobes(cosine, 1) * (error + ldexp(1, -12)) + right[1] * ldexp(1, -16);
            bound[2] = 0;
            for (int k = 1; k <= OCTAVES; k++) {
                const double phase = ldexp(lobes(cosine, ldexp(1, -k)), -k),
                             term = phase * slab_light(extinction, ldexp(extinction, -k), rise, length, length, STEPS, false, &error);
                right[2] += term, bound[2] += phase * (error + ldexp(1, -12)) + term * ldexp(1, -16);
            }
            for (uint32_t c = 0; c < 3; c++) {
                if (kind == 1 && c) continue; /* jitter moves the way to the sun */
                const double difference = fabs((double)found[4 * i + c] - right[c]);
                worst[c] = fmax(worst[c], difference), most = fmax(most, difference / bound[c]);
                if (!(difference <= bound[c]))
                    fail_msg("kind %d pixel %u,%u channel %u: %g, expected %g within %g", kind, i % WIDE, i / WIDE, c,
                             (double)found[4 * i + c], right[c], bound[c]);
            }
            if (kind == 1) assert_true(found[4 * i + 2] == 0);
        }
        print_message("# worst differences: mask %.2g, single %.2g, multiple %.2g; at most %.2f of the bound\n", worst[0], worst[1],
                      worst[2], most);
        free(found);
    }
}

static float *image_of(struct gpu *gpu, const struct plain *plain, const char *image, const char *const *words) {
    run(gpu, plain, words);
    return gpu_floats(gpu, image, NULL, NULL);
}

/* How much absorption takes away, and that jitter moves something, and noise, too. */
static void clouds_have_switches(void **state) {
    static const char *const plainly[] = {"cloud_map.jitter=false", NULL},
                             *const half[] = {"cloud_map.jitter=false", "cloud_map.albedo=0.5", NULL},
                             *const jittered[] = {"cloud_map.jitter=true", NULL},
                             *const unshaded[] = {"cloud_map.jitter=false", "cloud_map.light_steps=0", NULL},
                             *const near[] = {"cloud_map.jitter=false", "cloud_map.length_m=1000", NULL};
    struct gpu *gpu = *state;
    fill_unevenly();
    struct glint_clouds worn = slab;
    worn.erosion = 0.5;
    const struct plain smooth_plain = plain_of(NULL, &slab, NULL), worn_plain = plain_of(NULL, &worn, NULL);
    float *whole = image_of(gpu, &smooth_plain, "cloud_map", plainly), *absorbed = image_of(gpu, NULL, "cloud_map", half),
          *moved = image_of(gpu, NULL, "cloud_map", jittered), *bright = image_of(gpu, NULL, "cloud_map", unshaded),
          *none = image_of(gpu, NULL, "cloud_map", near), *eroded = image_of(gpu, &worn_plain, "cloud_map", plainly);
    uint32_t thinner = 0, other = 0, brighter = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        assert_true(absorbed[4 * i] == whole[4 * i] && absorbed[4 * i + 1] == 0.5F * whole[4 * i + 1] &&
                    absorbed[4 * i + 2] == 0.5F * whole[4 * i + 2]);
        assert_true(eroded[4 * i] <= whole[4 * i] && bright[4 * i + 1] >= whole[4 * i + 1]);
        assert_true(none[4 * i] == 0);
        thinner += eroded[4 * i] < whole[4 * i], other += moved[4 * i] != whole[4 * i],
            brighter += bright[4 * i + 1] > whole[4 * i + 1];
    }
    assert_true(thinner > 100 && other > 100 && brighter > 100);
    free(whole), free(absorbed), free(moved), free(bright), free(none), free(eroded);
}

static void same_images(const float *a, const float *b, double part, const char *what) {
    for (uint32_t i = 0; i < 4 * PIXELS; i++)
        if (!(fabs((double)a[i] - (double)b[i]) <= part * fabs((double)a[i])))
            fail_msg("%s: pixel %u,%u channel %u: %g and %g", what, i / 4 % WIDE, i / 4 / WIDE, i % 4, (double)a[i],
                     (double)b[i]);
}

/* Clouds that the wind has blown by their tile are the same; by half of it they are those of a camera that moved the other way. In a world whose z
   points up they lie in its x and y. */
static void clouds_lie_in_the_world(void **state) {
    static const char *const words[] = {"cloud_map.jitter=false", NULL};
    struct gpu *gpu = *state;
    fill_unevenly();
    struct glint_clouds blown = slab, half = slab;
    blown.offset[0] = 2 * slab.tile, blown.offset[1] = -slab.tile;
    half.offset[0] = slab.tile / 4, half.offset[1] = slab.tile / 2;
    const double moved[16] = {1, 0, 0, slab.tile / 4, 0, 1, 0, 0, 0, 0, 1, slab.tile / 2, 0, 0, 0, 1};
    struct plain plains[5] = {plain_of(NULL, &slab, NULL), plain_of(NULL, &blown, NULL), plain_of(NULL, &half, NULL),
                              plain_of(NULL, &slab, moved), plain_of(NULL, &half, upright_z)};
    struct glint_sun sun = low_sun;
    sun.direction[1] = low_sun.direction[2], sun.direction[2] = low_sun.direction[1];
    plains[4].up = GLINT_AXIS_Z, plains[4].sun = &sun;
    float *found[5];
    for (int k = 0; k < 5; k++) found[k] = image_of(gpu, &plains[k], "cloud_map", words);
    same_images(found[0], found[1], 0, "a whole tile");
    same_images(found[2], found[3], 0, "a quarter and a half");
    same_images(found[2], found[4], 1e-4, "z up"); /* sums in another order */
    assert_true(memcmp(found[0], found[2], 4 * PIXELS * sizeof(float)) != 0);
    for (int k = 0; k < 5; k++) free(found[k]);
}

/* ---- the picture ---- */

/* Without molecules and with particles that absorb alone, nothing but stars is seen, and none through a cloud that absorbs everything. */
static void dark_air_shows_stars_alone(void **state) {
    static const char *const starless[] = {"sky_compose.starry=false", "sky_compose.clouds=false", NULL},
                             *const starry[] = {"sky_compose.clouds=false", NULL},
                             *const black[] = {"cloud_map.albedo=0", "halves", NULL};
    struct gpu *gpu = *state;
    fill_evenly(1);
    struct glint_atmosphere dark = even;
    memset(dark.rayleigh, 0, sizeof dark.rayleigh);
    dark.mie_extinction = 1e-5;
    const struct plain plain = plain_of(&dark, &solid, looking_up);
    float *none = image_of(gpu, &plain, "composed_sky", starless), *seen = image_of(gpu, NULL, "composed_sky", starry),
          *lit = gpu_floats(gpu, "composed", NULL, NULL), *passed = gpu_floats(gpu, "sky_passed", NULL, NULL),
          *hidden = image_of(gpu, NULL, "composed_sky", black), *mask = gpu_floats(gpu, "cloud_map", NULL, NULL),
          *halved = gpu_floats(gpu, "composed", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t k = 0; k < 3; k++) {
            if (!is_sky(i)) { /* surfaces keep every bit */
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
            const double own = (double)passed[4 * (y * LOW_WIDE + x)], left = (double)passed[4 * (y * LOW_WIDE + x - 1)],
                         right = (double)passed[4 * (y * LOW_WIDE + x + 1)], above = (double)passed[4 * ((y - 1) * LOW_WIDE + x)],
                         under = (double)passed[4 * ((y + 1) * LOW_WIDE + x)];
            /* Each pixel is an eighth of a texel beside its middle along both axes: 49/64 of the texel, 7/64 of two neighbours, 1/64 of a third. */
            const double low = fmin(fmin(left, right), fmin(fmin(above, under), own)), mixed = own + (left + right + above + under - 4 * own) / 16;
            assert_true(fabs(mean - mixed) <= (own - low) / 16 + 1e-5);
        }
    free(none), free(seen), free(lit), free(passed), free(hidden), free(mask), free(halved);
}

/* Air before an opaque cloud at a known distance: the cloud's own light passes exp(-depth), and the air scatters what it does up to there. */
static void clouds_lie_in_haze(void **state) {
    static const char *const all[] = {"cloud_map.jitter=false", "sky_compose.multiple=false", NULL},
                             *const clear[] = {"cloud_map.jitter=false", "sky_compose.multiple=false", "sky_compose.haze=false", NULL},
                             *const often[] = {"cloud_map.jitter=false", NULL};
    struct gpu *gpu = *state;
    fill_evenly(1);
    const struct plain plain = plain_of(&even, &solid, looking_up);
    float *hazy = image_of(gpu, &plain, "composed_sky", all), *map = gpu_floats(gpu, "cloud_map", NULL, NULL),
          *without = image_of(gpu, NULL, "composed_sky", clear),
          *bright = image_of(gpu, NULL, "composed_sky", often);
    double worst = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        if (!is_sky(i)) continue;
        pixel_ray(i, looking_up, d);
        const double far = 1000 * (double)map[4 * i + 3], high = far * d[1], cosine = cosine_to_sun(d),
                     phase = 3 / (16 * acos(-1)) * (1 + cosine * cosine);
        for (uint32_t k = 0; k < 3; k++) {
            double error;
            const double b = (double)even.rayleigh[k], before = exp(-b * far),
                         sun = (double)even.irradiance[k] * exp(-b * (even.top - high) / low_sun.direction[1]),
                         own = (double)map[4 * i + 1] * sun, light = phase * (double)even.irradiance[k],
                         front = light * slab_light(b, b, d[1] / low_sun.direction[1], far, even.top / d[1], 4, true, &error),
                         right = front + before * own, bound = light * error + right * ldexp(1, -16);
            worst = fmax(worst, fabs((double)hazy[4 * i + k] - right) / bound);
            if (!(fabs((double)hazy[4 * i + k] - right) <= bound))
                fail_msg("pixel %u,%u channel %u: %g, expected %g", i % WIDE, i / WIDE, k, (double)hazy[4 * i + k], right);
            assert_true(fabs((double)without[4 * i + k] - own) <= 1e-4 * own);
            const double more = (double)map[4 * i + 2] * sun;
            assert_true(fabs((double)bright[4 * i + k] - (double)hazy[4 * i + k] - before * more) <= 2e-4 * (double)bright[4 * i + k]);
        }
    }
    print_message("# at most %.2f of the bound\n", worst);
    free(hazy), free(map), free(without), free(bright);
}

/* Molecules and particles by themselves make both together; each has its phase function. */
static void scattering_has_switches(void **state) {
    static const char *const both[] = {"sky_compose.starry=false", NULL},
                             *const molecules[] = {"sky_compose.starry=false", "sky_compose.mie=false", NULL},
                             *const particles[] = {"sky_compose.starry=false", "sky_compose.rayleigh=false", NULL},
                             *const neither[] = {"sky_compose.starry=false", "sky_compose.rayleigh=false", "sky_compose.mie=false", NULL};
    struct gpu *gpu = *state;
    struct glint_atmosphere air = even;
    air.mie = air.mie_extinction = 2e-5, air.mie_asymmetry = 0.6;
    const struct plain plain = plain_of(&air, NULL, looking_up);
    float *sum = image_of(gpu, &plain, "composed_sky", both), *r = image_of(gpu, NULL, "composed_sky", molecules),
          *m = image_of(gpu, NULL, "composed_sky", particles), *none = image_of(gpu, NULL, "composed_sky", neither);
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        if (!is_sky(i)) continue;
        pixel_ray(i, looking_up, d);
        const double cosine = cosine_to_sun(d), pi = acos(-1), rayleigh = 3 / (16 * pi) * (1 + cosine * cosine),
                     mie = (1 - 0.36) / (4 * pi * pow(1.36 - 1.2 * cosine, 1.5));
        for (uint32_t k = 0; k < 3; k++) {
            assert_true(none[4 * i + k] == 0);
            assert_true(fabs((double)sum[4 * i + k] - (double)r[4 * i + k] - (double)m[4 * i + k]) <= 1e-6 * (double)sum[4 * i + k]);
            /* Both are the same integral here but for coefficients, as the air has one density. */
            const double ratio = (double)r[4 * i + k] / (double)m[4 * i + k],
                         right = (double)air.rayleigh[k] / air.mie * rayleigh / mie;
            if (!(fabs(ratio - right) <= 1e-5 * right)) fail_msg("pixel %u: ratio %g, expected %g", i, ratio, right);
        }
    }
    free(sum), free(r), free(m), free(none);
}

/* ---- when there is nothing to do, and what comes next ---- */

static const char *reason_of(struct gpu *gpu, const char *slot, bool *ran) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(gpu->replay, &count);
    for (size_t i = 0; i < count; i++)
        if (!strcmp(results[i].pass->slot, slot)) {
            *ran = results[i].ran;
            return results[i].reason;
        }
    fail_msg("the pipeline has no slot %s", slot);
    return NULL;
}

static void without_sky_there_is_no_pass(void **state) {
    static const char *const none[] = {NULL}, *const slots[] = {"sky_scatter", "cloud_map", "sky_compose"};
    static const struct {
        bool air, clouds, wall, runs[3];
        const char *reasons[3];
    } cases[] = {{false, false, false, {false}, {"no atmosphere", "no clouds", "no atmosphere and no clouds"}},
                 {true, true, true, {false}, {"0 of 1536 pixels are sky", "0 of 1536 pixels are sky", "0 of 1536 pixels are sky"}},
                 {true, false, false, {true, false, true}, {NULL, "no clouds", NULL}},
                 {false, true, false, {false, true, true}, {"no atmosphere", NULL, NULL}},
                 {true, true, false, {true, true, true}, {NULL, NULL, NULL}}};
    struct gpu *gpu = *state;
    fill_evenly(0.5F);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct plain plain = plain_of(cases[i].air ? &earth : NULL, cases[i].clouds ? &slab : NULL, looking_up);
        plain.user = cases[i].wall ? &slab : NULL;
        run(gpu, &plain, none);
        for (uint32_t k = 0; k < 3; k++) {
            bool ran = false;
            const char *reason = reason_of(gpu, slots[k], &ran);
            assert_true(ran == cases[i].runs[k]);
            if (!ran) assert_string_equal(reason, cases[i].reasons[k]);
        }
    }
}

/* Fog leaves the sky as it is, or covers it where it is told to; what is planned is what all passes make. */
static void fog_comes_after_the_sky(void **state) {
    static const struct glint_fog fog = {.color = {0.5F, 0.75F, 1}, .density = 0.15, .base = 0, .scale_height = 10};
    static const char *const before[] = {"fog=height", "whole", NULL}, *const over[] = {"fog=height", "fog.sky=true", NULL},
                             *const all[] = {"fog=height", "whole", "all", NULL};
    struct gpu *gpu = *state;
    fill_unevenly();
    struct plain plain = plain_of(&earth, &slab, NULL);
    plain.fog = &fog;
    run(gpu, &plain, before);
    float *sky = gpu_floats(gpu, "composed_sky", NULL, NULL), *kept = gpu_floats(gpu, "composed_fog", NULL, NULL),
          *covered = image_of(gpu, NULL, "composed_fog", over), *every = image_of(gpu, NULL, "composed_fog", all),
          *lit = gpu_floats(gpu, "composed", NULL, NULL);
    uint32_t changed = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        pixel_ray(i, NULL, d);
        const double passes = d[1] > 0 ? exp(-fog.density * fog.scale_height / d[1]) : 0;
        for (uint32_t k = 0; k < 3; k++) {
            assert_true(every[4 * i + k] == kept[4 * i + k]);
            if (!is_sky(i)) {
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
    static const char *const usual[] = {"whole", NULL}, *const coarse[] = {"whole", "cloud_map.steps=12", "cloud_map.light_steps=2", NULL},
                             *const fine[] = {"whole", "downsample=none", "cloud_map.steps=160", "cloud_map.light_steps=12", "cloud_map.jitter=false",
                                              "sky_scatter.steps=48", "sky_scatter.light_steps=24", NULL};
    static const char *const rgb[] = {"R", "G", "B"}, *const z[] = {"depth.Z"};
    struct gpu *gpu = *state;
    const struct glint_sample_options options = {
        .width = 96, .height = 54, .cube_size = 8, .also = GLINT_ALSO_SKY, .light_samples = 1, .unjittered = true};
    gpu_sample(gpu, "meadow", "meadow", &options);
    float *engine = gpu_part(gpu, "lit", rgb, 3), *depth = gpu_part(gpu, "gbuffer", z, 1);
    double errors[3];
    run(gpu, NULL, coarse);
    errors[0] = mean_error(gpu, engine, depth, 96 * 54);
    run(gpu, NULL, usual);
    errors[1] = mean_error(gpu, engine, depth, 96 * 54);
    run(gpu, NULL, fine);
    errors[2] = mean_error(gpu, engine, depth, 96 * 54);
    print_message("# mean difference to the engine's sky: %.4f, %.4f by default, %.4f of it\n", errors[0], errors[1], errors[2]);
    assert_true(errors[2] < 0.005 && errors[1] < 0.1 && errors[0] > 3 * errors[1]);
    free(engine);
    free(depth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_air_is_integrated),      cmocka_unit_test(an_even_atmosphere_scatters),
        cmocka_unit_test(a_slab_of_cloud_hides_and_scatters), cmocka_unit_test(clouds_have_switches),
        cmocka_unit_test(clouds_lie_in_the_world),    cmocka_unit_test(dark_air_shows_stars_alone),
        cmocka_unit_test(clouds_lie_in_haze),         cmocka_unit_test(scattering_has_switches),
        cmocka_unit_test(without_sky_there_is_no_pass), cmocka_unit_test(fog_comes_after_the_sky),
        cmocka_unit_test(the_engine_draws_the_same_sky)};
    return cmocka_run_group_tests_name("gpu_sky", tests, gpu_set_up, gpu_tear_down);
}
