/* The limits of finer steps: screen_trace/linear_facets approaches dda, and cubemap_trace/march with surfaces=exact approaches exact
   with maps=chain. The steps of both differ from texels, so that nothing agrees by construction. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

/* The end of each ray and its cube map, which is NULL for screen rays. */
struct ends {
    size_t count;
    float *travelled_m;
    uint32_t *place, *end;
};

static struct ends ends_of(struct gpu *gpu, const char *travelled, const char *place, const char *end) {
    uint32_t width, height;
    gpu_run(gpu);
    struct ends e = {.travelled_m = gpu_floats(gpu, travelled, &width, &height),
                     .place = gpu_uints(gpu, place, NULL, NULL),
                     .end = gpu_uints(gpu, end, NULL, NULL)};
    e.count = (size_t)width * height;
    return e;
}

static void ends_free(struct ends *e) {
    free(e->travelled_m);
    free(e->place);
    free(e->end);
}

/* The fraction of rays that end elsewhere: distances differ by more than a fraction, or cube maps differ. */
static double fraction_elsewhere(const struct ends *a, const struct ends *b, double part) {
    size_t rays = 0, apart = 0;
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; ++i) {
        if (b->end[i] == 0) continue; /* no ray */
        float s = a->travelled_m[i], t = b->travelled_m[i];
        bool same = isinf(s) || isinf(t) ? s == t : fabsf(s - t) <= (float)part * t;
        ++rays;
        apart += !same || a->place[i] != b->place[i];
    }
    assert_true(rays > 1000);
    return (double)apart / (double)rays;
}

static void screen_rays(struct gpu *gpu, const char *variant) {
    static const char *const without[] = {
        "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", "compose", NULL};
    gpu_reset(gpu);
    gpu_without(gpu, without);
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, variant);
    gpu_set(gpu, "screen_trace.thickness=0.01");
    gpu_set(gpu, "screen_trace.solid=32");
    gpu->all = true;
}

static void finer_steps_on_screen_end_as_texel_by_texel(void **state) {
    static const char *const steps[] = {"8", "32", "128", "4096"};
    struct gpu *gpu = *state;
    char text[64];
    gpu_sample(gpu, "street", "street", &(struct glint_sample_options){.width = 128, .height = 72, .cube_size = 16});
    screen_rays(gpu, "screen_trace=dda");
    struct ends walked = ends_of(gpu, "screen_travelled", "screen_finished", "screen_end");
    double before = 1;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
        screen_rays(gpu, "screen_trace=linear_facets");
        gpu_set(gpu, "screen_trace.first_step=0.001");
        snprintf(text, sizeof text, "screen_trace.steps=%s", steps[i]);
        gpu_set(gpu, text);
        struct ends stepped = ends_of(gpu, "screen_travelled", "screen_finished", "screen_end");
        double part = fraction_elsewhere(&stepped, &walked, 1e-4);
        print_message("# %s steps: %.3f %% of the rays end elsewhere\n", steps[i], 100 * part);
        assert_true(part < before);
        before = part;
        ends_free(&stepped);
    }
    /* 4096 steps for a ray that crosses at most 200 texels: one in a hundred texels contains so little of the ray that it can be
       missed, and few of the crossed texels decide where a ray ends. */
    assert_true(before < 0.01);
    ends_free(&walked);
}

/* A bar near the camera, in front of a wall and its floor. */
enum { BAR_WIDTH = 81, BAR_HEIGHT = 121, BELOW_THE_BAR = 85 };
static void bar(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const double down = 2 * (i / plain->width + 0.5) / plain->height - 1;
        if (down < -0.05 || down > 0.3) continue;
        values[PLAIN_DEPTH * pixels + i] = 0.5F;
        values[PLAIN_NORMAL_Y * pixels + i] = 0, values[PLAIN_NORMAL_Z * pixels + i] = 1;
    }
}

/* A ray from the floor goes behind the bar once: one step of it is bisected, however many more end behind the bar. */
static void only_the_step_behind_a_surface_is_bisected(void **state) {
    static const char *const halvings[] = {"screen_trace.refinements=0", "screen_trace.refinements=4"};
    struct gpu *gpu = *state;
    char path[256];
    uint32_t *steps[2], bisected = 0, most = 0;
    plain_capture(
        gpu_path(gpu, "bar", path),
        &(struct plain){.width = BAR_WIDTH, .height = BAR_HEIGHT, .fov_y_degrees = 60, .floor = true, .spoil = bar});
    gpu_load(gpu, "bar");
    for (int i = 0; i < 2; ++i) {
        screen_rays(gpu, "screen_trace=linear_facets");
        gpu_set(gpu, "screen_trace.dither=false");
        gpu_set(gpu, "screen_trace.growth=1");
        gpu_set(gpu, "screen_trace.steps=24");
        gpu_set(gpu, "screen_trace.solid=1");
        gpu_set(gpu, halvings[i]);
        gpu_run(gpu);
        steps[i] = gpu_uints(gpu, "screen_steps", NULL, NULL);
    }
    for (uint32_t i = BELOW_THE_BAR * BAR_WIDTH; i < BAR_HEIGHT * BAR_WIDTH; ++i) {
        const uint32_t more = steps[1][i] > steps[0][i] ? steps[1][i] - steps[0][i] : 0;
        bisected += more > 0, most = more > most ? more : most;
    }
    print_message("# %u rays bisect, in at most %u more steps\n", bisected, most);
    assert_true(bisected > 1000 && most <= 4);
    free(steps[0]), free(steps[1]);
}

static void cube_map_rays(struct gpu *gpu, const char *variant) {
    gpu_reset(gpu);
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, variant);
    gpu_set(gpu, "cubemap_active.chain=8");
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu->all = true;
}

static struct ends followed(struct gpu *gpu, const char *texel_part) {
    cube_map_rays(gpu, "cubemap_trace=exact");
    gpu_set(gpu, "cubemap_trace.maps=chain");
    gpu_set(gpu, "cubemap_trace.occluded=stop");
    gpu_set(gpu, "cubemap_trace.steps=1000000");
    gpu_set(gpu, texel_part);
    return ends_of(gpu, "travelled", "cubemap_index", "cubemap_end");
}

static void finer_steps_through_cube_maps_end_as_by_texels(void **state) {
    static const char *const always[] = {"surfaces=exact", "bias=0",  "hq_roughness=1",  "first_step_m=0.01",
                                         "length_m=300",   "chain=8", "fallback=lookup", "exhausted=fallback",
                                         "depth=captured"};
    static const char *const steps[] = {"8", "32", "128", "1024"};
    struct gpu *gpu = *state;
    char text[64];
    gpu_sample(gpu, "room", "room", &(struct glint_sample_options){.width = 96, .height = 54, .cube_size = 64});
    struct ends half = followed(gpu, "cubemap_trace.texel_part=0.5"),
                fine = followed(gpu, "cubemap_trace.texel_part=0.1");
    double own = fraction_elsewhere(&half, &fine, 0.02), before = 1;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
        cube_map_rays(gpu, "cubemap_trace=march");
        for (size_t k = 0; k < sizeof always / sizeof *always; ++k) {
            snprintf(text, sizeof text, "cubemap_trace.%s", always[k]);
            gpu_set(gpu, text);
        }
        snprintf(text, sizeof text, "cubemap_trace.steps_hq=%s", steps[i]);
        gpu_set(gpu, text);
        struct ends marched = ends_of(gpu, "travelled", "cubemap_index", "cubemap_end");
        double part = fraction_elsewhere(&marched, &fine, 0.02);
        print_message("# %s steps: %.2f %% of the rays end elsewhere; of steps of half a texel %.2f %%\n", steps[i],
                      100 * part, 100 * own);
        assert_true(part < before);
        before = part;
        ends_free(&marched);
    }
    /* Steps of a tenth of a texel are as accurate as steps of half a texel: both miss only what is thinner than a step. Twice, for the
       march's fixed first step. */
    assert_true(before < 2 * own);
    ends_free(&half);
    ends_free(&fine);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finer_steps_on_screen_end_as_texel_by_texel),
        cmocka_unit_test(only_the_step_behind_a_surface_is_bisected),
        cmocka_unit_test(finer_steps_through_cube_maps_end_as_by_texels),
    };
    return cmocka_run_group_tests_name("gpu_step_limits", tests, gpu_set_up, gpu_tear_down);
}
