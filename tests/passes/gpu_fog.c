/* Fog and shafts before a wall, in the shadow of a slab between two planes, against integrals in double precision. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDE = 48, HIGH = 32, PIXELS = WIDE * HIGH };
static const double WALL = 5, NEAR_WALL = 2, FROM = 2.25, TO = 3.75, REACH = 8; /* m; the slab's sides are texels' */

static const struct glint_fog even = {.color = {0.5F, 0.75F, 1}, .density = 0.15},
                              high = {.color = {0.5F, 0.75F, 1}, .density = 0.3, .base = -1, .scale_height = 1.5},
                              adding = {.color = {0.5F, 0.75F, 1}, .density = 0.15, .adds = true};
static const struct glint_sun above = {.direction = {0, 1, 0}, .irradiance = {1, 1, 1}};

/* What casts the shadow lies far above the picture, over -TO < z < -FROM: the map's v grows with z, from -REACH to 0. */
static float map_of_slab(const struct plain *plain, double u, double v) {
    (void)plain, (void)u;
    const double z = -REACH * (1 - v);
    return z > -TO && z < -FROM ? 0.125F : 1;
}
static const struct glint_shadow slab = {
    .world_to_shadow = {1 / 8.0, 0, 0, 0, 0, 0, -1 / 4.0, -1, 0, -1 / 64.0, 0, 0.5, 0, 0, 0, 1}, .range = {0, 1}};

/* The left half lies nearer with `user`. Nothing reflects, so that composed is lit. */
static double depth_of(const struct plain *plain, uint32_t x) {
    return plain->user && x < WIDE / 2 ? NEAR_WALL : WALL;
}
static void spoil_wall(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < PIXELS; i++) {
        values[PLAIN_SPECULAR * PIXELS + i] = 0;
        values[PLAIN_DEPTH * PIXELS + i] = (float)depth_of(plain, i % WIDE);
        for (uint32_t k = 0; k < 3; k++) values[(PLAIN_LIT_R + k) * PIXELS + i] = (float)(i * (5 + k) % 61) / 32;
    }
}

static struct plain plain_of(const struct glint_fog *fog, bool shadow, bool two_walls) {
    return (struct plain){.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.5F,
                          .fov_y_degrees = 60,
                          .spoil = spoil_wall,
                          .fog = fog,
                          .sun = shadow ? &above : NULL,
                          .shadow_map = shadow ? map_of_slab : NULL,
                          .shadow = slab,
                          .user = two_walls ? &slab : NULL};
}
static void run(struct gpu *gpu, const struct plain *plain, const char *const *words) {
    static const char *const slots[] = {
        "screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    char path[256];
    plain_capture(gpu_path(gpu, "fog", path), plain);
    gpu_load(gpu, "fog");
    gpu_reset(gpu);
    gpu_without(gpu, slots);
    gpu_use(gpu, "shaft_march=map");
    gpu_use(gpu, "shaft_blur=depth");
    gpu_use(gpu, "fog=height");
    for (; *words; words++) (strchr(*words, '.') ? gpu_set : gpu_use)(gpu, *words);
    gpu_run(gpu);
}

/* ---- integrals ---- */

static void ray_of(uint32_t x, uint32_t y, double d[3]) {
    const double t = tan(30 * acos(-1) / 180);
    d[0] = t * WIDE / HIGH * (2 * (x + 0.5) / WIDE - 1), d[1] = t * (1 - 2 * (y + 0.5) / HIGH), d[2] = -1;
}
static double density_at(const struct glint_fog *fog, double height) {
    return fog->density * (fog->scale_height > 0 ? exp(-(height - fog->base) / fog->scale_height) : 1);
}
/* By the trapezoidal rule along the ray, with t from 0 to `most` along -z: what the fog scatters to the camera between two depths, and how much
   it lets through. */
struct air {
    double all, shaded, passes;
};
static struct air air_of(const struct glint_fog *fog, const double d[3], double most) {
    enum { STEPS = 8000 };
    const double metres = sqrt(d[0] * d[0] + d[1] * d[1] + 1), step = most / STEPS;
    struct air air = {0, 0, 1};
    double depth = 0, before = density_at(fog, 0);
    for (int i = 1; i <= STEPS; i++) {
        const double t = i * step, now = density_at(fog, d[1] * t), passed = exp(-depth);
        depth += 0.5 * (before + now) * step * metres;
        const double scattered = passed - exp(-depth), middle = t - 0.5 * step;
        air.all += scattered, before = now;
        if (middle > FROM && middle < TO) air.shaded += scattered;
    }
    air.passes = exp(-depth);
    return air;
}

/* ---- tests ---- */

/* Each of the slab's two sides lies in one step. Its light counts as lit or shaded as a whole, and a sample in the middle errs by half of it at
   most, but for how much the fog's light changes within a step: by less than half of it here, where density · step and step / height are
   below 0.1; what passes the fog in front of it makes it less. Then a half: 2^-10. */
static void a_slab_of_shadow_is_integrated(void **state) {
    static const char *const words[] = {"downsample=none", "shaft_march.pattern=middle", "shaft_march.steps=57",
                                        "shaft_blur.radius=0", NULL};
    static const struct glint_fog *const fogs[] = {&even, &high};
    struct gpu *gpu = *state;
    for (int f = 0; f < 2; f++) {
        const struct plain plain = plain_of(fogs[f], true, false);
        double worst = 0, most = 0, least = 1;
        run(gpu, &plain, words);
        float *found = gpu_floats(gpu, "shaft_half", NULL, NULL);
        for (uint32_t i = 0; i < PIXELS; i++) {
            double d[3];
            ray_of(i % WIDE, i / WIDE, d);
            const struct air air = air_of(fogs[f], d, WALL);
            const double right = 1 - air.shaded / air.all, step = WALL / 57,
                         metres = sqrt(d[0] * d[0] + d[1] * d[1] + 1);
            double bound = ldexp(1, -10);
            for (int side = 0; side < 2; side++) {
                const double light = density_at(fogs[f], d[1] * (side ? TO : FROM)) * step * metres;
                bound += 0.5 * 1.5 * light / air.all;
            }
            worst = fmax(worst, fabs((double)found[i] - right)), most = fmax(most, right), least = fmin(least, right);
            if (!(fabs((double)found[i] - right) <= bound))
                fail_msg("pixel %u,%u: %g, expected %g within %g", i % WIDE, i / WIDE, (double)found[i], right, bound);
        }
        free(found);
        print_message("# %s: worst difference %.4f of %.3f to %.3f\n", f ? "height fog" : "even fog", worst, least,
                      most);
        assert_true(most < 0.9);
    }
}

static void fog_covers_and_scatters(void **state) {
    static const char *const words[][3] = {{"downsample=none", NULL}, {"downsample=none", "fog.sun_share=0", NULL}};
    static const struct glint_fog *const fogs[] = {&even, &high, &adding};
    struct gpu *gpu = *state;
    for (int f = 0; f < 4; f++) {
        const struct glint_fog *fog = fogs[f % 3];
        const struct plain plain = plain_of(fog, true, false);
        run(gpu, &plain, words[f == 3]);
        float *lit = gpu_floats(gpu, "composed", NULL, NULL), *found = gpu_floats(gpu, "composed_fog", NULL, NULL),
              *shafts = gpu_floats(gpu, "shafts", NULL, NULL);
        for (uint32_t i = 0; i < PIXELS; i++) {
            double d[3];
            ray_of(i % WIDE, i / WIDE, d);
            const double passes = air_of(fog, d, WALL).passes, share = f == 3 ? 0 : 0.5;
            for (uint32_t k = 0; k < 3; k++) {
                const double right = (fog->adds ? 1 : passes) * (double)lit[4 * i + k] +
                                     (1 - passes) * (double)fog->color[k] * (1 - share * (1 - (double)shafts[i]));
                /* The trapezoidal rule is exact to 1e-6; a half. */
                if (!(fabs((double)found[4 * i + k] - right) <= ldexp(right, -10) + 2e-6))
                    fail_msg("pixel %u,%u channel %u: %g, expected %g", i % WIDE, i / WIDE, k, (double)found[4 * i + k],
                             right);
            }
        }
        free(lit);
        free(found);
        free(shafts);
    }
}

/* The near wall lies before the slab: all air in front of it is lit, and nothing of the shadow beside it may be mixed in. The samples of a block
   of 4 x 4 texels lie in 16 places of their steps, so that their mean is nearer to the integral than they are. */
static void the_blur_stays_at_its_depth(void **state) {
    static const char *const words[] = {"shaft_march.steps=8", NULL}, *const mixing[] = {"shaft_blur.depth_part=10",
                                                                                         NULL};
    struct gpu *gpu = *state;
    const struct plain plain = plain_of(&even, true, true);
    double raw = 0, blurred = 0;
    run(gpu, &plain, words);
    float *found = gpu_floats(gpu, "shafts", NULL, NULL), *half = gpu_floats(gpu, "shaft_half", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t x = i % WIDE, y = i / WIDE;
        double d[3];
        if (x < WIDE / 2) assert_true(found[i] == 1);
        if (x < WIDE / 2 + 6 || x >= WIDE - 6 || y < 6 || y >= HIGH - 6) continue;
        ray_of(x, y, d);
        const struct air air = air_of(&even, d, WALL);
        const double right = 1 - air.shaded / air.all;
        raw += pow((double)half[y / 2 * (WIDE / 2) + x / 2] - right, 2), blurred += pow((double)found[i] - right, 2);
    }
    print_message("# mean square error of the blur: %.3f of that before\n", blurred / raw);
    assert_true(blurred < 0.05 * raw);
    free(found);
    free(half);
    run(gpu, &plain, mixing);
    found = gpu_floats(gpu, "shafts", NULL, NULL);
    assert_true(found[HIGH / 2 * WIDE + WIDE / 2 - 1] < 1);
    free(found);
}

static void without_fog_there_is_no_pass(void **state) {
    static const char *const none[] = {NULL};
    struct gpu *gpu = *state;
    for (int kind = 0; kind < 2; kind++) { /* no fog; no shadow map */
        const struct plain plain = plain_of(kind ? &even : NULL, !kind, false);
        run(gpu, &plain, none);
        const struct glint_pass_result *march = gpu_result(gpu, "shaft_march"), *blur = gpu_result(gpu, "shaft_blur"),
                                       *fog = gpu_result(gpu, "fog");
        assert_true(!march->ran && !blur->ran && fog->ran == (kind == 1));
        assert_string_equal(march->reason, kind ? "no sun" : "no fog");
        assert_string_equal(blur->reason, march->reason);
        if (!kind) assert_string_equal(fog->reason, "no fog");
    }
}

/* Without a plan the pass of the water runs in a capture that has none, too, and nothing is in front of the surfaces. */
static void a_dry_frame_is_as_planned(void **state) {
    struct gpu *gpu = *state;
    const struct plain plain = plain_of(&even, true, true);
    char path[256];
    plain_capture(gpu_path(gpu, "dry", path), &plain);
    gpu_load(gpu, "dry");
    gpu_reset(gpu);
    gpu_use(gpu, "water=combine");
    gpu_use(gpu, "fog=height");
    gpu_run(gpu);
    float *planned = gpu_floats(gpu, "composed_fog", NULL, NULL);
    gpu->all = true;
    gpu_run(gpu);
    float *all = gpu_floats(gpu, "composed_fog", NULL, NULL);
    assert_memory_equal(planned, all, 4 * PIXELS * sizeof *all);
    free(planned);
    free(all);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slab_of_shadow_is_integrated), cmocka_unit_test(fog_covers_and_scatters),
        cmocka_unit_test(the_blur_stays_at_its_depth), cmocka_unit_test(without_fog_there_is_no_pass),
        cmocka_unit_test(a_dry_frame_is_as_planned)};
    return cmocka_run_group_tests_name("gpu_fog", tests, gpu_set_up, gpu_tear_down);
}
