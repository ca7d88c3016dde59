/* The refraction map and the water that is drawn with it: refraction and absorption by hand over a level bottom, and the lake, whose finished
   picture is known. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "lake.h"
#include "plain_capture.h"
#include "unit.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, POST_TOP = 44, POST_END = 49, WIDTH = 192, HEIGHT = 108 };
static const double HALF_VIEW = 0.57735026918962576, DEEP = 0.5, INDEX = 1.333; /* tan 30°; m */

/* ---- a level bottom under level water, a metre below the camera ---- */

static double down_at(double y) {
    return (2 * (y + 0.5) / SIDE - 1) * HALF_VIEW;
}
static double across_at(double x) {
    return (2 * (x + 0.5) / SIDE - 1) * HALF_VIEW;
}
static bool is_post(uint32_t y) {
    return y >= POST_TOP && y < POST_END;
}
static bool is_wet(uint32_t y) {
    return down_at(y) > 0.1 && !is_post(y);
}

/* Clear water for the place where the ray ends, `murky` for what it absorbs. The length of the view ray is in proportion to its depth. */
static void water_at(uint32_t x, uint32_t y, float opacity, float out[9]) {
    const double down = down_at(y), length = sqrt(1 + pow(across_at(x), 2) + down * down);
    const float values[9] = {1.5F,
                             0.25F,
                             0.125F,
                             opacity,
                             0,
                             1,
                             0,
                             is_wet(y) ? (float)(1 / down) : INFINITY,
                             is_wet(y) ? (float)(DEEP / down * length) : 0};
    memcpy(out, values, sizeof values);
}
static void clear(uint32_t x, uint32_t y, float out[9]) {
    water_at(x, y, 0x1p-30F, out);
}
/* Its thickness is half as large again as the bottom is deep: the depths say where the ray ends. */
static void too_thick(uint32_t x, uint32_t y, float out[9]) {
    clear(x, y, out);
    out[8] *= 1.5F;
}
static void murky(uint32_t x, uint32_t y, float out[9]) {
    water_at(x, y, 0.375F, out);
}

/* Colours say where in the picture they are: linear in x and y, so that interpolation keeps them. Nothing reflects. */
static void spoil_bottom(const struct plain *plain, float *values) {
    (void)plain;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t x = i % SIDE, y = i / SIDE;
        const double down = down_at(y);
        values[PLAIN_SPECULAR * PIXELS + i] = 0;
        values[PLAIN_DEPTH * PIXELS + i] = is_post(y) ? 0.5F : down > 0.1 ? (float)((1 + DEEP) / down) : INFINITY;
        values[PLAIN_LIT_R * PIXELS + i] = ((float)x + 0.5F) / SIDE;
        values[PLAIN_LIT_G * PIXELS + i] = ((float)y + 0.5F) / SIDE;
        values[PLAIN_LIT_B * PIXELS + i] = 1;
    }
}
static float caustic_at(uint32_t i) {
    return (float)(i * 2654435761U % 1021) / 256;
}

struct pool {
    void (*water)(uint32_t x, uint32_t y, float out[9]);
    void (*spoil)(const struct plain *plain, float *values); /* NULL: the level bottom */
    bool caustics;
};
static void load_pool(struct gpu *gpu, const struct pool *pool, const char *const *words) {
    static const char *const slots[] = {"screen_trace", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    static const char *const names[3] = {"R", "G", "B"};
    static float light[PIXELS];
    struct glint_channel channels[3] = {{0}};
    char path[256];
    for (uint32_t i = 0; i < PIXELS; i++) light[i] = caustic_at(i);
    for (int k = 0; k < 3; k++)
        channels[k] = (struct glint_channel){.name = names[k], .type = GLINT_F32, .data = light};
    const struct glint_part part = {
        .name = "water.caustics", .width = SIDE, .height = SIDE, .channels = channels, .channel_count = 3};
    plain_capture(gpu_path(gpu, "pool", path), &(struct plain){.width = SIDE,
                                                               .height = SIDE,
                                                               .roughness = 0.5F,
                                                               .fov_y_degrees = 60,
                                                               .spoil = pool->spoil ? pool->spoil : spoil_bottom,
                                                               .water = pool->water,
                                                               .part = pool->caustics ? &part : NULL});
    gpu_load(gpu, "pool");
    gpu_reset(gpu);
    gpu_without(gpu, slots);
    gpu->float_precision = true;
    gpu_use(gpu, "linear_depth_half=picked");
    gpu_use(gpu, "refraction_map=absorbed");
    gpu_use(gpu, "water=mapped");
    gpu_set(gpu, "water.intensity=0");
    for (; *words; words++) (strchr(*words, '.') ? gpu_set : gpu_use)(gpu, *words);
    gpu_run(gpu);
}

static void load(struct gpu *gpu, void (*water)(uint32_t x, uint32_t y, float out[9]), bool caustics,
                 const char *const *words) {
    load_pool(gpu, &(struct pool){.water = water, .caustics = caustics}, words);
}

/* Where the refracted ray of a pixel ends, in pixels. Snell's law at a level plane: what of the direction is along it is divided by the index. */
static void landing(uint32_t x, uint32_t y, double deep, double place[2]) {
    const double across = across_at(x), down = down_at(y), length = sqrt(1 + across * across + down * down);
    const double flat[2] = {across / length / INDEX, -1 / length / INDEX};
    const double way = deep / sqrt(1 - flat[0] * flat[0] - flat[1] * flat[1]);
    const double end[3] = {across / down + way * flat[0], -1 - deep, -1 / down + way * flat[1]};
    place[0] = (end[0] / -end[2] / HALF_VIEW + 1) / 2 * SIDE;
    place[1] = (1 - end[1] / -end[2] / HALF_VIEW) / 2 * SIDE;
}

/* Whether each of the texels around a place, so many pixels wide, shows water (1), none does (0), or it is not sure (-1). */
static int wet_around(const double place[2], int wide) {
    const double margin = wide + 0.01; /* rounding */
    int wet = 0, all = 0;
    for (int k = 0; k < 2; k++)
        if (place[k] < 2 * wide || place[k] > SIDE - 2 * wide) return -1;
    for (int y = (int)floor(place[1] - margin); y <= (int)floor(place[1] + margin); y++, all++)
        wet += is_wet((uint32_t)y);
    return wet == all ? 1 : wet == 0 ? 0 : -1;
}

/* The depths and positions are floats: each is off by 2^-23 of itself at most after a dozen roundings. The bottom lies (1 + DEEP) / 0.1 = 15 m
   away at most, and its depth is a difference, so that it is off by 12 · 2^-23 · 15 m, of DEEP: 4e-5 of the offset, which is below 12 pixels.
   Colours are off by 2^-23 of 64 pixels, and clear water takes 2^-30 of them a metre. */
static void the_refracted_ray_ends_where_snell_says(void **state) {
    static const char *const settings[][3] = {{"downsample=none", NULL},
                                              {"downsample=pick", NULL},
                                              {"downsample=pick", "linear_depth_half.choose=first", NULL},
                                              {"downsample=pick", "linear_depth_half.choose=farthest", NULL},
                                              {"downsample=none", "water.refraction=false", NULL},
                                              {"downsample=pick", "water.refinements=1", NULL}};
    const double bound = 12 * 4e-5 + 64 * 0x1p-23 + 64 * 0x1p-28;
    struct gpu *gpu = *state;
    for (int s = 0; s < 6; s++) {
        const int wide = settings[s][0][11] == 'n' ? 1 : 2;
        double worst = 0, farthest = 0;
        int counted = 0, behind_post = 0;
        load(gpu, s == 5 ? too_thick : clear, false, settings[s]);
        float *found = gpu_floats(gpu, "composed_water", NULL, NULL);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const uint32_t x = i % SIDE, y = i / SIDE;
            const double own[2] = {x + 0.5, y + 0.5};
            double place[2], first[2];
            if (!is_wet(y)) {
                assert_true(found[4 * i] == (float)(own[0] / SIDE) && found[4 * i + 1] == (float)(own[1] / SIDE));
                continue;
            }
            landing(x, y, DEEP, place);
            landing(x, y, s == 5 ? 1.5 * DEEP : DEEP, first);
            const double away = hypot(place[0] - own[0], place[1] - own[1]);
            if (s == 4) memcpy(place, own, sizeof place);
            const int wet = wet_around(place, wide);
            if (wet < 0 || wet_around(own, wide) != 1 || (s == 5 && (!wet || wet_around(first, wide) != 1))) continue;
            for (uint32_t k = 0; k < 2; k++)
                worst = fmax(worst, fabs((double)found[4 * i + k] * SIDE - (wet ? place[k] : own[k])));
            if (wet && s != 4) farthest = fmax(farthest, away);
            counted += wet, behind_post += !wet;
        }
        print_message(
            "# %s %s: %d pixels off by %.2g px at most, bound %.2g; refracted by up to %.1f px; %d ends behind "
            "the post\n",
            settings[s][0], settings[s][1] ? settings[s][1] : "", counted, worst, bound, farthest, behind_post);
        assert_true(counted > (wide == 1 ? 300 : 50) && worst <= bound && farthest < 12);
        if (s != 4) assert_true(farthest > 4 && (wide == 2 || behind_post > SIDE));
        free(found);
    }
}

/* ---- a bottom that descends away from the shore ---- */

/* At z = -SHORE it meets the water, and is SLOPE deeper with each metre farther away. */
static const double SLOPE = 0.2, SHORE = 1.8;
static double slope_depth(double down) {
    return (1 - SLOPE * SHORE) / (down - SLOPE);
}
static bool is_sloped(uint32_t y) {
    const double down = down_at(y);
    return down > SLOPE + 0.03 && slope_depth(down) > SHORE;
}
static void sloped(uint32_t x, uint32_t y, float out[9]) {
    const double down = down_at(y), length = sqrt(1 + pow(across_at(x), 2) + down * down);
    clear(x, y, out);
    out[7] = is_sloped(y) ? (float)(1 / down) : INFINITY;
    out[8] = is_sloped(y) ? (float)((slope_depth(down) - 1 / down) * length) : 0;
}
static void spoil_slope(const struct plain *plain, float *values) {
    spoil_bottom(plain, values);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const double down = down_at(i / SIDE);
        values[PLAIN_DEPTH * PIXELS + i] = down > SLOPE + 0.03 ? (float)slope_depth(down) : INFINITY;
    }
}

/* The refracted ray of a pixel: where it starts, and how far it comes to the side, down and away with each metre. */
struct ray {
    double from[2], across, sinks, away;
};
static struct ray ray_of(uint32_t x, uint32_t y) {
    const double across = across_at(x), down = down_at(y),
                 along = 1 / (INDEX * sqrt(1 + across * across + down * down));
    return (struct ray){
        {across / down, 1 / down}, along * across, sqrt(1 - along * along * (1 + across * across)), along};
}
static void place_of(const struct ray *ray, double way, double place[2]) {
    const double far = ray->from[1] + way * ray->away;
    place[0] = ((ray->from[0] + way * ray->across) / far / HALF_VIEW + 1) / 2 * SIDE;
    place[1] = ((1 + way * ray->sinks) / far / HALF_VIEW + 1) / 2 * SIDE;
}
static double true_way(const struct ray *ray) {
    return SLOPE * (ray->from[1] - SHORE) / (ray->sinks - SLOPE * ray->away);
}

/* How far from the ray's true end two lookups of the bottom come, in pixels: each takes the depth that shows at the last end, the second one by the
   secant, where one end was too deep and one not deep enough. -1 where an end shows no water. */
static double off_after_two(uint32_t x, uint32_t y, bool secant) {
    const struct ray ray = ray_of(x, y);
    double way = SLOPE * (slope_depth(down_at(y)) - SHORE) / ray.sinks, before = way, missed = 0, ends[2][2];
    for (int i = 0; i < 2; i++) {
        const double seen = (1 + way * ray.sinks) / (ray.from[1] + way * ray.away);
        if (!(seen > SLOPE + 0.05 && seen < 0.97 * HALF_VIEW && slope_depth(seen) > SHORE + 0.1)) return -1;
        const double missing = SLOPE * (slope_depth(seen) - SHORE) / ray.sinks - way, here = way;
        way += secant && missing * missed < 0 ? -missing * (way - before) / (missing - missed) : missing;
        before = here, missed = missing;
    }
    place_of(&ray, way, ends[0]), place_of(&ray, true_way(&ray), ends[1]);
    for (int k = 0; k < 4; k++)
        if (!(ends[k / 2][k % 2] > 1 && ends[k / 2][k % 2] < SIDE - 1)) return -1;
    return hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]);
}

/* What is looked up is the middle of a texel, half a pixel at most from where the ray ends, so that the mean over pixels differs by less than that;
   a quarter tells it from lookups that alternate between the two sides. */
static void a_slope_is_met_by_the_secant(void **state) {
    static const char *const words[] = {"downsample=none", NULL};
    struct gpu *gpu = *state;
    double mean = 0, by_secant = 0, alternating = 0;
    int count = 0;
    load_pool(gpu, &(struct pool){.water = sloped, .spoil = spoil_slope}, words);
    float *found = gpu_floats(gpu, "composed_water", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t x = i % SIDE, y = i / SIDE;
        if (!is_sloped(y)) continue;
        const double off = off_after_two(x, y, true), other = off_after_two(x, y, false);
        const struct ray ray = ray_of(x, y);
        double right[2];
        if (off < 0 || other < 0) continue;
        place_of(&ray, true_way(&ray), right);
        mean += hypot((double)found[4 * i] * SIDE - right[0], (double)found[4 * i + 1] * SIDE - right[1]);
        by_secant += off, alternating += other, count++;
    }
    assert_true(count > 500);
    print_message("# %d pixels: %.3f px from the end in the mean; expected %.3f, alternating %.3f\n", count,
                  mean / count, by_secant / count, alternating / count);
    assert_true(alternating - by_secant > 0.5 * count && fabs(mean - by_secant) < 0.25 * count);
    free(found);
}

static double left_of(uint32_t x, uint32_t y, int along) {
    const double down = down_at(y), length = sqrt(1 + pow(across_at(x), 2) + down * down);
    const double sine = sqrt(1 - pow(down / length, 2)) / INDEX;
    const double ways[] = {DEEP / sqrt(1 - sine * sine), DEEP / down * length, DEEP, 1};
    return pow(1 - 0.375, ways[along]);
}

/* pow: 16 ULP of an exponent below 8, and a dozen roundings of the way before it, whose logarithm is below 8 · 0.47: 2^-23 · (16 + 12 · 4) of
   what is left, at most 1, times colours up to 1 + 2 · 4. */
static void the_map_absorbs_and_scatters(void **state) {
    static const char *const along[] = {"refraction_map.along=refracted", "refraction_map.along=view",
                                        "refraction_map.along=up", "refraction_map.depth=false"};
    static const double own[3] = {1.5, 0.25, 0.125};
    struct gpu *gpu = *state;
    for (int s = 0; s < 8; s++) {
        const char *const words[] = {s < 4 ? "downsample=none" : "downsample=pick", along[s % 4],
                                     s % 2 ? "refraction_map.caustics=0" : "refraction_map.caustics=2", NULL};
        const uint32_t wide = s < 4 ? 1 : 2;
        const double more = s % 2 ? 0 : 2, bound = 9 * 64 * 0x1p-23;
        double worst = 0;
        uint32_t width, height, some = 0;
        load(gpu, murky, true, words);
        float *found = gpu_floats(gpu, "refraction_map", &width, &height);
        assert_true(width == SIDE / wide && height == SIDE / wide);
        for (uint32_t t = 0; t < width * height; t++) {
            double sum[4] = {0};
            for (uint32_t i = 0; i < wide * wide; i++) {
                const uint32_t x = wide * (t % width) + i % 2, y = wide * (t / width) + i / 2;
                if (!is_wet(y)) continue;
                const double left = left_of(x, y, s % 4), light = more * (double)caustic_at(y * SIDE + x);
                const double bottom[3] = {(x + 0.5) / SIDE, (y + 0.5) / SIDE, 1};
                for (int k = 0; k < 3; k++) sum[k] += own[k] + ((bottom[k] + light) - own[k]) * left;
                sum[3]++;
            }
            for (uint32_t k = 0; k < 3; k++)
                worst = fmax(worst, fabs((double)found[4 * t + k] - (sum[3] > 0 ? sum[k] / sum[3] : 0)));
            assert_true((double)found[4 * t + 3] == sum[3] / (wide * wide));
            some += found[4 * t + 3] > 0 && found[4 * t + 3] < 1;
        }
        print_message("# %s %s %s: off by %.2g at most, bound %.2g\n", words[0], words[1], words[2], worst, bound);
        assert_true(worst <= bound && (wide == 1 ? some == 0 : some > 0));
        free(found);
    }
}

/* Rows of a texel differ in depth, and its columns do not: of equal depths the first counts. */
static void one_pixel_stands_for_the_texel(void **state) {
    static const char *const settings[][2] = {{"linear_depth_half.choose=first", NULL},
                                              {"linear_depth_half.choose=nearest", NULL},
                                              {"linear_depth_half.choose=farthest", NULL}};
    struct gpu *gpu = *state;
    for (int s = 0; s < 3; s++) {
        uint32_t width, height, lower = 0;
        load(gpu, clear, false, settings[s]);
        float *found = gpu_floats(gpu, "linear_depth_half", &width, &height),
              *depth = gpu_part(gpu, "gbuffer", (const char *[]){"depth.Z"}, 1);
        assert_true(width == SIDE / 2 && height == SIDE / 2);
        for (uint32_t i = 0; i < PIXELS / 4; i++) {
            const float *two = depth + 2 * (i / width) * SIDE + 2 * (i % width), above = two[0], below = two[SIDE];
            const bool second =
                s && below < INFINITY && (above == INFINITY || (s == 1 ? below < above : below > above));
            assert_true(found[2 * i] == (second ? below : above));
            assert_true(found[2 * i + 1] == (second ? 2 : 0));
            lower += second;
        }
        assert_true(s == 0 || lower >= SIDE / 2);
        free(found), free(depth);
    }
}

/* ---- nothing to do ---- */

static void without_water_there_is_no_pass(void **state) {
    static const char *const none[] = {NULL}, *const slots[] = {"linear_depth_half", "refraction_map", "water"};
    struct gpu *gpu = *state;
    load(gpu, NULL, false, none);
    for (int i = 0; i < 3; i++) {
        assert_string_equal(gpu_result(gpu, slots[i])->reason, "no water surface");
        assert_false(gpu_result(gpu, slots[i])->ran);
    }
}

/* A capture without them, and one that has them at a factor of 0, give the same bits. */
static void without_caustics_nothing_is_added(void **state) {
    static const char *const words[2][2] = {{NULL}, {"refraction_map.caustics=0", NULL}};
    struct gpu *gpu = *state;
    float *maps[2];
    for (int i = 0; i < 2; i++) {
        load(gpu, murky, i == 1, words[i]);
        maps[i] = gpu_floats(gpu, "refraction_map", NULL, NULL);
    }
    assert_memory_equal(maps[0], maps[1], sizeof(float) * PIXELS);
    free(maps[0]), free(maps[1]);
}

/* ---- the lake ---- */

static void load_lake(struct gpu *gpu, const char *size) {
    gpu_sample(gpu, "lake", "lake",
               &(struct glint_sample_options){.width = WIDTH,
                                              .height = HEIGHT,
                                              .cube_size = 32,
                                              .light_samples = 8,
                                              .planar_width = 96,
                                              .planar_height = 54,
                                              .also = GLINT_ALSO_CAUSTICS});
    gpu_reset(gpu);
    gpu_use(gpu, size);
    gpu_use(gpu, "classify_water=shown");
    gpu_use(gpu, "planar=lookup");
    gpu_use(gpu, "linear_depth_half=picked");
    gpu_use(gpu, "refraction_map=absorbed");
    gpu_use(gpu, "water=mapped");
    gpu_set(gpu, "refraction_map.caustics=0"); /* the finished picture has none */
}

static void every_part_of_it_brings_the_picture_nearer(void **state) {
    static const char *const off[] = {NULL,
                                      "refraction_map.along=view",
                                      "refraction_map.along=up",
                                      "refraction_map.depth=false",
                                      "water.refinements=0",
                                      "water.refraction=false"};
    struct gpu *gpu = *state;
    double errors[6];
    load_lake(gpu, "downsample=pick");
    float *opacity = gpu_part(gpu, "water", (const char *[]){"opacity"}, 1),
          *scene = gpu_part(gpu, "scene", (const char *[]){"R", "G", "B"}, 3);
    for (int i = 0; i < 6; ++i) {
        load_lake(gpu, "downsample=pick");
        if (off[i]) gpu_set(gpu, off[i]);
        gpu_run(gpu);
        errors[i] = lake_error(gpu, opacity, scene);
        print_message("# %-28s %.4f\n", off[i] ? off[i] : "all", errors[i]);
        if (i) assert_true(errors[i] > errors[0]);
    }
    free(opacity), free(scene);
}

/* The captured layer lies on the bottom of the lake, and is seen through the water. */
static void caustics_light_the_bottom(void **state) {
    struct gpu *gpu = *state;
    float *maps[2];
    load_lake(gpu, "downsample=none");
    float *light = gpu_part(gpu, "water.caustics", (const char *[]){"G"}, 1),
          *opacity = gpu_part(gpu, "water", (const char *[]){"opacity"}, 1);
    for (int i = 0; i < 2; i++) {
        if (i) gpu_set(gpu, "refraction_map.caustics=1");
        gpu_run(gpu);
        maps[i] = gpu_floats(gpu, "refraction_map", NULL, NULL);
    }
    size_t lit = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float more = maps[1][4 * i + 1] - maps[0][4 * i + 1];
        if (!(opacity[i] > 0 && light[i] > 0)) assert_true(more == 0);
        else assert_true(more >= 0 && more <= light[i] * 1.002F + 0x1p-11F); /* halves */
        lit += more > 0;
    }
    print_message("# %zu pixels\n", lit);
    assert_true(lit > 500);
    free(light), free(opacity), free(maps[0]), free(maps[1]);
}

static void the_plan_changes_no_bit(void **state) {
    static const char *const images[] = {"linear_depth_half", "refraction_map", "composed_water"};
    struct gpu *gpu = *state;
    float *planned[3], *all[3];
    uint32_t width[3], height[3];
    for (int i = 0; i < 2; i++) {
        load_lake(gpu, "downsample=pick");
        gpu->all = i == 1;
        gpu_run(gpu);
        for (int k = 0; k < 3; k++) (i ? all : planned)[k] = gpu_floats(gpu, images[k], &width[k], &height[k]);
    }
    for (int k = 0; k < 3; k++) {
        const size_t channels = k ? 4 : 2;
        assert_memory_equal(planned[k], all[k], sizeof(float) * channels * width[k] * height[k]);
        free(planned[k]), free(all[k]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_refracted_ray_ends_where_snell_says),
        cmocka_unit_test(a_slope_is_met_by_the_secant),
        cmocka_unit_test(the_map_absorbs_and_scatters),
        cmocka_unit_test(one_pixel_stands_for_the_texel),
        cmocka_unit_test(without_water_there_is_no_pass),
        cmocka_unit_test(without_caustics_nothing_is_added),
        cmocka_unit_test(every_part_of_it_brings_the_picture_nearer),
        cmocka_unit_test(caustics_light_the_bottom),
        cmocka_unit_test(the_plan_changes_no_bit),
    };
    return cmocka_run_group_tests_name("gpu_refraction_map", tests, gpu_set_up, gpu_tear_down);
}
