/* shadow_mask, contact_trace and contact_apply against closed forms, in frames that show all that casts the shadow. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sunlit.h"
#include "unit.h"

static const char *const variants[] = {"contact_trace=dda", "contact_trace=hiz", "contact_trace=linear_facets",
                                       "contact_trace=linear", "contact_trace=linear_binary"};
enum { DDA, HIZ, FACETS, LINEAR, BINARY, VARIANTS };

/* ---- shadows of boxes ---- */

static const struct shapes pole = {.floor_y = -1, .box = {-0.05, -1, -4.1, 0.05, 0.2, -4}};
static const struct shapes wall = {.floor_y = -1, .wall_z = -4, .wall_top = -0.6};

/* How far from the foot the middle column is dark. */
static double length_of_shadow(const struct plain *plain, const float *found, double *pixel) {
    double far = 0, position[3], normal[3], before = 0;
    for (uint32_t y = plain->height - 1; y > 0; y--) {
        if (!shapes_pixel(plain->user, plain, plain->width / 2, y, position, normal) || normal[1] < 0.5) break;
        const double away = position[2] + 4;
        if (found[y * plain->width + plain->width / 2] < 0.5F) {
            *pixel = before - away;
            return far = away;
        }
        before = away;
    }
    return far;
}

/* The shadow of a height h under a sun of elevation e is h / tan e long, and no longer than the rays reach: their length times cos e. */
static void a_shadow_is_as_long_as_the_sun_is_low(void **state) {
    static const struct shapes *const scenes[] = {&sunlit_box, &wall, &pole};
    static const double heights[] = {0.5, 0.4, 1.2};
    struct gpu *gpu = *state;
    for (int s = 0; s < 3; s++)
        for (int e = 35; e <= (s == 0 ? 60 : 35); e += 25) {
            const struct glint_sun sun = sunlit_sun(e, 0);
            const struct plain plain = sunlit_frame(scenes[s], &sun);
            occlusion_load(gpu, &plain);
            for (int v = 0; v < VARIANTS; v++)
                for (int brief = 0; brief <= (e == 35); brief++) {
                    const char *const words[] = {variants[v], v == HIZ ? "hiz=nearest" : "contact_trace.lift=0",
                                                 brief ? "contact_trace.length_m=0.3" : "contact_trace.length_m=4",
                                                 v >= FACETS ? "contact_trace.steps=128" : NULL, NULL};
                    const double a = e * M_PI / 180, right = fmin(heights[s] / tan(a), (brief ? 0.3 : 4) * cos(a));
                    double pixel = 0;
                    float *found = sunlit_run(gpu, words);
                    const double length = length_of_shadow(&plain, found, &pixel);
                    /* A sample of the linear march has to fall behind the surface by no more than the thickness. */
                    if (!(fabs(length - right) < (v >= LINEAR ? 2 : 1) * pixel + 0.03))
                        fail_msg("scene %d, %s, %d degrees: a shadow of %g m, expected %g, a pixel is %g", s,
                                 variants[v], e, length, right, pixel);
                    free(found);
                }
        }
}

/* From every side: what the frame shows is found, and nothing else is. The share of wrong pixels that each may have. */
static void the_sun_may_stand_anywhere(void **state) {
    static const double share[VARIANTS] = {0.01, 0.01, 0.012, 0.03, 0};
    struct gpu *gpu = *state;
    int dark = 0;
    for (int azimuth = 0; azimuth < 360; azimuth += 100) {
        const struct glint_sun sun = sunlit_sun(35, azimuth);
        const struct plain plain = sunlit_frame(&sunlit_box, &sun);
        occlusion_load(gpu, &plain);
        for (int v = 0; v < BINARY; v++) {
            const char *const words[] = {variants[v], v == HIZ ? "hiz=nearest" : "contact_trace.lift=0",
                                         "contact_trace.length_m=0.5", v >= FACETS ? "contact_trace.steps=64" : NULL,
                                         NULL};
            float *found = sunlit_run(gpu, words);
            const struct sunlit_counts c = sunlit_errors(&plain, found, 0.5);
            print_message("# %s, %d degrees: of %d dark %d missed, of %d lit %d dark\n", variants[v], azimuth, c.dark,
                          c.missed, c.pixels - c.dark, c.false_dark);
            dark += c.dark;
            assert_true(c.pixels > 8000);
            assert_true(c.missed + c.false_dark <= share[v] * c.pixels);
            free(found);
        }
    }
    assert_true(dark > 1500);
}

/* ---- nothing shades itself ---- */

static void an_open_plain_is_lit(void **state) {
    static const struct shapes open = {.floor_y = -1};
    static const int elevations[] = {2, 30};
    struct gpu *gpu = *state;
    for (int e = 0; e < 2; e++)
        for (int azimuth = 0; azimuth < 360; azimuth += 150) {
            const struct glint_sun sun = sunlit_sun(elevations[e], azimuth);
            const struct plain plain = sunlit_frame(&open, &sun);
            occlusion_load(gpu, &plain);
            for (int v = 0; v < BINARY; v++)
                for (int half = e; half < 2; half++) {
                    const char *const words[] = {variants[v], half ? "downsample=pick" : "downsample=none",
                                                 "contact_apply=planes", "hiz=nearest", NULL};
                    int dark = 0;
                    sunlit_arrange(gpu, words);
                    gpu->float_precision = false;
                    gpu_run(gpu);
                    float *found = gpu_floats(gpu, "sun_shadow", NULL, NULL);
                    for (uint32_t i = 0; i < WIDE * HIGH; i++) dark += found[i] != 1;
                    print_message("# %s, %s, elevation %d, azimuth %d: %d dark\n", variants[v], words[1], elevations[e],
                                  azimuth, dark);
                    if (dark >
                        (v == LINEAR ? WIDE * HIGH / 20 : 0)) /* beside the sky it compares with the nearest texel */
                        fail_msg("%s, %s, elevation %d, azimuth %d: %d pixels are dark", variants[v], words[1],
                                 elevations[e], azimuth, dark);
                    free(found);
                }
        }
}

/* Below the horizon nothing is lit, and no ray is traced. */
static void a_sun_below_the_horizon_lights_nothing(void **state) {
    static const struct shapes open = {.floor_y = -1};
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(-1, 40);
    const struct plain plain = sunlit_frame(&open, &sun);
    occlusion_load(gpu, &plain);
    for (int facing = 0; facing < 2; facing++) {
        const char *const words[] = {variants[DDA], facing ? NULL : "contact_apply.facing=false", NULL};
        float *found = sunlit_run(gpu, words);
        uint32_t *steps = gpu_uints(gpu, "contact_steps", NULL, NULL);
        double position[3], normal[3];
        for (uint32_t i = 0; i < WIDE * HIGH; i++) {
            const bool surface = shapes_pixel(&open, &plain, i % WIDE, i / WIDE, position, normal);
            assert_true(found[i] == (surface && facing ? 0 : 1) && steps[i] == 0);
        }
        free(found), free(steps);
    }
}

/* ---- switches ---- */

static float dark_left(UNUSED const struct plain *plain, uint32_t x, UNUSED uint32_t y) {
    return x < WIDE / 2 ? 0 : x % 3 ? 0.75F : 1;
}
static float dark_everywhere(UNUSED const struct plain *plain, UNUSED uint32_t x, UNUSED uint32_t y) {
    return 0;
}
static float invalid_mask(UNUSED const struct plain *plain, uint32_t x, uint32_t y) {
    static const float values[] = {NAN, -1, 7, INFINITY, 0.5F};
    return values[(x + y) % 5];
}

static void the_mask_and_the_contact_shadow_meet_in_their_minimum(void **state) {
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(35, -30);
    struct plain plain = sunlit_frame(&sunlit_box, &sun);
    plain.sun_mask = dark_left;
    occlusion_load(gpu, &plain);
    static const char *const alone[] = {"contact_trace=dda", "shadow_mask.mask=none", NULL};
    static const char *const both[] = {"contact_trace=dda", NULL};
    static const char *const neither[] = {"contact_trace=dda", "contact_trace.length_m=0", NULL};
    static const char *const thin[] = {"contact_trace=dda", "contact_apply.intensity=0", NULL};
    float *contact = sunlit_run(gpu, alone), *found = sunlit_run(gpu, both), *mask = sunlit_run(gpu, neither),
          *none = sunlit_run(gpu, thin);
    int darker = 0;
    double position[3], normal[3];
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        assert_true(found[i] == fminf(contact[i], mask[i]) && none[i] == mask[i]);
        darker += found[i] < mask[i];
        if (!shapes_pixel(&sunlit_box, &plain, i % WIDE, i / WIDE, position, normal)) assert_true(found[i] == 1);
        else if (normal[1] > 0.5) assert_true(mask[i] == dark_left(&plain, i % WIDE, i / WIDE));
    }
    assert_true(darker > 50);
    free(contact), free(found), free(mask), free(none);
}

/* Texels that shade no lit pixel trace no ray, at either resolution. */
static void skipped_rays_would_have_changed_nothing(void **state) {
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(35, 30);
    struct plain plain = sunlit_frame(&sunlit_box, &sun);
    plain.sun_mask = dark_left;
    occlusion_load(gpu, &plain);
    for (int half = 0; half < 2; half++) {
        uint64_t steps[2] = {0, 0};
        float *found[2];
        for (int skip = 0; skip < 2; skip++) {
            const char *const words[] = {"contact_trace=dda", half ? "downsample=pick" : "downsample=none",
                                         "contact_apply=planes", skip ? NULL : "contact_trace.skip=false", NULL};
            uint32_t width, height;
            found[skip] = sunlit_run(gpu, words);
            uint32_t *taken = gpu_uints(gpu, "contact_steps", &width, &height);
            for (uint32_t i = 0; i < width * height; i++) steps[skip] += taken[i];
            free(taken);
        }
        print_message("# %d steps of %d\n", (int)steps[1], (int)steps[0]);
        assert_memory_equal(found[0], found[1], WIDE * HIGH * sizeof(float));
        assert_true(5 * steps[1] < 3 * steps[0] && steps[1] > 0);
        free(found[0]), free(found[1]);
    }
}

/* How far from the border of the picture a hit lies, as a fraction of the half. */
static double inside_of(const struct plain *plain, uint32_t i, double distance) {
    const double half = tan(plain->fov_y_degrees * M_PI / 360), *sun = plain->sun->direction;
    double at[3], normal[3];
    shapes_pixel(plain->user, plain, i % WIDE, i / WIDE, at, normal);
    for (int k = 0; k < 3; k++) at[k] += distance * sun[k];
    const double x = at[0] / -at[2] / half * HIGH / WIDE, y = at[1] / -at[2] / half;
    return 1 - fmax(fabs(x), fabs(y));
}

static void hits_fade_at_the_end_and_at_the_border(void **state) {
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(35, 0);
    const struct plain plain = sunlit_frame(&sunlit_box, &sun);
    occlusion_load(gpu, &plain);
    static const char *const hard[] = {"contact_trace=dda", NULL};
    static const char *const at_end[] = {"contact_trace=dda", "contact_trace.end_fade=1", NULL};
    static const char *const at_border[] = {"contact_trace=dda", "contact_trace.border_fade=0.5", NULL};
    float *found = sunlit_run(gpu, hard), *distance = gpu_floats(gpu, "contact_distance", NULL, NULL),
          *end = sunlit_run(gpu, at_end), *border = sunlit_run(gpu, at_border);
    int faded = 0, bordered = 0;
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        if (!(distance[i] < 0.5F)) {
            assert_true(end[i] == found[i] && border[i] == found[i]);
            continue;
        }
        assert_true(fabs((double)end[i] - (double)distance[i] / 0.5) < 1e-5);
        assert_true(fabs((double)border[i] - (1 - inside_of(&plain, i, (double)distance[i]))) < 1e-4);
        faded++, bordered += border[i] > 0.2F;
    }
    assert_true(faded > 100 && bordered > 50);
    free(found), free(distance), free(end), free(border);
}

/* The part of a disc above a straight edge at t radii below its middle. */
static double part_above(double t) {
    return t >= 1 ? 1 : t <= -1 ? 0 : 1 - (acos(t) - t * sqrt(1 - t * t)) / M_PI;
}
/* Behind a long wall of the height 0.4 the floor sees the part of the disc above its top, which is a straight edge of the plane of the disc. */
static void a_wide_sun_has_a_penumbra(void **state) {
    static const char *const words[] = {"contact_trace=dda", "contact_trace.disc=1", "contact_trace.directions=48",
                                        "contact_trace.length_m=4", NULL};
    struct gpu *gpu = *state;
    const double elevation = 35 * M_PI / 180;
    struct glint_sun sun = sunlit_sun(35, 0);
    sun.angular_radius_rad = 0.25;
    const struct plain plain = sunlit_frame(&wall, &sun);
    int part = 0;
    occlusion_load(gpu, &plain);
    float *found = sunlit_run(gpu, words);
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        double position[3], normal[3];
        if (!shapes_pixel(&wall, &plain, i % WIDE, i / WIDE, position, normal) || normal[1] < 0.5 || position[2] < -3.9)
            continue;
        if (fabs(position[0]) > 0.8) continue; /* rays to the side may leave the picture */
        const double top = atan(0.4 / (position[2] + 4)), right = part_above(tan(elevation - top) / tan(0.25));
        part += right > 0.1 && right < 0.9;
        if (!(fabs((double)found[i] - right) < 0.12))
            fail_msg("%g m from the wall: %g, expected %g", position[2] + 4, (double)found[i], right);
    }
    print_message("# %d pixels see a part of the disc\n", part);
    assert_true(part > 150);
    free(found);
}

/* ---- the picture ---- */

/* What the sun adds to a white surface goes where it passes the mask and not the traced shadow: the captured shadow counts once. */
static void the_picture_loses_the_suns_light(void **state) {
    static float (*const masks[])(const struct plain *, uint32_t, uint32_t) = {NULL, dark_left, dark_everywhere};
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(35, 30);
    for (int m = 0; m < 3; m++)
        for (int shade = 0; shade < 2; shade++) {
            const char *const words[] = {"contact_trace=dda", "compose=brdf",
                                         shade ? "compose.shade=true" : "compose.shade=false", NULL};
            struct plain plain = sunlit_frame(&sunlit_box, &sun);
            int darker = 0;
            plain.sun_mask = masks[m];
            occlusion_load(gpu, &plain);
            float *shadow = sunlit_run(gpu, words), *composed = gpu_floats(gpu, "composed", NULL, NULL),
                  *lit = gpu_part(gpu, "lit", (const char *const[]){"R", "G", "B"}, 3);
            for (uint32_t i = 0; i < WIDE * HIGH; i++) {
                double position[3], normal[3], cosine = 0;
                const bool surface = shapes_pixel(&sunlit_box, &plain, i % WIDE, i / WIDE, position, normal);
                for (int k = 0; k < 3; k++) cosine += surface ? normal[k] * sun.direction[k] : 0;
                const double mask = masks[m] ? (double)masks[m](&plain, i % WIDE, i / WIDE) : 1;
                const double gone = shade ? fmax(mask - (double)shadow[i], 0) * fmax(cosine, 0) / M_PI * 0.5 : 0;
                darker += gone > 0.01;
                for (uint32_t k = 0; k < 3; k++)
                    assert_true(fabs((double)composed[4 * i + k] - fmax((double)lit[3 * i + k] - gone, 0)) < 1e-5);
            }
            print_message("# mask %d, %s: %d pixels are darker\n", m, words[2], darker);
            assert_true(shade && m < 2 ? darker > 30 : darker == 0);
            free(shadow), free(composed), free(lit);
        }
}

/* ---- plans ---- */

/* The plan changes no bit, also where the mask says that no ray is needed. */
static void planned_is_all(void **state) {
    static float (*const masks[])(const struct plain *, uint32_t, uint32_t) = {NULL, dark_left, dark_everywhere,
                                                                               invalid_mask};
    static const char *const words[] = {"contact_trace=hiz",    "hiz=nearest",  "downsample=pick",
                                        "contact_apply=planes", "compose=brdf", NULL};
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(35, 30);
    for (int m = 0; m < 4; m++) {
        struct plain plain = sunlit_frame(&sunlit_box, &sun);
        float *found[2], *composed[2];
        plain.sun_mask = masks[m];
        occlusion_load(gpu, &plain);
        for (int all = 0; all < 2; all++) {
            sunlit_arrange(gpu, words);
            gpu->all = all;
            gpu_run(gpu);
            found[all] = gpu_floats(gpu, "sun_shadow", NULL, NULL);
            composed[all] = gpu_floats(gpu, "composed", NULL, NULL);
        }
        gpu->all = false;
        assert_memory_equal(found[0], found[1], WIDE * HIGH * sizeof(float));
        assert_memory_equal(composed[0], composed[1], WIDE * HIGH * 4 * sizeof(float));
        for (uint32_t i = 0; i < WIDE * HIGH; i++) assert_true(found[0][i] >= 0 && found[0][i] <= 1);
        free(found[0]), free(found[1]), free(composed[0]), free(composed[1]);
    }
}

/* ---- what is not a surface, and no sun ---- */

static void invalid_pixels_are_lit_and_spoil_no_others(void **state) {
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(35, 20);
    struct plain plain = sunlit_frame(&sunlit_box, &sun);
    plain.spoil = shapes_spoil_some;
    occlusion_load(gpu, &plain);
    for (int v = 0; v < VARIANTS; v++)
        for (int half = 0; half < 2; half++) {
            const char *const words[] = {variants[v], half ? "downsample=pick" : "downsample=none",
                                         "contact_apply=planes", "hiz=nearest", NULL};
            float *found = sunlit_run(gpu, words);
            for (uint32_t i = 0; i < WIDE * HIGH; i++) {
                assert_true(found[i] >= 0 && found[i] <= 1);
                if (i % 7 == 0 || i % 11 == 0 || i % 13 == 0 || i % 17 == 0) assert_true(found[i] == 1);
            }
            free(found);
        }
}

static void without_a_sun_there_is_no_shadow(void **state) {
    static const char *const words[] = {"contact_trace=linear", NULL};
    struct gpu *gpu = *state;
    const struct plain plain = occlusion_frame(&sunlit_box, 60);
    occlusion_load(gpu, &plain);
    sunlit_arrange(gpu, words);
    gpu->all = true;
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "sun_shadow", NULL, NULL);
    for (uint32_t i = 0; i < WIDE * HIGH; i++) assert_true(found[i] == 1);
    gpu->all = false;
    free(found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shadow_is_as_long_as_the_sun_is_low),
        cmocka_unit_test(the_sun_may_stand_anywhere),
        cmocka_unit_test(an_open_plain_is_lit),
        cmocka_unit_test(a_sun_below_the_horizon_lights_nothing),
        cmocka_unit_test(the_mask_and_the_contact_shadow_meet_in_their_minimum),
        cmocka_unit_test(skipped_rays_would_have_changed_nothing),
        cmocka_unit_test(hits_fade_at_the_end_and_at_the_border),
        cmocka_unit_test(a_wide_sun_has_a_penumbra),
        cmocka_unit_test(the_picture_loses_the_suns_light),
        cmocka_unit_test(planned_is_all),
        cmocka_unit_test(invalid_pixels_are_lit_and_spoil_no_others),
        cmocka_unit_test(without_a_sun_there_is_no_shadow),
    };
    return cmocka_run_group_tests_name("gpu_shadow", tests, gpu_set_up, gpu_tear_down);
}
