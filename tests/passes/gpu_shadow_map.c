/* shadow_mask made from a shadow map, against the shapes that cast the shadow and against the map itself. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sunlit.h"
#include "unit.h"

/* An orthographic map, 6 m wide and 8 m deep, about a point under the box. */
static const double map_middle[3] = {0, -1, -4}, map_reach = 3, map_depth = 8;
static void map_axes(const double sun[3], double right[3], double up[3]) {
    const double flat = hypot(sun[0], sun[2]);
    right[0] = -sun[2] / flat, right[1] = 0, right[2] = sun[0] / flat;
    up[0] = sun[1] * right[2] - sun[2] * right[1];
    up[1] = sun[2] * right[0] - sun[0] * right[2];
    up[2] = sun[0] * right[1] - sun[1] * right[0];
}
static float map_at(const struct plain *plain, double u, double v) {
    const double *sun = plain->sun->direction;
    double right[3], up[3], from[3], towards[3], normal[3];
    map_axes(sun, right, up);
    for (int k = 0; k < 3; k++) {
        towards[k] = -sun[k];
        from[k] = map_middle[k] + map_reach * ((2 * u - 1) * right[k] + (1 - 2 * v) * up[k]) + 0.5 * map_depth * sun[k];
    }
    const double depth = fmin(shapes_hit(plain->user, from, towards, normal) / map_depth, 1);
    return (float)(plain->shadow.range[0] > plain->shadow.range[1] ? 1 - depth : depth);
}
static struct glint_shadow map_of(const struct glint_sun *sun, bool reversed) {
    struct glint_shadow shadow = {.range = {reversed, !reversed}, .bias = 0.005};
    double axes[3][3];
    map_axes(sun->direction, axes[0], axes[1]);
    memcpy(axes[2], sun->direction, sizeof axes[2]);
    for (int r = 0; r < 3; r++) {
        const double scale = r < 2 ? 1 / map_reach : (reversed ? 1 : -1) / map_depth;
        shadow.world_to_shadow[4 * r + 3] = r < 2 ? 0 : 0.5;
        for (int c = 0; c < 3; c++) {
            shadow.world_to_shadow[4 * r + c] = scale * axes[r][c];
            shadow.world_to_shadow[4 * r + 3] -= scale * axes[r][c] * map_middle[c];
        }
    }
    shadow.world_to_shadow[15] = 1;
    return shadow;
}

/* What the texel that holds a point has to say of it; NAN: within rounding of a decision. */
static double by_texel(const struct plain *plain, const double at[3], const double normal[3]) {
    enum { MAP = 256 };
    const double *sun = plain->sun->direction;
    double axes[2][3], place[2], deep = 0.5;
    map_axes(sun, axes[0], axes[1]);
    for (int a = 0; a < 2; a++) {
        place[a] = 0.5;
        for (int k = 0; k < 3; k++) {
            const double from_middle = at[k] + 2 * map_reach / MAP * normal[k] - map_middle[k];
            place[a] += (a ? -1 : 1) * axes[a][k] * from_middle / (2 * map_reach);
            if (a == 0) deep -= sun[k] * from_middle / map_depth;
        }
        place[a] *= MAP;
        if (fabs(place[a] - round(place[a])) < 1e-2) return NAN;
        if (place[a] < 0 || place[a] > MAP) return 1;
    }
    const double stored = (double)map_at(plain, (floor(place[0]) + 0.5) / MAP, (floor(place[1]) + 0.5) / MAP);
    const double behind =
        deep - (plain->shadow.range[0] > plain->shadow.range[1] ? 1 - stored : stored) - plain->shadow.bias;
    return fabs(behind) < 1e-4 ? (double)NAN : behind > 0 ? 0 : 1;
}

static void a_shadow_map_makes_the_mask(void **state) {
    static const char *const words[] = {"shadow_mask=map", "shadow_mask.taps=1", "contact_trace=dda",
                                        "contact_trace.length_m=0", NULL};
    struct gpu *gpu = *state;
    int dark = 0;
    for (int reversed = 0; reversed < 2; reversed++)
        for (int azimuth = 0; azimuth < 360; azimuth += 100) {
            const struct glint_sun sun = sunlit_sun(40, azimuth);
            struct plain plain = sunlit_frame(&sunlit_box, &sun);
            plain.shadow = map_of(&sun, reversed);
            plain.shadow_map = map_at;
            occlusion_load(gpu, &plain);
            float *found = sunlit_run(gpu, words);
            const struct sunlit_counts c = sunlit_errors(&plain, found, INFINITY);
            print_message("# %d degrees: of %d dark %d missed, of %d lit %d dark\n", azimuth, c.dark, c.missed,
                          c.pixels - c.dark, c.false_dark);
            dark += c.dark;
            assert_true(c.missed + c.false_dark <= 0.004 * c.pixels); /* texels of 23 mm, and the bias of 40 mm */
            free(found);
            /* Pixel by pixel: a map that is read half a texel beside shows another edge. */
            float *mask = gpu_floats(gpu, "shadow_mask", NULL, NULL);
            for (uint32_t i = 0; i < WIDE * HIGH; i++) {
                double position[3], normal[3];
                if (!shapes_pixel(&sunlit_box, &plain, i % WIDE, i / WIDE, position, normal)) continue;
                const double right = by_texel(&plain, position, normal);
                if (!isnan(right) && (double)mask[i] != right)
                    fail_msg("%d degrees, pixel %u,%u: %g by the map, expected %g", azimuth, i % WIDE, i / WIDE,
                             (double)mask[i], right);
            }
            free(mask);
        }
    assert_true(dark > 1500);
}

/* A mask of the capture is the frame's own, whatever the map says. */
static float striped(UNUSED const struct plain *plain, uint32_t x, UNUSED uint32_t y) {
    return (float)(x % 5) / 4;
}
static void a_captured_mask_comes_before_the_map(void **state) {
    static const char *const words[] = {"shadow_mask=map", "contact_trace=dda", "contact_trace.length_m=0", NULL};
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(40, 0);
    struct plain plain = sunlit_frame(&sunlit_box, &sun);
    plain.shadow = map_of(&sun, false);
    plain.shadow_map = map_at;
    plain.sun_mask = striped;
    occlusion_load(gpu, &plain);
    free(sunlit_run(gpu, words));
    float *mask = gpu_floats(gpu, "shadow_mask", NULL, NULL);
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        double position[3], normal[3];
        if (shapes_pixel(&sunlit_box, &plain, i % WIDE, i / WIDE, position, normal))
            assert_true(mask[i] == striped(&plain, i % WIDE, 0));
    }
    free(mask);
}

/* ---- Cascades ---- */

/* Map k is half as wide in texels as the one before. Its
   depths tell of no scene, but of the map and the texel. Map 1 is of the class foreground alone, which is the right half of the picture. */
enum { OF_CLASS = 1, MAPS = 4 };
static const double reaches[MAPS] = {0.5, 2, 1.5, 4.5};
static float by_pattern(uint32_t number, double u, double v) {
    const uint32_t wide = 256 >> number, x = (uint32_t)(u * wide), y = (uint32_t)(v * wide);
    return ((x ^ y) + x * y + number) % 3 ? 1 : 0;
}
static float first_pattern(UNUSED const struct plain *plain, double u, double v) {
    return by_pattern(0, u, v);
}
static float other_pattern(UNUSED const struct plain *plain, uint32_t number, double u, double v) {
    return by_pattern(number, u, v);
}
static struct glint_shadow cascade_of(const struct glint_sun *sun, double reach) {
    struct glint_shadow shadow = map_of(sun, false);
    for (int i = 0; i < 8; i++) shadow.world_to_shadow[i] *= map_reach / reach;
    return shadow;
}

/* What the square of texels about a point says, of the first map of the class, or of all surfaces, that holds it, 1 if none does; NAN: within rounding of another texel
   or map. */
static double by_maps(const struct glint_sun *sun, const double at[3], bool of_class) {
    static const int taps[MAPS] = {3, 3, 2, 2};
    double axes[2][3];
    map_axes(sun->direction, axes[0], axes[1]);
    for (uint32_t k = 0; k < MAPS; k++) {
        if (of_class != (k == OF_CLASS)) continue;
        const int wide = 256 >> k;
        double place[2], lit = 0;
        bool inside = true;
        for (int a = 0; a < 2; a++) {
            place[a] = 0.5;
            for (int c = 0; c < 3; c++)
                place[a] += (a ? -1 : 1) * axes[a][c] * (at[c] - map_middle[c]) / (2 * reaches[k]);
            const double first = place[a] * wide - 0.5 * (taps[k] - 1);
            if (fabs(first - round(first)) < 1e-2 || fabs(place[a] - round(place[a])) < 1e-4) return NAN;
            inside = inside && place[a] > 0 && place[a] < 1;
            place[a] = floor(first);
        }
        if (!inside) continue;
        for (int i = 0; i < taps[k] * taps[k]; i++) {
            const double x = fmin(fmax(place[0] + i % taps[k], 0), wide - 1),
                         y = fmin(fmax(place[1] + i / taps[k], 0), wide - 1);
            lit += (double)by_pattern(k, (x + 0.5) / wide, (y + 0.5) / wide);
        }
        return lit / (taps[k] * taps[k]);
    }
    return 1;
}

/* The floor and the wall are seen in all three maps, and beyond them. */
static void each_surface_is_compared_with_the_finest_map_that_holds_it(void **state) {
    static const char *const words[] = {"shadow_mask=map",
                                        "shadow_mask.taps=3",
                                        "shadow_mask.far_taps=2",
                                        "shadow_mask.offset=0",
                                        "contact_trace=dda",
                                        "contact_trace.length_m=0",
                                        NULL};
    struct gpu *gpu = *state;
    const struct glint_sun sun = sunlit_sun(50, 100);
    struct glint_shadow others[] = {cascade_of(&sun, reaches[1]), cascade_of(&sun, reaches[2]),
                                    cascade_of(&sun, reaches[3])};
    others[OF_CLASS - 1].has_stencil_class = true;
    struct plain plain = sunlit_frame(&sunlit_box, &sun);
    plain.shadow = cascade_of(&sun, reaches[0]);
    plain.shadow_map = first_pattern;
    plain.cascade = other_pattern;
    plain.cascades = others;
    plain.cascade_count = MAPS - 1;
    plain.foreground = true;
    occlusion_load(gpu, &plain);
    free(sunlit_run(gpu, words));
    float *mask = gpu_floats(gpu, "shadow_mask", NULL, NULL);
    size_t compared = 0, darker = 0, values[3] = {0}; /* dark, between, lit */
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        double position[3], normal[3];
        if (!shapes_pixel(&sunlit_box, &plain, i % WIDE, i / WIDE, position, normal)) continue;
        double right = by_maps(&sun, position, false);
        const double of_class = by_maps(&sun, position, true);
        if (isnan(right) || isnan(of_class)) continue;
        darker += i % WIDE >= WIDE / 2 && of_class < right;
        if (i % WIDE >= WIDE / 2) right = fmin(right, of_class);
        if (fabs((double)mask[i] - right) > 1e-3) /* a half holds multiples of 1/9 to 2^-12 */
            fail_msg("pixel %u,%u: %g, expected %g", i % WIDE, i / WIDE, (double)mask[i], right);
        compared++;
        values[right == 0 ? 0 : right < 1 ? 1 : 2]++;
    }
    print_message("# %zu compared: %zu dark, %zu between, %zu lit\n", compared, values[0], values[1], values[2]);
    assert_true(compared > 4000 && darker > 500 && values[1] > 500 && values[2] > 100);
    free(mask);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shadow_map_makes_the_mask),
        cmocka_unit_test(each_surface_is_compared_with_the_finest_map_that_holds_it),
        cmocka_unit_test(a_captured_mask_comes_before_the_map),
    };
    return cmocka_run_group_tests_name("gpu_shadow_map", tests, gpu_set_up, gpu_tear_down);
}
