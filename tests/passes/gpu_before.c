/* What was where in the previous frame: points whose depth moved. */
#include <math.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDE = 48, HIGH = 40, PIXELS = WIDE * HIGH, SHOWN = 1, HIDDEN = 3 };

/* Writes what the floor reflects: the wall, 5 m away, which was `before_m` away where the previous picture shows it, and came by `motion_m`. */
static void load_moved(struct gpu *gpu, float before_m, float motion_m) {
    static const char *const names[] = {"R", "G", "B"}, *const depth = "depth.Z";
    static float depths_m[PIXELS], light[3][PIXELS];
    struct glint_channel channels[3], z = {.name = depth, .type = GLINT_F32, .data = depths_m};
    char path[256];
    for (int i = 0; i < PIXELS; ++i) depths_m[i] = before_m, light[0][i] = light[1][i] = light[2][i] = 0.75F;
    for (int k = 0; k < 3; ++k)
        channels[k] = (struct glint_channel){.name = names[k], .type = GLINT_F32, .data = light[k]};
    const struct glint_part parts[] = {
        {.name = "previous.gbuffer", .width = WIDE, .height = HIGH, .channels = &z, .channel_count = 1},
        {.name = "previous.lit", .width = WIDE, .height = HIGH, .channels = channels, .channel_count = 3}};
    plain_capture(gpu_path(gpu, "moved", path), &(struct plain){.width = WIDE,
                                                                .height = HIGH,
                                                                .fov_y_degrees = 60,
                                                                .floor = true,
                                                                .frame = 2,
                                                                .motion_m = &motion_m,
                                                                .part = parts,
                                                                .part_count = 2});
    gpu_load(gpu, "moved");
    gpu_reset(gpu);
    gpu->all = true;
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, "resolve=previous");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_set(gpu, "resolve.hidden=black");
    gpu_run(gpu);
}

/* motion.Z is the depth one frame earlier minus the depth now: a wall that comes by a metre was 6 m away, and 4 m if it goes by one. */
static void a_surface_that_came_nearer_was_farther(void **state) {
    static const struct {
        float before_m, motion_m;
        uint32_t source;
    } cases[] = {{5, 0, SHOWN},   {6, 1, SHOWN},  {4, -1, SHOWN}, {4, 1, HIDDEN},
                 {6, -1, HIDDEN}, {5, 1, HIDDEN}, {6, 0, HIDDEN}};
    struct gpu *gpu = *state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        load_moved(gpu, cases[c].before_m, cases[c].motion_m);
        uint32_t *source = gpu_uints(gpu, "previous_source", NULL, NULL), hits = 0;
        float *color = gpu_floats(gpu, "reflection_half", NULL, NULL),
              *depth_m = gpu_floats(gpu, "depth_half", NULL, NULL);
        for (int i = 0; i < PIXELS; ++i) {
            if (!source[i] || !(depth_m[i] < 4.9F)) continue; /* the wall reflects the floor */
            hits++;
            assert_int_equal(source[i], cases[c].source);
            assert_true(fabsf(color[4 * i] - (cases[c].source == SHOWN ? 0.75F : 0)) < 1e-3F); /* a half */
        }
        assert_true(hits > 100);
        free(source), free(color), free(depth_m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_surface_that_came_nearer_was_farther)};
    return cmocka_run_group_tests_name("gpu_before", tests, gpu_set_up, gpu_tear_down);
}
