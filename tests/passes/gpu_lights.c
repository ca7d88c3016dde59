/* light and light_mask on a floor and a box, against closed forms and in double precision. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "occlusion.h"
#include "unit.h"

enum { WIDE = 160, HIGH = 120, PIXELS = WIDE * HIGH, MAP = 256 };
static const double FLOOR = -1, ALBEDO = 0.5;
static const struct shapes bare = {.floor_y = -1}, boxed = {.floor_y = -1, .box = {-0.5, -0.7, -4.6, 0.6, -0.4, -3.4}};
static const float white[3] = {1, 2, 4};

static struct glint_light lamp_at(double x, double y, double z, double range) {
    return (struct glint_light){.position = {x, y, z}, .intensity = {white[0], white[1], white[2]}, .range = range};
}
static struct glint_light spot_at(double x, double y, double z, double range, double inner, double outer) {
    struct glint_light light = lamp_at(x, y, z, range);
    light.has_cone = true;
    light.cone = (struct glint_cone){.axis = {0.6 * 0.6, -0.8, -0.6 * 0.8}, .inner_rad = inner, .outer_rad = outer};
    return light;
}
static struct plain frame_with(const struct shapes *shapes, const struct glint_light *lights, uint32_t count) {
    struct plain plain = occlusion_frame(shapes, 60);
    plain.lights = lights;
    plain.light_count = count;
    return plain;
}
static float *run(struct gpu *gpu, const struct plain *plain, const char *const *more) {
    const char *words[12] = {"light_mask=stencil", "light=lambert"};
    size_t n = 2;
    for (; more && *more; more++) words[n++] = *more;
    occlusion_load(gpu, plain);
    occlusion_arrange(gpu, words);
    gpu_run(gpu);
    return gpu_floats(gpu, "light", NULL, NULL);
}

/* ---- In double precision ---- */

enum { SQUARED, FOURTH, CUT, SMOOTH = SQUARED };
static double fade_of_range(int law, double part) {
    if (part >= 1) return 0;
    return law == SQUARED ? pow(1 - part, 2) : law == FOURTH ? pow(1 - part * part, 2) : 1;
}
/* law: smooth, squared, cut */
static double fade_of_cone(int law, const struct glint_light *light, double cosine) {
    const double outer = cos(light->cone.outer_rad), inner = cos(light->cone.inner_rad);
    if (cosine <= outer) return 0;
    const double x = fmin((cosine - outer) / (inner - outer), 1);
    return law == SMOOTH ? x * x * (3 - 2 * x) : law == FOURTH ? x * x : 1;
}
/* What a surface sends back of the light by an intensity of 1, for an albedo of ALBEDO; *edge: how near the place is to where light ends, as a part. */
static double radiance(const struct glint_light *light, const double at[3], const double normal[3], int range_law,
                       int cone_law, double *edge) {
    double way[3], square = 0, cosine = 0, axial = 0;
    for (int k = 0; k < 3; k++) {
        way[k] = light->position[k] - at[k];
        square += way[k] * way[k];
        cosine += way[k] * normal[k];
        axial -= way[k] * light->cone.axis[k];
    }
    const double distance = sqrt(square);
    double factor = fmax(cosine / distance, 0) / fmax(square, light->radius * light->radius) * ALBEDO / M_PI;
    *edge = 1;
    if (light->range > 0) {
        const double part = square / (light->range * light->range);
        factor *= fade_of_range(range_law, part);
        *edge = fabs(part - 1);
    }
    if (light->has_cone) {
        *edge = fmin(*edge, fabs(axial / distance - cos(light->cone.outer_rad)));
        factor *= fade_of_cone(cone_law, light, axial / distance);
    }
    return factor;
}

/* Rounding of a place p in floats is a few 2^-24 |p|. Distances and the height over the surface have it as a part of themselves, and the factor is
   their third power at most; fades have the slope 2 or less in `part`, and a cone's 1.5 over the difference of its cosines, on light of `most`. */
static double rounding(const struct glint_light *light, const double at[3], double right, double most) {
    const double p = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]), h = light->position[1] - at[1];
    double way = 0;
    for (int k = 0; k < 3; k++) way += pow(light->position[k] - at[k], 2);
    const double of_place = ldexp(1 + 3 * p / sqrt(way) + p / fabs(h), -21);
    const double cone = light->has_cone ? cos(light->cone.inner_rad) - cos(light->cone.outer_rad) : 1;
    return of_place * (right + (2 + 1.5 / cone) * most);
}

static void compare(const struct plain *plain, const float *found, int range_law, int cone_law, const char *what,
                    double *share) {
    double worst = 0;
    size_t dark = 0, lit = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        double at[3], normal[3], sum = 0, bound = 0, nearest = 1;
        if (!shapes_pixel(plain->user, plain, i % WIDE, i / WIDE, at, normal)) {
            assert_true(found[4 * i] == 0);
            continue;
        }
        for (uint32_t k = 0; k < plain->light_count; k++) {
            struct glint_light endless = plain->lights[k];
            endless.range = 0, endless.has_cone = false;
            double edge, unused;
            const double right = radiance(&plain->lights[k], at, normal, range_law, cone_law, &edge);
            const bool fades = plain->lights[k].range > 0 || plain->lights[k].has_cone;
            sum += right;
            bound += rounding(&plain->lights[k], at, right, fades ? radiance(&endless, at, normal, 0, 0, &unused) : 0);
            nearest = fmin(nearest, edge);
        }
        if (nearest < 1e-4) continue;
        for (uint32_t c = 0; c < 3; c++) {
            const double off = fabs((double)found[4 * i + c] - (double)white[c] * sum);
            if (!(off <= (double)white[c] * bound) || (sum == 0 && found[4 * i + c] != 0))
                fail_msg("%s, pixel %u,%u channel %u: %.9g, expected %.9g within %g", what, i % WIDE, i / WIDE, c,
                         (double)found[4 * i + c], (double)white[c] * sum, (double)white[c] * bound);
            if (sum > 0) worst = fmax(worst, off / ((double)white[c] * bound));
        }
        *(sum > 0 ? &lit : &dark) += 1;
    }
    print_message("# %s: %zu pixels lit, %zu dark, worst error %.2f of the bound\n", what, lit, dark, worst);
    assert_true(lit > 500);
    *share = (double)dark / (double)(lit + dark);
}

/* E = I h / (h² + r²)^(3/2), which is what radiance() is for a lamp without an end. */
static void a_lamp_over_a_floor(void **state) {
    struct gpu *gpu = *state;
    const struct glint_light lamp = lamp_at(0.4, 0.8, -4, 0);
    const struct plain plain = frame_with(&bare, &lamp, 1);
    double dark;
    float *full = run(gpu, &plain, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        double at[3], normal[3], unused;
        if (!shapes_pixel(&bare, &plain, i % WIDE, i / WIDE, at, normal)) continue;
        const double h = 0.8 - FLOOR, r2 = pow(at[0] - 0.4, 2) + pow(at[2] + 4, 2);
        const double right = ALBEDO / M_PI * h / pow(h * h + r2, 1.5);
        assert_true(fabs(radiance(&lamp, at, normal, 0, 0, &unused) / right - 1) < 1e-9);
    }
    compare(&plain, full, SQUARED, SMOOTH, "a lamp over a floor", &dark);
    assert_true(dark == 0);
    /* In halves an image has the same values, rounded: by 2^-10 if towards zero, and albedo and normal are halves. */
    gpu->float_precision = false;
    gpu_run(gpu);
    float *half = gpu_floats(gpu, "light", NULL, NULL);
    for (uint32_t i = 0; i < 4 * PIXELS; i++)
        assert_true(fabs((double)half[i] - (double)full[i]) <= ldexp((double)full[i], -10) + ldexp(1, -24));
    free(full);
    free(half);
}

static void light_fades_out_by_each_law(void **state) {
    static const char *const laws[3][3] = {{"light.range_law=squared", "light.cone_law=smooth", NULL},
                                           {"light.range_law=fourth", "light.cone_law=squared", NULL},
                                           {"light.range_law=cut", "light.cone_law=cut", NULL}};
    struct gpu *gpu = *state;
    const struct glint_light lamps[] = {lamp_at(0.4, 0.8, -4, 3), spot_at(-0.3, 1, -2.5, 0, 0.3, 0.5),
                                        spot_at(-0.3, 1, -2.5, 4, 0.6, 1.7)};
    for (int law = 0; law < 3; law++)
        for (int k = 0; k < 3; k++) {
            static const char *const names[] = {"a range", "a cone", "a wide cone with a range"};
            const struct plain plain = frame_with(&bare, &lamps[k], 1);
            double dark;
            float *found = run(gpu, &plain, laws[law]);
            compare(&plain, found, law, law, names[k], &dark);
            assert_true(dark > 0.05);
            free(found);
        }
}

static void switched_off_light_has_no_end(void **state) {
    static const char *const off[2][2] = {{"light.range=false", NULL}, {"light.cones=false", NULL}};
    struct gpu *gpu = *state;
    for (int k = 0; k < 2; k++) {
        const struct glint_light lamp = spot_at(-0.3, 1, -2.5, 4, 0.3, 0.5);
        struct glint_light expected = lamp;
        if (k) expected.has_cone = false;
        else expected.range = 0;
        const struct plain plain = frame_with(&bare, &lamp, 1), other = frame_with(&bare, &expected, 1);
        double dark;
        float *found = run(gpu, &plain, off[k]);
        compare(&other, found, SQUARED, SMOOTH, k ? "no cone" : "no range", &dark);
        free(found);
    }
}

/* Each adds its own, whatever their order is, and 64 of them do; the sum of 64 floats has 63 roundings. */
static void lights_add_up(void **state) {
    struct gpu *gpu = *state;
    static struct glint_light lamps[64];
    for (int i = 0; i < 64; i++)
        lamps[i] = i % 3 ? lamp_at(-2 + i % 8 * 0.55, -0.7 + i / 8 * 0.1, -2 - i / 8 * 0.6, i % 5 ? 1.5 : 0)
                         : spot_at(-2 + i % 8 * 0.55, -0.2, -2 - i / 8 * 0.6, 2, 0.3, 0.8);
    for (int n = 0; n < 2; n++) {
        const struct plain plain = frame_with(&bare, lamps, n ? 64 : 2);
        double dark;
        float *found = run(gpu, &plain, NULL);
        compare(&plain, found, SQUARED, SMOOTH, n ? "64 lamps" : "two lamps", &dark);
        free(found);
    }
}

/* A surface inside of a lamp is as bright as on its rim; the diffuse albedo is albedo × (1 - metalness). */
static void half_metal(const struct plain *plain, float *values) {
    shapes_spoil_some(plain, values);
    for (uint32_t i = 0; i < PIXELS; i++) values[PLAIN_METALNESS * PIXELS + i] = 0.25F;
}
static void radius_metalness_and_invalid_surfaces(void **state) {
    struct gpu *gpu = *state;
    struct glint_light lamp = lamp_at(0.1, -0.9, -3, 0);
    lamp.radius = 0.7;
    struct plain plain = frame_with(&bare, &lamp, 1);
    plain.spoil = half_metal;
    float *found = run(gpu, &plain, NULL);
    size_t inside = 0, invalid = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        double at[3], normal[3], unused;
        const bool hit = shapes_pixel(&bare, &plain, i % WIDE, i / WIDE, at, normal);
        const bool none = i % 7 == 0 || i % 11 == 0 || i % 13 == 0 || i % 17 == 0;
        const double right = hit && !none ? 0.75 * radiance(&lamp, at, normal, 0, 0, &unused) : 0;
        inside += hit && pow(at[0] - 0.1, 2) + pow(at[2] + 3, 2) < 0.4;
        invalid += hit && none;
        if (none || !hit) assert_true(found[4 * i] == 0);
        else if (!(fabs((double)found[4 * i] - right) <= rounding(&lamp, at, right, 0)))
            fail_msg("pixel %u,%u: %g, expected %g", i % WIDE, i / WIDE, (double)found[4 * i], right);
    }
    assert_true(inside > 300 && invalid > 1000);
    free(found);
}

/* ---- Shadows ---- */

/* A perspective from the lamp straight down, as wide as high: x to the right, y towards -z, depth in [0, 1] from 0.1 to 4 m. */
static const double from[3] = {0.3, 1.2, -3.6}, map_near = 0.1, map_far = 4, map_tangent = 0.7;
static double map_depth(double along_m) {
    return map_far / (map_far - map_near) * (1 - map_near / along_m);
}
static float lamp_map(const struct plain *plain, double u, double v) {
    const double direction[3] = {map_tangent * (2 * u - 1), -1, -map_tangent * (1 - 2 * v)};
    double normal[3];
    return (float)fmin(map_depth(shapes_hit(plain->user, from, direction, normal)), 1);
}
static struct glint_shadow map_of_lamp(uint32_t light) {
    const double k = map_far / (map_far - map_near), t = 1 / map_tangent;
    return (struct glint_shadow){.world_to_shadow = {t, 0, 0, -t * from[0], 0, 0, -t, t * from[2], 0, -k, 0,
                                                     k * from[1] - k * map_near, 0, -1, 0, from[1]},
                                 .range = {0, 1},
                                 .bias = 1e-4,
                                 .has_light = true,
                                 .light = light};
}
/* Whether anything hides the lamp; NAN: about a texel of the map farther something else does. */
static double hidden(const struct shapes *shapes, const double at[3], const double normal[3]) {
    double found[5];
    for (int s = 0; s < 5; s++) {
        double start[3], way[3], unused[3];
        for (int k = 0; k < 3; k++) start[k] = at[k] + 1e-6 * normal[k];
        const double side = 2 * map_tangent * 2.2 / MAP;
        if (normal[1] > 0.5 && s) start[s < 3 ? 0 : 2] += (s % 2 ? 1 : -1) * 1.5 * side;
        for (int k = 0; k < 3; k++) way[k] = from[k] - start[k];
        found[s] = shapes_hit(shapes, start, way, unused) < 1;
        if (found[s] != found[0]) return NAN;
    }
    return found[0];
}

/* A third lamp, of no light, has a map in which all it holds is in shadow, and that holds all that is seen. */
static float all_dark(UNUSED const struct plain *plain, UNUSED uint32_t number, UNUSED double u, UNUSED double v) {
    return 0;
}
static void the_maps_of_a_lamp_shade_its_light_alone(void **state) {
    static const struct glint_shadow of_all = {
        .world_to_shadow = {1e-3, 0, 0, 0, 0, 0, 1e-3, 0, 0, 1e-3, 0, 0.5, 0, 0, 0, 1},
        .range = {0, 1},
        .has_light = true,
        .light = 2};
    static const char *const words[][2] = {{"light.shadows=true", NULL}, {"light.shadows=false", NULL}};
    struct gpu *gpu = *state;
    /* the map is the second lamp's; the first one, nearer to the camera, covers more of the screen */
    const struct glint_light lamps[] = {
        lamp_at(0, 0.5, -2, 0), lamp_at(from[0], from[1], from[2], 3.5), {.position = {0, 0, -3}, .range = 0.5}};
    struct plain plain = frame_with(&boxed, lamps, 3);
    plain.shadow_map = lamp_map;
    plain.shadow = map_of_lamp(1);
    plain.cascade = all_dark;
    plain.cascades = &of_all;
    plain.cascade_count = 1;
    for (int off = 0; off < 2; off++) {
        float *found = run(gpu, &plain, words[off]);
        size_t dark = 0, lit = 0, beside = 0;
        for (uint32_t i = 0; i < PIXELS; i++) {
            double at[3], normal[3], edge, way[3];
            if (!shapes_pixel(&boxed, &plain, i % WIDE, i / WIDE, at, normal) || normal[1] < 0.5) continue;
            for (int k = 0; k < 3; k++) way[k] = at[k] - from[k];
            const double place = fmax(fabs(way[0]), fabs(way[2])) / -way[1] / map_tangent;
            const double in_map = fabs(place - 1) < 0.02 ? NAN : place < 1 ? hidden(&boxed, at, normal) : 0;
            if (isnan(in_map)) continue;
            const double own = radiance(&lamps[0], at, normal, SQUARED, SMOOTH, &edge),
                         other = radiance(&lamps[1], at, normal, SQUARED, SMOOTH, &edge);
            const double right = own + (off ? 1 : 1 - in_map) * other;
            const double bound = rounding(&lamps[0], at, own, 0) + rounding(&lamps[1], at, other, other);
            if (!(fabs((double)found[4 * i] - right) <= bound))
                fail_msg("pixel %u,%u: %g, expected %g within %g", i % WIDE, i / WIDE, (double)found[4 * i], right,
                         bound);
            *(place > 1 ? &beside : in_map > 0 ? &dark : &lit) += 1;
        }
        print_message("# %zu pixels shaded, %zu lit, %zu beside the map\n", dark, lit, beside);
        assert_true(dark > 300 && lit > 2000 && beside > 1000);
        free(found);
    }
}

/* Maps of the sun are not compared for lamps, and those of lamps not for the sun, whatever their numbers are. */
static float squares(UNUSED const struct plain *plain, double u, double v) {
    return ((int)(16 * u) + (int)(16 * v)) % 2 ? 1.0F : 0.0F;
}
static float map_of_either(const struct plain *plain, UNUSED uint32_t number, double u, double v) {
    return plain->cascades[0].has_light ? lamp_map(plain, u, v) : squares(plain, u, v);
}
static void sun_and_lamps_have_maps_of_their_own(void **state) {
    static const struct glint_sun above = {.direction = {0, 1, 0}, .irradiance = {1, 1, 1}};
    static const struct glint_shadow of_sun = {
        .world_to_shadow = {1 / 4.0, 0, 0, 0, 0, 0, -1 / 4.0, -1, 0, -1 / 4.0, 0, 0.5, 0, 0, 0, 1}, .range = {0, 1}};
    static const char *const words[] = {"shadow_mask=map", "contact_trace=dda", "contact_apply=planes",
                                        "contact_trace.length_m=0", NULL};
    struct gpu *gpu = *state;
    const struct glint_light lamp = lamp_at(from[0], from[1], from[2], 3.5);
    const struct glint_shadow of_lamp = map_of_lamp(0);
    float *light[4], *mask[4];
    for (int kind = 0; kind < 4; kind++) { /* 000 and 001: sun; sun, lamp; lamp, sun; lamp */
        struct plain plain = frame_with(&boxed, &lamp, 1);
        plain.sun = &above;
        plain.shadow_map = kind < 2 ? squares : lamp_map;
        plain.shadow = kind < 2 ? of_sun : of_lamp;
        plain.cascade = map_of_either;
        plain.cascades = kind == 1 ? &of_lamp : &of_sun;
        plain.cascade_count = kind == 1 || kind == 2;
        light[kind] = run(gpu, &plain, words);
        mask[kind] = gpu_floats(gpu, "shadow_mask", NULL, NULL);
    }
    /* A map of 128 texels has the same squares as one of 256. */
    size_t dark = 0, shaded = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        dark += mask[0][i] == 0, shaded += light[1][4 * i] < light[0][4 * i];
        assert_true(mask[3][i] == 1 && light[2][4 * i] == light[3][4 * i]);
    }
    assert_memory_equal(mask[0], mask[1], PIXELS * sizeof *mask[0]);
    assert_memory_equal(mask[0], mask[2], PIXELS * sizeof *mask[0]);
    assert_true(dark > 1000 && shaded > 300);
    for (int kind = 0; kind < 4; kind++) free(light[kind]), free(mask[kind]);
}

/* ---- Masks and rectangles ---- */

/* Bit k is of the lamp that covers the k-th most of the screen: 1 where the place lies in the range and the cone. */
static void bits_say_what_a_light_reaches(void **state) {
    static const char *const words[] = {"light_mask.share=0", NULL};
    struct gpu *gpu = *state;
    const struct glint_light lamps[] = {lamp_at(-0.9, -0.8, -3, 0.5), spot_at(-0.3, 1, -2.5, 4, 0.3, 0.5),
                                        lamp_at(0.4, 0.8, -4, 3)};
    static const int order[] = {2, 1, 0};
    const struct plain plain = frame_with(&bare, lamps, 3);
    free(run(gpu, &plain, words));
    uint32_t *mask = gpu_uints(gpu, "light_mask", NULL, NULL);
    size_t ones[3] = {0};
    for (uint32_t i = 0; i < PIXELS; i++) {
        double at[3], normal[3] = {0, 1, 0};
        const bool hit = shapes_pixel(&bare, &plain, i % WIDE, i / WIDE, at, normal);
        for (int k = 0; k < 3; k++) {
            double edge = 1;
            const bool right = hit && radiance(&lamps[order[k]], at, normal, CUT, CUT, &edge) > 0;
            if (edge > 1e-4 && (mask[i] >> k & 1) != right)
                fail_msg("pixel %u,%u, bit %d: expected %d", i % WIDE, i / WIDE, k, right);
            ones[k] += right;
        }
    }
    free(mask);
    assert_true(ones[0] > 1000 && ones[1] > 500 && ones[2] > 100);
    /* The rectangle of the smallest covers 7 % of the screen, the others more: it has no mask then. */
    static const char *const large[] = {"light_mask.share=0.1", NULL};
    free(run(gpu, &plain, large));
    mask = gpu_uints(gpu, "light_mask", NULL, NULL);
    size_t zeros[3] = {0};
    for (uint32_t i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) zeros[k] += !(mask[i] >> k & 1);
    assert_true(zeros[0] > 1000 && zeros[1] > 1000 && zeros[2] == 0);
    free(mask);
}

/* ---- Plans and the picture ---- */

static float lamps_lit[3][PIXELS];
static struct glint_channel lamps_channels[] = {{.name = "R", .type = GLINT_F32, .data = lamps_lit[0]},
                                                {.name = "G", .type = GLINT_F32, .data = lamps_lit[1]},
                                                {.name = "B", .type = GLINT_F32, .data = lamps_lit[2]}};
static const struct glint_part lamps_part = {
    .name = "lamps", .width = WIDE, .height = HIGH, .channels = lamps_channels, .channel_count = 3};
static float *picture_of(struct gpu *gpu, const struct plain *plain, const char *word, bool all) {
    static const char *const others[] = {
        "screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    occlusion_load(gpu, plain);
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu->all = all;
    gpu_without(gpu, others);
    gpu_use(gpu, "light_mask=stencil");
    gpu_use(gpu, "light=lambert");
    if (word) gpu_set(gpu, word);
    gpu_run(gpu);
    gpu->all = false;
    return gpu_floats(gpu, "composed", NULL, NULL);
}
static void matt(const struct plain *plain, float *values) {
    shapes_spoil(plain, values);
    for (uint32_t i = 0; i < PIXELS; i++) {
        values[PLAIN_SPECULAR * PIXELS + i] = 0;
        for (uint32_t c = 0; c < 3; c++) values[(PLAIN_LIT_R + c) * PIXELS + i] = (float)(1 + c) / 4;
    }
}

static void a_light_out_of_reach_leaves_the_passes_out(void **state) {
    struct gpu *gpu = *state;
    const struct glint_light lamp = lamp_at(0, 0.5, -4, 1.25), near_lamp = lamp_at(0, 0.5, -4, 1.75);
    /* too far; no lamp; near enough; too far, but it has no end, or the engine had it reach the surfaces */
    for (int kind = 0; kind < 5; kind++) {
        for (uint32_t i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++) lamps_lit[c][i] = kind == 4 ? 0.125F : 0;
        struct plain plain = frame_with(&bare, kind == 2 ? &near_lamp : &lamp, kind != 1);
        const char *const word = kind == 3 ? "light.range=false" : NULL;
        plain.spoil = matt;
        plain.part = &lamps_part;
        float *planned = picture_of(gpu, &plain, word, false);
        const struct glint_pass_result *light = gpu_result(gpu, "light"), *mask = gpu_result(gpu, "light_mask");
        assert_true(light->ran == (kind >= 2) && mask->ran == (kind == 2 || kind == 4));
        if (kind == 0) assert_string_equal(light->reason, "light of 1 lamp may reach 0 of 9600 surfaces");
        if (kind == 1) assert_string_equal(light->reason, "no lamps");
        float *all = picture_of(gpu, &plain, word, true);
        assert_memory_equal(planned, all, 4 * PIXELS * sizeof *all);
        for (uint32_t i = 0; kind < 2 && i < PIXELS; i++) assert_true(planned[4 * i] == 0.25F);
        if (kind == 4) assert_true(planned[4 * (PIXELS - 1)] == 0.125F);
        free(planned);
        free(all);
    }
}

/* lit - lamps + light; as it was where the capture does not say what part of its light is the lamps'. */
static void made_light_takes_the_place_of_the_captured_one(void **state) {
    struct gpu *gpu = *state;
    const struct glint_light lamp = lamp_at(0.4, 0.8, -4, 3);
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < PIXELS; i++) lamps_lit[c][i] = (float)(i % 32) / 256;
    for (int kind = 0; kind < 4; kind++) { /* with the part; without; switched off; without, but the pass runs */
        struct plain plain = frame_with(&bare, &lamp, 1);
        plain.spoil = matt;
        plain.part = kind % 2 ? NULL : &lamps_part;
        float *found = picture_of(gpu, &plain, kind == 2 ? "compose.relight=false" : NULL, kind == 3),
              *light = kind ? NULL : gpu_floats(gpu, "light", NULL, NULL);
        size_t brighter = 0, darker = 0;
        for (uint32_t i = 0; i < PIXELS; i++)
            for (uint32_t c = 0; c < 3; c++) {
                double at[3], normal[3];
                const bool hit = shapes_pixel(&bare, &plain, i % WIDE, i / WIDE, at, normal);
                const double lit = (1 + c) / 4.0, own = (double)lamps_lit[c][i];
                const double right = kind || !hit ? lit : fmax(lit - own + (double)light[4 * i + c], 0);
                assert_true(fabs((double)found[4 * i + c] - right) <= ldexp(1, -22));
                brighter += right > lit, darker += right < lit;
            }
        assert_true(kind ? !brighter && !darker : brighter > 1000 && darker > 1000);
        free(found);
        free(light);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_over_a_floor),
        cmocka_unit_test(light_fades_out_by_each_law),
        cmocka_unit_test(switched_off_light_has_no_end),
        cmocka_unit_test(lights_add_up),
        cmocka_unit_test(radius_metalness_and_invalid_surfaces),
        cmocka_unit_test(the_maps_of_a_lamp_shade_its_light_alone),
        cmocka_unit_test(sun_and_lamps_have_maps_of_their_own),
        cmocka_unit_test(bits_say_what_a_light_reaches),
        cmocka_unit_test(a_light_out_of_reach_leaves_the_passes_out),
        cmocka_unit_test(made_light_takes_the_place_of_the_captured_one),
    };
    return cmocka_run_group_tests_name("gpu_lights", tests, gpu_set_up, gpu_tear_down);
}
