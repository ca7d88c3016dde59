/* Slabs of cloud against closed forms in double precision, and where clouds lie. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sky_frames.h"
#include "unit.h"

/* Straight ahead in a world whose z points up. */
static const double upright_z[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1};

static double lobes(double cosine, double part) {
    const double a = 0.8 * part, b = 0.3 * part, pi = acos(-1);
    return (0.7 * (1 - a * a) / pow(1 + a * a - 2 * a * cosine, 1.5) +
            0.3 * (1 - b * b) / pow(1 + b * b + 2 * b * cosine, 1.5)) /
           (4 * pi);
}

static void a_slab_of_cloud_hides_and_scatters(void **state) {
    enum { STEPS = 16, OCTAVES = 3 };
    static const char *const words[][8] = {{"cloud_map.steps=16", "cloud_map.light_m=1e6", "cloud_map.octaves=3",
                                            "cloud_map.jitter=false", "cloud_map.length_m=1e6", NULL},
                                           {"cloud_map.steps=16", "cloud_map.light_m=1e6", "cloud_map.octaves=0",
                                            "cloud_map.jitter=true", "cloud_map.length_m=1e6", "cloud_map.albedo=0.5",
                                            NULL}};
    struct gpu *gpu = *state;
    sky_fill_evenly(0.75F);
    for (int kind = 0; kind < 3; kind++) { /* ahead; ahead with jitter, half of it absorbed; up */
        const double *view = kind == 2 ? sky_upwards : NULL, extinction = 0.75 * sky_slab.extinction,
                     deep = sky_slab.top - sky_slab.bottom;
        const struct plain plain = sky_plain(NULL, &sky_slab, view);
        sky_run(gpu, &plain, words[kind == 1]);
        float *found = gpu_floats(gpu, "cloud_map", NULL, NULL);
        double worst[3] = {0, 0, 0}, most = 0;
        for (uint32_t i = 0; i < PIXELS; i++) {
            double d[3], right[3] = {0}, bound[3], error;
            sky_pixel_ray(i, view, d);
            if (!sky_shows(i) || d[1] <= 0.01) { /* the flattest of these rays rises by 1/32 · tan 50° */
                for (uint32_t c = 0; c < 4; c++) assert_true(found[4 * i + c] == 0);
                continue;
            }
            const double length = deep / d[1], rise = d[1] / sky_sun.direction[1], cosine = sky_cosine(d);
            right[0] = -expm1(-extinction * length);
            bound[0] = ldexp(1, -12) + ldexp(1, -18); /* less is left: all is hidden; and 16 products */
            right[1] =
                lobes(cosine, 1) * sky_slab_light(extinction, extinction, rise, length, length, STEPS, false, &error);
            bound[1] = lobes(cosine, 1) * (error + ldexp(1, -12)) + right[1] * ldexp(1, -16);
            bound[2] = 0;
            for (int k = 1; k <= OCTAVES; k++) {
                const double phase = ldexp(lobes(cosine, ldexp(1, -k)), -k),
                             term = phase * sky_slab_light(extinction, ldexp(extinction, -k), rise, length, length,
                                                           STEPS, false, &error);
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
            if (right[0] > 1 - 0.99 * ldexp(1, -12)) assert_true(found[4 * i] == 1); /* nothing shines through */
        }
        print_message("# worst differences: mask %.2g, single %.2g, multiple %.2g; at most %.2f of the bound\n",
                      worst[0], worst[1], worst[2], most);
        free(found);
    }
}

/* How much absorption takes away, and that jitter moves something, and noise, too. */
static void clouds_have_switches(void **state) {
    static const char *const plainly[] = {"cloud_map.jitter=false", NULL},
                             *const half[] = {"cloud_map.jitter=false", "cloud_map.albedo=0.5", NULL},
                             *const jittered[] = {"cloud_map.jitter=true", NULL},
                             *const unshaded[] = {"cloud_map.jitter=false", "cloud_map.light_steps=0", NULL},
                             *const near[] = {"cloud_map.jitter=false", "cloud_map.length_m=1000", NULL};
    struct gpu *gpu = *state;
    sky_fill_unevenly();
    struct glint_clouds worn = sky_slab;
    worn.erosion = 0.5;
    const struct plain smooth_plain = sky_plain(NULL, &sky_slab, NULL), worn_plain = sky_plain(NULL, &worn, NULL);
    float *whole = sky_image(gpu, &smooth_plain, "cloud_map", plainly),
          *absorbed = sky_image(gpu, NULL, "cloud_map", half), *moved = sky_image(gpu, NULL, "cloud_map", jittered),
          *bright = sky_image(gpu, NULL, "cloud_map", unshaded), *none = sky_image(gpu, NULL, "cloud_map", near),
          *eroded = sky_image(gpu, &worn_plain, "cloud_map", plainly);
    uint32_t thinner = 0, other = 0, brighter = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        assert_true(absorbed[4 * i] == whole[4 * i] && absorbed[4 * i + 1] == 0.5F * whole[4 * i + 1] &&
                    absorbed[4 * i + 2] == 0.5F * whole[4 * i + 2]);
        assert_true(eroded[4 * i] <= whole[4 * i] && bright[4 * i + 1] >= whole[4 * i + 1]);
        assert_true(none[4 * i] == 0);
        thinner += eroded[4 * i]<whole[4 * i], other += moved[4 * i] != whole[4 * i], brighter += bright[4 * i + 1]>
            whole[4 * i + 1];
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
    sky_fill_unevenly();
    struct glint_clouds blown = sky_slab, half = sky_slab;
    blown.offset[0] = 2 * sky_slab.tile, blown.offset[1] = -sky_slab.tile;
    half.offset[0] = sky_slab.tile / 4, half.offset[1] = sky_slab.tile / 2;
    const double moved[16] = {1, 0, 0, sky_slab.tile / 4, 0, 1, 0, 0, 0, 0, 1, sky_slab.tile / 2, 0, 0, 0, 1};
    struct plain plains[5] = {sky_plain(NULL, &sky_slab, NULL), sky_plain(NULL, &blown, NULL),
                              sky_plain(NULL, &half, NULL), sky_plain(NULL, &sky_slab, moved),
                              sky_plain(NULL, &half, upright_z)};
    struct glint_sun sun = sky_sun;
    sun.direction[1] = sky_sun.direction[2], sun.direction[2] = sky_sun.direction[1];
    plains[4].up = GLINT_AXIS_Z, plains[4].sun = &sun;
    float *found[5];
    for (int k = 0; k < 5; k++) found[k] = sky_image(gpu, &plains[k], "cloud_map", words);
    same_images(found[0], found[1], 0, "a whole tile");
    same_images(found[2], found[3], 0, "a quarter and a half");
    same_images(found[2], found[4], 1e-4, "z up"); /* sums in another order */
    assert_true(memcmp(found[0], found[2], 4 * PIXELS * sizeof(float)) != 0);
    for (int k = 0; k < 5; k++) free(found[k]);
}

/* Over a planet the layer comes down to the horizon, and ends there. What is seen of opaque clouds lies at its lower side: the n-th step, n from 0, hides
   q^n (1 - q) of it, with q what passes a step, so that their mean distance is half a step and q / (1 - q) steps behind where the layer begins. Of what
   is left below 2^-12 none counts. */
static void clouds_end_at_the_horizon(void **state) {
    enum { STEPS = 48 };
    static const char *const words[] = {"cloud_map.jitter=false", "cloud_map.length_m=1e6", NULL};
    const struct glint_atmosphere air = {.planet_radius = 6360e3, .top = 60e3};
    struct gpu *gpu = *state;
    double farthest = 0, worst = 0;
    sky_fill_evenly(1);
    const struct plain plain = sky_plain(&air, &sky_solid, NULL);
    float *found = sky_image(gpu, &plain, "cloud_map", words);
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        sky_pixel_ray(i, NULL, d);
        if (!sky_shows(i) || d[1] < 0) {
            assert_true(found[4 * i] == 0);
            continue;
        }
        const double r = air.planet_radius, b = r * d[1], begin = sqrt(b * b + 1000 * (2 * r + 1000)) - b,
                     end = sqrt(b * b + 1500 * (2 * r + 1500)) - b, step = (end - begin) / STEPS,
                     q = exp(-sky_solid.extinction * step), right = begin + step * (0.5 + q / (1 - q)),
                     bound = ldexp(end - begin, -12) + right * ldexp(1, -18),
                     difference = 1000 * (double)found[4 * i + 3] - right;
        assert_true(found[4 * i] == 1);
        farthest = fmax(farthest, right), worst = fmax(worst, fabs(difference) / bound);
        if (!(fabs(difference) <= bound))
            fail_msg("pixel %u,%u: at %g m, expected %g within %g", i % WIDE, i / WIDE, right + difference, right,
                     bound);
    }
    print_message("# up to %.0f m, at most %.2f of the bound\n", farthest, worst);
    free(found);
}

/* Textures that were moved over their borders lie where they lay if the wind moves them back, and the ground the noise. */
static void clouds_repeat(void **state) {
    static const char *const words[] = {"cloud_map.jitter=false", NULL};
    struct gpu *gpu = *state;
    struct glint_clouds worn = sky_slab, moved;
    worn.erosion = 0.5, worn.noise_tile = worn.tile;
    moved = worn;
    const double texel = worn.tile / SIDE;
    moved.offset[0] = -3 * texel, moved.offset[1] = -2 * texel;
    moved.ground = -5 * texel, moved.bottom += 5 * texel, moved.top += 5 * texel;
    const struct plain plains[2] = {sky_plain(NULL, &worn, NULL), sky_plain(NULL, &moved, NULL)};
    sky_fill_unevenly();
    float *found = sky_image(gpu, &plains[0], "cloud_map", words);
    sky_roll(3, 2, 5);
    float *rolled = sky_image(gpu, &plains[1], "cloud_map", words);
    same_images(found, rolled, 1e-4, "rolled");
    free(found), free(rolled);
}

/* Air before an opaque cloud at a known distance: the cloud's own light passes exp(-depth), and the air scatters what it does up to there. */
static void clouds_lie_in_haze(void **state) {
    static const char *const all[] = {"cloud_map.jitter=false", "sky_compose.multiple=false", NULL},
                             *const clear[] = {"cloud_map.jitter=false", "sky_compose.multiple=false",
                                               "sky_compose.haze=false", NULL},
                             *const often[] = {"cloud_map.jitter=false", NULL};
    struct gpu *gpu = *state;
    sky_fill_evenly(1);
    const struct plain plain = sky_plain(&sky_even, &sky_solid, sky_upwards);
    float *hazy = sky_image(gpu, &plain, "composed_sky", all), *map = gpu_floats(gpu, "cloud_map", NULL, NULL),
          *without = sky_image(gpu, NULL, "composed_sky", clear), *bright = sky_image(gpu, NULL, "composed_sky", often);
    double worst = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        if (!sky_shows(i)) continue;
        sky_pixel_ray(i, sky_upwards, d);
        const double far = 1000 * (double)map[4 * i + 3], high = far * d[1], cosine = sky_cosine(d),
                     phase = 3 / (16 * acos(-1)) * (1 + cosine * cosine);
        for (uint32_t k = 0; k < 3; k++) {
            double error;
            const double b = (double)sky_even.rayleigh[k], before = exp(-b * far),
                         sun = (double)sky_even.irradiance[k] * exp(-b * (sky_even.top - high) / sky_sun.direction[1]),
                         own = (double)map[4 * i + 1] * sun, light = phase * (double)sky_even.irradiance[k],
                         front = light * sky_slab_light(b, b, d[1] / sky_sun.direction[1], far, sky_even.top / d[1], 4,
                                                        true, &error),
                         right = front + before * own, bound = light * error + right * ldexp(1, -16);
            worst = fmax(worst, fabs((double)hazy[4 * i + k] - right) / bound);
            if (!(fabs((double)hazy[4 * i + k] - right) <= bound))
                fail_msg("pixel %u,%u channel %u: %g, expected %g", i % WIDE, i / WIDE, k, (double)hazy[4 * i + k],
                         right);
            assert_true(fabs((double)without[4 * i + k] - own) <= 1e-4 * own);
            const double more = (double)map[4 * i + 2] * sun;
            assert_true(fabs((double)bright[4 * i + k] - (double)hazy[4 * i + k] - before * more) <=
                        2e-4 * (double)bright[4 * i + k]);
        }
    }
    print_message("# at most %.2f of the bound\n", worst);
    free(hazy), free(map), free(without), free(bright);
}

/* ---- shadows of clouds on surfaces ---- */

static float visible[PIXELS], through[PIXELS];
static const struct glint_channel mask_channels[] = {{.name = "visibility", .type = GLINT_F32, .data = visible},
                                                     {.name = "clouds", .type = GLINT_F32, .data = through}};

/* Both masks are multiplied. What is in both has left the captured light already, so that without contact shadows nothing more does. */
static void cloud_shadows_are_in_the_mask(void **state) {
    static const char *const words[][6] = {
        {"shadow_mask=captured", "contact_trace=linear", "contact_apply=bilinear", "contact_trace.length_m=0", NULL},
        {"shadow_mask=map", "contact_trace=linear", "contact_apply=bilinear", "contact_trace.length_m=0", NULL},
        {"shadow_mask=captured", "shadow_mask.clouds=false", NULL},
        {"shadow_mask=map", "shadow_mask.clouds=false", NULL}};
    static const char *const rgb[] = {"R", "G", "B"};
    struct gpu *gpu = *state;
    for (uint32_t i = 0; i < PIXELS; i++) visible[i] = (float)(i % 5) / 4, through[i] = (float)(i % 7) / 8;
    through[9] = NAN; /* no light */
    for (int kind = 0; kind < 8; kind++) {
        struct plain plain = sky_plain(NULL, NULL, NULL);
        const struct glint_part sun = {
            .name = "sun", .width = WIDE, .height = HIGH, .channels = mask_channels, .channel_count = kind < 4 ? 2 : 1};
        plain.user = &sun; /* no sky */
        plain.part = &sun, plain.part_count = 1;
        float *found = sky_image(gpu, &plain, "shadow_mask", words[kind % 4]), *lit = gpu_part(gpu, "lit", rgb, 3),
              *composed = gpu_floats(gpu, "composed", NULL, NULL);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const float cloud = kind >= 4 || kind % 4 >= 2 ? 1 : i == 9 ? 0 : through[i];
            if (!(found[i] == cloud * visible[i]))
                fail_msg("kind %d pixel %u: %g, expected %g", kind, i, (double)found[i], (double)(cloud * visible[i]));
            for (uint32_t k = 0; k < 3; k++) assert_true(composed[4 * i + k] == lit[3 * i + k]);
        }
        free(found), free(lit), free(composed);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_slab_of_cloud_hides_and_scatters),
                                       cmocka_unit_test(clouds_have_switches),
                                       cmocka_unit_test(clouds_lie_in_the_world),
                                       cmocka_unit_test(clouds_end_at_the_horizon),
                                       cmocka_unit_test(clouds_repeat),
                                       cmocka_unit_test(clouds_lie_in_haze),
                                       cmocka_unit_test(cloud_shadows_are_in_the_mask)};
    return cmocka_run_group_tests_name("gpu_clouds", tests, gpu_set_up, gpu_tear_down);
}
