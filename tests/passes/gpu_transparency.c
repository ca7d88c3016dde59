/* Glass on the scene glasshouse, compared with the image of its path tracer: both faces of a pane with Fresnel's equations, and the
   exact mirror ray. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "glint/study.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDTH = 240, HEIGHT = 136 };

static void use_panes(struct gpu *gpu) {
    static const char *const slots[] = {"transparent_downsample=nearest", "transparent_screen_trace=linear",
                                        "transparent_cubemap_trace=march", "transparent_resolve=hit",
                                        "transparency=trace"};
    for (size_t i = 0; i < sizeof slots / sizeof *slots; ++i) gpu_use(gpu, slots[i]);
}

static void load_scene(struct gpu *gpu, const char *scene) {
    gpu_sample(gpu, scene, scene,
               &(struct glint_sample_options){
                   .width = WIDTH, .height = HEIGHT, .cube_size = 64, .light_samples = 8, .unjittered = true});
    gpu_reset(gpu);
    use_panes(gpu);
    gpu_set(gpu, "compose.intensity=0"); /* the truth contains only the reflections of panes */
}

/* The mean of |image - truth| / (image + truth + 0.05) over the pixels of panes, or the maximum over all others. */
static double error_of(struct gpu *gpu, const float *opacity, const float *scene, bool beside) {
    double sum = 0, worst = 0;
    size_t count = 0;
    float *finished = gpu_floats(gpu, "composed_transparent", NULL, NULL);
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i)
        for (size_t c = 0; c < 3; ++c) {
            double a = (double)finished[4 * i + c], b = (double)scene[3 * i + c], apart = fabs(a - b) / (a + b + 0.05);
            if (opacity[i] > 0) sum += apart, ++count;
            else worst = fmax(worst, apart);
        }
    free(finished);
    assert_true(count > WIDTH * HEIGHT / 4);
    return beside ? worst : sum / (double)count;
}

static void every_part_of_it_brings_the_picture_nearer(void **state) {
    struct gpu *gpu = *state;
    static const char *const off[] = {NULL, "transparent_screen_trace.length_m=0", "transparent_cubemap_trace.chain=1",
                                      "transparency.fresnel=false", "transparency.intensity=0"};
    double errors[5];
    load_scene(gpu, "glasshouse");
    float *opacity = gpu_part(gpu, "transparent", (const char *[]){"A"}, 1),
          *scene = gpu_part(gpu, "scene", (const char *[]){"R", "G", "B"}, 3);
    for (int i = 0; i < 5; ++i) {
        load_scene(gpu, "glasshouse");
        if (off[i]) gpu_set(gpu, off[i]);
        gpu_run(gpu);
        errors[i] = error_of(gpu, opacity, scene, false);
        print_message("# %-40s %.4f\n", off[i] ? off[i] : "all", errors[i]);
        if (i) assert_true(errors[i] > errors[0]);
        /* Pixels without a pane do not change, apart from the rounding of both to half floats. */
        assert_true(error_of(gpu, opacity, scene, true) < 1e-3);
    }
    /* The remaining error of the reflection is due to surfaces that no buffer shows: back faces, edges. */
    assert_true(errors[4] > 3 * errors[0]);
    free(opacity), free(scene);
}

static void a_frame_without_glass_leaves_it_out(void **state) {
    struct gpu *gpu = *state;
    size_t count = 0;
    bool found = false;
    load_scene(gpu, "matte");
    gpu_run(gpu);
    const struct glint_pass_result *results = glint_replay_results(gpu->replay, &count);
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(results[i].pass->slot, "transparency")) continue;
        found = true;
        assert_false(results[i].ran);
    }
    assert_true(found);
}

/* Where nothing moves, the previous frame equals the current one, and rays that end on screen find the same colour. */
static void panes_find_their_colour_in_the_previous_frame(void **state) {
    struct gpu *gpu = *state;
    float *color[2];
    gpu_sample(gpu, "glasshouse", "again",
               &(struct glint_sample_options){.width = WIDTH,
                                              .height = HEIGHT,
                                              .cube_size = 32,
                                              .light_samples = 8,
                                              .unjittered = true,
                                              .first_frame = 2,
                                              .travel_given = true});
    for (int before = 0; before < 2; ++before) {
        gpu_reset(gpu);
        gpu->float_precision = true;
        use_panes(gpu);
        if (before) {
            gpu_use(gpu, "transparent_resolve=previous");
            gpu_set(gpu, "transparent_resolve.color_source=lit");
        }
        gpu_set(gpu, "transparent_resolve.fog=false");
        gpu_run(gpu);
        color[before] = gpu_floats(gpu, "transparent_reflection", NULL, NULL);
    }
    uint32_t *finished = gpu_uints(gpu, "transparent_screen_finished", NULL, NULL);
    double *apart = malloc(sizeof *apart * WIDTH * HEIGHT / 4);
    assert_non_null(apart);
    size_t on_screen = 0, others = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT / 4; ++i) {
        const double a = (double)color[0][4 * i + 1], b = (double)color[1][4 * i + 1];
        if (finished[i]) apart[on_screen++] = fabs(a - b) / (a + b + 0.05);
        else others += a != b;
    }
    const double most = on_screen ? quantile(apart, on_screen, 0.9) : 1;
    print_message("# %zu rays end on the screen, nine in ten off by less than %.2g; %zu others differ\n", on_screen,
                  most, others);
    /* Both images are rounded to half floats; an edge may occlude a point in one pixel and not in the next. */
    assert_true(on_screen > 200 && most < 2e-3 && others == 0);
    free(color[0]), free(color[1]), free(finished), free(apart);
}

/* ---- panes by closed form ---- */

enum { SIDE = 96 };

static void at_wall(UNUSED uint32_t number, const double direction[3], float out[5]) {
    for (int k = 0; k < 3; ++k) out[k] = (float)(0.5 + 0.5 * direction[k]);
    out[3] = 1, out[4] = 100;
}

/* Faces the viewer at 3 m in the left half; the water is at 4 m, and in the upper third at 2 m. */
static float pane_roughness;
static void matte(const struct plain *plain, float *values) {
    memset(values + (size_t)PLAIN_SPECULAR * plain->width * plain->height, 0,
           sizeof *values * plain->width * plain->height);
}
static void pane_at(uint32_t x, UNUSED uint32_t y, float out[9]) {
    const float values[9] = {0.25f, 0.5f, 0.75f, 0.5f, 0, 0, 1, x < SIDE / 2 ? 3 : INFINITY, pane_roughness};
    memcpy(out, values, sizeof values);
}
static void water_at(UNUSED uint32_t x, uint32_t y, float out[9]) {
    const float values[9] = {0, 0.125f, 0.25f, 0.5f, 0, 0, 1, y < SIDE / 3 ? 2 : 4, 1};
    memcpy(out, values, sizeof values);
}

static void load_panes(struct gpu *gpu, const struct plain *plain) {
    char path[256];
    plain_capture(gpu_path(gpu, "panes", path), plain);
    gpu_load(gpu, "panes");
    gpu_reset(gpu);
    gpu->float_precision = true;
    use_panes(gpu);
}

static void load_plain(struct gpu *gpu, bool water, float roughness, void (*spoil)(const struct plain *, float *)) {
    pane_roughness = roughness;
    load_panes(gpu, &(struct plain){.width = SIDE,
                                    .height = SIDE,
                                    .fov_y_degrees = 60,
                                    .cube_size = 32,
                                    .cube_count = 1,
                                    .cube = at_wall,
                                    .pane = pane_at,
                                    .spoil = spoil,
                                    .water = water ? water_at : NULL});
}

/* Panes are composed over water, unless the water is in front of them. */
static void panes_lie_over_water(void **state) {
    struct gpu *gpu = *state;
    load_plain(gpu, true, 0, NULL);
    gpu_use(gpu, "water=combine");
    gpu_set(gpu, "transparency.intensity=0");
    gpu_run(gpu);
    assert_string_equal(glint_study_picture(gpu->replay)->name, "composed_transparent");
    float *water = gpu_floats(gpu, "composed_water", NULL, NULL),
          *all = gpu_floats(gpu, "composed_transparent", NULL, NULL),
          *composed = gpu_floats(gpu, "composed", NULL, NULL);
    int over = 0, wet = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        const bool pane = i % SIDE < SIDE / 2 && i / SIDE >= SIDE / 3;
        for (uint32_t k = 0; k < 3; ++k) { /* half covered by the pane's own colour */
            const float below = water[4 * i + k], own = 0.25f * (float)(k + 1);
            assert_true(fabsf(all[4 * i + k] - (pane ? 0.5f * (below + own) : below)) < 1e-6f);
        }
        over += pane, wet += memcmp(water + 4 * i, composed + 4 * i, 3 * sizeof *water) != 0;
    }
    assert_true(over > 0 && wet == SIDE * SIDE);
    free(water), free(all), free(composed);
    /* Without water the same pipeline composes them over the opaque image. */
    load_plain(gpu, false, 0, NULL);
    gpu_use(gpu, "water=combine");
    gpu_set(gpu, "transparency.intensity=0");
    gpu_run(gpu);
    all = gpu_floats(gpu, "composed_transparent", NULL, NULL), composed = gpu_floats(gpu, "composed", NULL, NULL);
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        const float expected = i % SIDE < SIDE / 2 ? 0.5f * (composed[4 * i] + 0.25f) : composed[4 * i];
        assert_true(fabsf(all[4 * i] - expected) < 1e-6f);
    }
    /* Without a plan the pass of the water runs, and nothing is in front of the panes. */
    gpu->all = true;
    gpu_run(gpu);
    float *unplanned = gpu_floats(gpu, "composed_transparent", NULL, NULL);
    assert_memory_equal(unplanned, all, 4 * SIDE * SIDE * sizeof *all);
    gpu->all = false;
    free(all), free(composed), free(unplanned);
}

/* Antialiasing takes the last picture, with panes and water; without a history it passes it on. */
static void antialiasing_has_panes_and_water(void **state) {
    static const char *const last[] = {"composed", "composed_water", "composed_transparent"};
    struct gpu *gpu = *state;
    for (int panes = 0; panes < 2; ++panes) {
        load_plain(gpu, true, 0, NULL);
        if (!panes) gpu_use(gpu, "transparency=none");
        gpu_use(gpu, "water=combine");
        gpu_use(gpu, "taa=composed");
        gpu_run(gpu);
        float *antialiased = gpu_floats(gpu, "antialiased", NULL, NULL),
              *picture = gpu_floats(gpu, last[1 + panes], NULL, NULL),
              *below = gpu_floats(gpu, last[panes], NULL, NULL);
        for (uint32_t i = 0; i < SIDE * SIDE; ++i)
            assert_memory_equal(antialiased + 4 * i, picture + 4 * i, 3 * sizeof *picture);
        assert_true(memcmp(picture, below, 4 * SIDE * SIDE * sizeof *picture));
        free(antialiased), free(picture), free(below);
    }
}

/* A pane in a matte scene: the images that its rays are traced in are written nevertheless. */
static void panes_reflect_in_a_matte_scene(void **state) {
    struct gpu *gpu = *state;
    float *color[2];
    for (int i = 0; i < 2; ++i) {
        load_plain(gpu, false, 0, i ? matte : NULL);
        gpu_run(gpu);
        color[i] = gpu_floats(gpu, "transparent_reflection", NULL, NULL);
    }
    assert_memory_equal(color[0], color[1], SIDE * SIDE / 4 * 4 * sizeof *color[0]);
    assert_true(color[0][4 * (SIDE / 4 * SIDE / 2 + SIDE / 8) + 2] > 0.5f); /* behind the viewer */
    for (int i = 0; i < 2; ++i) free(color[i]);
}

/* A smooth pane has exactly its mirror ray. Rays of a rough one are sampled from its lobe, and several per pixel are averaged. */
static void panes_have_their_roughness(void **state) {
    struct gpu *gpu = *state;
    double variance[2];
    load_plain(gpu, false, 0, NULL);
    gpu_run(gpu);
    float *normal = gpu_floats(gpu, "transparent_normal_jittered", NULL, NULL);
    for (uint32_t i = 0; i < SIDE * SIDE / 4; ++i) {
        const float there = i % (SIDE / 2) < SIDE / 4 ? 1 : 0;
        assert_true(normal[4 * i] == 0 && normal[4 * i + 1] == 0 && normal[4 * i + 2] == there);
    }
    free(normal);
    const struct glint_survey *survey = NULL;
    struct glint_error err = {0};
    if (!glint_replay_survey(gpu->replay, &survey, NULL, &err)) fail_msg("%s", err.message);
    assert_true(survey->transparent == SIDE * SIDE && survey->transparent_roughness == 0);
    for (int many = 0; many < 2; ++many) {
        load_plain(gpu, false, 0.4f, NULL);
        gpu_set(gpu, "transparent_screen_trace.length_m=0");
        gpu_set(gpu, many ? "pipeline.rays=16" : "pipeline.rays=1");
        gpu_run(gpu);
        float *color = gpu_floats(gpu, "transparent_reflection", NULL, NULL);
        double sum = 0, squares = 0;
        int count = 0;
        for (int y = 20; y < 28; ++y) /* the view direction changes little over these */
            for (int x = 16; x < 24; ++x, ++count) {
                double value = (double)color[4 * (y * SIDE / 2 + x)];
                sum += value, squares += value * value;
            }
        variance[many] = squares / count - sum * sum / count / count;
        free(color);
    }
    print_message("# variance of a rough pane's reflection: one ray %.5f, 16 rays %.5f\n", variance[0], variance[1]);
    /* A sixteenth; the variance of 64 texels is accurate to a fifth, and the image has a slope. */
    assert_true(variance[0] > 1e-3 && variance[1] < variance[0] / 6);
}

/* A pane on the floor, whose rays meet the wall: each frame begins its steps elsewhere. */
static void on_floor(UNUSED uint32_t x, uint32_t y, float out[9]) {
    const double down = (2 * (y + 0.5) / SIDE - 1) * 0.57735027;
    const float values[9] = {0, 0, 0, 0.5f, 0, 1, 0, down > 0.3 ? (float)(1 / down) : INFINITY, 0};
    memcpy(out, values, sizeof values);
}
static void each_frame_of_a_pane_steps_elsewhere(void **state) {
    struct gpu *gpu = *state;
    float *travelled[2];
    size_t found = 0, apart = 0;
    for (uint32_t i = 0; i < 2; ++i) {
        load_panes(
            gpu, &(struct plain){.width = SIDE, .height = SIDE, .fov_y_degrees = 60, .frame = 7 + i, .pane = on_floor});
        gpu_set(gpu, "transparent_screen_trace.refine=false");
        gpu_set(gpu, "transparent_downsample.jitter=false");
        gpu_run(gpu);
        travelled[i] = gpu_floats(gpu, "transparent_screen_travelled", NULL, NULL);
    }
    for (size_t i = 0; i < SIDE * SIDE / 4; ++i)
        if (travelled[0][i] > 0 && travelled[1][i] > 0) found++, apart += travelled[0][i] != travelled[1][i];
    print_message("# %zu rays end on screen in both frames, %zu elsewhere\n", found, apart);
    assert_true(found > 300 && apart > found / 2);
    free(travelled[0]), free(travelled[1]);
}

/* In the left column of each block a pane at 2 m without a normal, in the right one a valid pane at 3 m. */
static void half_usable(uint32_t x, UNUSED uint32_t y, float out[9]) {
    const float values[9] = {0.25f, 0.5f, 0.75f, 0.5f, 0, 0, (float)(x % 2), x % 2 ? 3 : 2, 0};
    memcpy(out, values, sizeof values);
}

/* A ray starts at the nearest valid surface. */
static void a_pane_without_a_normal_has_no_ray(void **state) {
    struct gpu *gpu = *state;
    load_panes(gpu, &(struct plain){.width = SIDE, .height = SIDE, .fov_y_degrees = 60, .pane = half_usable});
    gpu->all = true;
    gpu_run(gpu);
    float *depth = gpu_floats(gpu, "transparent_depth_half", NULL, NULL),
          *normal = gpu_floats(gpu, "transparent_normal_jittered", NULL, NULL);
    uint32_t *pick = gpu_uints(gpu, "transparent_pick", NULL, NULL);
    for (uint32_t i = 0; i < SIDE * SIDE / 4; ++i) {
        assert_true(depth[i] == 3 && normal[4 * i + 2] == 1);
        assert_int_equal(pick[i], 1); /* the first of two at equal distance */
    }
    free(depth), free(normal), free(pick);
}

/* Two adjacent panes with different normals, the left one at 3 m, the right one at half the distance; there is none above them. */
static void two_panes(uint32_t x, uint32_t y, float out[9]) {
    const bool left = x < SIDE / 2;
    const float values[9] = {
        0, 0, 0, 0.5f, left ? 0 : 0.6f, 0, left ? 1 : 0.8f, y < SIDE / 2 ? INFINITY : left ? 3 : 1.5f, 0};
    memcpy(out, values, sizeof values);
}

static void white(UNUSED const double direction[3], float out[3]) {
    out[0] = out[1] = out[2] = 1;
}

/* The reflection of a pixel is interpolated from texels of its own pane; pixels without a pane do not change. */
static void a_pane_shows_its_own_reflection(void **state) {
    struct gpu *gpu = *state;
    load_panes(gpu, &(struct plain){.width = SIDE,
                                    .height = SIDE,
                                    .fov_y_degrees = 60,
                                    .cube_size = 32,
                                    .cube_count = 1,
                                    .cube = at_wall,
                                    .sky = white,
                                    .pane = two_panes});
    gpu->all = true;
    gpu_set(gpu, "transparent_screen_trace.length_m=0");
    gpu_set(gpu, "transparency.fresnel=false"); /* a reflectance of 0.53 at an index of 4, times sixteen */
    gpu_set(gpu, "transparency.index=4");
    gpu_set(gpu, "transparency.intensity=16");
    gpu_run(gpu);
    float *half = gpu_floats(gpu, "transparent_reflection", NULL, NULL),
          *all = gpu_floats(gpu, "composed_transparent", NULL, NULL);
    double apart = 0;
    for (int i = 0; i < SIDE / 2 * SIDE / 4; ++i) assert_true(half[4 * i] == 0 && half[4 * i + 3] == 0);
    for (int y = SIDE / 2 + 1; y < SIDE - 1; ++y)
        for (int x = 1; x < SIDE - 1; ++x)
            for (int k = 0; k < 3; ++k) {
                double sum = 0, weights = 0;
                for (int t = 0; t < 4; ++t) {
                    const int i = (x - 1) / 2 + t % 2, j = (y - 1) / 2 + t / 2;
                    const double weight = (1 - fabs(x / 2.0 - 0.25 - i)) * (1 - fabs(y / 2.0 - 0.25 - j));
                    if ((i < SIDE / 4) != (x < SIDE / 2)) continue;
                    sum += weight * (double)half[4 * (j * SIDE / 2 + i) + k], weights += weight;
                }
                apart = fmax(apart, fabs(sum / weights - (double)all[4 * (y * SIDE + x) + k]));
            }
    print_message("# off by at most %.2g\n", apart);
    /* where a third of the weight is the other pane's, a ten-thousandth of it is used, of colours up to 1 */
    assert_true(apart < 4e-5);
    free(half), free(all);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_of_it_brings_the_picture_nearer),
        cmocka_unit_test(panes_find_their_colour_in_the_previous_frame),
        cmocka_unit_test(a_frame_without_glass_leaves_it_out),
        cmocka_unit_test(panes_lie_over_water),
        cmocka_unit_test(antialiasing_has_panes_and_water),
        cmocka_unit_test(panes_reflect_in_a_matte_scene),
        cmocka_unit_test(panes_have_their_roughness),
        cmocka_unit_test(each_frame_of_a_pane_steps_elsewhere),
        cmocka_unit_test(a_pane_without_a_normal_has_no_ray),
        cmocka_unit_test(a_pane_shows_its_own_reflection),
    };
    return cmocka_run_group_tests_name("gpu_transparency", tests, gpu_set_up, gpu_tear_down);
}
