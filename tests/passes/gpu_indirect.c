/* The slots of indirect light against closed forms, in frames that show all that sends light. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "indirect.h"
#include "unit.h"

static const double pi = 3.14159265358979323846;
enum { WIDE = 160, HIGH = 120, WORDS = 12 };

static struct plain frame_of(const void *user, double fov_y_degrees) {
    return (struct plain){.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.5F,
                          .fov_y_degrees = fov_y_degrees,
                          .spoil = lit_patch_spoil,
                          .user = user};
}

/* ---- closed forms ---- */

/* The same by quadrature over the patch: cos cos / (π r²). */
static double by_quadrature(const struct lit_patch *patch, const double at[3], const double normal[3]) {
    enum { STEPS = 400 };
    const int a = patch->axis == 0, b = patch->axis == 2 ? 1 : 2;
    const double da = (patch->high[a] - patch->low[a]) / STEPS, db = (patch->high[b] - patch->low[b]) / STEPS;
    double sum = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        double way[3], r2 = 0, cosine = 0;
        way[patch->axis] = patch->place - at[patch->axis];
        way[a] = patch->low[a] + (i % STEPS + 0.5) * da - at[a];
        way[b] = patch->low[b] + (i / STEPS + 0.5) * db - at[b];
        for (int k = 0; k < 3; k++) r2 += way[k] * way[k], cosine += way[k] * normal[k];
        if (cosine > 0) sum += cosine * fabs(way[patch->axis]) / (pi * r2 * r2) * da * db;
    }
    return sum;
}

/* With a field of view of 90 degrees it begins and ends between two texels, 8 and 14 pixels above the horizon. */
static const struct lit_patch overhead = {
    {.floor_y = -1, .ceiling_y = 1}, 1, 1, {-1.5, 0, -60.0 / 8}, {1, 0, -60.0 / 14}};
static const struct lit_patch on_wall = {
    {.floor_y = -1, .wall_z = -6, .wall_top = INFINITY}, 2, -6, {-0.75, -0.5, 0}, {0.5, 1, 0}};
static const struct lit_patch on_floor = {
    {.floor_y = -1, .wall_z = -6, .wall_top = INFINITY}, 1, -1, {-0.5, 0, -5.5}, {0.75, 0, -4.5}};

static const struct lit_patch all_floor = {
    {.floor_y = -1, .wall_z = -6, .wall_top = INFINITY}, 1, -1, {-2, 0, -6}, {2, 0, -2}};

static void form_factors_agree_with_quadrature(UNUSED void **state) {
    static const double up[3] = {0, 1, 0}, back[3] = {0, 0, 1};
    for (double x = -2; x < 2; x += 0.7)
        for (double z = -5.2; z > -8; z -= 0.9) {
            const double floor[3] = {x, -1, z + 3}, below[3] = {x, -1, z}, wall[3] = {x, 0.4 * x, -6};
            assert_true(fabs(lit_patch_seen(&overhead, below, up) - by_quadrature(&overhead, below, up)) < 1e-4);
            if (floor[2] > -5.5)
                assert_true(fabs(lit_patch_seen(&on_wall, floor, up) - by_quadrature(&on_wall, floor, up)) < 1e-3);
            assert_true(fabs(lit_patch_seen(&on_floor, wall, back) - by_quadrature(&on_floor, wall, back)) < 1e-3);
        }
    /* A plate that fills nearly all of the hemisphere. */
    const struct lit_patch wide = {{.floor_y = -1}, 1, 1, {-1e5, 0, -1e5}, {1e5, 0, 1e5}};
    assert_true(fabs(lit_patch_seen(&wide, (double[3]){0, -1, 0}, up) - 1) < 1e-4);
}

/* ---- every tracer against them ---- */

#define FINE                                                                                                           \
    "downsample=none", "indirect_trace.level=0", "indirect_apply=bilinear", "indirect_trace.fallback=black",           \
        "indirect_trace.pattern=sobol"

struct trial {
    const char *words[WORDS];
    double mean, bias; /* bounds */
    const char *reason;
};

/* In the middle of the picture, and not nearer to the patch's plane than `away`: a ray cannot hit anything in its own texel. */
static bool is_judged(const struct lit_patch *patch, const double at[3], double away) {
    return fabs(at[0]) < 2.5 && at[2] < -2.5 && at[2] > -8 && fabs(at[patch->axis] - patch->place) > away;
}

static void try_all(struct gpu *gpu, const struct lit_patch *patch, double fov, const struct trial *trials,
                    size_t count) {
    const struct plain plain = frame_of(patch, fov);
    indirect_load(gpu, &plain);
    for (size_t t = 0; t < count; t++) {
        uint32_t width, height;
        double mean = 0, bias = 0, light = 0;
        int judged = 0;
        indirect_arrange(gpu, trials[t].words);
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "indirect", &width, &height);
        for (uint32_t i = 0; i < width * height; i++) {
            double at[3], normal[3];
            if (!shapes_pixel(plain.user, &plain, i % width, i / width, at, normal) || !is_judged(patch, at, 0.25))
                continue;
            const double right = lit_patch_seen(patch, at, normal), error = (double)found[4 * i] - right;
            mean += fabs(error), bias += error, light += right;
            judged++;
            assert_true(found[4 * i] == found[4 * i + 1] && found[4 * i + 3] == 1);
        }
        free(found);
        assert_true(judged > 400);
        print_message("# %s: mean error %.4f, bias %+.4f of %.4f, %d pixels\n", trials[t].words[5], mean / judged,
                      bias / judged, light / judged, judged);
        if (!(mean <= trials[t].mean * judged && fabs(bias) <= trials[t].bias * judged))
            fail_msg("%s: expected at most %g and %g: %s", trials[t].words[5], trials[t].mean, trials[t].bias,
                     trials[t].reason);
    }
}
#define TRY(gpu, patch, fov, trials) try_all(gpu, patch, fov, trials, sizeof(trials) / sizeof *(trials))

/* 64 directions of a Sobol sequence: an area of 0.1 to 0.2 of the unit square is off by its border, about 64^-3/4 = 0.04 of a part of it. */
static const struct trial trials[] = {
    {{FINE, "indirect_trace=hiz", "hiz=nearest", "indirect_trace.directions=64"}, 0.02, 0.004, "64 directions"},
    {{FINE, "indirect_trace=linear", "indirect_trace.directions=64", "indirect_trace.steps=64",
      "indirect_trace.thickness_m=0.1"},
     0.03,
     0.01,
     "64 directions, and steps that pass over the patch's border"}};

/* Cell by cell, a ray ends where the pyramid lets it end, so that a few rays a pixel tell them apart. */
static void cells_end_rays_where_the_pyramid_does(struct gpu *gpu, const struct lit_patch *patch, double fov) {
    static const struct trial few[] = {
        {{FINE, "indirect_trace=hiz", "hiz=nearest", "indirect_trace.directions=4"}, 0, 0, NULL},
        {{FINE, "indirect_trace=dda", "indirect_trace.directions=4"}, 0, 0, NULL}};
    const struct plain plain = frame_of(patch, fov);
    float *found[2];
    int differ = 0, lit = 0;
    indirect_load(gpu, &plain);
    for (int t = 0; t < 2; t++) {
        indirect_arrange(gpu, few[t].words);
        gpu_run(gpu);
        found[t] = gpu_floats(gpu, "indirect", NULL, NULL);
    }
    for (int i = 0; i < WIDE * HIGH; i++) lit += found[0][4 * i] > 0, differ += found[0][4 * i] != found[1][4 * i];
    free(found[0]), free(found[1]);
    print_message("# cell by cell, %d of %d lit pixels differ\n", differ, lit);
    assert_true(lit > 400 && differ == 0);
}

/* The linear march takes longer steps across the picture than a plate seen at a grazing angle is high. */
static void a_lit_patch_opposite(void **state) {
    try_all(*state, &overhead, 90, trials, 1);
    cells_end_rays_where_the_pyramid_does(*state, &overhead, 90);
}
static void a_lit_patch_beside_the_floor(void **state) {
    TRY(*state, &on_wall, 60, trials);
    cells_end_rays_where_the_pyramid_does(*state, &on_wall, 60);
}
static void a_lit_patch_beside_a_wall(void **state) {
    TRY(*state, &on_floor, 60, trials);
    cells_end_rays_where_the_pyramid_does(*state, &on_floor, 60);
}

/* ---- furnaces ---- */

static void white_cube(UNUSED uint32_t number, const double direction[3], float out[5]) {
    const double far = fmax(fabs(direction[0]) / 4, fmax(fabs(direction[1]), fabs(direction[2]) / 6));
    for (int k = 0; k < 4; k++) out[k] = 1;
    out[4] = (float)(1 / far);
}
static void white_light(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    shapes_spoil(plain, values);
    for (uint32_t i = 0; i < 3 * pixels; i++) values[PLAIN_LIT_R * pixels + i] = 1;
}
/* Some texels have a normal that none around them has, so that no texel of a coarser level is of their surface. */
static void speckled_light(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    white_light(plain, values);
    for (uint32_t i = 0; i < pixels; i++) {
        const uint32_t x = i % plain->width / 2 % 8, y = i / plain->width / 2 % 8;
        for (uint32_t k = 0; k < 3 && ((x == 3 && y == 5) || (x == 6 && y == 2)); k++)
            values[(PLAIN_NORMAL_X + k) * pixels + i] = k == 0;
    }
}
static const struct shapes room = {.floor_y = -1, .ceiling_y = 1, .wall_z = -6, .wall_top = INFINITY};

/* In a closed room whose surfaces all send the radiance 1, everything receives 1: on every way that light can take. */
static void radiance_stays_in_a_furnace(void **state) {
    static const char *const ways[][3] = {{"indirect_trace.fallback=volume", "volume_make=gather", NULL},
                                          {"indirect_trace.fallback=cubemaps", NULL},
                                          {"indirect_trace.fallback=volume", NULL},
                                          {"indirect_trace.fallback=black", NULL}};
    static const char *const tracers[] = {"indirect_trace=dda", "indirect_trace=hiz", "indirect_trace=linear"};
    struct gpu *gpu = *state;
    struct plain plain = frame_of(&room, 60);
    plain.spoil = speckled_light;
    plain.cube = white_cube;
    plain.cube_size = 16;
    plain.cube_count = 1;
    indirect_load(gpu, &plain);
    for (int way = 0; way < 4; way++)
        for (int t = 0; t < 3; t++) {
            const char *words[] = {"downsample=mips",
                                   tracers[t],
                                   "hiz=nearest",
                                   "indirect_blur=edges",
                                   "indirect_apply=planes",
                                   "indirect_temporal=reprojected",
                                   "surface_levels=picked",
                                   ways[way][0],
                                   ways[way][1],
                                   NULL};
            double least = INFINITY, most = 0;
            indirect_arrange(gpu, words);
            gpu_run(gpu);
            float *found = gpu_floats(gpu, "indirect", NULL, NULL);
            for (int i = 0; i < WIDE * HIGH; i++) {
                least = fmin(least, (double)found[4 * i]);
                most = fmax(most, (double)found[4 * i]);
            }
            free(found);
            print_message("# %s, %s: %.6f to %.6f\n", tracers[t], ways[way][0], least, most);
            assert_true(most < 1 + 1e-5); /* weights of a mean */
            if (way < 3) assert_true(least > 1 - 1e-5);
            else assert_true(least < 0.9); /* a ray out of the picture finds nothing */
        }
}

/* ---- light that no ray finds ---- */

/* The ambient light that falls on a pixel, and what its material sends back of it; some materials are metals, or nearly black. */
static double ambient_at(uint32_t i, uint32_t k) {
    return 0.25 + 0.01 * (i % 53) + 0.2 * k;
}
static void add_materials(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    shapes_spoil(plain, values);
    for (uint32_t i = 0; i < pixels; i++) {
        values[PLAIN_METALNESS * pixels + i] = i % 3 ? 0 : 0.5F * (float)(i % 9 / 3);
        for (uint32_t k = 0; k < 3; k++)
            values[(PLAIN_ALBEDO_R + k) * pixels + i] = i % 7 ? 0.0625F * (float)(1 + (i + k) % 15) : 0.0F;
    }
}
static double diffuse_at(uint32_t i, uint32_t k) {
    return i % 7 ? 0.0625 * (1 + (i + k) % 15) * (i % 3 ? 1 : 1 - 0.5 * (i % 9 / 3)) : 0;
}

/* In a frame without cube maps, sky and volume the captured light stays where rays of no length find nothing; and where it is not to be used, the
   indirect light is black. In floats, of which some dozens are rounded, so that the bound does not depend on whether a device rounds or cuts off
   the halves that it stores. */
static void light_that_no_ray_finds_is_the_captured_one(void **state) {
    static const char *const ways[] = {"indirect_trace.fallback=volume", "indirect_trace.fallback=captured",
                                       "compose.bounce=false",           "compose.ambient=true",
                                       "indirect_trace.fallback=black",  "indirect_apply.least_albedo=1.01",
                                       "indirect_apply.intensity=0"};
    enum { OFF = 2, ADDED, BLACK, WAYS = 7 };
    struct gpu *gpu = *state;
    struct plain plain = frame_of(&room, 60);
    float *light = malloc(3 * WIDE * HIGH * sizeof *light);
    assert_non_null(light);
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t i = 0; i < WIDE * HIGH; i++)
            light[k * WIDE * HIGH + i] = (float)(ambient_at(i, k) * diffuse_at(i, k));
    const struct glint_channel channels[] = {{.name = "R", .type = GLINT_F32, .data = light},
                                             {.name = "G", .type = GLINT_F32, .data = light + WIDE * HIGH},
                                             {.name = "B", .type = GLINT_F32, .data = light + 2 * WIDE * HIGH}};
    plain.spoil = add_materials;
    plain.part = &(struct glint_part){
        .name = "indirect", .width = WIDE, .height = HIGH, .channels = channels, .channel_count = 3};
    indirect_load(gpu, &plain);
    for (int way = 0; way < WAYS; way++) {
        const char *words[] = {"downsample=mips",
                               "surface_levels=picked",
                               "indirect_trace=linear",
                               "indirect_blur=edges",
                               "indirect_apply=planes",
                               "indirect_temporal=reprojected",
                               "volume_make=gather",
                               "compose=brdf",
                               ways[way],
                               "indirect_trace.length_m=0",
                               NULL};
        float *composed[2];
        for (int all = 0; all < 2; all++) {
            indirect_arrange(gpu, words);
            gpu->float_precision = true;
            gpu->all = all;
            gpu_run(gpu);
            composed[all] = gpu_floats(gpu, "composed", NULL, NULL);
        }
        gpu->all = false;
        float *found = gpu_floats(gpu, "indirect", NULL, NULL),
              *lit = gpu_part(gpu, "lit", (const char *const[]){"R", "G", "B"}, 3);
        assert_memory_equal(composed[0], composed[1], WIDE * HIGH * 4 * sizeof(float));
        for (uint32_t i = 0; i < 3 * WIDE * HIGH; i++) {
            const uint32_t p = i / 3, k = i % 3;
            const double ambient = way < BLACK && diffuse_at(p, k) > 0 ? ambient_at(p, k) : 0, picture = (double)lit[i];
            const double captured = ambient_at(p, k) * diffuse_at(p, k);
            const double right = fmax(way < ADDED    ? picture
                                      : way == ADDED ? picture + captured
                                                     : picture - captured,
                                      0);
            assert_true(fabs((double)found[4 * p + k] - ambient) <= 0x1p-18 * ambient);
            assert_true(fabs((double)composed[0][4 * p + k] - right) <= 0x1p-18 * (picture + ambient));
        }
        free(composed[0]), free(composed[1]), free(found), free(lit);
    }
    free(light);
}

/* A black picture has no light to send back unless something else holds some: the plan leaves the effect out, and no bit changes. */
static void blacken(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    shapes_spoil(plain, values);
    memset(values + PLAIN_LIT_R * pixels, 0, 3 * pixels * sizeof *values);
}
static void where_nothing_shines_nothing_is_traced(void **state) {
    static const char *const words[] = {"downsample=mips",
                                        "surface_levels=picked",
                                        "indirect_trace=linear",
                                        "indirect_blur=edges",
                                        "indirect_apply=planes",
                                        "compose=brdf",
                                        NULL};
    struct gpu *gpu = *state;
    for (int bright = 0; bright < 2; bright++) {
        struct plain plain = frame_of(&room, 60);
        plain.spoil = blacken;
        if (bright) plain.cube = white_cube, plain.cube_size = 16, plain.cube_count = 1;
        float *composed[2];
        indirect_load(gpu, &plain);
        for (int all = 0; all < 2; all++) {
            indirect_arrange(gpu, words);
            gpu->all = all;
            gpu_run(gpu);
            assert_true(gpu_result(gpu, "indirect_trace")->ran == (all || bright));
            composed[all] = gpu_floats(gpu, "composed", NULL, NULL);
        }
        gpu->all = false;
        float *found = gpu_floats(gpu, "indirect", NULL, NULL);
        for (uint32_t i = 0; i < WIDE * HIGH; i++) assert_true((found[4 * i] > 0) == bright);
        assert_memory_equal(composed[0], composed[1], WIDE * HIGH * 4 * sizeof(float));
        free(found), free(composed[0]), free(composed[1]);
    }
}

/* Each frame takes other directions and, where these stay, other starts of the linear march. */
static void frames_take_other_directions(void **state) {
    static const char *const tracers[2][2] = {{"indirect_trace=dda"},
                                              {"indirect_trace=linear", "indirect_trace.shuffle=false"}};
    struct gpu *gpu = *state;
    float *found[2][2];
    for (uint32_t f = 0; f < 2; f++) {
        struct plain plain = frame_of(&all_floor, 60);
        plain.frame = 7 + f;
        indirect_load(gpu, &plain);
        for (int t = 0; t < 2; t++) {
            const char *const words[] = {"downsample=none",
                                         "indirect_trace.level=0",
                                         "indirect_apply=bilinear",
                                         tracers[t][0],
                                         tracers[t][1],
                                         NULL};
            indirect_arrange(gpu, words);
            gpu_run(gpu);
            found[f][t] = gpu_floats(gpu, "indirect", NULL, NULL);
        }
    }
    for (int t = 0; t < 2; t++) {
        int lit = 0, other = 0;
        for (uint32_t i = 0; i < WIDE * HIGH; i++)
            if (found[0][t][4 * i] > 0) lit++, other += found[0][t][4 * i] != found[1][t][4 * i];
        print_message("# %s: %d of %d lit pixels differ\n", tracers[t][0], other, lit);
        assert_true(lit > 1000 && other > lit / 2);
        free(found[0][t]), free(found[1][t]);
    }
}

/* ---- three resolutions ---- */

/* Each level's mean is nearly that of full resolution, blurred and upscaled; without the blur the noise is larger. */
static void levels_share_what_they_find(void **state) {
    struct gpu *gpu = *state;
    const struct plain plain = frame_of(&all_floor, 60);
    double error[4] = {0};
    static const char *const levels[] = {"indirect_trace.level=0", "indirect_trace.level=1", "indirect_trace.level=2",
                                         "indirect_trace.level=2"};
    indirect_load(gpu, &plain);
    for (int l = 0; l < 4; l++) {
        const char *words[] = {"downsample=mips",
                               "surface_levels=picked",
                               "indirect_trace=dda",
                               "indirect_trace.fallback=black",
                               "indirect_trace.directions=4",
                               levels[l],
                               "indirect_apply=planes",
                               l < 3 ? "indirect_blur=edges" : "indirect_trace.directions=4",
                               NULL};
        double light = 0, bias = 0;
        int judged = 0;
        indirect_arrange(gpu, words);
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "indirect", NULL, NULL);
        for (uint32_t i = 0; i < WIDE * HIGH; i++) {
            double at[3], normal[3];
            if (!shapes_pixel(plain.user, &plain, i % WIDE, i / WIDE, at, normal) || !is_judged(&all_floor, at, 1.5))
                continue;
            const double right = lit_patch_seen(&all_floor, at, normal), off = (double)found[4 * i] - right;
            error[l] += off * off, bias += off, light += right;
            judged++;
        }
        free(found);
        error[l] = sqrt(error[l] / judged);
        print_message("# %s%s: RMSE %.4f, bias %+.4f of %.4f\n", levels[l], l == 3 ? ", not shared" : "", error[l],
                      bias / judged, light / judged);
        assert_true(fabs(bias) < 0.15 * light); /* of texels half a metre wide, blurred over three */
    }
    assert_true(error[2] < 0.1 && error[2] < 0.7 * error[3]);
}

/* ---- what is no light ---- */

static void spoiled(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    white_light(plain, values);
    for (uint32_t i = 0; i < pixels; i++) {
        if (i % 7 == 0) values[PLAIN_NORMAL_X * pixels + i] = NAN;
        if (i % 13 == 0) values[i] = i % 2 ? INFINITY : NAN;
        if (i % 17 == 0) values[i] = i % 2 ? 0 : -3;
        if (i % 5 == 0) values[PLAIN_LIT_G * pixels + i] = i % 2 ? NAN : INFINITY;
        if (i % 11 == 0) values[PLAIN_LIT_B * pixels + i] = -1;
    }
}
static void invalid_pixels_spoil_no_others(void **state) {
    static const char *const tracers[] = {"indirect_trace=dda", "indirect_trace=hiz", "indirect_trace=linear"};
    struct gpu *gpu = *state;
    struct plain plain = frame_of(&room, 60);
    plain.spoil = spoiled;
    indirect_load(gpu, &plain);
    for (int t = 0; t < 3; t++) {
        const char *words[] = {
            "downsample=mips",       "surface_levels=picked",         tracers[t], "hiz=nearest", "indirect_blur=edges",
            "indirect_apply=planes", "indirect_temporal=reprojected", NULL};
        int lit = 0;
        indirect_arrange(gpu, words);
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "indirect", NULL, NULL);
        for (uint32_t i = 0; i < WIDE * HIGH; i++) {
            for (uint32_t k = 0; k < 3; k++) assert_true(found[4 * i + k] >= 0 && found[4 * i + k] <= 1.00001F);
            if (i % 7 == 0 || i % 13 == 0 || i % 17 == 0) assert_true(found[4 * i] == 0);
            lit += found[4 * i] > 0.1F;
        }
        free(found);
        print_message("# %s: %d pixels lit\n", tracers[t], lit);
        assert_true(lit > 5000);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(form_factors_agree_with_quadrature),
        cmocka_unit_test(a_lit_patch_opposite),
        cmocka_unit_test(a_lit_patch_beside_the_floor),
        cmocka_unit_test(a_lit_patch_beside_a_wall),
        cmocka_unit_test(radiance_stays_in_a_furnace),
        cmocka_unit_test(light_that_no_ray_finds_is_the_captured_one),
        cmocka_unit_test(where_nothing_shines_nothing_is_traced),
        cmocka_unit_test(frames_take_other_directions),
        cmocka_unit_test(levels_share_what_they_find),
        cmocka_unit_test(invalid_pixels_spoil_no_others),
    };
    return cmocka_run_group_tests_name("gpu_indirect", tests, gpu_set_up, gpu_tear_down);
}
